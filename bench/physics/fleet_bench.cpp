// SPDX-License-Identifier: Apache-2.0
//
// How fast the world is: N robots on a 3 m lattice inside walls, each driving a square of 1 m; 1 ms
// steps. Prints the real-time factor, the median of five chunks of simulated time. The robots are
//   default   the Kiva as it comes: 1.5 m/s, 1.0 m/s², a laser of 121 rays over 120°
//   at_once   of the bare arrays' workload: one second a side at 1 m/s, one second a quarter turn,
//             both at full speed at once; a laser of 20 rays over 180°, 5 m, 10 Hz
//   jointed   the same with wheel joints, as fast as they can
// Every scan is read, or with --unread none is; robots look ahead in any case.
//
//   fleet_bench [--robot default|at_once|jointed] [--unread | --no-lasers] [--threads=T]
//               [--seconds S] N…
#include <cmath>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "chunks.h"
#include "kiva_plugin_cpp/world.h"
#include "kiva_plugin_cpp/world_file.h"
#include "square.h"

namespace {

constexpr char kHelp[] =
    "fleet_bench [--robot default|at_once|jointed] [--unread | --no-lasers] [--threads=T] "
    "[--seconds S] N…\n";

const std::string kThreads = "--threads=";  // bare numbers are robots

// Parameters with which a jointed robot's square takes as long as the workload's.
const std::pair<const char*, const char*> kJointedChanges[] = {
    {"acceleration", "3.5"}, {"speed", "2.0"}, {"quarter_turn_time", "0.82"}};

struct Options : bench::Options {
  std::string robot = "default";
  bool read = true;  ///< Every scan that is due.
  int threads = 1;
};

Options parse(int argc, char** argv) {
  Options options;
  static_cast<bench::Options&>(options) = bench::parse(argc, argv, kHelp);
  const auto& words = options.others;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (words[k] == "--unread") {
      options.read = false;
    } else if (words[k] == "--robot" && k + 1 < words.size()) {
      options.robot = words[++k];
    } else if (words[k].rfind(kThreads, 0) == 0) {
      options.threads = std::atoi(words[k].c_str() + kThreads.size());
    } else {
      bench::usage(kHelp);
    }
  }
  const std::string& robot = options.robot;
  if (robot != "default" && robot != "at_once" && robot != "jointed") bench::usage(kHelp);
  return options;
}

std::string with(const std::string& text, const std::string& key, const std::string& value) {
  const std::regex element("<" + key + ">[^<]*</" + key + ">");
  return std::regex_replace(text, element, "<" + key + ">" + value + "</" + key + ">");
}

/// Returns the Kiva with the parameters of the bare arrays' workload.
std::string likeArrays(std::string text, const std::string& robot) {
  const std::pair<const char*, const char*> changes[] = {
      {"drive", robot == "jointed" ? "jointed" : "traction"},
      {"speed", "1.0"},
      {"quarter_turn_time", "1.0"},
      {"rays", "20"},
      {"rate", "10"},
      {"min_angle", "-1.5707963267948966"},
      {"max_range", "5.0"},
      {"max_angle", "1.5707963267948966"},
  };
  for (const auto& [key, value] : changes) text = with(text, key, value);
  if (robot == "at_once") return with(text, "acceleration", "0");
  // A body with mass can't reach full speed at once: 1.18 s a side, 0.82 s a turn.
  for (const auto& [key, value] : kJointedChanges) text = with(text, key, value);
  return text;
}

std::string robotText(const Options& options) {
  std::ifstream file(std::string(WORLDS_DIR) + "/models/kiva/model.sdf");
  std::ostringstream buffer;
  buffer << file.rdbuf();
  std::string text = buffer.str();
  if (options.robot != "default") text = likeArrays(std::move(text), options.robot);
  if (options.lasers) return text;
  const std::size_t begin = text.find("<plugin name=\"laser\"");
  return text.erase(begin, text.find("</plugin>", begin) + 9 - begin);
}

