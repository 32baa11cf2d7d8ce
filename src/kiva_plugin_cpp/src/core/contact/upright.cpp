// SPDX-License-Identifier: Apache-2.0
#include "core/contact/upright.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/physics/solver/sliding_friction.h"
#include "core/state/places/footprints.h"
#include "core/state/places/poses.h"
#include "core/state/places/unit_geometry.h"

namespace kiva {
namespace {

constexpr double kFootHeight = 0.005;  // [m] above the floor up to which a shape is a foot
constexpr double kVisible = 0.01;      // [rad]; a unit that rocks farther gets a whole body
constexpr double kCalm = 0.25;         // share of that energy below which it is planar again
constexpr double kAbove = 0.002;       // [m] above the floor up to which it may be planar again
constexpr double kRising = 0.02;       // [m/s] of vertical speed up to which it may be planar again
constexpr double kNoPush = 1e-3;       // [Nms]; a smaller momentum does not rock a unit
constexpr double kBurden = 0.1;        // largest pressure from above, as a share of its weight

/// The properties of a body that determine its rocking.
struct Rocking {
  double weight = 0;   // [N]
  double height = 0;   // height of the centre of mass [m]
  double support = 0;  // shortest distance from the centre of mass to a tipping edge [m]
  double inertia = 0;  // inertia about that edge, of feet that slide [kg m²]

