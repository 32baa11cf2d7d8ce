// SPDX-License-Identifier: Apache-2.0
#include "world_file/regex_once.h"

template class std::__detail::_Compiler<std::regex_traits<char>>;
