// SPDX-License-Identifier: Apache-2.0
#include "world_file/parsing/expansion.h"

#include <filesystem>

#include "world_file/check/validation.h"
#include "world_file/elements/frames.h"
#include "world_file/elements/values.h"
#include "world_file/files/model_paths.h"
#include "world_file/files/text_file.h"
#include "world_file/parsing/conversion.h"
#include "world_file/parsing/preparation.h"

namespace kiva {
namespace {

class Expansion {
 public:
  Expansion(const ModelPaths& model_paths, SdfDocument* document)
      : model_paths_(model_paths), document_(document) {}

  void run(XmlElement* around) {
    XmlElement* next = nullptr;
    for (XmlElement* child = around->FirstChildElement(); child; child = next) {
      next = child->NextSiblingElement();
      if (is(*child, "plugin")) continue;
      if (is(*child, "include")) {
        replace(child);
      } else {
        run(child);
      }
    }
  }

 private:
  void replace(XmlElement* include) {
    XmlElement* const around = include->Parent()->ToElement();
    XmlElement* const uri = include->FirstChildElement("uri");
    const std::string place = findModel(contentOf(uri), model_paths_);
    if (place.empty()) {
      const std::string why = uri ? leftOut(contentOf(uri), model_paths_)
                                  : "this include is left out: expected a text in <uri>";
      document_->warnings.push_back(noteAt(uri ? *uri : *include, why));
    } else {
      const std::string file = std::filesystem::path(modelFile(place)).lexically_normal().string();
      if (XmlElement* const model = modelIn(file)) {
        setFromInclude(*include, model);
        around->InsertAfterChild(include, model);
        run(model);
        if (readFlag(attributeOf(*include, "merge")).value_or(false)) merge(model);
      }
    }
    around->DeleteChild(include);
  }

  /// Returns the model of a file as an element of our document; null if it holds none.
  XmlElement* modelIn(const std::string& file) {
    const auto xml = parseXml(readText(file, kMostBytes));
    modernizePoses(xml.get());
    XmlElement* const root = xml->RootElement();
    if (!root || !is(*root, "sdf")) return nullptr;
    convert(root);
    Faults left_out, unknown;
    validate(root, &left_out, &unknown);
    for (Fault& fault : unknown) {
      fault.file = file;
      document_->warnings.push_back(fault);
    }
    document_->files.insert(file);
    document_->files.insert((std::filesystem::path(file).parent_path() / "model.config").string());
    const XmlElement* const model = root->FirstChildElement("model");
    return model ? copyOf(*model, file) : nullptr;
  }

  /// Returns a copy in our document; each element remembers its origin.
  XmlElement* copyOf(const XmlElement& from, const std::string& file) {
    XmlElement* const copy = document_->xml->NewElement(from.Name());
    for (const auto* attribute = from.FirstAttribute(); attribute; attribute = attribute->Next()) {
      copy->SetAttribute(attribute->Name(), attribute->Value());
    }
    document_->sources.push_back({file, from.GetLineNum()});
    copy->SetUserData(&document_->sources.back());
    for (const auto* node = from.FirstChild(); node; node = node->NextSibling()) {
      if (const XmlElement* const child = node->ToElement()) {
        copy->InsertEndChild(copyOf(*child, file));
      } else if (node->ToText()) {
        copy->InsertEndChild(document_->xml->NewText(node->Value()));
      }
    }
    return copy;
  }

  /// Replaces the model's name, pose, plugins and the like by those of the include.
  void setFromInclude(const XmlElement& include, XmlElement* model) {
    if (const auto* name = include.FirstChildElement("name")) {
      model->SetAttribute("name", contentOf(name).c_str());
    }
    if (const auto* frame = include.FirstChildElement("placement_frame")) {
      model->SetAttribute("placement_frame", contentOf(frame).c_str());
    }
    for (const char* part : {"pose", "static"}) {
      const XmlElement* const override_element = include.FirstChildElement(part);
      if (!override_element) continue;
      if (XmlElement* const own = model->FirstChildElement(part)) model->DeleteChild(own);
      model->InsertFirstChild(override_element->DeepClone(document_->xml.get()));
    }
    for (const auto* plugin = include.FirstChildElement("plugin"); plugin;
         plugin = plugin->NextSiblingElement("plugin")) {
      model->InsertEndChild(plugin->DeepClone(document_->xml.get()));
    }
  }

  /// Moves a model's parts into the model around it and adds a frame in place of the merged model.
  void merge(XmlElement* model) {
    XmlElement* const around = model->Parent()->ToElement();
    const std::string frame = "_merged__" + attributeOf(*model, "name") + "__";
    const Pose pose = poseAround(*model);
    XmlElement* const proxy = around->InsertNewChildElement("frame");
    proxy->SetAttribute("name", frame.c_str());
    proxy->InsertNewChildElement("pose")->SetText(textOf(pose).c_str());
    XmlElement* next = nullptr;
    for (XmlElement* part = model->FirstChildElement(); part; part = next) {
      next = part->NextSiblingElement();
      if (is(*part, "pose") || is(*part, "static")) continue;
      placeIn(frame, part);
      around->InsertEndChild(part);
    }
    around->DeleteChild(model);
  }

  /// Makes poses and axes relative to `frame` that were relative to the model.
  static void placeIn(const std::string& frame, XmlElement* part) {
    if (is(*part, "link") || is(*part, "frame") || is(*part, "model")) {
      XmlElement* pose = part->FirstChildElement("pose");
      if (!pose) pose = part->InsertNewChildElement("pose");
      const bool has_own = pose->Attribute("relative_to") || part->Attribute("attached_to");
      if (!has_own) pose->SetAttribute("relative_to", frame.c_str());
    }
    forAll(part, [&](XmlElement* element) {
      for (const char* name : {"relative_to", "expressed_in", "attached_to"}) {
        if (attributeOf(*element, name) == "__model__") element->SetAttribute(name, frame.c_str());
      }
    });
  }

  const ModelPaths& model_paths_;
  SdfDocument* const document_;
};

}  // namespace

void expandIncludes(const ModelPaths& model_paths, SdfDocument* document) {
  Expansion(model_paths, document).run(document->xml->RootElement());
}

}  // namespace kiva
