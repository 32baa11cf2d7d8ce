// SPDX-License-Identifier: Apache-2.0
#include "ros/services/models/package_uris.h"

#include <ros/package.h>

#include <cctype>
#include <map>

namespace kiva_ros {
namespace {

const std::string kScheme = "package://";

bool isName(const std::string& text) {
  for (const unsigned char c : text) {
    if (!std::isalnum(c) && c != '_' && c != '-') return false;
  }
  return !text.empty();
}

}  // namespace

std::string resolvePackageUris(const std::string& text) {
  std::string out;
  std::map<std::string, std::string> paths;  // each lookup crawls the file system
  std::size_t done = 0;
  for (std::size_t at = text.find(kScheme); at != std::string::npos;
       at = text.find(kScheme, at + 1)) {
    const std::size_t begin = at + kScheme.size();
    const std::size_t end = text.find_first_of("/\"'< ", begin);
    if (end == std::string::npos || text[end] != '/') continue;
    const std::string name = text.substr(begin, end - begin);
    if (!isName(name)) continue;
    const auto [path, is_new] = paths.try_emplace(name);
    if (is_new) path->second = ros::package::getPath(name);
    if (path->second.empty()) continue;
    out += text.substr(done, at - done) + path->second;
    done = end;
  }
  return out + text.substr(done);
}

}  // namespace kiva_ros
