// SPDX-License-Identifier: Apache-2.0
//
// Many worlds that are stepped at once. Each owns its memory, which moves when models come or go
// or a checkpoint is restored. So the thread that has just stepped a world copies its robots into
// the common arrays while they are in the cache (under a microsecond for ten robots), and Python
// reads those without another copy.
#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <mutex>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "arrays.h"
#include "core/motion/wheels.h"
#include "core/parallel/workers.h"
#include "host.h"
#include "kiva_plugin_cpp/command.h"

namespace kiva::python {
namespace {

constexpr std::size_t kKinds = Event::kKinds;

using Checkpoints = std::variant<py::bytes, std::vector<py::bytes>>;

/// The robots of all worlds; rows are worlds.
struct FleetRows {
  Column<double> x, y, yaw, vx, vy, yaw_rate, left_wheel_speed, right_wheel_speed, tower;
  Column<std::uint8_t> status, state, last_end;
  Column<std::int32_t> shelf_id;
  Column<std::uint32_t> counts;  // of events: kKinds a robot

  explicit FleetRows(std::size_t size) {
    for (Column<double>* c :
         {&x, &y, &yaw, &vx, &vy, &yaw_rate, &left_wheel_speed, &right_wheel_speed, &tower}) {
      c->resize(size);
    }
    for (Column<std::uint8_t>* c : {&status, &state, &last_end}) c->resize(size);
    shelf_id.resize(size);
    counts.resize(size * kKinds);
  }

  void take(const World& world, std::size_t at) {
    const Fleet& f = world.fleet();
    const auto copy = [&](const auto& from, auto& to) {
      std::transform(from.begin(), from.end(), to.begin() + static_cast<std::ptrdiff_t>(at),
                     [](auto value) {
                       return static_cast<typename std::decay_t<decltype(to)>::value_type>(value);
                     });
    };
    copy(f.x, x);
    copy(f.y, y);
    copy(f.yaw, yaw);
    copy(f.vx, vx);
    copy(f.vy, vy);
    copy(f.yaw_rate, yaw_rate);
    copy(f.wheel_speed[0], left_wheel_speed);
    copy(f.wheel_speed[1], right_wheel_speed);
    copy(f.tower, tower);
    copy(f.status, status);
    copy(f.state, state);
    copy(f.last_end, last_end);
    std::transform(f.unit.begin(), f.unit.end(), shelf_id.begin() + static_cast<std::ptrdiff_t>(at),
                   [&](int unit) { return unit < 0 ? 0 : world.storageUnits()[unit].id; });
  }
};

bool isIdle(const Fleet& fleet) {
  return std::all_of(fleet.status.begin(), fleet.status.end(),
                     [](Status status) { return status == Status::kIdle; });
}

/// Returns the number in `kiva12`, 0 for a name that is not a robot's.
int kivaId(const std::string& model) {
  if (model.compare(0, 4, "kiva") != 0 || model.size() == 4 || model.size() > 11) return 0;
  int id = 0;
  for (std::size_t i = 4; i < model.size(); ++i) {
    if (model[i] < '0' || model[i] > '9') return 0;
    id = 10 * id + (model[i] - '0');
  }
  return id;
}

class Worlds {
 public:
  Worlds(std::vector<HostPtr> hosts, unsigned threads)
      : hosts_(std::move(hosts)),
        workers_(threads),
        robots_(hosts_.empty() ? 0 : hosts_[0]->world.fleet().size()),
        rows_(hosts_.size() * static_cast<std::size_t>(robots_)),
        events_(hosts_.size()) {
    if (hosts_.empty()) throw py::value_error("worlds: at least one was expected");
    for (std::size_t i = 0; i < hosts_.size(); ++i) {
      const auto lock = hosts_[i]->use();
      copyRobots(i);
    }
  }

  std::unique_lock<std::mutex> use() const {
    std::unique_lock<std::mutex> lock(mutex_, std::try_to_lock);
    if (!lock) throw std::runtime_error("the worlds are in use by another thread");
    return lock;
  }

  std::size_t size() const { return hosts_.size(); }
  unsigned threads() const { return workers_.threads(); }

