// SPDX-License-Identifier: Apache-2.0
#include "world_file/includes.h"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>

#include "world_file/errors.h"
#include "world_file/model_paths.h"
#include "world_file/tag_scanner.h"
#include "world_file/xml_parts.h"

namespace kiva {
namespace {

using Path = std::vector<std::string_view>;

std::optional<bool> parseFlag(const std::string& text) {
  if (text == "true" || text == "1") return true;
  if (text == "false" || text == "0") return false;
  return std::nullopt;
}

/// Names that mean something else in SDF are left to libsdformat's rules.
bool isPlainName(const std::string& name) {
  return !name.empty() && name != "world" && name.find("::") == std::string::npos &&
         name.compare(0, 2, "__") != 0;
}

/// One child of an include; false if it is more than we understand.
bool setField(const std::string& field, const std::string& text, Include* include) {
  if (field == "uri") {
    include->uri = text;
    return isModelUri(text);
  }
  if (field == "name") {
    include->name = text;
    return isPlainName(text);
  }
  if (field == "pose") return (include->pose = parsePose(text)).has_value();
  if (field == "static") return (include->is_static = parseFlag(text)).has_value();
  return false;
}

/// From the scanner's `<include>` to its `</include>`.
std::optional<Include> readInclude(std::string_view xml, TagScanner* scanner) {
  Include include;
  std::set<std::string_view> fields;
  if (scanner->closes || !trimmed(scanner->attributes).empty()) return std::nullopt;
  while (scanner->next()) {
    if (!scanner->opens) {
      if (scanner->name != "include" || include.uri.empty()) return std::nullopt;
      return include;
    }
    const std::string_view field = scanner->name;
    const std::size_t begin = scanner->end;
    const bool is_leaf = !scanner->closes && trimmed(scanner->attributes).empty() &&
                         scanner->next() && !scanner->opens && scanner->name == field;
    if (!is_leaf || !fields.insert(field).second) return std::nullopt;
    const std::string_view text = xml.substr(begin, scanner->begin - begin);
    // Comments and entities inside a text.
    if (text.find_first_of("<&") != std::string_view::npos) return std::nullopt;
    if (!setField(std::string(field), trimmed(text), &include)) return std::nullopt;
  }
  return std::nullopt;
}

/// A part of the world that is placed by another one's name, perhaps an include's. Deeper down,
/// names are those of the model around.
bool refersToOthers(const Path& path, std::string_view attributes) {
  constexpr std::size_t kPoseOfModel = 4;  // sdf, world, model, pose.
  return path.size() <= kPoseOfModel && (attributes.find("relative_to") != std::string_view::npos ||
                                         attributes.find("attached_to") != std::string_view::npos);
}

bool isTop(const Path& path) { return path == Path{"sdf"} || path == Path{"sdf", "world"}; }

/// What two models have in common that differ in name and place alone; nothing for one that is
/// placed in another way.
struct ModelText {
  std::string common;
  std::string name;
  Pose pose;
};

std::optional<ModelText> readModelText(const XmlPart& model) {
  const auto name = attributeOf(model, "name");
  const auto parts = partsOf(model.inside);
  if (!name || !isPlainName(*name) || !parts) return std::nullopt;
  ModelText out{"", *name, Pose::Zero};
  const XmlPart* pose = findPart(*parts, "pose");
  std::size_t end = 0;  // Of what is in `common`.
  if (pose) {
    const auto numbers = parsePose(trimmed(pose->inside));
    if (!numbers || !trimmed(pose->attributes).empty()) return std::nullopt;
    out.pose = *numbers;
    const auto begin = static_cast<std::size_t>(pose->whole.data() - model.inside.data());
    out.common = model.inside.substr(0, begin);
    end = begin + pose->whole.size();
  }
  out.common += model.inside.substr(end);
  for (const char* attribute : {"canonical_link", "placement_frame"}) {
    const bool has = model.attributes.find(attribute) != std::string_view::npos;
    if (has)
      out.common += std::string(" ") + attribute + attributeOf(model, attribute).value_or("");
  }
  return out;
}

/// Follows the elements and collects what is taken out.
class Splitter {
 public:
  explicit Splitter(const std::string& xml) : xml_(xml), scanner_(xml_) {}

  /// Nothing if the text had better stay whole.
  std::optional<SplitText> split() {
    while (scanner_.next()) {
      if (scanner_.opens && !open()) return std::nullopt;
      if (scanner_.closes && !close()) return std::nullopt;
    }
    if (!path_.empty()) return std::nullopt;
    keepUpTo(xml_.size());
    return std::move(result_);
  }

