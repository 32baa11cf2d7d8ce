// SPDX-License-Identifier: Apache-2.0
#include "core/motion/joints/joints.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/geometry/angle.h"
#include "core/state/places/footprints.h"

namespace kiva {
namespace {

constexpr double kNoLimit = 1e15;      // from here on a limit counts as none
constexpr double kFastestMotor = 1e6;  // speed of a motor [rad/s, m/s]
constexpr double kMostPush = 1e9;      // [Nm, N]

bool isSlider(const Joint& joint) { return joint.kind == Joint::Kind::kPrismatic; }

/// A joint in Bullet: its bodies, its anchor and its axis in world.
struct Mount {
  btTypedConstraint& constraint;
  btRigidBody& parent;
  btRigidBody& child;
  btVector3 anchor;
  btVector3 axis;
};

Mount mountOf(const Model& model, int joint) {
  btTypedConstraint& constraint = *model.bodies.joints[joint];
  btRigidBody& parent = constraint.getRigidBodyA();
  const bool slides = isSlider(model.description->joints[joint]);
  const btTransform& in_parent =
      slides ? static_cast<btSliderConstraint&>(constraint).getFrameOffsetA()
             : static_cast<btHingeConstraint&>(constraint).getAFrame();
  const btTransform frame = parent.getWorldTransform() * in_parent;
  return {constraint, parent, constraint.getRigidBodyB(), frame.getOrigin(),
          frame.getBasis().getColumn(slides ? 0 : 2)};
}

btHingeConstraint& hinge(const Mount& mount) {
  return static_cast<btHingeConstraint&>(mount.constraint);
}
btSliderConstraint& slider(const Mount& mount) {
  return static_cast<btSliderConstraint&>(mount.constraint);
}

double rateOf(const Mount& mount, bool slides) {
  if (!slides) {
    return (mount.child.getAngularVelocity() - mount.parent.getAngularVelocity()).dot(mount.axis);
  }
  const auto velocity = [&](const btRigidBody& body) {
    return body.getVelocityInLocalPoint(mount.anchor - body.getWorldTransform().getOrigin());
  };
  return (velocity(mount.child) - velocity(mount.parent)).dot(mount.axis);
}

/// Returns the inertia against a change of the joint's rate [kg m²] or [kg].
double inertiaOf(const Mount& mount, bool slides) {
  const auto yields = [&](const btRigidBody& body) {
    if (body.isStaticObject()) return 0.0;
    return slides ? body.computeImpulseDenominator(mount.anchor, mount.axis)
                  : body.computeAngularImpulseDenominator(mount.axis);
  };
  const double both = yields(mount.parent) + yields(mount.child);
  return both > 0 ? 1 / both : 0;
}

void push(const Mount& mount, bool slides, double effort) {
  const btVector3 along = mount.axis * effort;
  const auto act = [&](btRigidBody& body, const btVector3& by) {
    if (body.isStaticObject()) return;
    if (slides) {
      body.applyForce(by, mount.anchor - body.getWorldTransform().getOrigin());
    } else {
      body.applyTorque(by);
    }
  };
  act(mount.child, along);
  act(mount.parent, -along);
}

void setMotor(const Mount& mount, bool slides, double speed, double effort, double dt) {
  if (slides) {
    slider(mount).setPoweredLinMotor(effort > 0);
    slider(mount).setTargetLinMotorVelocity(speed);
    slider(mount).setMaxLinMotorForce(effort);
  } else {  // Bullet's angle of a hinge has the opposite sign
    hinge(mount).enableAngularMotor(effort > 0, -speed, effort * dt);
  }
}

void setLimits(const Mount& mount, bool slides, const JointSettings& settings) {
  if (slides) {
    slider(mount).setLowerLinLimit(settings.lower);
    slider(mount).setUpperLinLimit(settings.upper);
  } else if (settings.upper - settings.lower < 2 * SIMD_PI) {
    hinge(mount).setLimit(-settings.upper, -settings.lower);
  } else {
    hinge(mount).setLimit(1, -1);  // free
  }
}

void wake(Model& model) {
  for (LinkBody& link : model.bodies.links) link.body->activate(true);
}

bool wantsToMove(const Model& model) {
  return std::any_of(model.joints.begin(), model.joints.end(), [](const JointState& j) {
    return j.settings.motor_effort > 0 && j.settings.motor_speed != 0;
  });
}

/// Limits the stiffness to what the step can integrate; the symplectic Euler method is stable up to
/// four times that.
void spring(const Mount& mount, const Joint& joint, double position, double dt) {
  const bool slides = isSlider(joint);
  const double stiffness = std::min(joint.stiffness, inertiaOf(mount, slides) / (dt * dt));
  push(mount, slides, stiffness * (joint.spring_reference - position));
}

void driveJoint(const Model& model, int index, double dt) {
  const Joint& joint = model.description->joints[index];
  const JointSettings& s = model.joints[index].settings;
  const bool slides = isSlider(joint);
  const Mount mount = mountOf(model, index);
  if (joint.stiffness > 0) spring(mount, joint, model.joints[index].position, dt);
  const bool motor = s.motor_effort > 0;
  setMotor(mount, slides, motor ? s.motor_speed : 0,
           std::min(motor ? s.motor_effort : s.friction, kMostPush), dt);
  if (s.damping <= 0) return;
  // The exact solution for an isolated joint: strong damping stops it and never reverses it.
  const double inertia = inertiaOf(mount, slides);
  const double lost = inertia * (1 - std::exp(-s.damping * dt / std::max(inertia, 1e-12)));
  push(mount, slides, -rateOf(mount, slides) * lost / dt);
}

void readJoint(Model& model, int index) {
  const bool slides = isSlider(model.description->joints[index]);
  const Mount mount = mountOf(model, index);
  JointState& state = model.joints[index];
  state.rate = rateOf(mount, slides);
  if (slides) {
    slider(mount).calculateTransforms(mount.parent.getWorldTransform(),
                                      mount.child.getWorldTransform());
    state.position = slider(mount).getLinearPos();
  } else {
    state.position += wrapAngle(-hinge(mount).getHingeAngle() - state.position);
  }
}

template <typename Visit>
void forAxes(const Model& model, Visit visit) {
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    if (model.description->joints[i].hasAxis()) visit(static_cast<int>(i));
  }
}

/// Returns the robot's wheel that a joint turns: 0 left, 1 right, -1 none.
int wheelOf(const Joint& joint) {
  if (joint.child == "left_wheel") return 0;
  return joint.child == "right_wheel" ? 1 : -1;
}

[[noreturn]] void refuse(const Model& model, const std::string& joint, const std::string& why) {
  throw std::invalid_argument("joint '" + joint + "' of '" + model.name + "' " + why);
}

struct Target {
  int joint;
  double position;
  std::vector<int> links;  ///< Links that move with it.
};

Target makeTarget(const Model& model, const std::string& name, double position) {
  const int index = findJoint(model, name);
  if (index < 0) refuse(model, name, "does not exist");
  const Joint& joint = model.description->joints[index];
  if (joint.kind == Joint::Kind::kFixed) refuse(model, name, "is fixed");
  if (!joint.hasAxis()) refuse(model, name, "is a ball and has no position");
  if (!std::isfinite(position)) refuse(model, name, "can't be put at a position that isn't finite");
  if (isSlider(joint) && std::abs(position) > 1e4) refuse(model, name, "can't go that far");
  const int child = linkIndex(*model.description, joint.child);
  const int parent = linkIndex(*model.description, joint.parent);
  Target target{index, position, linksHeldTo(*model.description, child, index)};
  const bool is_loop =
      std::find(target.links.begin(), target.links.end(), parent) != target.links.end();
  if (is_loop) refuse(model, name, "is part of a loop");
  return target;
}

void place(Model& model, const Target& target) {
  const Mount mount = mountOf(model, target.joint);
  const double way = target.position - model.joints[target.joint].position;
  btTransform move = btTransform::getIdentity();
  if (isSlider(model.description->joints[target.joint])) {
    move.setOrigin(mount.axis * way);
  } else {
    const btTransform turn(btQuaternion(mount.axis, way), btVector3(0, 0, 0));
    move = btTransform(btQuaternion::getIdentity(), mount.anchor) * turn *
           btTransform(btQuaternion::getIdentity(), -mount.anchor);
  }
  for (int link : target.links) {
    LinkBody& body = model.bodies.links[link];
    body.place(move * body.linkPose());
    body.body->setLinearVelocity({0, 0, 0});
    body.body->setAngularVelocity({0, 0, 0});
  }
  model.joints[target.joint].position = target.position;
  model.joints[target.joint].rate = 0;
}

void placeWheels(FleetState& fleet, const Model& model,
                 const std::map<std::string, double>& positions) {
  for (const auto& [name, position] : positions) {
    const int index = findJoint(model, name);
    if (index < 0) refuse(model, name, "does not exist");
    if (wheelOf(model.description->joints[index]) < 0) refuse(model, name, "is its plugins' own");
    if (!std::isfinite(position)) refuse(model, name, "needs a finite position");
  }
  for (const auto& [name, position] : positions) {
    const int wheel = wheelOf(model.description->joints[findJoint(model, name)]);
    fleet.wheel_angle[wheel][model.index] = position;
  }
}

}  // namespace

