// SPDX-License-Identifier: Apache-2.0
#include "core/motion/joints/jointed.h"

#include <algorithm>
#include <cmath>

#include "core/motion/joints/jointed_body.h"
#include "core/motion/wheels/ground.h"
#include "core/physics/solver/contact_problem.h"

namespace kiva {
namespace {

constexpr double kForeseen = 0.01;      // [m] above the floor up to which a contact is foreseen
constexpr double kMending = 0.2;        // share of a contact's depth that a step corrects,
constexpr double kMendSpeed = 0.05;     // [m/s], the limit of that
constexpr double kSteady = 1e-6;        // [m/s, rad/s]
constexpr double kSteepest = 0.01;      // cosine of the largest pitch at which a heading is defined
constexpr double kUnlimitedPush = 1e6;  // [Nm s]

/// The rotation of the chassis frame against the horizontal frame along the robot's heading, z up.
struct Tilt {
  explicit Tilt(const Stance& s)
      : cos_pitch(std::max(kSteepest, std::cos(s.pitch))),
        sin_pitch(std::sin(s.pitch)),
        cos_roll(std::cos(s.roll)),
        sin_roll(std::sin(s.roll)) {}

  btMatrix3x3 toHeading() const {
    return btMatrix3x3(cos_pitch, sin_pitch * sin_roll, sin_pitch * cos_roll,  //
                       0, cos_roll, -sin_roll,                                 //
                       -sin_pitch, cos_pitch * sin_roll, cos_pitch * cos_roll);
  }
  /// Returns the angular velocity in the chassis frame from the rates about x and y and that of the
  /// heading.
  btVector3 turning(const Stance& s, double heading_rate) const {
    return {s.roll_rate, s.pitch_rate,
            (heading_rate * cos_pitch - s.pitch_rate * sin_roll) / cos_roll};
  }
  /// Returns the rate of the heading, and so of yaw, for an angular velocity of the chassis.
  double headingRate(const btVector3& turning) const {
    return (turning.y() * sin_roll + turning.z() * cos_roll) / cos_pitch;
  }

  double cos_pitch, sin_pitch, cos_roll, sin_roll;
};

/// Velocities in the chassis frame.
struct Velocities {
  btVector3 linear;   // velocity of the centre of mass [m/s]
  btVector3 turning;  // [rad/s]
  double spin[2];     // rates of the wheels against the chassis [rad/s]
};

/// One direction at a contact, with its effect on the velocities.
struct ContactRow {
  btVector3 linear, angular;
  double spin[2];
  // Change of the turning velocities by a unit impulse.
  double turning[5];
};

struct FloorContacts {
  ContactProblem problem;
  ContactRow rows[ContactProblem::kMaxRows];
  double target_speed[ContactProblem::kMaxRows];  // least velocity along a normal, 0 along the
                                                  // ground [m/s]
};

/// A point of the robot just above, on or in the floor.
struct FloorTouch {
  btVector3 at;  // position in the chassis frame
  double gap;    // [m]
  double friction;
  int wheel;  // -1: the chassis itself
};

class JointedStep {
 public:
  JointedStep(RobotView& world, int robot)
      : f_(world.fleet),
        robot_(robot),
        drive_(f_.robots[robot].drive),
        body_(jointedBody(world, robot)),
        stance_(f_.stance[robot]),
        tilt_(stance_),
        to_heading_(tilt_.toHeading()),
        up_(to_heading_.getRow(2)),
        dt_(world.clock.dt),
        gravity_(world.settings.gravityDown()),
        floor_friction_(world.floor.friction),
        ground_(groundUnder(world, robot)) {}

  void run() {
    read();
    findContacts();
    loadSprings();
    const double limit = drive_.acceleration == 0 ? kUnlimitedPush : drive_.motor_torque * dt_;
    // A motor holds its wheel at the target while its torque suffices. Otherwise it gives its whole
    // torque, and the wheel's speed is solved together with the floor's impulses.
    int free = 0;
    double motor[2] = {0, 0};
    for (int round = 0; round < 3; ++round) {
      solve(free, motor);
      const int before = free;
      for (int wheel = 0; wheel < 2; ++wheel) {
        if (before >> wheel & 1) continue;
        const double needed = motorImpulse(wheel);
        if (std::abs(needed) <= limit) continue;
        motor[wheel] = std::copysign(limit, needed);
        free |= 1 << wheel;
      }
      if (free == before) break;
    }
    write();
  }

