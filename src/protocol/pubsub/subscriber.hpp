// SPDX-License-Identifier: Apache-2.0
// Subscriber: a PubSubConnection that receives from one Publisher, with its ReaderGroups (paper, IV).
#pragma once

#include <memory>
#include <vector>

#include "pubsub/data_set_reader.hpp"
#include "uadp/network_message.hpp"

namespace takt::pubsub {

/// The readers of one WriterGroup. Without a PayloadHeader in the messages they stand in the order of the writers.
struct ReaderGroup {
  std::uint16_t writer_group_id = 0;                         ///< 0: any
  std::optional<std::uint16_t> network_message_number = {};  ///< nothing: any
  std::uint32_t group_version = 0;                           ///< 0: any; messages that say none are heard
  std::vector<std::unique_ptr<DataSetReader>> readers;
  PubSubComponent component;
};

class Subscriber {
 public:
  /// Hears the Publisher with this id, and messages without a PublisherId; of nothing these alone.
  explicit Subscriber(const std::optional<uadp::PublisherId>& publisher_id);
  Subscriber(const Subscriber&) = delete;
  Subscriber& operator=(const Subscriber&) = delete;

  const std::optional<uadp::PublisherId>& publisher_id() const { return publisher_id_; }
  /// From now on messages without a PublisherId are not heard, unless no others are.
  void require_publisher_id() { needs_publisher_id_ = publisher_id_.has_value(); }

  /// Makes a further group and gives its index. The default group (any WriterGroupId) is made when it is first needed.
  std::size_t add_reader_group(std::uint16_t writer_group_id, std::optional<std::uint16_t> network_message_number = {},
                               std::uint32_t group_version = 0);

  /// Subscribes to a DataSet in the default group or in one made before. DataSets that are added in the order in which
  /// the Publisher adds them have its DataSetWriterIds by themselves. False if there is no such group or a name is
  /// taken.
  bool add_data_set(const std::string& name, AnyDataSet& data_set, const DataSetReaderSettings& settings = {},
                    std::optional<std::size_t> group = {});

  PubSubComponent& component() { return component_; }
  const std::vector<std::unique_ptr<ReaderGroup>>& groups() const { return groups_; }
  /// The reader with this name; nullptr if there is none.
  DataSetReader* reader(const std::string& name) const;

  void update(PubSubState parent);
  /// Takes what concerns it from a decoded NetworkMessage; false if nothing does.
  bool received(const uadp::NetworkMessage& message, sim::LocalTime now);
  sim::LocalTime next_time() const;
  void advance(sim::LocalTime now);

 private:
  void take(ReaderGroup& group, const uadp::NetworkMessage& message, sim::LocalTime now);

  std::string text_;  ///< of a PublisherId that is a String
  std::optional<uadp::PublisherId> publisher_id_;
  bool needs_publisher_id_ = false;
  std::optional<std::size_t> default_group_;
  std::uint16_t last_writer_id_ = 0;
  PubSubComponent component_;
  std::vector<std::unique_ptr<ReaderGroup>> groups_;
};

}  // namespace takt::pubsub
