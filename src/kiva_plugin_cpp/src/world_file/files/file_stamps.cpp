// SPDX-License-Identifier: Apache-2.0
#include "world_file/files/file_stamps.h"

#include <sys/stat.h>

#include <algorithm>

namespace kiva {

FileStamps::FileStamps(const std::set<std::string>& files) {
  for (const std::string& file : files) stamps_.push_back(take(file));
}

bool FileStamps::areCurrent() const {
  return std::all_of(stamps_.begin(), stamps_.end(), [](const Stamp& then) {
    const Stamp now = take(then.file);
    return now.changed == then.changed && now.size == then.size;
  });
}

FileStamps::Stamp FileStamps::take(const std::string& file) {
  struct stat status {};
  if (stat(file.c_str(), &status) != 0) return {file, 0, -1};
  const long long changed = status.st_mtim.tv_sec * 1000000000LL + status.st_mtim.tv_nsec;
  return {file, changed, static_cast<long long>(status.st_size)};
}

}  // namespace kiva
