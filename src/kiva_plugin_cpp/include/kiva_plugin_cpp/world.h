// SPDX-License-Identifier: Apache-2.0
//
// The warehouse world: Bullet bodies, the fleet, storage units and items, stepped in lockstep.
//
//   kiva::World world(kiva::loadWorld("worlds/empty.sdf", {"worlds/models"}));
//   world.spawn(...); world.post(...); world.step();
//
// One thread at a time; nothing here knows of ROS, wall time or logging.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/command.h"
#include "kiva_plugin_cpp/description.h"
#include "kiva_plugin_cpp/external_inputs.h"
#include "kiva_plugin_cpp/fleet.h"
#include "kiva_plugin_cpp/odometry.h"
#include "kiva_plugin_cpp/people.h"
#include "kiva_plugin_cpp/realism.h"

namespace kiva {

class Plugin;
struct WorldState;

/// The role of a model in the warehouse. Its name decides (`kiva1`, `storage_unit1`, `item1`,
/// `conveyor_belt1`); a robot also has the motion plugin.
enum class ModelKind : std::uint8_t { kRobot, kStorageUnit, kItem, kBelt, kFloor, kOther };

struct Twist {
  Vector3 linear;   ///< [m/s], in world.
  Vector3 angular;  ///< [rad/s], in world.
};

struct EntityState {
  Pose pose;  ///< In world.
  Twist twist;
};

/// A storage unit. It stands on the floor, or on the tower of the robot that carries it.
struct StorageUnit {
  std::string name;
  int id = 0;
  int model = -1;
  double mass = 0;       ///< Mass with its items [kg].
  int carrier = -1;      ///< Index of the robot that carries it, -1 = none.
  int claimed_by = -1;   ///< Index of the robot that is about to lift it, -1 = none.
  Pose pose_on_carrier;  ///< In the carrier's tower frame, while it is carried.
  double raised = 0;     ///< Height by which it was raised at spawning, to stand on the floor [m].
};

/// An item. It is fixed to its storage unit, or a free body if no unit was there at its spawning.
struct Item {
  std::string name;
  int id = 0;
  int model = -1;
  int unit = -1;  ///< Index of its storage unit, -1 = none.
  Pose pose_in_unit;
  Pose spawn_pose_in_unit;  ///< Pose to which a reset puts the item.
  double mass = 0;          ///< [kg]
};

/// An item that fell off its storage unit.
struct FallenItem {
  std::string name;
  std::string unit;  ///< Name of the storage unit that it belongs to.
  Pose pose;         ///< In world.
};

/// The floor that robots may stand on: a rectangle along the axes of `world` [m].
struct FloorExtent {
  double min_x = 0, max_x = 0, min_y = 0, max_y = 0;
  double z = 0;  ///< Height of the floor.
};

/// The cells of the grid, and what keeps robots out of each. A cell is taken if a model that
/// belongs to no warehouse reaches into it, if a loaded robot that turns in it would hit such a
/// model, or if part of it is off the floor. In a world without a floor, all cells around its
/// models are taken.
struct Occupancy {
  double x = 0, y = 0;        ///< The first cell's grid point, of the lowest x and y [m].
  double z = 0;               ///< Height of the floor [m].
  double spacing = 1;         ///< Edge of a cell [m].
  int columns = 0, rows = 0;  ///< Cells along x and y.
  /// Row by row, x first: the greatest of the values below that applies to the cell.
  std::vector<std::uint8_t> cells;

  // Values of cells, like the percentages of a nav_msgs/OccupancyGrid.
  static constexpr std::uint8_t kFree = 0;
  static constexpr std::uint8_t kStorageUnit =
      50;  ///< A storage unit; robots without a load drive beneath.
  static constexpr std::uint8_t kBelt = 99;    ///< A conveyor belt; removed with its warehouse.
  static constexpr std::uint8_t kTaken = 100;  ///< Building, no floor, or too close to either.
};

/// The floor as robots' lasers see it: walls, belts, other static models, and the legs of storage
/// units where these stand now. Robots, people, items and what moves freely are left out.
struct LaserMap {
  double x = 0, y = 0;             ///< Corner of lowest x and y, in world [m].
  double z = 0;                    ///< Height of the floor.
  double resolution = 0;           ///< Edge of a cell [m].
  int columns = 0, rows = 0;       ///< Cells along x and y.
  std::vector<std::int8_t> cells;  ///< Row by row, x first.

