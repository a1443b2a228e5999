#include "opcua/address_space/event.hpp"

#include <algorithm>

namespace takt::opcua {
namespace {

/// Of BaseEventType, TransitionEventType, ProgramTransitionEventType and the audit types (OPC 10000-5, 6.4; OPC 10000-16, 4.4).
constexpr std::string_view event_fields[] = {
    "EventId", "EventType", "SourceNode", "SourceName", "Time", "ReceiveTime", "LocalTime", "Message", "Severity",
    "Transition", "Transition/Id", "Transition/Name", "Transition/Number", "Transition/EffectiveDisplayName", "Transition/TransitionTime", "Transition/EffectiveTransitionTime",
    "FromState", "FromState/Id", "FromState/Name", "FromState/Number", "FromState/EffectiveDisplayName",
    "ToState", "ToState/Id", "ToState/Name", "ToState/Number", "ToState/EffectiveDisplayName", "IntermediateResult",
    "ActionTimeStamp", "Status", "ServerId", "ClientAuditEntryId", "ClientUserId", "MethodId", "InputArguments", "OldStateId", "NewStateId", "TransitionNumber", "1:Cause"};

}  // namespace

std::string path_of(const List<QualifiedName>& names) {
  std::string path;
  for (const QualifiedName& each : names)
    path += (path.empty() ? "" : "/") + (each.name_space == 0 ? std::string() : std::to_string(each.name_space) + ":") + each.name.value;
  return path;
}

bool is_event_field(const std::string& path) { return std::find(std::begin(event_fields), std::end(event_fields), path) != std::end(event_fields); }

}  // namespace takt::opcua
