// SPDX-License-Identifier: Apache-2.0
//
// Bullet, wrapped: bodies move, and their contacts become pairs of models.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <cstdint>
#include <vector>

#include "core/physics/bodies/bodies.h"
#include "core/physics/collision/box_contacts.h"
#include "core/physics/collision/round_contacts.h"
#include "core/physics/solver/ordered_bullet.h"
#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// Two models that touch; the point, the normal and the speed are those of the hardest contact.
struct Contact {
  int model_a = -1, model_b = -1;
  Vector3 point;       ///< In world.
  Vector3 normal;      ///< From b to a.
  double speed = 0;    ///< Of approach before the step [m/s].
  double impulse = 0;  ///< Of all their contacts in the step, as far as it ended approach that
                       ///< was there before the step; what holds against pushes is not in it [Ns].
  double most = -1;    ///< Of the hardest one.
  double nearing = 0;  ///< Like `speed`, of the contact where it is largest [m/s].
};

/// One point of contact between two collisions.
struct TouchPoint {
  const btCollisionObject* body_a;
  const btCollisionObject* body_b;
  const BodyPart* part_a;
  const BodyPart* part_b;
  Vector3 point, normal;  ///< In world, the normal from b to a.
  double depth = 0;       ///< [m], >= 0.
  Vector3 impulse;        ///< On a in the last step, with friction [Ns].
};

/// What contacts did to a body in the last step, in world.
struct Push {
  btVector3 moment{0, 0, 0};  ///< About its centre of mass [Nms].
  double load = 0;            ///< Of what lies on it [Ns].
};

class Physics {
 public:
  explicit Physics(const Vector3& gravity);
  ~Physics();

  /// Bodies of all links and joints, at `pose`, not yet in the world; `model` marks them.
  ModelBodies build(const ModelDescription& description, const Pose& pose, int model, int group,
                    int mask) const;
  void insert(ModelBodies& bodies);
  void remove(ModelBodies& bodies);
  /// Bodies of what does not move by itself follow their model, which is there now.
  void shift(ModelBodies& bodies, const ModelDescription& description, const Pose& pose);

  /// Counts up whenever something static comes, goes or is moved.
  std::uint64_t fixtureChanges() const { return fixture_changes_; }

  /// One step; costs nothing where no body is awake.
  void step(double dt);
  /// For what is in the world and what will be.
  void setGravity(const Vector3& gravity);
  /// Pairs of models that touch now, each once, the lower index first.
  void contacts(std::vector<Contact>* out) const;
  /// What Bullet keeps of contacts, in an order that follows from the bodies.
  std::vector<btPersistentManifold*> manifolds() const { return dispatcher_.manifolds(); }
  /// A manifold, still without contacts, for every two parts that are near each other.
  std::vector<btPersistentManifold*> makeManifolds();
  /// Every point at which that model touches another now, itself being a.
  std::vector<TouchPoint> touchPoints(int model) const;
  /// Of every body that can move, by its second user index; what floors did is not in it.
  std::vector<Push> pushes() const;
  /// Whether all that lies at the floor is unbounded and level.
  bool hasPlainFloor() const { return uneven_floors_ == 0; }
  /// First body on a ray, as a fraction of `range`; +inf = none.
  double cast(const Vector3& from, const Vector3& direction, double range) const;

 private:
  bool anyAwake() const;
  struct Velocity {
    btVector3 linear, angular;
  };
  /// Of a body about a step.
  struct Motion {
    Velocity before;  ///< When the last step had ended.
    Velocity driven;  ///< When this one began: motors have set it since.
    Velocity pushed;  ///< With what forces add in it.
  };

  /// Calls visit(manifold, point, model_a, model_b) wherever parts of two models touch.
  template <typename Visit>
  void forEachTouch(Visit visit) const;
  void noteMotions(double dt);
  double approach(const btPersistentManifold& pair, const btManifoldPoint& point,
                  Velocity Motion::*when) const;
  double impactShare(const btPersistentManifold& pair, const btManifoldPoint& point) const;

  btDefaultCollisionConfiguration configuration_;
  BoxBoxContacts::Creator box_contacts_;
  RoundContacts::Creator round_contacts_, swapped_round_contacts_;
  OrderedDispatcher dispatcher_;
  OwnPartsFilter own_parts_filter_;
  btDbvtBroadphase broadphase_;
  OrderedSolver solver_;
  ContactIslandWorld world_;

  std::vector<Motion> motions_;  ///< By a body's second user index.
  double dt_ = 0;                ///< Of the last step [s].
  std::uint64_t fixture_changes_ = 0;
  int uneven_floors_ = 0;  ///< Bodies of the floor's group that are no level planes.
};

}  // namespace kiva
