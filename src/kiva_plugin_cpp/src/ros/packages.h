// SPDX-License-Identifier: Apache-2.0
//
// ROS packages by name, without a library for it.
#pragma once

#include <string>
#include <vector>

namespace kiva_ros {

/// The value of an environment variable; empty if it is not set.
std::string environment(const char* name);

/// A list of paths, with colons between them, in its parts.
std::vector<std::string> split(const std::string& list);

/// The folder of a package in ROS_PACKAGE_PATH: a folder with that name and a package.xml, at most
/// two levels deep. Empty if there is none.
std::string findPackage(const std::string& name);

/// A text with every `package://name/` of a package that is found written as its path.
std::string resolvePackages(const std::string& text);

}  // namespace kiva_ros
