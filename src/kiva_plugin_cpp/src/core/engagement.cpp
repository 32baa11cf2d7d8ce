// SPDX-License-Identifier: Apache-2.0
#include "engagement.h"

#include <algorithm>
#include <cmath>

#include "commands.h"
#include "cruise.h"
#include "jointed.h"
#include "load.h"
#include "models.h"
#include "surroundings.h"
#include "traction.h"

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

std::uint64_t lingerSteps(const Parts& parts) {
  return static_cast<std::uint64_t>(std::ceil(kLinger / parts.dt));
}

bool isJointed(const Robot& robot) { return robot.drive.drive == Drive::kJointed; }

/// A standing unit with the mass of its items.
ModelBodies buildUnit(const Parts& parts, const Model& model) {
  const StorageUnit& unit = parts.units[model.index];
  ModelDescription loaded = *model.description;
  double own = 0;
  for (const Link& link : loaded.links) own += link.mass;
  for (Link& link : loaded.links) {
    link.mass *= unit.mass / own;
    link.principal_moments *= unit.mass / own;
  }
  ModelBodies bodies = parts.physics.build(loaded, model.pose, unit.model, kDynamicGroup, ~0);
  for (LinkBody& link : bodies.links) link.body->setActivationState(ISLAND_SLEEPING);
  return bodies;
}

