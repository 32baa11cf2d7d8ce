// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace kiva_ros {

/// Keeps checkpoints by name: in memory or, if the name ends in `.checkpoint`, as files of one
/// folder. For one thread at a time.
class CheckpointStore {
 public:
  /// `most_bytes`: limits the checkpoints in memory, and those in the folder.
  CheckpointStore(std::string folder, std::uintmax_t most_bytes);

  /// Saves a checkpoint whole or throws Refusal with the cause.
  void save(const std::string& name, std::string bytes);
  /// Returns a checkpoint. Throws Refusal with the cause if there is none.
  std::string load(const std::string& name) const;

 private:
  void saveFile(const std::string& name, const std::string& bytes) const;
  std::string loadFile(const std::string& name) const;
  std::uintmax_t inMemory() const;
  std::uintmax_t inFolder() const;

  const std::string folder_;
  const std::uintmax_t most_bytes_;
  std::map<std::string, std::string> by_name_;
};

}  // namespace kiva_ros
