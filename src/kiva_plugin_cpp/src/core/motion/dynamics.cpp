// SPDX-License-Identifier: Apache-2.0
#include "core/motion/dynamics.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/angle.h"
#include "core/motion/driving/cruise.h"
#include "core/motion/driving/drives.h"
#include "core/motion/driving/self_location.h"
#include "core/motion/joints/jointed.h"
#include "core/motion/joints/joints.h"
#include "core/motion/wheels/ground.h"
#include "core/motion/wheels/traction.h"
#include "core/parallel/workers.h"
#include "core/state/places/footprints.h"
#include "core/state/progress/path_progress.h"

namespace kiva {
namespace {

constexpr int kDrivesTogether = 128;  // on one thread: fewer do not justify waking another

bool isJointed(const Robot& robot) { return robot.drive.drive == Drive::kJointed; }

btRigidBody& bodyOf(const Scene& world, int robot) {
  return *world.models.of(world.fleet.robots[robot]).bodies.links.front().body;
}

void pushBody(const Scene& world, int robot) {
  const Fleet& f = world.fleet;
  btRigidBody& body = bodyOf(world, robot);
  const btVector3 turning(0, 0, f.yaw_rate[robot]);
  const btVector3 arm = toBullet(centreFromOrigin(f, robot));
  body.setLinearVelocity(btVector3(f.vx[robot], f.vy[robot], 0) + turning.cross(arm));
  body.setAngularVelocity(turning);
}

void readBody(RobotView& world, int robot) {
  Fleet& f = world.fleet;
  const btRigidBody& body = bodyOf(world, robot);
  // The robot's origin before its motion, to which the integration in arrays refers.
  const btVector3 arm = toBullet(centreFromOrigin(f, robot));
  const btVector3 velocity = body.getLinearVelocity() - body.getAngularVelocity().cross(arm);
  const btTransform pose =
      world.models.of(world.fleet.robots[robot]).bodies.links.front().linkPose();
  const btVector3 at = pose.getOrigin(), ahead = pose.getBasis().getColumn(0);
  f.x[robot] = at.x();
  f.y[robot] = at.y();
  f.yaw[robot] += wrapAngle(std::atan2(ahead.y(), ahead.x()) - f.yaw[robot]);
  f.vx[robot] = velocity.x();
  f.vy[robot] = velocity.y();
  f.yaw_rate[robot] = body.getAngularVelocity().z();
  for (int wheel = 0; wheel < 2; ++wheel) {
    f.wheel_angle[wheel][robot] += f.wheel_speed[wheel][robot] * world.clock.dt;
  }
}

/// Returns whether a robot at rest has no work until a command or another model moves it.
bool hasNothingToDo(const FleetState& f, int robot) {
  const Phase phase = f.tasks[robot].phase;
  if (phase == Phase::kIdle || phase == Phase::kWaiting) return true;
  if (phase == Phase::kSteered) return f.steering(robot).rests();
  return isHeld(f, robot) && (phase == Phase::kStarting || f.reference_speed[robot] == 0);
}

/// Puts a robot to sleep that stands without a command, waits, or is stopped, until it goes on or
/// is hit.
void letRest(FleetState& f, int robot) {
  const bool is_settled = atRest(f, robot) && f.sway[robot].tilt == 0;
  if (!hasNothingToDo(f, robot) || f.activated[robot] || !is_settled) return;
  if (isJointed(f.robots[robot]) && !restJointed(f, robot)) return;
  f.vx[robot] = f.vy[robot] = f.yaw_rate[robot] = 0;
  f.wheel_speed[0][robot] = f.wheel_speed[1][robot] = 0;
  // A tower without a load still comes down.
  f.awake[robot] = f.tasks[robot].phase == Phase::kIdle && f.tower[robot] > 0 &&
                   f.unit[robot] < 0 && !isHeld(f, robot);
}

/// Drives each robot by itself, on all threads.
void driveByTraction(RobotView& world) {
  FleetState& f = world.fleet;
  const std::vector<int>& robots = world.schedule.stepped_singly;
  world.schedule.workers->share(static_cast<int>(robots.size()), kDrivesTogether,
                                [&](int begin, int end) {
                                  for (int k = begin; k < end; ++k) {
                                    const int i = robots[k];
                                    if (f.cruising[i] != 0 || isJointed(f.robots[i])) continue;
                                    applyTraction(f, i, groundUnder(world, i), world.clock.dt);
                                  }
                                });
}

void integrateRobots(MotionView& world) {
  FleetState& f = world.fleet;
  for (int i : world.schedule.stepped_singly) {
    if (f.cruising[i] != 0) continue;  // since this step
    if (f.activated[i]) {
      readBody(world, i);
    } else {
      integrate(f, i, world.clock.dt);
    }
    if (isJointed(f.robots[i])) settleJointed(world, i);
    followRobot(f, world.obstacles, world.storage, i);
    if (f.localises) track(world, i);
    if (f.tasks[i].follows() && f.tasks[i].drives()) countPoints(world, i, alongSegment(f, i));
    letRest(f, i);
  }
  cruise(world);
}

void followBodies(MotionView& world) {
  for (int slot : world.models.bodies) {
    if (isAwake(*world.models[slot])) moved(world, *world.models[slot]);
  }
  for (int slot : world.models.activated) {
    Model& model = *world.models[slot];
    if (model.disturbed && isAwake(model)) moved(world, model);
  }
}

}  // namespace

void actuate(MotionView& world) {
  driveByTraction(world);
  for (int i : world.schedule.stepped_singly) {
    const FleetState& f = world.fleet;
    if (f.cruising[i] != 0) continue;
    if (isJointed(f.robots[i])) driveJointed(world, i);
    if (f.activated[i]) pushBody(world, i);
  }
  driveJoints(world.models, world.clock.dt);
}

void integrate(MotionView& world) {
  integrateRobots(world);
  followBodies(world);
  readJoints(world.models);
}

void wakeBodies(ModelTable& models) {
  for (int slot : models.bodies) {
    for (LinkBody& link : models[slot]->bodies.links) link.body->activate();
  }
}

}  // namespace kiva
