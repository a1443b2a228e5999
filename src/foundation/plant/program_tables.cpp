// SPDX-License-Identifier: Apache-2.0
// The tables of the words that all files of Programs share. Decoding, resolved copies and schemas come from them.
#include <algorithm>

#include "plant/program.hpp"

namespace takt::handshake {

using json::name;

const json::Enumeration& describe(json::Type<Variant>) {
  static constexpr json::EnumName names[] = {
      name(Variant::robust, "robust",
           "state and greatest intent are published; survives loss, duplication and reordering"),
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

namespace takt::plant {
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
      name(DataType::boolean, "Boolean", "1 octet"), name(DataType::sbyte, "SByte", "1 octet"),
      name(DataType::byte, "Byte", "1 octet"),       name(DataType::int16, "Int16", "2 octets"),
      name(DataType::uint16, "UInt16", "2 octets"),  name(DataType::int32, "Int32", "4 octets"),
      name(DataType::uint32, "UInt32", "4 octets"),  name(DataType::int64, "Int64", "8 octets"),
      name(DataType::uint64, "UInt64", "8 octets"),  name(DataType::float32, "Float", "4 octets"),
      name(DataType::float64, "Double", "8 octets"),
  };
  static constexpr json::Enumeration table = json::enumeration<DataType>("an OPC UA data type", names);
  return table;
}

const json::Object& describe(json::Type<DataField>) {
  static constexpr json::Field fields[] = {
      required<&DataField::type>("type", "OPC UA built-in type."),
      optional<&DataField::count>("count", "Number of values.", {.min = 1, .max = 1500}),
  };
  static constexpr json::Object table =
      json::object<DataField>("data_field", "One field of a data set.", fields, {.shorthand = "type"});
  return table;
}

const json::Object& describe(json::Type<ProcessData>) {
  static constexpr json::Field fields[] = {
      required<&ProcessData::name>("name", "Unique in the program.", {.min_length = 1, .max_length = 200}),
      required<&ProcessData::from>("from", "The participant that publishes it, to all that subscribe to it."),
      required<&ProcessData::fields>("fields", "The fields of the data set.", {.min_items = 1, .max_items = 256}),
  };
  static constexpr json::Object table = json::object<ProcessData>(
      "process_data", "A data set that is published every cycle while both ends are Running.", fields);
  return table;
}

const json::Enumeration& describe(json::Type<Violations>) {
  static constexpr json::EnumName names[] = {
      name(Violations::forbidden, "forbidden", "a violated invariant fails the run"),
      name(Violations::reported, "reported", "violated invariants are findings, the verdict ignores them"),
  };
  static constexpr json::Enumeration table = json::enumeration<Violations>("a rule for violated invariants", names);
  return table;
}

const json::Object& describe(json::Type<Reply>) {
  static constexpr json::Field fields[] = {
      required<&Reply::to>("to", "The process data that is answered; published every cycle."),
      required<&Reply::with>(
          "with", "The process data that answers it: published when the host has processed the other, and then only."),
  };
  static constexpr json::Object table = json::object<Reply>(
      "reply", "Process data that answers other process data at once; the round trip is measured.", fields);
  return table;
}

const json::Object& describe(json::Type<Callers>) {
  static constexpr json::Field fields[] = {
      optional<&Callers::start>("Start", "The participants on which Start is called.",
                                {.min_items = 1, .max_items = 65}),
      optional<&Callers::suspend>("Suspend", "Likewise of Suspend.", {.min_items = 1, .max_items = 65}),
      optional<&Callers::resume>("Resume", "Likewise of Resume.", {.min_items = 1, .max_items = 65}),
      optional<&Callers::halt>("Halt", "Likewise of Halt.", {.min_items = 1, .max_items = 65}),
      optional<&Callers::reset>("Reset", "Likewise of Reset.", {.min_items = 1, .max_items = 65}),
  };
  static constexpr json::Object table = json::object<Callers>(
      "callers", "On which participants methods are called; a method that is not here is called on any of them.",
      fields);
  return table;
}

const std::optional<std::vector<std::string>>& callers_of(const Program& program, Method method) {
  constexpr std::optional<std::vector<std::string>> Callers::*all[] = {
      &Callers::start, &Callers::suspend, &Callers::resume, &Callers::halt, &Callers::reset};
  return program.callers.*all[program::index_of(method)];
}

const json::Object& describe(json::Type<Program>) {
  static constexpr json::Field fields[] = {
      required<&Program::name>("name", "Unique among streams and programs.", {.min_length = 1, .max_length = 200}),
      optional<&Program::variant>("variant", "Which handshake synchronises the participants."),
      required<&Program::master>("master", "The host of the master."),
      optional<&Program::slaves>("slaves", "The hosts of the slaves.", {.min_items = 1, .max_items = 64}),
      optional<&Program::roles>("roles",
                                "Roles instead of slaves: each is bound to a node that announces the skill it needs.",
                                {.min_items = 1, .max_items = 64}),
      optional<&Program::candidates>("candidates",
                                     "The only hosts that may have a role; all that offer a skill it needs if absent.",
                                     {.max_items = 64}),
      optional<&Program::absent>("absent", "Candidates that announce themselves only when the script lets them join.",
                                 {.max_items = 64}),
      optional<&Program::announce_every>("announce_every",
                                         "Interval of announcements; who misses three is gone. 10 cycles if absent.",
                                         {.min = 1_us, .max = 3600_s}),
      optional<&Program::on_replacement>(
          "on_replacement", "What follows when a node that was lost in a start or a run has been replaced."),
      optional<&Program::within>("within",
                                 "The program in which this one is nested: its master is a slave there, and it is "
                                 "started, suspended, resumed, reset and halted with it."),
      required<&Program::cycle>("cycle", "Publishing interval of state and process data.",
                                {.min = 1_us, .max = 3600_s}),
      optional<&Program::offset>(
          "offset",
          "Phase of publishing within the cycle; 0 in a run if absent, and then any for the search for the worst case. "
          "\"auto\": takt chooses one for each participant, at which its messages meet no others.",
          {.max = 3600_s}),
      optional<&Program::phases>("phases", "Other phases of single participants, by host.",
                                 {.max_items = 65, .items = {.max = 3600_s}}),
      optional<&Program::publish>("publish", "When the state is published."),
      optional<&Program::subscription>("subscription", "Who hears whom."),
      optional<&Program::receive_timeout>(
          "receive_timeout",
          "A peer that is silent for so long halts the group (MessageReceiveTimeout); 10 cycles if absent.",
          {.min = 1_us, .max = 3600_s}),
      optional<&Program::initialisation>("initialisation", "How long a participant stays in INIT.", {.max = 3600_s}),
      optional<&Program::pcp>("pcp", "Priority of its messages.", {.max = 7}),
      optional<&Program::vlan>("vlan", "VLAN of its messages.", {.max = 4094}),
      optional<&Program::violations>("violations", "What a violated invariant means for the verdict."),
      optional<&Program::publisher_id>(
          "publisher_id",
          "PublisherId of the master; the others have the next ones. Those behind the program before it if absent.",
          {.min = 1, .max = 65471}),
      optional<&Program::process_data>("process_data", "Data sets that the participants exchange.", {.max_items = 256}),
      optional<&Program::redundancy>("redundancy",
                                     "So many copies of each message take ways that share as little as the network "
                                     "allows (IEEE 802.1CB); hosts and stations send them and take out the later ones.",
                                     {.min = 2, .max = 2}),
      optional<&Program::paths>("paths",
                                "Ways of messages, each from the node of one member to that of another: all nodes in "
                                "order, taken in both directions. The other messages find their own.",
                                {.min_items = 1, .max_items = 4096, .items = {.min_items = 2, .max_items = 4096}}),
      optional<&Program::security>("security",
                                   "Its messages are signed, or signed and encrypted; neither if absent. Of a real "
                                   "node: `security` of the node."),
      optional<&Program::callers>("callers",
                                  "On which participants each method is called. The plant promises it: the script "
                                  "makes no other call, and no bound counts one."),
      optional<&Program::replies>("replies", "Process data that answers other process data at once.",
                                  {.max_items = 256}),
  };
  static constexpr std::string_view members[] = {"slaves", "roles"};
  static constexpr json::Group groups[] = {json::exactly_one_of(members)};
  static constexpr json::Object table = json::object<Program>(
      "program", "A distributed OPC UA Program: one master, its slaves, their handshake.", fields, {.groups = groups});
  return table;
}

Duration phase_of(const Program& program, std::string_view participant) {
  const auto own =
      std::ranges::find(program.phases, participant, [](const auto& phase) -> std::string_view { return phase.first; });
  return own != program.phases.end() ? own->second : program.offset.value_or(Duration()).value;
}

}  // namespace takt::plant