  double energy() const { return weight * support * kVisible; }  // [J]
};

/// Returns the feet of the description, in the frame of the centre of mass.
std::vector<SlidingFoot> feetOf(const FloorState& floor, const Model& model, double weight) {
  std::vector<SlidingFoot> feet;
  const Link& link = model.description->links.front();
  const Pose to_mass = (link.pose_in_model * link.inertial_pose_in_link).Inverse();
  const auto add = [&](double x, double y, double friction) {
    const Vector3 at = to_mass.CoordPositionAdd(Vector3(x, y, 0));
    feet.push_back({toBullet(at), std::min(friction, floor.friction)});
  };
  std::vector<std::pair<Bounds, double>> soles;
  for (const Collision& c : link.collisions) {
    const Bounds box = bounds(c.shape, link.pose_in_model * c.pose_in_link);
    if (box.min.Z() < kFootHeight) soles.push_back({box, c.friction});
  }
  for (const auto& [box, friction] : soles) {
    if (soles.size() > 1) {
      add((box.min.X() + box.max.X()) / 2, (box.min.Y() + box.max.Y()) / 2, friction);
      continue;
    }
    for (double x : {box.min.X(), box.max.X()}) {
      for (double y : {box.min.Y(), box.max.Y()}) add(x, y, friction);
    }
  }
  for (SlidingFoot& foot : feet) foot.grip_limit *= weight / static_cast<double>(feet.size());
  return feet;
}

const SlidingFriction& frictionOf(const Model& model) {
  return static_cast<const SlidingFriction&>(*model.bodies.joints.front());
}

/// Returns the extent of the feet from the centre of mass in a direction.
double supportAlong(const std::vector<SlidingFoot>& feet, const btVector3& way_in_body) {
  double most = -std::numeric_limits<double>::infinity();
  for (const SlidingFoot& foot : feet) most = std::max(most, foot.at.dot(way_in_body));
  return most;
}

std::vector<btVector3> allAround() {
  std::vector<btVector3> ways;
  for (int i = 0; i < 16; ++i) {
    const double angle = i * M_PI / 8;
    ways.emplace_back(std::cos(angle), std::sin(angle), 0);
  }
  return ways;
}

double leastSupport(const std::vector<SlidingFoot>& feet) {
  static const std::vector<btVector3> ways = allAround();
  double least = std::numeric_limits<double>::infinity();
  for (const btVector3& way : ways) least = std::min(least, supportAlong(feet, way));
  return least;
}

Rocking rockingOf(const WorldSettings& settings, const btRigidBody& body,
                  const std::vector<SlidingFoot>& feet) {
  Rocking r;
  r.weight = body.getMass() * settings.gravityDown();
  if (feet.empty()) return r;
  r.height = -feet.front().at.z();
  r.support = leastSupport(feet);
  const btVector3 inertia = body.getInvInertiaDiagLocal();
  r.inertia = 1 / std::max(inertia.x(), inertia.y()) + body.getMass() * r.support * r.support;
  return r;
}

/// Returns the distance from the centre of mass to the edge over which a momentum turns it [m].
double armOf(const Model& model, const Vector3& momentum) {
  const double size = momentum.Length();
  const btVector3 way(momentum.Y() / size, -momentum.X() / size, 0);  // direction of tipping
  const btMatrix3x3& basis = model.bodies.links.front().body->getWorldTransform().getBasis();
  return supportAlong(frictionOf(model).feet(), basis.transpose() * way);
}

void rockOne(const Scene& world, Model& model, const Push& push) {
  const btRigidBody& body = *model.bodies.links.front().body;
  const SlidingFriction& friction = frictionOf(model);
  const Rocking r = rockingOf(world.settings, body, friction.feet());
  const btVector3 grip = friction.impulse(world.clock.dt);
  // Grip acts at the feet, below the centre of mass.
  Vector3 momentum = model.rocking + Vector3(push.moment.x() + r.height * grip.y(),
                                             push.moment.y() - r.height * grip.x(), 0);
  const double size = momentum.Length();
  if (size > 0)
    momentum *= std::max(0.0, 1 - r.weight * armOf(model, momentum) * world.clock.dt / size);
  model.rocking = momentum;
  model.tips = model.tips || momentum.SquaredLength() > 2 * r.inertia * r.energy();
}

/// Returns whether it carries a load, or is lifted.
bool isBurdened(const Scene& world, const Model& model, const Push& push) {
  const double weight = model.bodies.links.front().body->getMass() * world.settings.gravityDown();
  return std::abs(push.load) > kBurden * weight * world.clock.dt;
}

/// Replaces the model's body by another one with that velocity.
void exchange(ContactView& world, Model& model, const EntityState& state, bool is_disturbed) {
  world.physics.remove(model.bodies);
  model.bodies = model.owner->build(world, model);
  world.physics.insert(model.bodies);
  if (!is_disturbed) return;
  LinkBody& link = model.bodies.links.front();
  link.place(toBullet(state.pose * model.description->links.front().pose_in_model));
  link.body->setLinearVelocity(toBullet(state.twist.linear));
  link.body->setAngularVelocity(toBullet(state.twist.angular));
  link.body->forceActivationState(ACTIVE_TAG);
  moved(world, model);
}

/// Returns the velocity of the centre of mass, with the model's pose.
EntityState stateOf(const Model& model) {
  const btRigidBody& body = *model.bodies.links.front().body;
  return {canonicalState(model).pose,
          {fromBullet(body.getLinearVelocity()), fromBullet(body.getAngularVelocity())}};
}

/// Returns whether a whole body stands on its feet again and no longer rocks visibly.
bool hasCalmed(const Scene& world, const Model& model) {
  const EntityState state = canonicalState(model);
  const double tilt = std::acos(std::min(1.0, state.pose.Rot().ZAxis().Z()));
  if (tilt > kVisible || std::abs(state.pose.Z() - world.floor.extent.z) > kAbove) return false;
  const btRigidBody& body = *model.bodies.links.front().body;
  if (!body.getTotalForce().isZero() || !body.getTotalTorque().isZero()) return false;
  const btVector3 turn = body.getAngularVelocity();
  const auto feet = feetOf(world.floor, model, body.getMass() * world.settings.gravityDown());
  const Rocking r = rockingOf(world.settings, body, feet);
  const double kinetic = 0.5 * r.inertia * (turn.x() * turn.x() + turn.y() * turn.y());
  return std::abs(body.getLinearVelocity().z()) < kRising &&
         kinetic + r.weight * r.support * tilt < kCalm * r.energy();
}

void standUp(ContactView& world, Model& model) {
  EntityState state = stateOf(model);
  const Pose& pose = state.pose;
  state.pose = Pose(pose.X(), pose.Y(), world.floor.extent.z, 0, 0, pose.Rot().Yaw());
  state.twist.linear.Z() = state.twist.angular.X() = state.twist.angular.Y() = 0;
  model.pose = state.pose;
  model.upright = true;
  model.rocking = Vector3::Zero;
  exchange(world, model, state, true);
}

}  // namespace

bool canSlideUpright(const Scene& world, const Model& model) {
  const Vector3& g = world.settings.gravity;
  return model.description->links.size() == 1 && g.X() == 0 && g.Y() == 0 && g.Z() < 0 &&
         model.description->links.front().gravity && world.physics.hasPlainFloor();
}

ModelBodies buildUpright(const Scene& world, const Model& model, ModelDescription description) {
  Link& link = description.links.front();
  link.gravity = false;
  ModelBodies bodies =
      world.physics.build(description, model.pose, model.slot, kDynamicGroup, ~kFloorGroup);
  btRigidBody& body = *bodies.links.front().body;
  body.setLinearFactor({1, 1, 0});
  body.setAngularFactor({0, 0, 1});
  bodies.joints.push_back(std::make_unique<SlidingFriction>(
      body, feetOf(world.floor, model, link.mass * world.settings.gravityDown())));
  mark(*bodies.joints.back(), model.slot, 1);
  return bodies;
}

void rock(const Scene& world, ModelTable& models) {
  std::vector<Push> pushes;
  for (int slot : models.activated) {
    Model& model = *models[slot];
    if (!model.disturbed || !isAwake(model)) continue;
    if (pushes.empty()) pushes = world.physics.pushes();
    const int index = model.bodies.links.front().body->getUserIndex2();
    if (index < 0 || index >= static_cast<int>(pushes.size())) continue;
    model.tips = isBurdened(world, model, pushes[index]);
    if (model.upright) rockOne(world, model, pushes[index]);
  }
}

void letTip(ContactView& world, Model& model) {
  EntityState state = stateOf(model);
  if (!model.rocking.Equal(Vector3::Zero, kNoPush)) {
    // The unit turns about the edge, which stays on the floor, so that the centre of mass rises.
    const btRigidBody& body = *model.bodies.links.front().body;
    const Rocking r = rockingOf(world.settings, body, frictionOf(model).feet());
    state.twist.angular += model.rocking / r.inertia;
    state.twist.linear.Z() += model.rocking.Length() / r.inertia * armOf(model, model.rocking);
  }
  model.upright = model.tips = false;
  model.rocking = Vector3::Zero;
  exchange(world, model, state, model.disturbed);
}

void letAllTip(ContactView& world) {
  const std::vector<int> activated = world.models.activated;
  for (int slot : activated) {
    if (world.models[slot]->upright) letTip(world, *world.models[slot]);
  }
}

void updateUprightness(ContactView& world) {
  const std::vector<int> activated = world.models.activated;
  for (int slot : activated) {
    Model& model = *world.models[slot];
    if (model.upright) {
      if (model.tips || !canSlideUpright(world, model)) letTip(world, model);
    } else if (model.disturbed && !model.tips && model.owner->mayBeUpright(world, model) &&
               isAwake(model) && hasCalmed(world, model)) {
      standUp(world, model);
    }
  }
}

}  // namespace kiva