void initJoints(Model& model) {
  model.joints.clear();
  for (const Joint& joint : model.description->joints) {
    JointState state;
    state.settings = {joint.damping, joint.friction, joint.lower, joint.upper, 0, 0};
    model.joints.push_back(state);
  }
}

void restoreLimits(Model& model) {
  forAxes(model, [&](int i) {
    const JointSettings& s = model.joints[i].settings;
    const Joint& from = model.description->joints[i];
    if (s.lower == from.lower && s.upper == from.upper) return;
    setLimits(mountOf(model, i), isSlider(from), s);
  });
}

void driveJoints(ModelTable& models, double dt) {
  for (int slot : models.bodies) {
    Model& model = *models[slot];
    if (model.joints.empty()) continue;
    if (!isAwake(model)) {
      if (!wantsToMove(model)) continue;
      wake(model);
    }
    forAxes(model, [&](int i) { driveJoint(model, i, dt); });
  }
}

void readJoints(ModelTable& models) {
  for (int slot : models.bodies) {
    Model& model = *models[slot];
    if (model.joints.empty() || !isAwake(model)) continue;
    forAxes(model, [&](int i) { readJoint(model, i); });
  }
}

int findJoint(const Model& model, const std::string& joint) {
  const auto& joints = model.description->joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].name == joint) return static_cast<int>(i);
  }
  return -1;
}

