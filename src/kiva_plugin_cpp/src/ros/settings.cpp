// SPDX-License-Identifier: Apache-2.0
#include "settings.h"

#include <ros/package.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace kiva_ros {
namespace {

namespace fs = std::filesystem;
using Paths = std::vector<std::string>;

/// Returns the value of an environment variable; empty if it is not set.
std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

/// Returns the folder of files that ROS writes.
std::string rosHome() {
  const std::string set = environment("ROS_HOME");
  return set.empty() ? environment("HOME") + "/.ros" : set;
}

/// Returns the parts of a list of paths with colons between them.
Paths split(const std::string& list) {
  Paths out;
  std::istringstream folders(list);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (!folder.empty()) out.push_back(folder);
  }
  return out;
}

[[noreturn]] void refuse(const ros::NodeHandle& node, const std::string& name,
                         const XmlRpc::XmlRpcValue& value, const std::string& expected) {
  std::ostringstream message;
  message << "parameter " << node.resolveName(name) << " is ";
  value.write(message);
  throw std::runtime_error(message.str() + ": " + expected + " was expected");
}

/// Returns a number, or nothing if the parameter is not set.
std::optional<double> optionalNumber(const ros::NodeHandle& node, const std::string& name,
                                     double least, const std::string& expected) {
  XmlRpc::XmlRpcValue value;
  if (!node.getParam(name, value)) return std::nullopt;
  double out = NAN;
  if (value.getType() == XmlRpc::XmlRpcValue::TypeInt) out = static_cast<int>(value);
  if (value.getType() == XmlRpc::XmlRpcValue::TypeDouble) out = static_cast<double>(value);
  if (!(std::isfinite(out) && out >= least)) refuse(node, name, value, expected);
  return out;
}

double number(const ros::NodeHandle& node, const std::string& name, double fallback, double least,
              const std::string& expected) {
  return optionalNumber(node, name, least, expected).value_or(fallback);
}

double wholeNumber(const ros::NodeHandle& node, const std::string& name, double fallback,
                   double most, const std::string& expected) {
  const double out = number(node, name, fallback, 0, expected);
  if (out == std::floor(out) && out <= most) return out;
  refuse(node, name, XmlRpc::XmlRpcValue(out), expected);
}

double fleetRate(const ros::NodeHandle& node, double fallback) {
  const std::string expected = "a rate from 0.1 to 100 Hz";
  const double out = number(node, "fleet_rate", fallback, 0.1, expected);
  if (out > 100) refuse(node, "fleet_rate", XmlRpc::XmlRpcValue(out), expected);
  return out;
}

bool flag(const ros::NodeHandle& node, const std::string& name, bool fallback = false) {
  XmlRpc::XmlRpcValue value;
  if (!node.getParam(name, value)) return fallback;
  if (value.getType() != XmlRpc::XmlRpcValue::TypeBoolean) {
    refuse(node, name, value, "true or false");
  }
  return value;
}

std::string text(const ros::NodeHandle& node, const std::string& name,
                 const std::string& fallback) {
  XmlRpc::XmlRpcValue value;
  if (!node.getParam(name, value)) return fallback;
  if (value.getType() != XmlRpc::XmlRpcValue::TypeString) refuse(node, name, value, "text");
  return value;
}

std::optional<kiva::Drive> drive(const ros::NodeHandle& node, const std::string& name) {
  const std::string drive = text(node, name, "");
  if (drive.empty()) return std::nullopt;
  if (drive == "traction") return kiva::Drive::kTraction;
  if (drive == "jointed") return kiva::Drive::kJointed;
  refuse(node, name, XmlRpc::XmlRpcValue(drive), "traction, jointed or nothing");
}

/// Sets every text or number below `value` at its path, `section/name`.
void flatten(const std::string& path, XmlRpc::XmlRpcValue& value, kiva::Parameters* out) {
  const bool is_struct = value.getType() == XmlRpc::XmlRpcValue::TypeStruct;
  if (is_struct && (value.size() > 0 || path.empty())) {
    for (auto& [name, field] : value) flatten(path.empty() ? name : path + "/" + name, field, out);
    return;
  }
  std::ostringstream text;
  text.precision(17);
  if (value.getType() == XmlRpc::XmlRpcValue::TypeDouble) {
    text << static_cast<double>(value);
  } else if (value.getType() == XmlRpc::XmlRpcValue::TypeBoolean) {
    text << (static_cast<bool>(value) ? "true" : "false");
  } else if (value.getType() == XmlRpc::XmlRpcValue::TypeString) {
    text << static_cast<std::string>(value);
  } else if (is_struct) {
    text << "true";  // a section without numbers of its own
  } else {
    value.write(text);
  }
  out->set(path, text.str());
}

std::optional<kiva::Realism> realism(const ros::NodeHandle& node) {
  XmlRpc::XmlRpcValue value;
  if (!node.getParam("realism", value)) return std::nullopt;
  if (value.getType() != XmlRpc::XmlRpcValue::TypeStruct) {
    refuse(node, "realism", value, "sections with their numbers");
  }
  kiva::Parameters parameters("parameter " + node.resolveName("realism"));
  flatten("", value, &parameters);
  const kiva::Realism out = kiva::readRealism(parameters);
  parameters.rejectUnread();
  return out;
}

/// Returns the number of threads; by default one core is left for the broadcaster.
int threads(const ros::NodeHandle& node) {
  const auto asked = static_cast<int>(
      wholeNumber(node, "threads", 0, kiva::kMostThreads, "a whole number from 0 to 256"));
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  return asked > 0 ? asked : std::clamp(cores - 1, 1, kiva::kMostThreads);
}