 private:
  bool open() {
    const bool is_top = isTop(path_);
    path_.push_back(scanner_.name);
    if (refersToOthers(path_, scanner_.attributes)) return false;
    if (is_top && (scanner_.name == "model" || scanner_.name == "include")) {
      const bool is_taken = scanner_.name == "include" ? takeInclude() : takeCopy();
      if (!is_taken) result_.order.push_back(SplitText::kOfRest);
    }
    return true;
  }

  bool close() {
    if (path_.empty() || path_.back() != scanner_.name) return false;
    path_.pop_back();
    return true;
  }

  bool takeInclude() {
    TagScanner ahead = scanner_;
    auto include = readInclude(xml_, &ahead);
    if (include) take(ahead, std::move(*include));
    return include.has_value();
  }

  /// The first of several models that differ in name and place alone stays.
  bool takeCopy() {
    if (path_.size() < 3) return false;  // <sdf> itself holds one model.
    TagScanner ahead = scanner_;
    const auto part = takePart(xml_, &ahead);
    const auto text = part ? readModelText(*part) : std::nullopt;
    if (!text) return false;
    const auto [original, is_new] = originals_.try_emplace(text->common, *text);
    if (is_new) return false;
    Include copy;
    copy.copy_of = original->second.name;
    copy.name = text->name;
    copy.pose = text->pose * original->second.pose.Inverse();
    take(ahead, std::move(copy));
    return true;
  }

  /// Takes what the scanner stands at, which then stands where `behind` does.
  void take(const TagScanner& behind, Include include) {
    keepUpTo(scanner_.begin);
    include.line = line_;
    result_.order.push_back(static_cast<int>(result_.includes.size()));
    result_.includes.push_back(std::move(include));
    const auto taken = xml_.substr(scanner_.begin, behind.end - scanner_.begin);
    const auto lines = std::count(taken.begin(), taken.end(), '\n');
    result_.rest.append(static_cast<std::size_t>(lines), '\n');
    line_ += static_cast<int>(lines);
    kept_ = behind.end;
    scanner_ = behind;
  }

  void keepUpTo(std::size_t position) {
    const auto text = xml_.substr(kept_, position - kept_);
    line_ += static_cast<int>(std::count(text.begin(), text.end(), '\n'));
    result_.rest.append(text);
  }

  std::string_view xml_;
  TagScanner scanner_;
  Path path_;
  SplitText result_;
  std::map<std::string, ModelText> originals_;  // by what their copies have in common with them
  std::size_t kept_ = 0;                        ///< Up to here the text is in `rest`, or taken out.
  int line_ = 1;                                ///< Of `kept_`.
};

bool isFieldOfInclude(const Path& path) {
  static const std::set<std::string_view> kFields = {"uri", "name", "static", "placement_frame"};
  return path.size() > 1 && path[path.size() - 2] == "include" && kFields.count(path.back());
}

[[noreturn]] void failAtBlank(const std::string& xml, const TagScanner& scanner) {
  const std::string name(scanner.name);
  sdf::Error error(sdf::ErrorCode::ELEMENT_INVALID, "include: expected a text in <" + name + ">");
  const auto end = xml.begin() + static_cast<std::ptrdiff_t>(scanner.begin);
  error.SetLineNumber(1 + static_cast<int>(std::count(xml.begin(), end, '\n')));
  throw SdfError(error);
}

}  // namespace

SplitText takeIncludes(const std::string& xml) {
  if (auto split = Splitter(xml).split()) return std::move(*split);
  return {xml, {}, {}};
}

void checkIncludes(const std::string& xml) {
  TagScanner scanner(xml);
  Path path;
  std::size_t text = 0;  // Where the innermost element's text begins.
  while (scanner.next()) {
    if (scanner.opens) {
      path.push_back(scanner.name);
      text = scanner.end;
    }
    if (!scanner.closes) continue;
    const bool is_blank =
        scanner.opens ||
        (text <= scanner.begin &&
         trimmed(std::string_view(xml).substr(text, scanner.begin - text)).empty());
    if (is_blank && isFieldOfInclude(path)) failAtBlank(xml, scanner);
    if (!path.empty()) path.pop_back();
    text = xml.size();  // What follows belongs to an element that is not empty.
  }
}

}  // namespace kiva
