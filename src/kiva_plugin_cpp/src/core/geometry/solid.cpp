// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/solid.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/infinity.h"

namespace kiva {
namespace {

/// The part of a line inside a shape, from `enter` to `leave`; empty if `leave` is less.
struct Span {
  double enter = kInfinity, leave = -kInfinity;
  bool empty() const { return enter > leave; }
};

Span common(const Span& a, const Span& b) {
  return {std::max(a.enter, b.enter), std::min(a.leave, b.leave)};
}

/// Returns the span that covers both, which are parts of one convex body.
Span around(const Span& a, const Span& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  return {std::min(a.enter, b.enter), std::max(a.leave, b.leave)};
}

/// Returns the span where a t² + 2 b t + c <= 0.
Span within(double a, double b, double c) {
  if (a < 1e-300) return c <= 0 ? Span{-kInfinity, kInfinity} : Span{};
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return {};
  // The first root has no cancellation; the other follows from their product.
  const double far = -(b + std::copysign(std::sqrt(discriminant), b));
  const double t0 = far / a, t1 = far == 0 ? 0 : c / far;
  return {std::min(t0, t1), std::max(t0, t1)};
}

Span inSphere(const Vector3& from, const Vector3& way, double radius) {
  return within(way.Dot(way), way.Dot(from), from.Dot(from) - radius * radius);
}

/// Returns the span in an infinite cylinder along z.
Span inTube(const Vector3& from, const Vector3& way, double radius) {
  return within(way.X() * way.X() + way.Y() * way.Y(), way.X() * from.X() + way.Y() * from.Y(),
                from.X() * from.X() + from.Y() * from.Y() - radius * radius);
}

Span inSlab(double from, double way, double half) {
  if (way == 0) return std::abs(from) <= half ? Span{-kInfinity, kInfinity} : Span{};
  const double t0 = (-half - from) / way, t1 = (half - from) / way;
  return {std::min(t0, t1), std::max(t0, t1)};
}

Span inside(Shape::Kind kind, const Vector3& half, const Vector3& from, const Vector3& way) {
  switch (kind) {
    case Shape::Kind::kBox: {
      Span span{-kInfinity, kInfinity};
      for (int i = 0; i < 3; ++i) span = common(span, inSlab(from[i], way[i], half[i]));
      return span;
    }
    case Shape::Kind::kCylinder:
      return common(inTube(from, way, half.X()), inSlab(from.Z(), way.Z(), half.Z()));
    case Shape::Kind::kCapsule: {
      const Vector3 end(0, 0, half.Z());
      const Span tube = common(inTube(from, way, half.X()), inSlab(from.Z(), way.Z(), half.Z()));
      return around(
          tube, around(inSphere(from - end, way, half.X()), inSphere(from + end, way, half.X())));
    }
    default:  // an ellipsoid: a unit sphere after scaling by its radii
      return inSphere(from / half, way / half, 1);
  }
}

Vector3 halfOf(const Shape& shape) {
  if (shape.kind == Shape::Kind::kBox) return shape.size * 0.5;
  if (shape.kind == Shape::Kind::kEllipsoid) return shape.size;
  return {shape.radius, shape.radius, shape.length / 2};
}

}  // namespace

Solid::Solid(const Shape& shape, const Quaternion& rotation)
    : kind(shape.kind),
      half(halfOf(shape)),
      axes{rotation.XAxis(), rotation.YAxis(), rotation.ZAxis()} {}

bool Solid::canBe(Shape::Kind kind) {
  return kind == Shape::Kind::kBox || kind == Shape::Kind::kCylinder ||
         kind == Shape::Kind::kCapsule || kind == Shape::Kind::kEllipsoid;
}

double Solid::cast(const Vector3& from, const Vector3& direction) const {
  const auto in_shape = [this](const Vector3& v) {
    return Vector3(axes[0].Dot(v), axes[1].Dot(v), axes[2].Dot(v));
  };
  const Span span = inside(kind, half, in_shape(from), in_shape(direction));
  if (span.empty() || span.leave < 0) return kInfinity;
  return span.enter >= 0 ? span.enter : span.leave;
}

}  // namespace kiva
