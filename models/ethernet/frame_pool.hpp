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
    if (free_.empty()) [[unlikely]] grow();
    const Handle handle = free_.back();
    free_.pop_back();
    return handle;
  }
  void free(Handle handle) { free_.push_back(handle); }
  std::size_t live() const { return chunks_.size() * chunk_size - free_.size(); }

 private:
  static constexpr std::size_t chunk_size = sizeof(T) > 512 ? 32 : 256;

  void grow() {
    const auto base = static_cast<std::uint32_t>(chunks_.size() * chunk_size);
    chunks_.push_back(std::make_unique<T[]>(chunk_size));
    free_.reserve(chunks_.size() * chunk_size);
    for (std::uint32_t i = chunk_size; i-- > 0;) free_.push_back(Handle{base + i});
  }

  std::vector<std::unique_ptr<T[]>> chunks_;
  std::vector<Handle> free_;
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
    if (free_.empty()) [[unlikely]] grow();
    const FrameIndex handle = free_.back();
    free_.pop_back();
    return handle;
  }
  void free(FrameIndex handle) { free_.push_back(handle); }
  std::size_t live() const { return frames_.size() - free_.size(); }

 private:
  void grow() {
    const auto base = static_cast<std::uint32_t>(frames_.size());
    const std::uint32_t more = base < 64 ? 64 : base;
    frames_.resize(base + more);
    free_.reserve(base + more);
    for (std::uint32_t i = more; i-- > 0;) free_.push_back(FrameIndex{base + i});
  }

  std::vector<Frame> frames_;
  std::vector<FrameIndex> free_;
};

using PayloadPool = Pool<Payload, PayloadIndex>;

}  // namespace takt::models
