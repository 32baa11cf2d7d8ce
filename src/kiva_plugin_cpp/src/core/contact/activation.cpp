// SPDX-License-Identifier: Apache-2.0
#include "core/contact/activation.h"

#include <algorithm>
#include <cmath>

#include "core/control/commands.h"
#include "core/models/load.h"
#include "core/models/models.h"
#include "core/motion/clearance.h"
#include "core/motion/cruise.h"
#include "core/motion/drives.h"
#include "core/motion/jointed.h"
#include "core/motion/traction.h"

namespace kiva {
namespace {

constexpr double kReach = 0.3;                     // [m] around a robot in which to look
constexpr double kLinger = 0.05;                   // [s] in Bullet after the last one was near
constexpr double kCornerSpeed = 3.2;               // [m/s] of a chassis' corner in the fastest turn
constexpr double kHorizons[] = {0.2, 0.06, 0.02};  // [s] for which a robot may be alone
constexpr double kAstray = 0.001;                  // [m] it may be beside its way by then
constexpr double kStill = 1e-3;     // [m/s]: a unit slower than that may leave Bullet
constexpr double kTilt = 1 - 5e-5;  // cosine: a unit more upright stands on its legs
constexpr double kAbove = 0.002;    // [m]: a unit higher than that stands on something else

std::uint64_t lingerSteps(const WorldState& world) {
  return static_cast<std::uint64_t>(std::ceil(kLinger / world.dt));
}

bool isJointed(const Robot& robot) { return robot.drive.drive == Drive::kJointed; }

/// A standing unit with the mass of its items.
ModelBodies buildUnit(const WorldState& world, const Model& model) {
  const StorageUnit& unit = world.units[model.index];
  ModelDescription loaded = *model.description;
  double own = 0;
  for (const Link& link : loaded.links) own += link.mass;
  for (Link& link : loaded.links) {
    link.mass *= unit.mass / own;
    link.principal_moments *= unit.mass / own;
  }
  ModelBodies bodies = world.physics.build(loaded, model.pose, unit.model, kDynamicGroup, ~0);
  for (LinkBody& link : bodies.links) link.body->setActivationState(ISLAND_SLEEPING);
  return bodies;
}

void activateOther(WorldState& world, int slot) {
  Model& other = *world.models[slot];
  if (!canActivate(other)) return;
  if (other.kind == ModelKind::kStorageUnit && world.units[other.index].carrier >= 0) {
    activate(world, world.modelOf(world.units[other.index].carrier));
  } else {
    activate(world, other);
  }
}

/// How fast any point of it may go within the next step [m/s].
double pointSpeed(const Fleet& f, int i) {
  const Robot& r = f.robots[i];
  const double corner = std::hypot(std::max(r.half_length, r.load_half_length),
                                   std::max(r.half_width, r.load_half_width));
  double speed = std::hypot(f.vx[i], f.vy[i]) + std::abs(f.yaw_rate[i]) * corner;
  const bool at_once = r.drive.acceleration == 0 || r.drive.quarter_turn_time == 0;
  return at_once ? std::max(speed, r.drive.speed + kCornerSpeed) : speed;
}

/// What the footprint, no point of which goes faster than `speed` [m/s], could touch in the next
/// step goes to `close`. Returns the least gap to anything foreign, at most `reach`; both in [m].
double inspect(WorldState& world, const Footprint& own, double speed, double reach,
               std::vector<int>* close) {
  const double farthest = kNear + (speed + world.top_speed + kCornerSpeed) * world.dt;
  double least = reach;
  world.obstacles.near(own.x, own.y, radiusOf(own) + reach, [&](const Footprint& other) {
    if (other.model == own.model || (own.group >= 0 && other.group == own.group)) return;
    if (other.z_min > own.z_max || other.z_max < own.z_min) return;
    if (!mayBeWithin(std::max(least, farthest), own, other)) return;
    const double distance = gap(own, other);
    least = std::min(least, distance);
    const bool is_robot = other.group >= 0 && other.group < world.fleet.size();
    const double theirs = is_robot ? pointSpeed(world.fleet, other.group) : 0;
    if (distance < kNear + (speed + theirs) * world.dt) close->push_back(other.model);
  });
  return least;
}

/// What the robot may cover of the floor within `time` [s], by what it is at.
Footprint sweep(const Fleet& f, int i, double time) {
  const Robot& r = f.robots[i];
  Footprint own = footprintOf(f, i);
  own.hx += kAstray;
  own.hy += kAstray;
  if (r.segments.empty() || r.segments.front().kind == MotionSegment::Kind::kTurn)
    own = turned(own);
  if (!r.segments.empty() && r.segments.front().kind != MotionSegment::Kind::kDrive) return own;
  own.hx += std::max(r.drive.speed, std::hypot(f.vx[i], f.vy[i])) * time;  // either way
  return own;
}

/// Lets the robot look again later if nothing can come near for a while.
bool lookFar(WorldState& world, int robot) {
  if (world.fleet.activated[robot]) return false;
  for (const double time : kHorizons) {
    if (!isClear(world, robot, sweep(world.fleet, robot, time), time)) continue;
    world.fleet.look_again[robot] =
        world.total_steps + static_cast<std::uint64_t>(std::max(1.0, time / world.dt));
    return true;
  }
  return false;
}

void lookAround(WorldState& world, int robot) {
  if (lookFar(world, robot)) return;
  Fleet& f = world.fleet;
  const double speed = pointSpeed(f, robot);
  double least = kReach;
  std::vector<int> close;
  for (const Footprint& own : world.obstacles.footprints(robot)) {
    least = std::min(least, inspect(world, own, speed, kReach, &close));
  }
  if (!close.empty()) activate(world, world.modelOf(robot));
  for (int slot : close) activateOther(world, slot);
  // It may be another that comes, and both may speed up.
  const double way = 2 * (world.top_speed + kCornerSpeed) * world.dt;
  const double free_steps = (least - kNear) / way - 1;
  f.look_again[robot] = world.total_steps + static_cast<std::uint64_t>(std::max(0.0, free_steps));
}

bool isMoving(const WorldState& world, int robot) {
  return !world.fleet.robots[robot].segments.empty() || !atRest(world.fleet, robot);
}

/// A body that moves by itself: what it could hit enters Bullet too.
void lookAroundBody(WorldState& world, Model& model) {
  double fastest = 0;
  bool awake = false;
  for (const LinkBody& link : model.bodies.links) {
    awake = awake || link.body->isActive();
    fastest = std::max(fastest, link.body->getLinearVelocity().length());
  }
  if (!awake) return;
  const double near = kNear + 4 * fastest * world.dt;
  std::vector<int> close;
  for (const CollisionGeometry& geometry : model.geometries) {
    Footprint own = world.obstacles[geometry.handle];
    own.z_min -= near;  // it may fall, or be thrown, upon something
    own.z_max += near;
    inspect(world, own, 4 * fastest, near, &close);
  }
  for (int slot : close) activateOther(world, slot);
}

bool standsStill(const WorldState& world, const Model& unit) {
  const btRigidBody& body = *unit.bodies.links.front().body;
  const double up = body.getWorldTransform().getBasis().getColumn(2).z();
  return up > kTilt && body.getLinearVelocity().length() < kStill &&
         body.getAngularVelocity().length() < kStill && unitPose(world, unit.index).Z() < kAbove;
}

/// Who nobody came near for a while, and a unit that was pushed as soon as it has come to rest:
/// else it and a robot beside it would keep each other in Bullet.
bool mayLeave(const WorldState& world, const Model& model) {
  const bool is_alone = model.active_until < world.total_steps;
  if (model.kind == ModelKind::kRobot || !model.disturbed) return is_alone;
  const bool rests = model.bodies.links.front().body->getDeactivationTime() > kLinger;
  return (is_alone || rests) && standsStill(world, model);
}

/// Takes over where Bullet left the unit, upright on its legs.
void settleUnit(WorldState& world, Model& model) {
  if (model.disturbed) {
    const Pose pose = unitPose(world, model.index);
    model.pose = Pose(pose.X(), pose.Y(), 0, 0, 0, pose.Rot().Yaw());
    ++world.units_revision;
  }
  model.disturbed = false;
}

void release(WorldState& world) {
  for (std::size_t k = 0; k < world.activated.size();) {
    Model& model = *world.models[world.activated[k]];
    if (mayLeave(world, model)) {
      deactivate(world, model);  // removes entry k
    } else {
      ++k;
    }
  }
}

void pullPlanar(WorldState& world, int robot) {
  Fleet& f = world.fleet;
  const LinkBody& planar = world.modelOf(robot).bodies.links.front();
  // Of the robot's origin before it moved, as what integrates robots in arrays leaves it.
  const btVector3 arm = toBullet(centreFromOrigin(f, robot));
  const btVector3 velocity =
      planar.body->getLinearVelocity() - planar.body->getAngularVelocity().cross(arm);
  const btTransform pose = planar.linkPose();
  const btVector3 at = pose.getOrigin(), ahead = pose.getBasis().getColumn(0);
  f.x[robot] = at.x();
  f.y[robot] = at.y();
  f.yaw[robot] += wrapAngle(std::atan2(ahead.y(), ahead.x()) - f.yaw[robot]);
  f.vx[robot] = velocity.x();
  f.vy[robot] = velocity.y();
  f.yaw_rate[robot] = planar.body->getAngularVelocity().z();
  for (int wheel = 0; wheel < 2; ++wheel) {
    f.wheel_angle[wheel][robot] += f.wheel_speed[wheel][robot] * world.dt;
  }
}

void moveRobotFootprints(WorldState& world, int robot) {
  const Fleet& f = world.fleet;
  const bool loaded = f.unit[robot] >= 0;
  const bool still = f.vx[robot] == 0 && f.vy[robot] == 0 && f.yaw_rate[robot] == 0;
  if (!still) world.obstacles.follow(robot);
  const bool lifts = loaded && f.state[robot] == State::kLifting;
  if (lifts) updateFootprints(world, world.modelOf(robot));
  if (loaded && (lifts || !still)) ++world.units_revision;
}

/// A robot that stands without a command is left alone until it gets one, or is hit.
void letRest(Fleet& f, int robot) {
  if (!f.robots[robot].segments.empty() || f.activated[robot] || !atRest(f, robot)) return;
  if (isJointed(f.robots[robot]) && !restJointed(f, robot)) return;
  f.vx[robot] = f.vy[robot] = f.yaw_rate[robot] = 0;
  f.wheel_speed[0][robot] = f.wheel_speed[1][robot] = 0;
  f.awake[robot] = f.tower[robot] > 0 && f.unit[robot] < 0;  // an empty tower still comes down
}

bool isAwake(const Model& model) {
  return std::any_of(model.bodies.links.begin(), model.bodies.links.end(),
                     [](const LinkBody& link) { return link.body->isActive(); });
}

void pullBodies(WorldState& world) {
  for (int slot : world.bodies) {
    Model& model = *world.models[slot];
    if (!isAwake(model)) continue;
    updateFootprints(world, model);
    if (model.kind == ModelKind::kItem) ++world.units_revision;
  }
  for (int slot : world.activated) {
    Model& model = *world.models[slot];
    if (model.kind != ModelKind::kStorageUnit || !model.disturbed || !isAwake(model)) continue;
    updateFootprints(world, model);
    ++world.units_revision;
  }
}

/// Who is awake and does not cruise. Most blocks of a large fleet have none, and cost little.
void findSteppedSingly(WorldState& world) {
  const Fleet& f = world.fleet;
  world.stepped_singly.clear();
  constexpr int kBlock = 16;
  for (int begin = 0; begin < f.size(); begin += kBlock) {
    const int end = std::min(begin + kBlock, f.size());
    std::int64_t any = 0;
    for (int i = begin; i < end; ++i) any |= f.awake[i] & ~f.cruising[i];
    if (any == 0) continue;
    for (int i = begin; i < end; ++i) {
      if (f.awake[i] && f.cruising[i] == 0) world.stepped_singly.push_back(i);
    }
  }
}

}  // namespace

ModelBodies buildPlanar(const WorldState& world, int robot) {
  const Robot& r = world.fleet.robots[robot];
  const Model& model = world.modelOf(robot);
  Link link;
  const Vehicle vehicle = vehicleOf(r, groundOf(world));
  link.mass = vehicle.mass;
  link.principal_moments.Set(vehicle.inertia, vehicle.inertia, vehicle.inertia);
  link.inertial_pose_in_link.Pos().Set(vehicle.centre[0], vehicle.centre[1], 0);
  link.gravity = false;
  ModelDescription planar;
  planar.links.push_back(link);
  ModelBodies bodies =
      world.physics.build(planar, basePose(world, robot), r.model, kRobotGroup, ~kFloorGroup);
  LinkBody& body = bodies.links.front();
  const btTransform base = (toBullet(basePose(world, robot)) * body.mass_frame).inverse();
  const auto add = [&](const Model& part_of, int slot) {
    for (std::size_t i = 0; i < part_of.description->links.size(); ++i) {
      const btTransform at = base * toBullet(linkPose(world, part_of, static_cast<int>(i)));
      for (const Collision& collision : part_of.description->links[i].collisions) {
        body.shape.add(collision, at * toBullet(collision.pose_in_link), slot);
      }
    }
  };
  add(model, r.model);
  const int unit = world.fleet.unit[robot];
  if (unit >= 0) add(*world.models[world.units[unit].model], world.units[unit].model);
  body.body->setLinearFactor({1, 1, 0});
  body.body->setAngularFactor({0, 0, 1});
  body.body->setActivationState(DISABLE_DEACTIVATION);
  return bodies;
}

bool canActivate(const Model& model) {
  return model.kind == ModelKind::kRobot || model.kind == ModelKind::kStorageUnit;
}

ModelBodies buildActivated(const WorldState& world, const Model& model) {
  if (model.kind == ModelKind::kRobot) return buildPlanar(world, model.index);
  return buildUnit(world, model);
}

void activate(WorldState& world, Model& model) {
  model.active_until = world.total_steps + lingerSteps(world);
  if (model.in_physics) return;
  const int slot = world.slot_of_name.at(model.name);
  if (model.kind == ModelKind::kRobot) stopCruise(world.fleet, model.index);
  model.bodies = buildActivated(world, model);
  if (model.kind == ModelKind::kRobot) {
    world.fleet.activated[model.index] = 1;
    world.fleet.awake[model.index] = 1;
  }
  world.physics.insert(model.bodies);
  model.in_physics = true;
  world.activated.push_back(slot);
}

void deactivate(WorldState& world, Model& model) {
  const int slot = world.slot_of_name.at(model.name);
  if (model.kind == ModelKind::kStorageUnit) settleUnit(world, model);
  world.physics.remove(model.bodies);
  model.bodies = ModelBodies();
  model.in_physics = false;
  if (model.kind == ModelKind::kRobot) world.fleet.activated[model.index] = 0;
  world.activated.erase(std::remove(world.activated.begin(), world.activated.end(), slot),
                        world.activated.end());
  updateFootprints(world, model);
}

void rebuildBody(WorldState& world, int robot) {
  Model& model = world.modelOf(robot);
  if (!model.in_physics) return;
  deactivate(world, model);
  activate(world, model);
}

void updateActivation(WorldState& world) {
  const Fleet& f = world.fleet;
  if (world.options.always_in_bullet) {
    for (int i = 0; i < f.size(); ++i) activate(world, world.modelOf(i));
  }
  findSteppedSingly(world);
  for (int i : world.stepped_singly) {
    if (f.look_again[i] <= world.total_steps && isMoving(world, i)) lookAround(world, i);
  }
  for (int slot : world.bodies) lookAroundBody(world, *world.models[slot]);
  const std::vector<int> activated = world.activated;  // it grows meanwhile
  for (int slot : activated) {
    Model& model = *world.models[slot];
    if (model.kind == ModelKind::kStorageUnit && model.disturbed) lookAroundBody(world, model);
  }
  release(world);
  findSteppedSingly(world);  // who was activated has woken
}

void drive(WorldState& world) {
  Fleet& f = world.fleet;
  for (int i : world.stepped_singly) {
    if (f.cruising[i] != 0) continue;  // since this step
    if (isJointed(f.robots[i])) {
      driveJointed(world, i);
    } else {
      applyTraction(f, i, groundOf(world), world.dt);
    }
    if (!f.activated[i]) continue;
    btRigidBody& body = *world.modelOf(i).bodies.links.front().body;
    const btVector3 turning(0, 0, f.yaw_rate[i]);
    body.setLinearVelocity(btVector3(f.vx[i], f.vy[i], 0) +
                           turning.cross(toBullet(centreFromOrigin(f, i))));
    body.setAngularVelocity(turning);
  }
}

void settle(WorldState& world) {
  Fleet& f = world.fleet;
  for (int i : world.stepped_singly) {
    if (f.cruising[i] != 0) continue;
    if (f.activated[i]) {
      pullPlanar(world, i);
    } else {
      integrate(f, i, world.dt);
    }
    if (isJointed(f.robots[i])) settleJointed(world, i);
    moveRobotFootprints(world, i);
    letRest(f, i);
  }
  cruise(world);
  pullBodies(world);
}

}  // namespace kiva
