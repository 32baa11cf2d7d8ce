// SPDX-License-Identifier: Apache-2.0
//
// Inertia tensors, and the axes along which they have no products of inertia.
#pragma once

#include "kiva_plugin_cpp/geometry.h"

namespace kiva {

/// A 3x3 matrix; rows and columns count from 0.
class Matrix3 {
 public:
  constexpr Matrix3() = default;
  constexpr Matrix3(double m00, double m01, double m02, double m10, double m11, double m12,
                    double m20, double m21, double m22)
      : data_{{m00, m01, m02}, {m10, m11, m12}, {m20, m21, m22}} {}
  /// The matrix of a rotation.
  explicit Matrix3(const Quaternion& rotation);

  constexpr double operator()(int row, int column) const { return data_[row][column]; }
  constexpr double& operator()(int row, int column) { return data_[row][column]; }
  Matrix3 operator+(const Matrix3& m) const;
  Matrix3 operator-(const Matrix3& m) const;
  Matrix3 operator*(const Matrix3& m) const;
  Vector3 operator*(const Vector3& v) const;
  Matrix3 Transposed() const;
  double Determinant() const;

 private:
  double data_[3][3] = {};
};

/// An inertia tensor about the centre of mass, along the axes of a frame [kg m²].
struct InertiaTensor {
  Vector3 moments;   ///< Ixx, Iyy, Izz.
  Vector3 products;  ///< Ixy, Ixz, Iyz as entries of the tensor: the negative integrals.

  Matrix3 matrix() const;
  /// Returns whether a body of that mass [kg] can have it: nothing is negative, and no principal
  /// moment exceeds the sum of the others.
  bool isPossible(double mass) const;
  /// Returns the moments about the principal axes, in ascending order. If the products are
  /// negligible (up to `tolerance` times the largest moment), returns the diagonal unsorted.
  Vector3 principalMoments(double tolerance = kNegligible) const;
  /// Returns the rotation from the frame's axes to the principal ones, in the order of
  /// principalMoments(). If the principal axes are not unique, those next to the frame's axes are
  /// chosen; if all three moments are about equal, the frame's own.
  Quaternion principalAxes() const;
};

}  // namespace kiva
