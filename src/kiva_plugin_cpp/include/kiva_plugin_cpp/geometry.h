// SPDX-License-Identifier: Apache-2.0
//
// Vectors, rotations and poses in space. Frames are right-handed with z up (REP 103), lengths are
// in metres and angles in radians, unless a name says otherwise. Results are the same bit by bit on
// every machine that rounds as IEEE 754 asks: states of worlds are compared by their digests, so
// the order of operations in here is part of the contract.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <ostream>

namespace kiva {

/// Smallest length, and smallest sum of squares, that is not treated as zero in a division.
constexpr double kNegligible = 1e-6;

class Vector3 {
 public:
  static const Vector3 Zero, One, UnitX, UnitY, UnitZ;

  constexpr Vector3() = default;
  constexpr Vector3(double x, double y, double z) : data_{x, y, z} {}

  constexpr double X() const { return data_[0]; }
  constexpr double Y() const { return data_[1]; }
  constexpr double Z() const { return data_[2]; }
  constexpr double& X() { return data_[0]; }
  constexpr double& Y() { return data_[1]; }
  constexpr double& Z() { return data_[2]; }
  constexpr void X(double value) { data_[0] = value; }
  constexpr void Y(double value) { data_[1] = value; }
  constexpr void Z(double value) { data_[2] = value; }
  constexpr void Set(double x, double y, double z) { *this = Vector3(x, y, z); }
  /// `index` is 0, 1 or 2.
  constexpr double operator[](std::size_t index) const { return data_[index]; }
  constexpr double& operator[](std::size_t index) { return data_[index]; }

  constexpr Vector3 operator-() const { return {-X(), -Y(), -Z()}; }
  constexpr Vector3 operator+(const Vector3& v) const {
    return {X() + v.X(), Y() + v.Y(), Z() + v.Z()};
  }
  constexpr Vector3 operator-(const Vector3& v) const {
    return {X() - v.X(), Y() - v.Y(), Z() - v.Z()};
  }
  /// Multiplies component by component.
  constexpr Vector3 operator*(const Vector3& v) const {
    return {X() * v.X(), Y() * v.Y(), Z() * v.Z()};
  }
  constexpr Vector3 operator/(const Vector3& v) const {
    return {X() / v.X(), Y() / v.Y(), Z() / v.Z()};
  }
  constexpr Vector3 operator*(double s) const { return {X() * s, Y() * s, Z() * s}; }
  constexpr Vector3 operator/(double s) const { return {X() / s, Y() / s, Z() / s}; }
  constexpr friend Vector3 operator*(double s, const Vector3& v) { return v * s; }
  constexpr Vector3& operator+=(const Vector3& v) { return *this = *this + v; }
  constexpr Vector3& operator-=(const Vector3& v) { return *this = *this - v; }
  constexpr Vector3& operator*=(double s) { return *this = *this * s; }
  constexpr Vector3& operator/=(double s) { return *this = *this / s; }

  constexpr double Dot(const Vector3& v) const { return X() * v.X() + Y() * v.Y() + Z() * v.Z(); }
  constexpr Vector3 Cross(const Vector3& v) const {
    return {Y() * v.Z() - Z() * v.Y(), Z() * v.X() - X() * v.Z(), X() * v.Y() - Y() * v.X()};
  }
  constexpr double SquaredLength() const { return Dot(*this); }
  double Length() const { return std::sqrt(SquaredLength()); }
  double Distance(const Vector3& v) const { return (*this - v).Length(); }
  /// Makes its length 1, unless that is negligible; returns itself.
  Vector3& Normalize() {
    const double length = Length();
    return length <= kNegligible ? *this : *this /= length;
  }
  Vector3 Normalized() const { return Vector3(*this).Normalize(); }

  Vector3 Abs() const { return {std::abs(X()), std::abs(Y()), std::abs(Z())}; }
  /// Returns the largest component.
  constexpr double Max() const { return std::max(std::max(X(), Y()), Z()); }
  constexpr double Min() const { return std::min(std::min(X(), Y()), Z()); }
  /// Raises each component to at least that of `v`; Min() lowers it to at most that.
  constexpr void Max(const Vector3& v) {
    Set(std::max(X(), v.X()), std::max(Y(), v.Y()), std::max(Z(), v.Z()));
  }
  constexpr void Min(const Vector3& v) {
    Set(std::min(X(), v.X()), std::min(Y(), v.Y()), std::min(Z(), v.Z()));
  }
  constexpr double Sum() const { return X() + Y() + Z(); }
  bool IsFinite() const { return std::isfinite(X()) && std::isfinite(Y()) && std::isfinite(Z()); }
  /// Compares exactly.
  constexpr bool operator==(const Vector3& v) const {
    return X() == v.X() && Y() == v.Y() && Z() == v.Z();
  }
  constexpr bool operator!=(const Vector3& v) const { return !(*this == v); }
  /// Returns whether no component differs by more than `tolerance`.
  bool Equal(const Vector3& v, double tolerance) const {
    return std::abs(X() - v.X()) <= tolerance && std::abs(Y() - v.Y()) <= tolerance &&
           std::abs(Z() - v.Z()) <= tolerance;
  }

