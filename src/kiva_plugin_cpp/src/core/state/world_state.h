// SPDX-License-Identifier: Apache-2.0
//
// The state of a world in one place. The rooms above this one are functions over it; none includes
// one that stands behind it here, which scripts/check_includes holds them to:
//   sensing     scans, and what lies ahead
//   motion      wheels on the floor, references that are followed, until when a way is free
//   contact     who is stepped by Bullet and who in arrays, collisions, forces from outside
//   models      what comes and goes: robots, storage units, items, all else
//   control     what robots are asked for, and what becomes of it
//   checkpoint  all of it as bytes, and back
#pragma once

#include <array>
#include <deque>
#include <memory>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/geometry/obstacles.h"
#include "core/physics/physics.h"
#include "core/state/fleet_state.h"
#include "core/state/model.h"
#include "core/state/walker.h"
#include "kiva_plugin_cpp/world.h"

namespace kiva {

class FleetPlugin;
class Workers;

/// Two models in contact.
struct TouchingPair {
  int model_a = -1, model_b = -1;
  std::uint64_t last_step = 0;
  Impact impact;                  ///< So far, its normal from b to a.
  std::uint64_t tell_at = 0;      ///< The step at which it is told, if it is over; 0 = it has been.
  std::uint64_t tell_latest = 0;  ///< The step at which it is told, over or not.
};

/// A collision that was seen, and stops that robot.
struct Crash {
  int kiva_id = 0;
  std::string with;  ///< A model's name.
};

/// Something changed a storage unit's velocity at once.
struct Jolt {
  int unit = -1;   ///< A model's slot.
  Vector3 change;  ///< In world [m/s].
};

/// An item that slides off its storage unit, or lies on the floor since.
struct OffShelf {
  int item = -1, unit = -1;  ///< Models' slots.
  Vector3 velocity;   ///< With which it comes to the edge, as the unit moves then, in its frame.
  bool lies = false;  ///< It is a body of its own.
  std::uint64_t due = 0;  ///< The step at which it comes to the edge; or, if it lies, at which
                          ///< somebody picks it up, 0 = nobody does.
};

/// What is broken now.
struct Defect {
  int kiva_id = 0;
  Failure failure = Failure::kMotor;
  double left = 0;   ///< Until it is repaired [s]; +inf = until somebody does.
  RobotReport last;  ///< Of a lost radio: what was heard before.
};

struct FailureState {
  std::vector<Defect> defects;  ///< In the order in which they came.
  double exposure = 0;          ///< Until the next one by chance [robot seconds],
  std::uint64_t count = 0;      ///< which has been drawn so often.
};

/// Where robots are charged, in world [m].
struct Charger {
  double min_x = 0, max_x = 0, min_y = 0, max_y = 0;
};

class FloorCover;

/// A rectangle of the floor that grips otherwise than the rest, in world [m].
struct FloorPatch {
  double min_x = 0, max_x = 0, min_y = 0, max_y = 0;
  double friction = 0;  ///< Coulomb coefficient of its surface.

  bool has(double x, double y) const {
    return x >= min_x && x <= max_x && y >= min_y && y <= max_y;
  }
  bool meets(const FloorPatch& o) const {
    return o.min_x <= max_x && o.max_x >= min_x && o.min_y <= max_y && o.max_y >= min_y;
  }
};

/// A command on its way to its robot.
struct RadioMessage {
  std::uint64_t due = 0;  ///< The step, of all, at which it is there.
  Command command;
  FollowPath path;  ///< If it stands for one.
};

/// What a robot reports, on its way to who listens.
struct ReportMessage {
  std::uint64_t due = 0;     ///< The step, of all, at which it is there.
  std::uint64_t number = 0;  ///< In the order in which they were sent.
  int kiva_id = 0;
  RobotReport report;
};

/// Robots whose scans have the same period, by the step within it.
struct ScanRound {
  std::uint64_t period = 0;  // steps
  std::vector<std::vector<int>> robots_at;
};

struct WorldState {
  explicit WorldState(const WorldDescription& description, const WorldOptions& options);
  ~WorldState();

  World* owner = nullptr;
  std::string name;
  Vector3 gravity;
  WorldOptions options;
  Realism realism;                 // of the options, or of the first robot whose file has one
  bool realism_of_models = false;  // the latter
  double dt = 0.001;               // [s]
  double dt_since_time = 0;        // [s]: when the present step size began,
  std::uint64_t dt_since = 0;      // and after how many steps
  double grid_spacing = 1;         // [m]
  std::uint64_t steps = 0;         // since the last reset of time
  std::uint64_t total_steps = 0;   // ever; what schedules count by

  Physics physics;
  FleetState fleet;
  Obstacles obstacles{fleet};
  std::vector<StorageUnit> units;
  std::vector<Item> items;
  std::unordered_map<int, int> unit_of_id;

