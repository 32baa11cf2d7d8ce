// SPDX-License-Identifier: Apache-2.0
//
// Includes may lead in circles, and through fourteen files that include the next one twice, 16,384
// times. They are followed first, each file once, before anything takes their place.
#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>

#include "kiva_plugin_cpp/world_file.h"
#include "world_file/files/xml.h"

namespace kiva {

class IncludeGraph {
 public:
  /// `fault_of(text, file)` returns the fault of a file by itself, without its includes; empty
  /// without a fault.
  using FaultOf = std::function<std::string(const std::string& text, const std::string& file)>;
  IncludeGraph(const ModelPaths& model_paths, FaultOf fault_of);

  /// Removes the includes of a document that lead nowhere or too far, each with a warning.
  /// Stand-ins, if there are any, take the place of their unknown models.
  void prune(XmlDocument* document, Faults* warnings);

  /// Returns the files that it has read, and the places where it looked for missing ones.
  const std::set<std::string>& files() const { return files_; }

 private:
  /// The cost of reading a file with its includes.
  struct Cost {
    double includes = 0, bytes = 0;
    std::string fault;  ///< Fault in there, or empty.
  };
  Cost follow(const std::string& uri);
  Cost read(const std::string& file);
  struct Fault {
    std::string what;  ///< Empty: none.
    bool is_of_model = false;
  };
  Fault faultOfInclude(const XmlElement& include);
  bool hasStandIn() const;

  const ModelPaths& model_paths_;
  const FaultOf fault_of_;
  std::map<std::string, Cost> known_;  // by file
  std::set<std::string> open_;         // files on the way to the one that is read
  std::set<std::string> files_;
  double includes_ = 0, bytes_ = 0;  // so far
};

}  // namespace kiva
