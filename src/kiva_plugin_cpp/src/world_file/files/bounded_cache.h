// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace kiva {

/// A cache of shared, immutable values by text. Thread-safe. A full cache drops its oldest value.
template <typename Value>
class BoundedCache {
 public:
  using Entry = std::shared_ptr<const Value>;

  explicit BoundedCache(std::size_t capacity) : capacity_(capacity) {}

  /// Returns the value of a key, or null.
  Entry find(const std::string& key) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto entry = entries_.find(key);
    return entry == entries_.end() ? nullptr : entry->second;
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
