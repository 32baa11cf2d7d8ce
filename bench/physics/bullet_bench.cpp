// SPDX-License-Identifier: Apache-2.0
//
// The fleet's workload in plain Bullet, as its manual does it: kinematic bodies moved each step, or
// (--hinges) rigid chassis on two hinged wheels with motors; lasers by rayTest.
#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "chunks.h"
#include "square.h"

namespace {

constexpr char kHelp[] = "bullet_bench [--hinges] [--no-lasers] [--seconds S] N…\n";
constexpr double kChassisMass = 140, kWheelMass = 2.5;  // [kg]
constexpr double kMotorTorque = 90;                     // [Nm]

/// A world with a floor and walls, and what it owns.
class BulletScene {
 public:
  explicit BulletScene(double size) : floor_({0, 0, 1}, 0), wall_({0.1, size / 2, 0.5}) {
    world_.setGravity({0, 0, -9.81});
    // Updates only what moved; otherwise each step updates everything in the broadphase.
    world_.setForceUpdateAllAabbs(false);
    add(0, &floor_, btTransform::getIdentity())->setFriction(1);
    for (int i = 0; i < 4; ++i) {
      const double at = (i % 2 ? -1 : 1) * (size / 2 + 0.1);
      const btQuaternion turn({0, 0, 1}, i < 2 ? 0 : M_PI / 2);
      add(0, &wall_, btTransform(turn, btVector3(i < 2 ? at : 0, i < 2 ? 0 : at, 0.5)));
    }
  }
  ~BulletScene() {
    for (auto& hinge : hinges_) world_.removeConstraint(hinge.get());
    for (auto& body : bodies_) world_.removeRigidBody(body.get());
  }

  btRigidBody* add(double mass, btCollisionShape* shape, const btTransform& pose) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    bodies_.push_back(std::make_unique<btRigidBody>(mass, nullptr, shape, inertia));
    bodies_.back()->setWorldTransform(pose);
    bodies_.back()->setInterpolationWorldTransform(pose);
    world_.addRigidBody(bodies_.back().get());
    return bodies_.back().get();
  }

  btHingeConstraint* addHinge(btRigidBody* chassis, btRigidBody* wheel, const btVector3& at) {
    hinges_.push_back(std::make_unique<btHingeConstraint>(*chassis, *wheel, at, btVector3(0, 0, 0),
                                                          btVector3(0, 1, 0), btVector3(0, 1, 0)));
    world_.addConstraint(hinges_.back().get(), true);
    return hinges_.back().get();
  }

  void step() { world_.stepSimulation(bench::kStep, 0); }

  /// Returns the sum of the ranges of a scan at that pose, so that no ray is optimised away.
  double scan(const btTransform& pose) const {
    double sum = 0;
    const btVector3 from = pose * btVector3(bench::kLaserAhead, 0, kLaserUp);
    for (int k = 0; k < bench::kRays; ++k) {
      const double angle = bench::rayAngle(k);
      const btVector3 ray(std::cos(angle), std::sin(angle), 0);
      const btVector3 to = from + pose.getBasis() * ray * bench::kRange;
      btCollisionWorld::ClosestRayResultCallback hit(from, to);
      world_.rayTest(from, to, hit);
      sum += hit.m_closestHitFraction * bench::kRange;
    }
    return sum;
  }

 private:
  static constexpr double kLaserUp = bench::kLaserHeight - bench::kBodyHeight;

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  btStaticPlaneShape floor_;
  btBoxShape wall_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
  std::vector<std::unique_ptr<btHingeConstraint>> hinges_;
};

btTransform start(const bench::Lattice& lattice, int i) {
  return btTransform(btQuaternion::getIdentity(),
                     btVector3(lattice.x(i), lattice.y(i), bench::kBodyHeight));
}

/// Kinematic bodies: nothing but their poses, integrated here.
class Kinematic {
 public:
  Kinematic(BulletScene& scene, const bench::Lattice& lattice, int robots)
      : body_({bench::kLength / 2, bench::kWidth / 2, bench::kHeight / 2}), yaw_(robots, 0) {
    for (int i = 0; i < robots; ++i) {
      chassis_.push_back(scene.add(0, &body_, start(lattice, i)));
      chassis_[i]->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
      chassis_[i]->setActivationState(DISABLE_DEACTIVATION);
    }
  }

