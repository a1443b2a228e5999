// SPDX-License-Identifier: Apache-2.0
// Publications and subscriptions over OPC UA PubSub on a simulated host: one NetworkMessage a sample, by the code that
// real nodes run.
#pragma once

#include <memory>
#include <vector>

#include "application/opc_ua_topic.hpp"
#include "scenario/resolved/resolved_applications.hpp"
#include "scenario/applications/topic_port.hpp"

namespace takt::scenario {

/// The port of UADP over UDP (OPC 10000-14, 7.3.2.2; IANA: opcua-udp).
inline constexpr std::uint16_t opc_ua_udp_port = 4840;

application::OpcUaAddress address_of(const ResolvedTopic& topic, const ResolvedThread& publication);

class OpcUaWriter final : public TopicWriter, private pubsub::PublishedData {
 public:
  /// The topic outlives it. Without a stream nobody hears it, and nothing is sent.
  OpcUaWriter(const application::TopicShape& topic, const application::OpcUaAddress& address,
              std::optional<models::StreamIndex> stream);

  void start(models::HostServices& host) override;
  WriteOutcome write(models::HostServices& host, uadp::Octets value) override;
  void crash() override;

 private:
  void publish(uadp::Octets network_message, const pubsub::Destination& destination) override;

  const application::TopicShape* topic_;
  application::OpcUaAddress address_;
  std::optional<models::StreamIndex> stream_;
  models::HostServices* host_ = nullptr;                        // of the present call
  std::unique_ptr<application::OpcUaPublication> publication_;  // what a crash loses
};

class OpcUaReader final : public TopicReader {
 public:
  /// The topic outlives it.
  OpcUaReader(const application::TopicShape& topic, std::vector<application::OpcUaAddress> heard);
  ~OpcUaReader() override;

  void start(models::HostServices& host) override;
  void receive(models::HostServices& host, uadp::Octets message) override;
  std::optional<uadp::Octets> next(models::HostServices& host) override;
  std::uint64_t lost() const override;
  void crash() override;

 private:
  struct Subscribing;
  const application::TopicShape* topic_;
  std::vector<application::OpcUaAddress> heard_;
  std::unique_ptr<Subscribing> subscribing_;  // what a crash loses
  std::uint64_t lost_ = 0;                    // before the last crash
};

}  // namespace takt::scenario
