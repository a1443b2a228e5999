// The sending side of a port: queues, transmission selection, medium. The same class serves hosts and bridges.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "models/egress/frame_queue.hpp"
#include "models/egress/mac_merge.hpp"
#include "models/egress/port_config.hpp"
#include "models/egress/port_shaping.hpp"
#include "models/ethernet/link_local.hpp"
#include "models/ethernet/sizes.hpp"
#include "models/ethernet/traffic.hpp"
#include "models/fault/link_fault.hpp"
#include "sim/simulation.hpp"

namespace takt::models {

/// Event kinds that a node understands.
enum class NodeEvent : sim::EventKind {
  frame_arrived = 0,  ///< the last bit is in and the node's fixed delay is over; argument: see ArrivalArgument
  first_free = 16,    ///< kinds from here on belong to the node type
};

/// What the receiving node should know of an arrival besides frame and port; nothing in the common case.
enum ArrivalNote : std::uint16_t {
  conditional = 1,   ///< ask the sending port whether it stands (EgressPort::confirm), and look at the frame's condition
  header_only = 2,   ///< only the header has come: the frame may be cut through
  withdrawable = 8,  ///< the frame may be cut on its way: ask the sending port whether it has come (EgressPort::has_come)
  confirmed = 4,     ///< what chance does to the frame on the link has been done
};

/// The argument of frame_arrived: which frame came in through which port of the node.
struct ArrivalArgument {
  FrameIndex frame;
  std::uint16_t port = 0;
  std::uint16_t notes = 0;
  static constexpr std::uint64_t pack(FrameIndex frame, std::uint16_t port, unsigned notes = 0) {
    return static_cast<std::uint64_t>(notes) << 48 | static_cast<std::uint64_t>(port) << 32 | frame.value;
  }
  static constexpr ArrivalArgument unpack(std::uint64_t argument) {
    return {FrameIndex{static_cast<std::uint32_t>(argument)}, static_cast<std::uint16_t>(argument >> 32), static_cast<std::uint16_t>(argument >> 48)};
  }
};

/// The far end of a link, as the sending port needs it.
struct LinkEnd {
  sim::ComponentId node;
  std::uint16_t port = 0;
  /// From the last bit leaving the sender to the event at the node: propagation plus the node's fixed delay (forwarding delay of
  /// a bridge, fixed receive latency of a host). Folding them saves an event for each frame and hop. At most 17 s.
  sim::Duration delay;
  sim::Duration node_delay;    ///< the node's share of it
};

class alignas(64) EgressPort final : public sim::Component {
 public:
  /// What all ports of a network share.
  struct Shared {
    Traffic* traffic = nullptr;
    LinkLocalSender* link_local = nullptr;
    QueueEntryPool entries;
  };

  EgressPort() = default;

  /// Connects the port. `octet_time` is that of the link; `config`, `clock` and `opposite`, the other direction's port, outlive
  /// the port.
  void connect(sim::Simulation& simulation, Shared& shared, const PortConfig& config, const LocalClock& clock, sim::Duration octet_time,
               LinkEnd far_end, EgressPort* opposite = nullptr);
  /// The peer may cut frames of these priorities through: tell it when so many octets from the preamble on have come (so many
  /// more if the frame has a VLAN tag or an R-TAG).
  void notice_headers(std::uint8_t priorities, Octets header);
  /// offer_header() will be called.
  void expect_headers();
  /// The node marks frames, changes their tags, or may send damaged ones: the peer looks at each.
  void make_conditional();
  /// Something may go wrong on this direction of the link; `path` names it in the random streams, e.g. "sw1 to sw2".
  void expect_faults(const sim::Simulation& simulation, std::string_view path);

  /// Hands the port a frame at the present instant. Frames that come at one instant are put into a canonical order, by
  /// `rank` (the ingress port in a bridge, the talker in a host), so that it does not matter which was handed over first.
  void offer(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank);

