// SPDX-License-Identifier: Apache-2.0
#include "world_file/urdf/urdf_links.h"

#include <algorithm>

#include "kiva_plugin_cpp/principal_inertia.h"
#include "world_file/elements/values.h"

namespace kiva {
namespace {

/// Reads values of attributes. A malformed value counts as missing, with a warning.
class Attributes {
 public:
  explicit Attributes(Faults* warnings) : warnings_(warnings) {}

  double number(const XmlElement& element, const char* attribute) const {
    const auto number = readDouble(attributeOf(element, attribute));
    return number ? *number : warned(element, attribute, "a number", 0.0);
  }

  /// Returns `xyz` and `rpy` of the `<origin>` in an element.
  Pose originIn(const XmlElement& element) const {
    const XmlElement* const origin = element.FirstChildElement("origin");
    if (!origin) return Pose::Zero;
    const Vector3 rpy = triple(*origin, "rpy");
    return {triple(*origin, "xyz"), Quaternion(rpy.X(), rpy.Y(), rpy.Z())};
  }

 private:
  Vector3 triple(const XmlElement& element, const char* attribute) const {
    const auto vector = readVector(attributeOf(element, attribute));
    return vector ? *vector : warned(element, attribute, "three numbers", Vector3::Zero);
  }

  template <typename Value>
  Value warned(const XmlElement& element, const std::string& attribute, const std::string& expected,
               const Value& otherwise) const {
    if (!element.Attribute(attribute.c_str())) return otherwise;
    warnings_->push_back(noteAt(element, "this " + attribute + " is left out: '" +
                                             attributeOf(element, attribute.c_str()) +
                                             "' is not a value for it; expected " + expected));
    return otherwise;
  }

  Faults* const warnings_;
};

/// Returns a tensor about a point at `arm` from the centre of mass (Huygens and Steiner).
Matrix3 shifted(const Matrix3& about_centre, double mass, const Vector3& arm) {
  const double x = arm.X(), y = arm.Y(), z = arm.Z();
  return about_centre + Matrix3(mass * (y * y + z * z), -mass * x * y, -mass * x * z,  //
                                -mass * x * y, mass * (x * x + z * z), -mass * y * z,  //
                                -mass * x * z, -mass * y * z, mass * (x * x + y * y));
}

Matrix3 turned(const UrdfInertia& inertia) {
  const Matrix3 turn(inertia.pose.Rot());
  return turn * InertiaTensor{inertia.moments, inertia.products}.matrix() * turn.Transposed();
}

UrdfInertia readInertia(const XmlElement& inertial, const Attributes& attributes) {
  UrdfInertia result;
  const XmlElement* const mass = inertial.FirstChildElement("mass");
  const XmlElement* const inertia = inertial.FirstChildElement("inertia");
  if (mass) result.mass = attributes.number(*mass, "value");
  result.pose = attributes.originIn(inertial);
  if (!inertia) return result;
  const auto moment = [&](const char* name) { return attributes.number(*inertia, name); };
  result.moments = {moment("ixx"), moment("iyy"), moment("izz")};
  result.products = {moment("ixy"), moment("ixz"), moment("iyz")};
  return result;
}

std::vector<UrdfShape> readShapes(const XmlElement& link, const char* kind,
                                  const Attributes& attributes) {
  std::vector<UrdfShape> shapes;
  const std::string name = attributeOf(link, "name");
  forEach(link, kind, [&](const XmlElement& shape) {
    const std::string own = attributeOf(shape, "name");
    shapes.push_back({&shape, own.empty() ? name : own, name, attributes.originIn(shape)});
  });
  return shapes;
}

class Reader {
 public:
  explicit Reader(Faults* warnings) : attributes_(warnings) {}

  UrdfTree run(const XmlElement& robot) {
    forEach(robot, "link", [&](const XmlElement& link) { addLink(link); });
    forEach(robot, "joint", [&](const XmlElement& joint) { addJoint(joint); });
    forEach(robot, "gazebo", [&](const XmlElement& extension) { addExtension(extension); });
    for (const auto& [name, joint] : tree_.joints)
      tree_.links[joint.parent].children.push_back(name);
    findRoot(robot);
    lump(robot, tree_.root, 0);
    return std::move(tree_);
  }

 private:
  static constexpr int kDeepest = 1000;

  void addLink(const XmlElement& from) {
    UrdfLink link;
    link.element = &from;
    link.name = attributeOf(from, "name");
    if (link.name.empty()) failAt(from, "expected a name");
    if (const XmlElement* const inertial = from.FirstChildElement("inertial")) {
      link.has_inertia = true;
      link.inertia = readInertia(*inertial, attributes_);
    }
    link.collisions = readShapes(from, "collision", attributes_);
    link.visuals = readShapes(from, "visual", attributes_);
    if (!tree_.links.emplace(link.name, link).second) failAt(from, "this name is taken");
  }

