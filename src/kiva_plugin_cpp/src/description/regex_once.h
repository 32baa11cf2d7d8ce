// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <regex>

// ignition-math keeps a regular expression in each unit that includes it, and thereby compiles the
// code of regular expressions there: two seconds a unit. A unit that includes this header takes the
// expression from regex_once.cpp.
extern template class std::__detail::_Compiler<std::regex_traits<char>>;
