// SPDX-License-Identifier: Apache-2.0
// The nodes of the mirror architecture of "DDS and OPC UA Protocol Coexistence Solution ..." (2021, section 3) as
// processes on this machine, and what their schedulers say: criteria 1 and 2 on a real operating system.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "json/type.hpp"

namespace takt::emulate {

/// The intervals of the tables, in ms, as their columns.
inline constexpr std::array<int, 4> coexistence_intervals = {10, 5, 2, 1};

/// What a thread of a node did at each interval, in per cent; nothing where it was not measured.
struct MeasuredThread {
  std::string protocol;                                ///< "DDS", "OPC UA"; of the gateway "gateway"
  std::string node;                                    ///< "update", "control", "diagnose", "gateway"
  std::string operation;                               ///< "publish", "subscribe"
  std::array<std::optional<double>, 4> success = {};   ///< criterion 1
  std::array<std::optional<double>, 4> buffered = {};  ///< criterion 2, of those that subscribe
  std::array<std::uint64_t, 4> tests = {};
  std::array<std::uint64_t, 4> discarded = {};  ///< windows at whose end the scheduler was not let run
  std::array<double, 4> late_p99_us = {};       ///< from an activation to waking up
};

/// What the shared buffer of the gateway did at each interval.
struct MeasuredBuffer {
  std::uint64_t received = 0;
  std::uint64_t forwarded = 0;
  std::uint64_t overwritten = 0;
  double mean_age_us = 0;
};

struct MeasuredCoexistence {
  std::string machine;                                        ///< kernel, processors, network
  std::vector<MeasuredThread> mirror;                         ///< case study 1: six nodes at once
  std::vector<MeasuredThread> gateway;                        ///< case study 2
  std::array<std::optional<MeasuredBuffer>, 4> buffers = {};  ///< of case study 2
};

struct CoexistenceSettings {
  int windows = 700;  ///< tests of 10 ms for each thread and interval; the tables have about 2800 in all
  std::string keep;   ///< folder for the nodes' files and statistics; "": they are removed
  std::function<void(const std::string&)> progress;
  bool (*stop_requested)(const void* context) = nullptr;
  const void* context = nullptr;
};

const json::Record& describe(json::Type<MeasuredThread>);
const json::Record& describe(json::Type<MeasuredBuffer>);
const json::Record& describe(json::Type<MeasuredCoexistence>);

/// In network namespaces with a bridge between them; over loopback where that is not permitted, which `machine` says.
/// Nothing, and `problem` says why, if a node failed or it was stopped. Nothing is left on the machine in any case.
std::optional<MeasuredCoexistence> measure_coexistence(const CoexistenceSettings& settings, std::string& problem);

/// For people, and for machines.
std::string to_text(const MeasuredCoexistence& measured);
std::string to_json(const MeasuredCoexistence& measured);

}  // namespace takt::emulate
