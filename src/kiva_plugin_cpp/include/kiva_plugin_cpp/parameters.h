// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace kiva {

/// A description that can't be built; the message names file, entity, field and what was expected.
class DescriptionError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The parameters of one plugin: the text of each child element of its SDF `<plugin>`.
/// Nested elements are reached by a path, `pose/x`. A getter checks type and range at once. A
/// misspelt parameter is an error, since `rejectUnread` finds what no getter has read.
class Parameters {
 public:
  Parameters() = default;
  /// `where` is the prefix of every error, such as `model 'kiva', plugin 'motion'`.
  explicit Parameters(std::string where) : where_(std::move(where)) {}

  void set(const std::string& key, const std::string& text) { values_[key] = text; }
  bool has(const std::string& key) const { return values_.count(key) != 0; }
  const std::map<std::string, std::string>& values() const { return values_; }
  const std::string& where() const { return where_; }

  /// Returns the number at `key`, or `fallback`. Throws DescriptionError unless lower <= it <=
  /// upper.
  double number(const std::string& key, double fallback, double lower, double upper) const;
  /// Returns the whole number at `key`, likewise.
  int whole(const std::string& key, int fallback, int lower, int upper) const;
  std::string text(const std::string& key, const std::string& fallback) const;

  /// Returns a function for a struct's fields(): it reads each number from `prefix` + its name. A
  /// missing number keeps its value. Throws as number() and whole() do.
  auto reader(const std::string& prefix = "") const {
    return [this, prefix](const char* name, auto& value, double least, double most) {
      read(prefix + name, &value, least, most);
    };
  }

  /// Returns `true`, `false`, 1 or 0 at `key`, or `fallback`.
  bool flag(const std::string& key, bool fallback) const;
  /// Returns `count` finite numbers at `key`, separated by blanks, or `fallback`.
  std::vector<double> numbers(const std::string& key, const std::vector<double>& fallback) const;

  /// Accepts `section` and all keys below it, whatever they are.
  void ignore(const std::string& section) const;

  /// Returns the keys that were not read, except `robotNamespace`, which every plugin gets.
  std::vector<std::string> unread() const;
  /// Throws DescriptionError, with a list of the known keys, if there is an unread one.
  void rejectUnread() const;

 private:
  void read(const std::string& key, double* value, double least, double most) const {
    *value = number(key, *value, least, most);
  }
  void read(const std::string& key, int* value, double least, double most) const {
    *value = whole(key, *value, static_cast<int>(least), static_cast<int>(most));
  }
  const std::string* find(const std::string& key) const;

  std::string where_;
  std::map<std::string, std::string> values_;
  mutable std::set<std::string> read_;
};

}  // namespace kiva
