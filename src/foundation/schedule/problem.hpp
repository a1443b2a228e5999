// SPDX-License-Identifier: Apache-2.0
// What is to be scheduled: a network, streams, and what a schedule may do. Plain values; nothing here knows of
// scenarios.
//
// Times are picoseconds in 64 bits, at most `longest_time`, so that sums of a few never overflow. Whoever
// fills a problem from outside sees to it that indices and numbers are in range (interchange/schedules); everything
// else takes it for sound.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace takt::schedule {

using Ps = std::int64_t;
using NodeIndex = std::uint32_t;
using LinkIndex = std::uint32_t;
using StreamIndex = std::uint32_t;

inline constexpr Ps longest_time = Ps{1} << 56;  ///< some 20 hours
inline constexpr std::uint64_t ps_per_second = 1'000'000'000'000;

struct Node {
  std::string name;
  bool is_bridge = false;  ///< only bridges forward
};

/// One direction of a cable, and the port that sends on it.
struct Link {
  std::string name;
  NodeIndex from = 0;
  NodeIndex to = 0;
  Ps octet = 8'000;    ///< how long one octet takes
  Ps propagation = 0;  ///< from the last bit sent until it is in
  Ps forwarding = 0;   ///< from then until the frame is ready at every port of `to`; at a listener it is latency, too
  std::optional<std::uint32_t>
      cut_through;  ///< octets, preamble first, that must be in before forwarding begins, if the next link is as fast
  std::uint32_t entries = 1024;  ///< greatest length of the gate control list
};

struct Stream {
  std::string name;
  NodeIndex talker = 0;
  std::vector<NodeIndex> listeners;
  std::uint32_t octets = 64;  ///< destination address to FCS
  std::uint32_t frames = 1;   ///< a train: so many a period, back to back on every link
  Ps period = 0;
  Ps release = 0;              ///< repetition k is not sent before release + k period
  std::optional<Ps> deadline;  ///< repetition k is at all listeners by deadline + k period; may exceed the period
  std::optional<Ps> latency;   ///< longest time from the start at the talker until the last frame is at a listener
  std::optional<Ps> jitter;    ///< arrivals at a listener, each less k period, differ by at most this
  std::optional<std::vector<LinkIndex>> route;  ///< prescribed: a tree, each link behind the one that it continues
  std::uint8_t traffic_class = 7;
};

struct Model {
  std::uint32_t preamble = 8;  ///< octets before each frame; 0 where a format counts them in its sizes
  std::uint32_t gap = 12;      ///< octets between frames
  bool is_strict = false;      ///< each transmission repeats with its stream's period on every link
  bool no_wait = false;        ///< a frame leaves a bridge the moment it can
  Ps margin = 0;               ///< clocks of two nodes differ by at most this
  Ps tick = 1'000;             ///< intervals of gate control lists are multiples of this
  std::uint32_t guard_octets =
      0;  ///< for so long unscheduled classes are closed before a scheduled frame; 0: ports look at the length
};

struct Problem {
  std::string name;
  std::string source;
  Model model;
  std::vector<Node> nodes;
  std::vector<Link> links;
  std::vector<Stream> streams;
};

/// After how long everything repeats; nothing if that is longer than `longest_time`.
std::optional<Ps> hyperperiod(const Problem& problem);

}  // namespace takt::schedule