 private:
  double data_[3] = {0, 0, 0};
};

inline constexpr Vector3 Vector3::Zero(0, 0, 0);
inline constexpr Vector3 Vector3::One(1, 1, 1);
inline constexpr Vector3 Vector3::UnitX(1, 0, 0);
inline constexpr Vector3 Vector3::UnitY(0, 1, 0);
inline constexpr Vector3 Vector3::UnitZ(0, 0, 1);

/// A rotation, w + x i + y j + z k; its length is 1 but for rounding. `a * b` turns by b first.
class Quaternion {
 public:
  static const Quaternion Identity;

  constexpr Quaternion() = default;
  constexpr Quaternion(double w, double x, double y, double z) : w_(w), x_(x), y_(y), z_(z) {}
  /// A rotation about fixed axes: roll about x, then pitch about y, then yaw about z.
  Quaternion(double roll, double pitch, double yaw) {
    const double cr = std::cos(roll / 2), sr = std::sin(roll / 2);
    const double cp = std::cos(pitch / 2), sp = std::sin(pitch / 2);
    const double cy = std::cos(yaw / 2), sy = std::sin(yaw / 2);
    *this = Quaternion(cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy,
                       cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy);
    Normalize();
  }
  /// A rotation by `angle` about `axis`, which has any length; the identity if that is negligible.
  Quaternion(const Vector3& axis, double angle) {
    const double squared = axis.SquaredLength();
    if (!(squared <= kNegligible)) {
      const double s = std::sin(angle * 0.5) / std::sqrt(squared);
      *this = Quaternion(std::cos(angle * 0.5), axis.X() * s, axis.Y() * s, axis.Z() * s);
    }
    Normalize();
  }

  constexpr double W() const { return w_; }
  constexpr double X() const { return x_; }
  constexpr double Y() const { return y_; }
  constexpr double Z() const { return z_; }
  constexpr double& W() { return w_; }
  constexpr double& X() { return x_; }
  constexpr double& Y() { return y_; }
  constexpr double& Z() { return z_; }
  constexpr void Set(double w, double x, double y, double z) { *this = Quaternion(w, x, y, z); }

  constexpr double Dot(const Quaternion& q) const {
    return w_ * q.w_ + x_ * q.x_ + y_ * q.y_ + z_ * q.z_;
  }
  constexpr Quaternion operator*(const Quaternion& q) const {
    return {w_ * q.w_ - x_ * q.x_ - y_ * q.y_ - z_ * q.z_,
            w_ * q.x_ + x_ * q.w_ + y_ * q.z_ - z_ * q.y_,
            w_ * q.y_ - x_ * q.z_ + y_ * q.w_ + z_ * q.x_,
            w_ * q.z_ + x_ * q.y_ - y_ * q.x_ + z_ * q.w_};
  }
  /// Returns `v` rotated, if the length is 1. It is faster than RotateVector, with other rounding.
  Vector3 operator*(const Vector3& v) const {
    const Vector3 axis(x_, y_, z_);
    const Vector3 once = axis.Cross(v);
    return v + once * (2.0 * w_) + axis.Cross(once) * 2.0;
  }
  /// Returns `v` rotated, whatever the quaternion's length; RotateVectorReverse rotates it back.
  Vector3 RotateVector(const Vector3& v) const {
    return (*this * (Quaternion(0, v.X(), v.Y(), v.Z()) * Inverse())).vector();
  }
  Vector3 RotateVectorReverse(const Vector3& v) const {
    return (Inverse() * (Quaternion(0, v.X(), v.Y(), v.Z()) * *this)).vector();
  }

  /// Compares exactly, component by component.
  constexpr bool operator==(const Quaternion& q) const {
    return w_ == q.w_ && x_ == q.x_ && y_ == q.y_ && z_ == q.z_;
  }
  constexpr bool operator!=(const Quaternion& q) const { return !(*this == q); }
  /// Returns the inverse rotation; the identity if the length is negligible.
  Quaternion Inverse() const {
    const double s = Dot(*this);
    if (s <= kNegligible) return Quaternion();
    return {w_ / s, -x_ / s, -y_ / s, -z_ / s};
  }
  /// Makes its length 1; becomes the identity if that is negligible.
  void Normalize() {
    const double length = std::sqrt(Dot(*this));
    *this = length <= kNegligible ? Quaternion()
                                  : Quaternion(w_ / length, x_ / length, y_ / length, z_ / length);
  }
  Quaternion Normalized() const {
    Quaternion result = *this;
    result.Normalize();
    return result;
  }
  bool IsFinite() const {
    return std::isfinite(w_) && std::isfinite(x_) && std::isfinite(y_) && std::isfinite(z_);
  }

