// SPDX-License-Identifier: Apache-2.0
//
// The world inside a Python process. This file translates; python/kiva_plugin_cpp/__init__.py adds
// what is easier said in Python.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "arrays.h"
#include "host.h"
#include "kiva_plugin_cpp/look.h"

namespace kiva::python {
namespace {

/// A row of World.items.
struct ItemRow {
  std::int32_t item_id;
  double x, y, z, mass;
  std::int32_t shelf_id;
};

std::optional<Drive> driveOf(const std::string& name) {
  if (name.empty()) return std::nullopt;
  if (name == "traction") return Drive::kTraction;
  if (name == "jointed") return Drive::kJointed;
  throw py::value_error("drive is '" + name + "'; 'traction', 'jointed' or '' was expected");
}

void warn(const std::vector<std::string>& warnings) {
  for (const std::string& text : warnings) {
    if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 2) != 0) throw py::error_already_set();
  }
}

Realism realismOf(const std::map<std::string, std::string>& texts, const std::string& from) {
  Parameters parameters(from);
  for (const auto& [key, text] : texts) parameters.set(key, text);
  const Realism out = readRealism(parameters);
  parameters.rejectUnread();
  return out;
}

/// Sections by name, each with whether it is on and its numbers.
py::dict realismOf(const World& world) {
  py::dict out;
  forEachSection(world.realism(), [&out](const char* name, const auto& section) {
    py::dict numbers;
    numbers["enabled"] = section.enabled;
    section.fields(section, [&numbers](const char* field, double value, double, double) {
      numbers[field] = value;
    });
    out[name] = numbers;
  });
  return out;
}

HostPtr makeHost(const std::string& source, bool is_text, const ModelPaths& world_model_paths,
                 const ModelPaths& model_paths, std::uint64_t seed, const std::string& drive,
                 int threads, const std::optional<std::map<std::string, std::string>>& realism,
                 const std::string& realism_from) {
  WorldOptions options;
  options.seed = seed;
  options.threads = threads;
  options.drive = driveOf(drive);
  if (realism) options.realism = realismOf(*realism, realism_from);
  std::vector<std::string> warnings;
  HostPtr host;
  {
    py::gil_scoped_release release;
    host =
        std::make_shared<Host>(is_text ? parseWorld(source, world_model_paths, "<text>", &warnings)
                                       : loadWorld(source, world_model_paths, &warnings),
                               options, model_paths);
  }
  warn(warnings);
  warn(host->world.takeWarnings());
  return host;
}

void step(Host& host, std::int64_t steps) {
  if (steps < 0) throw py::value_error("steps is " + std::to_string(steps) + "; 0 or more");
  const auto lock = host.use();
  while (steps > 0) {
    const std::int64_t now = std::min(steps, kStepsBetweenSignals);
    {
      py::gil_scoped_release release;
      for (std::int64_t i = 0; i < now; ++i) host.world.step();
    }
    steps -= now;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();  // Ctrl-C
  }
}

// --- commands

void checkRobot(const Host& host, std::int32_t id) {
  if (host.world.fleet().find(id) < 0) {
    throw py::value_error("kiva_id: there is no robot kiva" + std::to_string(id));
  }
}

void checkFinite(const char* name, double value, std::size_t i) {
  if (std::isfinite(value)) return;
  throw py::value_error(std::string(name) + " of command " + std::to_string(i) + " is " +
                        text(py::float_(value)) + "; expected a finite number");
}

}  // namespace

void checkCommand(const Host& host, const Command& command, std::size_t i) {
  if (command.kind >= Command::Kind::kFollow) {
    throw py::value_error("kind of command " + std::to_string(i) + " is " +
                          std::to_string(static_cast<int>(command.kind)) + "; expected 0 to 7");
  }
  const bool may_be_all =
      command.kind == Command::Kind::kStop || command.kind == Command::Kind::kGoOn;
  if (!may_be_all || command.kiva_id != 0) checkRobot(host, command.kiva_id);
  checkFinite("x", command.x, i);
  checkFinite("y", command.y, i);
}

namespace {

/// All or none.
void postAll(Host& host, const Command* commands, std::size_t count) {
  const auto lock = host.use();
  for (std::size_t i = 0; i < count; ++i) checkCommand(host, commands[i], i);
  for (std::size_t i = 0; i < count; ++i) host.world.post(commands[i]);
}

}  // namespace

