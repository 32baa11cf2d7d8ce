// SPDX-License-Identifier: Apache-2.0
//
// Converts URDF to SDF as Gazebo does. A link without a mass is dropped, with its children. The
// contents of `<gazebo reference="link">` go into the link, those without a reference into the
// model.
#include <algorithm>
#include <charconv>

#include "world_file/elements/values.h"
#include "world_file/urdf/urdf.h"
#include "world_file/urdf/urdf_links.h"

namespace kiva {
namespace {

constexpr const char* kNoLimit = "1e16";

/// Returns the shortest text that parses to the same number.
std::string exact(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

std::string exact(const Vector3& v) {
  return exact(v.X()) + ' ' + exact(v.Y()) + ' ' + exact(v.Z());
}

class SdfWriter {
 public:
  SdfWriter(const XmlElement& robot, SdfDocument* parsed)
      : robot_(robot), parsed_(parsed), tree_(readUrdf(robot, &parsed->warnings)) {}

  std::unique_ptr<XmlDocument> run() {
    XmlElement* const sdf = document_->NewElement("sdf");
    document_->InsertEndChild(sdf);
    sdf->SetAttribute("version", "1.9");
    model_ = insert(sdf, "model", robot_);
    model_->SetAttribute("name", attributeOf(robot_, "name").c_str());
    write(tree_.root, nullptr);
    forEach(robot_, "gazebo", [&](const XmlElement& extension) {
      if (attributeOf(extension, "reference").empty()) copyParts(extension, model_);
    });
    return std::move(document_);
  }

 private:
  /// Inserts an element that comes from one of the URDF.
  XmlElement* insert(XmlElement* parent, const char* name, const XmlElement& from) {
    XmlElement* const child = parent->InsertNewChildElement(name);
    setLine(from, child);
    return child;
  }

  /// Gives an element and its contents the line of an element of the URDF.
  void setLine(const XmlElement& from, XmlElement* element) {
    parsed_->sources.push_back({"", from.GetLineNum()});
    forAll(element, [&](XmlElement* part) { part->SetUserData(&parsed_->sources.back()); });
  }

  XmlElement* add(XmlElement* parent, const char* name, const std::string& text) {
    XmlElement* const child = parent->InsertNewChildElement(name);
    child->SetUserData(parent->GetUserData());
    child->SetText(text.c_str());
    return child;
  }

  /// Writes quaternions, since angles would be rounded.
  XmlElement* addPose(XmlElement* parent, const Pose& pose) {
    const Quaternion& q = pose.Rot();
    std::string text;
    for (const double number : {pose.X(), pose.Y(), pose.Z(), q.X(), q.Y(), q.Z(), q.W()}) {
      text += (text.empty() ? "" : " ") + exact(number);
    }
    XmlElement* const element = add(parent, "pose", text);
    element->SetAttribute("rotation_format", "quat_xyzw");
    return element;
  }

  void write(const std::string& name, const UrdfJoint* by) {
    const UrdfLink& link = tree_.links.at(name);
    if (name != "world") {
      if (!link.has_inertia || link.inertia.mass == 0) return;
      writeLink(link, by);
      if (by) writeJoint(*by);
    }
    for (const std::string& child : link.children) {
      const UrdfJoint& joint = tree_.joints.at(child);
      write(joint.child, &joint);
    }
  }

  void writeLink(const UrdfLink& from, const UrdfJoint* by) {
    XmlElement* const link = insert(model_, "link", *from.element);
    link->SetAttribute("name", from.name.c_str());
    if (by) addPose(link, Pose::Zero)->SetAttribute("relative_to", by->name.c_str());
    writeInertia(from, link);
    int count = 0;
    for (const UrdfShape& shape : from.collisions) {
      writeFriction(shape, writeShape(from, shape, "collision", count++, link));
    }
    count = 0;
    for (const UrdfShape& shape : from.visuals) {
      writeColour(shape, writeShape(from, shape, "visual", count++, link));
    }
    for (const UrdfExtension& extension : from.extensions) writeExtension(extension, link);
  }

  void writeInertia(const UrdfLink& of, XmlElement* link) {
    const UrdfInertia& from = of.inertia;
    const XmlElement* const own = of.element->FirstChildElement("inertial");
    const XmlElement& geometry = own ? *own : *of.element;
    XmlElement* const inertial = insert(link, "inertial", geometry);
    addPose(inertial, from.pose);
    add(inertial, "mass", exact(from.mass));
    XmlElement* const inertia = insert(inertial, "inertia", geometry);
    const Vector3 &m = from.moments, &p = from.products;
    const std::pair<const char*, double> parts[] = {{"ixx", m.X()}, {"iyy", m.Y()}, {"izz", m.Z()},
                                                    {"ixy", p.X()}, {"ixz", p.Y()}, {"iyz", p.Z()}};
    for (const auto& [name, value] : parts) add(inertia, name, exact(value));
  }

  XmlElement* writeShape(const UrdfLink& link, const UrdfShape& from, const std::string& kind,
                         int count, XmlElement* to) {
    std::string name = from.name + "_" + kind + (count > 0 ? "_" + std::to_string(count) : "");
    if (!startsWith(name, link.name)) name = link.name + "_fixed_joint_lump__" + name;
    XmlElement* const shape = insert(to, kind.c_str(), *from.element);
    shape->SetAttribute("name", name.c_str());
    addPose(shape, from.pose);
    const XmlElement* const child = from.element->FirstChildElement("geometry");
    XmlElement* const geometry = insert(shape, "geometry", child ? *child : *from.element);
    if (child && child->FirstChildElement()) writeGeometry(*child->FirstChildElement(), geometry);
    return shape;
  }

  void writeGeometry(const XmlElement& from, XmlElement* geometry) {
    XmlElement* const shape = insert(geometry, from.Name(), from);
    for (const char* size : {"size", "radius", "length", "scale"}) {
      if (from.Attribute(size)) add(shape, size, attributeOf(from, size));
    }
    if (!from.Attribute("filename")) return;
    std::string uri = attributeOf(from, "filename");
    const std::string package = "package://";
    if (startsWith(uri, package)) uri = "model://" + uri.substr(package.size());
    add(shape, "uri", uri);
  }

  /// Returns the last element of that key in `<gazebo reference="NAME">` of a link or a joint.
  const XmlElement* extensionOf(const std::string& name, const char* key) const {
    const XmlElement* element = nullptr;
    forEach(robot_, "gazebo", [&](const XmlElement& extension) {
      if (attributeOf(extension, "reference") != name) return;
      if (const XmlElement* const own = extension.FirstChildElement(key)) element = own;
    });
    return element;
  }

  void writeFriction(const UrdfShape& from, XmlElement* collision) {
    const XmlElement* const along = extensionOf(from.from, "mu1");
    const XmlElement* const across = extensionOf(from.from, "mu2");
    if (!along && !across) return;
    const XmlElement& axis = along ? *along : *across;
    XmlElement* const surface = insert(collision, "surface", axis);
    XmlElement* const ode = insert(insert(surface, "friction", axis), "ode", axis);
    if (along) add(ode, "mu", valueOf(along));
    if (across) add(ode, "mu2", valueOf(across));
  }

  void writeColour(const UrdfShape& from, XmlElement* visual) {
    const XmlElement* material = from.element->FirstChildElement("material");
    if (!material) return;
    const std::string name = attributeOf(*material, "name");
    if (!material->FirstChildElement("color")) {
      forEach(robot_, "material", [&](const XmlElement& shared) {
        if (attributeOf(shared, "name") == name) material = &shared;
      });
    }
    const XmlElement* const colour = material->FirstChildElement("color");
    if (!colour) return;
    XmlElement* const out = insert(visual, "material", *material);
    for (const char* kind : {"diffuse", "ambient"}) add(out, kind, attributeOf(*colour, "rgba"));
  }

  /// Returns whether SDF has another word for a part, or none.
  static bool isOfUrdf(const XmlElement& part) {
    static constexpr const char* kNames[] = {"material",
                                             "mu1",
                                             "mu2",
                                             "kp",
                                             "kd",
                                             "maxVel",
                                             "minDepth",
                                             "maxContacts",
                                             "laserRetro",
                                             "fdir1",
                                             "stopCfm",
                                             "stopErp",
                                             "selfCollide",
                                             "turnGravityOff",
                                             "dampingFactor",
                                             "static",
                                             "stopKp",
                                             "stopKd",
                                             "initialJointPosition",
                                             "fudgeFactor",
                                             "provideFeedback",
                                             "implicitSpringDamper",
                                             "springReference",
                                             "springStiffness",
                                             "preserveFixedJoint",
                                             "disableFixedJointLumping"};
    return std::any_of(std::begin(kNames), std::end(kNames),
                       [&](const char* name) { return is(part, name); });
  }

  void writeExtension(const UrdfExtension& from, XmlElement* link) {
    const auto says = [&](const char* name) {
      return readFlag(valueOf(from.element->FirstChildElement(name))).value_or(false);
    };
    if (says("turnGravityOff")) add(link, "gravity", "false");
    if (says("selfCollide")) add(link, "self_collide", "true");
    for (const XmlElement* part = from.element->FirstChildElement(); part;
         part = part->NextSiblingElement()) {
      if (isOfUrdf(*part)) continue;
      XmlElement* const copy = copyInto(*part, link);
      if (!from.is_lumped || !is(*copy, "sensor")) continue;
      const Pose pose = from.pose * valueOfPose(copy->FirstChildElement("pose"));
      if (XmlElement* const own = copy->FirstChildElement("pose")) copy->DeleteChild(own);
      add(copy, "pose", exact(pose.Pos()) + ' ' + exact(pose.Rot().Euler()));
    }
  }

  void copyParts(const XmlElement& extension, XmlElement* to) {
    for (const XmlElement* part = extension.FirstChildElement(); part;
         part = part->NextSiblingElement()) {
      if (is(*part, "static") || !isOfUrdf(*part)) copyInto(*part, to);
    }
  }

  XmlElement* copyInto(const XmlElement& from, XmlElement* to) {
    XmlElement* const copy = from.DeepClone(document_.get())->ToElement();
    to->InsertEndChild(copy);
    setLine(from, copy);
    if (is(*copy, "plugin")) renameBodies(copy);
    return copy;
  }

  /// Renames a lumped link in a plugin to the link that holds its parts now, with the lumped link's
  /// offset in it.
  void renameBodies(XmlElement* plugin) {
    for (const char* name : {"bodyName", "frameName"}) {
      XmlElement* const body = plugin->FirstChildElement(name);
      const auto place = body ? tree_.lumped.find(contentOf(body)) : tree_.lumped.end();
      if (place == tree_.lumped.end()) continue;
      body->SetText(place->second.link.c_str());
      addOffset(place->second.pose, plugin);
    }
  }

  void addOffset(const Pose& pose, XmlElement* plugin) {
    const Vector3 rpy = vectorIn(*plugin, "rpyOffset", Vector3::Zero);
    const Pose own(vectorIn(*plugin, "xyzOffset", Vector3::Zero),
                   Quaternion(rpy.X(), rpy.Y(), rpy.Z()));
    const Pose offset = pose * own;
    constexpr char kDone[] = "ignition::corrected_offsets";  // the name in Gazebo
    for (const char* name : {"xyzOffset", "rpyOffset", kDone}) {
      if (XmlElement* const child = plugin->FirstChildElement(name)) plugin->DeleteChild(child);
    }
    add(plugin, "xyzOffset", exact(offset.Pos()));
    add(plugin, "rpyOffset", exact(offset.Rot().Euler()));
    add(plugin, kDone, "1");
  }

  void writeJoint(const UrdfJoint& from) {
    if (from.type == "floating" || from.type == "planar") return;
    XmlElement* const joint = insert(model_, "joint", *from.element);
    joint->SetAttribute("name", from.name.c_str());
    const bool is_continuous = from.type == "continuous";
    joint->SetAttribute("type", is_continuous ? "revolute" : from.type.c_str());
    const std::string around = from.parent == "world" ? "__model__" : from.parent;
    addPose(joint, from.pose)->SetAttribute("relative_to", around.c_str());
    add(joint, "parent", from.parent);
    add(joint, "child", from.child);
    if (from.type != "fixed") writeAxis(*from.element, is_continuous, joint);
  }

  void writeAxis(const XmlElement& from, bool is_continuous, XmlElement* joint) {
    const XmlElement* const child = from.FirstChildElement("axis");
    XmlElement* const axis = insert(joint, "axis", child ? *child : from);
    add(axis, "xyz", child && child->Attribute("xyz") ? attributeOf(*child, "xyz") : "1 0 0");
    const XmlElement* const limit = from.FirstChildElement("limit");
    XmlElement* const limits = insert(axis, "limit", limit ? *limit : from);
    const auto text = [](const XmlElement* element, const char* name,
                         const std::string& otherwise) {
      return element && element->Attribute(name) ? attributeOf(*element, name) : otherwise;
    };
    add(limits, "lower", is_continuous ? std::string("-") + kNoLimit : text(limit, "lower", "0"));
    add(limits, "upper", is_continuous ? kNoLimit : text(limit, "upper", "0"));
    for (const char* most : {"effort", "velocity"}) {
      if (limit && limit->Attribute(most)) add(limits, most, attributeOf(*limit, most));
    }
    const XmlElement* const dynamics = from.FirstChildElement("dynamics");
    XmlElement* const out = insert(axis, "dynamics", dynamics ? *dynamics : from);
    for (const char* name : {"damping", "friction"}) add(out, name, text(dynamics, name, "0"));
    const std::string joint_name = attributeOf(from, "name");
    for (const auto& [key, name] : {std::pair{"springStiffness", "spring_stiffness"},
                                    {"springReference", "spring_reference"}}) {
      if (const auto* spring = extensionOf(joint_name, key)) add(out, name, valueOf(spring));
    }
  }

  const XmlElement& robot_;
  SdfDocument* const parsed_;
  const UrdfTree tree_;
  std::unique_ptr<XmlDocument> document_ = std::make_unique<XmlDocument>();
  XmlElement* model_ = nullptr;
};

}  // namespace

std::unique_ptr<XmlDocument> sdfFromUrdf(const XmlDocument& urdf, SdfDocument* parsed) {
  return SdfWriter(*urdf.RootElement(), parsed).run();
}

}  // namespace kiva
