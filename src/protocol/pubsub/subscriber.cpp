// SPDX-License-Identifier: Apache-2.0
#include "pubsub/subscriber.hpp"

#include <algorithm>

namespace takt::pubsub {
namespace {

/// A filter that names nothing lets all pass; a message that says nothing passes (OPC 10000-14, 6.2.9.3).
bool concerns(const ReaderGroup& group, const uadp::NetworkMessage& message) {
  if (!message.header.group) return true;
  const uadp::GroupHeader& header = *message.header.group;
  const bool same_group =
      group.writer_group_id == 0 || !header.writer_group_id || *header.writer_group_id == group.writer_group_id;
  const bool same_version =
      group.group_version == 0 || !header.group_version || *header.group_version == group.group_version;
  return same_group && same_version &&
         (!group.network_message_number || !header.network_message_number ||
          *group.network_message_number == *header.network_message_number);
}

}  // namespace

Subscriber::Subscriber(const std::optional<uadp::PublisherId>& publisher_id)
    : text_(publisher_id ? publisher_id->text : std::string_view()), publisher_id_(publisher_id) {
  if (publisher_id_) publisher_id_->text = text_;
}

std::size_t Subscriber::add_reader_group(std::uint16_t writer_group_id,
                                         std::optional<std::uint16_t> network_message_number,
                                         std::uint32_t group_version) {
  groups_.push_back(std::make_unique<ReaderGroup>());
  groups_.back()->writer_group_id = writer_group_id;
  groups_.back()->network_message_number = network_message_number;
  groups_.back()->group_version = group_version;
  groups_.back()->component.set_parent(component_.state());
  return groups_.size() - 1;
}

DataSetReader* Subscriber::reader(const std::string& name) const {
  for (const auto& group : groups_)
    for (const auto& each : group->readers)
      if (each->name() == name) return each.get();
  return nullptr;
}

bool Subscriber::add_data_set(const std::string& name, AnyDataSet& data_set, const DataSetReaderSettings& settings,
                              std::optional<std::size_t> group) {
  if (reader(name) != nullptr || (group && *group >= groups_.size())) return false;
  if (!group) {
    if (!default_group_) default_group_ = add_reader_group(0);
    group = default_group_;
  }
  DataSetReaderSettings complete = settings;
  if (complete.data_set_writer_id == 0) complete.data_set_writer_id = static_cast<std::uint16_t>(last_writer_id_ + 1);
  last_writer_id_ = std::max(last_writer_id_, complete.data_set_writer_id);
  ReaderGroup& target = *groups_[*group];
  target.readers.push_back(std::make_unique<DataSetReader>(name, data_set, complete));
  target.readers.back()->set_parent(target.component.state());
  return true;
}

void Subscriber::update(PubSubState parent) {
  component_.set_parent(parent);
  for (const auto& group : groups_) {
    group->component.set_parent(component_.state());
    for (const auto& each : group->readers) each->set_parent(group->component.state());
  }
}

bool Subscriber::received(const uadp::NetworkMessage& message, sim::LocalTime now) {
  if (message.header.publisher_id ? message.header.publisher_id != publisher_id_ : needs_publisher_id_) return false;
  bool any = false;
  for (const auto& group : groups_) {
    if (!concerns(*group, message)) continue;
    any = true;
    take(*group, message, now);
  }
  return any;
}

void Subscriber::take(ReaderGroup& group, const uadp::NetworkMessage& message, sim::LocalTime now) {
  if (message.writer_ids) {
    for (std::size_t i = 0; i < message.count(); ++i)
      for (const auto& each : group.readers)
        if (each->writer_id() == *message.writer_id(i)) each->take(message.data_set_message(i), now);
    return;
  }
  std::size_t begin = 0;
  for (const auto& each : group.readers) {
    const auto length = each->take(message.payload.subspan(begin), now);
    if (!length || *length > message.payload.size() - begin) return;
    begin += *length;
  }
}

sim::LocalTime Subscriber::next_time() const {
  sim::LocalTime next = sim::LocalTime::never();
  for (const auto& group : groups_)
    for (const auto& each : group->readers) next = std::min(next, each->next_time());
  return next;
}

void Subscriber::advance(sim::LocalTime now) {
  for (const auto& group : groups_)
    for (const auto& each : group->readers)
      if (each->next_time() <= now) each->advance(now);
}

}  // namespace takt::pubsub
