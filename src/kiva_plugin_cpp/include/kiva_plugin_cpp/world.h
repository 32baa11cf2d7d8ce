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
#include "kiva_plugin_cpp/people.h"
#include "kiva_plugin_cpp/realism.h"

namespace kiva {

class Plugin;
struct WorldState;

/// What a model is to the warehouse; told by its name (`kiva1`, `storage_unit1`, `item1`,
/// `conveyor_belt1`) and, for robots, by the motion plugin.
enum class ModelKind : std::uint8_t { kRobot, kStorageUnit, kItem, kBelt, kFloor, kOther };

struct Twist {
  Vector3 linear;   ///< [m/s], in world.
  Vector3 angular;  ///< [rad/s], in world.
};

struct EntityState {
  Pose pose;  ///< In world.
  Twist twist;
};

/// A storage unit: stands on the floor, or on the tower of its carrier.
struct StorageUnit {
  std::string name;
  int id = 0;
  int model = -1;
  double mass = 0;       ///< With its items [kg].
  int carrier = -1;      ///< Index of the robot that carries it, -1 = none.
  int claimed_by = -1;   ///< Index of the robot that is about to, -1 = none.
  Pose pose_on_carrier;  ///< In the carrier's tower frame, while it is carried.
  double raised = 0;     ///< How much higher than asked for it was put, to stand on the floor [m].
};

/// An item: fixed to its storage unit, or a body of its own where no unit was when it came.
struct Item {
  std::string name;
  int id = 0;
  int model = -1;
  int unit = -1;  ///< Index of its storage unit, -1 = none.
  Pose pose_in_unit;
  Pose spawn_pose_in_unit;  ///< Where a reset puts it.
  double mass = 0;          ///< [kg]
};

/// An item that fell off its storage unit, and belongs back there.
struct FallenItem {
  std::string name;
  std::string unit;  ///< Its storage unit's name.
  Pose pose;         ///< In world.
};

/// The floor that robots may stand on: a rectangle along the axes of `world` [m].
struct Floor {
  double min_x = 0, max_x = 0, min_y = 0, max_y = 0;
  double z = 0;  ///< Its height.
};

/// Which cells of the grid are in the way of robots: those where a model that belongs to no
/// warehouse reaches in, or would be hit by a loaded robot that turns there, and those that are not
/// on the floor as a whole. Where there is no floor, all around what stands there are taken.
struct Occupancy {
  double x = 0, y = 0;        ///< The first cell's grid point, of the lowest x and y [m].
  double z = 0;               ///< Of the floor [m].
  double spacing = 1;         ///< Edge of a cell [m].
  int columns = 0, rows = 0;  ///< Cells along x and y.
  /// Row by row, x first: what is in the way there, the worst of it.
  std::vector<std::uint8_t> cells;

