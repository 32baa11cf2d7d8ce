// SPDX-License-Identifier: Apache-2.0
//
// Method of M. J. Kronenburg, "A method for fast diagonalization of a 2x2 or 3x3 real symmetric
// matrix", arXiv:1306.6291v4. Equations and the names phi1, phi2, phi3, f and g are those of the
// paper.
#include "kiva_plugin_cpp/principal_inertia.h"

#include <array>
#include <limits>

namespace kiva {
namespace {

struct PlaneVector {
  double x = 0, y = 0;
};

double square(double x) { return x * x; }
double squaredLength(const PlaneVector& v) { return v.x * v.x + v.y * v.y; }
double clampedRoot(double x) { return x <= 0 ? 0 : std::sqrt(x); }
double angleOfCosine(double squared) {
  return std::acos(std::clamp(clampedRoot(squared), -1.0, 1.0));
}
double wrapped(double angle) { return std::atan2(std::sin(angle), std::cos(angle)); }

bool isSmall(const PlaneVector& v, double tolerance) {
  return squaredLength(v) < square(tolerance);
}

double angleOf(const PlaneVector& v, double tolerance) {
  return isSmall(v, tolerance) ? 0 : std::atan2(v.y, v.x);
}

/// Returns the squared chord between two directions.
double chord(double a, double b) {
  return square(std::sin(a) - std::sin(b)) + square(std::cos(a) - std::cos(b));
}

/// Returns the largest error by which rounding may change the moments of a possible body.
double roundingOf(const Vector3& moments) {
  constexpr double kUlps = 10;
  return kUlps * std::numeric_limits<double>::epsilon() * (0.5 * std::abs(moments.Sum()));
}

Quaternion turnBack(double phi1, double phi2, double phi3) {
  return Quaternion(-phi1, -phi2, -phi3).Inverse();
}

/// Finds the angles for a tensor whose principal moments are known.
class AxisSearch {
 public:
  AxisSearch(const InertiaTensor& tensor, const Vector3& moments, double tolerance)
      : first_(tensor.moments.X()),
        moments_(moments),
        products_(tensor.products),
        tolerance_(tolerance),
        f1_{tensor.products.X(), -tensor.products.Y()},
        f2_{tensor.moments.Y() - tensor.moments.Z(), -2 * tensor.products.Z()} {}

  Quaternion run() const {
    if (areEqual(moments_.X(), moments_.Y())) return withTwoEqual(moments_.Z());
    if (areEqual(moments_.Y(), moments_.Z())) {  // the unequal one is to come first
      return withTwoEqual(moments_.X()) * Quaternion(0, M_PI_2, 0);
    }
    return withAllDifferent();
  }

 private:
  bool areEqual(double a, double b) const { return std::abs(a - b) <= std::abs(tolerance_); }
  double angleOf1(const PlaneVector& g1) const {  // eqs. 5.11, 5.13
    return wrapped(angleOf(g1, tolerance_) - angleOf(f1_, tolerance_));
  }
  double angleOf2(const PlaneVector& g2) const {  // eqs. 5.12, 5.14
    return wrapped(0.5 * (angleOf(g2, tolerance_) - angleOf(f2_, tolerance_)));
  }

  /// Section 5, eqs. 5.21 to 5.25: a turn about the axis of the unequal moment is free.
  Quaternion withTwoEqual(double unequal) const {
    const double apart = moments_.Y() - unequal;
    const double s = (first_ - unequal) / apart;
    double phi2 = angleOfCosine(s);
    const double phi1 = angleOf2({apart * s, 0});
    if (!isSmall(f1_, tolerance_)) {
      const double up = angleOf1({0, 0.5 * apart * std::sin(2 * phi2)});
      const double down = angleOf1({0, 0.5 * apart * std::sin(-2 * phi2)});
      if (chord(phi1, down) < chord(phi1, up)) phi2 *= -1;
    }
    return turnBack(phi1, phi2, 0);
  }

