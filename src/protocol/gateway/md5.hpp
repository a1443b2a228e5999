// SPDX-License-Identifier: Apache-2.0
// MD5 (RFC 1321), for key hashes of DDS alone (DDSI-RTPS 2.5, 9.6.4.8): it protects nothing.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace takt::gateway {

/// The digest, in the order in which its octets are written.
std::array<std::uint8_t, 16> md5(std::span<const std::uint8_t> message);

}  // namespace takt::gateway