py::array_t<Command, py::array::c_style> commandRows(const py::array& commands) {
  const py::dtype expected = py::dtype::of<Command>();
  if (!commands.dtype().equal(expected)) {
    throw py::type_error("commands: expected an array of dtype kiva_plugin_cpp.COMMAND, " +
                         text(expected) + ", not " + text(commands.dtype()));
  }
  if (commands.ndim() > 1) {
    throw py::value_error("commands: expected shape (n,), not " + text(commands.attr("shape")));
  }
  return py::array_t<Command, py::array::c_style>::ensure(commands);
}

namespace {

void post(Host& host, const py::array& commands) {
  const auto rows = commandRows(commands);
  postAll(host, rows.data(), static_cast<std::size_t>(rows.size()));
}

/// How many commands the columns make: the one length that isn't 1.
template <typename... Columns>
std::size_t lengthOf(const Columns&... columns) {
  py::ssize_t length = 1;
  const char* whose = nullptr;
  const auto check = [&](const auto& column) {
    if (column.isOne()) return;
    if (whose && column.size() != length) {
      throw py::value_error(std::string(column.name()) + " has " + std::to_string(column.size()) +
                            " entries and " + whose + " has " + std::to_string(length));
    }
    whose = column.name();
    length = column.size();
  };
  (check(columns), ...);
  return static_cast<std::size_t>(length);
}

template <typename Fill, typename... Columns>
void postColumns(Host& host, Command::Kind kind, Fill fill, const Columns&... columns) {
  std::vector<Command> commands(lengthOf(columns...));
  for (std::size_t i = 0; i < commands.size(); ++i) {
    commands[i].kind = kind;
    fill(commands[i], columns[static_cast<py::ssize_t>(i)]...);
  }
  postAll(host, commands.data(), commands.size());
}

using Ids = Numbers<std::int32_t>;
using Counts = Numbers<std::uint32_t>;
using Reals = Numbers<double>;

void mov(Host& host, const py::object& kiva_id, const py::object& x, const py::object& y) {
  const auto fill = [](Command& c, int id, double to_x, double to_y) {
    c.kiva_id = id;
    c.x = to_x;
    c.y = to_y;
  };
  postColumns(host, Command::Kind::kMoveTo, fill, Ids("kiva_id", kiva_id), Reals("x", x),
              Reals("y", y));
}

void movAlong(Host& host, Command::Kind kind, const py::object& kiva_id,
              const py::object& distance) {
  const auto fill = [kind](Command& c, int id, double way) {
    c.kiva_id = id;
    (kind == Command::Kind::kMoveX ? c.x : c.y) = way;
  };
  postColumns(host, kind, fill, Ids("kiva_id", kiva_id), Reals("distance", distance));
}

void rot(Host& host, const py::object& kiva_id, const py::object& direction) {
  const auto fill = [](Command& c, int id, int way) {
    c.kiva_id = id;
    c.direction = way;
  };
  postColumns(host, Command::Kind::kRotate, fill, Ids("kiva_id", kiva_id),
              Ids("direction", direction));
}

void lift(Host& host, const py::object& kiva_id, const py::object& status,
          const py::object& shelf_id) {
  const auto fill = [](Command& c, int id, int what, int shelf) {
    c.kiva_id = id;
    c.lift = what;
    c.shelf_id = shelf;
  };
  postColumns(host, Command::Kind::kLift, fill, Ids("kiva_id", kiva_id), Ids("status", status),
              Ids("shelf_id", shelf_id));
}

void cancel(Host& host, const py::object& kiva_id) {
  const auto fill = [](Command& c, int id) { c.kiva_id = id; };
  postColumns(host, Command::Kind::kCancel, fill, Ids("kiva_id", kiva_id));
}

void stop(Host& host, const py::object& kiva_id, bool stop) {
  const auto fill = [](Command& c, int id) { c.kiva_id = id; };
  postColumns(host, stop ? Command::Kind::kStop : Command::Kind::kGoOn, fill,
              Ids("kiva_id", kiva_id));
}

/// `kind` 0: it is repaired.
void fail(Host& host, std::int32_t kiva_id, int kind, double repair_after) {
  const auto lock = host.use();
  if (kind == 0) return host.world.repair(kiva_id);
  const bool is_known = kind > 0 && kind <= kFailureKinds;
  if (!is_known) throw py::value_error("kind is " + std::to_string(kind) + "; expected 0 to 5");
  host.world.fail(kiva_id, static_cast<Failure>(kind), repair_after);
}

/// A row of World.last_heard.
struct HeardRow {
  std::int32_t index;
  double x, y, yaw, vx, vy, yaw_rate;
  std::uint8_t status, state;
  std::int32_t shelf_id;
  std::uint32_t path_id, reached, left;
  std::uint8_t last_end;
};

py::array_t<HeardRow> lastHeard(Host& host) {
  const auto lock = host.use();
  std::vector<HeardRow> rows;
  for (int i = 0; i < host.world.fleet().size(); ++i) {
    const auto last = host.world.lastHeard(i);
    if (!last) continue;
    rows.push_back({i, last->x, last->y, last->yaw, last->vx, last->vy, last->yaw_rate,
                    static_cast<std::uint8_t>(last->status), static_cast<std::uint8_t>(last->state),
                    last->shelf_id, last->path_id, last->reached, last->left, last->last_end});
  }
  return py::array_t<HeardRow>(static_cast<py::ssize_t>(rows.size()), rows.data());
}

/// Rows of which each has `points[i]` entries of x and y, one after the other. All or none.
void follow(Host& host, const py::object& kiva_id, const py::object& path_id,
            const py::object& first, const py::object& points, const py::object& x,
            const py::object& y, const py::object& released) {
  const Ids ids("kiva_id", kiva_id);
  const Counts paths("path_id", path_id), firsts("first", first), counts("points", points),
      releases("released", released);
  const Reals xs("x", x), ys("y", y);
  const std::size_t rows = lengthOf(ids, paths, firsts, counts, releases);
  std::size_t total = 0;
  for (std::size_t i = 0; i < rows; ++i) total += counts[static_cast<py::ssize_t>(i)];
  for (const Reals* column : {&xs, &ys}) {
    if (static_cast<std::size_t>(column->size()) == total) continue;
    throw py::value_error(std::string(column->name()) + " has " + std::to_string(column->size()) +
                          " entries, and points make " + std::to_string(total));
  }
  const auto lock = host.use();
  for (std::size_t i = 0; i < rows; ++i) checkRobot(host, ids[static_cast<py::ssize_t>(i)]);
  for (std::size_t k = 0; k < total; ++k) {
    checkFinite("x", xs.data()[k], k);
    checkFinite("y", ys.data()[k], k);
  }
  std::size_t at = 0;
  for (std::size_t row = 0; row < rows; ++row) {
    const auto i = static_cast<py::ssize_t>(row);
    FollowPath path;
    path.kiva_id = ids[i];
    path.path_id = paths[i];
    path.first = firsts[i];
    path.released = releases[i];
    path.x.assign(xs.data() + at, xs.data() + at + counts[i]);
    path.y.assign(ys.data() + at, ys.data() + at + counts[i]);
    at += counts[i];
    host.world.post(std::move(path));
  }
}

// --- the fleet

/// What Python calls World.fleet.
struct FleetView {
  HostPtr host;