  Quaternion withAllDifferent() const {
    const double m0 = moments_.X(), m1 = moments_.Y(), m2 = moments_.Z();
    const double v =
        (square(products_.X()) + square(products_.Y()) + (first_ - m2) * (first_ + m2 - m0 - m1)) /
        ((m1 - m2) * (m2 - m0));  // eq. 5.1
    const double w =
        v < std::abs(tolerance_) ? 1 : (first_ - m2 + (m2 - m1) * v) / ((m0 - m1) * v);  // eq. 5.2
    const double phi2 = angleOfCosine(v), phi3 = angleOfCosine(w);                       // eq. 5.3
    const PlaneVector g1{0.5 * (m0 - m1) * clampedRoot(v) * std::sin(2 * phi3),
                         0.5 * ((m0 - m1) * w + m1 - m2) * std::sin(2 * phi2)};  // eq. 5.7
    const PlaneVector g2{(m0 - m1) * (1 + (v - 2) * w) + (m1 - m2) * v,
                         (m0 - m1) * std::sin(phi2) * std::sin(2 * phi3)};  // eq. 5.8
    const bool is_small1 = isSmall(f1_, tolerance_), is_small2 = isSmall(f2_, tolerance_);
    if (is_small1) return turnBack(is_small2 ? 0 : angleOf2(g2), phi2, phi3);
    if (is_small2) return turnBack(angleOf1(g1), phi2, phi3);
    return withBestSigns(g1, g2, phi2, phi3);
  }

  /// phi2 and phi3 are known up to their signs. The right signs are those with which both formulas
  /// for phi1 agree.
  Quaternion withBestSigns(const PlaneVector& g1, const PlaneVector& g2, double phi2,
                           double phi3) const {
    struct Signs {
      double of_phi2, of_phi3;
    };
    constexpr std::array<Signs, 4> kSigns{{{1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};
    double phi1 = 0, least = std::numeric_limits<double>::infinity();
    Signs best = kSigns.front();
    for (const Signs& sign : kSigns) {
      const PlaneVector turned1{sign.of_phi3 * g1.x, sign.of_phi2 * g1.y};
      const PlaneVector turned2{g2.x, sign.of_phi2 * sign.of_phi3 * g2.y};
      const double first_angle = angleOf1(turned1), second_angle = angleOf2(turned2);
      if (!(chord(first_angle, second_angle) < least)) continue;
      least = chord(first_angle, second_angle);
      phi1 = first_angle;
      best = sign;
    }
    return turnBack(phi1, best.of_phi2 * phi2, best.of_phi3 * phi3);
  }

  const double first_;  // Ixx
  const Vector3 moments_, products_;
  const double tolerance_;
  const PlaneVector f1_, f2_;  // eqs. 5.5, 5.6
};

}  // namespace

Matrix3::Matrix3(const Quaternion& rotation) {
  const Quaternion q = rotation.Normalized();
  const double w = q.W(), x = q.X(), y = q.Y(), z = q.Z();
  *this = Matrix3(1 - 2 * y * y - 2 * z * z, 2 * x * y - 2 * z * w, 2 * x * z + 2 * y * w,
                  2 * x * y + 2 * z * w, 1 - 2 * x * x - 2 * z * z, 2 * y * z - 2 * x * w,
                  2 * x * z - 2 * y * w, 2 * y * z + 2 * x * w, 1 - 2 * x * x - 2 * y * y);
}

Matrix3 Matrix3::operator+(const Matrix3& m) const {
  Matrix3 sum;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      sum(row, column) = (*this)(row, column) + m(row, column);
  }
  return sum;
}

Matrix3 Matrix3::operator-(const Matrix3& m) const {
  Matrix3 difference;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      difference(row, column) = (*this)(row, column) - m(row, column);
    }
  }
  return difference;
}

Matrix3 Matrix3::operator*(const Matrix3& m) const {
  Matrix3 product;
  for (int row = 0; row < 3; ++row) {
    const Vector3 left(data_[row][0], data_[row][1], data_[row][2]);
    for (int column = 0; column < 3; ++column) {
      product(row, column) = left.Dot({m(0, column), m(1, column), m(2, column)});
    }
  }
  return product;
}

