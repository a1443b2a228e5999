// SPDX-License-Identifier: Apache-2.0
// Frames and payloads behind 32-bit handles, at addresses that stay. In steady state nothing is allocated.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "models/ethernet/frame.hpp"
#include "sim/check.hpp"

#if defined(__SANITIZE_ADDRESS__)
#define TAKT_LONE_SLOTS 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define TAKT_LONE_SLOTS 1
#endif
#endif

namespace takt::models {

/// Slots in chunks: a growing pool adds one and moves nothing. A freed slot keeps its memory.
template <class T>
class ChunkedSlots {
 public:
  T& operator[](std::uint32_t slot) const { return chunks_[slot / chunk_size][slot % chunk_size]; }
  T* find(std::uint32_t slot) const { return &(*this)[slot]; }
  std::uint32_t count() const { return static_cast<std::uint32_t>(chunks_.size()) * chunk_size; }
  void grow() { chunks_.push_back(std::make_unique<T[]>(chunk_size)); }
  void occupy(std::uint32_t) {}
  void vacate(std::uint32_t) {}

 private:
  static constexpr std::uint32_t chunk_size = sizeof(T) > 512 ? 32 : 256;
  std::vector<std::unique_ptr<T[]>> chunks_;
};

/// Each occupied slot is an allocation of its own, made anew each time, and the pool grows whenever it can: whoever
/// looks at what has been freed, beside a slot or through a handle of which nothing is left, is found by
/// AddressSanitizer or by a CHECK.
template <class T>
class LoneSlots {
 public:
  T& operator[](std::uint32_t slot) const {
    TAKT_CHECK(slot < slots_.size() && slots_[slot] != nullptr, "a handle is used while what it stands for lives");
    return *slots_[slot];
  }
  T* find(std::uint32_t slot) const { return slots_.at(slot).get(); }
  std::uint32_t count() const { return static_cast<std::uint32_t>(slots_.size()); }
  void grow() { slots_.emplace_back(); }
  void occupy(std::uint32_t slot) { slots_[slot] = std::make_unique<T>(); }
  void vacate(std::uint32_t slot) { slots_[slot].reset(); }

 private:
  std::vector<std::unique_ptr<T>> slots_;
};

/// A pool of T with stable addresses; freed slots are used again, the last one first, so that they are warm in the
/// cache.
template <class T, class Handle, class Slots>
class BasicPool {
 public:
  T& operator[](Handle handle) { return slots_[handle.value]; }
  const T& operator[](Handle handle) const { return slots_[handle.value]; }
  /// Lookup of a possibly stale handle: null, or its current owner.
  T* find(Handle handle) { return slots_.find(handle.value); }

  Handle allocate() {
    if (free_count_ == 0) [[unlikely]]
      grow();
    const Handle handle = free_[--free_count_];
    slots_.occupy(handle.value);
    return handle;
  }
  void free(Handle handle) {
    TAKT_CHECK(free_count_ < free_.size(), "what is freed was allocated");
    slots_.vacate(handle.value);
    free_[free_count_++] = handle;
  }
  std::size_t live() const { return free_.size() - free_count_; }
  /// Calls visit(what) for each that is under way, in no particular order. For the end of a run: it looks at the whole
  /// pool.
  template <class Visit>
  void for_each_live(Visit&& visit) const {
    std::vector<bool> is_free(slots_.count(), false);
    for (std::size_t i = 0; i < free_count_; ++i) is_free[free_[i].value] = true;
    for (std::uint32_t slot = 0; slot < slots_.count(); ++slot)
      if (!is_free[slot]) visit(std::as_const(slots_[slot]));
  }

 private:
  [[gnu::noinline]] void grow() {
    const std::uint32_t before = slots_.count();
    slots_.grow();
    free_.resize(slots_.count());
    for (std::uint32_t slot = slots_.count(); slot-- > before;) free_[free_count_++] = Handle{slot};
  }

  Slots slots_;
  std::vector<Handle>
      free_;  ///< as long as there are slots, so that freeing never asks for room; the first free_count_ of them count
  std::size_t free_count_ = 0;
};

/// With AddressSanitizer every frame stands alone.
#ifdef TAKT_LONE_SLOTS
template <class T, class Handle>
using Pool = BasicPool<T, Handle, LoneSlots<T>>;
#else
template <class T, class Handle>
using Pool = BasicPool<T, Handle, ChunkedSlots<T>>;
#endif

/// The octets of an MSDU that protocol code wrote; at most 1500.
struct Payload {
  std::uint32_t references = 0;  ///< frames that carry it
  std::uint16_t length = 0;
  std::array<std::byte, 1500> octets;
  std::span<const std::byte> view() const { return {octets.data(), length}; }
};

using FramePool = Pool<Frame, FrameIndex>;
using PayloadPool = Pool<Payload, PayloadIndex>;

}  // namespace takt::models
