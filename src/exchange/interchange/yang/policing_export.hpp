// SPDX-License-Identifier: Apache-2.0
// Stream identification, stream filters, gates, meters and ATS schedulers, and redundancy, as instance data.
#pragma once

#include "interchange/export.hpp"
#include "interchange/ports.hpp"
#include "interchange/yang/data.hpp"

namespace takt::interchange::yang {

void write_policing(Data& root, const scenario::Resolved& resolved, const Device& device, Dialect dialect,
                    std::uint64_t start_ns, Exported& exported);

/// Sequence generation, splits and recoveries (802.1CB) with the identities that they need, beside those that are
/// there.
void write_redundancy(Data& root, const scenario::Resolved& resolved, const Device& device, Dialect dialect,
                      Exported& exported);

}  // namespace takt::interchange::yang
