// SPDX-License-Identifier: Apache-2.0
//
// Robots of many worlds as those who learn see them: on the cells of a grid, arrays in and arrays
// out. What numpy would do in a hundred passes is done in one here; what is meant by it is
// warehouse_learning's (grid.py, fields.py).
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "arrays.h"
#include "host.h"

namespace kiva::python {
namespace {

constexpr double kQuarterTurn = 1.5707963267948966;  // [rad]

/// A row of numbers for each robot or unit of each world. Nothing is converted: another type or
/// shape is a ValueError that names the argument.
template <typename T>
class Rows {
 public:
  Rows(const char* name, const py::object& given, std::vector<py::ssize_t> shape)
      : array_(check(name, given, shape)) {}
  const T* operator[](py::ssize_t world) const { return array_.data(world); }
  T* mutableRow(py::ssize_t world) { return array_.mutable_data(world); }

 private:
  using Array = py::array_t<T, py::array::c_style>;

  static Array check(const char* name, const py::object& given,
                     const std::vector<py::ssize_t>& shape) {
    bool fits = py::isinstance<Array>(given);
    if (fits) {
      const auto array = py::reinterpret_borrow<py::array>(given);
      fits = array.ndim() == static_cast<py::ssize_t>(shape.size());
      for (std::size_t i = 0; fits && i < shape.size(); ++i) fits = array.shape(i) == shape[i];
    }
    if (!fits) {
      std::string wanted;
      for (const py::ssize_t edge : shape) {
        wanted += (wanted.empty() ? "" : ", ") + std::to_string(edge);
      }
      throw py::value_error(std::string(name) + ": expected an array of " +
                            text(py::dtype::of<T>()) + ", contiguous, of shape (" + wanted + ")");
    }
    return py::reinterpret_borrow<Array>(given);
  }

  Array array_;
};

/// Throws IndexError unless low <= value < high.
int within(const char* name, int value, int low, py::ssize_t high) {
  if (value >= low && value < high) return value;
  throw py::index_error(std::string(name) + " has " + std::to_string(value) + "; " +
                        std::to_string(low) + " to " + std::to_string(high - 1) + " was expected");
}

/// What a cell looks like, by bits of its layers.
enum Layer : std::uint8_t { kUnit = 8, kRequested = 16, kRobot = 32, kLoaded = 64 };
constexpr int kLayers = 7;

/// The same numbers for every world.
struct Floor {
  int width = 0, height = 0;  // cells
  int rim = 0, radius = 0;
  double longest = 1;              // edge of the floor without its rim [cells]
  double x = 0, y = 0;             // of the centre of cell 0 [m]
  double spacing = 1;              // [m]
  std::vector<std::uint8_t> look;  // of each cell, without what moves

  int cells() const { return width * height; }
  int step(int heading) const {
    const int steps[] = {1, width, -1, -width};
    return steps[heading & 3];
  }
};

class Cells {
 public:
  Cells(int width, int height, int rim, int radius, std::array<double, 2> origin, double spacing,
        const py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast>& look) {
    if (rim < radius || radius < 0 || width <= 2 * rim || height <= 2 * rim ||
        look.size() != static_cast<py::ssize_t>(width) * height) {
      throw py::value_error("cells: a floor of width x height with a rim of radius or more");
    }
    floor_.width = width;
    floor_.height = height;
    floor_.rim = rim;
    floor_.radius = radius;
    floor_.longest = std::max(width, height) - 2 * rim;
    floor_.x = origin[0];
    floor_.y = origin[1];
    floor_.spacing = spacing;
    floor_.look.assign(look.data(), look.data() + look.size());
    for (int bits = 0; bits < 256; ++bits) {
      for (int layer = 0; layer < kLayers; ++layer) {
        layers_[bits][layer] = static_cast<float>((bits >> layer) & 1);
      }
    }
    for (int heading = 0; heading < 4; ++heading) {
      for (int ahead = -radius; ahead <= radius; ++ahead) {
        for (int left = -radius; left <= radius; ++left) {
          around_[heading].push_back(ahead * floor_.step(heading) +
                                     left * floor_.step(heading + 1));
        }
      }
    }
  }

