// The tables of the words that all files of Programs share. Decoding, resolved copies and schemas come from them.
#include "vocabulary/program.hpp"

namespace takt::handshake {

using json::name;

const json::Enumeration& describe(json::Type<Variant>) {
  static constexpr json::EnumName names[] = {
      name(Variant::robust, "robust", "state and greatest intent are published; survives loss, duplication and reordering"),
      name(Variant::paper, "paper", "the published handshake: the state alone"),
  };
  static constexpr json::Enumeration table = json::enumeration<Variant>("a handshake", names);
  return table;
}

const json::Enumeration& describe(json::Type<Subscription>) {
  static constexpr json::EnumName names[] = {
      name(Subscription::star, "star", "the master hears all slaves, a slave the master"),
      name(Subscription::all_to_all, "all-to-all", "everybody hears everybody"),
  };
  static constexpr json::Enumeration table = json::enumeration<Subscription>("a subscription", names);
  return table;
}

}  // namespace takt::handshake

namespace takt::program {

using json::name;

const json::Enumeration& describe(json::Type<Method>) {
  static constexpr json::EnumName names[] = {
      name(Method::Start, "Start", "at the master (paper: anywhere)"),
      name(Method::Suspend, "Suspend", "anywhere"),
      name(Method::Resume, "Resume", "anywhere"),
      name(Method::Halt, "Halt", "anywhere"),
      name(Method::Reset, "Reset", "anywhere"),
  };
  static constexpr json::Enumeration table = json::enumeration<Method>("a Program control method", names);
  return table;
}

}  // namespace takt::program

namespace takt::vocabulary {
namespace {

using json::name;
using json::optional;
using json::required;

}  // namespace

const json::Enumeration& describe(json::Type<Publish>) {
  static constexpr json::EnumName names[] = {
      name(Publish::cyclic, "cyclic", "once a cycle"),
      name(Publish::on_change, "on-change", "once a cycle, and at once when the state changes"),
  };
  static constexpr json::Enumeration table = json::enumeration<Publish>("a publishing rule", names);
  return table;
}

const json::Enumeration& describe(json::Type<DataType>) {
  static constexpr json::EnumName names[] = {
      name(DataType::boolean, "Boolean", "1 octet"), name(DataType::sbyte, "SByte", "1 octet"),   name(DataType::byte, "Byte", "1 octet"),
      name(DataType::int16, "Int16", "2 octets"),    name(DataType::uint16, "UInt16", "2 octets"), name(DataType::int32, "Int32", "4 octets"),
      name(DataType::uint32, "UInt32", "4 octets"),  name(DataType::int64, "Int64", "8 octets"),   name(DataType::uint64, "UInt64", "8 octets"),
      name(DataType::float32, "Float", "4 octets"),  name(DataType::float64, "Double", "8 octets"),
  };
  static constexpr json::Enumeration table = json::enumeration<DataType>("an OPC UA data type", names);
  return table;
}

const json::Object& describe(json::Type<DataField>) {
  static constexpr json::Field fields[] = {
      required<&DataField::type>("type", "OPC UA built-in type."),
      optional<&DataField::count>("count", "Number of values.", {.min = 1, .max = 1500}),
  };
  static constexpr json::Object table = json::object<DataField>("data_field", "One field of a data set.", fields, {.shorthand = "type"});
  return table;
}

const json::Object& describe(json::Type<ProcessData>) {
  static constexpr json::Field fields[] = {
      required<&ProcessData::name>("name", "Unique in the program.", {.min_length = 1, .max_length = 200}),
      required<&ProcessData::from>("from", "The participant that publishes it, to all that subscribe to it."),
      required<&ProcessData::fields>("fields", "The fields of the data set.", {.min_items = 1, .max_items = 256}),
  };
  static constexpr json::Object table = json::object<ProcessData>("process_data", "A data set that is published every cycle while both ends are Running.", fields);
  return table;
}

}  // namespace takt::vocabulary
