// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "interchange/ports.hpp"
#include "interchange/uadp/configuration.hpp"
#include "interchange/uadp/uadp.hpp"
#include "pubsub/content_mask.hpp"
#include "scenario/programs/program_shape.hpp"
#include "uadp/builtin_type.hpp"
#include "wire/message_list.hpp"

namespace takt::interchange {
namespace {

namespace file = uadp_configuration;
using file::Text;

constexpr std::uint16_t own_namespace = 1;
constexpr std::uint16_t only_message = 1;      // NetworkMessageNumber of UADP-Periodic-Fixed with one message a group
constexpr std::uint16_t data_set_offset = 15;  // octets of the headers before the DataSetMessage
constexpr const char* ethernet_profile = "http://opcfoundation.org/UA-Profile/Transport/pubsub-eth-uadp";
constexpr const char* fixed_layout = "http://opcfoundation.org/UA/PubSub-Layouts/UADP-Periodic-Fixed";

double ms(sim::Duration duration) { return static_cast<double>(duration.ps()) / 1e9; }

class ConfigurationWriter {
 public:
  ConfigurationWriter(const ExportRequest& request, Exported& exported)
      : r_(request.resolved), exported_(exported), configurations_(r_.plan.nodes.size()) {
    for (const scenario::ResolvedProgram& program : r_.programs) write(program);
    for (const scenario::ResolvedTopic& topic : r_.topics)
      exported_.lose("topic " + topic.description->name,
                     "what applications send and hear; takt node --describe tells it");
    for (std::uint32_t node = 0; node < configurations_.size(); ++node) {
      if (!request.concerns(node) || configurations_[node].connections.empty()) continue;
      const std::vector<std::byte> octets = file::file_of(configurations_[node]);
      exported_.files.push_back({r_.plan.nodes[node].name + ".uadp.bin",
                                 std::string(reinterpret_cast<const char*>(octets.data()), octets.size())});
    }
    if (exported_.files.empty() && exported_.losses.empty())
      exported_.mistake = "uadp: the scenario has no Programs whose messages could be configured";
  }

 private:
  void write(const scenario::ResolvedProgram& program) {
    const std::string where = "program " + program.name;
    if (program.has_roles()) return exported_.lose(where, "roles, whose nodes change while it runs");
    if (program.redundancy)
      exported_.lose(where, "redundant messages (IEEE 802.1CB), which bridges and interfaces are set to");
    if (program.description->publish != scenario::Publish::cyclic)
      exported_.lose(where, "that states are published on change, too");
    if (program.description->security)
      exported_.lose(where, "the keys of its group: only the mode and the name of the group are written");
    const auto format = scenario::formats_of(program, r_.topology).program;
    const std::vector<wire::MessageOnWire> messages = wire::messages_of(*format);
    for (std::size_t m = 0; m < messages.size(); ++m) {
      const bool is_state = m < program.members.size();
      const auto sender =
          is_state ? static_cast<std::uint8_t>(m) : program.process_data[m - program.members.size()].from;
      const models::StreamIndex stream =
          is_state ? program.members[m].state : program.stream_of(m - program.members.size());
      write({program, messages[m], *format, r_.plan.streams[stream.value], sender});
    }
  }

  struct Message {
    const scenario::ResolvedProgram& program;
    const wire::MessageOnWire& wire;
    const wire::ProgramFormat& format;
    const models::StreamPlan& stream;
    std::uint8_t sender;
  };

  void write(const Message& message) {
    publish(message, configurations_[message.stream.talker.value]);
    for (std::uint8_t p = 0; p < message.program.members.size(); ++p) {
      const models::NodeIndex node = message.program.members[p].node;
      if (std::ranges::find(message.stream.listeners, node) != message.stream.listeners.end())
        subscribe(message, p, configurations_[node.value]);
    }
  }

  file::Connection connection_of(const Message& message, std::uint32_t node, std::uint8_t participant) const {
    file::Connection connection;
    connection.name = Text(message.stream.name);
    connection.publisher_id =
        file::Variant(static_cast<std::uint16_t>(message.format.shape().first_publisher_id + participant));
    connection.transport_profile = Text(ethernet_profile);
    file::NetworkAddressUrl address;
    const auto& neighbours = r_.topology.neighbours[node];
    if (!neighbours.empty())
      address.network_interface = Text(interface_name(r_.plan.nodes[node].forwards(), neighbours.front().port));
    address.url = Text(fmt::format("opc.eth://{}:{}.{}", mac_text(mac_of(r_, message.stream.destination), '-'),
                                   message.stream.vlan, message.stream.priority.value_or(0)));
    connection.address = opcua::extension_of(address);
    return connection;
  }

