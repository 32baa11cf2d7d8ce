// SPDX-License-Identifier: Apache-2.0
#include "checkpoint_services.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "service_answer.h"

namespace kiva_ros {
namespace {

constexpr double kSaveInterval = 1;       // [s], simulated
constexpr double kRounding = 1e-6;        // [s]
constexpr std::size_t kMostNames = 1000;  // a client that never repeats one must not fill memory

bool isFile(const std::string& name) { return name.find('/') != std::string::npos; }

/// Whole or not at all: nobody sees half a file.
void writeFile(const std::string& path, const std::string& bytes) {
  const std::string partial = path + ".part";
  {
    std::ofstream file(partial, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) throw Refusal("can't write " + partial);
  }
  if (std::rename(partial.c_str(), path.c_str()) != 0) throw Refusal("can't write " + path);
}

std::string readFile(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Refusal("can't read " + path);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string seconds(double time) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f s", time);
  return text;
}

void checkName(const std::string& name) {
  if (name.empty()) throw Refusal("a name, or the path of a file with a '/' in it, was expected");
}

/// `body` returns the message.
template <typename Response, typename Body>
bool reply(Response& response, Body body) {
  try {
    response.message = body();
    response.success = true;
  } catch (const std::exception& error) {
    response.message = error.what();
    response.success = false;
  }
  return true;
}

}  // namespace

CheckpointServices::CheckpointServices(ros::NodeHandle& root, SimulationThread& simulation,
                                       int autosave)
    : simulation_(simulation), autosave_(static_cast<std::size_t>(autosave)) {
  servers_.push_back(
      root.advertiseService("/warehouse/checkpoint", &CheckpointServices::save, this));
  servers_.push_back(
      root.advertiseService("/warehouse/restore", &CheckpointServices::restore, this));
  servers_.push_back(root.advertiseService("/warehouse/undo", &CheckpointServices::undo, this));
}

bool CheckpointServices::save(Request& request, Response& response) {
  return reply(response, [&] {
    checkName(request.name);
    std::string bytes = simulation_.checkpoint();
    const std::string message = request.name + ": " + std::to_string(bytes.size()) + " bytes";
    if (isFile(request.name)) {
      writeFile(request.name, bytes);
      return message;
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    if (by_name_.size() >= kMostNames && !by_name_.count(request.name)) {
      throw Refusal("there are " + std::to_string(kMostNames) + " checkpoints already");
    }
    by_name_[request.name] = std::move(bytes);
    return message;
  });
}

std::string CheckpointServices::find(const std::string& name) {
  checkName(name);
  if (isFile(name)) return readFile(name);
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto at = by_name_.find(name);
  if (at != by_name_.end()) return at->second;
  std::string known;
  for (const auto& [other, bytes] : by_name_) known += (known.empty() ? "" : ", ") + other;
  throw Refusal("there is no checkpoint '" + name + "'; there " +
                (known.empty() ? "is none" : "are " + known));
}

bool CheckpointServices::restore(Request& request, Response& response) {
  return reply(response, [&] {
    const double time = simulation_.restore(find(request.name));
    return "back at " + seconds(time) + " of " + request.name;
  });
}

bool CheckpointServices::undo(warehouse_msgs::Undo::Request& request,
                              warehouse_msgs::Undo::Response& response) {
  return reply(response, [&] {
    const double time =
        simulation_.run([&](kiva::World& world) { return undoHere(world, request.seconds); });
    response.stamp = ros::Time(time);
    return "back at " + seconds(time);
  });
}

double CheckpointServices::undoHere(kiva::World& world, double seconds_back) {
  if (!(std::isfinite(seconds_back) && seconds_back >= 0)) {
    throw Refusal("a finite number of seconds, 0 or more, was expected");
  }
  if (autosave_ == 0) throw Refusal("nothing was saved: start with autosave:=60, say");
  const auto is_old_enough = [&](const Saved& saved) {
    return age_ - saved.age >= seconds_back - kRounding;
  };
  const auto at = std::find_if(ring_.rbegin(), ring_.rend(), is_old_enough);
  if (at == ring_.rend()) {
    const double oldest = ring_.empty() ? 0 : age_ - ring_.front().age;
    throw Refusal("the oldest of " + std::to_string(ring_.size()) + " checkpoints is " +
                  seconds(oldest) + " old");
  }
  simulation_.restoreHere(world, at->bytes);
  age_ = at->age;
  ring_.erase(at.base(), ring_.end());  // what came after it did not happen
  return world.time();
}

void CheckpointServices::afterStep(kiva::World& world) {
  age_ += world.stepSize();
  const auto save_every = std::max(1LL, std::llround(kSaveInterval / world.stepSize()));  // steps
  if (autosave_ == 0 || world.steps() % static_cast<std::uint64_t>(save_every) != 0) return;
  simulation_.noteCheckpoint();
  ring_.push_back({age_, world.checkpoint()});
  if (ring_.size() > autosave_) ring_.pop_front();
}

}  // namespace kiva_ros
