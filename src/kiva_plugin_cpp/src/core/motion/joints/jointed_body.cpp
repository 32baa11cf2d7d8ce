// SPDX-License-Identifier: Apache-2.0
#include "core/motion/joints/jointed_body.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kiva {
namespace {

constexpr double kLow = 0.01;  // [m] above the floor up to which a foot is tested in every step

const char* const kWheelNames[2] = {"left_wheel", "right_wheel"};

bool isWheel(const Link& link) {
  return link.name == kWheelNames[0] || link.name == kWheelNames[1];
}

btMatrix3x3 tensor(const SpatialInertia::Matrix& m) {
  return btMatrix3x3(m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1),
                     m(2, 2));
}

const Link& findWheel(const Model& model, int side) {
  const Link* link = model.description->findLink(kWheelNames[side]);
  if (link) return *link;
  throw DescriptionError("model '" + model.name + "': the jointed drive needs a link '" +
                         std::string(kWheelNames[side]) + "'");
}

/// Returns the wheel's first round shape; null if it has none.
const Collision* tyreOf(const Link& wheel) {
  for (const Collision& collision : wheel.collisions) {
    const Shape::Kind kind = collision.shape.kind;
    if (kind == Shape::Kind::kCylinder || kind == Shape::Kind::kSphere) return &collision;
  }
  return nullptr;
}

/// Makes a wheel with the radius of its tyre, which touches the floor in one point beneath its
/// centre, as a crowned tyre does.
JointedBody::Wheel makeWheel(const Link& link, const DriveParameters& drive) {
  JointedBody::Wheel wheel{toBullet(link.pose_in_model.Pos()), drive.wheel_radius,
                           std::min(drive.friction, tyreFriction(link))};
  if (const Collision* tyre = tyreOf(link)) wheel.radius = tyre->shape.radius;
  return wheel;
}

void addBoxFeet(const Vector3& half, const Pose& pose, const Collision& collision,
                std::vector<JointedBody::Foot>* feet) {
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3 at(corner & 1 ? half.X() : -half.X(), corner & 2 ? half.Y() : -half.Y(),
                     corner & 4 ? half.Z() : -half.Z());
    feet->push_back(
        {toBullet((pose * Pose(at, Quaternion::Identity)).Pos()), 0, collision.friction});
  }
}

/// Adds the points at which the shape could touch the floor. Round shapes except balls count as
/// their boxes.
void addFeet(const Collision& collision, const Pose& in_model,
             std::vector<JointedBody::Foot>* feet) {
  const Shape& shape = collision.shape;
  const Pose pose = in_model * collision.pose_in_link;
  switch (shape.kind) {
    case Shape::Kind::kSphere:
      feet->push_back({toBullet(pose.Pos()), shape.radius, collision.friction});
      break;
    case Shape::Kind::kCapsule:
      for (double end : {-shape.length / 2, shape.length / 2}) {
        feet->push_back(
            {toBullet((pose * Pose(0, 0, end, 0, 0, 0)).Pos()), shape.radius, collision.friction});
      }
      break;
    case Shape::Kind::kBox:
      addBoxFeet(shape.size * 0.5, pose, collision, feet);
      break;
    case Shape::Kind::kEllipsoid:
      addBoxFeet(shape.size, pose, collision, feet);
      break;
    case Shape::Kind::kCylinder:
      addBoxFeet({shape.radius, shape.radius, shape.length / 2}, pose, collision, feet);
      break;
    case Shape::Kind::kMesh:
    case Shape::Kind::kPlane:
      break;
  }
}

void addFeet(const Link& link, const Pose& in_model, std::vector<JointedBody::Foot>* feet) {
  for (const Collision& collision : link.collisions) addFeet(collision, in_model, feet);
}

/// Sorts low feet first, and limits the tilt up to which the others stay off the floor.
void sortFeet(JointedBody* body) {
  const auto height = [](const JointedBody::Foot& foot) { return foot.centre.z() - foot.radius; };
  const auto high =
      std::stable_partition(body->feet.begin(), body->feet.end(),
                            [&](const JointedBody::Foot& foot) { return height(foot) < kLow; });
  body->low_feet = static_cast<int>(high - body->feet.begin());
  body->low_feet_reach = 1;
  for (auto foot = high; foot != body->feet.end(); ++foot) {
    // The chassis may sink by half of the foot's height without floor contact.
    const double far = foot->centre.length() + foot->radius;
    body->low_feet_reach = std::min(body->low_feet_reach, 0.5 * height(*foot) / far);
  }
}

