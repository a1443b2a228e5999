// SPDX-License-Identifier: Apache-2.0
// What the keys of a topic mean together, wherever it is published.
#pragma once

#include <algorithm>
#include <span>

#include "plant/application.hpp"

namespace takt::plant {

/// Whether it is a number: what a pattern may be in.
constexpr bool is_number(TopicType type) { return type <= TopicType::float64; }
/// Whether values differ in length.
constexpr bool has_length(TopicType type) { return type == TopicType::string || type == TopicType::byte_string; }

constexpr bool has(const UadpLayout& layout, NetworkMessagePart part) {
  return std::find(layout.network_message.begin(), layout.network_message.end(), part) != layout.network_message.end();
}
constexpr bool has(const UadpLayout& layout, DataSetMessagePart part) {
  return std::find(layout.data_set_message.begin(), layout.data_set_message.end(), part) !=
         layout.data_set_message.end();
}
constexpr bool has(const UadpLayout& layout, DataValuePart part) {
  return layout.data_value &&
         std::find(layout.data_value->begin(), layout.data_value->end(), part) != layout.data_value->end();
}

/// Whether messages carry a UInt16 as PublisherId, a number of `publisher_id` or of the topic's position.
bool has_uint16_publisher(const Topic& topic);

/// Fields and their lengths, and how messages are laid out.
void check_fields_and_layout(const Topic& topic, json::Diagnostics& diagnostics);

/// Of topics, each of which so many threads and gateways publish to: receivers can tell apart who publishes. UInt16s
/// are whose who numbers them.
void check_publishers(std::span<const Topic> topics, std::span<const std::size_t> publications,
                      json::Diagnostics& diagnostics);

/// What a thread publishes to the topic: it has a field for the pattern, and values for fields that it has.
void check_payload(const Payload& payload, const Topic& topic, const json::Place& thread,
                   json::Diagnostics& diagnostics);

}  // namespace takt::plant