  void publish(const Message& message, file::Configuration& into) {
    file::PublishedDataSet data_set;
    data_set.name = Text(message.stream.name);
    data_set.meta_data = meta_data_of(message);
    file::PublishedDataItems items;
    for (const file::FieldMetaData& field : data_set.meta_data.fields) {
      file::PublishedVariable variable;
      variable.variable = node_of(message, field);
      items.variables.push_back(std::move(variable));
    }
    data_set.source = opcua::extension_of(items);
    into.published_data_sets.push_back(std::move(data_set));

    file::DataSetWriter writer;
    writer.name = Text(message.stream.name);
    writer.data_set_name = Text(message.stream.name);
    writer.data_set_writer_id = message.wire.writer_group_id;
    writer.data_set_field_content_mask = pubsub::data_set_field_content::RawData;
    file::UadpDataSetWriterMessage writer_message;
    writer_message.data_set_message_content_mask = pubsub::data_set_message_content::periodic_fixed;
    writer_message.network_message_number = only_message;
    writer_message.data_set_offset = data_set_offset;
    writer.message_settings = opcua::extension_of(writer_message);

    file::WriterGroup group;
    group.name = Text(message.stream.name);
    group.security_mode = security_mode_of(message);
    group.security_group = security_group_of(message);
    group.writer_group_id = message.wire.writer_group_id;
    group.publishing_interval = ms(message.program.description->cycle);
    group.keep_alive_time = group.publishing_interval;
    group.header_layout = Text(fixed_layout);
    file::UadpWriterGroupMessage group_message;
    group_message.group_version = message.format.group_version();
    group_message.network_message_content_mask = pubsub::network_message_content::periodic_fixed;
    group_message.publishing_offset.push_back(ms(message.program.phases[message.sender]));
    group.message_settings = opcua::extension_of(group_message);
    group.writers.push_back(std::move(writer));

    file::Connection connection = connection_of(message, message.stream.talker.value, message.sender);
    connection.writer_groups.push_back(std::move(group));
    into.connections.push_back(std::move(connection));
  }

  void subscribe(const Message& message, std::uint8_t participant, file::Configuration& into) {
    file::DataSetReader reader;
    reader.name = Text(message.stream.name);
    reader.publisher_id = file::Variant(message.wire.publisher_id);
    reader.writer_group_id = message.wire.writer_group_id;
    reader.data_set_writer_id = message.wire.writer_group_id;
    reader.meta_data = meta_data_of(message);
    reader.data_set_field_content_mask = pubsub::data_set_field_content::RawData;
    reader.message_receive_timeout = ms(message.program.receive_timeout);
    reader.header_layout = Text(fixed_layout);
    reader.security_mode = security_mode_of(message);
    reader.security_group = security_group_of(message);
    file::UadpDataSetReaderMessage settings;
    settings.group_version = message.format.group_version();
    settings.network_message_number = only_message;
    settings.data_set_offset = data_set_offset;
    settings.network_message_content_mask = pubsub::network_message_content::periodic_fixed;
    settings.data_set_message_content_mask = pubsub::data_set_message_content::periodic_fixed;
    settings.publishing_interval = ms(message.program.description->cycle);
    reader.message_settings = opcua::extension_of(settings);
    file::TargetVariables targets;
    for (const file::FieldMetaData& field : reader.meta_data.fields) {
      file::FieldTarget target;
      target.data_set_field_id = field.data_set_field_id;
      target.target = node_of(message, field);
      targets.targets.push_back(std::move(target));
    }
    reader.subscribed_data_set = opcua::extension_of(targets);

    file::ReaderGroup group;
    group.name = Text(message.stream.name);
    group.security_mode = reader.security_mode;
    group.security_group = reader.security_group;
    group.readers.push_back(std::move(reader));
    file::Connection connection = connection_of(message, message.program.members[participant].node.value, participant);
    connection.reader_groups.push_back(std::move(group));
    into.connections.push_back(std::move(connection));
  }

  /// A field with a count is that many fields, as on the wire.
  static file::DataSetMetaData meta_data_of(const Message& message) {
    file::DataSetMetaData meta_data;
    meta_data.name = Text(message.stream.name);
    meta_data.major_version = meta_data.minor_version = message.format.group_version();
    for (const wire::FieldOnWire& field : message.wire.fields)
      for (std::uint32_t i = 0; i < field.count; ++i) {
        file::FieldMetaData made;
        made.name = Text(field.count == 1 ? field.name : fmt::format("{}.{}", field.name, i));
        for (std::uint8_t type = 0; type < uadp::built_in_types.size(); ++type)
          if (uadp::name_of(static_cast<uadp::BuiltInType>(type)) == field.type) made.built_in_type = type;
        made.data_type = file::NodeId(made.built_in_type);  // the data types of built-in types have their numbers
        // Readers find a field by its id: number of the group, then of the field.
        made.data_set_field_id.value.octets[0] = std::byte(message.wire.publisher_id & 0xFF);
        made.data_set_field_id.value.octets[1] = std::byte(message.wire.publisher_id >> 8);
        made.data_set_field_id.value.octets[2] = std::byte(message.wire.writer_group_id & 0xFF);
        made.data_set_field_id.value.octets[3] = std::byte(message.wire.writer_group_id >> 8);
        const std::size_t number = meta_data.fields.size() + 1;
        made.data_set_field_id.value.octets[14] = std::byte(number >> 8 & 0xFF);
        made.data_set_field_id.value.octets[15] = std::byte(number & 0xFF);
        meta_data.fields.push_back(std::move(made));
      }
    return meta_data;
  }

  static file::NodeId node_of(const Message& message, const file::FieldMetaData& field) {
    return {own_namespace, message.stream.name + "/" + field.name.value};
  }
  static std::int32_t security_mode_of(const Message& message) {
    const auto& security = message.program.description->security;
    return !security ? 1 : security->mode == security::MessageMode::sign ? 2 : 3;
  }
  static Text security_group_of(const Message& message) {
    return message.program.description->security ? Text(message.program.name) : Text();
  }

  const scenario::Resolved& r_;
  Exported& exported_;
  std::vector<file::Configuration> configurations_;  // by node
};

}  // namespace

Exported export_uadp(const ExportRequest& request) {
  Exported exported;
  ConfigurationWriter(request, exported);
  return exported;
}

}  // namespace takt::interchange
