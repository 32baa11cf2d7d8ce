// SPDX-License-Identifier: Apache-2.0
#include "rware/layout.h"

#include <stdexcept>
#include <utility>

#include "rware/python_set.h"

namespace rware {

Layout::Layout(int height, int width, std::vector<std::uint8_t> highway, std::vector<int> goals,
               std::vector<std::uint8_t> wall)
    : height(height),
      width(width),
      highway(std::move(highway)),
      goals(std::move(goals)),
      wall(std::move(wall)) {
  if (height < 1 || width < 1 || this->highway.size() != static_cast<std::size_t>(size())) {
    throw std::invalid_argument("layout: expected height * width cells");
  }
  if (!this->wall.empty() && this->wall.size() != this->highway.size()) {
    throw std::invalid_argument("layout: expected as many walls as highways, or none");
  }
  for (const int goal : this->goals) {
    if (goal < 0 || goal >= size()) throw std::invalid_argument("layout: a goal lies outside");
    if (isWall(goal)) throw std::invalid_argument("layout: a goal lies in a wall");
  }
  hashes.reserve(size());
  for (int cell = 0; cell < size(); ++cell) {
    if (!isWall(cell)) open.push_back(cell);
    if (!isWall(cell) && !this->highway[cell]) storage.push_back(cell);
    hashes.push_back(hashOfPair(x(cell), y(cell)));
  }
}

}  // namespace rware
