// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace kiva {

/// Walks over the tags of an XML text, one after the other; comments, processing instructions and
/// CDATA are passed by. It knows where things are in the text, which a document tree forgets.
class TagScanner {
 public:
  explicit TagScanner(std::string_view xml) : xml_(xml) {}

  /// To the next tag; false at the end of the text and at what is no XML.
  bool next();

  std::string_view name;
  std::string_view attributes;  ///< As written, blanks around them.
  std::size_t begin = 0;        ///< Of the tag, at its `<`.
  std::size_t end = 0;          ///< Behind its `>`.
  bool opens = false;           ///< True for `<a>` and `<a/>`.
  bool closes = false;          ///< True for `</a>` and `<a/>`.

 private:
  bool skip(std::string_view opening, std::string_view closing);
  bool readTag();
  std::size_t closingBracket() const;

  std::string_view xml_;
};

}  // namespace kiva