  /// The same as the last act of an event handler: spares the detour if nothing else happens at this instant. `record` is that of
  /// the frame.
  void offer_last(sim::Simulation& simulation, FrameIndex frame, const Frame& record, std::uint32_t rank) {
    if (simulation.instant_is_surely_complete() && simulation.now() >= busy_until_ && way_ == Way::straight) [[likely]]
      start(simulation, frame, record);
    else
      take_last(simulation, frame, record, rank);
  }

  /// The same for a frame of which only the header has come: it may start at once if this port cuts its class through, the medium
  /// is free, nothing waits and the link it comes from is as fast. Otherwise it is offered at `stored`, when it has wholly come
  /// and the node's fixed delay is over, or dropped then if it turns out to be damaged. `sender` is the port from which it comes.
  /// Precondition: expect_headers().
  void offer_header(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank, sim::TrueTime stored, EgressPort& sender) {
    extras_->headers.push_back({frame, rank, stored, &sender});
    settle_later(simulation);
  }

  /// The medium may have become free, or a class may have become eligible.
  void handle(sim::Simulation& simulation, const sim::Event& event) override;
  /// All frames of this instant are here: selects, starts, queues.
  void settle(sim::Simulation& simulation) override;

  /// The clock has changed its rate or was stepped: what waits for a local time asks again.
  void clock_changed(sim::Simulation& simulation);

  /// Brings what a frame touches at a free port towards the cache.
  void prefetch_hot() const { __builtin_prefetch(this, 1); }

  /// The receiving node asks for an arrival with the note `conditional` at the present instant. False: the frame has not come
  /// (it was cut and comes later, or it is lost and accounted for). Chance may damage it: then the index is that of a record of
  /// its own.
  bool confirm(sim::Simulation& simulation, FrameIndex& frame, std::uint16_t notes);
  /// The same for a note `withdrawable` alone: false if the frame was cut and comes later.
  bool has_come(sim::TrueTime now, FrameIndex frame) { return !extras_ || extras_->withdrawn.empty() || !take_withdrawn(now, frame); }
  /// force_gate() will be called.
  void expect_stuck_gates() { make_shaping(); }
  /// Faults (precondition: expect_faults). A link that goes down loses what is on it and what waits for it; while it is down, what is offered.
  void set_up(sim::Simulation& simulation, bool up);
  /// Precondition: expect_faults.
  void add_impairment(const Impairment& impairment) { extras_->fault->add(impairment); }
  /// What waits in the queues is lost for that reason; so is a frame under way.
  void flush(sim::Simulation& simulation, DropReason reason);
  void force_gate(sim::Simulation& simulation, TrafficClass q, std::optional<bool> open);

  /// Management sets ConfigChange: another gate list (IEEE 802.1Q 8.6.9.3).
  ConfigChange request_gates(sim::Simulation& simulation, const GateConfig& gates);
  sim::Duration octet_time() const { return sim::Duration::from_ps(octet_time_ps_); }
  /// How many octets of a frame, preamble included, have come when the peer is told of its header.
  Octets header_notice(const Frame& frame) const {
    return extras_->noticed_header + (frame.tagged ? vlan_tag : Octets{0}) + (frame.r_tagged ? r_tag : Octets{0});
  }
  /// Frames that were passed on although their FCS was wrong.
  std::uint64_t bad_fcs_forwarded() const { return extras_ ? extras_->bad_fcs_forwarded : 0; }
  /// Frames that were passed on before they had come wholly.
  std::uint64_t frames_cut_through() const { return extras_ ? extras_->frames_cut_through : 0; }
  /// What the port has beyond strict priority, or null.
  PortShaping* shaping() const { return shaping_.get(); }
  const MacMerge* merge() const { return extras_ ? extras_->merge.get() : nullptr; }
  EgressPort* opposite() const { return opposite_; }
  /// A number between those of other ports may have no link.
  bool is_connected() const { return shared_ != nullptr; }
  bool untags() const { return config_->untagged; }
  const PortConfig& config() const { return *config_; }
  const LocalClock& clock() const { return *clock_; }