  // Of a cell. Like the percentages of a nav_msgs/OccupancyGrid.
  static constexpr std::uint8_t kFree = 0;
  static constexpr std::uint8_t kStorageUnit = 50;  ///< Robots without a load pass beneath.
  static constexpr std::uint8_t kBelt = 99;         ///< It goes when its warehouse does.
  static constexpr std::uint8_t kTaken = 100;       ///< By the building; no floor; or too near.
};

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

/// What a joint is like, and what its motor is asked for.
struct JointSettings {
  double damping = 0;       ///< [Nm s/rad] or [N s/m], >= 0.
  double friction = 0;      ///< Dry friction [Nm] or [N], >= 0; a motor takes its place.
  double lower = -1e16;     ///< [rad] or [m].
  double upper = 1e16;      ///< [rad] or [m].
  double motor_speed = 0;   ///< [rad/s] or [m/s].
  double motor_effort = 0;  ///< The most that the motor may use [Nm] or [N]; 0 = no motor.
};

/// A joint as it is now.
struct JointState {
  double position = 0;  ///< [rad], counting full turns, or [m].
  double rate = 0;      ///< [rad/s] or [m/s].
  JointSettings settings;
};

/// What a joint does to its child link, about that link's origin, in world.
struct JointWrench {
  Vector3 force;   ///< [N]
  Vector3 torque;  ///< [Nm]
};

/// A point at which two collisions touch. Names are `model::link::collision`; in world.
struct ContactPoint {
  std::string collision1, collision2;
  Vector3 position;  ///< [m]
  Vector3 normal;    ///< Unit vector, from the second towards the first.
  double depth = 0;  ///< How far they overlap [m], >= 0.
  Vector3 force;     ///< On the first, in the last step [N].
};

/// Makes the plugin of that file name, or null if it knows none. `sensor`: the one that it sits
/// in, null for a plugin of a model or a world; it lives as long as the plugin.
using PluginFactory = std::function<std::shared_ptr<Plugin>(const std::string& filename,
                                                            const SensorDescription* sensor)>;

struct WorldOptions {
  std::uint64_t seed = 1;      ///< Of everything random.
  std::optional<Drive> drive;  ///< Overrides the drive model that the robots' files name.
  /// Every robot is a Bullet body at all times, slowly: the reference that the arrays are held to.
  bool always_in_bullet = false;
  /// On which robots are stepped, look ahead and scan, with the same result however many there are;
  /// 1 to kMostThreads. A checkpoint keeps to those of the world that restores it.
  int threads = 1;
  /// Of all robots, in place of what their files say in `<realism>`; without either, all is ideal.
  std::optional<Realism> realism;
  PluginFactory plugins;  ///< Asked before libraries are looked for.
};

constexpr int kMostThreads = 256;

class World {
 public:
  /// Builds every model and plugin. Throws DescriptionError.
  explicit World(const WorldDescription& description, const WorldOptions& options = {});
  ~World();
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  // --- time
  void step();
  double time() const;          ///< Simulated [s], since the last reset of time.
  std::uint64_t steps() const;  ///< Since then.
  double stepSize() const;      ///< [s]
  /// From the next step on; throws std::invalid_argument unless 1e-6 <= seconds <= 1.
  void setStepSize(double seconds);
  const Vector3& gravity() const;  ///< [m/s²]
  /// Throws std::invalid_argument if it is not finite or above 1000 m/s².
  void setGravity(const Vector3& gravity);
  std::uint64_t seed() const;  ///< Of everything random.
  const Realism& realism() const;
  const std::string& name() const;
  /// Puts everything back to where it was spawned, at rest, tower down, without commands; units and
  /// items too. What clients apply ends. Time goes back to 0 as well if `time_too`.
  void reset(bool time_too);

  // --- commands
  /// Queues a command; an ACCEPTED or REFUSED event answers it at the next step.
  void post(const Command& command);
  /// The same, in one row with those; a change of the path under way is only answered if it is
  /// refused.
  void post(FollowPath path);

  // --- failures
  /// Breaks something in a robot now: FAILED. `repair_after` [s]; 0 = until repair() is called.
  /// What is broken already is repaired then instead. Throws std::invalid_argument if there is no
  /// such robot, or the time is negative or not finite.
  void fail(int kiva_id, Failure failure, double repair_after);
  /// Repairs all that is broken in a robot: REPAIRED for each, before its time. An empty battery is
  /// exchanged for a full one. Throws as fail().
  void repair(int kiva_id);
  /// What was heard last of a robot whose radio is lost, and of every robot where reports go by
  /// radio; nothing of one that is heard at once.
  std::optional<RobotReport> lastHeard(int robot) const;

  // --- modes of robots
  /// Stores a robot's mode, as Fleet::mode. Throws std::invalid_argument if there is no such
  /// robot or no such mode.
  void keepMode(int kiva_id, int mode);

  // --- shadows of robots that are elsewhere
  /// Puts a robot where another one is that it is the shadow of: in a hall, behind a broker. From
  /// the first report on it takes no commands, since others answer them: lasers see it, its load
  /// goes with it, and it tells what it is told. Ends when the robot is removed. Throws
  /// std::invalid_argument, with nothing changed, if there is no such robot or storage unit, another
  /// robot carries the unit, or a number is not finite.
  void shadow(int kiva_id, const ShadowReport& report);
  bool isShadow(int kiva_id) const;

