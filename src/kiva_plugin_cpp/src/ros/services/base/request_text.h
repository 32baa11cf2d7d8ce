// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/message_operations.h>

#include <ios>
#include <sstream>
#include <string>

namespace kiva_ros {

/// Takes what a message's own printer writes, and makes YAML of it: texts are quoted, long ones
/// cut, and elements of arrays are a list.
class RequestText {
 public:
  RequestText() { out_.precision(8); }  // 0.1f is 0.1

  RequestText& operator<<(const char* literal);      ///< Names of fields and what is around them.
  RequestText& operator<<(const std::string& text);  ///< An indentation, or a field's value.
  RequestText& operator<<(std::ostream& (*end)(std::ostream&));  ///< The end of a line.
  template <typename Number>
  RequestText& operator<<(const Number& value) {
    out_ << value;
    return *this;
  }

  std::string yaml() const;

 private:
  std::ostringstream out_;
  bool is_value_ = false;  ///< A name was written: what comes next is its value.
};

/// Returns the fields of a message as YAML.
template <typename Message>
std::string fieldsOf(const Message& message) {
  RequestText text;
  ros::message_operations::Printer<Message>::stream(text, "", message);
  return text.yaml();
}

}  // namespace kiva_ros
