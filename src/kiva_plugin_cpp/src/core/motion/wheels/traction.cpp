// SPDX-License-Identifier: Apache-2.0
#include "core/motion/wheels/traction.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/physics/solver/coulomb.h"

namespace kiva {
namespace {

constexpr double kRestSpeed = 1e-9;  // [m/s, rad/s] below which a braked robot stands
constexpr double kSettled = 1e-12;   // [N s], largest change in the last sweep
constexpr int kMaxSweeps = 100;

enum { kAhead, kAside, kTurn };  // components of a planar velocity

/// The velocity of the centre of mass, along and across the heading, and about z.
using Velocity = std::array<double, 3>;

/// One wheel within a step. A motor holds its wheel at the target while its torque suffices.
/// Otherwise it gives its whole torque, and the wheel's speed is solved together with the floor's
/// impulses.
struct TractionWheel {
  double speed = 0;             // at the beginning of the step [rad/s]
  double target = 0;            // [rad/s]
  bool saturated = false;       // the motor is at its limit
  double motor = 0;             // impulse of a saturated motor [Nm s]
  double friction[2] = {0, 0};  // impulse of the floor on the wheel, ahead and aside [N s]
};

/// The floor's impulses on a vehicle within one step.
class FloorFriction {
 public:
  FloorFriction(const Vehicle& vehicle, const Velocity& before, double dt)
      : v_(vehicle), before_(before) {
    for (int wheel = 0; wheel < 2; ++wheel) {
      arm_[wheel] = (wheel == 0 ? v_.half_separation : -v_.half_separation) - v_.centre[1];
      limit_[wheel] = v_.grip[wheel] * dt;
    }
    const double sum = limit_[0] + limit_[1];
    const bool is_limited = sum > 0 && sum < kUnlimited;
    share_[0] = is_limited ? limit_[0] / sum : 0.5;
    share_[1] = 1 - share_[0];
  }

  /// Computes the impulses that end the slip of both wheels. Where these exceed the grip, they are
  /// those of Coulomb friction, whose circle driving and sideways holding share.
  void solve(TractionWheel wheels[2]) {
    holdBoth(wheels);
    bool holds = true;
    for (int wheel = 0; wheel < 2; ++wheel) {
      const double* friction = wheels[wheel].friction;
      holds = holds && friction[0] * friction[0] + friction[1] * friction[1] <=
                           limit_[wheel] * limit_[wheel];
    }
    if (!holds) slide(wheels);
  }

  Velocity after(const TractionWheel wheels[2]) const {
    Velocity velocity = before_;
    for (int wheel = 0; wheel < 2; ++wheel) {
      const double* friction = wheels[wheel].friction;
      velocity[kAhead] += friction[0] / v_.mass;
      velocity[kAside] += friction[1] / v_.mass;
      velocity[kTurn] -= (arm_[wheel] * friction[0] + v_.centre[0] * friction[1]) / v_.inertia;
    }
    return velocity;
  }

 private:
  /// Returns the change of a saturated wheel's rim speed per impulse of the floor on it [1/kg].
  double yielding(const TractionWheel& wheel) const {
    return wheel.saturated ? v_.radius * v_.radius / v_.wheel_inertia : 0;
  }

  /// Returns the slip of the rim over the floor without friction in this step [m/s].
  double slipAhead(const TractionWheel& wheel, int side, const Velocity& velocity) const {
    const double spin =
        wheel.saturated ? wheel.speed + wheel.motor / v_.wheel_inertia : wheel.target;
    return velocity[kAhead] - velocity[kTurn] * arm_[side] - v_.radius * spin;
  }

  double slipAside(const Velocity& velocity) const {
    return velocity[kAside] - velocity[kTurn] * v_.centre[0];
  }

  /// Holds both wheels: three unknowns. The sideways one is shared in proportion to their grips,
  /// since wheels on one axle slip sideways together.
  void holdBoth(TractionWheel wheels[2]) const {
    const double mass = 1 / v_.mass, turn = 1 / v_.inertia, cx = v_.centre[0];
    const double a00 = mass + arm_[0] * arm_[0] * turn + yielding(wheels[0]);
    const double a11 = mass + arm_[1] * arm_[1] * turn + yielding(wheels[1]);
    const double a22 = mass + cx * cx * turn;
    const double a01 = mass + arm_[0] * arm_[1] * turn;
    const double a02 = arm_[0] * cx * turn, a12 = arm_[1] * cx * turn;
    const double b0 = slipAhead(wheels[0], 0, before_), b1 = slipAhead(wheels[1], 1, before_);
    const double b2 = slipAside(before_);
    // Eliminates the last unknown, which is decoupled if the centre of mass is over the axle.
    const double f0 = a02 / a22, f1 = a12 / a22;
    const double s00 = a00 - f0 * a02, s01 = a01 - f0 * a12, s11 = a11 - f1 * a12;
    const double c0 = b0 - f0 * b2, c1 = b1 - f1 * b2;
    const double determinant = s00 * s11 - s01 * s01;
    const double x0 = (-s11 * c0 + s01 * c1) / determinant;
    const double x1 = (-s00 * c1 + s01 * c0) / determinant;
    const double aside = -(b2 + a02 * x0 + a12 * x1) / a22;
    wheels[0].friction[0] = x0;
    wheels[1].friction[0] = x1;
    for (int wheel = 0; wheel < 2; ++wheel) wheels[wheel].friction[1] = share_[wheel] * aside;
  }