/// Sets the casters' springs, and their distances from the axle.
void measureCasters(const Robot& robot, JointedBody* body) {
  int casters = 0;
  body->front_reach = body->rear_reach = 0;
  const double axle = 0.5 * (body->wheels[0].centre.x() + body->wheels[1].centre.x());
  for (int i = 0; i < body->low_feet; ++i) {
    const JointedBody::Foot& foot = body->feet[i];
    casters += foot.radius > 0;
    body->front_reach = std::max(body->front_reach, foot.centre.x() - axle);
    body->rear_reach = std::max(body->rear_reach, axle - foot.centre.x());
  }
  if (body->front_reach == 0) body->front_reach = robot.half_length;
  if (body->rear_reach == 0) body->rear_reach = robot.half_length;
  body->spring_share = casters > 0 ? (1 - robot.drive.drive_wheel_load) / casters : 0;
}

/// Returns the pose of the unit on its robot; in this model it is upright on the floor plane.
Pose unitInModel(const Scene& world, int robot, int unit) {
  const double height = world.fleet.robots[robot].height + world.fleet.tower[robot];
  return Pose(0, 0, height, 0, 0, 0) * world.storage.units[unit].pose_on_carrier;
}

SpatialInertia addUp(const Scene& world, int robot, JointedBody* body) {
  SpatialInertia sum;
  for (const Link& link : world.models.of(world.fleet.robots[robot]).description->links) {
    Pose at = link.pose_in_model;
    if (link.name == "tower") at.Pos().Z() += world.fleet.tower[robot];
    sum.add(link, at);
    if (!isWheel(link)) addFeet(link, at, &body->feet);
  }
  if (body->unit < 0) return sum;
  const Pose at = unitInModel(world, robot, body->unit);
  sum.add(body->load, at);
  for (const Link& link : world.models[world.storage.units[body->unit].model]->description->links) {
    addFeet(link, at * link.pose_in_model, &body->feet);
  }
  return sum;
}

/// Returns the moment of inertia of the wheels' links about their axle.
double axialMoment(const Model& model, const Vector3& axle) {
  double moment = 0;
  for (int side = 0; side < 2; ++side) {
    const Link& link = findWheel(model, side);
    const Pose centre = link.pose_in_model * link.inertial_pose_in_link;
    const Vector3 along = centre.Rot().RotateVectorReverse(axle);
    moment += (along * along).Dot(link.principal_moments);
  }
  return moment;
}

/// Computes the inverse of the rows and columns `dofs` of a symmetric matrix by Gauss-Jordan
/// elimination; the rest is 0.
void invert(const double matrix[5][5], const std::vector<int>& dofs, double out[5][5]) {
  const int n = static_cast<int>(dofs.size());
  double work[5][10] = {};
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) work[i][j] = matrix[dofs[i]][dofs[j]];
    work[i][n + i] = 1;
  }
  for (int pivot = 0; pivot < n; ++pivot) {  // no pivoting: the matrix is positive definite
    const double scale = 1 / work[pivot][pivot];
    for (int j = 0; j < 2 * n; ++j) work[pivot][j] *= scale;
    for (int i = 0; i < n; ++i) {
      if (i == pivot) continue;
      const double factor = work[i][pivot];
      for (int j = 0; j < 2 * n; ++j) work[i][j] -= factor * work[pivot][j];
    }
  }
  std::fill(&out[0][0], &out[0][0] + 25, 0.0);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) out[dofs[i]][dofs[j]] = work[i][n + j];
  }
}

void fillResponses(JointedBody* body) {
  double m[5][5] = {};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      m[i][j] = body->inertia[i][j] + 2 * body->spin_inertia * body->axle[i] * body->axle[j];
    }
    for (int wheel = 3; wheel < 5; ++wheel) {
      m[i][wheel] = m[wheel][i] = body->spin_inertia * body->axle[i];
    }
  }
  m[3][3] = m[4][4] = body->spin_inertia;
  for (int free = 0; free < 4; ++free) {
    std::vector<int> dofs{0, 1, 2};
    if (free & 1) dofs.push_back(3);
    if (free & 2) dofs.push_back(4);
    invert(m, dofs, body->response[free]);
  }
}