std::string floorAndWalls(double size) {
  std::ostringstream sdf;
  sdf << "<sdf version='1.9'><world name='bench'><model name='ground_plane'><static>true</static>"
      << "<link name='l'><collision name='c'><geometry><plane><normal>0 0 1</normal><size>" << size
      << " " << size << "</size></plane></geometry></collision></link></model>";
  const char* names[] = {"east", "west", "north", "south"};
  for (int i = 0; i < 4; ++i) {
    const double sign = i % 2 ? -1 : 1, at = sign * (size / 2 + 0.1);
    sdf << "<model name='wall_" << names[i] << "'><static>true</static><pose>" << (i < 2 ? at : 0)
        << " " << (i < 2 ? 0 : at) << " 0.5 0 0 " << (i < 2 ? 0 : M_PI / 2)
        << "</pose><link name='l'><collision name='c'><geometry><box><size>0.2 " << size
        << " 1</size></box></geometry></collision></link></model>";
  }
  sdf << "</world></sdf>";
  return sdf.str();
}

/// One robot's square: along its heading, then a quarter turn, four times.
class Squares {
 public:
  explicit Squares(int robots) : phase_(robots + 1, 0) {}

  /// Gives every robot that has become idle its next command.
  void command(kiva::World& world) {
    for (const kiva::StatusChange& change : world.takeStatusChanges()) {
      if (change.status == kiva::Status::kIdle) world.post(next(change.kiva_id));
    }
  }

 private:
  kiva::Command next(int kiva_id) {
    kiva::Command next;
    next.kiva_id = kiva_id;
    const int phase = phase_[kiva_id]++ % 8, side = phase / 2;
    if (phase % 2) {
      next.kind = kiva::Command::Kind::kRotate;
      next.direction = 1;
    } else {
      next.kind = side % 2 ? kiva::Command::Kind::kMoveY : kiva::Command::Kind::kMoveX;
      (side % 2 ? next.y : next.x) = side < 2 ? 1 : -1;
    }
    return next;
  }

  std::vector<int> phase_;  // by id
};

double meanSpeed(const kiva::Fleet& fleet) {
  double sum = 0;
  for (int i = 0; i < fleet.size(); ++i) sum += std::hypot(fleet.vx[i], fleet.vy[i]);
  return sum / fleet.size();
}

/// Takes every scan that is due, as a client that reads the lasers.
void readLasers(const kiva::World& world, std::vector<std::vector<float>>* ranges) {
  world.scan(world.scansDue(), ranges);
}

void spawn(kiva::World& world, const Options& options, int robots) {
  const auto description = kiva::parseModels(robotText(options), {}, "kiva").front().description;
  const bench::Lattice lattice(robots);
  for (int i = 0; i < robots; ++i) {
    const kiva::Pose pose(lattice.x(i), lattice.y(i), 0, 0, 0, 0);
    world.spawn({"kiva" + std::to_string(i + 1), pose, description});
  }
}

void run(const Options& options, int robots) {
  kiva::WorldOptions of_world;
  of_world.threads = options.threads;
  kiva::World world(kiva::parseWorld(floorAndWalls(bench::Lattice(robots).size()), {}, "bench"),
                    of_world);
  spawn(world, options, robots);
  Squares squares(robots);
  std::vector<std::vector<float>> ranges;
  double speed = 0;
  constexpr int kSample = 10;  // steps between two looks at the speed
  const long steps = std::lround(options.seconds / world.stepSize());
  const auto factors = bench::measure(options.seconds, [&] {
    for (long s = 0; s < steps; ++s) {
      squares.command(world);
      world.step();
      if (options.read && options.lasers) readLasers(world, &ranges);
      if (s % kSample == 0) {
        speed += kSample * meanSpeed(world.fleet()) / static_cast<double>(steps * bench::kChunks);
      }
    }
    world.takeEvents();
  });
  bench::print(options.robot, robots, options.lasers, factors,
               std::string(", \"read\": ") + (options.read ? "true" : "false") + ", \"threads\": " +
                   std::to_string(options.threads) + ", \"speed\": " + std::to_string(speed));
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = parse(argc, argv);
  for (int robots : options.robots) run(options, robots);
}
