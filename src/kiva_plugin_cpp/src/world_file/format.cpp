// SPDX-License-Identifier: Apache-2.0
#include "world_file/format.h"

#include <algorithm>
#include <map>
#include <memory>
#include <sdf/Element.hh>
#include <sdf/Param.hh>
#include <sdf/parser.hh>
#include <set>

namespace kiva {
namespace {

/// libsdformat's own description of SDF. Building it takes 30 ms, copying it half of that.
const sdf::ElementPtr& format() {
  static const sdf::ElementPtr kFormat = [] {
    auto document = std::make_shared<sdf::SDF>();
    sdf::init(document);
    return document->Root();
  }();
  return kFormat;
}

/// Parts that SDF allows to be left out and that take the room.
constexpr const char* kLargeParts[] = {"actor",
                                       "atmosphere",
                                       "audio_sink",
                                       "audio_source",
                                       "battery",
                                       "gripper",
                                       "gui",
                                       "heightmap",
                                       "image",
                                       "joint",
                                       "light",
                                       "material",
                                       "particle_emitter",
                                       "physics",
                                       "polyline",
                                       "population",
                                       "projector",
                                       "road",
                                       "scene",
                                       "sensor",
                                       "state",
                                       "surface",
                                       "wind",
                                       "spherical_coordinates"};

std::set<std::string> absentParts(const std::string& text) {
  std::set<std::string> absent;
  for (const std::string name : kLargeParts) {
    if (text.find("<" + name) == std::string::npos) absent.insert(name);
  }
  // What libsdformat makes of a URDF's <mu1>, <implicitSpringDamper> and the like.
  if (text.find("<robot") != std::string::npos) {
    for (const char* made : {"surface", "physics"}) absent.erase(made);
  }
  return absent;
}

bool isOptional(const sdf::Element& element) {
  return element.GetRequired() == "0" || element.GetRequired() == "*";
}

void copyParam(const sdf::Param& from, sdf::Element* to, bool is_value) {
  const std::string& type = from.GetTypeName();
  const std::string value = from.GetDefaultAsString();
  if (!is_value) return to->AddAttribute(from.GetKey(), type, value, from.GetRequired());
  const auto least = from.GetMinValueAsString(), most = from.GetMaxValueAsString();
  to->AddValue(type, value, from.GetRequired(), least.value_or(""), most.value_or(""));
}

sdf::ElementPtr copyWithout(const std::set<std::string>& absent, const sdf::ElementPtr& from) {
  auto copy = std::make_shared<sdf::Element>();
  copy->SetName(from->GetName());
  copy->SetRequired(from->GetRequired());
  copy->SetCopyChildren(from->GetCopyChildren());
  copy->SetReferenceSDF(from->ReferenceSDF());
  for (const sdf::ParamPtr& attribute : from->GetAttributes()) {
    copyParam(*attribute, copy.get(), false);
  }
  if (from->GetValue()) copyParam(*from->GetValue(), copy.get(), true);
  for (unsigned i = 0; i < from->GetElementDescriptionCount(); ++i) {
    const sdf::ElementPtr part = from->GetElementDescription(i);
    if (isOptional(*part) && absent.count(part->GetName())) continue;
    copy->AddElementDescription(copyWithout(absent, part));
  }
  return copy;
}

}  // namespace

sdf::SDFPtr emptyDocument(const std::string& text) {
  auto document = std::make_shared<sdf::SDF>();
  document->Root(copyWithout(absentParts(text), format()));
  return document;
}

/// By hand: std::regex overflows the stack on names of a hundred thousand letters.
std::vector<PathStep> pathSteps(const std::string& xml_path) {
  constexpr char kName[] = "[@name=\"";
  std::vector<PathStep> steps;
  for (std::size_t at = 0; at < xml_path.size() && xml_path[at] == '/';) {
    const std::size_t stop = std::min(xml_path.find_first_of("/[", at + 1), xml_path.size());
    steps.push_back({xml_path.substr(at + 1, stop - at - 1), std::nullopt});
    at = stop;
    if (xml_path.compare(at, sizeof(kName) - 1, kName) == 0) {
      const std::size_t begin = at + sizeof(kName) - 1;
      const std::size_t end = std::min(xml_path.find("\"]", begin), xml_path.size());
      steps.back().name = xml_path.substr(begin, end - begin);
      at = end;
    }
    at = std::min(xml_path.find('/', at), xml_path.size());  // Behind `"]` or `[0]`.
  }
  return steps;
}

std::string expectedValue(const std::string& xml_path) {
  static const std::map<std::string, std::string> kWords = {
      {"double", "a number"},           {"float", "a number"},
      {"int", "a whole number"},        {"unsigned int", "a whole number of 0 or above"},
      {"bool", "true or false"},        {"vector2d", "two numbers"},
      {"vector3", "three numbers"},     {"pose", "six numbers, x y z roll pitch yaw"},
      {"color", "red green blue alpha"}};
  sdf::ElementPtr element = format();
  for (const PathStep& step : pathSteps(xml_path)) {
    if (step.element != "sdf" && element) element = element->GetElementDescription(step.element);
  }
  if (!element || !element->GetValue()) return "";
  const auto words = kWords.find(element->GetValue()->GetTypeName());
  return words == kWords.end() ? "" : words->second;
}

}  // namespace kiva
