// SPDX-License-Identifier: Apache-2.0
// The way of a frame, hop by hop, and where its time went: parts that add up to its latency.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "models/ethernet/frame.hpp"
#include "models/ethernet/traffic.hpp"
#include "models/port_directory.hpp"
#include "sim/time.hpp"

namespace takt::explain {

using sim::Duration;
using sim::TrueTime;

/// Where time goes.
enum class Cause : std::uint8_t {
  os_transmit,   ///< the operating system, from the application to the network interface
  processor,     ///< the protocol stack waits for its host's processor, or is on it
  launch_time,   ///< kept by the network interface until its launch time
  ats,           ///< kept by a bridge until its ATS eligibility time
  higher_class,  ///< a frame of a higher class is on the medium
  precedence,    ///< a frame of a lower class that goes first all the same: express, or by its share of the bandwidth
  own_class,     ///< a frame of its class that came before it is
  lower_class,   ///< a frame of a lower class, which was on the medium already, is
  gate_closed,   ///< the gate of its class is closed; amount = the entry of the list
  guard,         ///< the gate is open, but not for long enough; amount = the entry of the list
  credit,        ///< the credit of its class is negative; amount = bits that are missing
  hold,          ///< the MAC holds preemptable frames
  preemption,    ///< what a cut costs: mCRC, gap, the preamble of the rest
  transmission,  ///< preamble and octets, or what of them must have come before the next node acts
  cable,         ///< on the cable
  forwarding,    ///< the fixed delay of the bridge
  jitter,        ///< what the bridge takes longer
  os_receive,    ///< the operating system, from the network interface to the application
  count
};
/// "os_transmit".
const char* name_of(Cause cause);
/// "the operating system, transmit".
std::string_view words_of(Cause cause);
/// Waiting for something else, as opposed to being on the way.
bool is_waiting(Cause cause);

struct FrameName {
  models::StreamIndex stream;
  std::uint64_t sequence = 0;
  auto operator<=>(const FrameName&) const = default;
};

struct Part {
  static constexpr std::uint32_t no_amount = 0xFFFF'FFFF;
  Cause cause = Cause::os_transmit;
  TrueTime begin;
  Duration length;
  std::optional<FrameName> who = {};  ///< whose frame is on the medium
  std::uint32_t amount = no_amount;   ///< see Cause
};

/// Why a frame of a class that the port cuts through was stored.
struct Stored {
  enum class Because : std::uint8_t {
    port,         ///< the port said why, when it had the header
    preemptable,  ///< the port before may cut it into fragments
    short_frame,  ///< it is not longer than its header
    timed,        ///< another port of the node sends its priority by eligibility times, which count from the last bit
    doubled,      ///< the link has made it of another one
  };
  Because because = Because::port;
  models::StoringDetail detail = {};  ///< of `port`
  std::optional<FrameName> who = {};  ///< which frame was on the medium
};

/// One port that the frame has left by, or waits at.
struct Hop {
  models::PortId port;
  models::NodeIndex peer;
  models::TrafficClass traffic_class = 0;
  TrueTime came;             ///< to the port
  TrueTime started;          ///< the first bit of its preamble; never() if it did not
  std::uint32_t octets = 0;  ///< DA to FCS
  std::uint32_t cuts = 0;
  std::optional<Stored> stored = {};
  std::vector<Part> parts;   ///< from then on, without gaps, to where the next hop begins or all ends
  bool is_reported = false;  ///< an earlier way has shared it: that of another copy of the frame
};

struct Way {
  enum class End : std::uint8_t { delivered, dropped, under_way };
  FrameName frame;
  models::Priority priority = 0;
  models::NodeIndex talker;
  TrueTime produced;
  std::vector<Part> before;  ///< the first port
  std::vector<Hop> hops;
  End end = End::delivered;
  models::NodeIndex node;                  ///< where it ended
  std::optional<std::uint16_t> port = {};  ///< that it was to leave by, or left by, when it was lost
  bool on_wire = false;                    ///< it was lost behind that port, not before it
  models::DropReason reason = {};          ///< of a dropped one
  TrueTime ended;
  Duration latency() const { return ended - produced; }
};

/// All parts in their order. They have no gaps and add up to the latency: a CHECK.
std::vector<Part> parts_of(const Way& way);

}  // namespace takt::explain