  template <typename Out, typename Read>
  py::array column(Read read) const {
    const auto lock = host->use();
    return view<Out>(read(host->world.fleet()));
  }
  template <typename Read>
  py::array_t<std::int32_t> numbers(Read read) const {
    const auto lock = host->use();
    const int size = host->world.fleet().size();
    py::array_t<std::int32_t> out(size);
    for (int i = 0; i < size; ++i) out.mutable_data()[i] = read(host->world, i);
    return out;
  }
};

std::int32_t idOf(const World& world, int robot) {
  return robot < 0 ? 0 : world.fleet().robots[robot].id;
}
std::int32_t shelfOf(const World& world, int robot) {
  const int unit = world.fleet().unit[robot];
  return unit < 0 ? 0 : world.storageUnits()[unit].id;
}

int indexOf(const Host& host, std::int32_t kiva_id) {
  checkRobot(host, kiva_id);
  return host.world.fleet().find(kiva_id);
}

std::vector<int> robotsOf(const Host& host, const py::object& kiva_id) {
  std::vector<int> robots;
  if (kiva_id.is_none()) {
    for (int i = 0; i < host.world.fleet().size(); ++i) robots.push_back(i);
    return robots;
  }
  const Ids ids("kiva_id", kiva_id);
  for (py::ssize_t i = 0; i < ids.size(); ++i) robots.push_back(indexOf(host, ids[i]));
  return robots;
}

/// One row a robot, filled up with NaN.
void scanInto(Host& host, const std::vector<int>& robots, std::size_t rays) {
  std::vector<int> fitted;
  for (int robot : robots) {
    if (host.world.fleet().robots[robot].laser.fitted) fitted.push_back(robot);
  }
  std::vector<std::vector<float>> ranges;
  host.world.scan(fitted, &ranges);
  std::fill(host.ranges.begin(), host.ranges.end(), std::numeric_limits<float>::quiet_NaN());
  std::size_t next = 0;  // of those that scan
  for (std::size_t row = 0; row < robots.size() && next < fitted.size(); ++row) {
    if (robots[row] != fitted[next]) continue;
    std::copy(ranges[next].begin(), ranges[next].end(), host.ranges.data() + row * rays);
    ++next;
  }
}

py::array scans(Host& host, const py::object& kiva_id) {
  const auto lock = host.use();
  const std::vector<int> robots = robotsOf(host, kiva_id);
  std::size_t rays = 0;
  for (int robot : robots) {
    const LaserParameters& laser = host.world.fleet().robots[robot].laser;
    if (laser.fitted) rays = std::max(rays, static_cast<std::size_t>(laser.rays));
  }
  if (host.ranges.size() != robots.size() * rays) {
    host.ranges = Column<float>(robots.size() * rays);
  }
  {
    py::gil_scoped_release release;
    scanInto(host, robots, rays);
  }
  return view<float>(host.ranges,
                     {static_cast<py::ssize_t>(robots.size()), static_cast<py::ssize_t>(rays)});
}

// --- models

std::vector<std::string> spawn(Host& host, std::vector<ModelInstance> models) {
  std::vector<std::string> names;
  for (const ModelInstance& model : models) names.push_back(model.name);
  host.world.spawn(models);
  return names;
}

std::vector<std::string> spawnText(Host& host, const std::string& sdf, const std::string& name,
                                   const std::optional<std::array<double, 4>>& place) {
  const auto lock = host.use();
  std::vector<std::string> warnings;
  std::vector<ModelInstance> models = parseModels(sdf, host.model_paths, "<text>", &warnings);
  warn(warnings);
  if (models.size() > 1 && (!name.empty() || place)) {
    throw py::value_error("the text holds " + std::to_string(models.size()) +
                          " models; name and place are for one");
  }
  if (!name.empty()) models[0].name = name;
  if (place) {
    const auto& [x, y, z, yaw] = *place;
    models[0].pose = Pose(x, y, z, 0, 0, yaw);
  }
  return spawn(host, std::move(models));
}

void checkModel(const Host& host, const std::string& name) {
  if (!host.world.has(name)) throw py::key_error("there is no model '" + name + "'");
}

void removeModel(Host& host, const std::string& name) {
  const auto lock = host.use();
  checkModel(host, name);
  host.world.remove(name);
}

py::array_t<double> poseOf(Host& host, const std::string& name) {
  const auto lock = host.use();
  checkModel(host, name);
  const Pose pose = host.world.state(name)->pose;
  const Quaternion& q = pose.Rot();
  const double numbers[] = {pose.X(), pose.Y(), pose.Z(), q.X(), q.Y(), q.Z(), q.W()};
  return py::array_t<double>(7, numbers);
}

void setPose(Host& host, const std::string& name, double x, double y, double z, double yaw) {
  const auto lock = host.use();
  checkModel(host, name);
  host.world.setState(name, {Pose(x, y, z, 0, 0, yaw), {}});
}

}  // namespace

