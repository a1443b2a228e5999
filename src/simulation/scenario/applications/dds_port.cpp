// SPDX-License-Identifier: Apache-2.0
#include "scenario/applications/dds_port.hpp"

#include <algorithm>

#include "scenario/applications/dds_qos.hpp"
#include "sim/check.hpp"

namespace takt::scenario {

dds::WriterConfig writer_config(const ResolvedTopic& topic, const ResolvedThread& thread) {
  dds::WriterConfig config;
  config.topic = topic.description->name;
  config.type = topic.shape.type.name;
  config.has_key = topic.shape.key.has_key();
  config.qos = writer_qos(thread.qos, thread.transport_priority);
  config.asynchronous = topic.description->publication == Publication::asynchronous;
  if (topic.description->flow_control) config.flow_controller = topic.description->name;
  return config;
}

dds::ReaderConfig reader_config(const ResolvedTopic& topic, const ResolvedThread& thread) {
  dds::ReaderConfig config;
  config.topic = topic.description->name;
  config.type = topic.shape.type.name;
  config.has_key = topic.shape.key.has_key();
  config.qos = reader_qos(thread.qos, thread.buffer);
  if (thread.filter) {
    config.content_filter = thread.filter->expression();
    config.passes = [&filter = *thread.filter](dds::Octets payload) { return filter.passes(payload); };
  }
  if (config.has_key)
    config.key_of = [&key = topic.shape.key](dds::PayloadKind kind, dds::Octets payload) {
      return kind == dds::PayloadKind::data ? key.of_data(payload) : key.of_key(payload);
    };
  return config;
}

dds::DurableTopic durable_topic(const ResolvedTopic& topic, const ResolvedService::Kept& kept) {
  return {topic.description->name, topic.shape.type.name, topic.shape.key.has_key(),
          writer_qos(kept.qos, kept.transport_priority)};
}

DdsWriter::DdsWriter(DdsNode& node, const ResolvedTopic& topic, const ResolvedThread& thread,
                     std::uint32_t thread_number)
    : node_(&node), key_(&topic.shape.key), config_(writer_config(topic, thread)) {
  config_.storage = node.storage(thread.qos.durability.value_or(plant::Durability::volatile_));
  if (config_.storage != nullptr) config_.persistence_guid = node.persistence_guid(thread_number);
}

void DdsWriter::start(models::HostServices& host) {
  const auto made = node_->participant().create_writer(config_, host.now());
  TAKT_CHECK(made.handle.has_value(), "a writer whose settings were checked");
  handle_ = *made.handle;
}

WriteOutcome DdsWriter::try_write(models::HostServices& host, uadp::Octets payload) {
  const dds::WriteResult result = node_->participant().write(handle_, key_->of_data(payload), payload, host.now());
  is_blocked_ = result.verdict == dds::WriteVerdict::would_block;
  if (is_blocked_) return WriteOutcome::waits;
  return result.verdict == dds::WriteVerdict::refused ? WriteOutcome::refused : WriteOutcome::published;
}

WriteOutcome DdsWriter::write(models::HostServices& host, uadp::Octets payload) {
  if (is_blocked_) return WriteOutcome::refused;
  const WriteOutcome outcome = try_write(host, payload);
  if (is_blocked_) payload_.assign(payload.begin(), payload.end());
  return outcome;
}

std::optional<WriteOutcome> DdsWriter::go_on(models::HostServices& host) {
  if (!is_blocked_) return std::nullopt;
  if (node_->is_write_timed_out(handle_)) {
    is_blocked_ = false;
    return WriteOutcome::timed_out;
  }
  if (!node_->is_write_possible(handle_)) return std::nullopt;
  const WriteOutcome outcome = try_write(host, payload_);
  return outcome == WriteOutcome::waits ? std::nullopt : std::optional(outcome);
}

DdsReader::DdsReader(DdsNode& node, const ResolvedTopic& topic, const ResolvedThread& thread,
                     std::uint32_t thread_number)
    : node_(&node), config_(reader_config(topic, thread)) {
  config_.storage = node.storage(thread.qos.durability.value_or(plant::Durability::volatile_));
  if (config_.storage != nullptr) config_.persistence_guid = node.persistence_guid(thread_number);
}

void DdsReader::start(models::HostServices& host) {
  const auto made = node_->participant().create_reader(config_, host.now());
  TAKT_CHECK(made.handle.has_value(), "a reader whose settings were checked");
  handle_ = *made.handle;
}

std::optional<uadp::Octets> DdsReader::next(models::HostServices& host) {
  do {
    sample_ = node_->participant().take(handle_, host.now());
    if (!sample_) return std::nullopt;
  } while (!sample_->info.valid_data);
  const auto [last, is_first] = last_.try_emplace(sample_->info.writer, sample_->info.number);
  if (!is_first && sample_->info.number > last->second) {
    gaps_ += static_cast<std::uint64_t>(sample_->info.number.value - last->second.value - 1);
    last->second = sample_->info.number;
  }
  return sample_->payload;
}

std::uint64_t DdsReader::lost() const {
  return lost_ + (node_->is_running() ? node_->participant().reader(handle_).rtps.sample_lost().total_count : 0);
}

std::uint64_t DdsReader::filtered() const {
  return filtered_ + (node_->is_running() ? node_->participant().reader(handle_).rtps.history().filtered() : 0);
}

std::uint64_t DdsReader::displaced() const { return gaps_ - std::min(gaps_, lost() + filtered()); }

void DdsReader::crash() {
  if (node_->is_running()) {
    lost_ = lost();
    filtered_ = filtered();
  }
  last_.clear();
}

}  // namespace takt::scenario