  /// (cell, heading), each like x.
  py::tuple locate(
      const py::array_t<double, py::array::c_style | py::array::forcecast>& x,
      const py::array_t<double, py::array::c_style | py::array::forcecast>& y,
      const py::array_t<double, py::array::c_style | py::array::forcecast>& yaw) const {
    if (y.size() != x.size() || yaw.size() != x.size()) {
      throw py::value_error("x, y and yaw: expected arrays of one shape");
    }
    const std::vector<py::ssize_t> shape(x.shape(), x.shape() + x.ndim());
    py::array_t<std::int32_t> cell(shape);
    py::array_t<std::int8_t> heading(shape);
    for (py::ssize_t i = 0; i < x.size(); ++i) {
      cell.mutable_data()[i] = count(y.data()[i] - floor_.y, floor_.height) * floor_.width +
                               count(x.data()[i] - floor_.x, floor_.width);
      const auto turns = static_cast<std::int64_t>(std::nearbyint(yaw.data()[i] / kQuarterTurn));
      heading.mutable_data()[i] = static_cast<std::int8_t>(turns & 3);
    }
    return py::make_tuple(cell, heading);
  }

  /// Fills what a robot observes but its motion and its laser: the first numbers of its row.
  void observe(const py::object& out, const py::object& cell, const py::object& heading,
               const py::object& busy, const py::object& load, const py::object& requested,
               const py::object& unit_cell, const py::object& goal_cell, const py::object& goal_row,
               const py::array_t<std::int16_t, py::array::c_style>& far) const {
    const auto whole = py::cast<py::array>(out);
    if (whole.ndim() != 3 || py::cast<py::array>(requested).ndim() != 2) {
      throw py::value_error("observe: expected out (n, robots, size) and requested (n, units)");
    }
    const py::ssize_t n = whole.shape(0), robots = whole.shape(1), size = whole.shape(2);
    const py::ssize_t units = py::cast<py::array>(requested).shape(1);
    if (size < kOwn + static_cast<py::ssize_t>(around_[0].size()) * kLayers || far.ndim() != 2 ||
        far.shape(1) != floor_.cells()) {
      throw py::value_error("observe: out or far is too small");
    }
    Rows<float> rows("out", out, {n, robots, size});
    const Rows<std::int32_t> cells("cell", cell, {n, robots});
    const Rows<std::int8_t> headings("heading", heading, {n, robots});
    const Rows<bool> busies("busy", busy, {n, robots});
    const Rows<std::int32_t> loads("load", load, {n, robots});
    const Rows<bool> asked("requested", requested, {n, units});
    const Rows<std::int32_t> places("unit_cell", unit_cell, {n, units});
    const Rows<std::int32_t> goals("goal_cell", goal_cell, {n, robots});
    const Rows<std::int32_t> ways("goal_row", goal_row, {n, robots});
    std::vector<std::uint8_t> look(floor_.look.size());
    for (py::ssize_t w = 0; w < n; ++w) {
      look = floor_.look;
      for (py::ssize_t u = 0; u < units; ++u) {
        const int place = within("unit_cell", places[w][u], -1, floor_.cells());
        if (place >= 0) look[place] |= asked[w][u] ? kUnit | kRequested : kUnit;
      }
      for (py::ssize_t i = 0; i < robots; ++i) {
        const int place = within("cell", cells[w][i], 0, floor_.cells());
        look[place] |= loads[w][i] < 0 ? kRobot : kRobot | kLoaded;
      }
      float* row = rows.mutableRow(w);
      for (py::ssize_t i = 0; i < robots; ++i, row += size) {
        const int unit = within("load", loads[w][i], -1, units);
        const int kind = unit < 0 ? 0 : asked[w][unit] ? 1 : 2;
        own(row, cells[w][i], headings[w][i], kind, busies[w][i]);
        const int way = within("goal_row", ways[w][i], 0, far.shape(0));
        goal(row, cells[w][i], headings[w][i], goals[w][i], way == 0, far.data(way));
        around(row + kOwn, cells[w][i], headings[w][i], look);
      }
    }
  }

 private:
  static constexpr py::ssize_t kOwn = 17;  // numbers before the neighbourhood
  static constexpr std::int16_t kFar = std::numeric_limits<std::int16_t>::max();

  /// Which cell of a row or column is nearest to `way` [m] from the first.
  std::int32_t count(double way, int cells) const {
    const double nearest = std::nearbyint(way / floor_.spacing);
    return nearest > 0 ? static_cast<std::int32_t>(std::min(nearest, cells - 1.0)) : 0;
  }

