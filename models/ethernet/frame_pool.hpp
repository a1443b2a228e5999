// Frames and payloads behind 32-bit handles. In steady state nothing is allocated.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "models/ethernet/frame.hpp"
#include "sim/check.hpp"

namespace takt::models {

/// A pool of T with stable addresses; freed slots are used again, the last one first, so that they are warm in the cache.
template <class T, class Handle>
class Pool {
 public:
  T& operator[](Handle handle) { return chunks_[handle.value / chunk_size][handle.value % chunk_size]; }
  const T& operator[](Handle handle) const { return chunks_[handle.value / chunk_size][handle.value % chunk_size]; }

  Handle allocate() {
    if (free_count_ == 0) [[unlikely]] grow();
    return free_[--free_count_];
  }
  void free(Handle handle) {
    TAKT_CHECK(free_count_ < free_.size(), "what is freed was allocated");
    free_[free_count_++] = handle;
  }
  std::size_t live() const { return chunks_.size() * chunk_size - free_count_; }

 private:
  static constexpr std::size_t chunk_size = sizeof(T) > 512 ? 32 : 256;

  [[gnu::noinline]] void grow() {
    const auto base = static_cast<std::uint32_t>(chunks_.size() * chunk_size);
    chunks_.push_back(std::make_unique<T[]>(chunk_size));
    free_.resize(chunks_.size() * chunk_size);
    for (std::uint32_t i = chunk_size; i-- > 0;) free(Handle{base + i});
  }

  std::vector<std::unique_ptr<T[]>> chunks_;
  std::vector<Handle> free_;  ///< as long as there are slots, so that freeing never asks for room; the first free_count_ of them count
  std::size_t free_count_ = 0;
};

/// The octets of an MSDU that protocol code wrote; at most 1500.
struct Payload {
  std::uint32_t references = 0;  ///< frames that carry it
  std::uint16_t length = 0;
  std::array<std::byte, 1500> octets;
  std::span<const std::byte> view() const { return {octets.data(), length}; }
};

/// The same in one block, so that a frame is one step away. Addresses change when the pool grows: nobody keeps a reference
/// over an allocate().
class FramePool {
 public:
  Frame& operator[](FrameIndex handle) { return frames_[handle.value]; }
  const Frame& operator[](FrameIndex handle) const { return frames_[handle.value]; }

  FrameIndex allocate() {
    if (free_count_ == 0) [[unlikely]] grow();
    return free_[--free_count_];
  }
  void free(FrameIndex handle) {
    TAKT_CHECK(free_count_ < free_.size(), "what is freed was allocated");
    free_[free_count_++] = handle;
  }
  std::size_t live() const { return frames_.size() - free_count_; }
  /// Calls visit(frame) for each that is under way, in no particular order. For the end of a run: it looks at the whole pool.
  template <class Visit>
  void for_each_live(Visit&& visit) const {
    for (const Frame& frame : frames_)
      if (frame.references > 0) visit(frame);
  }

 private:
  [[gnu::noinline]] void grow() {
    const auto base = static_cast<std::uint32_t>(frames_.size());
    const std::uint32_t more = base < 64 ? 64 : base;
    frames_.resize(base + more);
    free_.resize(base + more);
    for (std::uint32_t i = more; i-- > 0;) free(FrameIndex{base + i});
  }

  std::vector<Frame> frames_;
  std::vector<FrameIndex> free_;  ///< as in Pool
  std::size_t free_count_ = 0;
};

using PayloadPool = Pool<Payload, PayloadIndex>;

}  // namespace takt::models
