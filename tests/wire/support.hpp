// What the tests of wire/ share: a small Program and an endpoint's host that only remembers.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "wire/program_endpoint.hpp"

namespace takt::wire::test {

using namespace sim::literals;
using handshake::PublishedState;
using handshake::Variant;

/// A master and `slaves` slaves; the master sends a Double and a UInt16, slave 1 a Byte.
inline ProgramShape shape(Variant variant = Variant::Robust, std::size_t slaves = 2) {
  ProgramShape made;
  made.name = "p";
  made.variant = variant;
  made.first_publisher_id = 0x0100;
  for (std::size_t i = 0; i <= slaves; ++i) made.participants.push_back("h" + std::to_string(i));
  made.data_sets = {{"down", 0, {{"x", uadp::BuiltInType::Double, 1}, {"n", uadp::BuiltInType::UInt16, 1}}},
                    {"up", 1, {{"b", uadp::BuiltInType::Byte, 3}}}};
  return made;
}

/// Remembers what an endpoint asks and says. Its time is set by hand.
struct Remembering final : EndpointHost {
  struct Sent {
    std::vector<std::byte> octets;
    pubsub::Destination destination;
  };
  sim::LocalTime time;
  std::map<std::size_t, sim::LocalTime> alarms;
  std::vector<Sent> sent;
  std::vector<handshake::StateChange> changes;
  std::vector<ProcessDataMessage> data;
  std::byte fill_with{};

  sim::LocalTime now() const override { return time; }
  void set_alarm(std::size_t alarm, sim::LocalTime at) override { alarms[alarm] = at; }
  void publish(uadp::Octets octets, const pubsub::Destination& destination) override {
    sent.push_back({{octets.begin(), octets.end()}, destination});
  }
  void stepped(const handshake::Outputs& outputs, const handshake::Word&) override {
    changes.insert(changes.end(), outputs.changes().begin(), outputs.changes().end());
  }
  void process_data(const ProcessDataMessage& message) override { data.push_back(message); }
  void fill(std::uint8_t, std::span<std::byte> fields) override {
    for (std::byte& octet : fields) octet = fill_with;
  }
};

inline EndpointSettings settings(std::uint8_t index, std::shared_ptr<const ProgramFormat> format) {
  EndpointSettings made;
  made.handshake.variant = format->shape().variant;
  made.handshake.role = index == 0 ? handshake::Role::Master : handshake::Role::Slave;
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