 private:
  void read() {
    const double c = std::cos(f_.yaw[robot_]), s = std::sin(f_.yaw[robot_]);
    cos_yaw_ = c;
    sin_yaw_ = s;
    const double vx = f_.vx[robot_], vy = f_.vy[robot_];
    const btVector3 origin(c * vx + s * vy, -s * vx + c * vy, stance_.climb_rate);
    before_.turning = tilt_.turning(stance_, f_.yaw_rate[robot_]);
    before_.linear = origin * to_heading_ + before_.turning.cross(body_.centre);
    for (int wheel = 0; wheel < 2; ++wheel) {
      before_.spin[wheel] = f_.wheel_speed[wheel][robot_];
      target_[wheel] = f_.wheel_target[wheel][robot_];
    }
  }

  void write() {
    const btVector3 origin = to_heading_ * (after_.linear - after_.turning.cross(body_.centre));
    f_.vx[robot_] = cos_yaw_ * origin.x() - sin_yaw_ * origin.y();
    f_.vy[robot_] = sin_yaw_ * origin.x() + cos_yaw_ * origin.y();
    f_.yaw_rate[robot_] = tilt_.headingRate(after_.turning);
    stance_.climb_rate = origin.z();
    stance_.roll_rate = after_.turning.x();
    stance_.pitch_rate = after_.turning.y();
    for (int wheel = 0; wheel < 2; ++wheel) f_.wheel_speed[wheel][robot_] = after_.spin[wheel];
  }

  double heightOf(const btVector3& point) const {
    return body_.axle_height + stance_.height + up_.dot(point);
  }

  void findContacts() {
    const double level = up_.dot(body_.axle);
    const double upright = std::sqrt(std::max(1e-12, 1 - level * level));
    // Vector from a wheel's centre towards its lowest point, per radius.
    const btVector3 down = (body_.axle * level - up_) / upright;
    for (int wheel = 0; wheel < 2; ++wheel) {
      const JointedBody::Wheel& w = body_.wheels[wheel];
      const btVector3 at = w.centre + down * w.radius;
      add({at, heightOf(at), f_.robots[robot_].grip * std::min(w.friction, ground_.friction[wheel]),
           wheel});
    }
    const double tilted = up_.x() * up_.x() + up_.y() * up_.y();
    const bool low_only = tilted < body_.low_feet_reach * body_.low_feet_reach;
    const int feet = low_only ? body_.low_feet : static_cast<int>(body_.feet.size());
    for (int i = 0; i < feet; ++i) {
      const JointedBody::Foot& foot = body_.feet[i];
      add({foot.centre - up_ * foot.radius, heightOf(foot.centre) - foot.radius,
           std::min(foot.friction, floor_friction_), -1});
    }
  }

  /// Casters are sprung: each bears its share of the weight however the chassis leans.
  void loadSprings() {
    const double force = body_.spring_share * gravity_ / body_.inverse_mass;
    for (int i = 0; i < body_.low_feet && force > 0; ++i) {
      const JointedBody::Foot& foot = body_.feet[i];
      if (foot.radius == 0 || heightOf(foot.centre) - foot.radius > kForeseen) continue;
      springs_push_ += up_ * (force * dt_ * body_.inverse_mass);
      springs_twist_ += (foot.centre - body_.centre).cross(up_) * (force * dt_);
    }
  }

  void add(const FloorTouch& touch) {
    if (touch.gap > kForeseen || contacts_.problem.contacts() == ContactProblem::kMaxContacts) {
      return;
    }
    const int row = contacts_.problem.rows();
    contacts_.problem.add(touch.friction);
    fill(row, touch, up_);
    // A foreseen contact closes at the end of the step; a point in the floor is lifted gently.
    contacts_.target_speed[row] =
        touch.gap > 0 ? -touch.gap / dt_ : std::min(kMendSpeed, -kMending * touch.gap / dt_);
    if (touch.friction <= 0) return;
    const btVector3 ahead = body_.axle.cross(up_).normalized();
    fill(row + 1, touch, ahead);
    fill(row + 2, touch, up_.cross(ahead));
    contacts_.target_speed[row + 1] = contacts_.target_speed[row + 2] = 0;
  }

