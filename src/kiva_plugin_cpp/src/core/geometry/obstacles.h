// SPDX-License-Identifier: Apache-2.0
//
// All models on the floor, seen from above: footprints in a grid of cells. Answers two queries
// quickly: what is near, and what a horizontal ray meets.
#pragma once

#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/geometry/footprint.h"
#include "core/geometry/loose_grid.h"
#include "core/geometry/ray_fan.h"
#include "kiva_plugin_cpp/fleet.h"

namespace kiva {

/// Returns a lower bound of the distance between two outlines [m]; negative where they overlap.
double gap(const Footprint& a, const Footprint& b);

/// Returns whether the gap may be less than `distance`: a fast test with false positives.
inline bool mayBeWithin(double distance, const Footprint& a, const Footprint& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double reach = radiusOf(a) + radiusOf(b) + distance;
  return reach > 0 && dx * dx + dy * dy < reach * reach;
}

/// A range of heights, both included [m].
struct Heights {
  double low = 0, high = 0;
};

struct RayHit {
  double range = 0;  ///< [m]; +inf = nothing
  int model = -1;
  /// Adds a hit at that distance. The nearest hit counts; of equally near ones that of the first
  /// model, so that the order of calls does not matter.
  void meet(double distance, int other) {
    const bool is_nearer = distance < range || (distance == range && model >= 0 && other < model);
    if (is_nearer) *this = {distance, other};
  }
};

/// The obstacles of a world. A robot with its load is a mover: footprints that move together. A
/// mover is indexed by a circle around its robot with some slack, so that the index changes seldom.
/// Its footprints in world are computed on demand.
class Obstacles {
 public:
  static constexpr double kSlack =
      0.25;  ///< Distance that a mover may move before it is reindexed [m].

  /// Movers are at the poses of the fleet's robots.
  explicit Obstacles(const Fleet& fleet) : fleet_(fleet) {}

  void clear();
  /// Adds a footprint. Returns a handle, valid until remove().
  int add(const Footprint& footprint);
  void update(int handle, const Footprint& footprint);
  void remove(int handle);
  const Footprint& operator[](int handle) const { return entries_[handle].footprint; }

  /// Replaces the footprints of a robot, given in its frame.
  void setMover(int robot, std::vector<Footprint> local);
  /// Raises those of its footprints that belong to `model` by `by` [m].
  void raise(int robot, int model, double by);
  /// Returns a mover's footprints in the robot's frame.
  const std::vector<Footprint>& ofMover(int robot) const { return movers_[robot].local; }
  /// Returns the radius of the circle around the robot that contains its mover [m].
  double radius(int robot) const { return radius_[robot]; }
  /// Removes a mover. The last mover takes its index, as in the fleet.
  void removeMover(int robot);
  /// Updates the index if the mover has left its circle, or might leave it within the next `way`
  /// [m].
  void follow(int robot, double way = 0);
  /// Returns a mover's present footprints in world.
  const std::vector<Footprint>& footprints(int robot) const;

  /// Calls visit(footprint) for each footprint whose box lies within `reach` [m] of (x, y).
  template <typename Visit>
  void near(double x, double y, double reach, Visit visit) const {
    const auto see = [&](const Footprint& footprint) {
      visit(footprint);
      return false;
    };
    any(x, y, reach, see, [&](int robot, double radius) {
      const double dx = fleet_.x[robot] - x, dy = fleet_.y[robot] - y;
      const double farthest = radius + std::sqrt(2.0) * reach;  // to a corner of that square
      if (dx * dx + dy * dy > farthest * farthest) return false;
      for (const Footprint& footprint : footprints(robot)) visit(footprint);
      return false;
    });
  }

  /// Returns whether any obstacle within `reach` of (x, y) satisfies its condition:
  /// meets(footprint) for entries, approaches(robot, radius) for movers. `radius` is that of the
  /// circle around the robot that contains its mover.
  template <typename Meets, typename Approaches>
  bool any(double x, double y, double reach, Meets meets, Approaches approaches) const {
    const CellRange cells = range({x - reach, x + reach, y - reach, y + reach});
    return anyHandle(cells, cells, [&](int handle) {
      return handle >= 0 ? meets(entries_[handle].footprint)
                         : approaches(~handle, radius_[~handle]);
    });
  }

