// SPDX-License-Identifier: Apache-2.0
// Filters of events (OPC 10000-4, 7.7 and 7.22.3): checked and decoded once, then asked for every event.
//
// An element is evaluated once at most for an event, so the work of a question is bounded by the size of the filter.
#pragma once

#include <memory>

#include "opcua/address_space/address_space.hpp"
#include "opcua/address_space/event.hpp"
#include "opcua/server/settings.hpp"

namespace takt::opcua {

/// Asks for a field of an event, or for a part of it.
struct FieldOperand {
  std::optional<std::size_t> number;  ///< nothing: null for every event
  std::string range;
};

class DecodedFilter {
 public:
  /// A filter that `check_filter` finds usable.
  explicit DecodedFilter(const EventFilter& filter);

  /// Whether it lets an event pass. What cannot be decided is no.
  bool lets_pass(const EventRecord& record, const AddressSpace& space) const;
  /// The fields that it selects; those that the event has not are null.
  List<Variant> selected_fields(const EventRecord& record) const;
  /// Steps of a question at most: one an operand.
  std::uint64_t steps() const { return steps_; }
  std::size_t octets() const { return octets_; }
  std::size_t fields() const { return selected_.size(); }

 private:
  friend class Question;
  struct ElementReference {
    std::uint32_t index = 0;
  };
  using Operand = std::variant<Variant, ElementReference, FieldOperand>;
  struct Element {
    FilterOperator operation = FilterOperator::Equals;
    std::vector<Operand> operands;
  };
  Operand decoded(const ExtensionObject& operand);

  std::vector<FieldOperand> selected_;
  std::vector<Element> elements_;
  std::uint64_t steps_ = 1;
  std::size_t octets_ = 0;
};

/// What is wrong with a filter, clause by clause and element by element; `is_usable` if one clause selects something
/// and all elements can be asked.
struct FilterCheck {
  EventFilterResult result;
  bool has_errors = false;
  bool is_usable = true;
};
FilterCheck check_filter(const EventFilter& filter, const AddressSpace& space, const Limits& limits);

}  // namespace takt::opcua
