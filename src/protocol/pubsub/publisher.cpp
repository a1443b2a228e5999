// SPDX-License-Identifier: Apache-2.0
#include "pubsub/publisher.hpp"

#include <algorithm>

namespace takt::pubsub {

Publisher::Publisher(uadp::PublisherId id, const WriterGroupSettings& default_group)
    : text_(id.text), id_(id), default_settings_(default_group) {
  id_.text = text_;
}

WriterGroup* Publisher::group(std::uint16_t id) const {
  for (const auto& each : groups_)
    if (each->id() == id) return each.get();
  return nullptr;
}

DataSetWriter* Publisher::writer(const std::string& name) const {
  for (const auto& each : groups_)
    for (const auto& writer : each->writers())
      if (writer->name() == name) return writer.get();
  return nullptr;
}

std::uint16_t Publisher::add_writer_group(const WriterGroupSettings& settings) {
  WriterGroupSettings complete = settings;
  if (complete.writer_group_id == 0) {
    complete.writer_group_id = 1;
    while (group(complete.writer_group_id) != nullptr) ++complete.writer_group_id;
  }
  if (group(complete.writer_group_id) != nullptr) return 0;
  const auto behind = std::find_if(groups_.begin(), groups_.end(),
                                   [&](const auto& each) { return each->settings().priority < complete.priority; });
  groups_.insert(behind, std::make_unique<WriterGroup>(id_, complete));
  return complete.writer_group_id;
}

/// DataSetWriterIds are unique within a Publisher.
std::uint16_t Publisher::free_writer_id() const {
  std::uint16_t id = 1;
  for (const auto& each : groups_)
    for (const auto& writer : each->writers()) id = std::max(id, static_cast<std::uint16_t>(writer->id() + 1));
  return id;
}

bool Publisher::add_data_set(const std::string& name, AnyDataSet& data_set, const DataSetWriterSettings& settings,
                             std::uint16_t writer_group_id) {
  if (writer(name) != nullptr) return false;
  DataSetWriterSettings complete = settings;
  if (complete.data_set_writer_id == 0) complete.data_set_writer_id = free_writer_id();
  for (const auto& each : groups_)
    for (const auto& writer : each->writers())
      if (writer->id() == complete.data_set_writer_id) return false;
  if (writer_group_id == 0) {
    if (default_group_ == 0) default_group_ = add_writer_group(default_settings_);
    writer_group_id = default_group_;
  }
  WriterGroup* const found = group(writer_group_id);
  return found != nullptr && found->add(name, data_set, complete);
}

void Publisher::update(PubSubState parent, sim::LocalTime now) {
  component_.set_parent(parent);
  for (const auto& each : groups_) each->update(component_.state(), now);
}

sim::LocalTime Publisher::next_time() const {
  sim::LocalTime next = sim::LocalTime::never();
  for (const auto& each : groups_) next = std::min(next, each->next_time());
  return next;
}

void Publisher::advance(sim::LocalTime now, PublishedData& stack) {
  for (const auto& each : groups_) each->advance(now, stack);
}

}  // namespace takt::pubsub
