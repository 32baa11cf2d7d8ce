// SPDX-License-Identifier: Apache-2.0
// Steps a world for a simulated second; prints its time.
#include <cstdio>

#include "kiva_plugin_cpp/world.h"
#include "kiva_plugin_cpp/world_file.h"

int main(int, char** argv) {
  kiva::World world(kiva::loadWorld(argv[1], {argv[2]}));
  for (int i = 0; i < 1000; ++i) world.step();
  std::printf("%.3f\n", world.time());
}
