// SPDX-License-Identifier: Apache-2.0
//
// The ceiling: the fleet's workload without any engine, in arrays. A planar integrator with two
// wheel servos, and lasers on a grid of boxes. Nothing can touch, lift or take commands. With
// --default the lasers have a default robot's rays: 121 over 120°.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "chunks.h"
#include "square.h"

namespace {

constexpr char kHelp[] = "array_bench [--no-lasers] [--default] [--seconds S] N…\n";
constexpr double kWheelAcceleration = 1e6;  // [rad/s²], beyond any need: speed changes at once

struct ArrayFleet {
  std::vector<double> x, y, yaw, c, s, left, right, left_wanted, right_wanted;

  explicit ArrayFleet(int robots) {
    const bench::Lattice lattice(robots);
    for (auto* array : {&x, &y, &yaw, &c, &s, &left, &right, &left_wanted, &right_wanted}) {
      array->assign(robots, 0);
    }
    for (int i = 0; i < robots; ++i) {
      x[i] = lattice.x(i);
      y[i] = lattice.y(i);
      c[i] = 1;
    }
  }

  int size() const { return static_cast<int>(x.size()); }

  void want(long step) {
    for (int i = 0; i < size(); ++i) {
      const bench::PlanarTwist w = bench::command(i, step);
      left_wanted[i] = w.speed - w.yaw_rate * bench::kTrack / 2;
      right_wanted[i] = w.speed + w.yaw_rate * bench::kTrack / 2;
    }
  }

  void integrate(double dt) {
    const double most = kWheelAcceleration * bench::kWheelRadius * dt;
    for (int i = 0; i < size(); ++i) {
      left[i] += std::clamp(left_wanted[i] - left[i], -most, most);
      right[i] += std::clamp(right_wanted[i] - right[i], -most, most);
      const double v = (left[i] + right[i]) / 2;
      x[i] += v * c[i] * dt;
      y[i] += v * s[i] * dt;
      const double turn = (right[i] - left[i]) / bench::kTrack * dt;
      yaw[i] += turn;
      // Sine and cosine of a step's turn, to the fourth order.
      const double sine = turn * (1 - turn * turn / 6), cosine = 1 - turn * turn / 2;
      const double c_next = c[i] * cosine - s[i] * sine;
      s[i] = s[i] * cosine + c[i] * sine;
      c[i] = c_next;
    }
  }

  double meanSpeed() const {
    double sum = 0;
    for (int i = 0; i < size(); ++i) sum += std::abs(left[i] + right[i]) / 2;
    return sum / size();
  }
};

/// Robots by the cell of their centre: as a cell is as wide as the lattice, each cell holds few.
class Grid {
 public:
  explicit Grid(int robots) : half_(bench::Lattice(robots).size() / 2) {
    columns_ = static_cast<int>(2 * half_ / kCell) + 3;
    cells_.resize(columns_ * columns_);
  }

  void fill(const ArrayFleet& fleet) {
    for (auto& cell : cells_) cell.clear();
    for (int i = 0; i < fleet.size(); ++i) {
      // Enters a robot into each cell that its body may reach, so that a ray reads its own cells
      // alone.
      for (int cx = column(fleet.x[i] - kReach); cx <= column(fleet.x[i] + kReach); ++cx) {
        for (int cy = column(fleet.y[i] - kReach); cy <= column(fleet.y[i] + kReach); ++cy) {
          cells_[cy * columns_ + cx].push_back(i);
        }
      }
    }
  }

  /// Returns the range to the first body but `self`, or to the walls, by traversing the cells
  /// (Amanatides, Woo 1987).
  double cast(const ArrayFleet& fleet, int self, double x, double y, double dx, double dy) const {
    double best = std::min({bench::kRange, toWall(x, dx), toWall(y, dy)});
    int cx = column(x), cy = column(y);
    const double per_x = kCell / std::abs(dx), per_y = kCell / std::abs(dy);
    double next_x = edge(x, cx, dx), next_y = edge(y, cy, dy);
    while (true) {
      for (int i : cells_[cy * columns_ + cx]) {
        if (i != self) best = std::min(best, toBox(fleet, i, x, y, dx, dy));
      }
      if (best <= std::min(next_x, next_y)) return best;
      if (next_x < next_y) {
        cx += dx > 0 ? 1 : -1;
        next_x += per_x;
      } else {
        cy += dy > 0 ? 1 : -1;
        next_y += per_y;
      }
    }
  }

 private:
  static constexpr double kCell = 1.5;   // [m]
  static constexpr double kReach = 0.5;  // distance of a body's corner from its centre [m]

