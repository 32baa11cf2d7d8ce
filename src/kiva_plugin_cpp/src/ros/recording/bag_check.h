// SPDX-License-Identifier: Apache-2.0
//
// librosbag trusts what it reads: some damaged bags crash it, others let it ask for all memory. So
// a bag is read once from its beginning to its end in a process of its own before this one opens
// it.
#pragma once

#include <string>

namespace kiva_ros {

/// The argument, before a path, that makes this program that process.
constexpr char kCheckBagOption[] = "--check-bag";

/// Checks a bag. Throws std::runtime_error with its fault and a remedy.
void checkBag(const std::string& path);

/// Checks a bag in that process: prints its fault to stdout and returns the exit code.
int checkBagHere(const std::string& path);

}  // namespace kiva_ros
