// SPDX-License-Identifier: Apache-2.0
//
// The state of a world in one place. The modules beside this file are functions over it:
//   models      spawn, remove, read, set, reset
//   activation  who is stepped by Bullet and who in arrays
//   commands    what robots are asked for, and what becomes of it
//   load        storage units and items: carried, put down, where they are
//   sensing     scans, and what lies ahead
//   collisions  contacts that should not be
//   checkpoint  all of it as bytes, and back
//   joints      motors, damping and positions of ordinary models' joints
//   intervene   what clients apply for a while
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
#include "kiva_plugin_cpp/plugin.h"
#include "kiva_plugin_cpp/world.h"

namespace kiva {

class FleetPlugin;

/// One footprint of a model, and the shape it comes from.
struct CollisionGeometry {
  int link = 0;
  Pose pose_in_link;
  Shape shape;
  int handle = -1;    ///< In Obstacles; -1 for those of a robot and its load, which are a mover's.
  int triangle = -1;  ///< Of the mesh of a static model: each of them is one of these.
  std::shared_ptr<std::array<Vector3, 3>> corners = nullptr;  ///< Of that triangle, in world.
};

struct JointedBody;

/// What of a static model lies level at one height near the ground.
struct LevelSurface {
  double z = 0;                                                         ///< In world [m].
  double area = 0;                                                      ///< [m2]
  double min_x = 1e300, max_x = -1e300, min_y = 1e300, max_y = -1e300;  ///< In world [m].
  double friction = 1;
  bool is_plane = false;
};

struct Model {
  std::string name;
  ModelKind kind = ModelKind::kOther;
  std::shared_ptr<const ModelDescription> description;
  std::uint64_t serial = 0;  ///< Order of arrival.
  Pose spawn_pose;           ///< In world.
  Pose pose;                 ///< In world; of a model that has no body now.
  int index = -1;            ///< In the fleet, the storage units or the items, by kind.
  ModelBodies bodies;
  bool in_physics = false;         ///< Its bodies are in Bullet now.
  std::uint64_t active_until = 0;  ///< Step up to which something near keeps it in Bullet.
  bool disturbed = false;          ///< Touched since it was activated.
  std::shared_ptr<const JointedBody>
      jointed;  ///< Of a robot of that drive; made when it is asked for.
  std::vector<CollisionGeometry> geometries;
  std::vector<LevelSurface> level_surfaces;  ///< Of a static model.
  std::vector<std::shared_ptr<Plugin>> plugins;
  std::vector<JointState> joints;  ///< In the description's order; of a model with free bodies.
  std::string robot_namespace;     ///< What its plugins were told.

  bool isStatic() const { return description->is_static; }
};

/// Two models in contact.
struct TouchingPair {
  int model_a = -1, model_b = -1;
  std::uint64_t last_step = 0;
  Impact impact;                  ///< So far, its normal from b to a.
  std::uint64_t tell_at = 0;      ///< The step at which it is told, if it is over; 0 = it has been.
  std::uint64_t tell_latest = 0;  ///< The step at which it is told, over or not.
};

/// Directions of a laser's rays in the frame of its robot, as (cos, sin).
struct RayFan {
  int rays = 0;
  double min_angle = 0, max_angle = 0;  // [rad]
  std::vector<double> c, s;
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
  double dt = 0.001;              // [s]
  double dt_since_time = 0;       // [s]: when the present step size began,
  std::uint64_t dt_since = 0;     // and after how many steps
  double grid_spacing = 1;        // [m]
  std::uint64_t steps = 0;        // since the last reset of time
  std::uint64_t total_steps = 0;  // ever; what schedules count by

  Physics physics;
  Fleet fleet;
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
  double floor_friction = 1;  // Coulomb coefficient of the floor's surface

  std::vector<std::unique_ptr<FleetPlugin>> fleet_plugins;
  std::vector<std::shared_ptr<Plugin>> world_plugins;
  std::vector<PluginDescription> world_plugin_descriptions;  // of those

  std::deque<Command> commands;
  std::vector<Event> events;
  std::vector<StatusChange> status_changes;
  std::vector<TouchingPair> touching;
  std::vector<Contact> contacts;  // scratch
  ExternalInputs external_inputs;
  std::vector<std::string> warnings;
  std::set<std::string> warned;

  double time() const { return dt_since_time + static_cast<double>(steps - dt_since) * dt; }
  double gravityDown() const { return -gravity.Z(); }
  Model& modelOf(int robot) { return *models[fleet.robots[robot].model]; }
  const Model& modelOf(int robot) const { return *models[fleet.robots[robot].model]; }
  Model* find(const std::string& model) const {
    const auto at = slot_of_name.find(model);
    return at == slot_of_name.end() ? nullptr : models[at->second].get();
  }

  void report(Event::Kind kind, const std::string& model, const std::string& other,
              const std::string& text, const Impact& impact = {});
  /// Tells what was left out, once for each `subject`.
  void warn(const std::string& subject, const std::string& text);
  /// Sets what the robot reports, and records it if it is new.
  void setStatus(int robot, Status status, State state);
};

/// The door for tests that look at what clients don't see.
WorldState& insideOf(World& world);
const WorldState& insideOf(const World& world);

}  // namespace kiva
