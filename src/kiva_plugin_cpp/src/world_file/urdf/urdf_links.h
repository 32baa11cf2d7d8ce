// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "world_file/files/xml.h"

namespace kiva {

/// A mass with its centre, and its inertia about the centre, along the axes of a link.
struct UrdfInertia {
  double mass = 0;  ///< [kg]
  Pose pose;        ///< Pose of the inertial's own frame.
  Vector3 moments, products;

  /// Adds another inertia at `pose` in this link's frame, rigidly connected.
  void add(UrdfInertia other, const Pose& pose);
};

/// A `<collision>` or a `<visual>` and the link of its document.
struct UrdfShape {
  const XmlElement* element = nullptr;
  std::string name;  ///< Its own name, or its link's.
  std::string from;  ///< The link in whose element it stands.
  Pose pose;         ///< Pose in the link that it belongs to now.
};

struct UrdfJoint {
  const XmlElement* element = nullptr;
  std::string name, type, parent, child;
  Pose pose;  ///< Pose in the parent link.
};

/// The elements of `<gazebo reference="…">` for a link, perhaps one that was lumped into another.
struct UrdfExtension {
  const XmlElement* element = nullptr;
  Pose pose;  ///< Pose of the link in whose element it stands.
  bool is_lumped = false;
};

struct UrdfLink {
  const XmlElement* element = nullptr;
  std::string name;
  bool has_inertia = false;
  UrdfInertia inertia;
  std::vector<UrdfShape> collisions, visuals;
  std::vector<UrdfExtension> extensions;
  std::vector<std::string> children;  ///< Sorted names of the joints to them.
};

/// A `<robot>` as a tree of links with fixed joints lumped, as in Gazebo: the contents of a link
/// that is fixed to another one go into that one. Links that are fixed to "world" stay, and so do
/// those whose joint a `<gazebo>` element asks to keep.
struct UrdfTree {
  std::map<std::string, UrdfLink> links;
  std::map<std::string, UrdfJoint> joints;
  std::string root;
  /// The link that holds a lumped link's parts now, and the lumped link's pose in it.
  struct Place {
    std::string link;
    Pose pose;
  };
  std::map<std::string, Place> lumped;
};

/// Returns the value of an element within `<gazebo>`: its attribute `value`, or its text. Nothing
/// for null.
std::string valueOf(const XmlElement* element);

/// Reads the links of a `<robot>`. Ignores texts that should be numbers, with a warning each.
/// Throws SdfError where the links are no tree.
UrdfTree readUrdf(const XmlElement& robot, Faults* warnings);

}  // namespace kiva
