// SPDX-License-Identifier: Apache-2.0
#include "core/checkpoint/archive.h"

namespace kiva {
namespace {

/// Returns the end of the argument that begins at `from`.
std::size_t endOf(const std::string& list, std::size_t from) {
  int depth = 0;
  for (std::size_t at = from; at < list.size(); ++at) {
    if (list[at] == '(') ++depth;
    if (list[at] == ')' && depth-- == 0) return at;
    if (list[at] == ',' && depth == 0) return at;
  }
  return list.size();
}

}  // namespace

void failTooShort() { throw ArchiveError("it ends too early"); }

void failOutside(double value, double least, double most) {
  throw ArchiveError("expected a number from " + std::to_string(least) + " to " +
                     std::to_string(most) + ", not " + std::to_string(value));
}

std::string nameIn(const char* names, int index) {
  const std::string list = names, limited = "within(";
  std::size_t from = 0;
  for (; index > 0; --index) from = endOf(list, from) + 2;  // ", "
  if (list.compare(from, limited.size(), limited) == 0) from += limited.size();
  std::string name = list.substr(from, endOf(list, from) - from);
  if (name.size() > 2 && name.back() == ')') name.resize(name.size() - 2);  // v.X()
  const std::size_t last = name.find_last_of(".>");
  return last == std::string::npos ? name : name.substr(last + 1);
}

}  // namespace kiva
