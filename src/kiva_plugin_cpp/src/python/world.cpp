// SPDX-License-Identifier: Apache-2.0
//
// One world: construction, steps, checkpoints.
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host.h"

namespace kiva::python {
namespace {

std::optional<Drive> driveOf(const std::string& name) {
  if (name.empty()) return std::nullopt;
  if (name == "traction") return Drive::kTraction;
  if (name == "jointed") return Drive::kJointed;
  throw py::value_error("drive is '" + name + "'; 'traction', 'jointed' or '' was expected");
}

Realism realismOf(const std::map<std::string, std::string>& texts, const std::string& from) {
  Parameters parameters(from);
  for (const auto& [key, text] : texts) parameters.set(key, text);
  const Realism out = readRealism(parameters);
  parameters.rejectUnread();
  return out;
}

/// Returns the sections of a world's realism by name, each with `enabled` and its numbers.
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

py::dtype eventType() {
  py::list fields;
  fields.append(py::make_tuple("time", "f8"));
  fields.append(py::make_tuple("kind", "u1"));
  for (const char* text : {"model", "other", "text"}) fields.append(py::make_tuple(text, "O"));
  fields.append(py::make_tuple("command", "u4"));
  return py::dtype::from_args(fields);
}

py::array events(Host& host) {
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

}  // namespace

void warn(const std::vector<std::string>& warnings) {
  for (const std::string& text : warnings) {
    if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 2) != 0) throw py::error_already_set();
  }
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
      py::arg("time") = true,
      R"(Puts everything back to where it was spawned, at rest, without commands.

Time goes back to 0 too, unless time is False.)");
  world.def("events", &events,
            R"(Returns the events since the last call: (n,) of dtype EVENT, in order.

Fields: time [s], kind (values of EventKind), model, other, text, and the number of the command
that the event belongs to (0 = none).)");
  world.def("checkpoint", &checkpoint, R"(Returns the whole state as bytes.

This world, and any that restores the bytes, continue identically from here, bit by bit, if they
get the same commands.)");
  world.def("restore", &restore, py::arg("checkpoint"),
            R"(Replaces the state of this world by a saved one.

CheckpointError (a ValueError), with nothing changed, if the bytes are damaged.)");
  world.def(
      "draw_failures_anew",
      [](Host& host, std::uint64_t number) {
        const auto lock = host.use();
        host.world.drawFailuresAnew(number);
      },
      py::arg("number"),
      R"(Draws the random failures to come from another stream, such as after restore().

Worlds that restore the same checkpoint fail differently by different numbers; 0 changes nothing.)");
  world.def(
      "state_hash", guarded([](World& w) { return w.stateHash(); }),
      "Returns a 64-bit hash over all state that decides what happens next; equal worlds have "
      "equal hashes.");
  world.def_property_readonly(
      "realism",
      [](Host& host) {
        const auto lock = host.use();
        return realismOf(host.world);
      },
      "The deviations from the ideal: sections by name, each a dict of `enabled` and its numbers.");
  world.def_property_readonly("time", guarded([](World& w) { return w.time(); }),
                              "Simulated time [s].");
  world.def_property_readonly("steps", guarded([](World& w) { return w.steps(); }),
                              "Steps made since time was 0.");
  world.def_property(
      "step_size", guarded([](World& w) { return w.stepSize(); }),
      [](Host& host, double seconds) {
        const auto lock = host.use();
        host.world.setStepSize(seconds);
      },
      "Duration of a step [s]. Setting it, from 1e-6 to 1, else ValueError, changes the next "
      "step.");
  world.def_property_readonly("grid_spacing", guarded([](World& w) { return w.gridSpacing(); }),
                              "Spacing of the grid points on which robots stand [m].");
  world.def_property_readonly("floor", guarded([](World& w) {
                                const FloorExtent& f = w.floor();
                                return py::make_tuple(f.min_x, f.max_x, f.min_y, f.max_y);
                              }),
                              "The floor: (min_x, max_x, min_y, max_y) in world [m].");
  defineCommands(world);
  defineRobots(world);
  defineModels(world);
  definePeople(world);
  defineFallenItems(world);
  m.attr("EVENT") = eventType();
}

}  // namespace kiva::python