  std::vector<std::unique_ptr<Model>> models;  // by slot; null where one was removed
  std::vector<int> free_slots;
  std::unordered_map<std::string, int> slot_of_name;
  std::uint64_t next_serial = 0;
  std::uint64_t models_revision = 0;
  std::uint64_t units_revision = 0;
  std::vector<int> bodies;               // slots of models with bodies of their own that can move
  std::vector<int> models_with_plugins;  // slots
  std::vector<int> activated;            // slots of robots and units that are in Bullet now
  std::vector<RayFan> ray_fans;
  std::vector<ScanRound> scan_rounds;
  std::uint64_t scan_rounds_revision = ~0ull;  // of the models that scan_rounds were made for
  std::vector<int> scans_due;                  // robots whose scan is due at this step
  std::vector<int> stepped_singly;             // robots that are stepped one by one
  double top_speed = 0;                        // [m/s] of the fastest robot there was
  // Of robots without a load, by description; owned by those robots.
  std::unordered_map<const ModelDescription*, std::weak_ptr<const JointedBody>> bare_jointed;
  Floor floor;
  double floor_friction = 1;  // Coulomb coefficient of the floor's largest surface
  std::shared_ptr<const FloorCover> floor_parts;  // null where all surfaces grip alike
  bool floor_parts_due = true;            // floor or robots have changed since those were found
  std::vector<FloorPatch> floor_patches;  // where it is another one; later ones lie on top

  std::vector<std::shared_ptr<const FleetPlugin>> fleet_plugins;
  std::vector<std::shared_ptr<Plugin>> world_plugins;
  std::vector<PluginDescription> world_plugin_descriptions;  // of those

  std::deque<Command> commands;
  std::deque<FollowPath> paths;               // of those that are kFollow, in the same order
  std::deque<RadioMessage> on_air;            // in the order in which they come
  std::uint64_t radio_messages = 0;           // ever sent
  std::vector<ReportMessage> reports_on_air;  // a heap, the next to come first
  std::uint64_t reports = 0;                  // ever sent
  std::vector<int> to_report;  // ids of robots whose status has changed since the last step
  std::vector<Event> events;
  std::vector<StatusChange> status_changes;
  std::vector<TouchingPair> touching;
  std::vector<Contact> contacts;    // scratch
  std::vector<char> cruised;        // scratch: what is to be done for each block of robots
  std::vector<int> sighted;         // robots whose lasers looked ahead in the last step
  std::vector<Crash> crashes;       // of the last step
  std::vector<Jolt> jolts;          // of this step; scratch
  std::vector<OffShelf> off_shelf;  // in the order in which they began to slide
  std::uint32_t last_command = 0;   // the number of the command that was answered last
  ExternalInputs external_inputs;
  FailureState failures;
  std::vector<Walker> walkers;  // people, in the order in which they came
  std::vector<LightCurtain> curtains;
  bool keeps_off = false;  // somebody was there to keep from when robots looked last
  std::vector<Charger> chargers;
  std::uint64_t chargers_revision = ~0ull;  // of the models that these were found among
  std::shared_ptr<Workers> workers;
  std::vector<std::string> warnings;
  std::set<std::string> warned;

  /// A storage unit, or an item that lies on none, is somewhere else or changed hands.
  void unitsMoved() { ++units_revision; }
  /// Steps that last at least so long [s].
  std::uint64_t stepsIn(double seconds) const {
    return static_cast<std::uint64_t>(std::ceil(seconds / dt));
  }
  double time() const { return dt_since_time + static_cast<double>(steps - dt_since) * dt; }
  double gravityDown() const { return -gravity.Z(); }
  Model& modelOf(int robot) { return *models[fleet.robots[robot].model]; }
  const Model& modelOf(int robot) const { return *models[fleet.robots[robot].model]; }
  /// Of the item in that slot; null: it stands on its unit, or never did.
  const OffShelf* offShelf(int item) const {
    for (const OffShelf& one : off_shelf) {
      if (one.item == item) return &one;
    }
    return nullptr;
  }
  Model* find(const std::string& model) const {
    const auto at = slot_of_name.find(model);
    return at == slot_of_name.end() ? nullptr : models[at->second].get();
  }

  void report(Event::Kind kind, const std::string& model, const std::string& other,
              const std::string& text, const Impact& impact = {});
  /// The same of what became of a robot's command.
  void reportCommand(Event::Kind kind, int robot, const std::string& other,
                     const std::string& text);
  /// Tells what was left out, once for each `subject`.
  void warn(const std::string& subject, const std::string& text);
  /// The fleet takes in what of realism it drives by; anew for another step size.
  void applyRealism();
  /// Sets what the robot reports, and records it if it is new.
  void setStatus(int robot, Status status, State state);
};

/// The door for tests that look at what clients don't see.
WorldState& insideOf(World& world);
const WorldState& insideOf(const World& world);

}  // namespace kiva
