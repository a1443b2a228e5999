// SPDX-License-Identifier: Apache-2.0
// Octets of messages: RTPS tells the byte order of each submessage by a flag, CDR that of each payload.
#pragma once

#include "sim/octets.hpp"

namespace takt::dds {

using sim::ByteOrder;
using sim::load;
using sim::Number;
using Octets = sim::OctetSpan;
using sim::rounded_up;
using sim::store;
using Reader = sim::OctetReader<ByteOrder>;
using Writer = sim::OctetWriter<ByteOrder>;

}  // namespace takt::dds
