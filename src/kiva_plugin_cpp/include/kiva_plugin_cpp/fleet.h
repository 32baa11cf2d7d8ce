// SPDX-License-Identifier: Apache-2.0
//
// The Kiva robots as arrays: entry i of every array belongs to robot i. Indices are dense and
// change when a robot is deleted; ids (the number in `kiva<id>`) do not.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/description.h"
#include "kiva_plugin_cpp/failures.h"
#include "kiva_plugin_cpp/message_enums.h"
#include "kiva_plugin_cpp/viewable_memory.h"

namespace kiva {

/// How a robot's drive is modelled.
enum class Drive : std::uint8_t {
  kTraction,  ///< Planar chassis, two wheel speeds, Coulomb friction at the wheels.
  kJointed    ///< Wheel joints, casters, rigid contacts with the floor; the chassis pitches.
};

// Each struct of parameters lists its numbers once, in fields(): name, value, least, most. This
// list serves for reading, checking and checkpoints.

struct DriveParameters {
  Drive drive = Drive::kTraction;
  double speed = 1.5;  ///< [m/s], > 0.
  double acceleration =
      1.0;  ///< [m/s²]; 0 = speed changes at once: motors have no limit, and grip has none either,
            ///< except that of jointed robots, whose wheels slip.
  double emergency_deceleration =
      2.5;                         ///< Deceleration where a normal stop would be too late [m/s²].
  double wheel_radius = 0.1;       ///< [m]
  double wheel_separation = 0.52;  ///< Distance between the wheels' centres [m].
  double wheel_inertia = 0.03;     ///< Inertia of a wheel with its motor, about its axle [kg m²].
  double motor_torque = 90.0;      ///< Limit of one motor at its wheel [Nm].
  double friction = 0.8;  ///< Coulomb coefficient between wheel and floor, unless the tyre's or the
                          ///< floor's own is smaller.
  double drive_wheel_load = 0.8;  ///< Share of the weight on the driven wheels; casters: the rest.
  double quarter_turn_time = 0.625;  ///< Time of a turn by 90°, from rest to rest [s]; 0 = at once.

  /// The numbers that the plugin `motion` takes.
  template <typename Self, typename Field>
  static void motionFields(Self& s, Field field) {
    field("speed", s.speed, 0.01, 10);
    field("acceleration", s.acceleration, 0, 100);
    field("emergency_deceleration", s.emergency_deceleration, 0.01, 100);
    field("wheel_radius", s.wheel_radius, 0.005, 1);
    field("wheel_separation", s.wheel_separation, 0.01, 10);
    field("wheel_inertia", s.wheel_inertia, 1e-6, 100);
    field("motor_torque", s.motor_torque, 0, 1e5);
    field("friction", s.friction, 0, kMostFriction);
    field("drive_wheel_load", s.drive_wheel_load, 0.01, 1);
  }
  /// The number that the plugin `rotation` takes.
  template <typename Self, typename Field>
  static void rotationFields(Self& s, Field field) {
    field("quarter_turn_time", s.quarter_turn_time, 0, 1000);
  }
  template <typename Self, typename Field>
  static void fields(Self& s, Field field) {
    motionFields(s, field);
    rotationFields(s, field);
  }
};

struct LiftParameters {
  bool fitted = false;
  double height = 0.10;     ///< Stroke of the tower [m].
  double time = 2.2;        ///< Time for the whole stroke [s]; 0 = at once.
  double max_load = 450.0;  ///< [kg]
  double max_force =
      5500;  ///< Largest force of the lift [N]; it stalls where the load resists with more.
  double proximity = 0.1;  ///< Largest distance between the centres of robot and unit [m].

  template <typename Self, typename Field>
  static void fields(Self& s, Field field) {
    field("height", s.height, 0.001, 10);
    field("time", s.time, 0, 1000);
    field("max_load", s.max_load, 0, 1e6);
    field("max_force", s.max_force, 0, 1e9);
    field("proximity", s.proximity, 0, 10);
  }
};

struct LaserParameters {
  bool fitted = false;
  int rays = 121;
  double min_angle = -1.0471975511965976;  ///< [rad], 0 = ahead, counterclockwise.
  double max_angle = 1.0471975511965976;   ///< [rad]
  double min_range = 0.01;                 ///< [m]
  double max_range = 5.0;                  ///< [m]
  double rate = 10.0;                      ///< [Hz] of simulated time.
  double x = 0.38;                         ///< Position of the sensor, in the chassis frame [m].
  double z = 0.2;                          ///< Height above the floor [m].

