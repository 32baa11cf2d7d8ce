// SPDX-License-Identifier: Apache-2.0
#include "python/rware.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/parallel/workers.h"
#include "python/arrays.h"
#include "rware/observer.h"
#include "rware/undertaking.h"
#include "rware/warehouse.h"

namespace learning::python {
namespace {

using rware::Layer;

constexpr int kWorth = 64;  // warehouses that justify a second thread

/// Warehouses of one kind, stepped and observed on all threads.
class Rware {
 public:
  Rware(std::shared_ptr<const rware::Layout> layout, const rware::Options& options, int count,
        const rware::Senses& senses, std::vector<Layer> layers, bool directional, unsigned threads)
      : agents_(options.agents),
        senses_(senses),
        layers_(std::move(layers)),
        directional_(directional),
        workers_(threads),
        warehouses_(count, rware::Warehouse(std::move(layout), options)),
        messages_(static_cast<std::size_t>(count) * agents_ * senses.bits) {}

  int count() const { return static_cast<int>(warehouses_.size()); }

  void seed(int i, const rware::NumpyGenerator::State& state) { at(i).seed(state); }

  void reset(const py::object& which) {
    const auto chosen = checked<bool>("which", which, {count()});
    const bool* begins = chosen.data();
    const py::gil_scoped_release release;
    const int bits = agents_ * senses_.bits;
    workers_.share(count(), kWorth, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        if (!begins[i]) continue;
        warehouses_[i].reset();
        std::fill_n(messages_.begin() + std::ptrdiff_t{i} * bits, bits, 0.0f);
      }
    });
  }

