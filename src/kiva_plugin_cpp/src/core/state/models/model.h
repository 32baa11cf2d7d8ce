// SPDX-License-Identifier: Apache-2.0
//
// A model that stands in the world, and the responsibilities of its kind.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/physics/physics.h"
#include "kiva_plugin_cpp/plugin.h"
#include "kiva_plugin_cpp/world.h"

namespace kiva {

struct JointedBody;
struct Model;
struct Scene;
struct RobotView;
struct MotionView;
struct ContactView;
struct ModelView;

/// One collision shape of a model, and its footprint among the obstacles.
struct CollisionGeometry {
  int link = 0;
  Pose pose_in_link;
  Shape shape;
  int handle =
      -1;  ///< Index in Obstacles; -1 for robots and loads, whose footprints are a mover's.
  int triangle = -1;  ///< Index in the mesh of a static model, if this is one triangle of it.
  std::shared_ptr<std::array<Vector3, 3>> corners =
      nullptr;  ///< Corners of that triangle in world [m].
};

/// The level faces of a static model at one height near the ground.
struct LevelSurface {
  double z = 0;                                                         ///< Height in world [m].
  double area = 0;                                                      ///< [m2]
  double min_x = 1e300, max_x = -1e300, min_y = 1e300, max_y = -1e300;  ///< Bounds in world [m].
  double friction = 1;
  bool is_plane = false;
};

/// Adds, removes, places and resets the models of one kind, and knows their poses and how they
/// touch others. There is one object a kind, in core/models; no other code asks for a model's kind.
class ModelOwner {
 public:
  virtual ~ModelOwner() = default;

  /// Makes the model, which has a name and a slot, part of the world. Throws DescriptionError.
  virtual void add(ModelView& world, Model& model) const = 0;
  /// Removes the model, with all that was made for it.
  virtual void remove(ModelView& world, Model& model) const = 0;
  /// Returns the slots of the models that are removed with it.
  virtual std::vector<int> passengers(const Scene& /*world*/, const Model& /*model*/) const {
    return {};
  }
  /// Puts the model there with that velocity, as a hand would.
  virtual void place(ModelView& world, Model& model, const EntityState& state) const = 0;
  /// Returns the model to its spawn pose, at rest.
  virtual void reset(ModelView& world, Model& model) const = 0;
  virtual EntityState state(const Scene& world, const Model& model) const = 0;
  /// Returns a link's pose in world.
  virtual Pose linkPose(const Scene& world, const Model& model, int link) const = 0;

  /// Takes over the masses of its changed description, `added` [kg] more than before.
  virtual void reweigh(ContactView& world, Model& model, double added) const = 0;
  /// Applies a force [N] at a point and a torque [Nm] to that link, in world, for the next step.
  /// Returns false if the model does not move.
  virtual bool push(ContactView& world, Model& model, int link, const Vector3& at,
                    const Vector3& force, const Vector3& torque) const = 0;

  /// Builds its bodies for Bullet, at its present pose.
  virtual ModelBodies build(const Scene& world, const Model& model) const = 0;
  /// Returns whether it is in Bullet only while something is near; else for as long as it stands.
  virtual bool isActivatedWhenNear() const { return false; }
  /// Follow the model's entry into Bullet and its leave, with `model.bodies` present.
  virtual void activated(RobotView& /*world*/, Model& /*model*/) const {}
  virtual void deactivated(RobotView& /*world*/, Model& /*model*/) const {}
  /// Returns whether Bullet may have it as a body that slides on its feet, until it tips.
  virtual bool mayBeUpright(const Scene& /*world*/, const Model& /*model*/) const { return false; }
  /// Returns whether it may leave Bullet. `is_alone`: nothing was near it for a while.
  virtual bool mayLeaveBullet(const Scene& /*world*/, const Model& /*model*/, bool is_alone) const {
    return is_alone;
  }
  /// Returns whether Bullet moves it, so that it follows its bodies.
  virtual bool followsBodies(const Model& model) const;

  /// Returns whether only its plugins move its joints.
  virtual bool drivesJoints() const { return false; }

  /// Returns whether its contacts are reported as collisions; those with a floor never are.
  virtual bool reportsCollisions() const { return false; }
  virtual bool isFloor() const { return false; }
  /// Follows a contact with a model that is no floor.
  virtual void touched(MotionView& /*world*/, Model& /*model*/) const {}
  /// Returns the robot that it is, or that carries it; -1 = none.
  virtual int robot(const Scene& /*world*/, const Model& /*model*/) const { return -1; }
  /// Returns whether it stops a robot that comes near.
  virtual bool stops(const Scene& /*world*/, const Model& /*model*/, int /*robot*/) const {
    return true;
  }
  /// Returns the Occupancy of the cells where it stands.
  virtual std::uint8_t occupies(const Scene& /*world*/, const Model& /*model*/) const {
    return Occupancy::kFree;
  }
  /// Returns whether items that are put into it are carried along.
  virtual bool holdsItems() const { return false; }
  /// Returns whether World::unitsRevision counts its moves.
  virtual bool isTracked() const { return false; }
  /// Returns the group of its footprints: rays of that group pass them; -1 = none.
  virtual int group(const Model& /*model*/) const { return -1; }
};

struct Model {
  std::string name;
  ModelKind kind = ModelKind::kOther;
  const ModelOwner* owner = nullptr;  ///< The owner of its kind.
  int slot = -1;                      ///< Index among the world's models.
  std::shared_ptr<const ModelDescription> description;
  std::uint64_t serial = 0;  ///< Order of arrival.
  Pose spawn_pose;           ///< Pose in world of its spawn.
  Pose pose;                 ///< Pose in world while it has no body.
  int index = -1;            ///< Index in the fleet, the storage units or the items, by kind.
  ModelBodies bodies;
  bool in_physics = false;         ///< Its bodies are in Bullet now.
  std::uint64_t active_until = 0;  ///< Step up to which something near keeps it in Bullet.
  bool disturbed = false;          ///< Touched since it was activated.
  bool upright = false;            ///< Its body slides on its feet, and can do no more.
  Vector3 rocking;    ///< Angular momentum that its feet have not held, about its centre of mass,
                      ///< in world [Nms].
  bool tips = false;  ///< It is a whole body, since it rocks too much or bears a load.
  mutable std::shared_ptr<const JointedBody>
      jointed;  ///< A cache: a jointed robot's mechanism, made when it is asked for.
  std::vector<CollisionGeometry> geometries;
  std::vector<LevelSurface> level_surfaces;  ///< A static model's.
  std::vector<std::shared_ptr<Plugin>> plugins;
  std::vector<JointState> joints;  ///< The joints of free bodies, in the description's order.
  std::string robot_namespace;     ///< The namespace that its plugins use.

  bool isStatic() const { return description->is_static; }
};

/// Returns whether one of its bodies is awake in Bullet.
bool isAwake(const Model& model);

/// Returns the index of the link of that name; -1 = none, or no model.
int linkIndex(const ModelDescription& description, const std::string& name);
int linkIndex(const Model* model, const std::string& name);

/// Returns the number in a name such as `kiva12`, behind the prefix: 1 to 9,999,999; 0 if the name
/// is not of that form.
int numberIn(const std::string& name, const std::string& prefix);

}  // namespace kiva