  /// How many steps each world made: all, or, if `until_idle`, as many as it took.
  py::array_t<std::int64_t> step(std::int64_t steps, bool until_idle) {
    if (steps < 0) throw py::value_error("steps is " + std::to_string(steps) + "; 0 or more");
    const auto own = use();
    std::vector<std::int64_t> made(size(), 0);
    std::vector<char> ready(size(), 0);
    std::fill(rows_.counts.begin(), rows_.counts.end(), 0);
    for (auto& events : events_) events.clear();
    for (std::int64_t done = 0; done < steps; done += kStepsBetweenSignals) {
      const std::int64_t now = std::min(steps - done, kStepsBetweenSignals);
      {
        py::gil_scoped_release release;
        forEach(size(), [&](std::size_t i) {
          if (!ready[i]) ready[i] = advance(i, now, until_idle, &made[i]);
        });
      }
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();  // Ctrl-C
      if (std::all_of(ready.begin(), ready.end(), [](char is) { return is != 0; })) break;
    }
    return py::array_t<std::int64_t>(static_cast<py::ssize_t>(size()), made.data());
  }

  void post(const ArrayLike& which, const py::array& commands) {
    const auto own = use();
    const Numbers<std::int32_t> worlds("world", which);
    const auto rows = commandRows(commands);
    if (!worlds.isOne() && worlds.size() != rows.size()) {
      throw py::value_error("world has " + std::to_string(worlds.size()) +
                            " entries and commands has " + std::to_string(rows.size()));
    }
    for (py::ssize_t i = 0; i < rows.size(); ++i) {
      checkCommand(host(worlds[i]), rows.data()[i], static_cast<std::size_t>(i));
    }
    for (py::ssize_t i = 0; i < rows.size(); ++i) {
      const auto lock = host(worlds[i]).use();
      host(worlds[i]).world.post(rows.data()[i]);
    }
  }

  void restore(const ArrayLike& which, const Checkpoints& checkpoints) {
    const auto own = use();
    const Numbers<std::int32_t> worlds("world", which);
    const auto count = static_cast<std::size_t>(worlds.size());
    std::vector<std::string> bytes;
    if (const auto* one = std::get_if<py::bytes>(&checkpoints)) {
      bytes.assign(1, *one);
    } else {
      for (const py::bytes& each : std::get<1>(checkpoints)) bytes.push_back(each);
    }
    if (bytes.size() != 1 && bytes.size() != count) {
      throw py::value_error("world has " + std::to_string(count) + " entries and checkpoint has " +
                            std::to_string(bytes.size()));
    }
    for (std::size_t i = 0; i < count; ++i) host(worlds[static_cast<py::ssize_t>(i)]);
    std::vector<int> at(count);
    for (std::size_t i = 0; i < count; ++i) at[i] = worlds[static_cast<py::ssize_t>(i)];
    py::gil_scoped_release release;
    forEach(count, [&](std::size_t i) {
      Host& restored = *hosts_[at[i]];
      const auto lock = restored.use();
      restored.world.restore(bytes[bytes.size() == 1 ? 0 : i]);
      takeEvents(at[i], nullptr);
      copyRobots(at[i]);
    });
  }

  void place(const ArrayLike& which, const ArrayLike& kiva_id, const ArrayLike& x,
             const ArrayLike& y, const ArrayLike& yaw) {
    const auto own = use();
    const Numbers<std::int32_t> worlds("world", which), ids("kiva_id", kiva_id);
    const Numbers<double> xs("x", x), ys("y", y), yaws("yaw", yaw);
    for (const py::ssize_t size : {ids.size(), xs.size(), ys.size(), yaws.size()}) {
      if (size == worlds.size()) continue;
      throw py::value_error("world, kiva_id, x, y and yaw: expected arrays of one length");
    }
    for (py::ssize_t i = 0; i < worlds.size(); ++i) {
      Host& at = host(worlds[i]);
      const auto lock = at.use();
      const int robot = at.world.fleet().find(ids[i]);
      if (robot < 0) {
        throw py::value_error("kiva_id: there is no robot kiva" + std::to_string(ids[i]) +
                              " in world " + std::to_string(worlds[i]));
      }
      at.world.setState(at.world.fleet().robots[robot].name,
                        {Pose(xs[i], ys[i], 0, 0, 0, yaws[i]), {}});
      copyRobots(static_cast<std::size_t>(worlds[i]));
    }
  }