/// Returns the folder of warehouse_layout's worlds, in the source tree or where it was installed.
std::string packagedWorlds() {
  const std::string package = ros::package::getPath("warehouse_layout");
  return package.empty() ? "" : package + "/worlds";
}

/// Returns the file of a world. A relative path begins in the user's working directory, since
/// roslaunch starts nodes in another one.
std::string findWorld(const std::string& world, const Paths& folders) {
  const std::string name = world.empty() ? "empty" : world;
  std::vector<fs::path> tried;
  if (!world.empty()) tried.push_back(fs::path(environment("PWD")) / name);
  for (const fs::path folder : folders) {
    tried.push_back(folder / name);
    tried.push_back(folder / (name + ".sdf"));
  }
  std::string list;
  for (const fs::path& path : tried) {
    if (fs::is_regular_file(path)) return path.string();
    list += (list.empty() ? "" : ", ") + path.string();
  }
  throw std::runtime_error("there is no world '" + name + "'; tried " +
                           (list.empty() ? "nothing: no folder of worlds is known" : list));
}

Paths joined(Paths first, const Paths& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

/// Returns the ids of robots in a text such as `kiva1 kiva2` or `1,2`.
std::vector<int> robotIds(const ros::NodeHandle& node, const std::string& name) {
  std::string names = text(node, name, "");
  std::replace(names.begin(), names.end(), ',', ' ');
  std::vector<int> ids;
  std::istringstream words(names);
  for (std::string word; words >> word;) {
    const std::string digits = word.rfind("kiva", 0) == 0 ? word.substr(4) : word;
    const bool is_number = !digits.empty() && digits.size() <= 7 &&
                           digits.find_first_not_of("0123456789") == std::string::npos;
    const int id = is_number ? std::stoi(digits) : 0;
    if (id < 1 || id > kiva::kMaxKivaId) {
      refuse(node, name, XmlRpc::XmlRpcValue(names), "names of robots, such as 'kiva1 kiva2',");
    }
    ids.push_back(id);
  }
  return ids;
}

/// Returns the full names of nodes in a text with blanks between them.
std::vector<std::string> nodeNames(const ros::NodeHandle& node, const std::string& name) {
  std::vector<std::string> out;
  std::istringstream words(text(node, name, ""));
  for (std::string word; words >> word;) {
    std::string error;
    if (!ros::names::validate(word, error)) {
      refuse(node, name, XmlRpc::XmlRpcValue(word), "names of nodes with blanks between");
    }
    out.push_back(ros::names::resolve(word));
  }
  return out;
}

double mapResolution(const ros::NodeHandle& node, double fallback) {
  const std::string expected = "a cell of 0.01 to 1 m";
  const double out = number(node, "map_resolution", fallback, 0.01, expected);
  if (out > 1) refuse(node, "map_resolution", XmlRpc::XmlRpcValue(out), expected);
  return out;
}

/// Returns a path; a relative one begins in the user's working directory.
std::string pathOf(const ros::NodeHandle& node, const std::string& name) {
  const std::string path = text(node, name, "");
  return path.empty() ? "" : (fs::path(environment("PWD")) / path).string();
}

}  // namespace

Settings readSettings(const ros::NodeHandle& node) {
  Settings out;
  const std::string worlds = packagedWorlds();
  const std::string world = text(node, "world", "");
  out.world_file = findWorld(world, split(text(node, "world_paths", worlds)));
  const std::string models = worlds.empty() ? "" : worlds + "/models";
  const Paths ours = split(text(node, "model_paths", models));
  const Paths theirs = kiva::environmentModelPaths();
  out.model_paths = joined(ours, theirs);
  out.world_model_paths = joined(joined(theirs, kiva::modelPathsAround(out.world_file)), ours);
  out.rtf = optionalNumber(node, "rtf", 0, "a factor above 0, or 0 (as fast as possible),");
  const std::string whole = "a whole number, 0 or more,";
  out.world.seed = static_cast<std::uint64_t>(wholeNumber(node, "seed", 1, 9e15, whole));
  out.world.drive = drive(node, "drive");
  out.world.realism = realism(node);
  out.world.threads = threads(node);
  out.awaits = nodeNames(node, "awaits");
  out.lockstep = flag(node, "lockstep");
  out.autosave =
      static_cast<int>(wholeNumber(node, "autosave", 0, 1e5, "a whole number from 0 to 100000"));
  out.checkpoint_folder = text(node, "checkpoint_folder", rosHome() + "/warehouse/checkpoints");
  out.checkpoint_limit = static_cast<std::uintmax_t>(
      1e6 * number(node, "checkpoint_limit", 1000, 0, "a number of megabytes, 0 or more,"));
  out.record = pathOf(node, "record");
  out.replay = pathOf(node, "replay");
  out.replay_stays = flag(node, "replay_stays", true);
  out.cmd_vel = robotIds(node, "cmd_vel");
  out.map_to_odom = flag(node, "map_to_odom", true);
  out.map_resolution = mapResolution(node, out.map_resolution);
  const std::string rate = "a rate above 0 in Hz, or 0 (every step)";
  out.rates.clock = number(node, "pub_clock_frequency", out.rates.clock, 0, rate);
  out.rates.model_states = number(node, "model_states_frequency", out.rates.model_states, 0, rate);
  out.rates.fleet = fleetRate(node, out.rates.fleet);
  return out;
}

}  // namespace kiva_ros
