// SPDX-License-Identifier: Apache-2.0
//
// Checks bags in a child process. librosbag trusts its input: some damaged bags crash it, others
// make it allocate all memory. So a bag is read once, from beginning to end, in a process of its
// own before this process opens it.
#pragma once

#include <string>

namespace kiva_ros {

/// The argument, before a path, with which this program is that child process.
constexpr char kCheckBagOption[] = "--check-bag";

/// Checks a bag. Throws std::runtime_error with its fault and a remedy.
void checkBag(const std::string& path);

/// Checks a bag inside the child process: prints its fault to stdout and returns the exit code.
int checkBagHere(const std::string& path);

}  // namespace kiva_ros