  // Values of cells, as of a nav_msgs/OccupancyGrid.
  static constexpr std::int8_t kFree = 0;
  static constexpr std::int8_t kOccupied = 100;
  static constexpr std::int8_t kUnknown = -1;  ///< No floor.
};

constexpr double kLeastMapResolution = 0.01, kMostMapResolution = 1;  // [m]

/// One robot's status at the moment when it changed.
struct StatusChange {
  double time = 0;
  int kiva_id = 0;
  Status status = Status::kIdle;
  State state = State::kIdle;
  int shelf_id = 0;  ///< 0 = none.
  double x = 0, y = 0, yaw = 0;
};

/// A checkpoint that can't be restored; the message says why.
class CheckpointError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Properties and motor command of a joint.
struct JointSettings {
  double damping = 0;       ///< [Nm s/rad] or [N s/m], >= 0.
  double friction = 0;      ///< Dry friction [Nm] or [N], >= 0; without effect under a motor.
  double lower = -1e16;     ///< [rad] or [m].
  double upper = 1e16;      ///< [rad] or [m].
  double motor_speed = 0;   ///< [rad/s] or [m/s].
  double motor_effort = 0;  ///< Largest effort of the motor [Nm] or [N]; 0 = no motor.
};

/// The present state of a joint.
struct JointState {
  double position = 0;  ///< [rad], counting full turns, or [m].
  double rate = 0;      ///< [rad/s] or [m/s].
  JointSettings settings;
};

/// The wrench of a joint on its child link, about that link's origin, in world.
struct JointWrench {
  Vector3 force;   ///< [N]
  Vector3 torque;  ///< [Nm]
};

/// A point at which two collisions touch, in world. Names are `model::link::collision`.
struct ContactPoint {
  std::string collision1, collision2;
  Vector3 position;  ///< [m]
  Vector3 normal;    ///< Unit vector, from collision2 towards collision1.
  double depth = 0;  ///< Overlap of the two [m], >= 0.
  Vector3 force;     ///< On collision1, in the last step [N].
};

/// Makes the plugin with a file name, or returns null for an unknown name. `sensor` is the sensor
/// that the plugin sits in, null for a plugin of a model or a world; it outlives the plugin.
using PluginFactory = std::function<std::shared_ptr<Plugin>(const std::string& filename,
                                                            const SensorDescription* sensor)>;

struct WorldOptions {
  std::uint64_t seed = 1;      ///< Seed of everything random.
  std::optional<Drive> drive;  ///< Overrides the drive model that the robots' files name.
  /// Whether every robot is a Bullet body at all times: slow, a reference to test the arrays by.
  bool always_in_bullet = false;
  /// Number of threads that step robots, look ahead and scan, 1 to kMostThreads. The result is the
  /// same for every number. Steps use several threads only where periodic trials show that these
  /// are faster. A checkpoint does not keep the number.
  int threads = 1;
  /// Realism of all robots, in place of `<realism>` in their files. Without both, all is ideal.
  std::optional<Realism> realism;
  PluginFactory plugins;  ///< Asked before libraries are searched.
};

constexpr int kMostThreads = 256;

/// A running world. Its members are implemented in src/core by subject: `world.cpp` has the step,
/// `world_warehouse.cpp` reads robots, units and sensors, `world_robots.cpp` posts to robots and
/// people, `world_models.cpp` has models and links, `world_mechanics.cpp` joints and external
/// inputs, `world_history.cpp` checkpoints and events.
class World {
 public:
  /// Builds every model and plugin. Throws DescriptionError.
  explicit World(const WorldDescription& description, const WorldOptions& options = {});
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  // --- time and settings
  void step();
  double time() const;          ///< Simulated time [s] since the last reset of time.
  std::uint64_t steps() const;  ///< Steps since the last reset of time.
  double stepSize() const;      ///< [s]
  /// Sets the step size from the next step on. Throws std::invalid_argument unless it is 1e-6 to 1
  /// [s].
  void setStepSize(double seconds);
  const Vector3& gravity() const;  ///< [m/s²]
  /// Throws std::invalid_argument if gravity is not finite, or above 1000 m/s².
  void setGravity(const Vector3& gravity);
  std::uint64_t seed() const;  ///< Seed of everything random.
  /// Draws the random failures to come from another stream, such as after a checkpoint was restored
  /// in several worlds: each number gives another future, 0 the same.
  void drawFailuresAnew(std::uint64_t number);
  const Realism& realism() const;
  const std::string& name() const;
  /// Puts robots, units and items back to where they were spawned, at rest, towers down, without
  /// commands. Forces that clients apply end. With `time_too` the time goes back to 0.
  void reset(bool time_too);

