// Filters of events (OPC 10000-4, 7.7 and 7.22.3): checked once, then asked for every event.
#pragma once

#include "opcua/address_space/address_space.hpp"
#include "opcua/address_space/event.hpp"

namespace takt::opcua {

/// What is wrong with a filter, clause by clause and element by element; `is_usable` if one clause selects something and all elements can be asked.
struct FilterCheck {
  EventFilterResult result;
  bool has_errors = false;
  bool is_usable = true;
};
FilterCheck check_filter(const EventFilter& filter, const AddressSpace& space);

/// The fields that the filter selects; those that the event has not are null.
List<Variant> selected_fields(const EventFilter& filter, const Event& event);

/// A filter that is usable, asked for an event. What cannot be told is no.
bool lets_pass(const ContentFilter& filter, const Event& event, const AddressSpace& space);

}  // namespace takt::opcua
