// SPDX-License-Identifier: Apache-2.0
#include "world_file/sdf/shapes.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>

#include "world_file/elements/values.h"
#include "world_file/files/model_paths.h"
#include "world_file/mesh/extrusion.h"
#include "world_file/mesh/mesh_file.h"

namespace kiva {
namespace {

constexpr std::size_t kMostPoints = 2000;  // limit of a polyline

const XmlElement& required(const XmlElement& parent, const char* name) {
  const XmlElement* const child = parent.FirstChildElement(name);
  if (!child) failAt(parent, "expected <" + std::string(name) + "> in <" + parent.Name() + ">");
  return *child;
}

void checkPositive(const XmlElement& element, double value) {
  if (std::isfinite(value) && value > 0) return;
  failAt(element, "expected lengths above 0 m, found " + contentOf(&element));
}

double length(const XmlElement& parent, const char* name) {
  const XmlElement& element = required(parent, name);
  const double value = *readDouble(contentOf(&element));
  checkPositive(element, value);
  return value;
}

Vector3 lengths(const XmlElement& parent, const char* name) {
  const XmlElement& element = required(parent, name);
  const Vector3 value = vectorIn(element);
  for (const double part : {value.X(), value.Y(), value.Z()}) checkPositive(element, part);
  return value;
}

/// Returns the folder of the document that holds an element: that of its own file, or of the
/// caller's text.
std::string folderOf(const XmlElement& element, const Origin& origin) {
  const Source* const source = sourceOf(element);
  const bool is_included = source && !source->file.empty();
  return std::filesystem::path(is_included ? source->file : origin.where).parent_path().string();
}

Vector3 scaleOf(const XmlElement& mesh) {
  const Vector3 scale = vectorIn(mesh, "scale", Vector3::One);
  const bool is_fit = scale.IsFinite() && scale.X() * scale.Y() * scale.Z() != 0;
  if (!is_fit) failAt(*mesh.FirstChildElement("scale"), "expected a finite scale other than 0");
  return scale;
}

MeshRequest requestOf(const XmlElement& mesh) {
  MeshRequest request;
  request.scale = scaleOf(mesh);
  if (const XmlElement* const submesh = mesh.FirstChildElement("submesh")) {
    request.submesh = contentOf(submesh->FirstChildElement("name"));
    request.is_centred = flagIn(*submesh, "center", false);
  }
  return request;
}

Shape readMeshShape(const XmlElement& mesh, const Origin& origin, MeshUse use) {
  const std::string uri = contentOf(&required(mesh, "uri"));
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

Vector2 pairIn(const XmlElement& element) {
  Vector2 pair;
  std::istringstream(contentOf(&element)) >> pair.x >> pair.y;
  return pair;
}

std::vector<Vector2> pointsOf(const XmlElement& polyline) {
  std::vector<Vector2> points;
  for (const XmlElement* point = polyline.FirstChildElement("point"); point;
       point = point->NextSiblingElement("point")) {
    points.push_back(pairIn(*point));
    const bool is_finite = std::isfinite(points.back().x) && std::isfinite(points.back().y);
    if (!is_finite) failAt(*point, "expected finite numbers");
    if (points.size() > kMostPoints) failAt(polyline, "expected at most 2000 points");
  }
  return points;
}

/// Reads one or several `<polyline>`; each is extruded.
void readPolylines(const XmlElement& first, Shape* shape) {
  auto mesh = std::make_shared<Mesh>();
  for (const XmlElement* polyline = &first; polyline;
       polyline = polyline->NextSiblingElement("polyline")) {
    const double height = length(*polyline, "height");
    if (extrude(pointsOf(*polyline), height, mesh.get())) continue;
    failAt(*polyline, "expected three <point>s or more that span an area");
  }
  measure(mesh.get());
  shape->mesh = mesh;
}

void readPlane(const XmlElement& plane, Shape* shape) {
  shape->normal = vectorIn(plane, "normal", Vector3::UnitZ);
  if (!(shape->normal.Length() > 0) || !shape->normal.IsFinite()) {
    failAt(*plane.FirstChildElement("normal"), "expected a normal that points somewhere");
  }
  shape->normal.Normalize();
  const XmlElement* const normal = plane.FirstChildElement("size");
  const Vector2 size = normal ? pairIn(*normal) : Vector2{1, 1};
  if (normal) checkPositive(*normal, size.x);
  if (normal) checkPositive(*normal, size.y);
  shape->plane_size[0] = size.x;
  shape->plane_size[1] = size.y;
}

/// A kind of shape and its reader. A kind that is not in the table is refused by name.
struct ShapeReader {
  const char* element;
  Shape::Kind kind;
  void (*read)(const XmlElement&, Shape*);
};

void readRound(const XmlElement& element, Shape* shape) {
  shape->radius = length(element, "radius");
  shape->length = length(element, "length");
}

const ShapeReader kReaders[] = {
    {"box", Shape::Kind::kBox,
     [](const XmlElement& e, Shape* shape) { shape->size = lengths(e, "size"); }},
    {"sphere", Shape::Kind::kSphere,
     [](const XmlElement& e, Shape* shape) { shape->radius = length(e, "radius"); }},
    {"cylinder", Shape::Kind::kCylinder, readRound},
    {"capsule", Shape::Kind::kCapsule, readRound},
    {"ellipsoid", Shape::Kind::kEllipsoid,
     [](const XmlElement& e, Shape* shape) { shape->size = lengths(e, "radii"); }},
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

/// Reads a number in `lower`…`upper` at `parent`/`name`, if there is one.
void readWithin(const XmlElement* parent, const char* name, double lower, double upper,
                double* value, Faults* warnings) {
  const XmlElement* const element = parent ? parent->FirstChildElement(name) : nullptr;
  if (!element) return;
  const double number = readDouble(contentOf(element)).value_or(*value);
  if (number >= lower && number <= upper) {
    *value = number;
    return;
  }
  const std::string range = std::isfinite(upper) ? "from 0 to 1" : "of 0 or above";
  warnings->push_back(noteAt(*element, "this " + std::string(name) +
                                           " is left out: expected a number " + range + ", found " +
                                           contentOf(element)));
}

const XmlElement* descend(const XmlElement& from, std::initializer_list<const char*> path) {
  const XmlElement* element = &from;
  for (const char* name : path) {
    if (element) element = element->FirstChildElement(name);
  }
  return element;
}

}  // namespace

std::optional<Shape> readShape(const XmlElement& owner, const Origin& origin, MeshUse use) {
  const XmlElement& geometry = required(owner, "geometry");
  const XmlElement* const element = geometry.FirstChildElement();
  if (!element) failAt(geometry, "expected a shape: " + supported());
  if (is(*element, "empty")) return std::nullopt;
  if (is(*element, "mesh")) return readMeshShape(*element, origin, use);
  const auto reader =
      std::find_if(std::begin(kReaders), std::end(kReaders),
                   [&](const ShapeReader& known) { return is(*element, known.element); });
  if (reader == std::end(kReaders)) {
    failAt(*element,
           "<" + std::string(element->Name()) + "> is not supported; expected " + supported());
  }
  Shape shape;
  shape.kind = reader->kind;
  reader->read(*element, &shape);
  return shape;
}

void readSurface(const XmlElement& element, Collision* collision, Faults* warnings) {
  constexpr double kUnlimited = std::numeric_limits<double>::infinity();
  const XmlElement* const ode = descend(element, {"surface", "friction", "ode"});
  const XmlElement* const bullet = descend(element, {"surface", "friction", "bullet"});
  readWithin(bullet, "friction", 0, kUnlimited, &collision->friction, warnings);
  readWithin(ode, "mu", 0, kUnlimited, &collision->friction, warnings);
  double across = collision->friction;
  readWithin(ode, "mu2", 0, kUnlimited, &across, warnings);
  if (across != collision->friction) {
    warnings->push_back(noteAt(*ode, "mu2 is left out: friction is the same in every direction"));
  }
  readWithin(descend(element, {"surface", "bounce"}), "restitution_coefficient", 0, 1,
             &collision->restitution, warnings);
}

void readMaterial(const XmlElement& element, Visual* visual, Faults* warnings) {
  const XmlElement* const material = element.FirstChildElement("material");
  for (const char* name : {"diffuse", "ambient"}) {
    const XmlElement* const child = material ? material->FirstChildElement(name) : nullptr;
    const auto colour = child ? readColour(contentOf(child)) : std::nullopt;
    if (!colour) continue;
    for (const int i : {0, 1, 2, 3}) visual->rgba[i] = std::clamp<double>((*colour)[i], 0, 1);
    break;
  }
  double transparency = 0;
  readWithin(&element, "transparency", 0, 1, &transparency, warnings);
  visual->rgba[3] *= 1 - transparency;
}

}  // namespace kiva