  // --- the warehouse
  const Fleet& fleet() const;
  const std::vector<StorageUnit>& storageUnits() const;
  const std::vector<Item>& items() const;
  Pose storageUnitPose(int unit) const;  ///< In world.
  Pose itemPose(int item) const;         ///< In world.
  /// Returns the points at which the robot is still to turn or to stop. On a path, the last
  /// released point is among them, followed by the points that are not released yet.
  std::vector<PathPoint> pathAhead(int robot) const;
  /// Returns the pose that the robot believes to have: (x, y, yaw) in world [m, rad], yaw
  /// unwrapped. Robots drive by this pose. It is the true pose unless localisation is realistic.
  Vector3 believedPose(int robot) const;
  /// Returns the believed pose and the motion by the wheels, with covariances. A steered robot
  /// believes in the frame of its own odometry, whose origin is where it was handed over.
  Odometry odometry(int robot) const;
  /// Returns the largest acceleration at which the robot's load does not tip [m/s²]. It is +inf
  /// without a load, and if loads are ideal.
  double loadLimit(int robot) const;
  Pose basePose(int robot) const;  ///< Pose of the chassis, on the floor, in world.
  /// Returns a number that grows whenever a storage unit, or an item that lies on no unit, moves or
  /// changes its carrier.
  std::uint64_t unitsRevision() const;
  const FloorExtent& floor() const;
  Occupancy occupancy() const;
  /// Returns the map with cells of that size, or of the next centimetre with which it has at most
  /// 16 million. Throws std::invalid_argument unless the size is 0.01 to 1 [m].
  LaserMap laserMap(double resolution) const;
  double gridSpacing() const;  ///< [m]

  // --- commands
  /// Queues a command; an ACCEPTED or REFUSED event answers it at the next step.
  void post(const Command& command);
  /// Queues a path. A change of the path under way is answered only if it is refused.
  void post(FollowPath path);

  // --- robots that clients drive by velocities
  /// Hands an idle robot over to a client, which drives it by steer(). Throws
  /// std::invalid_argument with the reason if the robot is not idle, or can't drive.
  void beginSteering(int kiva_id);
  /// Asks a steered robot for a speed ahead [m/s] and a turn rate to the left [rad/s], for half a
  /// second or until the next call. Its accelerations are limited, and its laser stops it before
  /// obstacles. Throws std::invalid_argument, with nothing changed, if it is not steered, or if a
  /// number is not finite.
  void steer(int kiva_id, double speed, double turn_rate);
  /// Gives a steered robot back to the grid. Throws std::invalid_argument, with what to do, unless
  /// it stands on a grid point, along the grid.
  void endSteering(int kiva_id);
  bool isSteered(int robot) const;
  /// Returns the ids of the steered robots, in the order in which they were handed over.
  std::vector<int> steeredRobots() const;

  // --- what happened since the last call
  std::vector<Event> takeEvents();
  std::vector<StatusChange> takeStatusChanges();
  /// Returns warnings, each once, about parts that were left out, such as an unknown plugin.
  std::vector<std::string> takeWarnings();
  /// Adds a warning of a plugin.
  void warn(const std::string& warning);

