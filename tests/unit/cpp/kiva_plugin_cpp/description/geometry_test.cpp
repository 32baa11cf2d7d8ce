// SPDX-License-Identifier: Apache-2.0
//
// Vectors, rotations, poses and principal axes against closed forms.
#include "kiva_plugin_cpp/geometry.h"

#include <gtest/gtest.h>

#include <random>

#include "kiva_plugin_cpp/principal_inertia.h"

namespace kiva {
namespace {

constexpr double kExact = 1e-14;

void expectNear(const Vector3& a, const Vector3& b, double tolerance = kExact) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << "component " << i;
}

/// Expects that two rotations are equal; so are q and -q.
void expectSameTurn(const Quaternion& a, const Quaternion& b, double tolerance = kExact) {
  EXPECT_NEAR(std::abs(a.Dot(b)), 1, tolerance);
}

class Random {
 public:
  double within(double most) {
    return std::uniform_real_distribution<double>(-most, most)(engine_);
  }
  Vector3 vector() { return {within(3), within(3), within(3)}; }
  Quaternion turn() { return Quaternion(within(M_PI), within(M_PI_2), within(M_PI)); }
  Pose pose() { return {vector(), turn()}; }

 private:
  std::mt19937_64 engine_{1};
};

// --- vectors

TEST(Vector, IsZeroAtFirst) { expectNear(Vector3(), Vector3::Zero, 0); }

TEST(Vector, ProductsAreThoseOfTheBooks) {
  const Vector3 a(1, 2, 3), b(-4, 5, 0.5);
  EXPECT_EQ(a.Dot(b), 7.5);
  expectNear(a.Cross(b), {-14, -12.5, 13}, 0);
  expectNear(Vector3::UnitX.Cross(Vector3::UnitY), Vector3::UnitZ, 0);
  expectNear(a * b, {-4, 10, 1.5}, 0);
  expectNear(2 * a - b / 2, {4, 1.5, 5.75}, 0);
}

TEST(Vector, LengthsAndExtremes) {
  Vector3 v(2, -3, 6);
  EXPECT_EQ(v.Length(), 7);
  EXPECT_EQ(v.SquaredLength(), 49);
  EXPECT_EQ(v.Distance({2, 0, 2}), 5);
  EXPECT_EQ(v.Max(), 6);
  EXPECT_EQ(v.Min(), -3);
  EXPECT_EQ(v.Sum(), 5);
  expectNear(v.Abs(), {2, 3, 6}, 0);
  v.Max({0, 0, 9});
  expectNear(v, {2, 0, 9}, 0);
  v.Min({1, 1, 1});
  expectNear(v, {1, 0, 1}, 0);
}

TEST(Vector, WhatHasNoLengthIsNotNormalised) {
  EXPECT_NEAR(Vector3(3, 4, 12).Normalized().Length(), 1, kExact);
  expectNear(Vector3(1e-7, 0, 0).Normalized(), {1e-7, 0, 0}, 0);
}

TEST(Vector, EqualWithinATolerance) {
  EXPECT_TRUE(Vector3(1, 2, 3).Equal({1.5, 2, 3}, 0.5));
  EXPECT_FALSE(Vector3(1, 2, 3).Equal({1, 2, 3.6}, 0.5));
  EXPECT_FALSE(Vector3(NAN, 0, 0).Equal({NAN, 0, 0}, 1));
  EXPECT_FALSE(Vector3(0, INFINITY, 0).IsFinite());
}

// --- rotations

TEST(Rotation, AQuarterAboutEachAxis) {
  expectNear(Quaternion(0, 0, M_PI_2).RotateVector({1, 0, 0}), {0, 1, 0});
  expectNear(Quaternion(M_PI_2, 0, 0).RotateVector({0, 1, 0}), {0, 0, 1});
  expectNear(Quaternion(0, M_PI_2, 0).RotateVector({0, 0, 1}), {1, 0, 0});
}

TEST(Rotation, RollComesFirstThenPitchThenYaw) {
  Random random;
  for (int i = 0; i < 100; ++i) {
    const double roll = random.within(M_PI), pitch = random.within(M_PI_2),
                 yaw = random.within(M_PI);
    const Quaternion rotation(roll, pitch, yaw);
    expectSameTurn(rotation,
                   Quaternion(0, 0, yaw) * Quaternion(0, pitch, 0) * Quaternion(roll, 0, 0));
    expectNear(rotation.Euler(), {roll, pitch, yaw}, 1e-7);
  }
}

TEST(Rotation, StraightUpAndDownHaveNoYaw) {
  for (const double up : {1.0, -1.0}) {
    const Vector3 euler = Quaternion(0.3, up * M_PI_2, 0).Euler();
    EXPECT_NEAR(euler.Y(), up * M_PI_2, 1e-7);
    expectSameTurn(Quaternion(euler.X(), euler.Y(), euler.Z()), Quaternion(0.3, up * M_PI_2, 0),
                   1e-7);
  }
}

TEST(Rotation, AboutAnAxisOfAnyLength) {
  expectSameTurn(Quaternion(Vector3(0, 0, 5), 0.7), Quaternion(0, 0, 0.7));
  expectSameTurn(Quaternion(Vector3(0, 0, 0), 0.7), Quaternion::Identity, 0);
  // A third of a turn about the diagonal brings x to y, y to z, z to x.
  const Quaternion third(Vector3::One, 2 * M_PI / 3);
  expectNear(third.RotateVector({1, 2, 3}), {3, 1, 2});
}

TEST(Rotation, BackAndForth) {
  Random random;
  for (int i = 0; i < 100; ++i) {
    const Quaternion turn = random.turn();
    const Vector3 v = random.vector();
    expectNear(turn.RotateVectorReverse(turn.RotateVector(v)), v);
    expectNear(turn.Inverse().RotateVector(v), turn.RotateVectorReverse(v));
    expectNear(turn * v, turn.RotateVector(v));
    expectNear(Matrix3(turn) * v, turn.RotateVector(v));
    expectNear(turn.XAxis(), turn.RotateVector(Vector3::UnitX));
    expectNear(turn.YAxis(), turn.RotateVector(Vector3::UnitY));
    expectNear(turn.ZAxis(), turn.RotateVector(Vector3::UnitZ));
  }
}

TEST(Rotation, OfAnotherLengthTurnsTheSame) {
  const Quaternion twice(2 * std::cos(0.2), 0, 0, 2 * std::sin(0.2));
  expectNear(twice.RotateVector({1, 0, 0}), {std::cos(0.4), std::sin(0.4), 0});
  expectSameTurn(twice.Normalized(), Quaternion(0, 0, 0.4));
  expectSameTurn(Quaternion(0, 0, 0, 0).Normalized(), Quaternion::Identity, 0);
  EXPECT_EQ(Quaternion(0, 0, 0, 0).Inverse().W(), 1);
}

// --- poses

TEST(APose, PutsAFrameIntoAnother) {
  const Pose shelf(2, 1, 0, 0, 0, M_PI_2);
  expectNear(shelf.CoordPositionAdd({1, 0, 5}), {2, 2, 5});
  const Pose box = shelf * Pose(1, 0, 5, 0, 0, M_PI_2);
  expectNear(box.Pos(), {2, 2, 5});
  EXPECT_NEAR(box.Yaw(), M_PI, kExact);
}

TEST(APose, TimesItsInverseIsNone) {
  Random random;
  for (int i = 0; i < 100; ++i) {
    const Pose a = random.pose(), b = random.pose();
    const Pose none = a * a.Inverse();
    expectNear(none.Pos(), Vector3::Zero);
    expectSameTurn(none.Rot(), Quaternion::Identity);
    expectNear((a * b).CoordPositionAdd({1, 2, 3}),
               a.CoordPositionAdd(b.CoordPositionAdd({1, 2, 3})));
  }
}

// --- inertia

/// Returns the tensor of a rotated body with those principal moments.
InertiaTensor turned(const Vector3& m, const Quaternion& by) {
  const Matrix3 turn(by);
  const Matrix3 t = turn * Matrix3(m.X(), 0, 0, 0, m.Y(), 0, 0, 0, m.Z()) * turn.Transposed();
  return {{t(0, 0), t(1, 1), t(2, 2)}, {t(0, 1), t(0, 2), t(1, 2)}};
}

/// Expects that the moments in their axes give the tensor again.
void expectDiagonalised(const InertiaTensor& tensor, double tolerance) {
  const InertiaTensor again = turned(tensor.principalMoments(), tensor.principalAxes());
  expectNear(again.moments, tensor.moments, tolerance);
  expectNear(again.products, tensor.products, tolerance);
}

TEST(Inertia, OfABoxAlongItsEdgesStaysAsItIs) {
  const InertiaTensor box{{5, 2, 4}, {0, 0, 0}};
  expectNear(box.principalMoments(), {5, 2, 4}, 0);
  expectSameTurn(box.principalAxes(), Quaternion::Identity, 0);
}

TEST(Inertia, OfATurnedBodyHasItsMomentsInOrder) {
  Random random;
  for (int i = 0; i < 1000; ++i) {
    const InertiaTensor tensor = turned({4, 2, 5}, random.turn());
    if (!tensor.products.Equal(Vector3::Zero, 1e-3)) {
      expectNear(tensor.principalMoments(), {2, 4, 5}, 1e-7);
    }
    expectDiagonalised(tensor, 1e-5);
  }
}

TEST(Inertia, OfARodAndADiscHasAFreeAxis) {
  Random random;
  for (const Vector3& moments : {Vector3(0.1, 4, 4), Vector3(2, 2, 4)}) {
    for (int i = 0; i < 1000; ++i) expectDiagonalised(turned(moments, random.turn()), 1e-3);
  }
}

TEST(Inertia, OfABallIsNotTurned) {
  Random random;
  expectSameTurn(turned({3, 3, 3}, random.turn()).principalAxes(), Quaternion::Identity, 0);
}

TEST(Inertia, InAPlaneHasItsClosedForm) {
  // Mohr's circle: (a + d)/2 ± sqrt(((a - d)/2)² + b²).
  const InertiaTensor tensor{{3, 1, 4}, {1, 0, 0}};
  expectNear(tensor.principalMoments(), {2 - std::sqrt(2), 2 + std::sqrt(2), 4}, 1e-12);
}

TEST(Inertia, NoBodyHasAMomentAboveTheSumOfTheOthers) {
  EXPECT_TRUE((InertiaTensor{{1, 2, 3}, {0, 0, 0}}.isPossible(1)));  // a flat one
  EXPECT_FALSE((InertiaTensor{{1, 2, 3.1}, {0, 0, 0}}.isPossible(1)));
  EXPECT_FALSE((InertiaTensor{{1, 1, 1}, {2, 0, 0}}.isPossible(1)));
  EXPECT_FALSE((InertiaTensor{{1, 1, 1}, {0, 0, 0}}.isPossible(-1)));
  EXPECT_FALSE((InertiaTensor{{NAN, 1, 1}, {0, 0, 0}}.isPossible(1)));
}

}  // namespace
}  // namespace kiva