  void step(const py::object& given_which, const py::object& given_actions,
            const py::object& given_messages, const py::object& given_rewards,
            const py::object& given_ends) {
    const auto which = checked<bool>("which", given_which, {count()});
    const auto actions = checked<std::int8_t>("actions", given_actions, {count(), agents_});
    auto rewards = checked<double>("rewards", given_rewards, {count(), agents_});
    auto ends = checked<bool>("ends", given_ends, {count()});
    checkActions(actions);
    if (senses_.bits) takeMessages(given_messages);
    const bool* steps = which.data();
    const std::int8_t* action = actions.data();
    double* reward = rewards.mutable_data();
    bool* ended = ends.mutable_data();
    const py::gil_scoped_release release;
    workers_.share(count(), kWorth, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const auto first = std::ptrdiff_t{i} * agents_;
        if (steps[i]) {
          ended[i] = warehouses_[i].step(action + first, reward + first);
        } else {
          std::fill_n(reward + first, agents_, 0.0);
          ended[i] = false;
        }
      }
    });
  }

  /// Steps the only warehouse, with Python's numbers: arrays would cost more than the step.
  py::tuple stepOne(const py::sequence& actions, const py::object& given_rewards) {
    auto rewards = checked<double>("rewards", given_rewards, {1, agents_});
    double* reward = rewards.mutable_data();
    if (count() != 1 || static_cast<int>(actions.size()) != agents_) {
      throw py::value_error("actions has " + std::to_string(actions.size()) + " entries; " +
                            std::to_string(agents_) + " were expected, one an agent");
    }
    actions_.clear();
    for (const py::handle action : actions) actions_.push_back(actionOf(action));
    const bool ends = warehouses_[0].step(actions_.data(), reward);
    const bool is_paid =
        std::any_of(reward, reward + agents_, [](double share) { return share != 0; });
    return py::make_tuple(ends, is_paid);
  }

  void vectors(const py::object& destination) {
    write("vectors", destination, {count(), agents_, senses_.size()}, senses_.size(),
          [this](int i, int agent, float* out) {
            const float* messages = messages_.data() + std::ptrdiff_t{i} * agents_ * senses_.bits;
            rware::writeVector(warehouses_[i], senses_, messages, agent, out);
          });
  }

  void images(const py::object& destination) {
    const int layers = static_cast<int>(layers_.size()), width = senses_.width();
    write("images", destination, {count(), agents_, layers, width, width}, layers * senses_.cells(),
          [this](int i, int agent, float* out) {
            rware::writeImage(warehouses_[i], senses_, layers_, directional_, agent, out);
          });
  }

  void features(const py::object& destination) {
    write(
        "features", destination, {count(), agents_, rware::kFeatures}, rware::kFeatures,
        [this](int i, int agent, float* out) { rware::writeFeatures(warehouses_[i], agent, out); });
  }

  void begin(const py::object& given_which, const py::object& given_actions, bool bodies,
             const py::object& given_current) {
    const auto which = checked<bool>("which", given_which, {count()});
    const auto actions = checked<std::int8_t>("actions", given_actions, {count(), agents_});
    auto current = checked<std::int8_t>("current", given_current, {count(), agents_});
    checkActions(actions);
    const bool* begins = which.data();
    const std::int8_t* action = actions.data();
    std::int8_t* out = current.mutable_data();
    const py::gil_scoped_release release;
    workers_.share(count(), kWorth, [&](int begin, int end) {
      rware::Undertaking undertaking(bodies);
      for (int i = begin; i < end; ++i) {
        const auto first = std::ptrdiff_t{i} * agents_;
        if (begins[i]) undertaking.begin(warehouses_[i], action + first, out + first);
      }
    });
  }

  /// Writes (count, agents, 3): cell, direction, carried shelf or -1.
  void where(const py::object& argument) {
    auto array = checked<int>("out", argument, {count(), agents_, 3});
    int* out = array.mutable_data();
    for (const rware::Warehouse& warehouse : warehouses_) {
      for (const rware::Agent& agent : warehouse.agents()) {
        for (const int value : {agent.cell, agent.direction, agent.shelf}) *out++ = value;
      }
    }
  }

  std::vector<int> shelfAt(int i) {
    std::vector<int> cells(at(i).layout().size());
    for (std::size_t cell = 0; cell < cells.size(); ++cell) {
      cells[cell] = at(i).shelfAt(static_cast<int>(cell));
    }
    return cells;
  }

  /// Returns (agents, 4) of a warehouse: cell, direction, carried shelf or -1, whether that was
  /// delivered.
  py::array_t<int> agents(int i) {
    py::array_t<int> out({agents_, 4});
    int* row = out.mutable_data();
    for (const rware::Agent& agent : at(i).agents()) {
      for (const int value : {agent.cell, agent.direction, agent.shelf, int{agent.has_delivered}}) {
        *row++ = value;
      }
    }
    return out;
  }

  std::vector<int> shelves(int i) {
    std::vector<int> cells(at(i).layout().storage.size());
    for (std::size_t shelf = 0; shelf < cells.size(); ++shelf) {
      cells[shelf] = at(i).shelfCell(static_cast<int>(shelf));
    }
    return cells;
  }

  std::vector<int> requests(int i) { return at(i).requests(); }

 private:
  rware::Warehouse& at(int i) {
    if (i < 0 || i >= count()) throw py::index_error("there is no such warehouse");
    return warehouses_[i];
  }

  static void checkActions(const Array<std::int8_t>& actions) {
    for (const std::int8_t* action = actions.data(); action < actions.data() + actions.size();) {
      checkAction(*action++);
    }
  }

  static void checkAction(long action) {
    if (action >= 0 && action < rware::kActions) return;
    throw py::value_error("actions: " + std::to_string(action) +
                          " is not an action; 0 to 4 were expected");
  }

  static std::int8_t actionOf(const py::handle& value) {
    const auto action = value.cast<long>();
    checkAction(action);
    return static_cast<std::int8_t>(action);
  }

  void takeMessages(const py::object& argument) {
    const auto messages = checked<float>("messages", argument, {count(), agents_, senses_.bits});
    std::copy_n(messages.data(), messages.size(), messages_.begin());
  }

  template <typename Write>
  void write(const char* name, const py::object& argument, std::vector<py::ssize_t> shape, int size,
             const Write& writeOne) {
    auto array = checked<float>(name, argument, std::move(shape));
    float* out = array.mutable_data();
    const py::gil_scoped_release release;
    workers_.share(count(), kWorth, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        for (int agent = 0; agent < agents_; ++agent) {
          writeOne(i, agent, out + (std::ptrdiff_t{i} * agents_ + agent) * size);
        }
      }
    });
  }

  int agents_;
  rware::Senses senses_;
  std::vector<Layer> layers_;
  bool directional_;
  kiva::Workers workers_;
  std::vector<rware::Warehouse> warehouses_;
  std::vector<float> messages_;  // count * agents * bits
  std::vector<std::int8_t> actions_;
};

