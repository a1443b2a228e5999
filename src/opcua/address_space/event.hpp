// An event as a value: its type and its fields, by the path that a client selects them with.
#pragma once

#include <map>
#include <string>

#include "opcua/encoding/variant.hpp"
#include "opcua/services/filters.hpp"

namespace takt::opcua {

struct Event {
  NodeId type;
  NodeId source;
  bool is_audit = false;                   ///< for sessions that nobody else can read along with
  std::map<std::string, Variant> fields;   ///< by path
};

/// "Transition/Id"; names that are not of the standard with the index of their namespace: "1:Cause".
std::string path_of(const List<QualifiedName>& names);

/// Some event of this server has a field of this path.
bool is_event_field(const std::string& path);

}  // namespace takt::opcua
