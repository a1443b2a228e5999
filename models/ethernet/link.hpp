// SPDX-License-Identifier: Apache-2.0
// One direction of a link: the medium, what is on it, and what becomes of that.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "models/ethernet/frame_exchange.hpp"
#include "models/ethernet/reception_checks.hpp"
#include "models/ethernet/sizes.hpp"
#include "models/ethernet/traffic.hpp"
#include "models/fault/link_fault.hpp"
#include "models/host/os_latency.hpp"
#include "sim/simulation.hpp"

namespace takt::models {

/// Event kinds that a node understands.
enum class NodeEvent : sim::EventKind {
  frame_arrived = 0,  ///< the last bit is in and the node's fixed delay is over; argument: see ArrivalArgument
  taken_in = 1,       ///< the same at a host, and its operating system has passed the frame on, too
  first_free = 16,    ///< kinds from here on belong to the node type
};

/// The argument of frame_arrived: which frame came in through which port of the node, and what else the node should
/// know of it; nothing in the common case.
struct ArrivalArgument {
  enum Flag : std::uint16_t {
    check = 1,        ///< ask the link whether the frame has come (Link::receive), and look at its condition
    header_only = 2,  ///< only the header has come: the frame may be cut through
    duplicate = 4,    ///< chance on the link has made it, and has no more say
  };
  FrameIndex frame;
  std::uint16_t port = 0;
  std::uint16_t flags = 0;
  /// The link is to be asked.
  bool is_uncertain() const { return (flags & check) != 0; }
  static constexpr int frame_bits = 32;
  static constexpr int port_bits = 16;
  static constexpr std::uint64_t pack(FrameIndex frame, std::uint16_t port, unsigned flags = 0) {
    return static_cast<std::uint64_t>(flags) << (frame_bits + port_bits) |
           static_cast<std::uint64_t>(port) << frame_bits | frame.value;
  }
  static constexpr ArrivalArgument unpack(std::uint64_t argument) {
    return {FrameIndex{static_cast<std::uint32_t>(argument)}, static_cast<std::uint16_t>(argument >> 32),
            static_cast<std::uint16_t>(argument >> 48)};
  }
};

/// The far end of a link.
struct LinkEnd {
  sim::ComponentId node;
  std::uint16_t port = 0;
  /// From the last bit leaving the sender to the event at the node: propagation plus the node's fixed delay (forwarding
  /// delay of a bridge, fixed receive latency of a host). Folding them saves an event for each frame and hop. At most
  /// 17 s.
  sim::Duration delay;
  sim::Duration node_delay;                     ///< the node's share of it
  ReceptionChecks* reception_checks = nullptr;  ///< the node's; there if frames may be cut
};

class Link {
 public:
  /// Who receives, and what of.
  struct Reception {
    LinkEnd far_end;
    std::uint8_t noticed_priorities = 0;  ///< see notice_headers()
    Octets noticed_header{0};
  };

  /// `sender` is the port that sends, of `node`; `traffic` outlives the link.
  void connect(sim::ComponentId sender, sim::ComponentId node, Traffic& traffic, sim::Duration octet_time,
               LinkEnd far_end);
  bool is_connected() const { return traffic_ != nullptr; }
  const Reception& reception() const { return reception_; }
  /// Another node receives from now on. Precondition: the link is down, and what was on it has been lost.
  void redirect(const Reception& reception);
  sim::Duration octet_time() const { return sim::Duration::from_ps(std::int64_t{octet_time_ps_}); }
  /// The sending port.
  sim::ComponentId sender() const { return source_.id(); }

  /// The receiver may cut frames of these priorities through: tell it when so many octets from the preamble on have
  /// come (so many more if the frame has a VLAN tag or an R-TAG).
  void notice_headers(std::uint8_t priorities, Octets header) {
    reception_.noticed_priorities = priorities;
    reception_.noticed_header = header;
  }
  /// The sender marks frames, changes their tags, or may pass on damaged ones: the receiver looks at each.
  void check_arrivals() { set_every_arrival(port(), ArrivalArgument::check); }
  /// Something may go wrong; `path` names the direction in the random streams, e.g. "sw1 to sw2".
  void expect_faults(const sim::Simulation& simulation, std::string_view path);
  /// Precondition: expect_faults().
  void add_impairment(const Impairment& impairment) { fault_->add(impairment); }
  /// The receiver acts in another part of a divided run; `exchange` brings frames there. Preconditions: no fault is
  /// expected, no header noticed, no frame cut.
  void cross(FrameExchange& exchange, std::uint32_t part) {
    exchange_ = &exchange;
    far_part_ = part;
  }
  /// The receiver is a host that takes in all it gets in the order of this link, each frame after a latency that is
  /// drawn: `latency`, of the receiver, is asked when a frame starts, which saves an event; null: the receiver does it
  /// itself. Precondition: is_plain(), not checks(), and transmit_any() is not called.
  void fold_latency(LatencyLine* latency) {
    latency_ = latency;
    folds_latency_ = latency != nullptr ? 1 : 0;
  }
  bool folds_latency() const { return folds_latency_ != 0; }
  /// Nothing of all that, but that the receiver may look at each frame: the link is always up, and transmit() will do.
  bool is_plain() const { return reception_.noticed_priorities == 0 && exchange_ == nullptr && !fault_; }
  /// The receiver looks at each frame.
  bool checks() const { return static_cast<std::uint64_t>(every_arrival_) >> ArrivalArgument::port_bits != 0; }

