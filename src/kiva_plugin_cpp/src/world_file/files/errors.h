// SPDX-License-Identifier: Apache-2.0
//
// What is wrong in an SDF document, with its address.
#pragma once

#include <exception>
#include <string>
#include <vector>

namespace kiva {

/// Something wrong at a place in a document.
struct Fault {
  std::string message;
  std::string entity;  ///< `model 'm', link 'l', inertial/mass`; empty: the whole document.
  std::string file;    ///< Empty: the document that was given, whose name is not known here.
  int line = 0;        ///< 0: unknown.
};
using Faults = std::vector<Fault>;

/// A fault that nothing is left with; `describe` adds the document's name.
class SdfError : public std::exception {
 public:
  explicit SdfError(Fault fault) : fault_(std::move(fault)) {}
  const Fault& error() const { return fault_; }
  const char* what() const noexcept override { return fault_.message.c_str(); }

 private:
  Fault fault_;
};

/// Another message at the address of `fault`.
Fault reworded(Fault fault, const std::string& message);

/// `file:line: model 'm', link 'l'`; `where` is put for the file of a document that was given as
/// text. If that is empty, the entity alone.
std::string address(const Fault& fault, const std::string& where);
/// The address and the message.
std::string describe(const Fault& fault, const std::string& where);

/// Builds a part, or tells in a warning that this part, a "joint" say, is left out and why.
template <typename Build>
void buildOrLeaveOut(const std::string& part, Faults* warnings, Build build) {
  try {
    build();
  } catch (const SdfError& error) {
    warnings->push_back(
        reworded(error.error(), "this " + part + " is left out: " + error.error().message));
  }
}

}  // namespace kiva
