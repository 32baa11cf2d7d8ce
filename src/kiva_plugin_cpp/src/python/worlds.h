// SPDX-License-Identifier: Apache-2.0
//
// Many worlds that are stepped at once. Each owns its memory, which moves when models come or go
// or a checkpoint is restored. So the thread that has just stepped a world copies its robots into
// the common arrays while they are in the cache (under a microsecond for ten robots), and Python
// reads those without another copy.
#pragma once

#include <pybind11/stl.h>

#include <cstdint>
#include <mutex>
#include <stdexcept>
#include <variant>
#include <vector>

#include "arrays.h"
#include "core/parallel/workers.h"
#include "fleet_rows.h"
#include "host.h"

namespace kiva::python {

using Checkpoints = std::variant<py::bytes, std::vector<py::bytes>>;

/// Many worlds with the same number of robots, stepped on many threads.
class Worlds {
 public:
  /// Throws ValueError for no world, and std::invalid_argument for worlds that differ in robots.
  Worlds(std::vector<HostPtr> hosts, unsigned threads);

  /// Locks the worlds for this thread; throws while another one uses them.
  std::unique_lock<std::mutex> use() const {
    std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (!lock) throw std::runtime_error("the worlds are in use by another thread");
    return lock;
  }

  std::size_t size() const { return hosts_.size(); }
  unsigned threads() const { return workers_.threads(); }

  /// Returns the number of steps that each world made: all, or, if `until_idle`, those until it was
  /// idle.
  py::array_t<std::int64_t> step(std::int64_t steps, bool until_idle);
  /// Posts commands, each to the world of that index; all or none.
  void post(const ArrayLike& which, const py::array& commands);
  /// Restores worlds from one checkpoint or one each.
  void restore(const ArrayLike& which, const Checkpoints& checkpoints);
  /// Puts robots at places in world [m, rad], at rest.
  void place(const ArrayLike& which, const ArrayLike& kiva_id, const ArrayLike& x,
             const ArrayLike& y, const ArrayLike& yaw);
  /// Returns which robots take the speeds, (n, robots): those without a command.
  py::array_t<bool> drive(
      const py::array_t<double, py::array::c_style | py::array::forcecast>& left,
      const py::array_t<double, py::array::c_style | py::array::forcecast>& right);
  /// Returns laser ranges [m], (n, robots, rays).
  py::array_t<float> scans();
  /// Returns the storage units of each world, (n, units).
  py::array_t<UnitRow> storageUnits() const;
  /// Returns the state hash of each world, (n,).
  py::array_t<std::uint64_t> stateHash();
  /// Returns (world, time, kind, model, other, text, command) of each event of the last step().
  py::list events() const;

  template <typename Out, typename T>
  py::array_t<Out> column(Column<T> FleetRows::*field) const {
    return view<Out>(rows_.*field, shape());
  }
  py::array_t<std::uint32_t> counts() const {
    return view<std::uint32_t>(rows_.counts, shape(static_cast<py::ssize_t>(Event::kKinds)));
  }

 private:
  std::vector<py::ssize_t> shape(py::ssize_t last = -1) const {
    std::vector<py::ssize_t> out{static_cast<py::ssize_t>(size()), robots_};
    if (last >= 0) out.push_back(last);
    return out;
  }

  Host& host(int world) const;

  /// Steps a world and returns whether all of its robots are idle.
  bool advance(std::size_t i, std::int64_t steps, bool until_idle, std::int64_t* made);

  void copyRobots(std::size_t i);
  void copyRobots(std::size_t i, int begin, int end);
  void takeEvents(std::size_t i, std::vector<Event>* kept);
  void scanInto(std::size_t i, float* out, std::size_t rays);

  /// Calls job(i) for each i below `count`, in any order, on all threads.
  template <typename Job>
  void forEach(std::size_t count, const Job& job) {
    workers_.share(static_cast<int>(count), 1, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) job(static_cast<std::size_t>(i));
    });
  }

  mutable std::mutex mutex_;
  std::vector<HostPtr> hosts_;
  Workers workers_;
  int robots_;
  FleetRows rows_;
  std::vector<std::vector<Event>> events_;  ///< events of the last step()
  Column<float> ranges_;                    ///< result of the last scans()
};

}  // namespace kiva::python