  // The sending port.
  /// When the medium is free for the next frame: the gap after the last one is over.
  sim::TrueTime free_at() const { return free_at_; }
  /// The last bit of the frame under way leaves, or that of the last one has left.
  sim::TrueTime last_bit() const { return free_at_ - octet_time() * inter_packet_gap.count; }

  /// When the receiver is notified of a frame that transmit() puts on the medium at that instant.
  sim::TrueTime arrival_of(sim::TrueTime start, const Frame& record) const {
    return start + sim::Duration::from_ps(std::int64_t{octet_time_ps_} * (preamble_and_sfd.count + record.length) +
                                          static_cast<std::int64_t>(delay_ps_));
  }
  /// Puts a frame on the free medium. Preconditions: is_plain(); the frame is link-local or not folds_latency().
  /// Returns arrival_of() it.
  sim::TrueTime transmit(sim::Simulation& simulation, FrameIndex frame, const Frame& record) {
    const std::int64_t octet = octet_time_ps_;
    const std::int64_t until_last_bit = octet * (preamble_and_sfd.count + record.length);
    const sim::TrueTime now = simulation.now();
    free_at_ = now + sim::Duration::from_ps(until_last_bit + octet * inter_packet_gap.count);
    wire_octets_sent_ += wire_length(Octets{record.length}).count;
    const sim::TrueTime arrival = now + sim::Duration::from_ps(until_last_bit + static_cast<std::int64_t>(delay_ps_));
    simulation.schedule(source_, arrival, order_, static_cast<sim::EventKind>(NodeEvent::frame_arrived),
                        static_cast<std::uint64_t>(every_arrival_) << ArrivalArgument::frame_bits | frame.value);
    return arrival;
  }
  /// The same where folds_latency(), of a frame that is not link-local.
  void transmit_folded(sim::Simulation& simulation, FrameIndex frame, const Frame& record);
  /// What these two do of a frame that will start at `start`, at the earliest now. Precondition besides theirs: nothing
  /// else is put on the medium before.
  void transmit_at(sim::Simulation& simulation, sim::TrueTime start, FrameIndex frame, const Frame& record) {
    const std::int64_t octet = octet_time_ps_;
    const std::int64_t until_last_bit = octet * (preamble_and_sfd.count + record.length);
    free_at_ = start.plus_saturated(sim::Duration::from_ps(until_last_bit + octet * inter_packet_gap.count));
    wire_octets_sent_ += wire_length(Octets{record.length}).count;
    const sim::TrueTime arrival =
        start.plus_saturated(sim::Duration::from_ps(until_last_bit + static_cast<std::int64_t>(delay_ps_)));
    simulation.schedule(source_, folds_latency_ ? latency_->pass(arrival) : arrival, order_,
                        static_cast<sim::EventKind>(folds_latency_ ? NodeEvent::taken_in : NodeEvent::frame_arrived),
                        static_cast<std::uint64_t>(every_arrival_) << ArrivalArgument::frame_bits | frame.value);
  }
  /// The same for any frame: when the receiver is notified.
  sim::TrueTime transmit_any(sim::Simulation& simulation, FrameIndex frame, const Frame& record, bool is_preemptable);
  /// The same for what is left of a frame that was cut.
  sim::TrueTime transmit_rest(sim::Simulation& simulation, FrameIndex frame, const Frame& record, Octets remaining);
  /// Cuts the frame under way, whose arrival was scheduled at `arrival`; the medium is free at `free_at`.
  void cut(FrameIndex frame, sim::TrueTime arrival, sim::TrueTime free_at);
  /// An event for the sending port itself.
  void schedule_for_sender(sim::Simulation& simulation, sim::TrueTime time, sim::EventKind kind,
                           std::uint64_t argument) {
    ++other_events_;
    simulation.schedule(source_, time, order_for_sender_, kind, argument);
  }

