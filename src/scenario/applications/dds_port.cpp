#include "scenario/applications/dds_port.hpp"

#include <algorithm>

#include "scenario/applications/dds_qos.hpp"
#include "sim/check.hpp"

namespace takt::scenario {

dds::WriterConfig writer_config(const ResolvedTopic& topic, const ResolvedThread& thread) {
  dds::WriterConfig config;
  config.topic = topic.description->name;
  config.type = topic.description->type.value_or(topic.description->name);
  config.qos = writer_qos(thread.qos, thread.transport_priority);
  config.asynchronous = topic.description->publication == Publication::asynchronous;
  if (topic.description->flow_control) config.flow_controller = topic.description->name;
  return config;
}

dds::ReaderConfig reader_config(const ResolvedTopic& topic, const ResolvedThread& thread) {
  dds::ReaderConfig config;
  config.topic = topic.description->name;
  config.type = topic.description->type.value_or(topic.description->name);
  config.qos = reader_qos(thread.qos, thread.buffer);
  return config;
}

DdsWriter::DdsWriter(DdsNode& node, const ResolvedTopic& topic, const ResolvedThread& thread, std::uint32_t thread_number)
    : node_(&node), layout_(topic.layout), config_(writer_config(topic, thread)), payload_(layout_.octets()) {
  config_.storage = node.storage(thread.qos.durability.value_or(vocabulary::Durability::volatile_));
  if (config_.storage != nullptr) config_.persistence_guid = node.persistence_guid(thread_number);
}

void DdsWriter::start(models::HostServices& host) {
  const auto made = node_->participant().create_writer(config_, host.now());
  TAKT_CHECK(made.handle.has_value(), "a writer whose settings were checked");
  handle_ = *made.handle;
}

bool DdsWriter::write(models::HostServices& host, uadp::Octets sample) {
  if (is_blocked_) return false;
  layout_.encode(sample, payload_);
  const dds::WriteResult result = node_->participant().write(handle_, dds::no_key, payload_, host.now());
  is_blocked_ = result.verdict == dds::WriteVerdict::would_block;
  return result.verdict != dds::WriteVerdict::refused;
}

void DdsWriter::go_on(models::HostServices& host) {
  if (!is_blocked_) return;
  if (node_->take_timed_out(handle_)) is_blocked_ = false;
  if (!node_->take_writable(handle_) || !is_blocked_) return;
  is_blocked_ = node_->participant().write(handle_, dds::no_key, payload_, host.now()).verdict == dds::WriteVerdict::would_block;
}

DdsReader::DdsReader(DdsNode& node, const ResolvedTopic& topic, const ResolvedThread& thread, std::uint32_t thread_number)
    : node_(&node), layout_(topic.layout), config_(reader_config(topic, thread)), sample_(topic.layout.zeros()) {
  config_.storage = node.storage(thread.qos.durability.value_or(vocabulary::Durability::volatile_));
  if (config_.storage != nullptr) config_.persistence_guid = node.persistence_guid(thread_number);
}

void DdsReader::start(models::HostServices& host) {
  const auto made = node_->participant().create_reader(config_, host.now());
  TAKT_CHECK(made.handle.has_value(), "a reader whose settings were checked");
  handle_ = *made.handle;
}

std::optional<uadp::Octets> DdsReader::next(models::HostServices& host) {
  while (const std::optional<dds::Sample> sample = node_->participant().take(handle_, host.now())) {
    if (!sample->info.valid_data) continue;
    const auto [last, is_first] = last_.try_emplace(sample->info.writer, sample->info.number);
    if (!is_first && sample->info.number > last->second) {
      gaps_ += static_cast<std::uint64_t>(sample->info.number.value - last->second.value - 1);
      last->second = sample->info.number;
    }
    if (layout_.decode(sample->payload, sample_)) return sample_;
  }
  return std::nullopt;
}

std::uint64_t DdsReader::lost() const { return lost_ + (node_->is_running() ? node_->participant().reader(handle_).rtps.sample_lost().total_count : 0); }

std::uint64_t DdsReader::displaced() const { return gaps_ - std::min(gaps_, lost()); }

void DdsReader::crash() {
  if (node_->is_running()) lost_ = lost();
  last_.clear();
}

}  // namespace takt::scenario
