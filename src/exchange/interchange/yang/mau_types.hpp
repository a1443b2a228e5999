// SPDX-License-Identifier: Apache-2.0
// MAU types by their number in RFC 4836 and IANA-MAU-MIB, by which IEC/IEEE 60802 names media.
#pragma once

#include <cstdint>
#include <optional>

#include "scenario/description/medium.hpp"

namespace takt::interchange::yang {

/// The medium of a full-duplex MAU; nothing of one that takt does not have.
std::optional<scenario::Medium> medium_of_mau(std::int64_t mau_type);

}  // namespace takt::interchange::yang