  /// Does the same for entries with a point at these heights in the circle of radius `reach` around
  /// (x, y), and for movers whose circle has a point in that of radius `mover_reach`.
  template <typename Meets, typename Approaches>
  bool anyAround(double x, double y, const Heights& heights, double reach, double mover_reach,
                 Meets meets, Approaches approaches) const {
    const auto moves = [&](int robot) {
      const double dx = fleet_.x[robot] - x, dy = fleet_.y[robot] - y;
      const double most = mover_reach + radius_[robot];
      return dx * dx + dy * dy < most * most && approaches(robot, radius_[robot]);
    };
    const auto stands = [&](int handle) {
      const Spot& spot = spots_[handle];
      return spot.isAt(heights) && spot.isWithin(reach, x, y) && meets(entries_[handle].footprint);
    };
    const auto ask = [&](int handle) { return handle < 0 ? moves(~handle) : stands(handle); };
    const CellRange near = range({x - reach, x + reach, y - reach, y + reach});
    const int movers = static_cast<int>(movers_.size());
    if (movers > kFew) {
      const double far = mover_reach;
      return anyHandle(near, range({x - far, x + far, y - far, y + far}), ask);
    }
    // A few movers are faster to test than the cells in which they may be.
    for (int robot = 0; robot < movers; ++robot) {
      if (moves(robot)) return true;
    }
    return anyHandle(near, near, [&](int handle) { return handle >= 0 && stands(handle); });
  }

  /// Returns the first surface on the horizontal ray from (x, y, z) along the unit vector (dx, dy),
  /// except those of `group`. A ray that starts inside a shape meets it from inside.
  RayHit cast(double x, double y, double z, double dx, double dy, double range, int group) const;
  /// Does the same for the rays of a fan.
  void cast(const RayFan& fan, const Sensor& from, const FanReach& reach, int group,
            FanHits* hits) const;

 private:
  static constexpr int kFew = 32;  // movers

  struct CellRange {  // range of cells, inclusive
    int x0 = 0, x1 = -1, y0 = 0, y1 = -1;
    bool operator==(const CellRange& o) const {
      return x0 == o.x0 && x1 == o.x1 && y0 == o.y0 && y1 == o.y1;
    }
    bool holds(int x, int y) const { return x >= x0 && x <= x1 && y >= y0 && y <= y1; }
  };
  struct Box {  // along the world's axes [m]
    double min_x, max_x, min_y, max_y;
  };
  struct Place {  // position in the index
    CellRange range;
    bool everywhere = false;
    bool linked = false;
  };
  struct Entry {
    Footprint footprint;
    Place place;
    bool used = false;
  };
  struct Corner {  // first cell of a CellRange
    std::int16_t x0 = 0, y0 = 0;
  };
  /// A cylinder around an entry. Most obstacles near a robot are ruled out by it, without a look at
  /// their footprints, which are all over the memory.
  struct Spot {
    Corner corner;
    float x = 0, y = 0, radius = 0;  // circle that contains it [m]
    float z_min = 0, z_max = 0;      // heights that contain its own [m]

    bool isAt(const Heights& heights) const {
      return z_min <= heights.high && heights.low <= z_max;
    }

    bool isWithin(double reach, double from_x, double from_y) const {
      const double dx = x - from_x, dy = y - from_y, most = reach + radius;
      return dx * dx + dy * dy < most * most;
    }
  };
  /// What level rays meet of most movers, in one cache line: the box that hides all other
  /// footprints from rays at these heights that come from outside of it. In the robot's frame [m].
  struct alignas(64) Silhouette {
    double x = 0, y = 0, c = 1, s = 0, hx = 0, hy = 0;
    float z_min = 1, z_max = 0;
    float radius = 0;  // of the circle around the robot that contains its mover
    int model = -1;

    Silhouette() = default;
    Silhouette(const std::vector<Footprint>& local, double radius);
    bool isAt(double z) const { return z_min <= z && z <= z_max; }
  };
  struct Mover {
    std::vector<Footprint> local;  // in the robot's frame
    Place place;
    double x = 0, y = 0;  // centre of the indexed circle
    mutable std::vector<Footprint> world;
    mutable double world_x = 0, world_y = 0, world_yaw = 0;  // pose at which `world` was computed
  };

