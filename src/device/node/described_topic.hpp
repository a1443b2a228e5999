// SPDX-License-Identifier: Apache-2.0
// What messages of a topic of OPC UA look like, for who configures others by it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "json/type.hpp"
#include "sim/time.hpp"

namespace takt::json {
struct Record;
}

namespace takt::node {

struct DescribedField {
  std::string name;
  std::string type;
  std::optional<std::int64_t> array_length;  ///< nothing: a scalar
  std::optional<std::int64_t> max_string_length;
  std::optional<std::int64_t> offset;  ///< in the NetworkMessage; nothing: not RawData, so it may move
};

/// A thread or gateway that publishes to the topic, on whatever node.
struct DescribedPublication {
  std::string application;
  std::string thread;
  bool is_own = false;
  std::int64_t writer_group_id = 0;
  sim::Duration every;
};

struct DescribedTopic {
  std::string name;
  std::optional<std::string> publisher_id_type;  ///< nothing: messages have no PublisherId
  std::optional<std::string> publisher_id;
  std::vector<DescribedPublication> publications;
  bool is_heard = false;  ///< by this node
  std::int64_t data_set_writer_id = 0;
  std::int64_t network_message_content_mask = 0;
  std::int64_t data_set_message_content_mask = 0;
  std::int64_t data_set_field_content_mask = 0;
  std::int64_t key_frame_count = 1;
  std::int64_t group_version = 0;
  std::int64_t major_version = 0;
  std::int64_t minor_version = 0;
  std::optional<std::int64_t> configured_size = {};
  std::int64_t data_set_offset = 0;
  std::int64_t octets = 0;
  std::vector<DescribedField> fields;
};

const json::Record& describe(json::Type<DescribedField>);
const json::Record& describe(json::Type<DescribedPublication>);
const json::Record& describe(json::Type<DescribedTopic>);

}  // namespace takt::node
