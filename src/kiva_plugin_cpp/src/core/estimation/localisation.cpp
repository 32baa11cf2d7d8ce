// SPDX-License-Identifier: Apache-2.0
#include "core/estimation/localisation.h"

#include <cmath>

#include "core/geometry/angle.h"

namespace kiva {
namespace {

constexpr int kN = Localisation::kStates;
constexpr double kWear = 1e-5;  // possible relative change of a radius over a metre

using Square = double[kN][kN];

PlanarPose onArc(const PlanarPose& from, double way, double turn) {
  const double middle = from.yaw + turn / 2;
  return {from.x + way * std::cos(middle), from.y + way * std::sin(middle), from.yaw + turn};
}

/// Computes how errors of the state propagate over a way [m] and a turn [rad].
void transition(const PlanarPose& at, const DriveSizes& drive, double way, double turn, Square& f) {
  const double middle = at.yaw - turn / 2;
  const double c = std::cos(middle), s = std::sin(middle);
  for (int i = 0; i < kN; ++i) {
    for (int j = 0; j < kN; ++j) f[i][j] = i == j ? 1 : 0;
  }
  f[0][2] = -way * s;
  f[1][2] = way * c;
  for (int wheel = 0; wheel < 2; ++wheel) {
    const double side = wheel == 0 ? -1 : 1;
    const double rolled = way + side * turn * drive.separation / 2;
    const double yaw = side * rolled / drive.separation;
    f[0][3 + wheel] = c * rolled / 2 - way * s * yaw / 2;
    f[1][3 + wheel] = s * rolled / 2 + way * c * yaw / 2;
    f[2][3 + wheel] = yaw;
  }
}

/// Inverts a symmetric, regular 3 x 3 matrix.
void invert(const double (&m)[3][3], double (&out)[3][3]) {
  const double a = m[0][0], b = m[0][1], c = m[0][2], d = m[1][1], e = m[1][2], g = m[2][2];
  const double aa = d * g - e * e, ab = c * e - b * g, ac = b * e - c * d;
  const double determinant = a * aa + b * ab + c * ac;
  const double bb = a * g - c * c, bc = b * c - a * e, cc = a * d - b * b;
  const double rows[3][3] = {{aa, ab, ac}, {ab, bb, bc}, {ac, bc, cc}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out[i][j] = rows[i][j] / determinant;
  }
}

}  // namespace

PlanarPose Localisation::at(double reference) const {
  if (!stretch.under_way) return pose;
  const double gone = reference - stretch.from;
  return stretch.turns ? onArc(pose, 0, gone) : onArc(pose, gone, stretch.curvature * gone);
}

void Localisation::settle(double reference, double left_angle, double right_angle) {
  if (!stretch.under_way) return;
  const double gone = reference - stretch.from;
  pose = at(reference);
  way += stretch.turns ? 0 : gone;
  turn += stretch.turns ? gone : stretch.curvature * gone;
  since_code += stretch.turns ? 0 : std::abs(gone);
  wheel_angle[0] = left_angle;
  wheel_angle[1] = right_angle;
  stretch.under_way = false;
}

double Localisation::roll(double left_angle, double right_angle) {
  const double left = (left_angle - wheel_angle[0]) * believed.radius[0] * (1 + slip[0]);
  const double right = (right_angle - wheel_angle[1]) * believed.radius[1] * (1 + slip[1]);
  wheel_angle[0] = left_angle;
  wheel_angle[1] = right_angle;
  const double gone = (left + right) / 2, turned = (right - left) / believed.separation;
  pose = onArc(pose, gone, turned);
  way += gone;
  turn += turned;
  since_code += std::abs(gone);
  return std::abs(gone);
}

void Localisation::propagate(double slip_noise, double separation_noise) {
  Square f, before, moved;
  transition(pose, believed, way, turn, f);
  for (int i = 0; i < kN; ++i) {
    for (int j = 0; j < kN; ++j) before[i][j] = covariance[i * kN + j];
  }
  for (int i = 0; i < kN; ++i) {
    for (int j = 0; j < kN; ++j) {
      moved[i][j] = 0;
      for (int k = 0; k < kN; ++k) moved[i][j] += f[i][k] * before[k][j];
    }
  }
  for (int i = 0; i < kN; ++i) {
    for (int j = 0; j < kN; ++j) {
      double sum = 0;
      for (int k = 0; k < kN; ++k) sum += moved[i][k] * f[j][k];
      covariance[i * kN + j] = sum;
    }
  }

  const double apart = turn * believed.separation / 2;
  const double rolled = std::abs(way - apart) + std::abs(way + apart);  // sum of both wheels [m]
  const double wheels = slip_noise * slip_noise * rolled;
  const double ahead = wheels / 4;
  const double yaw = wheels / (believed.separation * believed.separation) +
                     separation_noise * separation_noise * turn * turn;
  const double aside = yaw * way * way / 3, both = yaw * way / 2;
  const double c = std::cos(pose.yaw - turn / 2), s = std::sin(pose.yaw - turn / 2);
  const double x[3] = {c, -s, 0}, y[3] = {s, c, 0};  // directions ahead and to the left
  const auto add = [this](int i, int j, double value) {
    covariance[i * kN + j] += value;
    if (i != j) covariance[j * kN + i] += value;
  };
  add(0, 0, x[0] * x[0] * ahead + x[1] * x[1] * aside);
  add(0, 1, x[0] * y[0] * ahead + x[1] * y[1] * aside);
  add(1, 1, y[0] * y[0] * ahead + y[1] * y[1] * aside);
  add(0, 2, x[1] * both);
  add(1, 2, y[1] * both);
  add(2, 2, yaw);
  for (int wheel = 3; wheel < kN; ++wheel) add(wheel, wheel, kWear * kWear * rolled / 2);
  way = turn = 0;
}

void Localisation::measure(const double rates[2], double slip_noise, double slip_length,
                           double separation_noise, double speeds[2], double variances[4]) const {
  double rim[2];
  double per_rim[2][2];  // derivatives of speed and turn rate
  for (int wheel = 0; wheel < 2; ++wheel) {
    rim[wheel] = rates[wheel] * believed.radius[wheel] * (1 + slip[wheel]);
    per_rim[0][wheel] = 0.5;
    per_rim[1][wheel] = (wheel == 0 ? -1 : 1) / believed.separation;
  }
  for (int row = 0; row < 2; ++row) {
    speeds[row] = per_rim[row][0] * rim[0] + per_rim[row][1] * rim[1];
  }
  const double share = slip_noise * slip_noise / slip_length;
  for (int row = 0; row < 2; ++row) {
    for (int column = 0; column < 2; ++column) {
      double sum = row == 1 && column == 1 ? std::pow(separation_noise * speeds[1], 2) : 0;
      for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
          const double error = covariance[(3 + i) * kN + 3 + j] + (i == j ? share : 0);
          sum += per_rim[row][i] * rim[i] * per_rim[column][j] * rim[j] * error;
        }
      }
      variances[2 * row + column] = sum;
    }
  }
}