  static float share(int at, int cells) {
    return static_cast<float>(std::clamp(double(at) / std::max(cells - 1, 1), 0.0, 1.0));
  }

  /// position 2, heading 4, load 3, busy 1
  void own(float* row, int cell, int heading, int load, bool busy) const {
    row[0] = share(cell % floor_.width - floor_.rim, floor_.width - 2 * floor_.rim);
    row[1] = share(cell / floor_.width - floor_.rim, floor_.height - 2 * floor_.rim);
    for (int k = 0; k < 4; ++k) row[2 + k] = k == heading ? 1 : 0;
    for (int k = 0; k < 3; ++k) row[6 + k] = k == load ? 1 : 0;
    row[9] = busy ? 1 : 0;
  }

  /// goal 2, distance 1, way 4; `far`: how far each cell is from the goal, none if it has none.
  void goal(float* row, int cell, int heading, int goal, bool has_none,
            const std::int16_t* far) const {
    constexpr int kCos[] = {1, 0, -1, 0}, kSin[] = {0, 1, 0, -1};
    const double dx = (goal % floor_.width - cell % floor_.width) / floor_.longest;
    const double dy = (goal / floor_.width - cell / floor_.width) / floor_.longest;
    const int c = kCos[heading & 3], s = kSin[heading & 3];
    row[10] = static_cast<float>(std::clamp(c * dx + s * dy, -1.0, 1.0));
    row[11] = static_cast<float>(std::clamp(c * dy - s * dx, -1.0, 1.0));
    const int here = far[cell] == kFar ? 0 : far[cell];
    row[12] = static_cast<float>(std::min(here / (2 * floor_.longest), 1.0));
    for (int k = 0; k < 4; ++k) {
      const int next = far[inside(cell + floor_.step(heading + k))];
      const int nearer = next == kFar ? -1 : std::clamp(here - next, -1, 1);
      row[13 + k] = has_none ? 0 : static_cast<float>(nearer);
    }
  }

  void around(float* out, int cell, int heading, const std::vector<std::uint8_t>& look) const {
    for (const int offset : around_[heading & 3]) {
      out = std::copy_n(layers_[look[inside(cell + offset)]].data(), kLayers, out);
    }
  }

  /// Of a robot in the rim, beside the floor, some of what is around lies outside.
  int inside(int cell) const { return std::clamp(cell, 0, floor_.cells() - 1); }

  Floor floor_;
  std::array<std::array<float, kLayers>, 256> layers_;
  std::array<std::vector<int>, 4> around_;  // by heading: what to add to the robot's cell
};

}  // namespace

void defineCells(py::module_& m) {
  py::class_<Cells>(m, "Cells")
      .def(py::init<int, int, int, int, std::array<double, 2>, double,
                    const py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast>&>(),
           py::arg("width"), py::arg("height"), py::arg("rim"), py::arg("radius"),
           py::arg("origin"), py::arg("spacing"), py::arg("look"),
           R"(A floor of width x height cells, numbered row by row, with a rim that is none of it.

origin: (x, y) of the centre of cell 0 in world [m]. look: bits of each cell, of the layers that
stand still. radius: of the neighbourhood [cells]. ValueError if the rim is narrower than that.)")
      .def("locate", &Cells::locate, py::arg("x"), py::arg("y"), py::arg("yaw"),
           "(cell, heading) that are nearest to places in world [m, rad], int32 and int8 arrays of "
           "their shape; heading counts quarter turns.")
      .def("observe", &Cells::observe, py::arg("out"), py::arg("cell"), py::arg("heading"),
           py::arg("busy"), py::arg("load"), py::arg("requested"), py::arg("unit_cell"),
           py::arg("goal_cell"), py::arg("goal_row"), py::arg("far"),
           R"(Fills the first 17 + (2 radius + 1)^2 * 7 numbers of each robot's row in `out`.

out: (n, robots, size) float32. cell, load, goal_cell, goal_row: (n, robots) int32; load is the
index of a unit or -1, goal_row one of far's, 0 = no goal. heading: int8. busy: bool. requested:
(n, units) bool. unit_cell: (n, units) int32, -1 = carried. far: (rows, cells) int16. ValueError for
another shape or type, IndexError for what points beyond.)");
}

}  // namespace kiva::python
