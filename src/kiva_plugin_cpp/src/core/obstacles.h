// SPDX-License-Identifier: Apache-2.0
//
// Everything that stands or moves on the floor, seen from above: footprints in a grid of cells.
// It answers two questions quickly: what is near, and what does a horizontal ray meet.
#pragma once

#include <cstdint>
#include <vector>

class btCollisionObject;

namespace kiva {

/// The outline of an upright shape on the floor and the heights it spans. In world [m].
struct Footprint {
  enum class Kind : std::uint8_t {
    kBox,     ///< Rectangle hx × hy, turned by (c, s).
    kCircle,  ///< An upright cylinder of radius hx.
    kSphere,  ///< A sphere of radius hx; narrower off its middle height.
    kOther    ///< Bounded by a circle of radius hx; a ray asks `body` for the truth.
  };
  Kind kind = Kind::kBox;
  double x = 0, y = 0;
  double c = 1, s = 0;
  double hx = 0, hy = 0;
  double z_min = 0, z_max = 0;
  int model = -1;  ///< Whose it is: index in the world's models.
  int group = -1;  ///< Robot index for a robot and what it carries; rays of that robot pass.
  const btCollisionObject* body = nullptr;  ///< For kOther.
};

/// A lower bound of the distance between two outlines [m]; negative where they overlap.
double gap(const Footprint& a, const Footprint& b);

struct RayHit {
  double range = 0;  ///< [m]; +inf = nothing
  int model = -1;
};

class Obstacles {
 public:
  /// Returns a handle, valid until removed.
  int add(const Footprint& footprint);
  void update(int handle, const Footprint& footprint);
  void remove(int handle);
  const Footprint& operator[](int handle) const { return entries_[handle].footprint; }

  /// Calls visit(footprint) for each one whose box lies within `reach` [m] of (x, y), once or more
  /// often each.
  template <typename Visit>
  void near(double x, double y, double reach, Visit visit) const {
    const Range r = range(x - reach, x + reach, y - reach, y + reach);
    for (int cy = r.y0; cy <= r.y1; ++cy) {
      for (int cx = r.x0; cx <= r.x1; ++cx) {
        for (int handle : cells_[cell(cx, cy)]) visit(entries_[handle].footprint);
      }
    }
    for (int handle : everywhere_) visit(entries_[handle].footprint);
  }

  /// The first footprint on the horizontal ray from (x, y, z) along the unit vector (dx, dy), but
  /// for those of `group`.
  RayHit cast(double x, double y, double z, double dx, double dy, double range, int group) const;

 private:
  struct Range {  // of cells, inclusive
    int x0 = 0, x1 = -1, y0 = 0, y1 = -1;
    bool operator==(const Range& o) const {
      return x0 == o.x0 && x1 == o.x1 && y0 == o.y0 && y1 == o.y1;
    }
  };
  struct Entry {
    Footprint footprint;
    Range range;
    bool everywhere = false;
    bool used = false;
  };

  Range range(double min_x, double max_x, double min_y, double max_y) const;
  Range rangeOf(const Footprint& footprint) const;
  bool isInside(const Footprint& footprint) const;
  int cell(int cx, int cy) const { return cy * columns_ + cx; }
  void link(int handle);
  void unlink(int handle);
  void cover(const Footprint& footprint);

  std::vector<Entry> entries_;
  std::vector<int> free_;
  std::vector<std::vector<int>> cells_;
  std::vector<int> everywhere_;  // too large for cells
  double origin_x_ = 0, origin_y_ = 0;
  int columns_ = 0, rows_ = 0;
};

}  // namespace kiva
