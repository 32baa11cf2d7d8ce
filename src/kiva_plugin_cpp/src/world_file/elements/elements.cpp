// SPDX-License-Identifier: Apache-2.0
#include "world_file/elements/elements.h"

#include "world_file/elements/format.h"

namespace kiva {
namespace {

/// Returns the key of a repeated name, `name[2]`, `name[3]`, …, so that no value is lost.
std::string freeKey(const std::string& base, const Parameters& parameters) {
  std::string key = base;
  for (int count = 2; parameters.has(key); ++count) {
    key = base + "[" + std::to_string(count) + "]";
  }
  return key;
}

bool hasRequired(const ElementFormat& format) {
  for (const ElementFormat::Child& child : format.children) {
    if (child.isRequired()) return true;
  }
  return false;
}

/// Adds the defaults of a missing element that SDF requires.
void addDefaults(const ElementFormat& format, const std::string& path, Parameters* parameters) {
  const std::string key = freeKey(path + format.name, *parameters);
  if (!hasRequired(format)) {
    parameters->set(key, format.value ? defaultText(*format.value) : "");
    return;
  }
  for (const ElementFormat::Child& child : format.children) {
    if (child.isRequired()) addDefaults(*child.format, key + "/", parameters);
  }
}

/// Adds the text of `element` and of all below it. `format` is null for an element that SDF does
/// not know.
void addParameters(const XmlElement& element, const ElementFormat* format, const std::string& path,
                   Parameters* parameters) {
  for (const XmlElement* child = element.FirstChildElement(); child;
       child = child->NextSiblingElement()) {
    const auto* const known = format && !format->is_open ? format->child(child->Name()) : nullptr;
    const ElementFormat* const below = known ? known->format : nullptr;
    const std::string key = freeKey(path + child->Name(), *parameters);
    if (child->FirstChildElement() || (below && hasRequired(*below))) {
      addParameters(*child, below, key + "/", parameters);
    } else {
      const std::string text = contentOf(child);
      const bool is_default = text.empty() && below && below->value;
      parameters->set(key, is_default ? defaultText(*below->value) : text);
    }
  }
  if (!format) return;
  for (const ElementFormat::Child& child : format->children) {
    const bool is_missing =
        child.isRequired() && !element.FirstChildElement(child.format->name.c_str());
    if (is_missing) addDefaults(*child.format, path, parameters);
  }
}

const ElementFormat* formatOf(const XmlElement& element) {
  const XmlElement* const around = element.Parent() ? element.Parent()->ToElement() : nullptr;
  if (!around) return &sdfFormat();
  const ElementFormat* const format = formatOf(*around);
  const auto* const own = format ? format->child(element.Name()) : nullptr;
  return own ? own->format : nullptr;
}

}  // namespace

std::vector<PluginDescription> readPlugins(const XmlElement& element, const std::string& where) {
  std::vector<PluginDescription> plugins;
  for (const XmlElement* child = element.FirstChildElement("plugin"); child;
       child = child->NextSiblingElement("plugin")) {
    PluginDescription plugin;
    plugin.name = attributeOf(*child, "name");
    plugin.filename = attributeOf(*child, "filename");
    plugin.parameters = readParameters(*child, where);
    plugins.push_back(std::move(plugin));
  }
  return plugins;
}

Parameters readParameters(const XmlElement& element, const std::string& where) {
  Parameters parameters(address(noteAt(element, ""), where));
  addParameters(element, formatOf(element), "", &parameters);
  return parameters;
}

void addMissing(const XmlElement& element, const std::string& child, Parameters* parameters) {
  const ElementFormat* const format = formatOf(element);
  const auto* const known = format ? format->child(child) : nullptr;
  if (known && !element.FirstChildElement(child.c_str()))
    addDefaults(*known->format, "", parameters);
}

}  // namespace kiva
