// SPDX-License-Identifier: Apache-2.0
// The parts of an ingress that stand for themselves: gates, meters, schedulers, identification entries. See
// ingress.hpp.
#pragma once

#include <optional>
#include <string>

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// The stream gate as management sets it. A cycle that cuts entries off is a warning, octets of a closed entry an
/// error.
models::StreamGateConfig stream_gate_of(const StreamGateEntryList& gate, json::Diagnostics& diagnostics);

/// The meter; one that is faster than `fastest`, the fastest link of the switch, never meters anything: an error.
models::NamedFlowMeterConfig meter_of(const Resolved& resolved, const Meter& meter, DataRate fastest,
                                      json::Diagnostics& diagnostics);

/// The identification function of an explicit entry; nothing if it names what is not there (reported).
std::optional<models::StreamIdentityEntry> identity_of(const Resolved& resolved, const IdentifiedStream& stream,
                                                       json::Diagnostics& diagnostics);

/// The stream of that name in the plan, or none.
models::StreamIndex find_stream(const Resolved& resolved, std::string_view name);

}  // namespace takt::scenario
