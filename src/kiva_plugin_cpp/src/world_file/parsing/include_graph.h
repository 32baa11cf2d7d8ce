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
  /// `fault_of(text, file)` tells what is wrong in a file of its own, its includes apart; empty:
  /// nothing.
  using FaultOf = std::function<std::string(const std::string& text, const std::string& file)>;
  IncludeGraph(const ModelPaths& model_paths, FaultOf fault_of);

  /// Takes out the includes in a document that lead nowhere or too far, each with a warning. What
  /// they would have put there is unknown: a stand-in takes its place, if there is one.
  void prune(XmlDocument* document, Faults* warnings);

  /// Those that it has read, and where it looked for what is missing.
  const std::set<std::string>& files() const { return files_; }

 private:
  /// What will be read.
  struct Cost {
    double includes = 0, bytes = 0;
    std::string fault;  ///< What is wrong in there; empty: nothing.
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
