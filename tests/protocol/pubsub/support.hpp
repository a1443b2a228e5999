// SPDX-License-Identifier: Apache-2.0
// A master and a slave in memory, and a stack that records.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "pubsub/communication.hpp"
#include "pubsub/memory_stack.hpp"

namespace takt::pubsub {

using namespace sim::literals;
using sim::LocalTime;
using uadp::PublisherId;

inline LocalTime at(sim::Duration since_start) { return LocalTime() + since_start; }

/// Keeps what was published; nothing is ever received.
struct RecordingStack final : PublishedData, SubscribedData {
  std::vector<std::vector<std::byte>> messages;
  std::vector<Destination> destinations;
  void publish(uadp::Octets message, const Destination& destination) override {
    messages.emplace_back(message.begin(), message.end());
    destinations.push_back(destination);
  }
  uadp::Octets next() override { return {}; }
};

/// Two Communications on one medium.
struct Pair {
  MemoryMedium medium;
  MemoryPort master_port{medium};
  MemoryPort slave_port{medium};
  Communication master{master_port, master_port};
  Communication slave{slave_port, slave_port};

  void enable() { enable(LocalTime()); }
  void enable(LocalTime time) {
    master.enable(time);
    slave.enable(time);
  }
  /// Steps both to `end` in steps of 100 us, and delivers at once.
  void run_until(LocalTime end, bool connected = true) {
    for (; now < end; now += 100_us) {
      master.advance(now);
      slave.advance(now);
      if (!connected)
        while (!slave_port.next().empty()) {
        }
      slave.poll(now);
      master.poll(now);
    }
  }
  LocalTime now;
};

}  // namespace takt::pubsub