void Localisation::correct(const PlanarPose& reading, double position_noise, double angle_noise) {
  // Even a perfect code has a small deviation, so that the matrix is regular.
  const double position = position_noise * position_noise + 1e-12;
  const double angle = angle_noise * angle_noise + 1e-12;
  const double noise[3] = {position, position, angle};
  const double error[3] = {reading.x - pose.x, reading.y - pose.y,
                           wrapAngle(reading.yaw - pose.yaw)};
  double innovation[3][3], inverse[3][3];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) innovation[i][j] = covariance[i * kN + j] + (i == j ? noise[i] : 0);
  }
  invert(innovation, inverse);
  double gain[kN][3], change[kN] = {}, top[3][kN];
  for (int i = 0; i < kN; ++i) {
    for (int j = 0; j < 3; ++j) {
      gain[i][j] = 0;
      for (int k = 0; k < 3; ++k) gain[i][j] += covariance[i * kN + k] * inverse[k][j];
      change[i] += gain[i][j] * error[j];
    }
  }
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < kN; ++j) top[k][j] = covariance[k * kN + j];
  }
  for (int i = 0; i < kN; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = covariance[i * kN + j];
      for (int k = 0; k < 3; ++k) sum -= gain[i][k] * top[k][j];
      covariance[i * kN + j] = covariance[j * kN + i] = sum;
    }
  }
  pose = {pose.x + change[0], pose.y + change[1], pose.yaw + change[2]};
  for (int wheel = 0; wheel < 2; ++wheel) believed.radius[wheel] *= 1 + change[3 + wheel];
}

}  // namespace kiva
