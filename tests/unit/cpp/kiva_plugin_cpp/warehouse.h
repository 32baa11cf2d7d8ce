// SPDX-License-Identifier: Apache-2.0
//
// A test fixture: a warehouse with an empty floor, the real models, and short names for commands.
//
//   Warehouse w;
//   w.spawn("kiva", "kiva1", 0, 0);
//   w.movx(1, 5);
//   w.runUntilIdle(1);
//   EXPECT_NEAR(w.x(1), 5, 1e-3);
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "kiva_plugin_cpp/world.h"
#include "kiva_plugin_cpp/world_file.h"

namespace kiva {

/// Prints a state by name in gtest's messages.
inline void PrintTo(State state, std::ostream* out) {
  static const char* const names[] = {"IDLE",    "MOVING_X", "MOVING_Y", "ROTATING",
                                      "LIFTING", "BLOCKED",  "WAITING",  "STEERED"};
  *out << names[static_cast<int>(state)];
}
inline void PrintTo(Status status, std::ostream* out) {
  static const char* const names[] = {"IDLE", "BUSY", "BLOCKED"};
  *out << names[static_cast<int>(status)];
}

namespace test {

constexpr double kMillimetre = 0.001;              // [m]
constexpr double kHundredthDegree = M_PI / 18000;  // [rad]
constexpr double kQuarter = M_PI / 2;              // [rad]
constexpr int kLeft = 1, kRight = -1;              // of Warehouse::rot

inline const ModelPaths& modelPaths() {
  static const ModelPaths paths{std::string(WORLDS_DIR) + "/models"};
  return paths;
}

inline std::string fileText(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("can't read " + path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// `text` with every `from` replaced; that there is none is an error of the test.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("no '" + from + "' in the text");
  for (; at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// Returns `text` without all parts that begin with `first` and end with the next `last`.
inline std::string without(std::string text, const std::string& first, const std::string& last) {
  const std::size_t begin = text.find(first);
  if (begin == std::string::npos) throw std::logic_error("no '" + first + "' in the text");
  return text.erase(begin, text.find(last, begin) + last.size() - begin);
}

/// Predicate for EXPECT_PRED2, which prints both arguments.
inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Returns the SDF of a model of worlds/models: "kiva", "storage_unit", "item", "conveyor_belt",
/// "wall", "person".
inline std::string modelText(const std::string& kind) {
  return fileText(std::string(WORLDS_DIR) + "/models/" + kind + "/model.sdf");
}

/// Returns `text` with another value in `<key>`, wherever that has the same value as at its first
/// place.
inline std::string withParameter(const std::string& text, const std::string& key,
                                 const std::string& value) {
  const std::string open = "<" + key + ">", close = "</" + key + ">";
  for (std::size_t at = text.find(open); at != std::string::npos; at = text.find(open, at + 1)) {
    const std::size_t end = text.find('<', at + 1);
    if (text.compare(end, close.size(), close) != 0) continue;  // holds elements, no value
    return replaced(text, text.substr(at, end - at) + close, open + value + close);
  }
  throw std::logic_error("no value in a " + open + " in the text");
}

using Changes = std::vector<std::pair<std::string, std::string>>;

/// Returns the SDF of the Kiva with other parameters: kivaText({{"speed", "3"}, {"drive",
/// "jointed"}}).
inline std::string kivaText(const Changes& changes = {}) {
  std::string text = modelText("kiva");
  for (const auto& [key, value] : changes) text = withParameter(text, key, value);
  return text;
}

/// Returns `text` without the plugin of that name: "motion", "rotation", "lift" or "laser".
inline std::string withoutPlugin(const std::string& text, const std::string& plugin) {
  return without(text, "<plugin name=\"" + plugin + "\"", "</plugin>");
}

/// Returns `text` with `element`, such as a `<plugin>`, at the end of its model.
inline std::string withElement(const std::string& text, const std::string& element) {
  return replaced(text, "</model>", element + "</model>");
}

/// Returns the Kiva at the paper's instantaneous speed: no acceleration.
inline std::string abruptKiva() { return kivaText({{"acceleration", "0"}}); }

/// Returns a storage unit with that mass [kg].
inline std::string unitOfMass(double mass) {
  return withParameter(modelText("storage_unit"), "mass", std::to_string(mass));
}

/// Returns one model of SDF `text`, with another name and pose.
inline ModelInstance instance(const std::string& text, const std::string& name,
                              const Pose& pose = Pose::Zero) {
  ModelInstance model = parseModels(text, modelPaths(), "test").at(0);
  model.name = name;
  model.pose = pose;
  return model;
}

/// Returns the fault in the order of a robot's events; empty if each ACCEPTED has one end.
inline std::string disorder(const std::vector<Event::Kind>& kinds) {
  using Kind = Event::Kind;
  bool busy = false;
  for (Kind kind : kinds) {
    if (kind == Kind::kAccepted) {
      if (busy) return "a second ACCEPTED before the first one's end";
      busy = true;
    } else if (kind == Kind::kDone || kind == Kind::kBlocked) {
      if (!busy) return "an end without an ACCEPTED";
      busy = false;
    } else if ((kind == Kind::kLifted || kind == Kind::kDropped) && !busy) {
      return "LIFTED or DROPPED outside a command";
    } else if (kind == Kind::kDeleted) {
      busy = false;  // its command goes with a robot
    }
  }
  return busy ? "an ACCEPTED without an end" : "";
}

struct Floorplan {
  double size = 100;      ///< Edge of the square floor around the origin [m].
  double spacing = 1;     ///< Of the grid [m].
  double step = 0.001;    ///< [s]
  std::string more = "";  ///< SDF elements to add to the world: plugins, models.
  WorldOptions options = {};
};

inline std::string number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

inline std::string worldText(const Floorplan& plan) {
  std::string text = fileText(std::string(WORLDS_DIR) + "/empty.sdf");
  const std::string edge = number(plan.size);
  text = withParameter(text, "size", edge + " " + edge);
  text = withParameter(text, "spacing", number(plan.spacing));
  text = withParameter(text, "max_step_size", number(plan.step));
  return replaced(text, "</world>", plan.more + "</world>");
}

class Warehouse {
 public:
  explicit Warehouse(const Floorplan& plan = {})
      : world(parseWorld(worldText(plan), modelPaths(), "test"), plan.options) {}
  explicit Warehouse(const WorldDescription& description, const WorldOptions& options = {})
      : world(description, options) {}
  /// Loads the world of a file in worlds/.
  explicit Warehouse(const std::string& file)
      : world(loadWorld(std::string(WORLDS_DIR) + "/" + file, modelPaths())) {}

  World world;
  std::vector<Event> events;          ///< All so far.
  std::vector<StatusChange> changes;  ///< All so far.

  // --- models
  void spawn(const std::string& kind, const std::string& name, double x, double y, double yaw = 0,
             double z = 0) {
    spawnText(modelText(kind), name, x, y, yaw, z);
  }
  void spawnText(const std::string& text, const std::string& name, double x, double y,
                 double yaw = 0, double z = 0) {
    world.spawn(instance(text, name, Pose(x, y, z, 0, 0, yaw)));
  }

  // --- commands; each takes effect at the next step
  void mov(int id, double x, double y) { post(Command::Kind::kMoveTo, id, x, y); }
  void movx(int id, double distance) { post(Command::Kind::kMoveX, id, distance, 0); }
  void movy(int id, double distance) { post(Command::Kind::kMoveY, id, 0, distance); }
  void rot(int id, int direction) {
    Command command;
    command.kind = Command::Kind::kRotate;
    command.kiva_id = id;
    command.direction = direction;
    world.post(command);
  }
  void carry(int id, int shelf) { lift(id, 1, shelf); }
  void drop(int id, int shelf) { lift(id, 0, shelf); }
  void lift(int id, int status, int shelf) {
    Command command;
    command.kind = Command::Kind::kLift;
    command.kiva_id = id;
    command.lift = status;
    command.shelf_id = shelf;
    world.post(command);
  }

  // --- time
  void step() {
    world.step();
    collect();
  }
  /// Runs for `seconds` [s]; `each` is called after every step.
  void run(double seconds, const std::function<void()>& each = {}) {
    const auto steps = std::llround(seconds / world.stepSize());
    for (long long i = 0; i < steps; ++i) {
      step();
      if (each) each();
    }
  }
  /// Steps, once at least, until `done` is true. Returns the duration [s]; one longer than
  /// `deadline` fails the test.
  double runUntil(const std::function<bool()>& done, double deadline = 120,
                  const std::function<void()>& each = {}) {
    const std::uint64_t begin = world.steps();
    const auto elapsed = [&] { return (world.steps() - begin) * world.stepSize(); };
    do {
      step();
      if (each) each();
    } while (!done() && elapsed() < deadline);
    if (!done()) ADD_FAILURE() << "not done within " << deadline << " s";
    return elapsed();
  }
  double runUntilIdle(int id, double deadline = 120, const std::function<void()>& each = {}) {
    return runUntil([this, id] { return status(id) == Status::kIdle; }, deadline, each);
  }
  double runUntilState(int id, State expected, double deadline = 120) {
    return runUntil([this, id, expected] { return state(id) == expected; }, deadline);
  }
  /// Moves new events into `events` and `changes`.
  void collect() {
    for (Event& event : world.takeEvents()) events.push_back(std::move(event));
    for (StatusChange& change : world.takeStatusChanges()) changes.push_back(change);
  }
  void forget() {
    collect();
    events.clear();
    changes.clear();
  }

  // --- robots
  int index(int id) const {
    const int robot = world.fleet().find(id);
    if (robot < 0) throw std::logic_error("no kiva" + std::to_string(id));
    return robot;
  }
  double x(int id) const { return world.fleet().x[index(id)]; }
  double y(int id) const { return world.fleet().y[index(id)]; }
  double yaw(int id) const { return world.fleet().yaw[index(id)]; }
  double speed(int id) const {
    const int i = index(id);
    return std::hypot(world.fleet().vx[i], world.fleet().vy[i]);
  }
  double tower(int id) const { return world.fleet().tower[index(id)]; }
  Status status(int id) const { return world.fleet().status[index(id)]; }
  State state(int id) const { return world.fleet().state[index(id)]; }
  const Robot& robot(int id) const { return world.fleet().robots[index(id)]; }
  /// Returns the distance to the nearest grid point [m].
  double offGrid(int id) const { return std::hypot(offLine(x(id)), offLine(y(id))); }
  /// Returns the angle to the nearest multiple of 90° [rad].
  double offSquare(int id) const { return std::abs(std::remainder(yaw(id), kQuarter)); }
  void expectOnGrid(int id) const {
    EXPECT_LT(offGrid(id), kMillimetre) << "kiva" << id << " at " << x(id) << ", " << y(id);
    EXPECT_LT(offSquare(id), kHundredthDegree) << "kiva" << id << " at yaw " << yaw(id);
  }
  void expectAt(int id, double at_x, double at_y) const {
    EXPECT_LT(std::hypot(x(id) - at_x, y(id) - at_y), kMillimetre)
        << "kiva" << id << " at " << x(id) << ", " << y(id) << " and not " << at_x << ", " << at_y;
  }

  // --- storage units, by number
  const StorageUnit& unit(int id) const { return world.storageUnits()[unitIndex(id)]; }
  Pose unitPose(int id) const { return world.storageUnitPose(unitIndex(id)); }
  Pose itemPose(const std::string& name) const { return world.state(name)->pose; }
  /// Returns the id of the robot that carries it, 0 = none.
  int carrierOf(int unit_id) const {
    const int carrier = unit(unit_id).carrier;
    return carrier < 0 ? 0 : world.fleet().robots[carrier].id;
  }
  /// Returns the number of the unit that the robot carries, 0 = none.
  int loadOf(int id) const {
    const int carried = world.fleet().unit[index(id)];
    return carried < 0 ? 0 : world.storageUnits()[carried].id;
  }

  // --- what happened
  /// Returns the number of events of that kind; of one model only, if it is named.
  int count(Event::Kind kind, const std::string& model = "") const {
    int count = 0;
    for (const Event& e : events) count += e.kind == kind && (model.empty() || e.model == model);
    return count;
  }
  /// Returns the last event of that kind; an empty event if there was none.
  Event last(Event::Kind kind) const {
    for (auto e = events.rbegin(); e != events.rend(); ++e) {
      if (e->kind == kind) return *e;
    }
    return {-1, kind, "", "", "no such event"};
  }
  std::vector<Event::Kind> kindsOf(const std::string& model) const {
    std::vector<Event::Kind> kinds;
    for (const Event& e : events) {
      if (e.model == model) kinds.push_back(e.kind);
    }
    return kinds;
  }
  /// Returns the states that the robot reported, in order.
  std::vector<State> statesOf(int id) const {
    std::vector<State> states;
    for (const StatusChange& c : changes) {
      if (c.kiva_id == id) states.push_back(c.state);
    }
    return states;
  }
  /// Steps once and returns the reason of the refusal; empty if the command is accepted.
  std::string refusal() {
    const std::size_t before = events.size();
    step();
    for (std::size_t i = before; i < events.size(); ++i) {
      if (events[i].kind == Event::Kind::kRefused) return events[i].text;
    }
    return "";
  }

 private:
  void post(Command::Kind kind, int id, double x, double y) {
    Command command;
    command.kind = kind;
    command.kiva_id = id;
    command.x = x;
    command.y = y;
    world.post(command);
  }
  int unitIndex(int id) const {
    const auto& units = world.storageUnits();
    for (std::size_t i = 0; i < units.size(); ++i) {
      if (units[i].id == id) return static_cast<int>(i);
    }
    throw std::logic_error("no storage_unit" + std::to_string(id));
  }
  double offLine(double coordinate) const {
    return std::remainder(coordinate, world.gridSpacing());
  }
};

}  // namespace test
}  // namespace kiva
