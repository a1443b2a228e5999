// SPDX-License-Identifier: Apache-2.0
// InstanceKey: which instance of a topic (DDSI-RTPS 2.5, 9.6.3.8).
#pragma once

#include "dds/message/submessage.hpp"

namespace takt::dds {

/// The key hash: the key fields in big-endian CDR, if they never have more than 16 octets, otherwise their MD5. All
/// zeros in topics without key.
using InstanceKey = KeyHash;

inline constexpr InstanceKey no_key{};

}  // namespace takt::dds