  void fill(int row, const FloorTouch& touch, const btVector3& direction) {
    ContactRow& r = contacts_.rows[row];
    r.linear = direction;
    r.angular = (touch.at - body_.centre).cross(direction);
    r.spin[0] = r.spin[1] = 0;
    if (touch.wheel < 0) return;
    const btVector3 arm = touch.at - body_.wheels[touch.wheel].centre;
    r.spin[touch.wheel] = body_.axle.cross(arm).dot(direction);
  }

  /// Computes the velocities after the step. Wheels in the bit mask `free` are driven by the
  /// impulses `motor` [Nm s]; the others are held at their targets.
  void solve(int free, const double motor[2]) {
    const JointedBody::Response& response = body_.response[free];
    advanceFreely(free, response, motor);
    ContactProblem& problem = contacts_.problem;
    for (int i = 0; i < problem.rows(); ++i) respond(response, free, &contacts_.rows[i]);
    for (int i = 0; i < problem.rows(); ++i) {
      for (int j = 0; j <= i; ++j) problem.a[i][j] = problem.a[j][i] = coupling(i, j);
      problem.b[i] = velocity(contacts_.rows[i]) - contacts_.target_speed[i];
    }
    problem.solve();
    for (int i = 0; i < problem.rows(); ++i) push(contacts_.rows[i], problem.x[i]);
  }

  /// Computes the velocities without the floor.
  void advanceFreely(int free, const JointedBody::Response& response, const double motor[2]) {
    const btVector3& w = before_.turning;
    const double around = w.dot(body_.axle);
    const double spins = before_.spin[0] + before_.spin[1];
    const btVector3 momentum =
        body_.inertia * w + body_.axle * (body_.spin_inertia * (spins + 2 * around));
    btVector3 twist = momentum.cross(w) * dt_;  // Euler's equation in the rotating frame
    double spin[2] = {0, 0};
    for (int wheel = 0; wheel < 2; ++wheel) {
      if (free >> wheel & 1) {
        spin[wheel] = motor[wheel];
      } else {
        twist -= body_.axle * (body_.spin_inertia * (target_[wheel] - before_.spin[wheel]));
      }
    }
    twist += springs_twist_;
    const double impulse[5] = {twist.x(), twist.y(), twist.z(), spin[0], spin[1]};
    double change[5];
    for (int i = 0; i < 5; ++i) {
      change[i] = 0;
      for (int j = 0; j < 5; ++j) change[i] += response[i][j] * impulse[j];
    }
    // The velocity that is stored is that of the origin: the centre has moved on around it since.
    const btVector3 centripetal = w.cross(w.cross(body_.centre));
    after_.linear = before_.linear - (centripetal + up_ * gravity_) * dt_ + springs_push_;
    after_.turning = w + btVector3(change[0], change[1], change[2]);
    for (int wheel = 0; wheel < 2; ++wheel) {
      const bool is_free = free >> wheel & 1;
      after_.spin[wheel] = is_free ? before_.spin[wheel] + change[3 + wheel] : target_[wheel];
    }
  }

  static void respond(const JointedBody::Response& response, int free, ContactRow* row) {
    const double impulse[5] = {row->angular.x(), row->angular.y(), row->angular.z(), row->spin[0],
                               row->spin[1]};
    const int responding = free ? 5 : 3;  // held wheels keep their speeds
    row->turning[3] = row->turning[4] = 0;
    for (int i = 0; i < responding; ++i) {
      row->turning[i] = 0;
      for (int j = 0; j < responding; ++j) row->turning[i] += response[i][j] * impulse[j];
    }
  }

  double coupling(int i, int j) const {
    const ContactRow &r = contacts_.rows[i], &s = contacts_.rows[j];
    return r.linear.dot(s.linear) * body_.inverse_mass + r.angular.x() * s.turning[0] +
           r.angular.y() * s.turning[1] + r.angular.z() * s.turning[2] + r.spin[0] * s.turning[3] +
           r.spin[1] * s.turning[4];
  }

