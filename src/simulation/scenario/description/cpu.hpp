// SPDX-License-Identifier: Apache-2.0
// What scenario files say of the processor of a host, and of what cryptography takes on it. See description.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "json/fields.hpp"
#include "plant/latency.hpp"
#include "sim/time.hpp"

namespace takt::scenario {

using namespace sim::literals;  // NOLINT: units in default values

/// As models::SchedulingPolicy, in its order.
enum class SchedulingPolicy : std::uint8_t { deadline, fifo, fair };

/// What the protocol stack and the clock do on a thread.
enum class StackPart : std::uint8_t { receive, transmit, gptp };

struct CpuThread {
  json::Source where;
  std::string name;
  SchedulingPolicy policy = SchedulingPolicy::fifo;
  std::optional<std::uint8_t> priority = {};
  std::optional<sim::Duration> deadline = {};
  std::optional<std::uint32_t> weight = {};
  std::optional<std::uint16_t> core = {};
  plant::Latency execution;
  sim::Duration non_preemptive;
  std::optional<plant::Latency> wake_up = {};
  std::vector<std::string> runs = {};
  std::vector<StackPart> stack = {};
  std::optional<sim::Duration> every = {};
  std::optional<sim::Duration> offset = {};
  bool operator==(const CpuThread&) const = default;
};

/// The cores of a host and the threads that share them.
struct Cpu {
  json::Source where;
  std::uint16_t cores = 1;
  sim::Duration switching;
  sim::Duration slice = 3_ms;
  std::vector<CpuThread> threads = {};
  bool operator==(const Cpu&) const = default;
};

/// How long a host takes for each message of Programs whose messages are secured.
struct Cryptography {
  json::Source where;
  sim::Duration seal;
  sim::Duration open;
  bool operator==(const Cryptography&) const = default;
};

const json::Object& describe(json::Type<Cryptography>);
const json::Enumeration& describe(json::Type<StackPart>);
const json::Enumeration& describe(json::Type<SchedulingPolicy>);
const json::Object& describe(json::Type<CpuThread>);
const json::Object& describe(json::Type<Cpu>);

}  // namespace takt::scenario