  void drive(long step) {
    for (int i = 0; i < static_cast<int>(chassis_.size()); ++i) {
      const bench::PlanarTwist w = bench::command(i, step);
      yaw_[i] += w.yaw_rate * bench::kStep;
      const double way = w.speed * bench::kStep;
      btTransform pose(btQuaternion({0, 0, 1}, yaw_[i]),
                       chassis_[i]->getWorldTransform().getOrigin());
      pose.getOrigin() += btVector3(way * std::cos(yaw_[i]), way * std::sin(yaw_[i]), 0);
      chassis_[i]->setWorldTransform(pose);
    }
  }

  const btTransform& pose(int i) const { return chassis_[i]->getWorldTransform(); }

 private:
  btBoxShape body_;
  std::vector<btRigidBody*> chassis_;
  std::vector<double> yaw_;
};

/// Rigid chassis with two casters that slide, and two wheels with velocity motors.
class Hinged {
 public:
  Hinged(BulletScene& scene, const bench::Lattice& lattice, int robots)
      : box_({bench::kLength / 2, bench::kWidth / 2, bench::kHeight / 2}),
        caster_(0.05),
        wheel_({bench::kWheelRadius, bench::kWheelWidth / 2, bench::kWheelRadius}) {
    const auto at = [](double x, double z) {
      return btTransform(btQuaternion::getIdentity(), btVector3(x, 0, z));
    };
    body_.addChildShape(btTransform::getIdentity(), &box_);
    for (double x : {0.3, -0.3}) body_.addChildShape(at(x, 0.051 - bench::kBodyHeight), &caster_);
    for (int i = 0; i < robots; ++i) add(scene, start(lattice, i));
  }

  void drive(long step) {
    for (std::size_t i = 0; i < chassis_.size(); ++i) {
      const bench::PlanarTwist w = bench::command(static_cast<int>(i), step);
      for (int side = 0; side < 2; ++side) {
        const double turn = (side ? 1 : -1) * w.yaw_rate * bench::kTrack / 2;
        const double wheel_speed = (w.speed + turn) / bench::kWheelRadius;
        motors_[2 * i + side]->enableAngularMotor(true, -wheel_speed, kMotorTorque * bench::kStep);
      }
    }
  }

  const btTransform& pose(int i) const { return chassis_[i]->getWorldTransform(); }

 private:
  void add(BulletScene& scene, const btTransform& pose) {
    btRigidBody* chassis = scene.add(kChassisMass, &body_, pose);
    chassis->setFriction(0);
    chassis->setActivationState(DISABLE_DEACTIVATION);
    chassis_.push_back(chassis);
    for (double side : {1.0, -1.0}) {
      const btVector3 at(0, side * bench::kTrack / 2, bench::kWheelRadius - bench::kBodyHeight);
      btTransform place = pose;
      place.getOrigin() += at;
      btRigidBody* wheel = scene.add(kWheelMass, &wheel_, place);
      wheel->setFriction(0.8);
      wheel->setActivationState(DISABLE_DEACTIVATION);
      motors_.push_back(scene.addHinge(chassis, wheel, at));
    }
  }

  btBoxShape box_;
  btSphereShape caster_;
  btCylinderShape wheel_;  // along y
  btCompoundShape body_;
  std::vector<btRigidBody*> chassis_;
  std::vector<btHingeConstraint*> motors_;
};

template <typename Robots>
void run(const char* engine, const bench::Options& options, int robots) {
  const bench::Lattice lattice(robots);
  BulletScene scene(lattice.size());
  Robots fleet(scene, lattice, robots);
  long step = 0;
  double way = 0, ranges = 0;
  const btVector3 origin = fleet.pose(0).getOrigin();
  btVector3 last = origin;
  const auto factors = bench::measure(options.seconds, [&] {
    for (const long end = step + std::lround(options.seconds / bench::kStep); step < end; ++step) {
      fleet.drive(step);
      scene.step();
      way += (fleet.pose(0).getOrigin() - last).length();
      last = fleet.pose(0).getOrigin();
      for (int i = 0; options.lasers && i < robots; ++i) {
        if (bench::scanDue(i, step)) ranges += scene.scan(fleet.pose(i));
      }
    }
  });
  const double speed = way / (static_cast<double>(step) * bench::kStep);
  bench::print(engine, robots, options.lasers, factors,
               ", \"speed\": " + std::to_string(speed) + ", \"ranges\": " + std::to_string(ranges));
}

}  // namespace

int main(int argc, char** argv) {
  const bench::Options options = bench::parse(argc, argv, kHelp);
  bool hinges = false;
  for (const std::string& word : options.others) {
    if (word != "--hinges") bench::usage(kHelp);
    hinges = true;
  }
  for (int robots : options.robots) {
    hinges ? run<Hinged>("Bullet hinges", options, robots)
           : run<Kinematic>("Bullet kinematic", options, robots);
  }
}
