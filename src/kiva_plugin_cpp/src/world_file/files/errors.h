// SPDX-License-Identifier: Apache-2.0
//
// Faults in an SDF document, with their addresses.
#pragma once

#include <exception>
#include <string>
#include <vector>

namespace kiva {

/// A fault at a place in a document.
struct Fault {
  std::string message;
  std::string entity;  ///< `model 'm', link 'l', inertial/mass`; empty: the whole document.
  std::string file;    ///< Empty = the caller's document, whose name is not known here.
  int line = 0;        ///< 0: unknown.
};
using Faults = std::vector<Fault>;

/// A fault that leaves nothing of a document; `describe` adds the document's name.
class SdfError : public std::exception {
 public:
  explicit SdfError(Fault fault) : fault_(std::move(fault)) {}
  const Fault& error() const { return fault_; }
  const char* what() const noexcept override { return fault_.message.c_str(); }

 private:
  Fault fault_;
};

/// Returns another message at the address of `fault`.
Fault reworded(Fault fault, const std::string& message);

/// Returns `file:line: model 'm', link 'l'`. `where` names a document that has no file; if it is
/// empty, the result is the entity alone.
std::string address(const Fault& fault, const std::string& where);
/// Returns the address and the message.
std::string describe(const Fault& fault, const std::string& where);

/// Builds a part, such as a "joint", or adds a warning with the reason why it is left out.
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
