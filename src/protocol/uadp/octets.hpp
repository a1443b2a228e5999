// SPDX-License-Identifier: Apache-2.0
// Octets of messages: OPC UA Binary (OPC 10000-6, 5.2.2) writes integers and floats little-endian.
#pragma once

#include "sim/octets.hpp"

namespace takt::uadp {

using Octets = sim::OctetSpan;
using Reader = sim::OctetReader<sim::LittleEndian>;
using Writer = sim::OctetWriter<sim::LittleEndian>;

/// The number that begins at `at`; sizeof(T) octets must be there.
template <sim::Number T>
inline T load_little_endian(const std::byte* at) {
  return sim::load<T>(at, sim::ByteOrder::little);
}

/// Writes sizeof(T) octets; there must be room for them.
template <sim::Number T>
inline void store_little_endian(std::byte* at, T number) {
  sim::store(at, number, sim::ByteOrder::little);
}

}  // namespace takt::uadp
