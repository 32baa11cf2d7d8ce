// SPDX-License-Identifier: Apache-2.0
//
// librosbag trusts what it reads: some damaged bags crash it, others let it ask for all memory. So
// a bag is read once from its beginning to its end in a process of its own before this one opens
// it.
#pragma once

#include <string>

namespace kiva_ros {

/// The argument, before a path, with which this program is that process.
constexpr char kCheckBagOption[] = "--check-bag";

/// Throws std::runtime_error that says what is wrong with the bag, and what may help.
void checkBag(const std::string& path);

/// What that process does: tells on stdout what is wrong. Returns its exit code.
int checkBagHere(const std::string& path);

}  // namespace kiva_ros
