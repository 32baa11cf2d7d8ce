// SPDX-License-Identifier: Apache-2.0
#include "listen_backlog.h"

#include <sys/socket.h>

#include <cstdlib>
#include <filesystem>

namespace kiva_ros {
namespace {

constexpr int kBacklog = 4096;

}  // namespace

void raiseListenBacklog() {
  for (const auto& file : std::filesystem::directory_iterator("/proc/self/fd")) {
    const int fd = std::atoi(file.path().filename().c_str());
    int is_listening = 0;
    socklen_t size = sizeof is_listening;
    if (getsockopt(fd, SOL_SOCKET, SO_ACCEPTCONN, &is_listening, &size) == 0 && is_listening) {
      listen(fd, kBacklog);
    }
  }
}

}  // namespace kiva_ros
