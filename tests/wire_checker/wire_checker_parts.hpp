// SPDX-License-Identifier: Apache-2.0
// What WireChecker is made of; only its own two sources read this.
#pragma once

#include <algorithm>

#include "models/ethernet/sizes.hpp"
#include "tests/wire_checker/wire_checker.hpp"

namespace takt::wire_checker {

/// A frame on its way to a node.
struct WireChecker::Arrival {
  models::FrameIndex handle;
  models::Frame frame;
  std::uint16_t port = 0;  // of the receiving node
  std::uint32_t direction = 0;
  Ps looked_at = 0;  // when the node may act upon it: its header or its last bit is in
  Ps complete = 0;
  Ps least_jitter = 0;  // of the node
  Ps greatest_jitter = 0;
  /// The node may hand it on, or drop it, at that instant.
  bool acts_at(Ps now) const {
    return now == looked_at || now == complete ||
           (greatest_jitter > 0 && now >= complete + least_jitter && now <= latest());
  }
  Ps latest() const { return complete + greatest_jitter; }
  bool lost = false;     // on the link
  bool damaged = false;  // and dropped for it
  bool has_outcome = false;
  bool was_dropped = false;  // by the node, when only its header was there
  std::vector<IngressOracle::Verdict> verdicts;
  std::vector<std::uint32_t> missed;  // directions that it could have left by when only its header was there
};

struct WireChecker::Direction {
  PortChecker checker;
  std::uint32_t link = 0;
  std::uint32_t from = 0;  // nodes
  std::uint32_t to = 0;
  std::uint16_t to_port = 0;
  Ps delay = 0;              // propagation and the fixed delay of the receiving node
  std::uint8_t noticed = 0;  // priorities whose headers the peer looks at
  Ps header = 0;             // octets of an untagged one, preamble included
  bool duplicates = false;
};

struct WireChecker::Node {
  /// What became of a frame in the node at this instant.
  struct Outcome {
    models::StreamIndex stream;
    std::uint64_t sequence = 0;
    std::uint32_t direction = 0xFFFF'FFFF;  // of the port that took it; none: the node itself dropped it
    std::optional<models::DropReason> drop;
    std::size_t recorded = 0;  // its place in the batch
  };
  std::string name;
  bool is_end_station = true;
  bool forwards = false;
  Ps fixed_delay = 0;
  Ps least_jitter = 0;
  Ps greatest_jitter = 0;
  std::unique_ptr<IngressOracle> ingress;
  std::map<std::uint32_t, const models::StreamRecoveryConfig*> recoveries;  // of a host, by stream
  std::vector<Arrival> arrivals;
  std::vector<Outcome> outcomes;  // of this instant
  struct Recovered {
    std::set<std::pair<std::uint16_t, std::uint64_t>> passed;  // numbers of R-TAGs with the frames'
    Ps last = long_ago;
  };
  std::map<std::uint32_t, Recovered> recovered;          // by stream
  std::map<std::uint32_t, std::uint64_t> next_sequence;  // by stream, where order is kept
};

/// A trace record with the frame as it stood then.
struct WireChecker::Recorded {
  sim::TraceRecord record;
  models::Frame frame;
  Ps eligible = long_ago;
  bool is_of_queue = false;  // a start or a drop of a frame that waited
};

}  // namespace takt::wire_checker
