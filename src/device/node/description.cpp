// SPDX-License-Identifier: Apache-2.0
#include "node/description.hpp"

#include "json/record.hpp"
#include "pubsub/content_mask.hpp"
#include "wire/program_format.hpp"

namespace takt::node {
namespace {

// Of every message of a Program (UADP-Periodic-Fixed, OPC 10000-14, A.2.1).
constexpr std::int64_t network_message_mask = pubsub::network_message_content::periodic_fixed;
constexpr std::int64_t data_set_message_mask = pubsub::data_set_message_content::periodic_fixed;
constexpr std::int64_t field_mask = 0x20;  // RawData

struct Header {};
std::int64_t network_mask(const Header&) { return network_message_mask; }
std::int64_t data_set_mask(const Header&) { return data_set_message_mask; }
std::int64_t fields_mask(const Header&) { return field_mask; }
std::int64_t network_message_number(const Header&) { return 1; }

const json::Record& describe(json::Type<Header>) {
  static constexpr json::Output outputs[] = {
      json::output<&network_mask>("network_message_content_mask",
                                  "UadpNetworkMessageContentMask: PublisherId, GroupHeader, WriterGroupId, "
                                  "GroupVersion, NetworkMessageNumber and SequenceNumber."),
      json::output<&data_set_mask>("data_set_message_content_mask",
                                   "UadpDataSetMessageContentMask: Status and SequenceNumber; one DataSetMessage in "
                                   "each NetworkMessage, without DataSetWriterId."),
      json::output<&fields_mask>("data_set_field_content_mask", "DataSetFieldContentMask: RawData."),
      json::output<&network_message_number>("network_message_number", "Of all messages."),
  };
  static constexpr json::Record record{
      "message_header",
      "How every message is laid out: UADP-Periodic-Fixed (OPC 10000-14, A.2.1) with a PublisherId of type UInt16.",
      outputs};
  return record;
}

struct FieldRow {
  const wire::FieldOnWire* field = nullptr;
};
const std::string& field_name(const FieldRow& row) { return row.field->name; }
std::string_view field_type(const FieldRow& row) { return row.field->type; }
std::int64_t field_offset(const FieldRow& row) { return row.field->offset; }
std::int64_t field_count(const FieldRow& row) { return row.field->count; }

const json::Record& describe(json::Type<FieldRow>) {
  static constexpr json::Output outputs[] = {
      json::output<&field_name>("name", "Its name."),
      json::output<&field_type>("type", "The built-in type of OPC UA."),
      json::output<&field_count>("count", "So many of the type, one behind the other, each a field of its own."),
      json::output<&field_offset>("offset", "Where it begins in the NetworkMessage, in octets."),
  };
  static constexpr json::Record record{"message_field", "A field of a message.", outputs};
  return record;
}

const std::string& message_name(const DescribedMessage& message) { return message.message.name; }
const std::string& publisher(const DescribedMessage& message) { return message.message.publisher; }
std::int64_t publisher_id(const DescribedMessage& message) { return message.message.publisher_id; }
std::int64_t writer_group(const DescribedMessage& message) { return message.message.writer_group_id; }
std::int64_t octets(const DescribedMessage& message) { return message.message.octets; }
std::vector<FieldRow> fields(const DescribedMessage& message) {
  std::vector<FieldRow> all;
  for (const wire::FieldOnWire& field : message.message.fields) all.push_back({&field});
  return all;
}

}  // namespace

const json::Record& describe(json::Type<DescribedMessage>) {
  static constexpr json::Output outputs[] = {
      json::output<&message_name>("name", "`state`, the name of a data set, `bindings` or `announcement`."),
      json::output<&publisher>("publisher", "The participant or candidate that sends it."),
      json::output<&DescribedMessage::is_own>("own", "This node is it."),
      json::output<&publisher_id>("publisher_id", "PublisherId, a UInt16."),
      json::output<&writer_group>("writer_group_id", "WriterGroupId."),
      json::output<&octets>("octets", "Of the NetworkMessage, before it is secured."),
      json::output<&fields>("fields", "One behind the other, as RawData."),
  };
  static constexpr json::Record record{"message", "A message of the Program.", outputs};
  return record;
}

namespace {
std::int64_t version_of(const DescribedProgram& program) { return program.group_version; }

}  // namespace

const json::Record& describe(json::Type<DescribedProgram>) {
  static constexpr json::Output outputs[] = {
      json::output<&DescribedProgram::name>("name", "Its name."),
      json::output<&version_of>("group_version",
                                "GroupVersion of all its messages: a hash of what its participants must know alike."),
      json::output<&DescribedProgram::cycle>("cycle_ps", "PublishingInterval."),
      json::output<&DescribedProgram::messages>("messages", "Those of all participants."),
  };
  static constexpr json::Record record{"described_program", "A Program of the node.", outputs};
  return record;
}

namespace {
std::optional<Header> header(const NodeDescription& description) {
  return description.programs.empty() ? std::nullopt : std::optional(Header());
}
template <auto Member>
std::optional<std::int64_t> number(const NodeDescription& description) {
  return description.*Member ? std::optional<std::int64_t>(*(description.*Member)) : std::nullopt;
}
std::int64_t pcp_of(const NodeDescription& description) { return description.pcp; }

}  // namespace

const json::Record& describe(json::Type<NodeDescription>) {
  static constexpr json::Output outputs[] = {
      json::output<&NodeDescription::node>("node", "Its name."),
      json::output<&NodeDescription::transport>("transport", "`udp` or `ethernet`; `none`: topics of DDS alone."),
      json::output<&NodeDescription::destinations>("destinations", "Addresses to which it sends."),
      json::output<&number<&NodeDescription::udp_port>>("udp_port", "At which it listens; null over Ethernet."),
      json::output<&number<&NodeDescription::ether_type>>("ether_type", "Of its frames; null over UDP."),
      json::output<&number<&NodeDescription::vlan>>("vlan", "Of its frames; null: without a tag, or over UDP."),
      json::output<&pcp_of>("pcp", "Priority of what it sends."),
      json::output<&NodeDescription::security>(
          "security", "`none`, `sign` or `sign-and-encrypt`; SecurityGroups and keys are in the file of keys."),
      json::output<&header>("header", "How messages of Programs are laid out; null: it is in none."),
      json::output<&NodeDescription::programs>("programs", "Each that it is in."),
      json::output<&NodeDescription::topics>(
          "topics", "Topics of OPC UA that its applications and gateways publish and subscribe to."),
  };
  static constexpr json::Record record{"node_description", "What a node sends and hears.", outputs};
  return record;
}

NodeDescription description_of(const std::string& node, const Transport& transport) {
  NodeDescription made;
  made.node = node;
  if (const auto* const udp = std::get_if<UdpTransport>(&transport)) {
    made.transport = "udp";
    made.destinations = udp->destinations;
    made.udp_port = udp->port;
    made.pcp = udp->pcp;
  } else {
    const auto& ethernet = std::get<EthernetTransport>(transport);
    made.transport = "ethernet";
    made.destinations = {ethernet.destination};
    made.ether_type = wire::uadp_ether_type;
    made.vlan = ethernet.vlan;
    made.pcp = ethernet.pcp;
  }
  return made;
}

std::string security_text(const std::optional<MessageSecurity>& security) {
  return !security ? "none" : security->mode == security::MessageMode::sign ? "sign" : "sign-and-encrypt";
}

NodeDescription description_of(const LoadedConfig& loaded) {
  NodeDescription made = description_of(loaded.config.node, loaded.config.transport);
  made.security = security_text(loaded.config.security);
  for (const LoadedProgram& program : loaded.programs) {
    const wire::ProgramFormat& format = *program.endpoint.format;
    DescribedProgram& described = made.programs.emplace_back(
        DescribedProgram{format.shape().name, format.group_version(), program.endpoint.cycle, {}});
    std::vector<wire::MessageOnWire> messages = messages_of(format);
    if (program.roles)
      for (wire::MessageOnWire& message : messages_of(*program.roles->format)) messages.push_back(std::move(message));
    for (wire::MessageOnWire& message : messages) {
      const bool is_own = message.publisher == loaded.config.node;
      described.messages.push_back({std::move(message), is_own});
    }
  }
  return made;
}

std::string to_json(const NodeDescription& description) {
  return json::pretty(json::ShapeOf<NodeDescription>::write(description));
}

}  // namespace takt::node
