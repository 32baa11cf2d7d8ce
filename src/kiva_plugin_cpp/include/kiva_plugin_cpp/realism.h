// SPDX-License-Identifier: Apache-2.0
//
// Realism: how far robots, sensors, radio and people differ from the ideal. Every section is off
// unless it is switched on. doc/explanation/realism.md gives models, defaults and sources.
//
//
// A section lists its numbers once, in fields(): name, value, least, most. From that list they are
// read, checked, compared and saved in checkpoints.
#pragma once

#include <string>

#include "kiva_plugin_cpp/description.h"
#include "kiva_plugin_cpp/parameters.h"

namespace kiva {

/// Robots drive by wheel odometry and by the codes on the floor, one at each grid point.
/// Deviations are standard deviations of a normal distribution.
struct LocalisationRealism {
  bool enabled = false;
  double wheel_radius_error = 0.001;      ///< Error of each wheel, as a share of its radius.
  double wheel_separation_error = 0.002;  ///< Error as a share of the separation.
  double slip =
      0.0003;  ///< Error of a wheel's distance over 1 m [m]; grows with the root of the distance.
  double code_position_noise = 0.0005;  ///< Noise of a reading along each axis [m].
  double code_angle_noise = 0.001;      ///< Noise of a reading [rad].
  double missed_codes = 0.002;  ///< Share of codes that a robot passes without reading them.
  double lost_after = 3.5;      ///< Distance without a code after which a robot is lost [m].

  template <typename Self, typename Field>
  static void fields(Self& s, Field field) {
    field("wheel_radius_error", s.wheel_radius_error, 0, 0.02);
    field("wheel_separation_error", s.wheel_separation_error, 0, 0.02);
    field("slip", s.slip, 0, 0.02);
    field("code_position_noise", s.code_position_noise, 0, 0.02);
    field("code_angle_noise", s.code_angle_noise, 0, 0.1);
    field("missed_codes", s.missed_codes, 0, 1);
    field("lost_after", s.lost_after, 0.1, 1000);
  }
};

/// Errors of laser scans.
struct LaserRealism {
  bool enabled = false;
  double range_noise = 0.01;    ///< Standard deviation of a range [m].
  double dropped_rays = 0.002;  ///< Share of rays that see nothing.

  template <typename Self, typename Field>
  static void fields(Self& s, Field field) {
    field("range_noise", s.range_noise, 0, 1);
    field("dropped_rays", s.dropped_rays, 0, 1);
  }
};

/// Spread of motors and tyres from robot to robot, and the lag of motors behind commands.
struct ActuationRealism {
  bool enabled = false;
  double motor_lag = 0;           ///< Time constant with which speeds follow their commands [s].
  double torque_spread = 0.05;    ///< Standard deviation, as a share of the motor's torque.
  double friction_spread = 0.05;  ///< Standard deviation, as a share of the tyres' friction.

  template <typename Self, typename Field>
  static void fields(Self& s, Field field) {
    field("motor_lag", s.motor_lag, 0, 0.5);
    field("torque_spread", s.torque_spread, 0, 0.3);
    field("friction_spread", s.friction_spread, 0, 0.3);
  }
};

/// Slippery cells of the floor: wet, oily or dusty. The seed chooses them.
struct FloorRealism {
  bool enabled = false;
  double slippery_cells = 0.01;  ///< Share of the grid's cells.
  double friction = 0.3;         ///< Coulomb coefficient of their surface.

  template <typename Self, typename Field>
  static void fields(Self& s, Field field) {
    field("slippery_cells", s.slippery_cells, 0, 1);
    field("friction", s.friction, 0, kMostFriction);
  }
};

/// Loads stand on the robot's plate, and tip over its edge where it brakes too hard. Items stand on
/// the boards of their storage unit, and slide off where it is hit hard enough, or tips.
struct LoadRealism {
  bool enabled = false;
  /// A robot accelerates with at most this share of the acceleration at which its load would tip;
  /// from 1 on, it does not avoid tipping.
  double tipping_share = 0.7;
  double item_friction_least = 0.3;  ///< Coulomb coefficient of an item on its board, evenly
  double item_friction_most = 0.5;   ///< distributed between these.
  double pick_up_after = 300;  ///< Time until an item is picked up off the floor [s]; 0: never.

  template <typename Self, typename Field>
  static void fields(Self& s, Field field) {
    field("tipping_share", s.tipping_share, 0.05, 100);
    field("item_friction_least", s.item_friction_least, 0, kMostFriction);
    field("item_friction_most", s.item_friction_most, 0, kMostFriction);
    field("pick_up_after", s.pick_up_after, 0, 1e6);
  }
};

/// Delay and loss of commands on their way to robots, and of reports on their way back. Each robot
/// gets its commands in the order of posting. A latency is `least` plus an exponentially
/// distributed rest; its mean is `mean`.
struct RadioRealism {
  bool enabled = false;
  double latency_least = 0.005;     ///< [s]
  double latency_mean = 0.03;       ///< [s]
  double lost = 0.001;              ///< Share of commands that are lost.
  double repeated = 0.001;          ///< Share of commands that arrive twice.
  double status_latency_least = 0;  ///< [s]
  double status_latency_mean = 0;   ///< [s]
  double status_lost = 0;           ///< Share of reports that are lost.

  /// Returns whether reports are delayed or lost.
  bool delaysReports() const {
    return enabled && (status_latency_least > 0 || status_latency_mean > 0 || status_lost > 0);
  }