  /// A cell beyond the wall, since a ray that ends on it may be a rounding away from it.
  double origin() const { return -half_ - kCell; }
  int column(double at) const {
    return std::clamp(static_cast<int>((at - origin()) / kCell), 0, columns_ - 1);
  }
  double toWall(double at, double d) const {
    return d == 0 ? bench::kRange : ((d > 0 ? half_ : -half_) - at) / d;
  }
  double edge(double at, int cell, double d) const {
    if (d == 0) return 1e9;
    return (origin() + (cell + (d > 0)) * kCell - at) / d;
  }

  static double toBox(const ArrayFleet& fleet, int i, double x, double y, double dx, double dy) {
    const double rx = x - fleet.x[i], ry = y - fleet.y[i], c = fleet.c[i], s = fleet.s[i];
    const double at[2] = {c * rx + s * ry, c * ry - s * rx};
    const double d[2] = {c * dx + s * dy, c * dy - s * dx};
    const double half[2] = {bench::kLength / 2, bench::kWidth / 2};
    double in = 0, out = bench::kRange;
    for (int axis = 0; axis < 2; ++axis) {
      const double a = (-half[axis] - at[axis]) / d[axis], b = (half[axis] - at[axis]) / d[axis];
      in = std::max(in, std::min(a, b));
      out = std::min(out, std::max(a, b));
    }
    return in <= out ? in : bench::kRange;
  }

  double half_;
  int columns_;
  std::vector<std::vector<int>> cells_;
};

/// Angles of a laser's rays against the robot's heading [rad].
std::vector<double> rayAngles(bool default_robot) {
  std::vector<double> angles;
  if (default_robot) {
    for (int k = 0; k < 121; ++k) angles.push_back((k - 60) * M_PI / 180);
  } else {
    for (int k = 0; k < bench::kRays; ++k) angles.push_back(bench::rayAngle(k));
  }
  return angles;
}

class Lasers {
 public:
  Lasers(int robots, const std::vector<double>& angles) : grid_(robots) {
    for (double angle : angles) {
      c_.push_back(std::cos(angle));
      s_.push_back(std::sin(angle));
    }
    ranges_.assign(robots, std::vector<float>(angles.size()));
  }

  void scan(const ArrayFleet& fleet, long step) {
    // A body moves 1 cm in ten steps, which the cells' overlap covers.
    if (step % 10 == 0) grid_.fill(fleet);
    const int first = static_cast<int>((bench::kStepsPerScan - step % bench::kStepsPerScan) %
                                       bench::kStepsPerScan);
    for (int i = first; i < fleet.size(); i += bench::kStepsPerScan) scanOne(fleet, i);
  }

 private:
  void scanOne(const ArrayFleet& fleet, int i) {
    const double c = fleet.c[i], s = fleet.s[i];
    const double x = fleet.x[i] + bench::kLaserAhead * c, y = fleet.y[i] + bench::kLaserAhead * s;
    for (std::size_t k = 0; k < c_.size(); ++k) {
      const double dx = c * c_[k] - s * s_[k], dy = s * c_[k] + c * s_[k];
      ranges_[i][k] = static_cast<float>(grid_.cast(fleet, i, x, y, dx, dy));
    }
  }

  Grid grid_;
  std::vector<std::vector<float>> ranges_;  // by robot
  std::vector<double> c_, s_;
};

void run(const bench::Options& options, bool default_robot, int robots) {
  ArrayFleet fleet(robots);
  Lasers lasers(robots, rayAngles(default_robot));
  long step = 0, samples = 0;
  double speed = 0;
  const auto factors = bench::measure(options.seconds, [&] {
    for (const long end = step + std::lround(options.seconds / bench::kStep); step < end; ++step) {
      fleet.want(step);
      fleet.integrate(bench::kStep);
      if (options.lasers) lasers.scan(fleet, step);
      if (step % 10 == 0) speed += fleet.meanSpeed(), ++samples;
    }
  });
  bench::print(default_robot ? "arrays, 121 rays" : "arrays", robots, options.lasers, factors,
               ", \"speed\": " + std::to_string(speed / static_cast<double>(samples)));
}

}  // namespace

int main(int argc, char** argv) {
  const bench::Options options = bench::parse(argc, argv, kHelp);
  const bool default_robot = options.others == std::vector<std::string>{"--default"};
  if (!default_robot && !options.others.empty()) bench::usage(kHelp);
  for (int robots : options.robots) run(options, default_robot, robots);
}
