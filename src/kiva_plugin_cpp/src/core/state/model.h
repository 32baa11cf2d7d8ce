// SPDX-License-Identifier: Apache-2.0
//
// A model that stands in the world, and what its kind answers for.
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
struct ContactView;
struct ModelView;

/// One collision shape of a model, and its footprint among the obstacles.
struct CollisionGeometry {
  int link = 0;
  Pose pose_in_link;
  Shape shape;
  int handle = -1;    ///< In Obstacles; -1 for those of a robot and its load, which are a mover's.
  int triangle = -1;  ///< Of the mesh of a static model: each of them is one of these.
  std::shared_ptr<std::array<Vector3, 3>> corners = nullptr;  ///< Of that triangle, in world.
};

/// What of a static model lies level at one height near the ground.
struct LevelSurface {
  double z = 0;                                                         ///< In world [m].
  double area = 0;                                                      ///< [m2]
  double min_x = 1e300, max_x = -1e300, min_y = 1e300, max_y = -1e300;  ///< In world [m].
  double friction = 1;
  bool is_plane = false;
};

/// What becomes of the models of one kind: who adds, removes, places and resets them, tells where
/// they are and how they touch others. One object a kind, in core/models; nobody else asks which
/// kind a model is.
class ModelOwner {
 public:
  virtual ~ModelOwner() = default;

  /// The model, which has a name and a slot, becomes part of the world. Throws DescriptionError.
  virtual void add(ModelView& world, Model& model) const = 0;
  /// It goes, with all that was made for it.
  virtual void remove(ModelView& world, Model& model) const = 0;
  /// Slots of the models that go when it goes.
  virtual std::vector<int> passengers(const Scene& /*world*/, const Model& /*model*/) const {
    return {};
  }
  /// Puts it there with that velocity, as a hand would.
  virtual void place(ModelView& world, Model& model, const EntityState& state) const = 0;
  /// Back to where it was spawned, at rest.
  virtual void reset(ModelView& world, Model& model) const = 0;
  virtual EntityState state(const Scene& world, const Model& model) const = 0;
  /// In world.
  virtual Pose linkPose(const Scene& world, const Model& model, int link) const = 0;

  /// Its description names other masses now, `added` [kg] more than before.
  virtual void reweigh(ModelView& world, Model& model, double added) const = 0;
  /// For the next step: a force [N] at a point and a torque [Nm] on that link, in world. Returns
  /// false if it does not move.
  virtual bool push(ContactView& world, Model& model, int link, const Vector3& at,
                    const Vector3& force, const Vector3& torque) const = 0;

  /// Its bodies as they are when it enters Bullet, at its present pose.
  virtual ModelBodies build(const Scene& world, const Model& model) const = 0;
  /// Whether it is in Bullet only while something is near; else for as long as it stands.
  virtual bool isActivatedWhenNear() const { return false; }
  /// It is in Bullet from now on, or was taken out of it: `model.bodies` are still there.
  virtual void activated(ContactView& /*world*/, Model& /*model*/) const {}
  virtual void deactivated(ContactView& /*world*/, Model& /*model*/) const {}
  /// Whether it can be there as a body that slides on its feet, as long as it does not tip.
  virtual bool mayBeUpright(const Scene& /*world*/, const Model& /*model*/) const { return false; }
  /// Whether it may leave Bullet, if `is_alone`: nothing was near it for a while.
  virtual bool mayLeaveBullet(const Scene& /*world*/, const Model& /*model*/, bool is_alone) const {
    return is_alone;
  }
  /// Whether Bullet moves it: what its bodies do is what it does.
  virtual bool followsBodies(const Model& model) const;

  /// Whether its plugins move its joints, and nobody else.
  virtual bool drivesJoints() const { return false; }

  /// Whether its contacts are collisions that somebody should hear of; those with a floor never.
  virtual bool tellsCollisions() const { return false; }
  virtual bool isFloor() const { return false; }
  /// It was touched by something that is no floor.
  virtual void touched(ContactView& /*world*/, Model& /*model*/) const {}
  /// The robot that it is, or that carries it; -1 = none.
  virtual int robot(const Scene& /*world*/, const Model& /*model*/) const { return -1; }
  /// Whether it stops a robot that comes near.
  virtual bool stops(const Scene& /*world*/, const Model& /*model*/, int /*robot*/) const {
    return true;
  }
  /// What it makes of a cell where it stands: of Occupancy.
  virtual std::uint8_t occupies(const Scene& /*world*/, const Model& /*model*/) const {
    return Occupancy::kFree;
  }
  /// Whether what is put into it stays there and goes where it goes.
  virtual bool holdsItems() const { return false; }
  /// Whether World::unitsRevision tells that it moved.
  virtual bool isTracked() const { return false; }
  /// The group of its footprints: rays of that group pass them; -1 = none.
  virtual int group(const Model& /*model*/) const { return -1; }
};

struct Model {
  std::string name;
  ModelKind kind = ModelKind::kOther;
  const ModelOwner* owner = nullptr;  ///< Of that kind.
  int slot = -1;                      ///< Among the world's models.
  std::shared_ptr<const ModelDescription> description;
  std::uint64_t serial = 0;  ///< Order of arrival.
  Pose spawn_pose;           ///< In world.
  Pose pose;                 ///< In world; of a model that has no body now.
  int index = -1;            ///< In the fleet, the storage units or the items, by kind.
  ModelBodies bodies;
  bool in_physics = false;         ///< Its bodies are in Bullet now.
  std::uint64_t active_until = 0;  ///< Step up to which something near keeps it in Bullet.
  bool disturbed = false;          ///< Touched since it was activated.
  bool upright = false;            ///< It is there as a body that slides on its feet, no more.
  Vector3 rocking;    ///< Momentum that its feet did not hold since, about its centre of mass,
                      ///< in world [Nms].
  bool tips = false;  ///< That is too much, or something lies on it: it is a whole body.
  std::shared_ptr<const JointedBody>
      jointed;  ///< Of a robot of that drive; made when it is asked for.
  std::vector<CollisionGeometry> geometries;
  std::vector<LevelSurface> level_surfaces;  ///< Of a static model.
  std::vector<std::shared_ptr<Plugin>> plugins;
  std::vector<JointState> joints;  ///< In the description's order; of a model with free bodies.
  std::string robot_namespace;     ///< What its plugins were told.

  bool isStatic() const { return description->is_static; }
};

/// Whether one of its bodies is awake in Bullet.
bool isAwake(const Model& model);

/// Index of the link of that name; -1 = none.
int linkIndex(const ModelDescription& description, const std::string& name);

/// The number in a name such as `kiva12`, behind the prefix: 1 to 9,999,999; 0 if the name is not
/// of that form.
int numberIn(const std::string& name, const std::string& prefix);

}  // namespace kiva