std::unique_ptr<Rware> makeRware(int height, int width, std::vector<std::uint8_t> highway,
                                 std::vector<int> goals, int count, int agents, int requests,
                                 int max_inactivity, int max_steps, int reward, int range, int bits,
                                 bool normalised, const std::vector<int>& layers, bool directional,
                                 unsigned threads, std::vector<std::uint8_t> walls) {
  if (count < 1) throw py::value_error("count: 1 or more was expected");
  if (range < 0 || bits < 0)
    throw py::value_error("sensor_range, msg_bits: 0 or more was expected");
  auto layout = std::make_shared<rware::Layout>(height, width, std::move(highway), std::move(goals),
                                                std::move(walls));
  const rware::Options options{agents, requests, max_inactivity, max_steps,
                               static_cast<rware::Reward>(reward)};
  std::vector<Layer> visible;
  for (const int layer : layers) visible.push_back(static_cast<Layer>(layer));
  return std::make_unique<Rware>(std::move(layout), options, count,
                                 rware::Senses{range, bits, normalised}, std::move(visible),
                                 directional, threads);
}

unsigned __int128 joined(std::uint64_t high, std::uint64_t low) {
  return (static_cast<unsigned __int128>(high) << 64) | low;
}

}  // namespace

void defineRware(py::module_& module) {
  py::class_<Rware> rware(module, "Rware",
                          "Warehouses of RWARE, of one kind; see warehouse_learning.rware.");
  rware.def(py::init(&makeRware), py::kw_only(), py::arg("height"), py::arg("width"),
            py::arg("highway"), py::arg("goals"), py::arg("count"), py::arg("agents"),
            py::arg("requests"), py::arg("max_inactivity"), py::arg("max_steps"), py::arg("reward"),
            py::arg("range"), py::arg("bits"), py::arg("normalised"), py::arg("layers"),
            py::arg("directional"), py::arg("threads"),
            py::arg("walls") = std::vector<std::uint8_t>());
  rware.def(
      "seed",
      [](Rware& self, int i, std::array<std::uint64_t, 4> words, bool has_half,
         std::uint32_t half) {
        self.seed(i, {joined(words[0], words[1]), joined(words[2], words[3]), has_half, half});
      },
      py::arg("i"), py::arg("words"), py::arg("has_half"), py::arg("half"),
      "words: state and increment of numpy's PCG64, the high 64 bits of each first.");
  rware.def("reset", &Rware::reset, py::arg("which"),
            "New episodes where which, (count,) bool, says so.");
  rware.def("step", &Rware::step, py::arg("which"), py::arg("actions"), py::arg("messages"),
            py::arg("rewards"), py::arg("ends"),
            R"(A step of those in which, (count,) bool; of the others nothing changes.

actions: (count, agents) int8; messages: (count, agents, bits) float32, not looked at without bits;
written: rewards, (count, agents) float64, and ends, (count,) bool.)");
  rware.def(
      "step_one", &Rware::stepOne, py::arg("actions"), py::arg("rewards"),
      R"(A step of the only warehouse; returns whether its episode ends, and whether any reward is not 0.

actions: a sequence of one an agent, without messages; written: rewards, (1, agents) float64.)");
  rware.def("vectors", &Rware::vectors, py::arg("out"), "out: (count, agents, size) float32.");
  rware.def("images", &Rware::images, py::arg("out"),
            "out: (count, agents, layers, width, width) float32.");
  rware.def("features", &Rware::features, py::arg("out"), "out: (count, agents, 6) float32.");
  rware.def(
      "begin", &Rware::begin, py::arg("which"), py::arg("actions"), py::arg("bodies"),
      py::arg("current"),
      R"(Lets agents that are at nothing begin an action that takes time, where that is possible.

actions, current: (count, agents) int8; current, 0 where an agent is at nothing, is written. What
ends is given to step(), which makes it come true. bodies: neighbours turn one after the other.)");
  rware.def("where", &Rware::where, py::arg("out"),
            "out: (count, agents, 3) int32: cell, direction, shelf carried or -1.");
  rware.def("shelf_at", &Rware::shelfAt, py::arg("i"), "By cell: the shelf there, or -1.");
  rware.def("agents", &Rware::agents, py::arg("i"),
            "(agents, 4) int32: cell, direction, shelf carried or -1, whether that was delivered.");
  rware.def("shelves", &Rware::shelves, py::arg("i"), "The cell of each shelf.");
  rware.def("requests", &Rware::requests, py::arg("i"), "The shelves that are requested.");
}

}  // namespace learning::python
