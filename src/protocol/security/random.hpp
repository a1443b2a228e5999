// SPDX-License-Identifier: Apache-2.0
// Random octets, which protocol code is given by its host.
#pragma once

#include <cstddef>
#include <span>

namespace takt::security {

/// A simulated host gives octets of the scenario's seed, a real one those of the operating system, a test what it
/// likes.
class RandomOctets {
 public:
  virtual ~RandomOctets() = default;
  virtual void fill(std::span<std::byte> octets) = 0;
};

/// The generator of OpenSSL, which the operating system seeds. For real nodes; a run with it is not reproducible.
class SystemRandom final : public RandomOctets {
 public:
  /// Throws std::runtime_error if the operating system gives none.
  void fill(std::span<std::byte> octets) override;
};

}  // namespace takt::security