Vector3 Matrix3::operator*(const Vector3& v) const {
  Vector3 product;
  for (int row = 0; row < 3; ++row) {
    product[row] = Vector3(data_[row][0], data_[row][1], data_[row][2]).Dot(v);
  }
  return product;
}

Matrix3 Matrix3::Transposed() const {
  return Matrix3(data_[0][0], data_[1][0], data_[2][0], data_[0][1], data_[1][1], data_[2][1],
                 data_[0][2], data_[1][2], data_[2][2]);
}

double Matrix3::Determinant() const {
  const double first = data_[2][2] * data_[1][1] - data_[2][1] * data_[1][2];
  const double second = -(data_[2][2] * data_[1][0] - data_[2][0] * data_[1][2]);
  const double third = data_[2][1] * data_[1][0] - data_[2][0] * data_[1][1];
  return first * data_[0][0] + second * data_[0][1] + third * data_[0][2];
}

Matrix3 InertiaTensor::matrix() const {
  const double xy = products.X(), xz = products.Y(), yz = products.Z();
  return Matrix3(moments.X(), xy, xz, xy, moments.Y(), yz, xz, yz, moments.Z());
}

bool InertiaTensor::isPossible(double mass) const {
  // Sylvester's criterion, then the triangle inequality.
  const double spare = roundingOf(moments);
  const bool is_positive = mass >= 0 && moments.X() + spare >= 0 &&
                           moments.X() * moments.Y() - square(products.X()) + spare >= 0 &&
                           matrix().Determinant() + spare >= 0;
  if (!is_positive) return false;
  const Vector3 principal = principalMoments();
  const double slack = roundingOf(principal);
  for (int i = 0; i < 3; ++i) {
    const double moment = principal[i], next = principal[(i + 1) % 3],
                 last = principal[(i + 2) % 3];
    if (!(moment + slack >= 0 && moment + next + slack >= last)) return false;
  }
  return true;
}

Vector3 InertiaTensor::principalMoments(double tolerance) const {
  const double negligible = tolerance * moments.Max();
  if (products.Equal(Vector3::Zero, negligible)) return moments;
  const double xx = moments.X(), yy = moments.Y(), zz = moments.Z();
  const double xy = products.X(), xz = products.Y(), yz = products.Z();
  // The characteristic polynomial's coefficients, and its roots by cosines: eqs. 4.1 to 4.9.
  const double b = moments.Sum();
  const double c = xx * yy - square(xy) + xx * zz - square(xz) + yy * zz - square(yz);
  const double d =
      xx * square(yz) + yy * square(xz) + zz * square(xy) - xx * yy * zz - 2 * xy * xz * yz;
  const double p = square(b) - 3 * c;
  if (p < square(negligible)) return b / 3.0 * Vector3::One;
  const double q = 2 * std::pow(b, 3) - 9 * b * c - 27 * d;
  const double delta = std::acos(std::clamp(0.5 * q / std::pow(p, 1.5), -1.0, 1.0));
  std::array<double, 3> roots = {(b + 2 * std::sqrt(p) * std::cos(delta / 3.0)) / 3.0,
                                 (b + 2 * std::sqrt(p) * std::cos((delta + 2 * M_PI) / 3.0)) / 3.0,
                                 (b + 2 * std::sqrt(p) * std::cos((delta - 2 * M_PI) / 3.0)) / 3.0};
  std::sort(roots.begin(), roots.end());
  return {roots[0], roots[1], roots[2]};
}

Quaternion InertiaTensor::principalAxes() const {
  const double tolerance = kNegligible * moments.Max();
  // ignition-math, and so Gazebo, treats this relative tolerance as an absolute one. Doing the same
  // keeps the axes that models have there.
  const Vector3 principal = principalMoments(tolerance);
  const double spare = std::abs(tolerance);
  const bool are_equal = std::abs(principal.X() - principal.Y()) <= spare &&
                         std::abs(principal.X() - principal.Z()) <= spare;
  if (are_equal || principal.Equal(moments, tolerance)) return Quaternion::Identity;
  return AxisSearch(*this, principal, tolerance).run();
}

}  // namespace kiva
