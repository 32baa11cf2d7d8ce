// SPDX-License-Identifier: Apache-2.0
#include "jointed.h"

#include <cmath>
#include <ignition/math/MassMatrix3.hh>

#include "commands.h"
#include "load.h"
#include "models.h"
#include "robots.h"

namespace kiva {
namespace {

constexpr int kLeftWheel = 1, kRightWheel = 2;  // in ModelBodies::links; 0 is the chassis

bool isWheel(const Link& link) { return link.name == "left_wheel" || link.name == "right_wheel"; }

/// Mass, centre and inertia tensor of several links as one, in the model's frame.
struct RigidSum {
  double mass = 0;
  Vector3 moment;                                               // sum of mass · position
  ignition::math::Matrix3d inertia{0, 0, 0, 0, 0, 0, 0, 0, 0};  // about the origin

  void add(const Link& link, const Pose& link_in_model) {
    const Pose centre = link_in_model * link.inertial_pose_in_link;
    const ignition::math::Matrix3d turn(centre.Rot());
    const Vector3& m = link.principal_moments;
    const ignition::math::Matrix3d own =
        turn * ignition::math::Matrix3d(m.X(), 0, 0, 0, m.Y(), 0, 0, 0, m.Z()) * turn.Transposed();
    addPoint(link.mass, centre.Pos());
    inertia = inertia + own;
  }

  void addPoint(double point_mass, const Vector3& p) {
    mass += point_mass;
    moment += p * point_mass;
    inertia = inertia + steiner(point_mass, p);
  }

  static ignition::math::Matrix3d steiner(double m, const Vector3& p) {
    const double x = p.X(), y = p.Y(), z = p.Z();
    return ignition::math::Matrix3d(m * (y * y + z * z), -m * x * y, -m * x * z,  //
                                    -m * x * y, m * (x * x + z * z), -m * y * z,  //
                                    -m * x * z, -m * y * z, m * (x * x + y * y));
  }

