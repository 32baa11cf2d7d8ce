// SPDX-License-Identifier: Apache-2.0
//
// Includes may form circles, or grow exponentially: fourteen files that each include the next one
// twice are 16,384 includes. So includes are followed once a file before any is expanded.
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
  /// `fault_of(text, file)` returns the fault of a file without its includes; empty if it has none.
  using FaultOf = std::function<std::string(const std::string& text, const std::string& file)>;
  IncludeGraph(const ModelPaths& model_paths, FaultOf fault_of);

  /// Removes includes that are missing, circular or too many, each with a warning. Stand-ins, if
  /// the document has any, replace unknown models.
  void prune(XmlDocument* document, Faults* warnings);

  /// Returns the files that were read, and the paths at which missing ones were searched for.
  const std::set<std::string>& files() const { return files_; }

 private:
  /// The cost of reading a file with its includes.
  struct Cost {
    double includes = 0, bytes = 0;
    std::string fault;  ///< Fault in there, or empty.
  };
  Cost follow(const std::string& uri);
  Cost read(const std::string& file);
  struct IncludeFault {
    std::string what;  ///< Empty: no limit is exceeded.
    bool is_of_model = false;
  };
  IncludeFault faultOfInclude(const XmlElement& include);
  bool hasStandIn() const;

  const ModelPaths& model_paths_;
  const FaultOf fault_of_;
  std::map<std::string, Cost> known_;  // by file
  std::set<std::string> open_;         // the files that include the present one, directly or not
  std::set<std::string> files_;
  double includes_ = 0, bytes_ = 0;  // so far
};

}  // namespace kiva
