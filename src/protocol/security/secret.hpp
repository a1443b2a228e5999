// SPDX-License-Identifier: Apache-2.0
// Octets that nobody else may see: cleared when they are dropped, and compared in constant time.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "sim/octets.hpp"

namespace takt::security {

using Octets = sim::OctetSpan;

/// Overwrites them with zeros; the compiler does not leave it out.
void wipe(std::span<std::byte> octets) noexcept;

/// Takes as long wherever they differ. Octets of different lengths are not equal, and that may show.
bool equal_in_constant_time(Octets a, Octets b) noexcept;

/// A key, a password: its octets are cleared when it is dropped, given another value or moved from.
class Secret {
 public:
  Secret() = default;
  explicit Secret(std::size_t octets) : octets_(octets) {}
  explicit Secret(Octets octets) : octets_(octets.begin(), octets.end()) {}
  Secret(const Secret&) = default;
  Secret(Secret&& other) noexcept : octets_(std::move(other.octets_)) { other.octets_.clear(); }
  Secret& operator=(Secret other) noexcept {
    octets_.swap(other.octets_);  // what was here is cleared with `other`
    return *this;
  }
  ~Secret() { wipe(octets_); }

  Octets octets() const { return octets_; }
  std::span<std::byte> octets() { return octets_; }
  std::size_t size() const { return octets_.size(); }
  bool empty() const { return octets_.empty(); }
  bool operator==(const Secret& other) const noexcept { return equal_in_constant_time(octets_, other.octets_); }

 private:
  std::vector<std::byte> octets_;
};

}  // namespace takt::security