  /// The sum as one link at the model's origin.
  Link asLink() const {
    const Vector3 centre = moment / mass;
    const ignition::math::Matrix3d about = inertia - steiner(mass, centre);
    ignition::math::MassMatrix3d principal(mass, {about(0, 0), about(1, 1), about(2, 2)},
                                           {about(0, 1), about(0, 2), about(1, 2)});
    Link link;
    link.name = "chassis";
    link.mass = mass;
    link.inertial_pose_in_link = Pose(centre, principal.PrincipalAxesOffset());
    link.principal_moments = principal.PrincipalMoments();
    return link;
  }
};

void addCollisions(const Link& from, const Pose& in_model, Link* to) {
  for (Collision collision : from.collisions) {
    collision.pose_in_link = in_model * collision.pose_in_link;
    to->collisions.push_back(collision);
  }
}

/// The unit as part of the chassis, at its present place on the robot.
void addLoad(const Parts& parts, int unit, const Pose& in_robot, RigidSum* sum,
             std::vector<Collision>* collisions) {
  const Model& model = *parts.models[parts.units[unit].model];
  for (const Link& link : model.description->links) {
    const Pose at = in_robot * link.pose_in_model;
    sum->add(link, at);
    for (Collision collision : link.collisions) {
      collision.pose_in_link = at * collision.pose_in_link;
      collisions->push_back(collision);
    }
  }
  for (const Item& item : parts.items) {
    if (item.unit == unit) sum->addPoint(item.mass, (in_robot * item.pose_in_unit).Pos());
  }
}

Joint wheelJoint(const Link& wheel) {
  Joint joint;
  joint.kind = Joint::Kind::kContinuous;
  joint.parent = "chassis";
  joint.child = wheel.name;
  joint.anchor_in_model = wheel.pose_in_model.Pos();
  joint.axis_in_model = Vector3::UnitY;
  return joint;
}

/// The robot as three links: chassis with tower, and wheels.
ModelDescription threeLinks(const Parts& parts, int robot, std::vector<Collision>* load) {
  const Model& model = parts.modelOf(robot);
  RigidSum sum;
  Link shapes;
  ModelDescription out;
  for (const Link& link : model.description->links) {
    if (isWheel(link)) continue;
    Pose at = link.pose_in_model;
    if (link.name == "tower") at.Pos().Z() += parts.fleet.tower[robot];
    sum.add(link, at);
    addCollisions(link, at, &shapes);
  }
  const int unit = parts.fleet.unit[robot];
  if (unit >= 0) {
    addLoad(parts, unit, basePose(parts, robot).Inverse() * unitPose(parts, unit), &sum, load);
  }
  out.links.push_back(sum.asLink());
  out.links[0].collisions = shapes.collisions;
  for (const char* name : {"left_wheel", "right_wheel"}) {
    const Link* wheel = model.description->findLink(name);
    if (!wheel) {
      throw DescriptionError("model '" + model.name + "': the jointed drive needs a link '" +
                             std::string(name) + "'");
    }
    out.links.push_back(*wheel);
    out.joints.push_back(wheelJoint(*wheel));
  }
  return out;
}

btHingeConstraint& hinge(Model& model, int wheel) {
  return static_cast<btHingeConstraint&>(*model.bodies.joints[wheel]);
}

}  // namespace

ModelBodies buildJointed(const Parts& parts, int robot) {
  const int slot = parts.fleet.robots[robot].model;
  std::vector<Collision> load;
  const ModelDescription description = threeLinks(parts, robot, &load);
  ModelBodies bodies =
      parts.physics.build(description, basePose(parts, robot), slot, kRobotGroup, ~0);
  LinkBody& chassis = bodies.links[0];
  const int unit = parts.fleet.unit[robot];
  for (const Collision& collision : load) {
    chassis.shape.add(collision, chassis.mass_frame.inverse() * toBullet(collision.pose_in_link),
                      parts.units[unit].model);
  }
  const Fleet& f = parts.fleet;
  for (LinkBody& link : bodies.links) {
    link.body->setActivationState(DISABLE_DEACTIVATION);
    link.body->setLinearVelocity({f.vx[robot], f.vy[robot], 0});
    link.body->setAngularVelocity({0, 0, f.yaw_rate[robot]});
  }
  return bodies;
}

void driveJointed(Parts& parts, int robot) {
  Model& model = parts.modelOf(robot);
  const Robot& r = parts.fleet.robots[robot];
  const bool unlimited = r.drive.acceleration == 0;
  const double impulse = unlimited ? 1e6 : r.drive.motor_torque * parts.dt;
  for (int wheel = 0; wheel < 2; ++wheel) {
    // Bullet turns a hinge's parent against its child: forward is negative.
    hinge(model, wheel).enableAngularMotor(true, -parts.fleet.wheel_target[wheel][robot], impulse);
  }
}

void readJointed(Parts& parts, int robot) {
  Model& model = parts.modelOf(robot);
  Fleet& f = parts.fleet;
  const LinkBody& chassis = model.bodies.links[0];
  const btTransform pose = chassis.linkPose();
  const btVector3 ahead = pose.getBasis().getColumn(0);
  f.x[robot] = pose.getOrigin().x();
  f.y[robot] = pose.getOrigin().y();
  f.yaw[robot] += wrapAngle(std::atan2(ahead.y(), ahead.x()) - f.yaw[robot]);
  const btVector3 velocity = chassis.velocityAtOrigin();
  f.vx[robot] = velocity.x();
  f.vy[robot] = velocity.y();
  f.yaw_rate[robot] = chassis.body->getAngularVelocity().z();
  const int link[2] = {kLeftWheel, kRightWheel};
  for (int wheel = 0; wheel < 2; ++wheel) {
    const btVector3 spin = model.bodies.links[link[wheel]].body->getAngularVelocity() -
                           chassis.body->getAngularVelocity();
    f.wheel_speed[wheel][robot] = spin.dot(pose.getBasis().getColumn(1));
    f.wheel_angle[wheel][robot] += f.wheel_speed[wheel][robot] * parts.dt;
  }
}

}  // namespace kiva
