// SPDX-License-Identifier: Apache-2.0
#include "opcua/address_space/event.hpp"

#include <algorithm>

namespace takt::opcua {
namespace {

/// Of BaseEventType, TransitionEventType, ProgramTransitionEventType and the audit types (OPC 10000-5, 6.4; OPC
/// 10000-16, 4.4).
constexpr std::string_view event_fields[] = {"EventId",
                                             "EventType",
                                             "SourceNode",
                                             "SourceName",
                                             "Time",
                                             "ReceiveTime",
                                             "LocalTime",
                                             "Message",
                                             "Severity",
                                             "Transition",
                                             "Transition/Id",
                                             "Transition/Name",
                                             "Transition/Number",
                                             "Transition/EffectiveDisplayName",
                                             "Transition/TransitionTime",
                                             "Transition/EffectiveTransitionTime",
                                             "FromState",
                                             "FromState/Id",
                                             "FromState/Name",
                                             "FromState/Number",
                                             "FromState/EffectiveDisplayName",
                                             "ToState",
                                             "ToState/Id",
                                             "ToState/Name",
                                             "ToState/Number",
                                             "ToState/EffectiveDisplayName",
                                             "IntermediateResult",
                                             "ActionTimeStamp",
                                             "Status",
                                             "ServerId",
                                             "ClientAuditEntryId",
                                             "ClientUserId",
                                             "MethodId",
                                             "InputArguments",
                                             "OldStateId",
                                             "NewStateId",
                                             "TransitionNumber",
                                             "1:Cause"};

}  // namespace

std::string path_of(const List<QualifiedName>& names) {
  std::string path;
  for (const QualifiedName& each : names)
    path += (path.empty() ? "" : "/") + (each.name_space == 0 ? std::string() : std::to_string(each.name_space) + ":") +
            each.name.value;
  return path;
}

std::optional<std::size_t> event_field(const std::string& path) {
  const auto found = std::find(std::begin(event_fields), std::end(event_fields), path);
  return found == std::end(event_fields) ? std::nullopt
                                         : std::optional(static_cast<std::size_t>(found - std::begin(event_fields)));
}

EventRecord::EventRecord(Event event, std::uint64_t number)
    : event_(std::move(event)),
      number_(number),
      octets_(sizeof(EventRecord) + std::size(event_fields) * sizeof(void*)) {
  static const Variant none;
  for (const std::string_view path : event_fields) {
    const auto found = event_.fields.find(std::string(path));
    by_number_.push_back(found == event_.fields.end() ? &none : &found->second);
  }
  for (const auto& [path, value] : event_.fields) octets_ += path.size() + octets_of(value);
}

}  // namespace takt::opcua