  void addJoint(const XmlElement& from) {
    UrdfJoint joint{&from, attributeOf(from, "name"), attributeOf(from, "type"), "",
                    "",    attributes_.originIn(from)};
    const auto end = [&](const char* kind) {
      const XmlElement* const element = from.FirstChildElement(kind);
      const std::string link = element ? attributeOf(*element, "link") : "";
      if (!tree_.links.count(link))
        failAt(from, "its " + std::string(kind) + " '" + link + "' is not there");
      return link;
    };
    joint.parent = end("parent");
    joint.child = end("child");
    if (!to_child_.emplace(joint.child, joint.name).second) {
      failAt(from, "its child '" + joint.child + "' has a parent already");
    }
    if (!tree_.joints.emplace(joint.name, joint).second) failAt(from, "this name is taken");
  }

  void addExtension(const XmlElement& from) {
    const std::string of = attributeOf(from, "reference");
    if (tree_.links.count(of)) tree_.links[of].extensions.push_back({&from, Pose::Zero, false});
    for (const char* flag : {"preserveFixedJoint", "disableFixedJointLumping"}) {
      if (readFlag(valueOf(from.FirstChildElement(flag))).value_or(false)) kept_.insert(of);
    }
  }

  void findRoot(const XmlElement& robot) {
    for (const auto& [name, link] : tree_.links) {
      if (to_child_.count(name)) continue;
      if (!tree_.root.empty()) {
        failAt(robot, "both '" + tree_.root + "' and '" + name + "' have no parent; expected one");
      }
      tree_.root = name;
    }
    if (tree_.root.empty()) failAt(robot, "expected a <link> without a parent");
  }

  bool isLumped(const UrdfJoint& joint) const {
    return joint.type == "fixed" && !kept_.count(joint.name);
  }

  void lump(const XmlElement& robot, const std::string& name, int depth) {
    if (depth > kDeepest) {
      failAt(robot, "its links nest deeper than " + std::to_string(kDeepest));
    }
    const std::vector<std::string> children = tree_.links[name].children;
    for (const bool first : {true, false}) {
      for (const std::string& child : children) {
        if (isLumped(tree_.joints[child]) == first) {
          lump(robot, tree_.joints[child].child, depth + 1);
        }
      }
      if (first) lumpIntoParent(name);
    }
  }

  void lumpIntoParent(const std::string& name) {
    const auto joint = to_child_.find(name);
    if (joint == to_child_.end()) return;
    const UrdfJoint by = tree_.joints[joint->second];
    if (by.parent == "world" || !isLumped(by)) return;
    UrdfLink& link = tree_.links[name];
    UrdfLink& parent = tree_.links[by.parent];
    if (link.has_inertia) {
      parent.has_inertia = true;
      parent.inertia.add(link.inertia, by.pose);
    }
    for (auto shapes : {&UrdfLink::collisions, &UrdfLink::visuals}) {
      for (UrdfShape shape : link.*shapes) {
        shape.pose = by.pose * shape.pose;
        (parent.*shapes).push_back(shape);
      }
    }
    for (const UrdfExtension& extension : link.extensions) {
      parent.extensions.push_back({extension.element, by.pose * extension.pose, true});
    }
    tree_.lumped[name] = {by.parent, by.pose};
    for (auto& [other, place] : tree_.lumped) {
      if (place.link == name) place = {by.parent, by.pose * place.pose};
    }
    moveJoints(by, &link, &parent);
  }

  void moveJoints(const UrdfJoint& by, UrdfLink* link, UrdfLink* parent) {
    for (const std::string& child : link->children) {
      UrdfJoint& joint = tree_.joints[child];
      joint.parent = by.parent;
      joint.pose = by.pose * joint.pose;
      parent->children.push_back(child);
    }
    link->children.clear();
    auto& children = parent->children;
    children.erase(std::find(children.begin(), children.end(), by.name));
    tree_.joints.erase(by.name);
  }

  const Attributes attributes_;
  UrdfTree tree_;
  std::map<std::string, std::string> to_child_;  // joints by child link
  std::set<std::string> kept_;                   // fixed joints that are not lumped
};

}  // namespace

void UrdfInertia::add(UrdfInertia other, const Pose& at) {
  other.pose = at * other.pose;
  const double sum = mass + other.mass;
  if (!(sum > 0)) return;
  const Vector3 centre = (pose.Pos() * mass + other.pose.Pos() * other.mass) / sum;
  const Matrix3 tensor = shifted(turned(*this), mass, pose.Pos() - centre) +
                         shifted(turned(other), other.mass, other.pose.Pos() - centre);
  mass = sum;
  pose = Pose(centre, Quaternion::Identity);
  moments = {tensor(0, 0), tensor(1, 1), tensor(2, 2)};
  products = {tensor(0, 1), tensor(0, 2), tensor(1, 2)};
}

std::string valueOf(const XmlElement* element) {
  if (element && element->Attribute("value")) return attributeOf(*element, "value");
  return contentOf(element);
}

UrdfTree readUrdf(const XmlElement& robot, Faults* warnings) { return Reader(warnings).run(robot); }

}  // namespace kiva