JointState jointState(const FleetState& fleet, const Model& model, int joint) {
  const Joint& from = model.description->joints[joint];
  JointState out;
  out.settings = {from.damping, from.friction, from.lower, from.upper, 0, 0};
  if (model.owner->drivesJoints()) {
    const int wheel = wheelOf(from);
    if (wheel >= 0) {
      out.position = fleet.wheel_angle[wheel][model.index];
      out.rate = fleet.wheel_speed[wheel][model.index];
    } else if (from.child == "tower") {
      out.position = fleet.tower[model.index];
    }
    return out;
  }
  return model.joints.empty() ? out : model.joints[joint];
}

std::optional<JointWrench> jointWrench(const Model& model, int joint) {
  const auto index = static_cast<std::size_t>(joint);
  const int link = linkIndex(*model.description, model.description->joints[joint].child);
  if (index >= model.bodies.feedback.size() || link < 0) return std::nullopt;
  const LinkBody& child = model.bodies.links[link];
  const btJointFeedback& feedback = model.bodies.feedback[index];
  const btVector3 force = feedback.m_appliedForceBodyB;  // at the centre of mass
  const btVector3 arm = child.body->getWorldTransform().getOrigin() - child.linkPose().getOrigin();
  return JointWrench{fromBullet(force),
                     fromBullet(feedback.m_appliedTorqueBodyB + arm.cross(force))};
}

void setJoint(Model& model, int joint, const JointSettings& s) {
  const std::string& name = model.description->joints[joint].name;
  const bool has_axis = model.description->joints[joint].hasAxis();
  if (model.joints.empty() || !has_axis) refuse(model, name, "has no properties to set");
  for (double value : {s.damping, s.friction, s.motor_effort}) {
    if (!(value >= 0 && value < kNoLimit)) {
      refuse(model, name, "needs a damping, friction and motor effort of 0 or above");
    }
  }
  if (!(std::abs(s.motor_speed) <= kFastestMotor)) {
    refuse(model, name, "needs a motor speed of at most 1e6 rad/s or m/s");
  }
  if (!(s.lower <= s.upper)) refuse(model, name, "needs a lower limit at or below the upper one");
  JointSettings& now = model.joints[joint].settings;
  const bool new_limits = now.lower != s.lower || now.upper != s.upper;
  now = s;
  if (new_limits) {
    setLimits(mountOf(model, joint), isSlider(model.description->joints[joint]), s);
  }
  wake(model);
}

void placeJoints(MotionView& world, Model& model, const std::map<std::string, double>& positions) {
  if (model.owner->drivesJoints()) return placeWheels(world.fleet, model, positions);
  std::vector<Target> targets;
  for (const auto& [name, position] : positions) {
    targets.push_back(makeTarget(model, name, position));
    if (model.joints.empty()) refuse(model, name, "can't move: the model does not");
  }
  for (const Target& target : targets) place(model, target);
  wake(model);
  moved(world, model);
  invalidateClearance(world.fleet);
}

void pushJoint(Model& model, int joint, double effort) {
  const Joint& from = model.description->joints[joint];
  if (!from.hasAxis()) return;
  const double most = from.max_effort >= 0 ? from.max_effort : kNoLimit;
  wake(model);
  push(mountOf(model, joint), isSlider(from), std::clamp(effort, -most, most));
}

std::vector<int> linksHeldTo(const ModelDescription& description, int link, int without) {
  std::vector<int> held{link};
  const auto reach = [&](const std::string& from, const std::string& to) {
    const int a = linkIndex(description, from), b = linkIndex(description, to);
    const auto has = [&](int l) { return std::find(held.begin(), held.end(), l) != held.end(); };
    if (a < 0 || b < 0 || !has(a) || has(b)) return false;
    held.push_back(b);
    return true;
  };
  for (bool grew = true; grew;) {
    grew = false;
    for (std::size_t i = 0; i < description.joints.size(); ++i) {
      if (static_cast<int>(i) == without) continue;
      const Joint& joint = description.joints[i];
      grew = reach(joint.parent, joint.child) || reach(joint.child, joint.parent) || grew;
    }
  }
  return held;
}

}  // namespace kiva
