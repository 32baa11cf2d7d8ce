// SPDX-License-Identifier: Apache-2.0
#include "world_file/files/errors.h"

namespace kiva {

Fault reworded(Fault fault, const std::string& message) {
  fault.message = message;
  return fault;
}

std::string address(const Fault& fault, const std::string& where) {
  std::string text = fault.file.empty() ? where : fault.file;
  if (fault.line > 0 && !text.empty()) text += ":" + std::to_string(fault.line);
  return text + (text.empty() || fault.entity.empty() ? "" : ": ") + fault.entity;
}

std::string describe(const Fault& fault, const std::string& where) {
  return address(fault, where) + ": " + fault.message;
}

}  // namespace kiva