void engageOther(Parts& parts, int slot) {
  Model& other = *parts.models[slot];
  if (!canEngage(other)) return;
  if (other.kind == ModelKind::kStorageUnit && parts.units[other.index].carrier >= 0) {
    engage(parts, parts.modelOf(parts.units[other.index].carrier));
  } else {
    engage(parts, other);
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
double inspect(Parts& parts, const Footprint& own, double speed, double reach,
               std::vector<int>* close) {
  const double farthest = kNear + (speed + parts.top_speed + kCornerSpeed) * parts.dt;
  double least = reach;
  parts.obstacles.near(own.x, own.y, radiusOf(own) + reach, [&](const Footprint& other) {
    if (other.model == own.model || (own.group >= 0 && other.group == own.group)) return;
    if (other.z_min > own.z_max || other.z_max < own.z_min) return;
    if (!mayBeWithin(std::max(least, farthest), own, other)) return;
    const double distance = gap(own, other);
    least = std::min(least, distance);
    const bool is_robot = other.group >= 0 && other.group < parts.fleet.size();
    const double theirs = is_robot ? pointSpeed(parts.fleet, other.group) : 0;
    if (distance < kNear + (speed + theirs) * parts.dt) close->push_back(other.model);
  });
  return least;
}

/// What the robot may cover of the floor within `time` [s], by what it is at.
Footprint sweep(const Fleet& f, int i, double time) {
  const Robot& r = f.robots[i];
  Footprint own = outlineOf(f, i);
  own.hx += kAstray;
  own.hy += kAstray;
  if (r.legs.empty() || r.legs.front().kind == Leg::Kind::kTurn) own = turned(own);
  if (!r.legs.empty() && r.legs.front().kind != Leg::Kind::kDrive) return own;
  own.hx += std::max(r.drive.speed, std::hypot(f.vx[i], f.vy[i])) * time;  // either way
  return own;
}

/// Lets the robot look again later if nothing can come near for a while.
bool lookFar(Parts& parts, int robot) {
  if (parts.fleet.engaged[robot]) return false;
  for (const double time : kHorizons) {
    if (!isClear(parts, robot, sweep(parts.fleet, robot, time), time)) continue;
    parts.fleet.look_again[robot] =
        parts.total_steps + static_cast<std::uint64_t>(std::max(1.0, time / parts.dt));
    return true;
  }
  return false;
}

void lookAround(Parts& parts, int robot) {
  if (lookFar(parts, robot)) return;
  Fleet& f = parts.fleet;
  const double speed = pointSpeed(f, robot);
  double least = kReach;
  std::vector<int> close;
  for (const Footprint& own : parts.obstacles.footprints(robot)) {
    least = std::min(least, inspect(parts, own, speed, kReach, &close));
  }
  if (!close.empty()) engage(parts, parts.modelOf(robot));
  for (int slot : close) engageOther(parts, slot);
  // It may be another that comes, and both may speed up.
  const double way = 2 * (parts.top_speed + kCornerSpeed) * parts.dt;
  const double free_steps = (least - kNear) / way - 1;
  f.look_again[robot] = parts.total_steps + static_cast<std::uint64_t>(std::max(0.0, free_steps));
}

bool isMoving(const Parts& parts, int robot) {
  return !parts.fleet.robots[robot].legs.empty() || !atRest(parts.fleet, robot);
}

/// A body that moves by itself: what it could hit enters Bullet too.
void lookAroundBody(Parts& parts, Model& model) {
  double fastest = 0;
  bool awake = false;
  for (const LinkBody& link : model.bodies.links) {
    awake = awake || link.body->isActive();
    fastest = std::max(fastest, link.body->getLinearVelocity().length());
  }
  if (!awake) return;
  const double near = kNear + 4 * fastest * parts.dt;
  std::vector<int> close;
  for (const Outline& outline : model.outlines) {
    inspect(parts, parts.obstacles[outline.handle], 4 * fastest, near, &close);
  }
  for (int slot : close) engageOther(parts, slot);
}

bool standsStill(const Parts& parts, const Model& unit) {
  const btRigidBody& body = *unit.bodies.links.front().body;
  const double up = body.getWorldTransform().getBasis().getColumn(2).z();
  return up > kTilt && body.getLinearVelocity().length() < kStill &&
         body.getAngularVelocity().length() < kStill && unitPose(parts, unit.index).Z() < kAbove;
}

/// Who nobody came near for a while, and a unit that was pushed as soon as it has come to rest:
/// else it and a robot beside it would keep each other in Bullet.
bool mayLeave(const Parts& parts, const Model& model) {
  const bool is_alone = model.engaged_until < parts.total_steps;
  if (model.kind == ModelKind::kRobot || !model.disturbed) return is_alone;
  const bool rests = model.bodies.links.front().body->getDeactivationTime() > kLinger;
  return (is_alone || rests) && standsStill(parts, model);
}

/// Takes over where Bullet left the unit, upright on its legs.
void settleUnit(Parts& parts, Model& model) {
  if (model.disturbed) {
    const Pose pose = unitPose(parts, model.index);
    model.pose = Pose(pose.X(), pose.Y(), 0, 0, 0, pose.Rot().Yaw());
    ++parts.units_revision;
  }
  model.disturbed = false;
}

void release(Parts& parts) {
  for (std::size_t k = 0; k < parts.engaged.size();) {
    Model& model = *parts.models[parts.engaged[k]];
    if (mayLeave(parts, model)) {
      disengage(parts, model);  // removes entry k
    } else {
      ++k;
    }
  }
}

void pullPlanar(Parts& parts, int robot) {
  Fleet& f = parts.fleet;
  const btRigidBody& body = *parts.modelOf(robot).bodies.links.front().body;
  const btVector3& at = body.getWorldTransform().getOrigin();
  const btVector3 ahead = body.getWorldTransform().getBasis().getColumn(0);
  f.x[robot] = at.x();
  f.y[robot] = at.y();
  f.yaw[robot] += wrapAngle(std::atan2(ahead.y(), ahead.x()) - f.yaw[robot]);
  f.vx[robot] = body.getLinearVelocity().x();
  f.vy[robot] = body.getLinearVelocity().y();
  f.yaw_rate[robot] = body.getAngularVelocity().z();
  for (int wheel = 0; wheel < 2; ++wheel) {
    f.wheel_angle[wheel][robot] += f.wheel_speed[wheel][robot] * parts.dt;
  }
}

void moveRobotOutlines(Parts& parts, int robot) {
  const Fleet& f = parts.fleet;
  const bool loaded = f.unit[robot] >= 0;
  const bool still = f.vx[robot] == 0 && f.vy[robot] == 0 && f.yaw_rate[robot] == 0;
  if (!still) parts.obstacles.follow(robot);
  const bool lifts = loaded && f.state[robot] == State::kLifting;
  if (lifts) updateOutlines(parts, parts.modelOf(robot));
  if (loaded && (lifts || !still)) ++parts.units_revision;
}

/// A robot that stands without a command is left alone until it gets one, or is hit.
void letRest(Fleet& f, int robot) {
  if (!f.robots[robot].legs.empty() || f.engaged[robot] || !atRest(f, robot)) return;
  if (isJointed(f.robots[robot]) && !restJointed(f, robot)) return;
  f.vx[robot] = f.vy[robot] = f.yaw_rate[robot] = 0;
  f.wheel_speed[0][robot] = f.wheel_speed[1][robot] = 0;
  f.awake[robot] = f.tower[robot] > 0 && f.unit[robot] < 0;  // an empty tower still comes down
}

bool isAwake(const Model& model) {
  return std::any_of(model.bodies.links.begin(), model.bodies.links.end(),
                     [](const LinkBody& link) { return link.body->isActive(); });
}

void pullBodies(Parts& parts) {
  for (int slot : parts.bodies) {
    Model& model = *parts.models[slot];
    if (!isAwake(model)) continue;
    updateOutlines(parts, model);
    if (model.kind == ModelKind::kItem) ++parts.units_revision;
  }
  for (int slot : parts.engaged) {
    Model& model = *parts.models[slot];
    if (model.kind != ModelKind::kStorageUnit || !model.disturbed || !isAwake(model)) continue;
    updateOutlines(parts, model);
    ++parts.units_revision;
  }
}

/// Who is awake and does not cruise. Most blocks of a large fleet have none, and cost little.
void findActive(Parts& parts) {
  const Fleet& f = parts.fleet;
  parts.active.clear();
  constexpr int kBlock = 16;
  for (int begin = 0; begin < f.size(); begin += kBlock) {
    const int end = std::min(begin + kBlock, f.size());
    std::int64_t any = 0;
    for (int i = begin; i < end; ++i) any |= f.awake[i] & ~f.cruising[i];
    if (any == 0) continue;
    for (int i = begin; i < end; ++i) {
      if (f.awake[i] && f.cruising[i] == 0) parts.active.push_back(i);
    }
  }
}

}  // namespace

ModelBodies buildPlanar(const Parts& parts, int robot) {
  const Robot& r = parts.fleet.robots[robot];
  const Model& model = parts.modelOf(robot);
  Link link;
  link.mass = r.mass + r.load_mass;
  const double inertia = r.inertia + r.load_inertia;
  link.principal_moments.Set(inertia, inertia, inertia);
  link.gravity = false;
  ModelDescription planar;
  planar.links.push_back(link);
  ModelBodies bodies =
      parts.physics.build(planar, basePose(parts, robot), r.model, kRobotGroup, ~kFloorGroup);
  LinkBody& body = bodies.links.front();
  const btTransform base = toBullet(basePose(parts, robot)).inverse();
  const auto add = [&](const Model& part_of, int slot) {
    for (std::size_t i = 0; i < part_of.description->links.size(); ++i) {
      const btTransform at = base * toBullet(linkPose(parts, part_of, static_cast<int>(i)));
      for (const Collision& collision : part_of.description->links[i].collisions) {
        body.shape.add(collision, at * toBullet(collision.pose_in_link), slot);
      }
    }
  };
  add(model, r.model);
  const int unit = parts.fleet.unit[robot];
  if (unit >= 0) add(*parts.models[parts.units[unit].model], parts.units[unit].model);
  body.body->setLinearFactor({1, 1, 0});
  body.body->setAngularFactor({0, 0, 1});
  body.body->setActivationState(DISABLE_DEACTIVATION);
  return bodies;
}

bool canEngage(const Model& model) {
  return model.kind == ModelKind::kRobot || model.kind == ModelKind::kStorageUnit;
}

ModelBodies buildEngaged(const Parts& parts, const Model& model) {
  if (model.kind == ModelKind::kRobot) return buildPlanar(parts, model.index);
  return buildUnit(parts, model);
}

void engage(Parts& parts, Model& model) {
  model.engaged_until = parts.total_steps + lingerSteps(parts);
  if (model.in_physics) return;
  const int slot = parts.slot_of_name.at(model.name);
  if (model.kind == ModelKind::kRobot) stopCruise(parts.fleet, model.index);
  model.bodies = buildEngaged(parts, model);
  if (model.kind == ModelKind::kRobot) {
    parts.fleet.engaged[model.index] = 1;
    parts.fleet.awake[model.index] = 1;
  }
  parts.physics.insert(model.bodies);
  model.in_physics = true;
  parts.engaged.push_back(slot);
}

void disengage(Parts& parts, Model& model) {
  const int slot = parts.slot_of_name.at(model.name);
  if (model.kind == ModelKind::kStorageUnit) settleUnit(parts, model);
  parts.physics.remove(model.bodies);
  model.bodies = ModelBodies();
  model.in_physics = false;
  if (model.kind == ModelKind::kRobot) parts.fleet.engaged[model.index] = 0;
  parts.engaged.erase(std::remove(parts.engaged.begin(), parts.engaged.end(), slot),
                      parts.engaged.end());
  updateOutlines(parts, model);
}

void rebuildBody(Parts& parts, int robot) {
  Model& model = parts.modelOf(robot);
  if (!model.in_physics) return;
  disengage(parts, model);
  engage(parts, model);
}

void updateEngagement(Parts& parts) {
  const Fleet& f = parts.fleet;
  if (parts.options.always_in_bullet) {
    for (int i = 0; i < f.size(); ++i) engage(parts, parts.modelOf(i));
  }
  findActive(parts);
  for (int i : parts.active) {
    if (f.look_again[i] <= parts.total_steps && isMoving(parts, i)) lookAround(parts, i);
  }
  for (int slot : parts.bodies) lookAroundBody(parts, *parts.models[slot]);
  const std::vector<int> engaged = parts.engaged;  // it grows meanwhile
  for (int slot : engaged) {
    Model& model = *parts.models[slot];
    if (model.kind == ModelKind::kStorageUnit && model.disturbed) lookAroundBody(parts, model);
  }
  release(parts);
  findActive(parts);  // who was engaged has woken
}

void drive(Parts& parts) {
  Fleet& f = parts.fleet;
  for (int i : parts.active) {
    if (f.cruising[i] != 0) continue;  // since this step
    if (isJointed(f.robots[i])) {
      driveJointed(parts, i);
    } else {
      applyTraction(f, i, parts.gravityDown(), parts.dt);
    }
    if (!f.engaged[i]) continue;
    btRigidBody& body = *parts.modelOf(i).bodies.links.front().body;
    body.setLinearVelocity({f.vx[i], f.vy[i], 0});
    body.setAngularVelocity({0, 0, f.yaw_rate[i]});
  }
}

void settle(Parts& parts) {
  Fleet& f = parts.fleet;
  for (int i : parts.active) {
    if (f.cruising[i] != 0) continue;
    if (f.engaged[i]) {
      pullPlanar(parts, i);
    } else {
      integrate(f, i, parts.dt);
    }
    if (isJointed(f.robots[i])) settleJointed(parts, i);
    moveRobotOutlines(parts, i);
    letRest(f, i);
  }
  cruise(parts);
  pullBodies(parts);
}

}  // namespace kiva
