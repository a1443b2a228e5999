// SPDX-License-Identifier: Apache-2.0
// What the tests of wire/ share: a small Program, and a node in it that only remembers.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "wire/program_node.hpp"

namespace takt::wire::test {

using namespace sim::literals;
using handshake::PublishedState;
using handshake::Variant;

/// A master and `slaves` slaves; the master sends a Double and a UInt16, slave 1 a Byte.
inline ProgramShape shape(Variant variant = Variant::robust, std::size_t slaves = 2) {
  ProgramShape made;
  made.name = "p";
  made.variant = variant;
  made.first_publisher_id = 0x0100;
  for (std::size_t i = 0; i <= slaves; ++i) made.participants.push_back("h" + std::to_string(i));
  made.data_sets = {{"down", 0, {{"x", uadp::BuiltInType::Double, 1}, {"n", uadp::BuiltInType::UInt16, 1}}},
                    {"up", 1, {{"b", uadp::BuiltInType::Byte, 3}}}};
  return made;
}

/// A node in a Program, by hand: remembers what comes out of its turns. Its time is set by hand.
struct Bench {
  struct Sent {
    std::vector<std::byte> octets;
    pubsub::Destination destination;
  };
  explicit Bench(NodeSettings settings) : node(std::move(settings)) {}
  explicit Bench(EndpointSettings settings) : node({std::move(settings), {}}) {}

  void start() { carry_out(node.start(time)); }
  program::StatusCode call(program::Method method) {
    NodeOutputs& outputs = node.call(time, method);
    carry_out(outputs);
    return outputs.status;
  }
  void receive(uadp::Octets message) { carry_out(node.receive(time, message)); }
  void wake(std::size_t alarm) { carry_out(node.wake(time, alarm)); }
  void at(sim::Duration since_start) { time = sim::LocalTime() + since_start; }
  sim::Duration alarm(std::size_t number) const { return alarms.at(number).since_start(); }
  const handshake::Participant<64>& participant() const { return node.endpoint()->participant(); }
  const EndpointCounts& counts() const { return node.endpoint()->counts(); }

  void carry_out(NodeOutputs& outputs) {
    while (const auto* const output = outputs.next()) std::visit([this](const auto& what) { act(what); }, output->what);
  }
  void act(const SetAlarm& set) { alarms[set.alarm] = set.time; }
  void act(const Publish& message) {
    if (!message.is_state() && !message.is_of_roles())
      for (std::byte& octet : message.fields()) octet = fill_with;
    sent.push_back({{message.octets.begin(), message.octets.end()}, message.destination});
  }
  void act(const Stepped& step) {
    changes.insert(changes.end(), step.outputs.changes().begin(), step.outputs.changes().end());
  }
  void act(const ProcessDataMessage& message) { data.push_back(message); }
  void act(const auto&) {}

  ProgramNode node;
  sim::LocalTime time;
  std::map<std::size_t, sim::LocalTime> alarms;
  std::vector<Sent> sent;
  std::vector<handshake::StateChange> changes;
  std::vector<ProcessDataMessage> data;
  std::byte fill_with{};
};

inline EndpointSettings settings(std::uint8_t index, std::shared_ptr<const ProgramFormat> format) {
  EndpointSettings made;
  made.handshake.variant = format->shape().variant;
  made.handshake.role = index == 0 ? handshake::Role::master : handshake::Role::slave;
  made.handshake.index = index;
  made.handshake.slaves = static_cast<std::uint8_t>(format->participants() - 1);
  made.handshake.incarnation = 7;
  made.format = std::move(format);
  made.cycle = 1_ms;
  made.receive_timeout = 10_ms;
  made.initialisation = 2_ms;
  return made;
}

}  // namespace takt::wire::test
