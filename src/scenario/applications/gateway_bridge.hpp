// A gateway of a scenario: samples of a topic of one protocol through a gateway::Channel to samples of a topic of the other.
#pragma once

#include <memory>

#include "gateway/channel.hpp"
#include "scenario/applications/cdr_layout.hpp"
#include "scenario/applications/resolved_applications.hpp"
#include "scenario/applications/sample_data_set.hpp"

namespace takt::scenario {

/// The struct that CdrLayout writes; a problem is a line.
gateway::IdlStruct idl_struct_of(const ResolvedTopic& topic, std::vector<std::string>& problems);

/// How the fields of `from` become those of `to`, by their names; one of the two is of DDS. Nothing if there is a problem; each is a line.
std::optional<gateway::TypeMapping> mapping_between(const ResolvedTopic& from, const ResolvedTopic& to, std::vector<std::string>& problems);

class GatewayBridge {
 public:
  /// All outlive it.
  GatewayBridge(const ResolvedGateway& settings, const ResolvedTopic& from, const ResolvedTopic& to);

  /// The buffer is empty.
  void start();
  void crash();
  void receive(uadp::Octets sample, sim::LocalTime now);
  /// The sample that is to be sent now, if any; valid until the next call.
  std::optional<uadp::Octets> pull(sim::LocalTime now);
  gateway::ChannelFigures figures() const;

 private:
  const ResolvedGateway* settings_;
  gateway::TypeMapping mapping_;
  bool to_dds_;
  CdrLayout cdr_;                        // of the topic of DDS
  SampleDataSet fields_;                 // of the topic of OPC UA
  Sample out_;
  std::vector<std::byte> octets_;
  std::unique_ptr<gateway::Channel> channel_;
  gateway::ChannelFigures before_;       // what crashes have taken
};

}  // namespace takt::scenario
