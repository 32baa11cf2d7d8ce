// SPDX-License-Identifier: Apache-2.0
//
// The speed of a whole warehouse, in-process: every robot under random commands, lifts included.
//
//   bench/physics/warehouse huge > huge.sdf; warehouse_bench [--scans] [--seconds S] [--chunks N]
//   huge.sdf
#include <cstdio>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "chunks.h"
#include "core/state/places/poses.h"
#include "core/state/world_state.h"
#include "kiva_plugin_cpp/world.h"
#include "kiva_plugin_cpp/world_file.h"
#include "random_commands.h"

namespace {

constexpr char kHelp[] =
    "warehouse_bench [--scans] [--seconds S] [--chunks N] WAREHOUSE.sdf\n"
    "  --scans    every laser scan that is due is read; else robots look as they need to\n"
    "  --seconds  of simulated time a chunk (5)\n"
    "  --chunks   that are simulated before those that are measured (1)\n";
constexpr int kStepsPerLook = 10;  // between two looks at what happened

/// The names of the counts, in the order of kiva::Event::Kind.
constexpr const char* kEventNames[] = {"accepted", "refused",   "done",    "blocked", "lifted",
                                       "dropped",  "collision", "spawned", "deleted", "lost",
                                       "failed",   "repaired",  "tipped",  "fell",    "picked_up"};
static_assert(std::size(kEventNames) == kiva::Event::kKinds, "each kind of event has a name");

struct Options {
  bool scans = false;
  double seconds = 5;
  int chunks = 1;
  std::string file;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--scans") {
      options.scans = true;
    } else if (word == "--seconds" && i + 1 < argc) {
      options.seconds = std::atof(argv[++i]);
    } else if (word == "--chunks" && i + 1 < argc) {
      options.chunks = std::atoi(argv[++i]);
    } else {
      options.file = word;
    }
  }
  if (options.file.empty() || !(options.seconds > 0)) bench::usage(kHelp);
  return options;
}

std::string read(const std::string& path) {
  std::ifstream file(path);
  if (!file) {
    std::fprintf(stderr, "warehouse_bench: %s can't be read\n", path.c_str());
    std::exit(1);
  }
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Commands every idle robot, as a client does: by the events.
class Dispatcher {
 public:
  explicit Dispatcher(const kiva::World& world) : commands_(1) {
    for (std::size_t u = 0; u < world.storageUnits().size(); ++u) {
      const kiva::Pose pose = world.storageUnitPose(static_cast<int>(u));
      commands_.standsAt(world.storageUnits()[u].id, pose.X(), pose.Y());
    }
  }

  void dispatch(kiva::World& world) {
    for (const kiva::Event& event : world.takeEvents()) note(world, event);
    world.takeStatusChanges();
    const kiva::Fleet& fleet = world.fleet();
    for (int i = 0; i < fleet.size(); ++i) {
      if (fleet.status[i] == kiva::Status::kIdle) world.post(commands_.next(waiting(world, i)));
    }
  }

  std::string counts() const {
    std::string out;
    for (const auto& [kind, count] : counts_) {
      const char* name = kEventNames[static_cast<int>(kind)];
      out += std::string(", \"") + name + "\": " + std::to_string(count);
    }
    return out;
  }

 private:
  static bench::Waiting waiting(const kiva::World& world, int i) {
    const kiva::Fleet& f = world.fleet();
    const int unit = f.unit[i];
    return {f.robots[i].id, f.x[i], f.y[i], unit < 0 ? 0 : world.storageUnits()[unit].id};
  }

  void note(const kiva::World& world, const kiva::Event& event) {
    ++counts_[event.kind];
    const bool lifted = event.kind == kiva::Event::Kind::kLifted;
    if (!lifted && event.kind != kiva::Event::Kind::kDropped) return;
    const auto state = world.state(event.other);
    if (!state) return;
    const double x = state->pose.Pos().X(), y = state->pose.Pos().Y();
    const int id = std::atoi(event.other.c_str() + event.other.find_first_of("0123456789"));
    lifted ? commands_.liftedAt(x, y) : commands_.standsAt(id, x, y);
  }

  bench::RandomCommands commands_;
  std::map<kiva::Event::Kind, long> counts_;
};

/// Shares of robots in a hundred that have a command, and that Bullet steps; and the number of
/// storage units in Bullet, awake, and fallen over.
class Shares {
 public:
  void add(const kiva::World& world) {
    const kiva::WorldState& inside = insideOf(world);
    const kiva::FleetState& fleet = inside.fleet;
    ++looks_;
    robots_ += fleet.size();
    for (int i = 0; i < fleet.size(); ++i) {
      busy_ += fleet.status[i] != kiva::Status::kIdle;
      in_bullet_ += fleet.activated[i];
    }
    for (int slot : inside.models.activated) {
      const kiva::Model& model = *inside.models[slot];
      if (model.kind != kiva::ModelKind::kStorageUnit) continue;
      units_ += 1;
      awake_ += isAwake(model);
      const double up = canonicalState(model).pose.Rot().ZAxis().Z();
      tilted_ += up < kTilted;
      fallen_ += up < kFallen;
    }
  }

  std::string text() const {
    char text[200];
    std::snprintf(text, sizeof text,
                  ", \"busy\": %.3f, \"in_bullet\": %.3f, \"units_in_bullet\": %.1f, "
                  "\"units_awake\": %.1f, \"units_tilted\": %.1f, \"units_fallen\": %.1f",
                  busy_ / robots_, in_bullet_ / robots_, units_ / looks_, awake_ / looks_,
                  tilted_ / looks_, fallen_ / looks_);
    return text;
  }

 private:
  static constexpr double kTilted = 0.99985, kFallen = 0.9;  // cosines: 1° and 26°

  double looks_ = 0, robots_ = 0, busy_ = 0, in_bullet_ = 0;
  double units_ = 0, awake_ = 0, tilted_ = 0, fallen_ = 0;
};

void readScans(const kiva::World& world, std::vector<float>* ranges) {
  for (int i : world.scansDue()) world.scan(i, ranges);
}

void run(const Options& options) {
  kiva::World world(kiva::WorldDescription{});
  world.spawn(kiva::parseModels(read(options.file), {WORLDS_DIR "/models"}, options.file));
  world.takeEvents();
  Dispatcher dispatcher(world);
  std::vector<float> ranges;
  const long steps = std::lround(options.seconds / world.stepSize());
  const auto chunk = [&](Shares* all) {
    Shares shares;
    const double begin = bench::cpuTime();
    for (long s = 0; s < steps; ++s) {
      if (s % kStepsPerLook == 0) {
        dispatcher.dispatch(world);
        shares.add(world);
        all->add(world);
      }
      world.step();
      if (options.scans) readScans(world, &ranges);
    }
    const double factor = options.seconds / (bench::cpuTime() - begin);
    std::fprintf(stderr, "  simulated %.0f s: RTF %.2f%s\n", world.time(), factor,
                 shares.text().c_str());
  };
  Shares before, shares;
  // From the start, where all stand still, to how a warehouse is.
  for (int i = 0; i < options.chunks; ++i) chunk(&before);
  const auto factors = bench::measure(options.seconds, [&] { chunk(&shares); });
  bench::print("warehouse", world.fleet().size(), options.scans, factors,
               shares.text() + dispatcher.counts());
}

}  // namespace

int main(int argc, char** argv) try {
  run(parse(argc, argv));
} catch (const std::exception& error) {
  std::fprintf(stderr, "warehouse_bench: %s\n", error.what());
  return 1;
}
