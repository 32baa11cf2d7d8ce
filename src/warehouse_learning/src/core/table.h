// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>

namespace learning {

/// A table with rows of equal length at fixed addresses, which numpy can view, of bool too.
template <typename T>
class Table {
 public:
  Table(int rows, int columns, T value = T())
      : rows_(rows), columns_(columns), data_(new T[std::size_t(rows) * columns]) {
    std::fill_n(data_.get(), std::size_t(rows) * columns, value);
  }

  T* operator[](int row) { return data_.get() + std::size_t(row) * columns_; }
  const T* operator[](int row) const { return data_.get() + std::size_t(row) * columns_; }
  void fill(int row, T value) { std::fill_n((*this)[row], columns_, value); }

  int rows() const { return rows_; }
  int columns() const { return columns_; }

 private:
  int rows_, columns_;
  std::unique_ptr<T[]> data_;
};

}  // namespace learning
