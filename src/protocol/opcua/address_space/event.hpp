// SPDX-License-Identifier: Apache-2.0
// An event as a value: its type and its fields, by the path that a client selects them with.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "opcua/encoding/variant.hpp"
#include "opcua/services/filters.hpp"

namespace takt::opcua {

struct Event {
  NodeId type;
  NodeId source;
  bool is_audit = false;                  ///< for sessions that nobody else can read along with
  std::map<std::string, Variant> fields;  ///< by path
};

/// "Transition/Id"; names that are not of the standard with the index of their namespace: "1:Cause".
std::string path_of(const List<QualifiedName>& names);

/// The number of a field that some event of this server has; nothing for another path.
std::optional<std::size_t> event_field(const std::string& path);

/// An event that has happened: what all who are told of it share.
class EventRecord {
 public:
  EventRecord(Event event, std::uint64_t number);
  EventRecord(const EventRecord&) = delete;
  EventRecord& operator=(const EventRecord&) = delete;

  const Event& event() const { return event_; }
  /// One more with each event.
  std::uint64_t number() const { return number_; }
  /// Of a number that `event_field` gives; null if this event has none.
  const Variant& field(std::size_t number) const { return *by_number_[number]; }
  /// That it takes in memory, about.
  std::size_t octets() const { return octets_; }

 private:
  Event event_;
  std::uint64_t number_;
  std::vector<const Variant*> by_number_;
  std::size_t octets_ = 0;
};

}  // namespace takt::opcua