  /// Iterates by block Gauss-Seidel over the wheels, each solved exactly.
  void slide(TractionWheel wheels[2]) const {
    for (int wheel = 0; wheel < 2; ++wheel) {
      double* x = wheels[wheel].friction;
      const double size = std::hypot(x[0], x[1]);
      for (int i = 0; i < 2 && size > limit_[wheel]; ++i) x[i] *= limit_[wheel] / size;
    }
    double change = kUnlimited;
    for (int sweep = 0; sweep < kMaxSweeps && change > kSettled; ++sweep) {
      change = 0;
      for (int wheel = 0; wheel < 2; ++wheel) {
        change = std::max(change, slideOne(wheels, wheel));
      }
    }
  }

  /// Solves one wheel with the other fixed. Returns the change of its friction [N s].
  double slideOne(TractionWheel wheels[2], int wheel) const {
    const double was[2] = {wheels[wheel].friction[0], wheels[wheel].friction[1]};
    wheels[wheel].friction[0] = wheels[wheel].friction[1] = 0;
    const Velocity others = after(wheels);
    const double slip[2] = {slipAhead(wheels[wheel], wheel, others), slipAside(others)};
    const double mass = 1 / v_.mass, turn = 1 / v_.inertia, cx = v_.centre[0], arm = arm_[wheel];
    double* x = wheels[wheel].friction;
    solveCoulomb(mass + arm * arm * turn + yielding(wheels[wheel]), arm * cx * turn,
                 mass + cx * cx * turn, slip, limit_[wheel], x);
    return std::max(std::abs(x[0] - was[0]), std::abs(x[1] - was[1]));
  }

  const Vehicle& v_;
  const Velocity before_;
  double arm_[2];    // arms of the wheels, left of the centre of mass [m]
  double limit_[2];  // limits of their friction [N s]
  double share_[2];  // shares of the sideways hold
};

/// Returns the impulse with which the motor brings the wheel to its target in the step [Nm s].
double neededMotor(const Vehicle& v, const TractionWheel& wheel) {
  return v.wheel_inertia * (wheel.target - wheel.speed) + v.radius * wheel.friction[0];
}

/// Determines the motors that are at their limits, together with the floor's friction.
void solveWheels(const Vehicle& v, FloorFriction* floor, double motor_limit,
                 TractionWheel wheels[2]) {
  for (int round = 0; round < 3; ++round) {
    floor->solve(wheels);
    bool changed = false;
    for (int i = 0; i < 2; ++i) {
      const double needed = neededMotor(v, wheels[i]);
      if (wheels[i].saturated || std::abs(needed) <= motor_limit) continue;
      wheels[i].saturated = changed = true;
      wheels[i].motor = std::copysign(motor_limit, needed);
    }
    if (!changed) return;
  }
}

double speedAfter(const Vehicle& v, const TractionWheel& wheel) {
  if (!wheel.saturated) return wheel.target;
  return wheel.speed + (wheel.motor - v.radius * wheel.friction[0]) / v.wheel_inertia;
}

}  // namespace

void applyTraction(FleetState& fleet, int i, const Ground& ground, double dt) {
  const Vehicle v = vehicleOf(fleet.robots[i], ground);
  const double c = std::cos(fleet.yaw[i]), s = std::sin(fleet.yaw[i]);
  const double cx = v.centre[0], cy = v.centre[1], turn = fleet.yaw_rate[i];
  // The velocity that is stored is that of the robot's origin: the centre has moved on around it
  // since.
  const double around = turn * turn * dt;
  const Velocity before{c * fleet.vx[i] + s * fleet.vy[i] - turn * cy + around * cx,
                        -s * fleet.vx[i] + c * fleet.vy[i] + turn * cx + around * cy, turn};
  TractionWheel wheels[2];
  for (int side = 0; side < 2; ++side) {
    wheels[side].speed = fleet.wheel_speed[side][i];
    wheels[side].target = fleet.wheel_target[side][i];
  }
  FloorFriction floor(v, before, dt);
  solveWheels(v, &floor, v.torque * dt, wheels);
  const Velocity after = floor.after(wheels);
  for (int side = 0; side < 2; ++side) {
    fleet.wheel_speed[side][i] = speedAfter(v, wheels[side]);
  }
  const double forward = after[kAhead] + after[kTurn] * cy;
  const double sideways = after[kAside] - after[kTurn] * cx;
  fleet.vx[i] = c * forward - s * sideways;
  fleet.vy[i] = s * forward + c * sideways;
  fleet.yaw_rate[i] = after[kTurn];
}

void integrate(Fleet& fleet, int i, double dt) {
  fleet.x[i] += fleet.vx[i] * dt;
  fleet.y[i] += fleet.vy[i] * dt;
  fleet.yaw[i] += fleet.yaw_rate[i] * dt;
  for (int wheel = 0; wheel < 2; ++wheel) {
    fleet.wheel_angle[wheel][i] += fleet.wheel_speed[wheel][i] * dt;
  }
}

bool atRest(const FleetState& fleet, int i) {
  return std::abs(fleet.vx[i]) < kRestSpeed && std::abs(fleet.vy[i]) < kRestSpeed &&
         std::abs(fleet.yaw_rate[i]) < kRestSpeed && fleet.wheel_target[0][i] == 0 &&
         fleet.wheel_target[1][i] == 0;
}

}  // namespace kiva
