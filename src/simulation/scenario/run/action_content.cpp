// SPDX-License-Identifier: Apache-2.0
#include "scenario/run/action_content.hpp"

#include <variant>

#include "sim/digest.hpp"

namespace takt::scenario {
namespace {

using sim::Content;

Content content(const ResolvedCall& call) { return Content(call.program, call.participant, call.method); }
Content content(const ResolvedMembership& change) { return Content(change.program, change.candidate, change.joins); }
Content content(const ResolvedLink& change) { return Content(change.link, change.up); }
Content content(const ResolvedNode& change) { return Content(change.node.value, change.up); }

Content content(const ResolvedGates& change) {
  const models::GateConfig& gates = change.gates;
  Content all(change.node.value, change.port, gates.admin_cycle_time.ps(), gates.admin_cycle_time_extension.ps(),
              gates.admin_base_time.ps());
  for (const models::GateControlEntry& entry : gates.admin_control_list) {
    all.add(static_cast<std::uint64_t>(entry.operation) << 8 | entry.gate_states);
    all.add(static_cast<std::uint64_t>(entry.interval.ps()));
  }
  return all;
}

Content content(const ResolvedStuckGate& change) {
  return Content(change.node.value, change.port, change.traffic_class, change.open.has_value(),
                 change.open.value_or(false));
}

Content content(const ResolvedRoutes& change) {
  Content all;
  for (const ResolvedRoutes::Entry& entry : change.entries) {
    all.add(static_cast<std::uint64_t>(entry.node.value) << 32 | entry.address.value);
    all.add(static_cast<std::uint64_t>(entry.vlan) << 32 | entry.ports.size());
    for (const std::uint16_t port : entry.ports) all.add(port);
  }
  return all;
}

Content content(const ResolvedClockFault& fault) {
  return Content(fault.node.value, fault.step.has_value(), fault.step.value_or(Duration()).ps(),
                 fault.offset.has_value(), fault.offset.value_or(sim::FrequencyOffset()).parts_per_trillion);
}

Content content(const ResolvedBypass& change) { return Content(change.node.value, change.joins); }

}  // namespace

std::uint64_t content_of(const ResolvedAction& action) {
  return std::visit([](const auto& what) { return content(what).value(); }, action.what);
}

}  // namespace takt::scenario