  // The receiving node.
  /// Asked at an arrival that is uncertain, or at each (ReceptionChecks::has_cancelled_arrivals()), at the present
  /// instant. False: the frame has not come (it was cut and comes later, or it is lost and accounted for). Chance may
  /// damage it: then the index is that of a record of its own.
  bool receive(sim::Simulation& simulation, FrameIndex& frame, std::uint16_t flags) {
    if (!cancelled_arrivals_.empty() && consume_cancelled(simulation.now(), frame)) return false;
    return !fault_ || passes_faults(simulation, frame, flags);
  }
  /// Whatever it has sent has come: nothing was cut, nothing may fail.
  bool is_loss_free() const { return cancelled_arrivals_.empty() && !fault_; }
  /// When the frame of which only the header has come, at the present instant, will be here wholly.
  sim::TrueTime complete_at(sim::TrueTime now, const Frame& frame) const {
    return now + octet_time() * (std::int64_t{preamble_and_sfd.count} + frame.length - header_notice(frame).count);
  }
  /// The frame is being passed on although the node has it wholly at `complete` only.
  void passed_on(sim::TrueTime now, FrameIndex frame, const Frame& record, sim::TrueTime complete) {
    if (fault_) fault_->cut_through(frame, record, now, complete - reception_.far_end.node_delay);
  }

  // Faults. Precondition: expect_faults().
  /// True if that is a change. A link that goes down loses what is on it.
  bool set_up(sim::Simulation& simulation, bool up);
  bool is_up() const { return !fault_ || fault_->is_up(); }

  /// Each frame is one event; the others are wake-ups of the sender and what faults, cuts and cut-through need.
  std::uint64_t frames_sent() const { return source_.count() - other_events_; }
  /// Octets that occupied the medium, preamble and inter-packet gap included.
  std::uint64_t wire_octets_sent() const { return wire_octets_sent_; }
  /// Frames that chance took, or that were on the link when it went down.
  std::uint64_t frames_lost() const { return frames_lost_; }

 private:
  struct Withdrawn {  // an arrival that will not be, since its frame was cut
    sim::TrueTime time;
    FrameIndex frame;
  };
  sim::TrueTime schedule_arrival(sim::Simulation& simulation, FrameIndex frame, Octets after_preamble, unsigned flags);
  bool consume_cancelled(sim::TrueTime now, FrameIndex frame);
  bool passes_faults(sim::Simulation& simulation, FrameIndex& frame, std::uint16_t flags);
  void lose(sim::Simulation& simulation, FrameIndex frame, DropReason reason);
  /// Octets of a frame, preamble included, that have arrived when the receiver is notified of its header.
  Octets header_notice(const Frame& frame) const {
    return reception_.noticed_header + (frame.tagged ? vlan_tag : Octets{0}) + (frame.r_tagged ? r_tag : Octets{0});
  }
  std::uint16_t port() const { return static_cast<std::uint16_t>(every_arrival_); }
  void set_every_arrival(std::uint16_t port, unsigned flags) {
    every_arrival_ = (ArrivalArgument::pack(FrameIndex{0}, port, flags) >> ArrivalArgument::frame_bits) & 0xF'FFFF;
  }
  sim::Duration delay() const { return sim::Duration::from_ps(static_cast<std::int64_t>(delay_ps_)); }

  // What every frame touches: the 48 octets that share a cache line with the sending port.
  std::uint64_t order_ = 0;               // of events for the receiver (sim::Event::order_of)
  std::uint64_t delay_ps_ : 44 = 0;       // see LinkEnd::delay
  std::uint64_t every_arrival_ : 20 = 0;  // the argument of every arrival but for the frame: the port, and flags
  sim::TrueTime free_at_;
  std::uint64_t wire_octets_sent_ = 0;
  [[no_unique_address]] sim::EventSource source_;  // of the sending port
  std::uint32_t octet_time_ps_ : 31 = 0;
  std::uint32_t folds_latency_ : 1 = 0;  // latency_ is there
  // The rest.
  LatencyLine* latency_ = nullptr;  // see fold_latency()
  Traffic* traffic_ = nullptr;
  Reception reception_;
  std::uint64_t order_for_sender_ = 0;
  std::uint64_t other_events_ = 0;
  std::uint64_t frames_lost_ = 0;
  std::unique_ptr<LinkFault> fault_;
  std::vector<Withdrawn> cancelled_arrivals_;
  std::uint32_t far_part_ = 0;
  FrameExchange* exchange_ = nullptr;  // null: the receiver acts here
};

}  // namespace takt::models
