// SPDX-License-Identifier: Apache-2.0
//
// Restores damaged checkpoints. Each must be refused with a reason and the world unchanged, or be a
// valid world.
//
//   checkpoint_fuzz COUNT SEED SECONDS KEPT    stops after COUNT checkpoints or SECONDS of wall
//   time
// The present one is written to KEPT first, so that it survives a crash of the process.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "damaged_checkpoint.h"
#include "kiva_plugin_cpp/world_file.h"

namespace {

const kiva::ModelPaths kPaths{std::string(WORLDS_DIR) + "/models", TESTS_DIR "/worlds/models",
                              TESTS_DIR "/worlds"};
constexpr int kSteps = 20;

void command(kiva::World& world, kiva::test::CheckpointDamager& random) {
  kiva::Command command;
  command.kind = static_cast<kiva::Command::Kind>(random.below(5));
  command.kiva_id = 1 + static_cast<int>(random.below(4));
  command.x = static_cast<double>(random.below(7)) - 3;
  command.y = static_cast<double>(random.below(7)) - 3;
  command.direction = random.below(2) ? 1 : -1;
  command.lift = static_cast<int>(random.below(2));
  command.shelf_id = 1 + static_cast<int>(random.below(4));
  world.post(command);
}

/// Adds checkpoints of every world in a folder, at a few moments of its run.
void addSeeds(const char* folder, std::vector<std::string>* seeds) {
  kiva::test::CheckpointDamager random(1);
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".sdf") continue;
    try {
      std::vector<std::string> warnings;
      kiva::World world(kiva::loadWorld(entry.path(), kPaths, &warnings));
      for (int moment = 0; moment < 3; ++moment) {
        for (int i = 0; i < 400; ++i) {
          if (i % 50 == 0) command(world, random);
          world.step();
        }
        seeds->push_back(world.checkpoint());
      }
    } catch (const kiva::DescriptionError&) {
      // One checkpoint that must be refused.
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::cerr << "usage: checkpoint_fuzz COUNT SEED SECONDS KEPT\n";
    return 2;
  }
  const long count = std::atol(argv[1]);
  const std::chrono::duration<double> limit(std::atof(argv[3]));
  const auto start = std::chrono::steady_clock::now();
  kiva::test::CheckpointDamager damaged(std::strtoul(argv[2], nullptr, 10));
  std::vector<std::string> seeds;
  addSeeds(WORLDS_DIR, &seeds);
  addSeeds(TESTS_DIR "/worlds", &seeds);
  kiva::World world((kiva::WorldDescription()));
  long done = 0, restored = 0;
  for (; done < count && std::chrono::steady_clock::now() - start < limit; ++done) {
    const std::string bytes = damaged(seeds[damaged.below(seeds.size())]);
    std::ofstream(argv[4], std::ios::binary) << bytes;
    restored += kiva::test::restores(world, bytes, kSteps);
  }
  std::filesystem::remove(argv[4]);
  std::printf("%ld checkpoints, %ld of them restored\n", done, restored);
  if (done < count) std::cerr << "out of time after " << done << " of " << count << "\n";
  return done < count ? 1 : 0;
}