  /// Returns which robots take the speeds, (n, robots): those without a command.
  py::array_t<bool> drive(
      const py::array_t<double, py::array::c_style | py::array::forcecast>& left,
      const py::array_t<double, py::array::c_style | py::array::forcecast>& right) {
    const auto own = use();
    const std::size_t all = size() * static_cast<std::size_t>(robots_);
    for (const auto* speeds : {&left, &right}) {
      const bool fits = speeds->ndim() == 2 &&
                        static_cast<std::size_t>(speeds->shape(0)) == size() &&
                        speeds->shape(1) == robots_;
      if (!fits) {
        throw py::value_error("wheel speeds: expected shape (" + std::to_string(size()) + ", " +
                              std::to_string(robots_) + "), not " + text(speeds->attr("shape")));
      }
      for (std::size_t k = 0; k < all; ++k) {
        if (std::isfinite(speeds->data()[k])) continue;
        throw py::value_error("wheel speed of robot " + std::to_string(k % robots_) + " in world " +
                              std::to_string(k / robots_) + " is no finite number");
      }
    }
    py::array_t<bool> out({static_cast<py::ssize_t>(size()), static_cast<py::ssize_t>(robots_)});
    for (std::size_t k = 0; k < all; ++k) {
      Host& at = *hosts_[k / robots_];
      const auto lock = at.use();
      out.mutable_data()[k] =
          setWheelSpeeds(at.world, static_cast<int>(k % robots_), left.data()[k], right.data()[k]);
    }
    return out;
  }

  py::array_t<float> scans() {
    const auto own = use();
    std::size_t rays = 0;
    for (const HostPtr& host : hosts_) {
      for (const Robot& robot : host->world.fleet().robots) {
        if (robot.laser.fitted) rays = std::max(rays, static_cast<std::size_t>(robot.laser.rays));
      }
    }
    const std::size_t row = static_cast<std::size_t>(robots_) * rays;
    if (ranges_.size() != size() * row) ranges_ = Column<float>(size() * row);
    {
      py::gil_scoped_release release;
      forEach(size(), [&](std::size_t i) { scanInto(i, ranges_.data() + i * row, rays); });
    }
    return view<float>(ranges_, shape(static_cast<py::ssize_t>(rays)));
  }

  py::array_t<UnitRow> storageUnits() const {
    const auto own = use();
    const std::size_t units = hosts_[0]->world.storageUnits().size();
    py::array_t<UnitRow> out({size(), units});
    for (std::size_t i = 0; i < size(); ++i) {
      const auto lock = hosts_[i]->use();
      if (hosts_[i]->world.storageUnits().size() != units) {
        throw py::value_error("world " + std::to_string(i) +
                              " has another number of storage units "
                              "than world 0");
      }
      for (std::size_t u = 0; u < units; ++u) {
        out.mutable_data()[i * units + u] = unitRow(hosts_[i]->world, static_cast<int>(u));
      }
    }
    return out;
  }

  py::array_t<std::uint64_t> stateHash() {
    const auto own = use();
    py::array_t<std::uint64_t> out(static_cast<py::ssize_t>(size()));
    std::uint64_t* const hashes = out.mutable_data();
    py::gil_scoped_release release;
    forEach(size(), [&](std::size_t i) {
      const auto lock = hosts_[i]->use();
      hashes[i] = hosts_[i]->world.stateHash();
    });
    return out;
  }

  /// Returns (world, time, kind, model, other, text, command) of each event of the last step().
  py::list events() const {
    const auto own = use();
    py::list out;
    for (std::size_t i = 0; i < size(); ++i) {
      for (const Event& e : events_[i]) {
        out.append(py::make_tuple(i, e.time, static_cast<int>(e.kind), e.model, e.other, e.text,
                                  e.command));
      }
    }
    return out;
  }