  // --- people
  /// Makes a person walk that way from now on: an actor, or a static model that is no larger than a
  /// person, which is one from then on: robots keep away from people. Without waypoints they stay
  /// where they are. They stop before what is in their way, and walk around it where they can.
  /// Throws std::invalid_argument, with nothing changed, if there is no such model, it is no
  /// person, or a waypoint is not finite, off the floor, or to be reached too fast.
  void walk(const std::string& person, const Walk& walk);
  /// Returns them in the order in which they were added.
  std::vector<Person> people() const;
  /// A new one, or in place of the one of that name. Throws std::invalid_argument if it has no
  /// name, or its edges are not finite or in the wrong order.
  void setLightCurtain(const LightCurtain& curtain);
  bool removeLightCurtain(const std::string& name);
  const std::vector<LightCurtain>& lightCurtains() const;

  // --- fallen items
  /// Returns them in the order in which they fell.
  std::vector<FallenItem> fallenItems() const;
  /// Puts an item that fell back in its place on its storage unit: PICKED_UP.
  /// Throws std::invalid_argument, with nothing changed, if it did not fall, or its unit does not
  /// stand upright.
  void pickUp(const std::string& item);

  // --- models
  /// Throws DescriptionError, with nothing changed, if the name is taken or unfit ("entity already
  /// exists"), a plugin is unknown or a parameter is wrong. Never half a model.
  void spawn(const ModelInstance& instance);
  /// All of them, or none: what was already spawned is removed again before the error goes on.
  void spawn(const std::vector<ModelInstance>& instances);
  /// A carried unit is put down if its carrier goes; a unit's items go with their unit.
  /// Returns false if there is no such model.
  bool remove(const std::string& name);
  bool has(const std::string& name) const;
  /// Returns them in the order in which they were added.
  std::vector<std::string> modelNames() const;
  ModelKind kind(const std::string& name) const;
  /// Returns a number that grows whenever a model is added or removed.
  std::uint64_t modelsRevision() const;
  /// Nothing if there is no such model. `link` empty: the model itself (its canonical link's
  /// twist).
  std::optional<EntityState> state(const std::string& model, const std::string& link = "") const;
  std::shared_ptr<const ModelDescription> description(const std::string& model) const;
  /// Moves a model and everything fixed to it, at that velocity. Returns false if there is no such
  /// model; throws DescriptionError if the state is not finite or too far away.
  bool setState(const std::string& model, const EntityState& state);
  /// Gives a model of free bodies this velocity where it is: its joints go on turning as they do.
  /// Returns false if there is no such model; throws DescriptionError if it is not finite.
  bool setVelocity(const std::string& model, const Twist& twist);
  /// Moves a link and everything that joints hold to it, the link at that velocity. Returns false
  /// if there is no such link; throws as setState.
  bool setLinkState(const std::string& model, const std::string& link, const EntityState& state);
  /// Returns all models at once, in the order of modelNames().
  void states(std::vector<EntityState>* out) const;
  /// Returns every `model::link`, models in the order of modelNames().
  void linkStates(std::vector<std::string>* names, std::vector<EntityState>* states) const;
  /// Gives the link of that name this mass, centre of mass, inertia and gravity flag. Returns false
  /// if there is no such link; throws std::invalid_argument if no body can be like that.
  bool setLinkInertia(const std::string& model, const Link& link);

  // --- joints
  /// Nothing if there is no such joint; a fixed one is always at 0.
  std::optional<JointState> joint(const std::string& model, const std::string& joint) const;
  /// Of the last step, dampers and applied efforts left out. Nothing if there is no such joint, or
  /// its model has no free bodies.
  std::optional<JointWrench> jointWrench(const std::string& model, const std::string& joint) const;
  /// Returns false if there is no such joint; throws std::invalid_argument where a number is out of
  /// range, and for the joints of a robot, which its plugins drive.
  bool setJoint(const std::string& model, const std::string& joint, const JointSettings& settings);
  /// Puts joints at positions [rad] or [m], with what hangs on them, at rest. All or none: throws
  /// std::invalid_argument that names the joint that can't be put there.
  void setJointPositions(const std::string& model, const std::map<std::string, double>& positions);

