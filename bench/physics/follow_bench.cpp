// SPDX-License-Identifier: Apache-2.0
//
// The cost of following a released path: N robots of worlds/models/kiva drive straight ahead in
// lanes of their own, by one long command, by a path that is released at once, and by one that is
// released cell by cell, in time. The three worlds take turns, a second each. Prints the CPU time
// of a step in each, commands and releases included, and the cost of the paths over the command.
//
//   follow_bench N…
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "chunks.h"
#include "kiva_plugin_cpp/world.h"
#include "kiva_plugin_cpp/world_file.h"

namespace {

constexpr int kColumns = 25;
constexpr int kCells = 33;            // cells that each drives
constexpr double kPitch[] = {36, 3};  // between robots along x and y [m]
constexpr int kSeconds = 20;          // simulated, while all are on their way
constexpr std::uint32_t kAhead = 3;   // points released beyond those reached: it never has to brake

enum class By { kCommand, kPath, kReleases };
constexpr const char* kNames[] = {"command", "path", "releases"};

class FollowLanes {
 public:
  FollowLanes(int robots, By by) : by_(by), released_(robots, kCells + 1) {
    kiva::WorldDescription empty =
        kiva::loadWorld(std::string(WORLDS_DIR) + "/empty.sdf", {WORLDS_DIR "/models"});
    for (auto& model : empty.models) growFloor(&model, robots);
    world_ = std::make_unique<kiva::World>(empty);
    const auto kiva =
        kiva::parseModels("<sdf version='1.9'><include><uri>model://kiva</uri></include></sdf>",
                          {WORLDS_DIR "/models"}, "bench");
    for (int i = 0; i < robots; ++i) {
      const kiva::Pose pose(x(i), y(i), 0, 0, 0, 0);
      world_->spawn({"kiva" + std::to_string(i + 1), pose, kiva.front().description});
      if (by_ == By::kReleases) released_[i] = kAhead + 1;
      start(i);
    }
  }

  /// Returns the CPU time that it took [s].
  double run(double seconds) {
    const long steps = std::lround(seconds / world_->stepSize());
    const double begin = bench::cpuTime();
    for (long s = 0; s < steps; ++s) {
      if (by_ == By::kReleases && s % 50 == 0) release();  // 20 Hz, as a coordinator may
      world_->step();
    }
    const double took = bench::cpuTime() - begin;
    for (const kiva::Event& event : world_->takeEvents()) {
      const bool is_wrong =
          event.kind == kiva::Event::Kind::kRefused || event.kind == kiva::Event::Kind::kBlocked;
      if (is_wrong) std::fprintf(stderr, "%s %s\n", event.model.c_str(), event.text.c_str());
    }
    world_->takeStatusChanges();
    return took;
  }

  double meanWay() const {
    double sum = 0;
    const kiva::Fleet& f = world_->fleet();
    for (int i = 0; i < f.size(); ++i) sum += f.x[i] - x(f.robots[i].id - 1);
    return sum / f.size();
  }

 private:
  static double x(int i) { return kPitch[0] * (i % kColumns) - 18 * kColumns; }
  static double y(int i) { return kPitch[1] * (i / kColumns) - 60; }

  static void growFloor(kiva::ModelInstance* model, int robots) {
    auto description = std::make_shared<kiva::ModelDescription>(*model->description);
    const double size = 40 * kColumns + 8.0 * robots / kColumns;
    for (kiva::Link& link : description->links) {
      for (kiva::Collision& collision : link.collisions) {
        collision.shape.plane_size[0] = collision.shape.plane_size[1] = size;
      }
    }
    model->description = description;
  }

  void start(int i) {
    if (by_ == By::kCommand) {
      kiva::Command command;
      command.kind = kiva::Command::Kind::kMoveX;
      command.kiva_id = i + 1;
      command.x = kCells;
      world_->post(command);
      return;
    }
    kiva::FollowPath path = update(i);
    for (int k = 0; k <= kCells; ++k) {
      path.x.push_back(x(i) + k);
      path.y.push_back(y(i));
    }
    world_->post(path);
  }

  kiva::FollowPath update(int i) const {
    kiva::FollowPath path;
    path.kiva_id = i + 1;
    path.path_id = 1;
    path.released = released_[i];
    return path;
  }

  void release() {
    const kiva::Fleet& f = world_->fleet();
    for (int k = 0; k < f.size(); ++k) {
      const int i = f.robots[k].id - 1;
      const std::uint32_t until = std::min<std::uint32_t>(kCells + 1, f.reached[k] + kAhead);
      if (until <= released_[i]) continue;
      released_[i] = until;
      world_->post(update(i));
    }
  }

  By by_;
  std::vector<std::uint32_t> released_;  // by id, from 0
  std::unique_ptr<kiva::World> world_;
};

void run(int robots) {
  std::vector<std::unique_ptr<FollowLanes>> worlds;
  for (By by : {By::kCommand, By::kPath, By::kReleases}) {
    worlds.push_back(std::make_unique<FollowLanes>(robots, by));
  }
  std::vector<std::vector<double>> took(worlds.size()), over(worlds.size());
  for (int second = 0; second < kSeconds; ++second) {
    for (std::size_t k = 0; k < worlds.size(); ++k) {
      took[k].push_back(worlds[k]->run(1));
      over[k].push_back(took[k].back() / took[0].back());
    }
  }
  std::printf("{\"robots\": %d", robots);
  for (std::size_t k = 0; k < worlds.size(); ++k) {
    std::printf(", \"%s\": {\"step_us\": %.1f, \"ratio\": %.3f, \"way_m\": %.3f}", kNames[k],
                1e3 * bench::median(took[k]), bench::median(over[k]), worlds[k]->meanWay());
  }
  std::printf("}\n");
}

}  // namespace

int main(int argc, char** argv) {
  const bench::Options options = bench::parse(argc, argv, "follow_bench N…\n");
  for (int robots : options.robots) run(robots);
}