  // --- sensing
  /// Writes one range a ray [m]. +inf is no return, -inf nearer than the minimum (REP 117), NaN a
  /// blind laser.
  void scan(int robot, std::vector<float>* ranges) const;
  /// Writes the ranges of several robots that have lasers, a row each, on the world's threads.
  void scan(const std::vector<int>& robots, std::vector<std::vector<float>>* ranges) const;
  /// Returns the robots whose scan is due at this step, in the fleet's order. Scans are staggered
  /// over the fleet. Valid until the next step, or until a robot is removed.
  const std::vector<int>& scansDue() const;
  /// Returns the distance [m] from a point in world to the first body that stands on the floor,
  /// along a horizontal ray in the direction `yaw`; +inf without one within `range`. The ray passes
  /// through the model `but`.
  double rayCast(const Vector3& from, double yaw, double range, const std::string& but = "") const;
  /// Writes distances [m] from a point in world along unit vectors to the first collision, the
  /// floor's included; +inf without one within `range`. Uses the world's threads; takes about 1 µs
  /// a ray.
  void rayCast(const Vector3& from, const std::vector<Vector3>& directions, double range,
               const std::string& but, std::vector<double>* ranges) const;
  /// Returns the present contacts of a model, which is the first of each pair.
  std::vector<ContactPoint> contacts(const std::string& model) const;

  // --- models
  /// Adds a model. Throws DescriptionError, with nothing changed, if the name is taken or unfit, if
  /// a plugin is unknown, or if a parameter is wrong.
  void spawn(const ModelInstance& instance);
  /// Adds all of these models, or throws and adds none.
  void spawn(const std::vector<ModelInstance>& instances);
  /// Removes a model. A unit that it carries is put down; the items of a unit go with the unit.
  /// Returns false if there is no such model.
  bool remove(const std::string& name);
  bool has(const std::string& name) const;
  /// Returns the names of all models, in the order in which they were added.
  std::vector<std::string> modelNames() const;
  ModelKind kind(const std::string& name) const;
  /// Returns a number that grows whenever a model is added or removed.
  std::uint64_t modelsRevision() const;
  /// Returns the state of a link, or of the model (with its canonical link's twist) if `link` is
  /// empty. Returns nothing if there is no such model or link.
  std::optional<EntityState> state(const std::string& model, const std::string& link = "") const;
  std::shared_ptr<const ModelDescription> description(const std::string& model) const;
  /// Moves a model, with everything fixed to it, and sets its velocity. Returns false if there is
  /// no such model. Throws DescriptionError if the state is not finite or out of bounds.
  bool setState(const std::string& model, const EntityState& state);
  /// Sets the velocity of a model of free bodies; the rates of its joints stay. Returns false if
  /// there is no such model. Throws DescriptionError if the velocity is not finite.
  bool setVelocity(const std::string& model, const Twist& twist);
  /// Moves a link, with everything that joints hold to it, and sets the link's velocity. Returns
  /// false if there is no such link. Throws as setState().
  bool setLinkState(const std::string& model, const std::string& link, const EntityState& state);
  /// Writes the states of all models, in the order of modelNames().
  void states(std::vector<EntityState>* out) const;
  /// Writes names (`model::link`) and states of all links, by model in the order of modelNames().
  void linkStates(std::vector<std::string>* names, std::vector<EntityState>* states) const;
  /// Sets mass, centre of mass, inertia and gravity flag of the link with that name. Returns false
  /// if there is no such link. Throws std::invalid_argument for an inertia that no body can have.
  bool setLinkInertia(const std::string& model, const Link& link);

  // --- joints
  /// Returns nothing if there is no such joint. A fixed joint is always at 0.
  std::optional<JointState> joint(const std::string& model, const std::string& joint) const;
  /// Returns the wrench of the last step, without dampers and applied efforts. Returns nothing if
  /// there is no such joint, or if its model has no free bodies.
  std::optional<JointWrench> jointWrench(const std::string& model, const std::string& joint) const;
  /// Returns false if there is no such joint. Throws std::invalid_argument for a number out of
  /// range, and for the joints of a robot, which its plugins drive.
  bool setJoint(const std::string& model, const std::string& joint, const JointSettings& settings);
  /// Sets positions of joints [rad] or [m], at rest; all that hangs on the joints moves along.
  /// Throws std::invalid_argument, with nothing changed; the message names the joint that can't
  /// take its position.
  void setJointPositions(const std::string& model, const std::map<std::string, double>& positions);

