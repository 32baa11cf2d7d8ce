// SPDX-License-Identifier: Apache-2.0
#include "world_file/shapes.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <ignition/math/Color.hh>
#include <ignition/math/Vector2.hh>
#include <limits>

#include "world_file/checks.h"
#include "world_file/errors.h"
#include "world_file/extrusion.h"
#include "world_file/from_sdformat.h"
#include "world_file/mesh_file.h"
#include "world_file/model_paths.h"

namespace kiva {
namespace {

using ignition::math::Color;

constexpr std::size_t kMostPoints = 2000;  // of a polyline

sdf::ElementPtr required(const sdf::ElementPtr& parent, const std::string& name) {
  const sdf::ElementPtr child = givenChild(parent, name);
  if (!child) failAt(parent, "expected <" + name + "> in <" + parent->GetName() + ">");
  return child;
}

void checkPositive(const sdf::ElementPtr& element, double value) {
  if (std::isfinite(value) && value > 0) return;
  failAt(element, "expected lengths above 0 m, found " + element->GetValue()->GetAsString());
}

double length(const sdf::ElementPtr& parent, const std::string& name) {
  const sdf::ElementPtr element = required(parent, name);
  const double value = element->Get<double>();
  checkPositive(element, value);
  return value;
}

Vector3 lengths(const sdf::ElementPtr& parent, const std::string& name) {
  const sdf::ElementPtr element = required(parent, name);
  const Vector3 value = vectorIn(element);
  for (const double part : {value.X(), value.Y(), value.Z()}) checkPositive(element, part);
  return value;
}

/// The document that an element stands in: its own file, or the text that was given.
std::string folderOf(const sdf::ElementPtr& element, const Origin& origin) {
  const std::string& file = element->FilePath();
  const bool is_text = file.empty() || file[0] == '<';  // libsdformat's <data-string>
  return std::filesystem::path(is_text ? origin.where : file).parent_path().string();
}

Vector3 scaleOf(const sdf::ElementPtr& mesh) {
  const Vector3 scale = vectorIn(mesh, "scale", Vector3::One);
  const bool is_fit = scale.IsFinite() && scale.X() * scale.Y() * scale.Z() != 0;
  if (!is_fit) failAt(mesh->FindElement("scale"), "expected a finite scale other than 0");
  return scale;
}

MeshRequest requestOf(const sdf::ElementPtr& mesh) {
  MeshRequest request;
  request.scale = scaleOf(mesh);
  if (const sdf::ElementPtr submesh = givenChild(mesh, "submesh")) {
    request.submesh = submesh->Get<std::string>("name");
    request.is_centred = submesh->Get<bool>("center", false).first;
  }
  return request;
}

Shape readMeshShape(const sdf::ElementPtr& mesh, const Origin& origin, MeshUse use) {
  const std::string uri = required(mesh, "uri")->Get<std::string>();
  const std::string folder = folderOf(mesh, origin);
  MeshRequest request = requestOf(mesh);
  request.file = findFile(uri, folder, origin.model_paths);
  if (request.file.empty()) failAt(mesh, fileNotFound(uri, folder, origin.model_paths));
  Shape shape;
  shape.kind = Shape::Kind::kMesh;
  shape.mesh_file = request.file;
  shape.mesh_scale = request.scale;
  try {
    if (use == MeshUse::kTouched) shape.mesh = readMesh(request);
  } catch (const DescriptionError& error) {
    failAt(mesh, "mesh " + request.file + ": " + error.what());
  }
  return shape;
}

std::vector<Vector2> pointsOf(const sdf::ElementPtr& polyline) {
  std::vector<Vector2> points;
  auto point = polyline->FindElement("point");
  for (; point; point = point->GetNextElement("point")) {
    const auto at = point->Get<ignition::math::Vector2d>();
    points.push_back({at.X(), at.Y()});
    if (!at.IsFinite()) failAt(point, "expected finite numbers");
    if (points.size() > kMostPoints) failAt(polyline, "expected 2000 points at the most");
  }
  return points;
}

/// One `<polyline>` or several: each is extruded.
void readPolylines(const sdf::ElementPtr& first, Shape* shape) {
  auto mesh = std::make_shared<Mesh>();
  for (auto polyline = first; polyline; polyline = polyline->GetNextElement("polyline")) {
    const double height = length(polyline, "height");
    if (extrude(pointsOf(polyline), height, mesh.get())) continue;
    failAt(polyline, "expected three <point>s or more that span an area");
  }
  measure(mesh.get());
  shape->mesh = mesh;
}

void readPlane(const sdf::ElementPtr& plane, Shape* shape) {
  shape->normal = vectorIn(plane, "normal", Vector3::UnitZ);
  if (!(shape->normal.Length() > 0) || !shape->normal.IsFinite()) {
    failAt(plane->FindElement("normal"), "expected a normal that points somewhere");
  }
  shape->normal.Normalize();
  const auto size = plane->Get("size", ignition::math::Vector2d::One).first;
  for (const int i : {0, 1}) {
    if (plane->HasElement("size")) checkPositive(plane->FindElement("size"), size[i]);
    shape->plane_size[i] = size[i];
  }
}

/// What we can build, in one place: a kind that is not in the table is refused by name.
struct ShapeReader {
  const char* element;
  Shape::Kind kind;
  void (*read)(const sdf::ElementPtr&, Shape*);
};

void readRound(const sdf::ElementPtr& element, Shape* shape) {
  shape->radius = length(element, "radius");
  shape->length = length(element, "length");
}

const ShapeReader kReaders[] = {
    {"box", Shape::Kind::kBox,
     [](const sdf::ElementPtr& e, Shape* shape) { shape->size = lengths(e, "size"); }},
    {"sphere", Shape::Kind::kSphere,
     [](const sdf::ElementPtr& e, Shape* shape) { shape->radius = length(e, "radius"); }},
    {"cylinder", Shape::Kind::kCylinder, readRound},
    {"capsule", Shape::Kind::kCapsule, readRound},
    {"ellipsoid", Shape::Kind::kEllipsoid,
     [](const sdf::ElementPtr& e, Shape* shape) { shape->size = lengths(e, "radii"); }},
    {"plane", Shape::Kind::kPlane, readPlane},
    {"polyline", Shape::Kind::kMesh, readPolylines},
};

std::string supported() {
  std::string list;
  for (const ShapeReader& reader : kReaders) {
    list += std::string(reader.element) + ", ";
  }
  return list + "mesh";
}

/// A number in `lower`…`upper` at `parent`/`name`, if it is there.
void readWithin(const sdf::ElementPtr& parent, const std::string& name, double lower, double upper,
                double* value, sdf::Errors* warnings) {
  if (!parent || !parent->HasElement(name)) return;
  const sdf::ElementPtr element = parent->FindElement(name);
  const double given = element->Get<double>();
  if (given >= lower && given <= upper) {
    *value = given;
    return;
  }
  const std::string range = std::isfinite(upper) ? "from 0 to 1" : "of 0 or above";
  warnings->push_back(noteAt(element, "this " + name + " is left out: expected a number " + range +
                                          ", found " + element->GetValue()->GetAsString()));
}

sdf::ElementPtr descend(sdf::ElementPtr element, std::initializer_list<const char*> path) {
  for (const char* name : path) {
    if (element) element = element->FindElement(name);
  }
  return element;
}

}  // namespace

std::optional<Shape> readShape(const sdf::ElementPtr& owner, const Origin& origin, MeshUse use) {
  const sdf::ElementPtr geometry = required(owner, "geometry");
  const sdf::ElementPtr element = geometry->GetFirstElement();
  if (!element) failAt(geometry, "expected a shape: " + supported());
  if (element->GetName() == "empty") return std::nullopt;
  if (element->GetName() == "mesh") return readMeshShape(element, origin, use);
  const auto reader =
      std::find_if(std::begin(kReaders), std::end(kReaders),
                   [&](const ShapeReader& known) { return element->GetName() == known.element; });
  if (reader == std::end(kReaders)) {
    failAt(element, "<" + element->GetName() + "> is not supported; expected " + supported());
  }
  Shape shape;
  shape.kind = reader->kind;
  reader->read(element, &shape);
  return shape;
}

void readSurface(const sdf::ElementPtr& element, Collision* collision, sdf::Errors* warnings) {
  constexpr double kUnlimited = std::numeric_limits<double>::infinity();
  const sdf::ElementPtr ode = descend(element, {"surface", "friction", "ode"});
  const sdf::ElementPtr bullet = descend(element, {"surface", "friction", "bullet"});
  readWithin(bullet, "friction", 0, kUnlimited, &collision->friction, warnings);
  readWithin(ode, "mu", 0, kUnlimited, &collision->friction, warnings);
  double across = collision->friction;
  readWithin(ode, "mu2", 0, kUnlimited, &across, warnings);
  if (across != collision->friction) {
    warnings->push_back(noteAt(ode, "mu2 is left out: friction is the same in every direction"));
  }
  readWithin(descend(element, {"surface", "bounce"}), "restitution_coefficient", 0, 1,
             &collision->restitution, warnings);
}

void readMaterial(const sdf::ElementPtr& element, Visual* visual, sdf::Errors* warnings) {
  const sdf::ElementPtr material = element->FindElement("material");
  for (const char* name : {"diffuse", "ambient"}) {
    if (!material || !material->HasElement(name)) continue;
    Color colour = material->Get<Color>(name);  // Its operator[] is not const.
    for (const int i : {0, 1, 2, 3}) visual->rgba[i] = std::clamp<double>(colour[i], 0, 1);
    break;
  }
  double transparency = 0;
  readWithin(element, "transparency", 0, 1, &transparency, warnings);
  visual->rgba[3] *= 1 - transparency;
}

}  // namespace kiva
