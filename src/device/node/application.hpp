// SPDX-License-Identifier: Apache-2.0
// What a node's own program has to do with its Program: it produces and consumes process data, and sees the states
// change.
#pragma once

#include <cstdint>
#include <span>

#include "handshake/io.hpp"
#include "uadp/octets.hpp"

namespace takt::node {

/// Called in the node's loop, so what it does must be short against the cycle. Data sets are counted as in the Program;
/// their fields stand one behind the other, little-endian, as uadp/octets.hpp loads and stores them (see also
/// data_set_binding.hpp).
class Application {
 public:
  virtual ~Application() = default;
  /// The fields of an own data set are about to be published; they are zeros so far. `time_ns` is the instant on the
  /// node's clock.
  virtual void produce(std::size_t data_set, std::int64_t time_ns, std::span<std::byte> fields) = 0;
  /// Fields of another's data set have come, while both are Running in one run.
  virtual void consume(std::size_t data_set, std::int64_t time_ns, uadp::Octets fields) = 0;
  virtual void changed(const handshake::StateChange& change) { static_cast<void>(change); }
};

}  // namespace takt::node
