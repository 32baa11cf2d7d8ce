// SPDX-License-Identifier: Apache-2.0
#include "kiva_plugin_cpp/realism.h"

#include <map>

namespace kiva {
namespace {

bool hasBelow(const Parameters& parameters, const std::string& key) {
  const auto at = parameters.values().lower_bound(key);
  return at != parameters.values().end() && at->first.compare(0, key.size(), key) == 0;
}

/// Returns every number by its name; `section` itself is whether the section is on.
std::map<std::string, double> numbersOf(const Realism& realism) {
  std::map<std::string, double> out;
  forEachSection(realism, [&](const std::string& name, const auto& section) {
    out[name] = section.enabled ? 1 : 0;
    section.fields(section, [&](const std::string& key, double value, double, double) {
      out[name + "/" + key] = value;
    });
  });
  return out;
}

}  // namespace

Realism readRealism(const Parameters& parameters, const std::string& prefix) {
  Realism out;
  forEachSection(out, [&](const std::string& name, auto& section) {
    const std::string key = prefix + name;
    const bool is_given = hasBelow(parameters, key + "/");
    section.fields(section, parameters.reader(key + "/"));
    section.enabled = is_given;
    // SDF's text of an element that has children is blank.
    if (!is_given || !parameters.text(key, "").empty()) {
      section.enabled = parameters.flag(key, is_given);
    }
  });
  parameters.ignore(prefix + "service");
  return out;
}

bool operator==(const Realism& a, const Realism& b) { return numbersOf(a) == numbersOf(b); }

}  // namespace kiva
