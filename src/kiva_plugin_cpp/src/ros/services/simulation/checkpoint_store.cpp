// SPDX-License-Identifier: Apache-2.0
#include "ros/services/simulation/checkpoint_store.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <utility>

#include "ros/services/base/service_answer.h"

namespace kiva_ros {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestName = 100;
constexpr std::size_t kMostNames = 1000;
const std::string kSuffix = ".checkpoint";

bool isFile(const std::string& name) {
  return name.size() > kSuffix.size() &&
         name.compare(name.size() - kSuffix.size(), kSuffix.size(), kSuffix) == 0;
}

bool isFit(unsigned char c) { return c >= 0x80 || (std::isprint(c) && c != '/' && c != '\\'); }

/// Throws ServiceRefusal unless a name is a plain file name, which can't lead out of the folder.
void checkName(const std::string& name) {
  const bool fits = !name.empty() && name.size() <= kLongestName && name[0] != '.' &&
                    std::all_of(name.begin(), name.end(), isFit);
  if (fits) return;
  throw ServiceRefusal("'" + name.substr(0, kLongestName) + "' is not a name: up to " +
                       std::to_string(kLongestName) +
                       " characters without '/' were expected, that do not begin with '.'; with " +
                       kSuffix + " at its end it is a file");
}

void checkRoom(std::uintmax_t used, std::uintmax_t more, std::uintmax_t most,
               const std::string& where) {
  if (more <= most && used <= most - more) return;
  throw ServiceRefusal("there is no room for " + std::to_string(more) + " bytes: the checkpoints " +
                       where + " have " + std::to_string(used) + " of " + std::to_string(most) +
                       " already");
}

std::uintmax_t sizeOf(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(file, error))) return 0;
  const std::uintmax_t size = fs::file_size(file, error);
  return error ? 0 : size;
}

}  // namespace

CheckpointStore::CheckpointStore(std::string folder, std::uintmax_t most_bytes)
    : folder_(std::move(folder)), most_bytes_(most_bytes) {}

void CheckpointStore::save(const std::string& name, std::string bytes) {
  checkName(name);
  if (isFile(name)) return saveFile(name, bytes);
  const auto known = by_name_.find(name);
  const std::uintmax_t freed = known == by_name_.end() ? 0 : known->second.size();
  checkRoom(inMemory() - freed, bytes.size(), most_bytes_, "in memory");
  if (by_name_.size() >= kMostNames && known == by_name_.end()) {
    throw ServiceRefusal("there are " + std::to_string(kMostNames) + " checkpoints already");
  }
  by_name_[name] = std::move(bytes);
}

std::string CheckpointStore::load(const std::string& name) const {
  checkName(name);
  if (isFile(name)) return loadFile(name);
  const auto at = by_name_.find(name);
  if (at != by_name_.end()) return at->second;
  std::string known;
  for (const auto& [other, bytes] : by_name_) known += (known.empty() ? "" : ", ") + other;
  throw ServiceRefusal("there is no checkpoint '" + name + "'; there " +
                       (known.empty() ? "is none" : "are " + known));
}

/// Writes a file under a temporary name and renames it, so that readers never see an incomplete
/// file.
void CheckpointStore::saveFile(const std::string& name, const std::string& bytes) const {
  const fs::path path = fs::path(folder_) / name;
  const fs::path partial = path.string() + ".part";
  std::error_code error;
  fs::create_directories(folder_, error);
  checkRoom(inFolder() - sizeOf(path), bytes.size(), most_bytes_, "in " + folder_);
  fs::remove(partial, error);  // a link there must not be written through
  std::ofstream file(partial, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (file) {
    fs::rename(partial, path, error);
    if (!error) return;
  }
  fs::remove(partial, error);
  throw ServiceRefusal("can't write " + path.string());
}

std::string CheckpointStore::loadFile(const std::string& name) const {
  const fs::path path = fs::path(folder_) / name;
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(path, error))) {
    throw ServiceRefusal("there is no checkpoint " + path.string());
  }
  const std::uintmax_t size = sizeOf(path);
  checkRoom(0, size, most_bytes_, path.string());
  std::string bytes(size, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file.read(bytes.data(), static_cast<std::streamsize>(size))) {
    throw ServiceRefusal("can't read " + path.string());
  }
  return bytes;
}

std::uintmax_t CheckpointStore::inMemory() const {
  std::uintmax_t sum = 0;
  for (const auto& [name, bytes] : by_name_) sum += bytes.size();
  return sum;
}

std::uintmax_t CheckpointStore::inFolder() const {
  std::uintmax_t sum = 0;
  std::error_code error;
  for (const auto& file : fs::directory_iterator(folder_, error)) sum += sizeOf(file.path());
  return sum;
}

}  // namespace kiva_ros