  template <typename Self, typename Field>
  static void fields(Self& s, Field field) {
    field("latency_least", s.latency_least, 0, 10);
    field("latency_mean", s.latency_mean, 0, 10);
    field("lost", s.lost, 0, 0.5);
    field("repeated", s.repeated, 0, 0.5);
    field("status_latency_least", s.status_latency_least, 0, 10);
    field("status_latency_mean", s.status_latency_mean, 0, 10);
    field("status_lost", s.status_lost, 0, 0.5);
  }
};

/// Batteries: consumption of robots, and supply of charging places on the floor.
struct EnergyRealism {
  bool enabled = false;
  double capacity = 960;              ///< Capacity of a new battery [Wh].
  double health = 1;                  ///< Share of the capacity that is left with age.
  double initial_least = 0.6;         ///< State of charge at the beginning, evenly distributed
  double initial_most = 1;            ///< between these, 0…1.
  double electronics = 80;            ///< Constant consumption [W].
  double rolling_resistance = 0.015;  ///< Rolling resistance force over weight.
  double drive_efficiency = 0.75;     ///< Efficiency from the battery to the wheels.
  double regeneration = 0.3;          ///< Share of kinetic energy that braking recovers.
  double lift_efficiency = 0.4;       ///< Efficiency from the battery to the load.
  double charge_power = 1500;         ///< Power into the battery [W],
  double charge_taper = 0.8;          ///< up to this state of charge; it falls linearly beyond.

  template <typename Self, typename Field>
  static void fields(Self& s, Field field) {
    field("capacity", s.capacity, 1, 1e6);
    field("health", s.health, 0.1, 1);
    field("initial_least", s.initial_least, 0, 1);
    field("initial_most", s.initial_most, 0, 1);
    field("electronics", s.electronics, 0, 1e5);
    field("rolling_resistance", s.rolling_resistance, 0, 1);
    field("drive_efficiency", s.drive_efficiency, 0.05, 1);
    field("regeneration", s.regeneration, 0, 1);
    field("lift_efficiency", s.lift_efficiency, 0.05, 1);
    field("charge_power", s.charge_power, 0, 1e6);
    field("charge_taper", s.charge_taper, 0, 1);
  }
};

/// Rates of failures, and durations of repairs. Times between failures and times to repair are
/// exponentially distributed.
struct FailureRealism {
  bool enabled = false;
  double per_robot_hour = 0.01;  ///< Failures an hour and robot.
  double repair_time = 300;      ///< Mean time to a repair [s].
  double motor = 0.3;  ///< Weight of this kind among all kinds of failures; likewise below.
  double lift_stuck = 0.15;
  double laser_blind = 0.15;
  double radio_lost = 0.25;
  double wheel_slips = 0.15;
  double slipping_grip = 0.3;  ///< Share of its friction that is left to a slipping wheel.

  template <typename Self, typename Field>
  static void fields(Self& s, Field field) {
    field("per_robot_hour", s.per_robot_hour, 0, 1e4);
    field("repair_time", s.repair_time, 0.1, 1e6);
    field("motor", s.motor, 0, 1);
    field("lift_stuck", s.lift_stuck, 0, 1);
    field("laser_blind", s.laser_blind, 0, 1);
    field("radio_lost", s.radio_lost, 0, 1);
    field("wheel_slips", s.wheel_slips, 0, 1);
    field("slipping_grip", s.slipping_grip, 0.05, 1);
  }
};

struct PeopleRealism {
  bool enabled = false;

  template <typename Self, typename Field>
  static void fields(Self& /*s*/, Field /*field*/) {}
};

/// Motion of robots as it was measured, in place of what their models say.
struct MotionRealism {
  bool enabled = false;
  double speed = 0;              ///< [m/s]; here and below 0: the model's own.
  double acceleration = 0;       ///< And deceleration [m/s²].
  double quarter_turn_time = 0;  ///< Time of a turn by 90°, from rest to rest [s].
  double lift_time = 0;          ///< Time for the whole stroke [s].

  template <typename Self, typename Field>
  static void fields(Self& s, Field field) {
    field("speed", s.speed, 0, 10);
    field("acceleration", s.acceleration, 0, 100);
    field("quarter_turn_time", s.quarter_turn_time, 0, 1000);
    field("lift_time", s.lift_time, 0, 1000);
  }
};

struct Realism {
  LocalisationRealism localisation;
  LaserRealism lasers;
  ActuationRealism actuation;
  FloorRealism floor;
  LoadRealism loads;
  RadioRealism radio;
  EnergyRealism energy;
  FailureRealism failures;
  PeopleRealism people;
  MotionRealism motion;
};

/// Calls call(name, section) for each section of a Realism.
template <typename R, typename Call>
void forEachSection(R& realism, Call call) {
  call("localisation", realism.localisation);
  call("lasers", realism.lasers);
  call("actuation", realism.actuation);
  call("floor", realism.floor);
  call("loads", realism.loads);
  call("radio", realism.radio);
  call("energy", realism.energy);
  call("failures", realism.failures);
  call("people", realism.people);
  call("motion", realism.motion);
}

/// Reads `prefix` + `section/name` for every number. A section is on if any of its numbers is
/// there, or if the section itself is `true`; `false` switches it off. Other numbers keep their
/// defaults. The section `service` is of people at stations, whom shifts simulate: it is ignored.
/// Throws DescriptionError for a text that is not a number, and a number out of range.
/// Unknown keys are left to Parameters::rejectUnread.
Realism readRealism(const Parameters& parameters, const std::string& prefix = "");

bool operator==(const Realism& a, const Realism& b);
inline bool operator!=(const Realism& a, const Realism& b) { return !(a == b); }

}  // namespace kiva
