// SPDX-License-Identifier: Apache-2.0
// Publications and subscriptions over DDS: a DataWriter or DataReader of the application's participant in the domain of
// the topic.
#pragma once

#include "dds/persistence/persistence_service.hpp"
#include "scenario/applications/dds_node.hpp"
#include "scenario/applications/topic_port.hpp"

namespace takt::scenario {

/// The endpoint of a thread; the storage of its node and its name there are filled in where its durability asks for
/// them.
dds::WriterConfig writer_config(const ResolvedTopic& topic, const ResolvedThread& thread);
dds::ReaderConfig reader_config(const ResolvedTopic& topic, const ResolvedThread& thread);
dds::DurableTopic durable_topic(const ResolvedTopic& topic, const ResolvedService::Kept& kept);

class DdsWriter final : public TopicWriter {
 public:
  /// All outlive it; the topic, too.
  DdsWriter(DdsNode& node, const ResolvedTopic& topic, const ResolvedThread& thread, std::uint32_t thread_number);

  void start(models::HostServices& host) override;
  WriteOutcome write(models::HostServices& host, uadp::Octets payload) override;
  void crash() override { is_blocked_ = false; }
  std::optional<WriteOutcome> go_on(models::HostServices& host) override;

 private:
  WriteOutcome try_write(models::HostServices& host, uadp::Octets payload);

  DdsNode* node_;
  const gateway::KeyLayout* key_;
  dds::WriterConfig config_;
  dds::WriterHandle handle_;
  std::vector<std::byte> payload_;  // that waits for room
  bool is_blocked_ = false;
};

class DdsReader final : public TopicReader {
 public:
  DdsReader(DdsNode& node, const ResolvedTopic& topic, const ResolvedThread& thread, std::uint32_t thread_number);

  void start(models::HostServices& host) override;
  void receive(models::HostServices&, uadp::Octets) override {}  // the participant takes messages
  std::optional<uadp::Octets> next(models::HostServices& host) override;
  std::uint64_t lost() const override;
  std::uint64_t displaced() const override;
  std::uint64_t filtered() const override;
  void crash() override;

 private:
  DdsNode* node_;
  dds::ReaderConfig config_;
  dds::ReaderHandle handle_;
  std::optional<dds::Sample> sample_;              // that was taken last
  std::map<dds::Guid, dds::SequenceNumber> last_;  // that was taken
  std::uint64_t gaps_ = 0;                         // numbers that were passed over
  std::uint64_t lost_ = 0;                         // before the last crash, as the next
  std::uint64_t filtered_ = 0;
};

}  // namespace takt::scenario
