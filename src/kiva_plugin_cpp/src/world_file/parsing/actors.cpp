// SPDX-License-Identifier: Apache-2.0
#include "world_file/parsing/actors.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace kiva {
namespace {

constexpr double kSamePlace = 0.001;  // [m]

const XmlElement* childOf(const XmlElement* element, const char* name) {
  return element ? element->FirstChildElement(name) : nullptr;
}

const XmlElement* trajectoryOf(const XmlElement& actor) {
  return childOf(childOf(&actor, "script"), "trajectory");
}

bool isSet(const XmlElement* flag, bool otherwise) {
  const std::string text = contentOf(flag);
  return text.empty() ? otherwise : text == "true" || text == "1";
}

/// Returns a time in a script; negative if it is invalid.
double secondsIn(const XmlElement* element, double otherwise) {
  if (!element) return otherwise;
  const auto numbers = parseNumbers(contentOf(element), 1);
  return numbers ? numbers->front() : -1;
}

struct KeyFrame {
  double time = 0;  // [s]
  Waypoint at;
};

/// Adds a keyframe to the walk, whose last one is `before`.
void append(const KeyFrame& frame, const KeyFrame& before, Walk* walk) {
  Waypoint to = frame.at;
  Waypoint& last = walk->waypoints.back();
  const double way = std::hypot(to.x - last.x, to.y - last.y);
  if (way < kSamePlace) {
    last.pause += frame.time - before.time;
    return;
  }
  to.speed = way / (frame.time - before.time);
  walk->waypoints.push_back(to);
}

/// Limits the speed to kMostWalkingSpeed, with a warning.
void slowDown(const XmlElement& waypoint, Waypoint* to, Faults* warnings) {
  if (to->speed <= kMostWalkingSpeed) return;
  warnings->push_back(
      noteAt(waypoint, "people walk to this waypoint at 1.6 m/s, and come there later"));
  to->speed = kMostWalkingSpeed;
}

}  // namespace

Pose placeOf(const XmlElement& actor) {
  const XmlElement* const waypoint = childOf(trajectoryOf(actor), "waypoint");
  const auto pose = parsePose(contentOf(childOf(waypoint ? waypoint : &actor, "pose")));
  if (!pose) return Pose::Zero;
  return Pose(pose->X(), pose->Y(), 0, 0, 0, pose->Yaw());
}

Walk scriptOf(const XmlElement& actor, Faults* warnings) {
  const XmlElement* const script = childOf(&actor, "script");
  const XmlElement* const trajectory = trajectoryOf(actor);
  Walk walk;
  if (!trajectory || !isSet(childOf(script, "auto_start"), true)) return walk;
  walk.loops = isSet(childOf(script, "loop"), true);
  std::optional<KeyFrame> before;
  for (const XmlElement* waypoint = childOf(trajectory, "waypoint"); waypoint;
       waypoint = waypoint->NextSiblingElement("waypoint")) {
    const auto pose = parsePose(contentOf(childOf(waypoint, "pose")));
    const double time = secondsIn(childOf(waypoint, "time"), -1);
    if (!pose || time < 0 || (before && time <= before->time)) {
      warnings->push_back(noteAt(*waypoint,
                                 "this waypoint is left out: expected a <pose> of six numbers and "
                                 "a <time> of 0 s or more, later than the one before"));
      continue;
    }
    KeyFrame frame{time, {pose->X(), pose->Y()}};
    if (before) {
      append(frame, *before, &walk);
      slowDown(*waypoint, &walk.waypoints.back(), warnings);
    } else {
      frame.at.pause = time + std::max(0.0, secondsIn(childOf(script, "delay_start"), 0));
      walk.waypoints.push_back(frame.at);
    }
    before = frame;
  }
  return walk;
}

}  // namespace kiva
