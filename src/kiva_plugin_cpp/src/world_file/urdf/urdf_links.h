// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "world_file/files/xml.h"

namespace kiva {

/// A mass with its centre and its inertia about that, all along the axes of a link.
struct UrdfInertia {
  double mass = 0;  ///< [kg]
  Pose pose;        ///< Of the inertial's own frame.
  Vector3 moments, products;

  /// The same, and another one that stands at `pose` in this link's frame, as one body.
  void add(UrdfInertia other, const Pose& pose);
};

/// A `<collision>` or a `<visual>` with the link that it was written for.
struct UrdfShape {
  const XmlElement* element = nullptr;
  std::string name;  ///< Its own, or that of its link.
  std::string from;  ///< The link that it was written for.
  Pose pose;         ///< In the link that has it now.
};

struct UrdfJoint {
  const XmlElement* element = nullptr;
  std::string name, type, parent, child;
  Pose pose;  ///< In the parent link.
};

/// What `<gazebo reference="…">` puts into a link, perhaps from another that was lumped into it.
struct UrdfExtension {
  const XmlElement* element = nullptr;
  Pose pose;  ///< Of the link that it was written for.
  bool is_lumped = false;
};

struct UrdfLink {
  const XmlElement* element = nullptr;
  std::string name;
  bool has_inertia = false;
  UrdfInertia inertia;
  std::vector<UrdfShape> collisions, visuals;
  std::vector<UrdfExtension> extensions;
  std::vector<std::string> children;  ///< Names of the joints to them, sorted.
};

/// A `<robot>` as a tree of links, fixed joints lumped: what a link holds that is fixed to another
/// one goes into that, as in Gazebo. Links that are fixed to "world" stay, and those whose joint a
/// `<gazebo>` element asks to keep.
struct UrdfTree {
  std::map<std::string, UrdfLink> links;
  std::map<std::string, UrdfJoint> joints;
  std::string root;
  /// Of each link that was lumped: the one that holds its parts now, and where it stands in that.
  struct Place {
    std::string link;
    Pose pose;
  };
  std::map<std::string, Place> lumped;
};

/// What an element within `<gazebo>` says: in an attribute `value`, or as its text. Null says
/// nothing.
std::string valueOf(const XmlElement* element);

/// Texts that are no numbers count as if they were not given, with a warning each. Throws SdfError
/// where the links are no tree.
UrdfTree readUrdf(const XmlElement& robot, Faults* warnings);

}  // namespace kiva
