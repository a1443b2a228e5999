// SPDX-License-Identifier: Apache-2.0
// Publisher: a PubSubConnection that sends, with its WriterGroups (paper, IV: Publisher and its default WritingGroup).
#pragma once

#include "pubsub/writer_group.hpp"

namespace takt::pubsub {

class Publisher {
 public:
  /// `default_group` says how the group is that is made by itself for the first DataSet added without naming one.
  explicit Publisher(uadp::PublisherId id, const WriterGroupSettings& default_group = {});
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;

  uadp::PublisherId id() const { return id_; }

  /// Makes a further group and gives its WriterGroupId; 0 if the id is taken.
  std::uint16_t add_writer_group(const WriterGroupSettings& settings);

  /// Publishes a DataSet, in the default group or in one that was made before. False, and nothing has changed, if there
  /// is no such group, a name or id is taken, or the DataSet does not fit the encoding.
  bool add_data_set(const std::string& name, AnyDataSet& data_set, const DataSetWriterSettings& settings = {},
                    std::uint16_t writer_group_id = 0);

  PubSubComponent& component() { return component_; }
  const std::vector<std::unique_ptr<WriterGroup>>& groups() const { return groups_; }
  /// The writer with this name; nullptr if there is none.
  DataSetWriter* writer(const std::string& name) const;

  /// The state of the parent, of this or of a group may have changed.
  void update(PubSubState parent, sim::LocalTime now);
  sim::LocalTime next_time() const;
  /// Publishes what is due, groups of higher priority first.
  void advance(sim::LocalTime now, PublishedData& stack);

 private:
  WriterGroup* group(std::uint16_t id) const;
  std::uint16_t free_writer_id() const;

  std::string text_;  ///< of a PublisherId that is a String
  uadp::PublisherId id_;
  WriterGroupSettings default_settings_;
  std::uint16_t default_group_ = 0;  ///< its id; 0 before it is needed
  PubSubComponent component_;
  std::vector<std::unique_ptr<WriterGroup>> groups_;  ///< by falling priority
};

}  // namespace takt::pubsub