  sim::ComponentId id() const { return source_.id(); }
  const PortQueues& queues() const { return queues_; }
  /// Each frame is one event of the port; the others are wake-ups and what faults, cuts and cut-through need.
  std::uint64_t frames_sent() const { return source_.count() - other_events_; }
  /// Octets that occupied the medium, preamble and inter-packet gap included.
  std::uint64_t wire_octets_sent() const { return wire_octets_sent_; }
  std::uint64_t frames_dropped() const { return frames_dropped_; }

 private:
  static constexpr sim::EventKind wake_up = 0;
  static constexpr sim::EventKind stored_frame = 1;  // a frame that was not cut through has come wholly
  struct Arrival {
    FrameIndex frame;
    std::uint32_t rank = 0;
  };
  /// What happens to a frame that comes alone to a free medium.
  enum class Way : std::uint8_t {
    straight,  ///< it starts
    gated,     ///< it starts when its gate lets it; nothing else has a say, and nothing waits
    merging,   ///< it starts; it may be cut later, or is express; nothing else has a say, nothing waits
    detour,    ///< frames wait already, or there is more to consider
  };
  /// What few ports have besides shaping.
  struct Extras {
    std::unique_ptr<MacMerge> merge;
    std::unique_ptr<LinkFault> fault;
    std::uint8_t noticed_priorities = 0;
    Octets noticed_header{0};
    bool conditional = false;
    bool expects_headers = false;
    std::uint64_t bad_fcs_forwarded = 0;
    std::uint64_t frames_cut_through = 0;
    struct Withdrawn {                 // an arrival that will not be, since its frame was cut
      sim::TrueTime time;
      FrameIndex frame;
    };
    std::vector<Withdrawn> withdrawn;
    struct HeaderArrival {
      FrameIndex frame;
      std::uint32_t rank = 0;
      sim::TrueTime stored;
      EgressPort* sender = nullptr;
    };
    std::vector<HeaderArrival> headers;  // of this instant
  };
  /// The first frame of a class: in its queue, or among those of this instant.
  struct First {
    FrameIndex frame;
    std::uint32_t arrival = in_queue;
    static constexpr std::uint32_t in_queue = 0xFFFF'FFFF;
  };
  /// What transmission selection says: a class, the rest of a frame that was cut, or when to ask again.
  struct Choice {
    Selection selection;
    bool rest = false;
  };

