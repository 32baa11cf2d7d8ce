// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstddef>
#include <new>

namespace kiva {

/// Memory with shared ownership: the last holder frees it. Any thread may call.
class ViewableMemory {
 public:
  /// Returns memory aligned to a cache line, with one holder.
  static void* allocate(std::size_t bytes) {
    void* block = ::operator new(kHeader + bytes, std::align_val_t(kHeader));
    new (block) std::atomic<long>(1);
    return static_cast<char*>(block) + kHeader;
  }
  static void hold(const void* memory) { holders(memory).fetch_add(1, std::memory_order_relaxed); }
  static void release(const void* memory) {
    if (holders(memory).fetch_sub(1, std::memory_order_acq_rel) != 1) return;
    ::operator delete(&holders(memory), std::align_val_t(kHeader));
  }

 private:
  static constexpr std::size_t kHeader = 64;
  static std::atomic<long>& holders(const void* memory) {
    char* const at = static_cast<char*>(const_cast<void*>(memory));
    return *reinterpret_cast<std::atomic<long>*>(at - kHeader);
  }
};

/// The allocator of containers whose elements other code reads without a copy. A reader that holds
/// the memory still sees the last values after the container has gone.
template <typename T>
struct ViewableAllocator {
  using value_type = T;
  ViewableAllocator() = default;
  template <typename U>
  ViewableAllocator(const ViewableAllocator<U>&) {}
  T* allocate(std::size_t count) {
    return static_cast<T*>(ViewableMemory::allocate(count * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t) { ViewableMemory::release(memory); }
  bool operator==(const ViewableAllocator&) const { return true; }
  bool operator!=(const ViewableAllocator&) const { return false; }
};

}  // namespace kiva
