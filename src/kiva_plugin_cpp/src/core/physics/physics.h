// SPDX-License-Identifier: Apache-2.0
//
// A wrapper of Bullet: bodies move, and their contacts become pairs of models.
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

/// Two models in contact; point, normal and speed are those of the hardest contact.
struct Contact {
  int model_a = -1, model_b = -1;
  Vector3 point;       ///< Point of contact in world.
  Vector3 normal;      ///< Unit vector from b to a.
  double speed = 0;    ///< Speed of approach before the step [m/s].
  double impulse = 0;  ///< Impulse of all their contacts that ended an approach from before the
                       ///< step, without forces that resist pushes [Ns].
  double most = -1;    ///< Impulse of the hardest contact [Ns].
  double nearing = 0;  ///< Largest `speed` of all contacts [m/s].
};

/// One point of contact between two collisions.
struct TouchPoint {
  const btCollisionObject* body_a;
  const btCollisionObject* body_b;
  const BodyPart* part_a;
  const BodyPart* part_b;
  Vector3 point, normal;  ///< Point in world, and unit vector from b to a.
  double depth = 0;       ///< [m], >= 0.
  Vector3 impulse;        ///< Impulse on a in the last step, with friction [Ns].
};

/// The effect of contacts on a body in the last step, in world.
struct Push {
  btVector3 moment{0, 0, 0};  ///< Angular impulse about its centre of mass [Nms].
  double load = 0;            ///< Impulse of bodies that lie on it [Ns].
};

class Physics {
 public:
  explicit Physics(const Vector3& gravity);
  ~Physics();

  /// Returns bodies of all links and joints at `pose`, not yet in the world, and marked with
  /// `model`.
  ModelBodies build(const ModelDescription& description, const Pose& pose, int model, int group,
                    int mask) const;
  void insert(ModelBodies& bodies);
  void remove(ModelBodies& bodies);
  /// Moves the bodies of an immobile model to the model's present pose.
  void shift(ModelBodies& bodies, const ModelDescription& description, const Pose& pose);

  /// Returns a number that grows whenever a static model is added, removed or moved.
  std::uint64_t fixtureChanges() const { return fixture_changes_; }

  /// Advances by one step; free of cost if no body is awake.
  void step(double dt);
  /// Sets the gravity of present and future bodies.
  void setGravity(const Vector3& gravity);
  /// Writes the pairs of models in contact, each once, the lower index first.
  void contacts(std::vector<Contact>* out) const;
  /// Returns Bullet's cached contacts, in an order that depends on the bodies alone.
  std::vector<btPersistentManifold*> manifolds() const { return dispatcher_.manifolds(); }
  /// Makes a manifold without contacts for every two parts near each other.
  std::vector<btPersistentManifold*> makeManifolds();
  /// Returns every point at which that model, as a, touches another one.
  std::vector<TouchPoint> touchPoints(int model) const;
  /// Returns the pushes on every movable body, by its second user index, without those of floors.
  std::vector<Push> pushes() const;
  /// Returns whether all bodies of the floor are unbounded and level.
  bool hasPlainFloor() const { return uneven_floors_ == 0; }
  /// Returns the distance to the first body on a ray, as a fraction of `range`; +inf = none.
  double cast(const Vector3& from, const Vector3& direction, double range) const;

 private:
  bool anyAwake() const;
  struct Velocity {
    btVector3 linear, angular;
  };
  /// The velocities of a body around a step.
  struct BodyMotion {
    Velocity before;  ///< Velocity at the end of the last step.
    Velocity driven;  ///< Velocity at the begin of this step, as set by motors.
    Velocity pushed;  ///< `driven` with the effect of forces in this step.
  };

  /// Calls visit(manifold, point, model_a, model_b) for all contact points of two models.
  template <typename Visit>
  void forEachTouch(Visit visit) const;
  void noteMotions(double dt);
  double approach(const btPersistentManifold& pair, const btManifoldPoint& point,
                  Velocity BodyMotion::*when) const;
  double impactShare(const btPersistentManifold& pair, const btManifoldPoint& point) const;

  btDefaultCollisionConfiguration configuration_;
  BoxBoxContacts::Creator box_contacts_;
  RoundContacts::Creator round_contacts_, swapped_round_contacts_;
  OrderedDispatcher dispatcher_;
  OwnPartsFilter own_parts_filter_;
  btDbvtBroadphase broadphase_;
  OrderedSolver solver_;
  ContactIslandWorld world_;

  std::vector<BodyMotion> motions_;  ///< Motions by a body's second user index.
  double dt_ = 0;                    ///< Size of the last step [s].
  std::uint64_t fixture_changes_ = 0;
  int uneven_floors_ = 0;  ///< Count of bodies in the floor's group other than level planes.
};

}  // namespace kiva