  double velocity(const ContactRow& r) const {
    return r.linear.dot(after_.linear) + r.angular.dot(after_.turning) +
           r.spin[0] * after_.spin[0] + r.spin[1] * after_.spin[1];
  }

  void push(const ContactRow& r, double impulse) {
    after_.linear += r.linear * (impulse * body_.inverse_mass);
    after_.turning += btVector3(r.turning[0], r.turning[1], r.turning[2]) * impulse;
    for (int wheel = 0; wheel < 2; ++wheel) after_.spin[wheel] += r.turning[3 + wheel] * impulse;
  }

  /// Returns the impulse that the motor of a held wheel gave in this step [Nm s].
  double motorImpulse(int wheel) const {
    const btVector3 turned = after_.turning - before_.turning;
    double needed =
        body_.spin_inertia * (target_[wheel] - before_.spin[wheel] + turned.dot(body_.axle));
    const ContactProblem& problem = contacts_.problem;
    for (int i = 0; i < problem.rows(); ++i) {
      needed -= contacts_.rows[i].spin[wheel] * problem.x[i];
    }
    return needed;
  }

  FleetState& f_;
  const int robot_;
  const DriveParameters& drive_;
  const JointedBody& body_;
  Stance& stance_;
  const Tilt tilt_;
  const btMatrix3x3 to_heading_;
  const btVector3 up_;  // vertical, in the chassis frame
  const double dt_, gravity_, floor_friction_;
  const Ground ground_;  // ground under its wheels
  double cos_yaw_ = 1, sin_yaw_ = 0;
  double target_[2];  // target speeds of the wheels
  Velocities before_, after_;
  btVector3 springs_push_{0, 0, 0};   // change of velocity by the springs [m/s]
  btVector3 springs_twist_{0, 0, 0};  // angular impulse of the springs [Nm s]
  FloorContacts contacts_;
};

}  // namespace

void driveJointed(RobotView& world, int robot) { JointedStep(world, robot).run(); }

Vehicle jointedVehicle(const Scene& world, int robot, const Ground& ground) {
  const Robot& r = world.fleet.robots[robot];
  const JointedBody& body = jointedBody(world, robot);
  Vehicle v = vehicleOf(r, ground);
  const double height = body.centre.z() + body.axle_height;
  v.lift_ahead = height / body.rear_reach;
  v.lift_braking = height / body.front_reach;
  v.lift_sideways = height / r.drive.wheel_separation;
  const double reach = v.centre[0] > 0 ? body.front_reach : body.rear_reach;
  const double leaning = std::abs(v.centre[0]) / reach;  // share of the weight on a caster's stop
  const double on_wheels = r.drive.drive_wheel_load - leaning;
  for (int wheel = 0; wheel < 2; ++wheel) {
    v.friction[wheel] = r.grip * std::min(body.wheels[wheel].friction, ground.friction[wheel]);
    v.grip[wheel] = v.friction[wheel] * v.mass * ground.gravity * v.weight(wheel, on_wheels);
  }
  return v;
}

void settleJointed(RobotView& world, int robot) {
  FleetState& f = world.fleet;
  Stance& stance = f.stance[robot];
  const Tilt tilt(stance);
  const btVector3 turning = tilt.turning(stance, f.yaw_rate[robot]);
  const double heading_rate = f.yaw_rate[robot];
  stance.height += stance.climb_rate * world.clock.dt;
  stance.pitch += (turning.y() * tilt.cos_roll - turning.z() * tilt.sin_roll) * world.clock.dt;
  stance.roll += (turning.x() + heading_rate * tilt.sin_pitch) * world.clock.dt;
}

bool restJointed(FleetState& f, int robot) {
  Stance& s = f.stance[robot];
  const double rocking =
      std::max({std::abs(s.climb_rate), std::abs(s.roll_rate), std::abs(s.pitch_rate)});
  if (rocking > kSteady) return false;
  s.climb_rate = s.roll_rate = s.pitch_rate = 0;
  return true;
}

}  // namespace kiva
