// SPDX-License-Identifier: Apache-2.0
//
// What is wrong in an SDF document, with its address, from libsdformat's lists and from our own
// checks alike.
#pragma once

#include <exception>
#include <mutex>
#include <sdf/Element.hh>
#include <sdf/Error.hh>
#include <sdf/Types.hh>
#include <sstream>
#include <string>
#include <vector>

namespace kiva {

/// An error in a document whose name is not known yet; `describe` adds it.
class SdfError : public std::exception {
 public:
  explicit SdfError(sdf::Error error) : error_(std::move(error)), text_(error_.Message()) {}
  const sdf::Error& error() const { return error_; }
  const char* what() const noexcept override { return text_.c_str(); }

 private:
  sdf::Error error_;
  std::string text_;
};

/// A message at the file, line and entity of `element`.
sdf::Error noteAt(const sdf::ElementConstPtr& element, const std::string& message);
/// Another message at the address of `error`.
sdf::Error reworded(const sdf::Error& error, const std::string& message);
[[noreturn]] void failAt(const sdf::ElementConstPtr& element, const std::string& message);

/// `file:line: model 'm', link 'l'`; `where` is put for the file of a document that was given as
/// text. If that is empty, the entity alone.
std::string address(const sdf::Error& error, const std::string& where);
/// The address and the message.
std::string describe(const sdf::Error& error, const std::string& where);

/// The message in words that help its reader.
std::string causeOf(const sdf::Error& error);
/// What tinyxml2, which libsdformat reads with, has to say of a text that is no XML.
sdf::Error xmlError(const std::string& printed);

/// Builds a part, or tells in a warning that this part, a "joint" say, is left out and why.
template <typename Build>
void buildOrLeaveOut(const std::string& part, sdf::Errors* warnings, Build build) {
  try {
    build();
  } catch (const SdfError& error) {
    warnings->push_back(
        reworded(error.error(), "this " + part + " is left out: " + causeOf(error.error())));
  }
}

/// Throws SdfError for the first of libsdformat's errors, with the cause that it only printed;
/// without any, appends the warnings that it printed.
void throwErrors(const sdf::Errors& errors, const std::string& printed, sdf::Errors* warnings);

/// While it lives, no other thread uses libsdformat through this library, and what libsdformat
/// prints on its console goes into a string.
class ConsoleCapture {
 public:
  ConsoleCapture();
  ~ConsoleCapture();
  ConsoleCapture(const ConsoleCapture&) = delete;
  ConsoleCapture& operator=(const ConsoleCapture&) = delete;
  /// What came since the last call.
  std::string take();

 private:
  static std::mutex mutex_;
  std::lock_guard<std::mutex> lock_;
  std::ostringstream printed_;
  std::ostream* before_;
};

}  // namespace kiva
