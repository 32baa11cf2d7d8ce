// SPDX-License-Identifier: Apache-2.0
//
// What a world is made of, as plain structs: filled from SDF by world_file.h, or by hand, and
// read once when a model is built. SI units and radians; poses are right-handed, z up (REP 103).
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/geometry.h"
#include "kiva_plugin_cpp/parameters.h"
#include "kiva_plugin_cpp/people.h"

namespace kiva {

// Limits of a world.
constexpr double kLeastStep = 1e-6, kMostStep = 1;                 ///< [s]
constexpr double kMostGravity = 1000;                              ///< Largest magnitude [m/s²].
constexpr double kMostFriction = 10;                               ///< Coulomb coefficient.
constexpr double kLeastGridSpacing = 0.1, kMostGridSpacing = 100;  ///< [m]

/// Triangles; shapes of one file share them.
struct Mesh {
  std::vector<Vector3> vertices;              ///< [m]
  std::vector<std::array<int, 3>> triangles;  ///< Indices of vertices, counterclockwise outside.
  Vector3 min, max;                           ///< The box around the vertices [m].
};

/// A primitive, centred on its own origin, or a mesh; cylinders and capsules stand along z.
struct Shape {
  enum class Kind { kBox, kSphere, kCylinder, kCapsule, kEllipsoid, kPlane, kMesh };
  Kind kind = Kind::kBox;
  Vector3 size{1, 1, 1};    ///< Box: full edge lengths [m]. Ellipsoid: the three radii [m].
  double radius = 0.5;      ///< Sphere, cylinder, capsule [m].
  double length = 1.0;      ///< Cylinder; capsule without its caps [m].
  Vector3 normal{0, 0, 1};  ///< Plane: unit normal in its own frame.
  double plane_size[2] = {100, 100};  ///< Plane: extent along x and y of its own frame [m].
  /// Mesh: static models are touched as the mesh is, others by its convex hull. Scale and unit are
  /// applied. Null in a visual whose link has a collision: pictures show the collision.
  std::shared_ptr<const Mesh> mesh;
  std::string mesh_file;        ///< Mesh: the path it was read from; empty: extruded.
  Vector3 mesh_scale{1, 1, 1};  ///< Mesh: what the file's lengths were multiplied by.
};

/// A shape that touches others.
struct Collision {
  std::string name;
  Pose pose_in_link;
  Shape shape;
  double friction = 1.0;  ///< Coulomb coefficient; the smaller one of two surfaces counts.
  double restitution =
      0.0;  ///< 0 = no bounce, 1 = elastic; the smaller one of two surfaces counts.
};

/// A shape that is visible and touches nothing.
struct Visual {
  std::string name;
  Pose pose_in_link;
  Shape shape;
  double rgba[4] = {0.7, 0.7, 0.7, 1.0};  ///< Each in 0…1.
};

struct Link {
  std::string name;  ///< Links of a nested model are named `nested::link`.
  Pose pose_in_model;
  double mass = 1.0;           ///< [kg], > 0.
  Pose inertial_pose_in_link;  ///< Pose of the centre of mass, turned to the principal axes.
  Vector3 principal_moments{1, 1, 1};  ///< Moments about that centre, along those axes [kg m²].
  bool gravity = true;
  bool self_collide =
      false;  ///< Whether it touches other links of its model that no joint connects to it.
  std::vector<Collision> collisions;
  std::vector<Visual> visuals;
};

struct Joint {
  enum class Kind { kFixed, kRevolute, kContinuous, kPrismatic, kBall };
  std::string name;
  Kind kind = Kind::kFixed;
  std::string parent;  ///< A link's name, or "world".
  std::string child;
  Vector3 anchor_in_model;         ///< Position of the joint with all joints at zero.
  Vector3 axis_in_model{0, 0, 1};  ///< Unit vector with all joints at zero.
  double lower = -1e16;            ///< [rad] or [m].
  double upper = 1e16;             ///< [rad] or [m].
  double max_effort = -1;          ///< [Nm] or [N]; negative = unlimited.
  double max_velocity = -1;        ///< [rad/s] or [m/s]; negative = unlimited.
  double damping = 0;              ///< [Nm s/rad] or [N s/m].
  double friction = 0;             ///< Dry friction [Nm] or [N].
  double stiffness = 0;            ///< Spring constant [Nm/rad] or [N/m]; 0 = no spring.
  double spring_reference = 0;     ///< Position at which the spring is relaxed [rad] or [m].

  /// Returns whether the joint turns or slides along an axis, with a position and a rate.
  bool hasAxis() const { return kind != Kind::kFixed && kind != Kind::kBall; }
};

/// A `<plugin>` element of a model or a world.
struct PluginDescription {
  std::string name;
  std::string filename;
  Parameters parameters;
};

/// A `<sensor>` of a link, as the plugins in it need it.
struct SensorDescription {
  std::string name;
  std::string type;  ///< Type in SDF: ray, imu, contact, …
  std::string link;
  Pose pose_in_link;
  double update_rate = 0;  ///< [Hz] of simulated time, 0 = every step.
  Parameters parameters;   ///< The text of every element in it, by path: `ray/range/max`.
  std::vector<PluginDescription> plugins;
};

/// A light. Clients can set and read it; nothing is rendered.
struct Light {
  enum class Kind { kPoint, kSpot, kDirectional };
  std::string name;
  Kind kind = Kind::kPoint;
  Pose pose;                         ///< In world.
  double diffuse[4] = {1, 1, 1, 1};  ///< Red, green, blue, alpha; each in 0…1.
  double specular[4] = {0.1, 0.1, 0.1, 1};
  double attenuation_constant = 1;
  double attenuation_linear = 0;     ///< [1/m]
  double attenuation_quadratic = 0;  ///< [1/m²]
  Vector3 direction{0, 0, -1};
  bool cast_shadows = false;
};

/// A model without its name and place.
struct ModelDescription {
  bool is_static = false;
  std::vector<Link> links;  ///< The first is the canonical link.
  std::vector<Joint> joints;
  std::vector<PluginDescription> plugins;
  std::vector<SensorDescription> sensors;
  std::vector<std::string> nested_models;  ///< Names of the models inside, `a::b` for deeper ones.

  const Link* findLink(const std::string& name) const {
    for (const Link& link : links) {
      if (link.name == name) return &link;
    }
    return nullptr;
  }
  const Joint* findJoint(const std::string& name) const {
    for (const Joint& joint : joints) {
      if (joint.name == name) return &joint;
    }
    return nullptr;
  }
};

/// A model with a name and a place. Instances of one file share their description.
struct ModelInstance {
  std::string name;
  Pose pose;  ///< In world.
  std::shared_ptr<const ModelDescription> description;
  std::string
      robot_namespace{};       ///< Passed to its plugins as `robotNamespace`, unless they have one.
  std::optional<Walk> walk{};  ///< The walk of an `<actor>`, which is a person.
};

struct WorldDescription {
  std::string name = "default";
  Vector3 gravity{0, 0, -9.81};   ///< [m/s²]
  double step_size = 0.001;       ///< [s], > 0.
  double real_time_factor = 1.0;  ///< Simulated seconds a wall second; 0 = as fast as possible.
  std::vector<ModelInstance> models;
  std::vector<Light> lights;
  std::vector<PluginDescription> plugins;
};

}  // namespace kiva
