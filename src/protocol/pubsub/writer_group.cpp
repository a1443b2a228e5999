// SPDX-License-Identifier: Apache-2.0
#include "pubsub/writer_group.hpp"

#include <limits>

namespace takt::pubsub {
namespace {

constexpr std::size_t most_messages = 255;  // that a PayloadHeader can name
constexpr std::int64_t ps_per_tick = 100'000;

uadp::DateTime utc(uadp::DateTime epoch, sim::LocalTime now) { return {epoch.ticks + now.ps() / ps_per_tick}; }

}  // namespace

WriterGroupSettings periodic_fixed_group(sim::Duration publishing_interval) {
  WriterGroupSettings settings;
  settings.publishing_interval = publishing_interval;
  settings.network_message_content_mask = network_message_content::periodic_fixed;
  return settings;
}

DataSetWriterSettings periodic_fixed_writer() {
  DataSetWriterSettings settings;
  settings.data_set_message_content_mask = data_set_message_content::periodic_fixed;
  settings.field_encoding = uadp::FieldEncoding::RawData;
  return settings;
}

WriterGroup::WriterGroup(uadp::PublisherId publisher_id, const WriterGroupSettings& settings)
    : publisher_id_(publisher_id), settings_(settings), message_(settings.max_network_message_size) {
  TAKT_CHECK(settings_.publishing_interval > sim::Duration(), "a PublishingInterval is longer than 0");
  TAKT_CHECK(
      settings_.publishing_offset >= sim::Duration() && settings_.publishing_offset < settings_.publishing_interval,
      "a PublishingOffset lies within the interval");
}

bool WriterGroup::add(const std::string& name, AnyDataSet& data_set, const DataSetWriterSettings& settings) {
  DataSetWriterSettings checked = settings;
  const bool needs_fixed_length = settings.field_encoding == uadp::FieldEncoding::RawData;
  if (needs_fixed_length && !raw_layout_of(data_set)) return false;
  if (settings.key_frame_count == 0) return false;
  for (const auto& writer : writers_)
    if (writer->id() == settings.data_set_writer_id) return false;
  // Without a PayloadHeader the receivers count on every DataSetMessage being there.
  if (!has(network_message_content::PayloadHeader)) checked.key_frame_count = 1;
  writers_.push_back(std::make_unique<DataSetWriter>(name, data_set, checked, settings_.max_network_message_size));
  writers_.back()->component().set_parent(component_.state());
  scratch_.resize(writers_.size() * settings_.max_network_message_size);
  composed_.reserve(writers_.size());
  ids_.reserve(writers_.size());
  return true;
}

void WriterGroup::update(PubSubState parent, sim::LocalTime now) {
  component_.set_parent(parent);
  for (const auto& writer : writers_) {
    if (!component_.operational()) writer->restart();
    writer->component().set_parent(component_.state());
  }
  if (!component_.operational())
    next_time_ = sim::LocalTime::never();
  else if (next_time_ == sim::LocalTime::never())
    plan_after(now);
}

/// The first begin of an interval after `now`, and the offset (OPC 10000-14, 5.4.1.2: now + P - now mod P).
void WriterGroup::plan_after(sim::LocalTime now) {
  const sim::Duration interval = settings_.publishing_interval;
  const sim::Duration since = now.since_start() - settings_.publishing_offset;
  sim::Duration into = since % interval;
  if (into < sim::Duration()) into += interval;
  next_time_ = now.plus_saturated(interval - into);
}

void WriterGroup::advance(sim::LocalTime now, PublishedData& stack) {
  if (!component_.operational()) return;
  const bool due = next_time_ <= now;
  bool changed = false;
  if (settings_.publish_on_change)
    for (const auto& writer : writers_) changed = changed || writer->changed();
  if (!due && !changed) return;
  publish(now, stack);
  if (!due) return;
  missed_intervals_ += static_cast<std::uint64_t>((now - next_time_) / settings_.publishing_interval);
  plan_after(now);
}

/// Each writer has its own share of the scratch, so one that is too long takes nothing from the others.
void WriterGroup::compose(sim::LocalTime now, uadp::DateTime timestamp) {
  composed_.clear();
  const std::size_t share = settings_.max_network_message_size;
  for (std::size_t i = 0; i < writers_.size(); ++i) {
    uadp::Writer writer(std::span<std::byte>(scratch_).subspan(i * share, share));
    switch (writers_[i]->compose(now, timestamp, settings_.keep_alive_time, writer)) {
      case Composed::message:
        composed_.push_back({writers_[i]->id(), i * share, writer.position()});
        break;
      case Composed::too_long:
        ++too_long_;
        break;
      case Composed::nothing:
        break;
    }
  }
  // Without a PayloadHeader nobody could tell which one is missing.
  if (!has(network_message_content::PayloadHeader) && composed_.size() != writers_.size()) composed_.clear();
}

void WriterGroup::publish(sim::LocalTime now, PublishedData& stack) {
  const uadp::DateTime timestamp = utc(settings_.epoch, now);
  compose(now, timestamp);
  const std::size_t header_octets = uadp::NetworkMessageEncoder(message_, header_of(timestamp, 1)).position();
  std::uint16_t number = 1;
  for (std::size_t first = 0; first < composed_.size();) {
    const std::size_t count = fitting(first, header_octets);
    const uadp::Octets octets = encode(first, count, timestamp, number);
    first += count;
    if (octets.empty()) {
      too_long_ += count;
      continue;
    }
    ++number;
    ++sequence_number_;
    stack.publish(octets, {settings_.writer_group_id, settings_.priority});
  }
}

/// How many DataSetMessages from `first` on go into one NetworkMessage; at least one.
std::size_t WriterGroup::fitting(std::size_t first, std::size_t header_octets) const {
  const bool payload_header = has(network_message_content::PayloadHeader);
  std::size_t size = header_octets + (payload_header ? 1U : 0U);
  std::size_t count = 0;
  while (first + count < composed_.size() && count < most_messages) {
    size += composed_[first + count].size + (payload_header ? 2U : 0U);
    const std::size_t sizes = payload_header && count > 0 ? 2 * (count + 1) : 0;
    if (count > 0 && size + sizes > settings_.max_network_message_size) break;
    ++count;
  }
  return count;
}

uadp::Octets WriterGroup::encode(std::size_t first, std::size_t count, uadp::DateTime timestamp, std::uint16_t number) {
  const auto append_all = [&](uadp::NetworkMessageEncoder&& encoder) {
    for (std::size_t i = first; i < first + count; ++i)
      encoder.append(uadp::Octets(scratch_).subspan(composed_[i].begin, composed_[i].size));
    return encoder.finish();
  };
  const uadp::NetworkMessageHeader header = header_of(timestamp, number);
  if (!has(network_message_content::PayloadHeader)) return append_all(uadp::NetworkMessageEncoder(message_, header));
  ids_.clear();
  for (std::size_t i = first; i < first + count; ++i) ids_.push_back(composed_[i].writer_id);
  return append_all(uadp::NetworkMessageEncoder(message_, header, ids_));
}

uadp::NetworkMessageHeader WriterGroup::header_of(uadp::DateTime timestamp, std::uint16_t number) const {
  namespace content = network_message_content;
  uadp::NetworkMessageHeader header;
  if (has(content::PublisherId)) header.publisher_id = publisher_id_;
  if (has(content::GroupHeader)) {
    uadp::GroupHeader& group = header.group.emplace();
    if (has(content::WriterGroupId)) group.writer_group_id = settings_.writer_group_id;
    if (has(content::GroupVersion)) group.group_version = settings_.group_version;
    if (has(content::NetworkMessageNumber)) group.network_message_number = number;
    if (has(content::SequenceNumber)) group.sequence_number = sequence_number_;
  }
  if (has(content::Timestamp)) header.timestamp = timestamp;
  if (has(content::Timestamp) && has(content::PicoSeconds)) header.picoseconds = std::uint16_t{0};
  return header;
}

}  // namespace takt::pubsub
