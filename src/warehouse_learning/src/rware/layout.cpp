// SPDX-License-Identifier: Apache-2.0
#include "rware/layout.h"

#include <stdexcept>
#include <utility>

#include "rware/python_set.h"

namespace rware {

Layout::Layout(int height, int width, std::vector<std::uint8_t> highway, std::vector<int> goals)
    : height(height), width(width), highway(std::move(highway)), goals(std::move(goals)) {
  if (height < 1 || width < 1 || this->highway.size() != static_cast<std::size_t>(size())) {
    throw std::invalid_argument("layout: expected height * width cells");
  }
  for (const int goal : this->goals) {
    if (goal < 0 || goal >= size()) throw std::invalid_argument("layout: a goal lies outside");
  }
  hashes.reserve(size());
  for (int cell = 0; cell < size(); ++cell) {
    if (!this->highway[cell]) storage.push_back(cell);
    hashes.push_back(hashOfPair(x(cell), y(cell)));
  }
}

}  // namespace rware
