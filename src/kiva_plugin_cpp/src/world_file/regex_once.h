// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <regex>

// ignition-math keeps a regular expression in each unit that includes it, and thereby has all of
// what makes one of a text compiled there: two seconds a unit. Who includes this takes it from
// regex_once.cpp.
extern template class std::__detail::_Compiler<std::regex_traits<char>>;