  void settle_many(sim::Simulation& simulation);
  void settle_all_classes(sim::Simulation& simulation);
  void settle_one(sim::Simulation& simulation, FrameIndex frame);
  void settle_waiting(sim::Simulation& simulation);
  void pass_gate(sim::Simulation& simulation, FrameIndex frame);
  void find_way();
  bool take_withdrawn(sim::TrueTime now, FrameIndex frame);
  void find_gates();
  void settle_later(sim::Simulation& simulation) {
    if (settling_) return;
    settling_ = true;
    simulation.settle_later(*this);
  }
  ClassSet find_heads(Heads& heads, std::array<First, traffic_class_count>& firsts) const;
  Selection select(sim::TrueTime now, ClassSet candidates, const Heads& heads, sim::Duration delay = {});
  Choice choose(sim::TrueTime now, ClassSet candidates, const Heads& heads);
  sim::TrueTime look_while_busy(sim::Simulation& simulation, ClassSet candidates, const Heads& heads);
  sim::TrueTime when_to_look(sim::TrueTime now);
  void take_stored(sim::Simulation& simulation, std::uint64_t argument);
  bool settle_headers(sim::Simulation& simulation);
  bool may_cut_through(sim::Simulation& simulation, const Extras::HeaderArrival& header);
  void start_first(sim::Simulation& simulation, const First& first, TrafficClass q);
  void start_selected(sim::Simulation& simulation, FrameIndex frame, TrafficClass q, bool queue_is_empty);
  void start_with_extras(sim::Simulation& simulation, FrameIndex frame, TrafficClass q);
  void resume(sim::Simulation& simulation);
  void cut(sim::Simulation& simulation, const MacMerge::Cut& cut);
  FrameIndex pop(sim::Simulation& simulation, TrafficClass q);
  bool passes_max_sdu(sim::Simulation& simulation, FrameIndex frame);
  void start(sim::Simulation& simulation, FrameIndex frame, const Frame& record);
  void start(sim::Simulation& simulation, FrameIndex frame) { start(simulation, frame, shared_->traffic->frame(frame)); }
  [[gnu::noinline]] void start_announced(sim::Simulation& simulation, FrameIndex frame, const Frame& record);
  void transmit(sim::Simulation& simulation, FrameIndex frame, const Frame& record);
  void take_last(sim::Simulation& simulation, FrameIndex frame, const Frame& record, std::uint32_t rank);
  void admit(sim::Simulation& simulation, FrameIndex frame);
  void give_up(sim::Simulation& simulation, FrameIndex frame, DropReason reason);
  void wake_at(sim::Simulation& simulation, sim::TrueTime time);
  PortShaping& make_shaping();
  Extras& make_extras();
  bool is_down() const { return extras_ && extras_->fault && !extras_->fault->is_up(); }
  HoldRequest hold_request(sim::TrueTime now);
  void gates_changed(sim::Simulation& simulation);
  /// What waits may become ready earlier or later than was thought.
  void ask_again(sim::Simulation& simulation);
  std::uint16_t peer_port() const { return static_cast<std::uint16_t>(peer_port_); }
  sim::Duration peer_delay() const { return sim::Duration::from_ps(static_cast<std::int64_t>(peer_delay_ps_)); }
  TrafficClass class_of(FrameIndex frame) const {
    return config_->traffic_class_of_priority[shared_->traffic->frame(frame).queue_priority];
  }
  sim::LocalTime eligible_of(FrameIndex frame) const {
    const Frame& record = shared_->traffic->frame(frame);
    return record.marked ? record.eligible : sim::LocalTime::from_ps(std::numeric_limits<std::int64_t>::min());
  }

  // One cache line holds all that a frame touches at a port that is free.
  bool settling_ = false;
  bool has_arrival_ = false;
  Way way_ = Way::straight;
  std::uint32_t octet_time_ps_ = 0;
  std::uint64_t peer_order_ = 0;             // of events for the peer (sim::Event::order_of)
  std::uint64_t peer_delay_ps_ : 44 = 0;     // see LinkEnd::delay
  std::uint64_t peer_port_ : 16 = 0;
  sim::TrueTime busy_until_;
  std::uint64_t wire_octets_sent_ = 0;
  sim::EventSource source_;
  // Touched when frames wait.
  Arrival arrival_;
  Shared* shared_ = nullptr;
  sim::TrueTime wake_at_ = sim::TrueTime::never();
  const PortConfig* config_ = nullptr;
  const LocalClock* clock_ = nullptr;
  std::unique_ptr<PortShaping> shaping_;
  std::unique_ptr<Extras> extras_;
  GateSchedule* only_gates_ = nullptr;       // if there is nothing but gates
  sim::TrueTime promised_ = sim::TrueTime::never();  // when the one frame that waits may start: its gate has said so
  TrafficClass sending_ = 0;                 // the class of the frame under way, if there is shaping
  std::uint64_t other_events_ = 0;
  std::uint64_t frames_dropped_ = 0;
  EgressPort* opposite_ = nullptr;
  sim::Duration node_delay_;                 // the peer's share of peer_delay
  PortQueues queues_;
  std::vector<Arrival> more_arrivals_;
};

}  // namespace takt::models