  /// Returns roll, pitch and yaw. Pitch is in -pi/2 to pi/2; yaw is 0 at either end of it.
  Vector3 Euler() const {
    const Quaternion q = Normalized();
    const double ww = q.w_ * q.w_, xx = q.x_ * q.x_, yy = q.y_ * q.y_, zz = q.z_ * q.z_;
    const double sine = -2 * (q.x_ * q.z_ - q.w_ * q.y_);
    const double pitch = sine <= -1 ? -M_PI_2 : sine >= 1 ? M_PI_2 : std::asin(sine);
    constexpr double kUpright = 1e-15;
    for (const double up : {1.0, -1.0}) {
      if (!(std::abs(sine - up) < kUpright)) continue;
      return {std::atan2(up * 2 * (q.x_ * q.y_ - q.z_ * q.w_), ww - xx + yy - zz), pitch, 0};
    }
    return {std::atan2(2 * (q.y_ * q.z_ + q.w_ * q.x_), ww - xx - yy + zz), pitch,
            std::atan2(2 * (q.x_ * q.y_ + q.w_ * q.z_), ww + xx - yy - zz)};
  }
  double Roll() const { return Euler().X(); }
  double Pitch() const { return Euler().Y(); }
  double Yaw() const { return Euler().Z(); }

  /// Returns the x axis of the rotated frame, if the length is 1; YAxis and ZAxis likewise.
  Vector3 XAxis() const {
    const double y2 = 2 * y_, z2 = 2 * z_;
    return {1 - (y2 * y_ + z2 * z_), y2 * x_ + z2 * w_, z2 * x_ - y2 * w_};
  }
  Vector3 YAxis() const {
    const double x2 = 2 * x_, y2 = 2 * y_, z2 = 2 * z_;
    return {y2 * x_ - z2 * w_, 1 - (x2 * x_ + z2 * z_), z2 * y_ + x2 * w_};
  }
  Vector3 ZAxis() const {
    const double x2 = 2 * x_, y2 = 2 * y_, z2 = 2 * z_;
    return {z2 * x_ + y2 * w_, z2 * y_ - x2 * w_, 1 - (x2 * x_ + y2 * y_)};
  }

 private:
  constexpr Vector3 vector() const { return {x_, y_, z_}; }

  double w_ = 1, x_ = 0, y_ = 0, z_ = 0;
};

inline constexpr Quaternion Quaternion::Identity{};

/// The pose of a frame in another one. `a_in_world * b_in_a` is b in world.
class Pose {
 public:
  static const Pose Zero;  ///< The pose of a frame in itself.

  constexpr Pose() = default;
  constexpr Pose(const Vector3& position, const Quaternion& rotation)
      : p_(position), q_(rotation) {}
  Pose(double x, double y, double z, double roll, double pitch, double yaw)
      : p_(x, y, z), q_(roll, pitch, yaw) {}
  constexpr Pose(double x, double y, double z, double qw, double qx, double qy, double qz)
      : p_(x, y, z), q_(qw, qx, qy, qz) {}

  constexpr const Vector3& Pos() const { return p_; }
  constexpr Vector3& Pos() { return p_; }
  constexpr const Quaternion& Rot() const { return q_; }
  constexpr Quaternion& Rot() { return q_; }
  constexpr double X() const { return p_.X(); }
  constexpr double Y() const { return p_.Y(); }
  constexpr double Z() const { return p_.Z(); }
  double Roll() const { return q_.Roll(); }
  double Pitch() const { return q_.Pitch(); }
  double Yaw() const { return q_.Yaw(); }
  bool IsFinite() const { return p_.IsFinite() && q_.IsFinite(); }

  /// Compares exactly.
  constexpr bool operator==(const Pose& pose) const { return p_ == pose.p_ && q_ == pose.q_; }
  constexpr bool operator!=(const Pose& pose) const { return !(*this == pose); }

  Pose operator*(const Pose& inner) const { return {CoordPositionAdd(inner.p_), q_ * inner.q_}; }
  /// Returns a point of this frame in the other frame.
  Vector3 CoordPositionAdd(const Vector3& point) const { return p_ + q_.RotateVector(point); }
  /// Returns the pose of the other frame in this one.
  Pose Inverse() const {
    const Quaternion back = q_.Inverse();
    return {back * (p_ * -1), back};
  }

 private:
  Vector3 p_;
  Quaternion q_;
};

inline constexpr Pose Pose::Zero{};

/// Prints x, y and z for a person; a pose also prints roll, pitch and yaw.
inline std::ostream& operator<<(std::ostream& out, const Vector3& v) {
  return out << v.X() << ' ' << v.Y() << ' ' << v.Z();
}
inline std::ostream& operator<<(std::ostream& out, const Pose& pose) {
  return out << pose.Pos() << ' ' << pose.Rot().Euler();
}

}  // namespace kiva
