// SPDX-License-Identifier: Apache-2.0
#include "wire/message_list.hpp"

#include "sim/check.hpp"

namespace takt::wire {
namespace {

using uadp::BuiltInType;

/// Puts one field behind the other.
class Fields {
 public:
  explicit Fields(MessageOnWire& message) : message_(message) { message.octets = fields_at; }

  void add(std::string name, BuiltInType type, std::uint32_t count = 1) {
    message_.fields.push_back({std::move(name), uadp::name_of(type), count, message_.octets});
    message_.octets += count * static_cast<std::uint32_t>(uadp::fixed_octets(type));
  }

 private:
  MessageOnWire& message_;
};

void add_word(handshake::Variant variant, MessageOnWire& message) {
  Fields fields(message);
  fields.add("CurrentState", BuiltInType::Int32);
  if (variant != handshake::Variant::robust) return;
  for (const char* const name : {"Incarnation", "Run", "IntentNumber", "IntentRun"})
    fields.add(name, BuiltInType::UInt32);
  for (const char* const name : {"IntentKind", "IntentOrigin"}) fields.add(name, BuiltInType::Byte);
}

}  // namespace

std::vector<MessageOnWire> messages_of(const ProgramFormat& format) {
  const ProgramShape& shape = format.shape();
  const auto id = [&](std::size_t participant) {
    return static_cast<std::uint16_t>(shape.first_publisher_id + participant);
  };
  std::vector<MessageOnWire> messages;
  for (std::size_t p = 0; p < shape.participants.size(); ++p) {
    MessageOnWire& made =
        messages.emplace_back(MessageOnWire{"state", shape.participants[p], id(p), state_writer_group, 0, {}});
    add_word(shape.variant, made);
    TAKT_CHECK(made.octets == state_octets(shape.variant), "a state has its length");
  }
  for (std::size_t d = 0; d < shape.data_sets.size(); ++d) {
    const DataSetShape& data_set = shape.data_sets[d];
    MessageOnWire& made = messages.emplace_back(MessageOnWire{data_set.name,
                                                              shape.participants[data_set.from],
                                                              id(data_set.from),
                                                              static_cast<std::uint16_t>(first_data_writer_group + d),
                                                              0,
                                                              {}});
    Fields fields(made);
    fields.add("Run", BuiltInType::UInt32);
    for (const FieldShape& field : data_set.fields) fields.add(field.name, field.type, field.count);
    TAKT_CHECK(made.octets == process_data_octets(octets_of(data_set)), "process data have their length");
  }
  return messages;
}

std::vector<MessageOnWire> messages_of(const RoleFormat& format) {
  const RoleShape& shape = format.shape();
  std::vector<MessageOnWire> messages;
  MessageOnWire& table = messages.emplace_back(MessageOnWire{
      "bindings", shape.program.participants.front(), shape.program.first_publisher_id, table_writer_group, 0, {}});
  Fields bindings(table);
  bindings.add("Incarnation", BuiltInType::UInt32);
  for (std::size_t role = 0; role < format.roles(); ++role) {
    const std::string& name = shape.program.participants[1 + role];
    bindings.add("Candidate of " + name, BuiltInType::Byte);
    bindings.add("Life of " + name, BuiltInType::UInt32);
  }
  for (const std::string& candidate : shape.candidates) bindings.add("Used life of " + candidate, BuiltInType::UInt32);
  TAKT_CHECK(table.octets == table_octets(format.roles(), format.candidates()), "a table has its length");
  for (std::size_t c = 0; c < shape.candidates.size(); ++c) {
    MessageOnWire& made = messages.emplace_back(MessageOnWire{
        "announcement",
        shape.candidates[c],
        static_cast<std::uint16_t>(shape.program.first_publisher_id + shape.program.participants.size() + c),
        announcement_writer_group,
        0,
        {}});
    Fields fields(made);
    fields.add("Life", BuiltInType::UInt32);
    fields.add("Leaving", BuiltInType::Byte);
    fields.add("Skills", BuiltInType::UInt32, handshake::most_skills);
    TAKT_CHECK(made.octets == announcement_octets, "an announcement has its length");
  }
  return messages;
}

}  // namespace takt::wire
