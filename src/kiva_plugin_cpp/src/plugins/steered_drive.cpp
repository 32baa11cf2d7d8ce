// SPDX-License-Identifier: Apache-2.0
#include "plugins/steered_drive.h"

#include <algorithm>
#include <cmath>

#include "core/motion/driving/drives.h"
#include "core/sensing/scans.h"
#include "core/state/progress/tasks.h"
#include "plugins/motion.h"
#include "plugins/rotation.h"

namespace kiva {
namespace {

constexpr double kSilence = 0.5;      // [s] without a velocity, after which the robot stops
constexpr double kTurnShare = 0.5;    // of a turn in place's acceleration, since it drives, too
constexpr double kAside = 0.4;        // share of the wheels' grip that holds it on an arc
constexpr double kLeastSpeed = 1e-6;  // [m/s, rad/s] that is rest, behind lagging motors
constexpr double kFreeAgain = 0.1;  // [m] beyond the braking distance from which it is not blocked

/// The limits of a robot's velocity now. An acceleration of 0: at once.
struct Limits {
  double acceleration = 0;       // [m/s²]
  double braking = 0;            // before obstacles and people [m/s²]
  double turn_acceleration = 0;  // [rad/s²]
  double aside = 0;              // largest acceleration across the heading [m/s²]
};

Limits limitsOf(const Scene& world, int i) {
  const Vehicle vehicle = plannedVehicle(world, i);
  const double holds = kAside * (vehicle.grip[0] + vehicle.grip[1]) / vehicle.mass;
  return {plannedAcceleration(world, i), plannedBraking(world, i),
          kTurnShare * turnAcceleration(world, i, M_PI / 2), std::min(holds, loadLimit(world, i))};
}

/// Returns `value` changed towards `target` by at most `most`.
double towards(double target, double value, double most) {
  return value + std::clamp(target - value, -most, most);
}

/// Slows down on an arc on which its wheels or its load would not hold; the arc stays.
DriveVelocity heldOnArc(DriveVelocity velocity, double aside) {
  const double needed = std::abs(velocity.speed * velocity.turn_rate);
  if (needed <= aside) return velocity;
  const double share = std::sqrt(aside / needed);
  return {velocity.speed * share, velocity.turn_rate * share};
}

/// Slows down on the arc to a speed [m/s].
DriveVelocity slowedOnArc(const DriveVelocity& velocity, double speed) {
  if (std::abs(speed) >= std::abs(velocity.speed)) return velocity;
  return {speed, velocity.turn_rate * speed / velocity.speed};
}

/// Returns the room ahead by now, if the obstacle goes on as it did, and brakes once it has seen
/// this robot [m].
double roomNow(const Scene& world, int i, double braking) {
  const Steering& s = world.fleet.steering(i);
  if (!world.fleet.robots[i].laser.fitted) return kUnlimited;
  if (s.approach == 0) return s.room;
  const double period =
      static_cast<double>(scanPeriod(world.clock, world.fleet.robots[i])) * world.clock.dt;
  const double comes = s.approach * (s.since_look + 2 * period) +
                       (braking > 0 ? s.approach * s.approach / (2 * braking) : 0);
  return std::max(0.0, s.room - comes);
}

/// Returns the highest speed from which the robot stops before the obstacle ahead [m/s].
double speedBefore(double room, const Limits& limits, double dt) {
  if (std::isinf(room)) return room;
  if (limits.acceleration == 0) return room / dt;
  return std::max(0.0, Profile::stoppingSpeed(room, limits.acceleration, dt));
}

/// Advances the command by one step, to at most `most` ahead [m/s]. Returns whether that slows it
/// down.
bool advance(RobotView& world, int i, const Limits& limits, double most) {
  FleetState& f = world.fleet;
  Steering& s = f.steering(i);
  const double dt = world.clock.dt, allowed = f.allowed_speed[i];
  const auto change = [&](double rate) { return limits.acceleration > 0 ? rate * dt : kUnlimited; };
  const bool is_held = isHeld(f, i);
  DriveVelocity wish = is_held ? DriveVelocity() : heldOnArc(s.asked, limits.aside);
  wish = slowedOnArc(wish, std::clamp(wish.speed, -allowed, allowed));
  const bool yields = is_held || std::abs(s.command.speed) > allowed;  // to people, for instance
  const double next =
      towards(wish.speed, s.command.speed, change(yields ? limits.braking : limits.acceleration));
  const bool is_slowed = next > most;
  const double least = s.command.speed - change(limits.braking);
  s.command.speed = is_slowed ? std::max(most, least) : next;
  if (is_slowed) wish = slowedOnArc(wish, s.command.speed);
  s.command.turn_rate =
      towards(wish.turn_rate, s.command.turn_rate,
              limits.turn_acceleration > 0 ? limits.turn_acceleration * dt : kUnlimited);
  return is_slowed;
}

/// Reports an obstacle in whose way a robot slows down, and that it is free again.
void report(TaskView& world, int i, bool is_slowed, double room, double braking) {
  const FleetState& f = world.fleet;
  const Steering& s = f.steering(i);
  const bool was_blocked = f.status[i] == Status::kBlocked;
  if (is_slowed && !was_blocked) {
    const Model* obstacle = world.models[s.obstacle];
    const std::string name = obstacle ? obstacle->name : "something that was there";
    setStatus(world, i, Status::kBlocked, State::kBlocked);
    reportCommand(world, world.log, Event::Kind::kBlocked, i, name, name + " is in the way");
  }
  if (!was_blocked || is_slowed) return;
  const double needed = braking > 0 ? s.asked.speed * s.asked.speed / (2 * braking) : 0;
  if (s.asked.speed <= 0 || room > needed + kFreeAgain) {
    setStatus(world, i, Status::kBusy, State::kSteered);
  }
}

/// Holds its wheels after a collision until its client has asked it to stop.
void holdBumped(TaskView& world, int i) {
  Steering& s = world.fleet.steering(i);
  s.command = s.lagged = DriveVelocity();
  setWheels(world.fleet, i, 0, 0);
  if (!s.asked.isNone() || !stands(world.fleet, i)) return;
  s.bumped = false;
  setStatus(world, i, Status::kBusy, State::kSteered);
}

/// Lets the motors follow the command.
void actuate(FleetState& f, int i, Steering* s) {
  s->lagged.speed += f.lag.share * (s->command.speed - s->lagged.speed);
  s->lagged.turn_rate += f.lag.share * (s->command.turn_rate - s->lagged.turn_rate);
  if (f.lag.isNone()) s->lagged = s->command;
  const bool has_stopped = s->command.isNone() && std::abs(s->lagged.speed) < kLeastSpeed &&
                           std::abs(s->lagged.turn_rate) < kLeastSpeed;
  if (has_stopped) s->lagged = DriveVelocity();
  setWheels(f, i, s->lagged.speed, s->lagged.turn_rate);
}

void drive(TaskView& world, int i) {
  FleetState& f = world.fleet;
  Steering& s = f.steering(i);
  const double dt = world.clock.dt;
  s.silence += dt;
  s.since_look += dt;
  s.since_measured += dt;
  if (s.silence > kSilence) s.asked = DriveVelocity();
  if (s.bumped) return holdBumped(world, i);
  const Limits limits = limitsOf(world, i);
  const double room = roomNow(world, i, limits.acceleration);
  const bool is_slowed = advance(world, i, limits, speedBefore(room, limits, dt));
  const double way = std::max(0.0, s.command.speed) * dt;
  s.room = std::max(0.0, s.room - way);
  s.measured -= way;
  if (s.asked.speed <= 0 && s.command.speed <= 0) {
    s.room = 0;  // it looks before it drives on
    s.obstacle = -1;
  }
  report(world, i, is_slowed && s.obstacle >= 0, room, limits.acceleration);
  actuate(f, i, &s);
}

}  // namespace

void driveSteered(MotionView& world) {
  if (world.fleet.steerings.empty()) return;
  for (const int i : world.schedule.stepped_singly) {
    if (world.fleet.tasks[i].isSteered()) drive(world, i);
  }
}

}  // namespace kiva
