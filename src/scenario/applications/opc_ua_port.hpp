// Publications and subscriptions over OPC UA PubSub: one NetworkMessage a sample, by the code that real nodes run.
#pragma once

#include <memory>
#include <vector>

#include "pubsub/communication.hpp"
#include "scenario/applications/resolved_applications.hpp"
#include "scenario/applications/sample_data_set.hpp"
#include "scenario/applications/topic_port.hpp"

namespace takt::scenario {

/// The port of UADP over UDP (OPC 10000-14, 7.3.2.2; IANA: opcua-udp).
inline constexpr std::uint16_t opc_ua_udp_port = 4840;

/// Who publishes, numbered as real nodes do it: a Publisher for each topic, and a WriterGroup with one DataSetWriter for each thread that publishes to it.
struct OpcUaAddress {
  std::uint16_t publisher_id = 0;
  std::uint16_t writer_group_id = 0;
  std::uint16_t data_set_writer_id = 0;
};

OpcUaAddress address_of(const ResolvedTopic& topic, const ResolvedThread& publication);

class OpcUaWriter final : public TopicWriter, private pubsub::PublishedData {
 public:
  /// The layout outlives it. Without a stream nobody hears it, and nothing is sent.
  OpcUaWriter(const SampleLayout& layout, const OpcUaAddress& address, std::optional<models::StreamIndex> stream);
  ~OpcUaWriter() override;

  /// Octets of a NetworkMessage; 0 if a sample is too long for one.
  static std::size_t message_octets(const SampleLayout& layout, const OpcUaAddress& address);

  void start(models::HostServices& host) override;
  WriteOutcome write(models::HostServices& host, uadp::Octets sample) override;
  void crash() override;

 private:
  struct Publishing;
  void publish(uadp::Octets network_message, const pubsub::Destination& destination) override;

  const SampleLayout* layout_;
  OpcUaAddress address_;
  std::optional<models::StreamIndex> stream_;
  models::HostServices* host_ = nullptr;        // of the present call
  std::size_t octets_ = 0;                      // of the last message
  std::unique_ptr<Publishing> publishing_;      // what a crash loses
};

class OpcUaReader final : public TopicReader {
 public:
  /// The layout outlives it.
  OpcUaReader(const SampleLayout& layout, std::vector<OpcUaAddress> heard);
  ~OpcUaReader() override;

  void start(models::HostServices& host) override;
  void receive(models::HostServices& host, uadp::Octets message) override;
  std::optional<uadp::Octets> next(models::HostServices& host) override;
  std::uint64_t lost() const override;
  void crash() override;

 private:
  struct Subscribing;
  const SampleLayout* layout_;
  std::vector<OpcUaAddress> heard_;
  std::unique_ptr<Subscribing> subscribing_;    // what a crash loses
  std::uint64_t lost_ = 0;                      // before the last crash
};

}  // namespace takt::scenario
