// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <vector>

namespace kiva {

/// The files that a description was read from, with their state at that time. A model that is
/// edited while the world runs is read again.
class FileStamps {
 public:
  FileStamps() = default;
  explicit FileStamps(const std::set<std::string>& files);
  bool areCurrent() const;

 private:
  struct Stamp {
    std::string file;
    long long changed = 0;  ///< [ns]
    long long size = 0;     ///< [byte]; negative: there is no such file.
  };
  static Stamp take(const std::string& file);
  std::vector<Stamp> stamps_;
};

}  // namespace kiva
