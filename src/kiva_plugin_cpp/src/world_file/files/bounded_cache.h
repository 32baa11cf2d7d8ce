// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace kiva {

/// Shared, immutable values by text. Thread-safe. The oldest goes when it is full.
template <typename Value>
class BoundedCache {
 public:
  using Entry = std::shared_ptr<const Value>;

  explicit BoundedCache(std::size_t capacity) : capacity_(capacity) {}

  /// Nothing if there is none.
  Entry find(const std::string& key) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = entries_.find(key);
    return found == entries_.end() ? nullptr : found->second;
  }

  void put(const std::string& key, Entry value) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (entries_.insert_or_assign(key, std::move(value)).second) order_.push_back(key);
    while (order_.size() > capacity_) {
      entries_.erase(order_.front());
      order_.pop_front();
    }
  }

 private:
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::map<std::string, Entry> entries_;
  std::deque<std::string> order_;
};

}  // namespace kiva