  // --- what clients apply
  const ExternalInputs& externalInputs() const;
  /// Applies a wrench in the next step only. Returns false if there is no such link, or if it is
  /// fixed.
  bool applyWrench(const std::string& model, const std::string& link, const Vector3& force,
                   const Vector3& torque);
  /// Applies a wrench or an effort for its period. Returns false if there is no such link or joint,
  /// or if it is fixed.
  bool apply(const Wrench& wrench);
  bool apply(const Effort& effort);
  void clearWrenches(const std::string& model, const std::string& link);
  void clearEfforts(const std::string& model, const std::string& joint);
  void setLight(const Light& light);  ///< Adds a light, or replaces the one of that name.
  bool removeLight(const std::string& name);
  void setOde(const OdeSettings& settings);

  // --- checkpoints
  /// Returns the whole state as bytes: time, models, motion, commands under way and pending, events
  /// not yet taken, and what plugins save. A world that restores these bytes goes on exactly as
  /// this one does, bit by bit, if both are given the same commands.
  std::string checkpoint() const;
  /// Turns this world into the one that was saved. Throws CheckpointError, with nothing changed, if
  /// the bytes are damaged or of another version, and DescriptionError if a plugin of a model can't
  /// be loaded.
  void restore(const std::string& checkpoint);
  /// Returns a hash of all that determines the future, without unanswered commands. Equal worlds
  /// have equal hashes.
  std::uint64_t stateHash() const;

  // --- people
  /// Makes a person walk along waypoints from now on. The person is an actor, or a static model no
  /// larger than a person; robots keep away from it. Without waypoints the person stays. People
  /// stop before obstacles, and walk around them where they can. Throws std::invalid_argument, with
  /// nothing changed, if there is no such model, if it can't be a person, or if a waypoint is not
  /// finite, off the floor, or asks for too high a speed.
  void walk(const std::string& person, const Walk& walk);
  /// Returns all people, in the order in which they were added.
  std::vector<Person> people() const;
  /// Adds a light curtain, or replaces the one of that name. Throws std::invalid_argument if it has
  /// no name, or if its edges are not finite or in the wrong order.
  void setLightCurtain(const LightCurtain& curtain);
  bool removeLightCurtain(const std::string& name);
  const std::vector<LightCurtain>& lightCurtains() const;

  // --- fallen items
  /// Returns fallen items, in the order in which they fell.
  std::vector<FallenItem> fallenItems() const;
  /// Puts a fallen item back into its place on its storage unit: PICKED_UP. Throws
  /// std::invalid_argument, with nothing changed, if the item did not fall, or if its unit does not
  /// stand upright.
  void pickUp(const std::string& item);

  // --- failures
  /// Makes a robot fail now: FAILED. The failure is repaired after `repair_after` [s], or by
  /// repair() if that is 0. A failure that the robot has already only gets a new time of repair.
  /// Throws std::invalid_argument for an unknown robot, and a time that is negative or not finite.
  void fail(int kiva_id, Failure failure, double repair_after);
  /// Repairs all failures of a robot now: REPAIRED for each. An empty battery is exchanged for a
  /// full one. Throws as fail().
  void repair(int kiva_id);
  /// Returns the last report of a robot whose radio is lost, and of every robot if reports go by
  /// radio. Returns nothing for a robot that reports without delay.
  std::optional<RobotReport> lastHeard(int robot) const;

  // --- modes of robots, stored for a coordinator
  /// Stores a robot's mode, as Fleet::mode. Throws std::invalid_argument if there is no such
  /// robot or no such mode.
  void keepMode(int kiva_id, int mode);

  // --- shadows of robots that are elsewhere
  /// Makes a robot the shadow of a robot elsewhere, such as one in a hall behind a broker, and
  /// moves it to the reported pose. A shadow takes no commands. Lasers see it, its load goes with
  /// it, and its state is the reported one. It stays a shadow until it is removed. Throws
  /// std::invalid_argument, with nothing changed, if there is no such robot or storage unit, if
  /// another robot carries the unit, or if a number is not finite.
  void shadow(int kiva_id, const ShadowReport& report);
  bool isShadow(int kiva_id) const;

  /// Gives access to the private state, for tests and parts of the world; see src/core/state.
  friend WorldState& insideOf(World& world);
  friend const WorldState& insideOf(const World& world);

 private:
  std::unique_ptr<WorldState> state_;
};

}  // namespace kiva
