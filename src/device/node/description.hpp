// SPDX-License-Identifier: Apache-2.0
// What a node sends and hears, in full, so that another publisher or subscriber of OPC UA PubSub can be configured
// without listening in. `takt schema describe --reference` describes it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "json/type.hpp"
#include "node/config.hpp"
#include "node/described_topic.hpp"
#include "wire/message_list.hpp"

namespace takt::json {
struct Record;
}

namespace takt::node {

/// `none`, `sign` or `sign-and-encrypt`.
std::string security_text(const std::optional<MessageSecurity>& security);

struct DescribedMessage {
  wire::MessageOnWire message;
  bool is_own = false;  ///< this node publishes it; others it may hear
};

struct DescribedProgram {
  std::string name;
  std::uint32_t group_version = 0;
  Duration cycle;
  std::vector<DescribedMessage> messages;
};

struct NodeDescription {
  std::string node;
  std::string transport;  ///< "udp" or "ethernet"; "none": topics of DDS only
  std::vector<std::string> destinations = {};
  std::optional<std::uint16_t> udp_port = {};
  std::optional<std::uint16_t> ether_type = {};
  std::optional<std::uint16_t> vlan = {};
  std::uint8_t pcp = 0;
  std::string security = {};  ///< "none", "sign", "sign-and-encrypt"
  std::vector<DescribedProgram> programs = {};
  std::vector<DescribedTopic> topics = {};  ///< of a node of applications
};
const json::Record& describe(json::Type<DescribedMessage>);
const json::Record& describe(json::Type<DescribedProgram>);
const json::Record& describe(json::Type<NodeDescription>);

NodeDescription description_of(const LoadedConfig& loaded);
/// The part that the transport tells.
NodeDescription description_of(const std::string& node, const Transport& transport);
/// With its newline at the end.
std::string to_json(const NodeDescription& description);

}  // namespace takt::node
