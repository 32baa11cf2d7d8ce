// SPDX-License-Identifier: Apache-2.0
#include "server_socket.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <cstdlib>
#include <filesystem>

namespace kiva_ros {
namespace {

constexpr int kBacklog = 4096;

bool isListening(int fd) {
  int out = 0;
  socklen_t size = sizeof out;
  return getsockopt(fd, SOL_SOCKET, SO_ACCEPTCONN, &out, &size) == 0 && out;
}

}  // namespace

void tuneServerSocket() {
  for (const auto& file : std::filesystem::directory_iterator("/proc/self/fd")) {
    const int fd = std::atoi(file.path().filename().c_str());
    if (!isListening(fd)) continue;
    listen(fd, kBacklog);
    const int on = 1;  // accepted connections inherit it
    setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  }
}

}  // namespace kiva_ros