  /// A handle in the list of a cell.
  struct Listed {
    int handle;
    std::int16_t x, y;
  };

  /// Returns whether ask(handle) is true for any mover indexed in a cell of `far`, or any entry in
  /// one of `near`; each is asked once. What is read of each comes from all over the memory: it is
  /// asked for together, and arrives together.
  template <typename Ask>
  bool anyHandle(const CellRange& near, const CellRange& far, Ask ask) const {
    boost::container::small_vector<Listed, 64> listed;
    list(near, far, &listed);
    for (const Listed& each : listed) {
      const int handle = each.handle;
      // Asked in the first of its cells within the range.
      const Corner own = handle >= 0 ? spots_[handle].corner : mover_corner_[~handle];
      const CellRange& r = handle >= 0 ? near : far;
      const bool is_first =
          each.x == std::max<int>(own.x0, r.x0) && each.y == std::max<int>(own.y0, r.y0);
      if (is_first && ask(handle)) return true;
    }
    return std::any_of(everywhere_.begin(), everywhere_.end(), ask);
  }

  /// Lists the movers in the cells of `far`, and the entries in those of `near`.
  template <typename Handles>
  void list(const CellRange& near, const CellRange& far, Handles* out) const {
    forEachCell(far, [&](int cx, int cy) { __builtin_prefetch(&cells_[cell(cx, cy)]); });
    forEachCell(far, [&](int cx, int cy) { __builtin_prefetch(cells_[cell(cx, cy)].data()); });
    forEachCell(far, [&](int cx, int cy) {
      const bool is_near = near.holds(cx, cy);
      for (const int handle : cells_[cell(cx, cy)]) {
        if (handle >= 0 && !is_near) break;  // all further ones are entries as well
        out->push_back({handle, static_cast<std::int16_t>(cx), static_cast<std::int16_t>(cy)});
        prefetchSpot(handle);
      }
    });
  }
  template <typename Visit>
  static void forEachCell(const CellRange& cells, Visit visit) {
    for (int cy = cells.y0; cy <= cells.y1; ++cy) {
      for (int cx = cells.x0; cx <= cells.x1; ++cx) visit(cx, cy);
    }
  }
  void prefetchSpot(int handle) const {
    if (handle >= 0) return __builtin_prefetch(&spots_[handle]);
    __builtin_prefetch(&mover_corner_[~handle]);
    __builtin_prefetch(&radius_[~handle]);
    __builtin_prefetch(&fleet_.x[~handle]);
    __builtin_prefetch(&fleet_.y[~handle]);
  }

  static Box boxOf(const Footprint& footprint);
  Box boxOfMover(int robot) const;
  CellRange range(double min_x, double max_x, double min_y, double max_y) const;
  CellRange range(const Box& b) const { return range(b.min_x, b.max_x, b.min_y, b.max_y); }
  bool isInside(const Box& box) const;
  int cell(int cx, int cy) const { return cy * columns_ + cx; }
  void link(int handle, Place& place, const Box& box);
  void setFootprint(int handle, const Footprint& footprint);
  void unlink(int handle, Place& place);
  void linkMover(int robot);
  void putMover(int robot);
  void prefetch(int handle) const;
  void cover(const Box& box);
  void castMover(int robot, double x, double y, double z, double dx, double dy, RayHit* hit) const;

  const Fleet& fleet_;
  std::vector<Entry> entries_;
  std::vector<Spot> spots_;  // by entry
  std::vector<Mover> movers_;
  std::vector<Corner> mover_corner_;
  std::vector<double> radius_;           // by mover [m]; most rays need no more
  std::vector<Silhouette> silhouettes_;  // by mover
  LooseGrid boxes_;                      // of entries and movers, for scans
  std::vector<int> free_;
  // Handles of each cell; ~robot for a mover. Movers come first, so that a query for distant movers
  // skips the rest. Few handles are stored inline: reading them is most of a ray's time.
  std::vector<boost::container::small_vector<int, 4>> cells_;
  std::vector<int> everywhere_;  // too large for cells
  double origin_x_ = 0, origin_y_ = 0;
  int columns_ = 0, rows_ = 0;
};

}  // namespace kiva
