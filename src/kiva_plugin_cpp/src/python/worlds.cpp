// SPDX-License-Identifier: Apache-2.0
#include "worlds.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/motion/wheels/wheels.h"
#include "kiva_plugin_cpp/command.h"

namespace kiva::python {
namespace {

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

}  // namespace

Worlds::Worlds(std::vector<HostPtr> hosts, unsigned threads)
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

py::array_t<std::int64_t> Worlds::step(std::int64_t steps, bool until_idle) {
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

void Worlds::post(const ArrayLike& which, const py::array& commands) {
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

void Worlds::restore(const ArrayLike& which, const Checkpoints& checkpoints) {
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

void Worlds::place(const ArrayLike& which, const ArrayLike& kiva_id, const ArrayLike& x,
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
    const auto w = static_cast<std::size_t>(worlds[i]);
    copyRobots(w, robot, robot + 1);
  }
}

py::array_t<bool> Worlds::drive(
    const py::array_t<double, py::array::c_style | py::array::forcecast>& left,
    const py::array_t<double, py::array::c_style | py::array::forcecast>& right) {
  const auto own = use();
  const std::size_t all = size() * static_cast<std::size_t>(robots_);
  for (const auto* speeds : {&left, &right}) {
    const bool fits = speeds->ndim() == 2 && static_cast<std::size_t>(speeds->shape(0)) == size() &&
                      speeds->shape(1) == robots_;
    if (!fits) {
      throw py::value_error("wheel speeds: expected shape (" + std::to_string(size()) + ", " +
                            std::to_string(robots_) + "), not " + text(speeds->attr("shape")));
    }
    for (std::size_t k = 0; k < all; ++k) {
      if (std::isfinite(speeds->data()[k])) continue;
      throw py::value_error("wheel speed of robot " + std::to_string(k % robots_) + " in world " +
                            std::to_string(k / robots_) + " is not a finite number");
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

py::array_t<float> Worlds::scans() {
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

py::array_t<UnitRow> Worlds::storageUnits() const {
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

py::array_t<std::uint64_t> Worlds::stateHash() {
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

py::list Worlds::events() const {
  const auto own = use();
  py::list out;
  for (std::size_t i = 0; i < size(); ++i) {
    for (const Event& e : events_[i]) {
      out.append(
          py::make_tuple(i, e.time, static_cast<int>(e.kind), e.model, e.other, e.text, e.command));
    }
  }
  return out;
}

Host& Worlds::host(int world) const {
  if (world < 0 || static_cast<std::size_t>(world) >= size()) {
    throw py::index_error("world is " + std::to_string(world) + "; there are " +
                          std::to_string(size()));
  }
  return *hosts_[world];
}

bool Worlds::advance(std::size_t i, std::int64_t steps, bool until_idle, std::int64_t* made) {
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

void Worlds::copyRobots(std::size_t i) { copyRobots(i, 0, robots_); }

void Worlds::copyRobots(std::size_t i, int begin, int end) {
  if (hosts_[i]->world.fleet().size() != robots_) {
    throw std::invalid_argument(
        "world " + std::to_string(i) + " has " + std::to_string(hosts_[i]->world.fleet().size()) +
        " robots and world 0 had " + std::to_string(robots_) + "; the same number was expected");
  }
  rows_.take(hosts_[i]->world, i * static_cast<std::size_t>(robots_), begin, end);
}

void Worlds::takeEvents(std::size_t i, std::vector<Event>* kept) {
  World& world = hosts_[i]->world;
  std::vector<Event> events = world.takeEvents();
  world.takeStatusChanges();
  if (!kept) return;
  for (Event& event : events) {
    const auto kind = static_cast<std::size_t>(event.kind);
    for (const std::string* model : {&event.model, &event.other}) {
      const int robot = world.fleet().find(kivaId(*model));
      const bool counts = model == &event.model || event.kind == Event::Kind::kCollision;
      if (robot >= 0 && counts && kind < Event::kKinds) {
        ++rows_.counts[(i * static_cast<std::size_t>(robots_) + robot) * Event::kKinds + kind];
      }
    }
    kept->push_back(std::move(event));
  }
}

void Worlds::scanInto(std::size_t i, float* out, std::size_t rays) {
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

}  // namespace kiva::python
