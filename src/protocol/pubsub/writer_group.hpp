// SPDX-License-Identifier: Apache-2.0
// WriterGroup: publishes the DataSetMessages of its writers in one rhythm (OPC 10000-14, 6.2.6).
#pragma once

#include <memory>

#include "pubsub/data_set_writer.hpp"
#include "pubsub/stack.hpp"
#include "uadp/encoder.hpp"

namespace takt::pubsub {

struct WriterGroupSettings {
  std::uint16_t writer_group_id = 0;  ///< 0: the next free one of the Publisher, from 1 on
  sim::Duration publishing_interval = sim::Duration::from_ps(1'000'000'000);  ///< above 0
  /// Into the interval, which begins at multiples of publishing_interval on the local clock; 0 to below one interval.
  sim::Duration publishing_offset = {};
  sim::Duration keep_alive_time = {};  ///< 0: no keep-alives; otherwise at least the interval
  bool publish_on_change = false;      ///< in addition at once when the application has set one of the DataSets
  std::uint8_t priority = 0;
  std::uint32_t network_message_content_mask =
      network_message_content::PublisherId | network_message_content::GroupHeader |
      network_message_content::WriterGroupId | network_message_content::PayloadHeader;
  std::uint32_t group_version = 0;              ///< VersionTime
  std::size_t max_network_message_size = 1472;  ///< octets; 1472 is what UDP over IPv4 leaves of an Ethernet frame
  uadp::DateTime epoch = {};                    ///< the UTC time at local time 0, for time stamps
};

/// All octets of a group are at the offsets of UADP-Periodic-Fixed, A.2.1; its writers need `periodic_fixed_writer`.
WriterGroupSettings periodic_fixed_group(sim::Duration publishing_interval);
DataSetWriterSettings periodic_fixed_writer();

class WriterGroup {
 public:
  WriterGroup(uadp::PublisherId publisher_id, const WriterGroupSettings& settings);

  std::uint16_t id() const { return settings_.writer_group_id; }
  const WriterGroupSettings& settings() const { return settings_; }
  PubSubComponent& component() { return component_; }

  /// False if the id is taken already, or if the DataSet has no fixed length where it needs one.
  bool add(const std::string& name, AnyDataSet& data_set, const DataSetWriterSettings& settings);
  const std::vector<std::unique_ptr<DataSetWriter>>& writers() const { return writers_; }

  /// The group's or its parent's state may have changed: tells the writers, and plans the next publishing.
  void update(PubSubState parent, sim::LocalTime now);

  /// When it publishes next by the clock; never if it is not Operational.
  sim::LocalTime next_time() const { return next_time_; }
  /// Publishes if it is time, or if something has changed and the group publishes on change.
  void advance(sim::LocalTime now, PublishedData& stack);

  /// PublishingIntervals that passed without anybody calling `advance`.
  std::uint64_t missed_intervals() const { return missed_intervals_; }
  /// DataSetMessages that were longer than a NetworkMessage may be; they were not sent.
  std::uint64_t too_long() const { return too_long_; }

 private:
  struct Part {
    std::uint16_t writer_id = 0;
    std::size_t begin = 0;
    std::size_t size = 0;
  };

  void compose(sim::LocalTime now, uadp::DateTime timestamp);
  void publish(sim::LocalTime now, PublishedData& stack);
  void plan_after(sim::LocalTime now);
  bool has(std::uint32_t content) const { return (settings_.network_message_content_mask & content) != 0; }
  uadp::NetworkMessageHeader header_of(uadp::DateTime timestamp, std::uint16_t number) const;
  std::size_t fitting(std::size_t first, std::size_t header_octets) const;
  uadp::Octets encode(std::size_t first, std::size_t count, uadp::DateTime timestamp, std::uint16_t number);

  uadp::PublisherId publisher_id_;
  WriterGroupSettings settings_;
  PubSubComponent component_;
  std::vector<std::unique_ptr<DataSetWriter>> writers_;
  sim::LocalTime next_time_ = sim::LocalTime::never();
  std::uint16_t sequence_number_ = 0;
  std::uint64_t missed_intervals_ = 0;
  std::uint64_t too_long_ = 0;
  // Room that is used again in every interval.
  std::vector<std::byte> scratch_;
  std::vector<std::byte> message_;
  std::vector<Part> composed_;
  std::vector<std::uint16_t> ids_;
};

}  // namespace takt::pubsub