  template <typename Out, typename T>
  py::array_t<Out> column(Column<T> FleetRows::*field) const {
    return view<Out>(rows_.*field, shape());
  }
  py::array_t<std::uint32_t> counts() const {
    return view<std::uint32_t>(rows_.counts, shape(static_cast<py::ssize_t>(kKinds)));
  }

 private:
  std::vector<py::ssize_t> shape(py::ssize_t last = -1) const {
    std::vector<py::ssize_t> out{static_cast<py::ssize_t>(size()), robots_};
    if (last >= 0) out.push_back(last);
    return out;
  }

  Host& host(int world) const {
    if (world < 0 || static_cast<std::size_t>(world) >= size()) {
      throw py::index_error("world is " + std::to_string(world) + "; there are " +
                            std::to_string(size()));
    }
    return *hosts_[world];
  }

  /// Steps a world and returns whether all of its robots are idle.
  bool advance(std::size_t i, std::int64_t steps, bool until_idle, std::int64_t* made) {
    const auto lock = hosts_[i]->use();
    World& world = hosts_[i]->world;
    bool idle = false;
    for (std::int64_t k = 0; k < steps && !idle; ++k, ++*made) {
      world.step();
      idle = until_idle && isIdle(world.fleet());
    }
    takeEvents(i, &events_[i]);
    copyRobots(i);
    return idle;
  }

  void copyRobots(std::size_t i) {
    if (hosts_[i]->world.fleet().size() != robots_) {
      throw std::invalid_argument(
          "world " + std::to_string(i) + " has " + std::to_string(hosts_[i]->world.fleet().size()) +
          " robots and world 0 had " + std::to_string(robots_) + "; the same number was expected");
    }
    rows_.take(hosts_[i]->world, i * static_cast<std::size_t>(robots_));
  }

  void takeEvents(std::size_t i, std::vector<Event>* kept) {
    World& world = hosts_[i]->world;
    std::vector<Event> events = world.takeEvents();
    world.takeStatusChanges();
    if (!kept) return;
    for (Event& event : events) {
      const auto kind = static_cast<std::size_t>(event.kind);
      for (const std::string* model : {&event.model, &event.other}) {
        const int robot = world.fleet().find(kivaId(*model));
        const bool counts = model == &event.model || event.kind == Event::Kind::kCollision;
        if (robot >= 0 && counts && kind < kKinds) {
          ++rows_.counts[(i * static_cast<std::size_t>(robots_) + robot) * kKinds + kind];
        }
      }
      kept->push_back(std::move(event));
    }
  }

  /// Calls job(i) for each i below `count`, in any order, on all threads.
  template <typename Job>
  void forEach(std::size_t count, const Job& job) {
    workers_.share(static_cast<int>(count), 1, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) job(static_cast<std::size_t>(i));
    });
  }

  void scanInto(std::size_t i, float* out, std::size_t rays) {
    const auto lock = hosts_[i]->use();
    const World& world = hosts_[i]->world;
    std::vector<float> ranges;
    for (int robot = 0; robot < robots_; ++robot, out += rays) {
      ranges.clear();
      if (world.fleet().robots[robot].laser.fitted) world.scan(robot, &ranges);
      std::fill(std::copy(ranges.begin(), ranges.end(), out), out + rays,
                std::numeric_limits<float>::quiet_NaN());
    }
  }

  mutable std::mutex mutex_;
  std::vector<HostPtr> hosts_;
  Workers workers_;
  int robots_;
  FleetRows rows_;
  std::vector<std::vector<Event>> events_;  // of the last step()
  Column<float> ranges_;                    // of the last scans()
};

}  // namespace