  /// The lower limit of max_range and max_angle is min_range and min_angle, which are read first.
  template <typename Self, typename Field>
  static void fields(Self& s, Field field) {
    field("rays", s.rays, 1, 10000);
    field("min_angle", s.min_angle, -M_PI, M_PI);
    field("max_angle", s.max_angle, s.min_angle, M_PI);
    field("min_range", s.min_range, 0, 100);
    field("max_range", s.max_range, s.min_range, 100);
    field("rate", s.rate, 0.01, 1000);
    field("x", s.x, -10, 10);
    field("z", s.z, 0, 10);
  }
};

/// Parameters of a robot that are set once and read seldom.
struct Robot {
  std::string name;
  int id = 0;
  int model = -1;       ///< Index in the world's models.
  double mass = 145;    ///< Mass without load [kg].
  double inertia = 12;  ///< Inertia about z through the robot's origin, without load [kg m²].
  double centre[2] = {0, 0};  ///< Centre of mass without load, in the chassis frame [m].
  /// Coulomb coefficients of the tyres: left, right.
  double tyre_friction[2] = {1e16, 1e16};
  double grip = 1;                 ///< Share of that friction that its wheels still have.
  double half_length = 0.38;       ///< Half of the chassis' length, along its x axis [m].
  double half_width = 0.32;        ///< Half of its width [m].
  double height = 0.40;            ///< Height of its highest point, tower down [m].
  double load_mass = 0;            ///< Mass of the load [kg].
  double load_inertia = 0;         ///< Its inertia about z through the robot's origin [kg m²].
  double load_centre[2] = {0, 0};  ///< Its centre of mass, in the chassis frame [m].
  double load_height = 0;          ///< Height of its centre of mass above the plate [m].
  double load_foothold = 0;        ///< Horizontal distance of that to the plate's nearest edge [m].
  double load_tipping_inertia = 0;  ///< Inertia of the load about that edge [kg m²].
  double load_half_length = 0;      ///< Half of its length, along the chassis' x axis [m].
  double load_half_width = 0;       ///< Half of its width [m].
  DriveParameters drive;
  LiftParameters lift;
  LaserParameters laser;
  bool has_motion = false;
  bool has_rotation = false;
  int ray_fan = -1;  ///< Index of its laser's rays among the world's fans.
};

/// The posture of a jointed robot's chassis on its wheels and casters. All zero: upright, wheels on
/// the floor.
struct Stance {
  double height = 0;      ///< Height of the axle's middle above its place then [m].
  double roll = 0;        ///< Rotation about the heading [rad].
  double pitch = 0;       ///< Rotation about the axle, front down [rad].
  double climb_rate = 0;  ///< Upward speed [m/s].
  double roll_rate = 0;   ///< Rate about the chassis' own x axis [rad/s].
  double pitch_rate = 0;  ///< Rate about its y axis [rad/s].
};

/// A place on the floor, in world [m].
struct PathPoint {
  double x = 0, y = 0;
};

/// A velocity on the floor, in world.
struct PlanarTwist {
  double vx = 0, vy = 0, yaw_rate = 0;  ///< [m/s, rad/s]
};

/// A robot's report; fields as in Fleet.
struct RobotReport {
  double x = 0, y = 0, yaw = 0;         ///< Pose in world [m, rad].
  double vx = 0, vy = 0, yaw_rate = 0;  ///< [m/s, rad/s]
  Status status = Status::kIdle;
  State state = State::kIdle;
  std::int32_t shelf_id = 0;  ///< 0 = none.
  std::uint32_t path_id = 0, reached = 0, left = 0;
  std::uint8_t last_end = 0;
};

/// The report of a robot that is elsewhere, whose shadow stands in the world.
struct ShadowReport {
  RobotReport report;         ///< The shadow stands; its velocities are published with its pose.
  std::uint8_t failures = 0;  ///< Set of failures, as Fleet::failures.
  float charge = 1;           ///< Charge of the battery, as Fleet::charge.
};

/// One value a robot. Others may hold its memory and read it without a copy.
template <typename T>
using Column = std::vector<T, ViewableAllocator<T>>;

/// Positions in world [m, rad], velocities in world [m/s, rad/s] unless said otherwise.
struct Fleet {
  Column<double> x, y, yaw;  ///< Yaw is unwrapped: it counts full turns.
  Column<double> vx, vy, yaw_rate;
  Column<double> wheel_speed[2];  ///< Left, right [rad/s].
  Column<double> wheel_angle[2];  ///< Left, right, unwrapped [rad].
  Column<Stance> stance;          ///< Posture of jointed robots; others stand upright.
  Column<double> tower;           ///< Height of the tower above its rest [m].
  Column<std::int32_t> unit;      ///< Index of the carried storage unit, -1 = none.
  Column<Status> status;
  Column<State> state;
  /// End of the last command: kDone or kBlocked of Event::Kind, 0 = none yet. It stays until the
  /// next command is accepted.
  Column<std::uint8_t> last_end;
  /// Id of the last command's path; 0 if that command was no path, and so are the next two.
  Column<std::uint32_t> path_id;
  /// Count of leading points of the path that the robot's centre has reached, within a millimetre.
  /// It is 1 at the beginning, since the robot stands on point 0, and the whole count at the end.
  Column<std::uint32_t> reached;
  /// Count of leading points whose cells the robot and its load have left completely. A cell is a
  /// square of the grid's spacing around its point. Extents are those of straight driving: the
  /// corners of a load that turns reach some centimetres out of its cell.
  Column<std::uint32_t> left;
  Column<std::uint8_t> stopped;   ///< 1 = stands until Command::Kind::kGoOn.
  Column<std::uint8_t> failures;  ///< Set of failures: bitOf() each Failure; 0 = none.
  Column<float> charge;           ///< Charge of the battery, 0…1; 1 without a battery model.
  /// The speed that the protective field allows near people [m/s]: 0 = the robot stands, +inf =
  /// no person is near.
  Column<double> allowed_speed;
  /// The mode, as in warehouse_msgs/SetRobotMode. It is kept for the program that coordinates the
  /// fleet, and changes nothing in the world.
  Column<std::uint8_t> mode;
  Column<std::uint8_t> curtained;  ///< 1 = stands within a light curtain with a person inside.
  std::vector<Robot> robots;

  int size() const { return static_cast<int>(robots.size()); }
  /// Returns the index of the robot with that id, or -1.
  int find(int id) const {
    return id > 0 && id < static_cast<int>(index_of_id.size()) ? index_of_id[id] : -1;
  }

  std::vector<std::int32_t> index_of_id;  ///< Index by id; -1 for other ids.

  /// Appends a robot at rest and returns its index.
  int add(Robot robot, double x, double y, double yaw);
  /// Removes robot `i`; the last one takes its index.
  void remove(int i);
};

constexpr int kMaxKivaId = 1000000;
constexpr std::uint8_t kMostMode = 2;  ///< The last of Fleet::mode's values.

}  // namespace kiva