/// Transforms from the model's frame to the chassis frame.
void raiseOrigin(JointedBody* body) {
  body->axle_height = 0.5 * (body->wheels[0].centre.z() + body->wheels[1].centre.z());
  const btVector3 up(0, 0, body->axle_height);
  for (auto& wheel : body->wheels) wheel.centre -= up;
  for (auto& foot : body->feet) foot.centre -= up;
  body->centre -= up;
}

std::shared_ptr<JointedBody> make(const Scene& world, int robot, const SpatialInertia& load) {
  const Robot& r = world.fleet.robots[robot];
  const Model& model = world.models.of(world.fleet.robots[robot]);
  auto body = std::make_shared<JointedBody>();
  body->tower = world.fleet.tower[robot];
  body->unit = world.fleet.unit[robot];
  body->load_mass = r.load_mass;
  body->load_inertia = r.load_inertia;
  body->load = load;
  for (int side = 0; side < 2; ++side) {
    body->wheels[side] = makeWheel(findWheel(model, side), r.drive);
  }
  body->axle.setValue(0, 1, 0);
  const SpatialInertia sum = addUp(world, robot, body.get());
  sortFeet(body.get());
  measureCasters(r, body.get());
  body->inverse_mass = 1 / sum.mass();
  body->centre = toBullet(sum.centre());
  body->spin_inertia = r.drive.wheel_inertia;
  body->inertia = tensor(sum.inertia());
  body->inertia[1][1] -= axialMoment(model, Vector3::UnitY);
  raiseOrigin(body.get());
  fillResponses(body.get());
  return body;
}

bool hasLoadOf(const JointedBody& body, const FleetState& fleet, int robot) {
  const Robot& r = fleet.robots[robot];
  return body.unit == fleet.unit[robot] && body.load_mass == r.load_mass &&
         body.load_inertia == r.load_inertia;
}

bool isFor(const JointedBody& body, const FleetState& fleet, int robot) {
  return body.tower == fleet.tower[robot] && hasLoadOf(body, fleet, robot);
}

/// Returns the inertia of the load, summed again only after a change of the load.
SpatialInertia loadOf(const Scene& world, int robot) {
  const int unit = world.fleet.unit[robot];
  if (unit < 0) return SpatialInertia();
  const JointedBody* old = world.models.of(world.fleet.robots[robot]).jointed.get();
  return old && hasLoadOf(*old, world.fleet, robot) ? old->load : sumUnit(world, unit);
}

/// Returns the mechanism that robots of one description share while they carry nothing and the
/// tower is down. A step of a whole fleet spends much of its time on loading each robot's data.
std::shared_ptr<const JointedBody> shareBare(const Scene& world, int robot) {
  auto& known = world.jointed_bodies.bare;
  const ModelDescription* description =
      world.models.of(world.fleet.robots[robot]).description.get();
  const auto at = known.find(description);
  if (at != known.end() && !at->second.expired()) return at->second.lock();
  for (auto old = known.begin(); old != known.end();) {
    old = old->second.expired() ? known.erase(old) : std::next(old);
  }
  std::shared_ptr<const JointedBody> body = make(world, robot, SpatialInertia());
  known[description] = body;
  return body;
}

}  // namespace

SpatialInertia sumUnit(const Scene& world, int unit) {
  SpatialInertia sum;
  for (const Link& link : world.models[world.storage.units[unit].model]->description->links) {
    sum.add(link, link.pose_in_model);
  }
  for (const int index : world.storage.items_on[unit]) {
    const Item& item = world.storage.items[index];
    sum.addPoint(item.mass, item.pose_in_unit.Pos());
  }
  return sum;
}

bool hasDriveWheels(const ModelDescription& model) {
  return model.findLink(kWheelNames[0]) && model.findLink(kWheelNames[1]);
}

double tyreFriction(const Link& wheel) {
  const Collision* tyre = tyreOf(wheel);
  return tyre ? tyre->friction : std::numeric_limits<double>::max();
}

const JointedBody& jointedBody(const Scene& world, int robot) {
  const Model& model = world.models.of(world.fleet.robots[robot]);
  if (!model.jointed || !isFor(*model.jointed, world.fleet, robot)) {
    const bool bare = world.fleet.unit[robot] < 0 && world.fleet.tower[robot] == 0;
    model.jointed = bare ? shareBare(world, robot) : make(world, robot, loadOf(world, robot));
  }
  return *model.jointed;
}

}  // namespace kiva