void defineWorlds(py::module_& m) {
  py::class_<Worlds> worlds(m, "Worlds");
  worlds.def(py::init<std::vector<HostPtr>, unsigned>(), py::arg("worlds"), py::arg("threads"));
  worlds.def("__len__", &Worlds::size);
  worlds.def("step", &Worlds::step, py::arg("steps") = 1, py::arg("until_idle") = false,
             R"(Advances all worlds by so many steps, on all threads, without the GIL.

until_idle: a world stops as soon as none of its robots has a command, after one step at least.
Returns how many steps each made, (n,) int64. ValueError for a negative number, RuntimeError for a
world that another thread uses; Ctrl-C ends it between steps.)");
  worlds.def("post", &Worlds::post, py::arg("world"), py::arg("commands"),
             R"(Posts commands, (k,) of dtype COMMAND, each to the world of that index, (k,) or one.

Errors as of World.post(), all or none; IndexError for an index without a world.)");
  worlds.def("restore", &Worlds::restore, py::arg("world"), py::arg("checkpoint"),
             R"(Restores the worlds of those indices, (k,) or one, from one checkpoint or k of them.

CheckpointError, with that world unchanged, if the bytes are damaged.)");
  worlds.def("place", &Worlds::place, py::arg("world"), py::arg("kiva_id"), py::arg("x"),
             py::arg("y"), py::arg("yaw"),
             R"(Puts robots at those places, at rest: arrays (k,), in world [m, rad].

ValueError for an unknown robot or arrays of different lengths.)");
  worlds.def("drive", &Worlds::drive, py::arg("left"), py::arg("right"),
             R"(Sets the wheel speeds of robots without a command, (n, robots) [rad/s].

The motors keep a speed until the next call or command, with all their torque and no faster than the
robot's top speed; no laser stops them. Returns (n, robots) bool: which robots took their speeds;
robots with a command don't. ValueError for another shape, NaN or infinity.)");
  worlds.def(
      "scans", &Worlds::scans,
      R"(Returns laser ranges of now: (n, robots, rays) float32 [m], rows as of World.scans().

A read-only view, current until the next call.)");
  worlds.def(
      "events", &Worlds::events,
      "Returns the events of the last step(): a list of (world, time, kind, model, other, text, "
      "command), worlds in order.");
  worlds.def("state_hash", &Worlds::stateHash,
             "Returns World.state_hash() of each world: (n,) uint64.");
  worlds.def_property_readonly("storage_units", &Worlds::storageUnits,
                               "World.storage_units of each world: (n, units). A copy.");
  worlds.def_property_readonly("threads", &Worlds::threads,
                               "How many threads step the worlds, the caller's among them.");
  const auto add = [&worlds](const char* name, auto field, auto zero, const char* doc) {
    const auto get = [field](const Worlds& w) { return w.column<decltype(zero)>(field); };
    worlds.def_property_readonly(name, get, doc);
  };
  add("x", &FleetRows::x, 0.0, "(n, robots) float64 in world [m]. A view.");
  add("y", &FleetRows::y, 0.0, "(n, robots) float64 in world [m]. A view.");
  add("yaw", &FleetRows::yaw, 0.0, "(n, robots) float64 [rad], unwrapped. A view.");
  add("vx", &FleetRows::vx, 0.0, "(n, robots) float64, in world [m/s]. A view.");
  add("vy", &FleetRows::vy, 0.0, "(n, robots) float64, in world [m/s]. A view.");
  add("yaw_rate", &FleetRows::yaw_rate, 0.0, "(n, robots) float64 [rad/s]. A view.");
  add("left_wheel_speed", &FleetRows::left_wheel_speed, 0.0,
      "(n, robots) float64 [rad/s]. A view.");
  add("right_wheel_speed", &FleetRows::right_wheel_speed, 0.0,
      "(n, robots) float64 [rad/s]. A view.");
  add("tower", &FleetRows::tower, 0.0, "(n, robots) float64: height above its rest [m]. A view.");
  add("status", &FleetRows::status, std::uint8_t(), "(n, robots) uint8 of Status. A view.");
  add("state", &FleetRows::state, std::uint8_t(), "(n, robots) uint8 of State. A view.");
  add("last_end", &FleetRows::last_end, std::uint8_t(),
      "(n, robots) uint8, as Fleet.last_end. A view.");
  add("shelf_id", &FleetRows::shelf_id, std::int32_t(),
      "(n, robots) int32: the storage unit that each carries, 0 = none. A view.");
  worlds.def_property_readonly(
      "counts", &Worlds::counts,
      "(n, robots, kinds) uint32: events of each EventKind, by its value, about each robot in the "
      "last step(). A view.");
}

}  // namespace kiva::python
