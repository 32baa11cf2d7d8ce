// SPDX-License-Identifier: Apache-2.0
#include "bag_check.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace kiva_ros {
namespace {

constexpr rlim_t kMostMemory = 8ULL << 30;           // [bytes]
constexpr rlim_t kLeastTime = 30;                    // [s] of processor time
constexpr std::uintmax_t kBytesPerSecond = 4000000;  // minimum rate of reading

void limit(int resource, rlim_t value) {
  const rlimit both{value, value};
  setrlimit(resource, &both);
}

/// Runs the check and returns its exit status as waitpid has it; appends its output to `said`.
int runCheck(const std::string& path, std::string* said) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe for the check of " + path);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addclose(&actions, ends[0]);
  std::vector<std::string> words = {"kiva_world_node", kCheckBagOption, path};
  char* arguments[] = {words[0].data(), words[1].data(), words[2].data(), nullptr};
  pid_t child = 0;
  const int failed = posix_spawn(&child, "/proc/self/exe", &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  char buffer[4096];
  for (ssize_t size; !failed && (size = read(ends[0], buffer, sizeof buffer)) > 0;) {
    said->append(buffer, static_cast<std::size_t>(size));
  }
  close(ends[0]);
  int status = 0;
  if (failed || waitpid(child, &status, 0) < 0) {
    throw std::runtime_error("no process for the check of " + path);
  }
  return status;
}

}  // namespace

void checkBag(const std::string& path) {
  const std::string cannot = "can't replay " + path + ": ";
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw std::runtime_error(cannot + "there is no such file");
  }
  std::string said;
  const int status = runCheck(path, &said);
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
  if (said.empty()) said = "it is damaged";
  throw std::runtime_error(cannot + said + ". If it was cut off or damaged, 'rosbag reindex " +
                           path + "' may save what is whole");
}

int checkBagHere(const std::string& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  limit(RLIMIT_AS, kMostMemory);
  limit(RLIMIT_CPU, kLeastTime + size / kBytesPerSecond);
  limit(RLIMIT_CORE, 0);
  try {
    rosbag::Bag bag(path, rosbag::bagmode::Read);
    std::vector<std::uint8_t> bytes;
    for (const rosbag::MessageInstance& message : rosbag::View(bag)) {
      bytes.resize(message.size());
      ros::serialization::OStream stream(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
      message.write(stream);
    }
    return 0;
  } catch (const std::exception& error) {
    std::printf("%s", error.what());
    return 1;
  }
}

}  // namespace kiva_ros