UnitRow unitRow(const World& world, int unit) {
  const StorageUnit& u = world.storageUnits()[unit];
  const Pose pose = world.storageUnitPose(unit);
  return {u.id, pose.X(), pose.Y(), pose.Z(), pose.Yaw(), u.mass, idOf(world, u.carrier)};
}

namespace {

py::array_t<UnitRow> storageUnits(Host& host) {
  const auto lock = host.use();
  const int units = static_cast<int>(host.world.storageUnits().size());
  py::array_t<UnitRow> out(units);
  for (int i = 0; i < units; ++i) out.mutable_data()[i] = unitRow(host.world, i);
  return out;
}

py::array_t<ItemRow> items(Host& host) {
  const auto lock = host.use();
  const auto& all = host.world.items();
  py::array_t<ItemRow> out(static_cast<py::ssize_t>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Pose pose = host.world.itemPose(static_cast<int>(i));
    const int unit = all[i].unit;
    out.mutable_data()[i] = {all[i].id,   pose.X(),
                             pose.Y(),    pose.Z(),
                             all[i].mass, unit < 0 ? 0 : host.world.storageUnits()[unit].id};
  }
  return out;
}

template <typename T>
py::array copyOf(const std::vector<T>& values) {
  return py::array_t<T>(static_cast<py::ssize_t>(values.size()), values.data());
}

/// Of all links, in the model's order.
py::list visualsOf(Host& host, const std::string& name) {
  const auto lock = host.use();
  checkModel(host, name);
  py::list out;
  for (const Link& link : host.world.description(name)->links) {
    for (const Visual& visual : link.visuals) {
      const Pose pose = link.pose_in_model * visual.pose_in_link;
      const Quaternion& q = pose.Rot();
      const Vector3& size = visual.shape.size;
      out.append(py::make_tuple(
          link.name, py::make_tuple(pose.X(), pose.Y(), pose.Z(), q.X(), q.Y(), q.Z(), q.W()),
          py::make_tuple(size.X(), size.Y(), size.Z())));
    }
  }
  return out;
}

py::dict lookOfModel(Host& host, const std::string& name) {
  const auto lock = host.use();
  checkModel(host, name);
  const Look look = lookOf(*host.world.description(name));
  py::dict out;
  out["links"] = look.links;
  out["link_pose"] = copyOf(look.link_pose);
  out["shape_link"] = copyOf(look.shape_link);
  out["shape_kind"] = copyOf(look.shape_kind);
  out["shape_pose"] = copyOf(look.shape_pose);
  out["shape_size"] = copyOf(look.shape_size);
  out["shape_colour"] = copyOf(look.shape_colour);
  return out;
}

py::tuple occupancyOf(Host& host) {
  const auto lock = host.use();
  const Occupancy map = host.world.occupancy();
  py::array_t<std::uint8_t> cells({map.rows, map.columns}, map.cells.data());
  return py::make_tuple(map.x, map.y, map.spacing, cells);
}

// --- events, checkpoints

py::dtype eventType() {
  py::list fields;
  fields.append(py::make_tuple("time", "f8"));
  fields.append(py::make_tuple("kind", "u1"));
  for (const char* text : {"model", "other", "text"}) fields.append(py::make_tuple(text, "O"));
  fields.append(py::make_tuple("command", "u4"));
  return py::dtype::from_args(fields);
}

py::object events(Host& host) {
  const auto lock = host.use();
  py::list rows;
  for (const Event& e : host.world.takeEvents()) {
    rows.append(
        py::make_tuple(e.time, static_cast<int>(e.kind), e.model, e.other, e.text, e.command));
  }
  host.world.takeStatusChanges();
  return py::module_::import("numpy").attr("array")(rows, eventType());
}

py::bytes checkpoint(Host& host) {
  const auto lock = host.use();
  return host.world.checkpoint();
}

void restore(Host& host, const py::bytes& bytes) {
  const auto lock = host.use();
  host.world.restore(bytes);
}

/// A function of the world, as a method that no second thread gets into.
template <typename Call>
auto guarded(Call call) {
  return [call](Host& host) {
    const auto lock = host.use();
    return call(host.world);
  };
}

void defineFleet(py::module_& m) {
  py::class_<FleetView> fleet(m, "Fleet", R"(All robots as arrays: entry i of each is robot i.

Arrays but kiva_id and shelf_id are read-only views: nothing is copied, and step() changes what
they show. They are current until robots come or go, or the world is restored: ask for them anew
then. An old one stays safe to read, whatever becomes of the world, and shows what was there last.)");
  const auto add = [&fleet](const char* name, auto read, auto zero, const char* doc) {
    const auto get = [read](const FleetView& f) { return f.template column<decltype(zero)>(read); };
    fleet.def_property_readonly(name, get, doc);
  };
  add(
      "x", [](const Fleet& f) -> auto& { return f.x; }, 0.0,
      "(n,) float64: x in world [m]. A view.");
  add(
      "y", [](const Fleet& f) -> auto& { return f.y; }, 0.0,
      "(n,) float64: y in world [m]. A view.");
  add(
      "yaw", [](const Fleet& f) -> auto& { return f.yaw; }, 0.0,
      "(n,) float64: heading in world [rad], unwrapped: it counts full turns. A view.");
  add(
      "vx", [](const Fleet& f) -> auto& { return f.vx; }, 0.0,
      "(n,) float64: velocity along the world's x [m/s]. A view.");
  add(
      "vy", [](const Fleet& f) -> auto& { return f.vy; }, 0.0,
      "(n,) float64: velocity along the world's y [m/s]. A view.");
  add(
      "yaw_rate", [](const Fleet& f) -> auto& { return f.yaw_rate; }, 0.0,
      "(n,) float64 [rad/s], counterclockwise. A view.");
  add(
      "left_wheel_speed", [](const Fleet& f) -> auto& { return f.wheel_speed[0]; }, 0.0,
      "(n,) float64 [rad/s]. A view.");
  add(
      "right_wheel_speed", [](const Fleet& f) -> auto& { return f.wheel_speed[1]; }, 0.0,
      "(n,) float64 [rad/s]. A view.");
  add(
      "tower", [](const Fleet& f) -> auto& { return f.tower; }, 0.0,
      "(n,) float64: height of the tower above its rest [m]. A view.");
  add(
      "status", [](const Fleet& f) -> auto& { return f.status; }, std::uint8_t(),
      "(n,) uint8, values of Status. A view.");
  add(
      "state", [](const Fleet& f) -> auto& { return f.state; }, std::uint8_t(),
      "(n,) uint8, values of State. A view.");
  add(
      "last_end", [](const Fleet& f) -> auto& { return f.last_end; }, std::uint8_t(),
      "(n,) uint8: how a robot's last command ended, until the next is accepted: 0 none yet, else "
      "EventKind.DONE or BLOCKED. A view.");
  add(
      "path_id", [](const Fleet& f) -> auto& { return f.path_id; }, std::uint32_t(),
      "(n,) uint32: the path that a robot's last command is; 0 if that is none. A view.");
  add(
      "reached", [](const Fleet& f) -> auto& { return f.reached; }, std::uint32_t(),
      "(n,) uint32: how many points of its path a robot's centre has come to, the one where it "
      "began among them. A view.");
  add(
      "left", [](const Fleet& f) -> auto& { return f.left; }, std::uint32_t(),
      "(n,) uint32: how many leading points' cells a robot and its load have left wholly. A view.");
  add(
      "stopped", [](const Fleet& f) -> auto& { return f.stopped; }, std::uint8_t(),
      "(n,) uint8: 1 while stop() holds a robot. A view.");
  add(
      "failures", [](const Fleet& f) -> auto& { return f.failures; }, std::uint8_t(),
      "(n,) uint8: what is broken in a robot, 1 << each FailureKind, added up, 1 for "
      "an empty battery; 0 nothing. A view.");
  add(
      "allowed_speed", [](const Fleet& f) -> auto& { return f.allowed_speed; }, 0.0,
      "(n,) float64: what a robot may drive since people are near [m/s]; 0 it stands for them, inf "
      "nobody is near. A view.");
  add(
      "curtained", [](const Fleet& f) -> auto& { return f.curtained; }, std::uint8_t(),
      "(n,) uint8: 1 while a robot stands in a light curtain where somebody is. A view.");
  add(
      "charge", [](const Fleet& f) -> auto& { return f.charge; }, 0.0f,
      "(n,) float32: state of charge of the battery, 0 to 1; 1 where realism has no energy. A "
      "view.");
  fleet.def_property_readonly(
      "kiva_id", [](const FleetView& f) { return f.numbers(idOf); },
      "(n,) int32: the robots' numbers; kiva7 has 7. A copy.");
  fleet.def_property_readonly(
      "shelf_id", [](const FleetView& f) { return f.numbers(shelfOf); },
      "(n,) int32: number of the storage unit that each carries, 0 = none. A copy.");
  fleet.def_property_readonly(
      "believed",
      [](const FleetView& f) {
        const auto lock = f.host->use();
        const int size = f.host->world.fleet().size();
        py::array_t<double> out({size, 3});
        for (int i = 0; i < size; ++i) {
          const Vector3 at = f.host->world.believedPose(i);
          for (int k = 0; k < 3; ++k) out.mutable_at(i, k) = at[k];
        }
        return out;
      },
      "(n, 3) float64: x, y [m], yaw [rad] where each robot believes to be. A copy.");
  fleet.def(
      "index",
      [](const FleetView& f, std::int32_t id) {
        const auto lock = f.host->use();
        return indexOf(*f.host, id);
      },
      py::arg("kiva_id"), "Where robot kiva_id is in the arrays. ValueError if there is none.");
  fleet.def("__len__", [](const FleetView& f) {
    const auto lock = f.host->use();
    return f.host->world.fleet().size();
  });
}

void defineWorld(py::module_& m) {
  py::class_<Host, HostPtr> world(m, "World");
  world.def(py::init(&makeHost), py::arg("source"), py::arg("is_text"),
            py::arg("world_model_paths"), py::arg("model_paths"), py::arg("seed"), py::arg("drive"),
            py::arg("threads"), py::arg("realism") = py::none(), py::arg("realism_from") = "");
  world.def("step", &step, py::arg("steps") = 1,
            R"(Advances the world by so many steps of step_size seconds.

Other threads run meanwhile; one that uses this world gets a RuntimeError. Ctrl-C ends it between
steps. ValueError for a negative number.)");
  world.def(
      "reset",
      [](Host& host, bool time) {
        const auto lock = host.use();
        host.world.reset(time);
      },
      py::arg("time") = true, R"(Everything back to where it was spawned, at rest, without commands.

Time goes back to 0 too, unless time is False.)");
  world.def("post", &post, py::arg("commands"),
            R"(Posts commands: a row, or an array of shape (n,), of dtype COMMAND.

They are answered by an ACCEPTED or REFUSED event each at the next step. TypeError for another
dtype; ValueError, and none is posted, for another shape, an unknown kind or robot, NaN or
infinity.)");
  world.def("mov", &mov, py::arg("kiva_id"), py::arg("x"), py::arg("y"),
            R"(Go to (x, y) in world [m]: along x first, then along y, turning as needed.

Each argument is a number or an array of shape (n,), one command an entry; numbers go with every
entry. TypeError for what holds no numbers; ValueError, and nothing is posted, for shapes that
don't match, an unknown robot, NaN or infinity. What a robot can't do is refused by an event.)");
  world.def(
      "movx",
      [](Host& host, const py::object& id, const py::object& distance) {
        movAlong(host, Command::Kind::kMoveX, id, distance);
      },
      py::arg("kiva_id"), py::arg("distance"),
      "Go so far [m] along the world's x, a whole number of cells. Arguments and errors as of "
      "mov().");
  world.def(
      "movy",
      [](Host& host, const py::object& id, const py::object& distance) {
        movAlong(host, Command::Kind::kMoveY, id, distance);
      },
      py::arg("kiva_id"), py::arg("distance"),
      "Go so far [m] along the world's y, a whole number of cells. Arguments and errors as of "
      "mov().");
  world.def(
      "rot", &rot, py::arg("kiva_id"), py::arg("direction"),
      "Turn by 90 degrees: 1 counterclockwise, -1 clockwise. Arguments and errors as of mov().");
  world.def("lift", &lift, py::arg("kiva_id"), py::arg("status"), py::arg("shelf_id"),
            "Carry (1) or drop (0) storage unit shelf_id; drop, 0: whichever it carries. Arguments "
            "and errors as of mov().");
  world.def("follow", &follow, py::arg("kiva_id"), py::arg("path_id"), py::arg("first"),
            py::arg("points"), py::arg("x"), py::arg("y"), py::arg("released"));
  world.def("cancel", &cancel, py::arg("kiva_id"),
            R"(End what it does in DONE, "cancelled", at the next grid point where it can stop.

A lift ends when it is over. Refused by an event if the robot is idle. Arguments and errors as of
mov().)");
  world.def("stop", &stop, py::arg("kiva_id"), py::arg("stop") = true,
            R"(Stop wheels and lift as hard as they can; stop=False: go on with what was stopped.

Kiva_id 0 means every robot. What is commanded meanwhile begins when they go on. Arguments and
errors as of mov().)");
  world.def("fail", &fail, py::arg("kiva_id"), py::arg("kind"), py::arg("repair_after") = 0.0,
            R"(Breaks something in a robot now, a FailureKind; FailureKind.REPAIRED mends all of it.

It is repaired after so many seconds; 0: when it is asked for. ValueError for an unknown robot or
kind, or a time that is negative or not finite.)");
  world.def("last_heard", &lastHeard,
            R"((n,) of robots whose radio is lost, and of all where reports go by radio: what was
heard of them last.

Fields: index (in the fleet's arrays), and those of Fleet. A copy.)");
  world.def(
      "scans", &scans, py::arg("kiva_id") = py::none(),
      R"(Laser ranges now, of all robots in the fleet's order or of those given: (n, rays) float32 [m].

+inf = nothing within range, -inf = nearer than the minimum; rays go counterclockwise; NaN fills
the rows of robots with fewer rays or without a laser. A read-only view of the world's own memory:
current until the next call of scans(), which may write into it; safe to read ever after.
ValueError for a robot that isn't.)");
  world.def("spawn", &spawnText, py::arg("sdf"), py::arg("name") = "",
            py::arg("place") = py::none(),
            R"(Adds the models of an SDF or URDF text, or none; returns their names.

A single one can be given a name and a place, (x, y, z, yaw) in world [m, rad]. DescriptionError
(a ValueError) names what is wrong.)");
  world.def("delete", &removeModel, py::arg("name"),
            "Takes a model away; a storage unit goes with its items. KeyError if there is none of "
            "that name.");
  world.def("pose", &poseOf, py::arg("name"),
            "x y z qx qy qz qw of a model in world [m], (7,) float64. KeyError if there is none.");
  world.def("visuals", &visualsOf, py::arg("name"),
            R"(What is seen of a model: a list of (link, pose in the model, size).

The pose is x y z [m] qx qy qz qw, the size a box's edges [m] (0 of other shapes). KeyError if there
is none of that name.)");
  world.def(
      "look", &lookOfModel, py::arg("name"),
      R"(What a model looks like, as a dict of arrays of the names, and the layout, of the fields of
warehouse_msgs/Look. KeyError if there is none of that name.)");
  world.def("occupancy", &occupancyOf, R"(What is in the way on the floor: (x, y, spacing, cells).

cells: (rows along y, columns along x) uint8, 0 free, 50 a storage unit, 99 a belt, 100 taken by
anything else, or no floor; robots are not in it. (x, y) is the centre of cells[0, 0], spacing the
edge of a cell, in world [m].)");
  world.def("set_pose", &setPose, py::arg("name"), py::arg("x"), py::arg("y"), py::arg("z") = 0.0,
            py::arg("yaw") = 0.0,
            R"(Puts a model there [m, rad], at rest; a command that it is at ends in BLOCKED.

KeyError if there is none of that name, DescriptionError if the place is no finite one.)");
  world.def("events", &events, R"(What happened since the last call: (n,) of dtype EVENT, in order.

Fields: time [s], kind (values of EventKind), model, other, text, and the number of the command that
it belongs to (0 = none).)");
  world.def("checkpoint", &checkpoint, R"(The whole state as bytes.

This world, and any that restores them, go on the same from here, bit by bit, if they are given
the same commands.)");
  world.def("restore", &restore, py::arg("checkpoint"),
            R"(Makes this world the one that was saved, whatever it was before.

CheckpointError (a ValueError), with nothing changed, if the bytes are damaged.)");
  world.def("state_hash", guarded([](World& w) { return w.stateHash(); }),
            "64 bits over all that decides what happens next; equal worlds have equal ones.");
  world.def_property_readonly(
      "fleet", [](const HostPtr& host) { return FleetView{host}; },
      "The robots as arrays, a Fleet.");
  world.def_property_readonly(
      "storage_units", &storageUnits,
      R"((n,) with shelf_id, x y z yaw in world [m, rad], mass with items [kg], kiva_id of its carrier
(0 = none). A copy.)");
  world.def_property_readonly(
      "items", &items,
      "(n,) with item_id, x y z in world [m], mass [kg], shelf_id it lies on (0 = none). A copy.");
  world.def_property_readonly("names", guarded([](World& w) { return w.modelNames(); }),
                              "Of all models, in the order in which they came.");
  world.def_property_readonly(
      "realism",
      [](Host& host) {
        const auto lock = host.use();
        return realismOf(host.world);
      },
      "What differs from the ideal: sections by name, each a dict of `enabled` and its numbers.");
  world.def_property_readonly("time", guarded([](World& w) { return w.time(); }), "Simulated [s].");
  world.def_property_readonly("steps", guarded([](World& w) { return w.steps(); }),
                              "Since time was 0.");
  world.def_property(
      "step_size", guarded([](World& w) { return w.stepSize(); }),
      [](Host& host, double seconds) {
        const auto lock = host.use();
        host.world.setStepSize(seconds);
      },
      "How far a step goes [s]; set, from the next one on: 1e-6 to 1, else ValueError.");
  world.def_property_readonly("grid_spacing", guarded([](World& w) { return w.gridSpacing(); }),
                              "Of the grid points on which robots stand [m].");
  world.def_property_readonly("floor", guarded([](World& w) {
                                const Floor& f = w.floor();
                                return py::make_tuple(f.min_x, f.max_x, f.min_y, f.max_y);
                              }),
                              "(min_x, max_x, min_y, max_y) in world [m].");
  definePeople(world);
  defineFallenItems(world);
}

}  // namespace

PYBIND11_MODULE(_core, m) {
  PYBIND11_NUMPY_DTYPE(Command, kind, kiva_id, x, y, direction, lift, shelf_id);
  PYBIND11_NUMPY_DTYPE(HeardRow, index, x, y, yaw, vx, vy, yaw_rate, status, state, shelf_id,
                       path_id, reached, left, last_end);
  PYBIND11_NUMPY_DTYPE(UnitRow, shelf_id, x, y, z, yaw, mass, kiva_id);
  PYBIND11_NUMPY_DTYPE(ItemRow, item_id, x, y, z, mass, shelf_id);
  py::register_exception<DescriptionError>(m, "DescriptionError", PyExc_ValueError);
  py::register_exception<CheckpointError>(m, "CheckpointError", PyExc_ValueError);
  m.attr("COMMAND") = py::dtype::of<Command>();
  m.attr("EVENT") = eventType();
  m.def("environment_model_paths", &environmentModelPaths);
  m.def("model_paths_around", &modelPathsAround, py::arg("world_file"));
  defineFleet(m);
  defineWorld(m);
  defineWorlds(m);
}

}  // namespace kiva::python