  // --- what clients apply
  const ExternalInputs& externalInputs() const;
  /// Acts in the next step only. Returns false if there is no such link or it does not move.
  bool applyWrench(const std::string& model, const std::string& link, const Vector3& force,
                   const Vector3& torque);
  /// Act for a period. Return false if there is no such link or joint, or it does not move.
  bool apply(const Wrench& wrench);
  bool apply(const Effort& effort);
  void clearWrenches(const std::string& model, const std::string& link);
  void clearEfforts(const std::string& model, const std::string& joint);
  void setLight(const Light& light);  ///< A new one, or in place of the one of that name.
  bool removeLight(const std::string& name);
  void setOde(const OdeSettings& settings);

  // --- the warehouse
  const Fleet& fleet() const;
  const std::vector<StorageUnit>& storageUnits() const;
  const std::vector<Item>& items() const;
  Pose storageUnitPose(int unit) const;  ///< In world.
  Pose itemPose(int item) const;         ///< In world.
  /// Where the robot is still to turn or to stop on its present way; on a path the end of what is
  /// released is one, and what is not released belongs to it.
  std::vector<PathPoint> pathAhead(int robot) const;
  /// Where the robot believes to be, which it drives by: (x, y, yaw) in world [m, rad], yaw
  /// unwrapped. Where it is, unless localisation is real.
  Vector3 believedPose(int robot) const;
  /// What the robot keeps its acceleration below so that its load does not tip [m/s²]; +inf without
  /// a load, or where loads are ideal.
  double loadLimit(int robot) const;
  Pose basePose(int robot) const;  ///< Of the chassis on the floor, in world.
  /// Counts up whenever a storage unit, or an item that lies on none, moved or changed hands.
  std::uint64_t unitsRevision() const;
  const Floor& floor() const;
  Occupancy occupancy() const;
  double gridSpacing() const;  ///< [m]

  // --- sensing
  /// One range a ray [m], +inf = no return, -inf = nearer than the minimum (REP 117); NaN of a
  /// laser that is blind.
  void scan(int robot, std::vector<float>* ranges) const;
  /// The same of several robots that have lasers, a row each, on the world's threads.
  void scan(const std::vector<int>& robots, std::vector<std::vector<float>>* ranges) const;
  /// Robots whose scan is due at this step, in the fleet's order; scans are staggered over the
  /// fleet. Valid until the next step or until a robot is removed.
  const std::vector<int>& scansDue() const;
  /// Distance [m] from a point in world, level, in the direction `yaw`, to the first body that
  /// stands on the floor; +inf = none within `range`. `but`: a model that the ray passes.
  double rayCast(const Vector3& from, double yaw, double range, const std::string& but = "") const;
  /// Distances [m] from a point in world along unit vectors to the first collision, the floor's
  /// among them; +inf = none within `range`. On the world's threads, about a microsecond a ray.
  void rayCast(const Vector3& from, const std::vector<Vector3>& directions, double range,
               const std::string& but, std::vector<double>* ranges) const;
  /// Where that model touches others now, itself the first of each pair.
  std::vector<ContactPoint> contacts(const std::string& model) const;

  // --- checkpoints
  /// The whole state as bytes: time, models and what is in motion, commands under way and pending,
  /// events not yet taken, what plugins save. This world and any that restores the bytes go on the
  /// same from here, bit by bit, as long as they are given the same commands.
  std::string checkpoint() const;
  /// Makes this world the one that was saved, whatever it was before. Throws CheckpointError, with
  /// nothing changed, if the bytes are damaged or of another version, and DescriptionError if a
  /// plugin of a model can't be loaded.
  void restore(const std::string& checkpoint);
  /// Of all that decides what happens next, commands posted but not yet answered left out. Equal
  /// worlds have equal hashes.
  std::uint64_t stateHash() const;

  // --- what happened since the last call
  std::vector<Event> takeEvents();
  std::vector<StatusChange> takeStatusChanges();
  /// What was left out, a plugin that is not known say; each once.
  std::vector<std::string> takeWarnings();
  /// For plugins: one more of these.
  void warn(const std::string& warning);

  /// What clients don't see; for tests and the parts of the world itself, see src/core/state.
  friend WorldState& insideOf(World& world);
  friend const WorldState& insideOf(const World& world);

 private:
  std::unique_ptr<WorldState> state_;
};

}  // namespace kiva
