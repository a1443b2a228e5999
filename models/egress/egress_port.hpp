// SPDX-License-Identifier: Apache-2.0
// The sending side of a port: queues and transmission selection in front of a link. The same class serves hosts and
// bridges.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "models/egress/frame_queue.hpp"
#include "models/egress/mac_merge.hpp"
#include "models/egress/port_config.hpp"
#include "models/egress/port_shaping.hpp"
#include "models/egress/single_talker_port.hpp"
#include "models/ethernet/link.hpp"
#include "models/ethernet/link_local.hpp"
#include "sim/simulation.hpp"

namespace takt::models {

class alignas(64) EgressPort final : public sim::Component {
 public:
  /// What all ports of a network share.
  struct Shared {
    Traffic* traffic = nullptr;
    LinkLocalSender* link_local = nullptr;
    QueueEntryPool entries;
  };

  EgressPort() = default;

  /// Connects the port of a node (sim::Simulation::group). `octet_time` is that of the link; `config`, `clock` and
  /// `incoming`, the link's other direction, outlive the port.
  void connect(sim::Simulation& simulation, sim::ComponentId node, Shared& shared, const PortConfig& config,
               const LocalClock& clock, sim::Duration octet_time, LinkEnd far_end, Link& incoming);
  /// To be called before the run, and after what is asked of the link before it.
  void prepare();
  /// offer_header() will be called. Before prepare().
  void expect_headers() { make_extras().expects_headers = true; }
  /// The direction of the link on which the port sends.
  Link& link() { return link_; }
  const Link& link() const { return link_; }
  /// Every frame is put on the link by Link::transmit. After prepare().
  bool sends_plainly() const { return !extras_ && link_.is_plain() && !link_.checks(); }
  /// Neither gates nor shapers nor other features: what starts next depends on queues and medium alone. After
  /// prepare().
  bool has_queues_only() const { return !shaping_ && !extras_; }
  /// One process alone will hand frames to this port, all of class `q`: where it does so. After prepare().
  /// Preconditions: sends_plainly(), has_queues_only(), the queue has no limit, and neither request_gates() nor
  /// force_gate() will be called.
  SingleTalkerPort& serve_one(const sim::Simulation& simulation, TrafficClass q) {
    single_talker_port_ = std::make_unique<SingleTalkerPort>(simulation, link_, q);
    return *single_talker_port_;
  }
  /// The other direction, by which the node receives.
  Link& incoming() const { return *incoming_; }
  /// The node receives by another link from now on. Precondition: both are down.
  void receive_by(Link& incoming) { incoming_ = &incoming; }

  /// Hands the port a frame at the present instant. Frames that come at one instant are put into a canonical order, by
  /// `rank` (the ingress port in a bridge, the talker in a host), so that it does not matter which was handed over
  /// first.
  void offer(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank);

  /// The same as the last act of an event handler: the port decides at once if nothing else happens to its node at this
  /// instant. `record` is that of the frame.
  void offer_last(sim::Simulation& simulation, FrameIndex frame, const Frame& record, std::uint32_t rank) {
    if (!simulation.is_last()) [[unlikely]]
      offer(simulation, frame, rank);
    else
      offer_only(simulation, frame, record, rank);
  }
  /// The same where Simulation::is_last() has said so.
  void offer_only(sim::Simulation& simulation, FrameIndex frame, const Frame& record, std::uint32_t rank) {
    if (simulation.now() >= link_.free_at() && starts_at_once_) [[likely]]
      start(simulation, frame, record);
    else
      offer_single(simulation, frame, record, rank);
  }

  /// The same for a frame of which only the header has come: it starts at once if this port cuts its class through, the
  /// link it comes from is as fast, the medium is free, no other frame may be selected now and none of its class waits.
  /// What waits for a gate or for credit is no reason to store it. Of several headers the first one in the order of
  /// transmission selection is cut through: the most urgent class, then the least rank. Otherwise it is offered at
  /// `stored`, when it has wholly come and the node's fixed delay is over, or dropped then if it turns out to be
  /// damaged. `from` is the link by which it comes. Precondition: expect_headers().
  void offer_header(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank, sim::TrueTime stored,
                    Link& from) {
    extras_->headers.push_back({frame, rank, stored, &from});
    decide_later(simulation);
  }

  /// The medium may have become free, or a class may have become eligible.
  void handle(sim::Simulation& simulation, const sim::Event& event) override;
  /// All frames of this instant are here: selects, starts, queues.
  void decide(sim::Simulation& simulation) override;

  /// The clock has changed its rate or was stepped: what waits for a local time asks again.
  void clock_changed(sim::Simulation& simulation);

  /// Brings what a frame touches at a free port towards the cache.
  void prefetch_hot() const { __builtin_prefetch(this, 1); }

  /// force_gate() will be called.
  void expect_stuck_gates() { make_shaping(); }
  /// A link that goes down loses what is on it and what waits for it; while it is down, what is offered. Precondition:
  /// Link::expect_faults.
  void set_link_up(sim::Simulation& simulation, bool up);
  /// What waits in the queues is lost for that reason; so is a frame under way.
  void flush(sim::Simulation& simulation, DropReason reason);
  void force_gate(sim::Simulation& simulation, TrafficClass q, std::optional<bool> open);

  /// Management sets ConfigChange: another gate list (IEEE 802.1Q 8.6.9.3).
  ConfigChange request_gates(sim::Simulation& simulation, const GateConfig& gates);
  sim::Duration octet_time() const { return link_.octet_time(); }
  /// Frames that were passed on although their FCS was wrong.
  std::uint64_t bad_fcs_forwarded() const { return extras_ ? extras_->bad_fcs_forwarded : 0; }
  /// Frames that were passed on before they had come wholly.
  std::uint64_t frames_cut_through() const { return extras_ ? extras_->frames_cut_through : 0; }
  /// What the port has beyond strict priority, or null.
  PortShaping* shaping() const { return shaping_.get(); }
  const MacMerge* merge() const { return extras_ ? extras_->merge.get() : nullptr; }
  /// A number between those of other ports may have no link.
  bool is_connected() const { return shared_ != nullptr; }
  bool untags() const { return config_->untagged; }
  const PortConfig& config() const { return *config_; }
  const LocalClock& clock() const { return *clock_; }

  sim::ComponentId id() const { return link_.sender(); }
  const PortQueues& queues() const { return is_sent_to_ahead() ? single_talker_port_->queues() : queues_; }
  std::uint64_t frames_sent() const {
    return link_.frames_sent() - (is_sent_to_ahead() ? single_talker_port_->to_come().frames : 0);
  }
  std::uint64_t wire_octets_sent() const {
    return link_.wire_octets_sent() - (is_sent_to_ahead() ? single_talker_port_->to_come().wire_octets : 0);
  }
  /// Those lost on its link are among them.
  std::uint64_t frames_dropped() const { return frames_dropped_ + link_.frames_lost(); }

 private:
  bool is_sent_to_ahead() const { return single_talker_port_ && !single_talker_port_->is_recorded(); }
  static constexpr sim::EventKind wake_up = 0;
  static constexpr sim::EventKind stored_frame = 1;  // a frame that was not cut through has come wholly
  struct Arrival {
    FrameIndex frame;
    std::uint32_t rank = 0;
  };
  /// What few ports have besides gates and shapers. Ports whose classes share bandwidth have it too, so that they
  /// select among all classes.
  struct Extras {
    std::unique_ptr<MacMerge> merge;
    bool expects_headers = false;
    std::uint64_t bad_fcs_forwarded = 0;
    std::uint64_t frames_cut_through = 0;
    struct HeaderArrival {
      FrameIndex frame;
      std::uint32_t rank = 0;
      sim::TrueTime stored;
      Link* from = nullptr;
    };
    std::vector<HeaderArrival> headers;  // of this instant
  };
  /// The first frame of a class: in its queue, or among those of this instant.
  struct First {
    FrameIndex frame;
    std::uint32_t arrival = 0xFFFF'FFFF;
    bool is_in_queue() const { return arrival == 0xFFFF'FFFF; }
  };
  /// What transmission selection says: a frame that may start now, or the rest of one that was cut, or when to ask
  /// again.
  struct Selection {
    bool found = false;
    bool is_rest = false;
    TrafficClass traffic_class = 0;
    First first = {};
    sim::TrueTime ask_again = sim::TrueTime::never();
  };

  // What has come at this instant and what waits is one of five cases: start_single() of a frame that comes alone to a
  // free medium while nothing waits, and these.
  void start_single(sim::Simulation& simulation, FrameIndex frame, const Frame& record);
  [[gnu::noinline]] void enqueue_behind_busy_medium(sim::Simulation& simulation);
  [[gnu::noinline]] void enqueue_behind_known_head(sim::Simulation& simulation);
  [[gnu::noinline]] void start_waiting(sim::Simulation& simulation);
  [[gnu::noinline]] void select_and_start(sim::Simulation& simulation);
  void offer_single(sim::Simulation& simulation, FrameIndex frame, const Frame& record, std::uint32_t rank);
  [[gnu::noinline]] void decide_now(sim::Simulation& simulation);
  [[gnu::noinline]] void start_if_shaping_allows(sim::Simulation& simulation, FrameIndex frame, const Frame& record);
  void wait_for_medium(sim::Simulation& simulation);
  void note_waiting();
  void note_features();
  [[gnu::noinline]] void decide_later(sim::Simulation& simulation);
  ClassSet candidates() const;
  First head_of_line(TrafficClass q) const;
  Selection select(sim::TrueTime now, ClassSet classes, sim::Duration delay = {});
  void select_by_share(sim::TrueTime now, ClassSet classes, sim::Duration delay, Selection& selection);
  Selection select_at_free_medium(sim::TrueTime now);
  Selection select_rest(sim::TrueTime now, const MacMerge::Rest& rest);
  sim::TrueTime next_cut_or_end(sim::Simulation& simulation);
  sim::TrueTime when_to_look(sim::TrueTime now);
  void wake(sim::Simulation& simulation, sim::TrueTime time);
  void handle_stored_frame(sim::Simulation& simulation, const sim::Event& event);
  bool cut_through(sim::Simulation& simulation);
  void start_before_it_has_come(sim::Simulation& simulation, FrameIndex frame);
  void store_headers(sim::Simulation& simulation, Storing reason);
  std::optional<StoringDetail> why_stored(sim::TrueTime now, const Extras::HeaderArrival& header);
  void start_first(sim::Simulation& simulation, const Selection& selection);
  void start_selected(sim::Simulation& simulation, FrameIndex frame, TrafficClass q, bool queue_is_empty);
  /// At a port that preempts and has nothing else.
  [[gnu::noinline]] void start_merging(sim::Simulation& simulation, FrameIndex frame, const Frame& record,
                                       TrafficClass q);
  void start_with_extras(sim::Simulation& simulation, FrameIndex frame, TrafficClass q);
  void resume(sim::Simulation& simulation);
  void cut(sim::Simulation& simulation, const MacMerge::Cut& cut);
  FrameIndex pop(sim::Simulation& simulation, TrafficClass q);
  bool passes_max_sdu(sim::Simulation& simulation, FrameIndex frame);
  void start(sim::Simulation& simulation, FrameIndex frame, const Frame& record);
  void start(sim::Simulation& simulation, FrameIndex frame) {
    start(simulation, frame, shared_->traffic->frame(frame));
  }
  [[gnu::noinline]] void start_announced(sim::Simulation& simulation, FrameIndex frame, const Frame& record);
  void start_highest(sim::Simulation& simulation);
  void enqueue_arrivals(sim::Simulation& simulation);
  void enqueue(sim::Simulation& simulation, FrameIndex frame);
  [[gnu::noinline]] void enqueue_slow(sim::Simulation& simulation, FrameIndex frame, const Frame& record,
                                      TrafficClass q);
  [[gnu::noinline]] void enqueue_to_full_queue(sim::Simulation& simulation, FrameIndex frame, TrafficClass q,
                                               DropReason reason);
  void drop(sim::Simulation& simulation, FrameIndex frame, DropReason reason);
  // For traces: why a waiting frame may not start although the medium is free.
  [[gnu::noinline]] void trace_all_blocked(sim::Simulation& simulation);
  [[gnu::noinline]] void trace_blocked(sim::Simulation& simulation, TrafficClass q, FrameIndex first,
                                       sim::TrueTime until);
  void tell(sim::Simulation& simulation, const BlockedRecord& refusal, sim::TrueTime until);
  void wake_at(sim::Simulation& simulation, sim::TrueTime time);
  PortShaping& make_shaping();
  Extras& make_extras();
  HoldRequest hold_request(sim::TrueTime now);
  void gates_changed(sim::Simulation& simulation);
  /// What waits may become ready earlier or later than was thought.
  void ask_again(sim::Simulation& simulation);
  TrafficClass class_of(FrameIndex frame) const {
    return config_->traffic_class_of_priority[shared_->traffic->frame(frame).queue_priority];
  }
  /// Preamble and gap included.
  std::int64_t octets_on_medium(FrameIndex frame) const {
    return wire_length(Octets{shared_->traffic->frame(frame).length}).count;
  }
  sim::LocalTime eligible_of(FrameIndex frame) const { return eligible_of(shared_->traffic->frame(frame)); }
  static sim::LocalTime eligible_of(const Frame& record) { return PortShaping::eligible_of(record); }
  MacMerge* merge_of() const { return extras_ ? extras_->merge.get() : nullptr; }

  // One cache line holds all that a frame touches at a port that is free.
  bool will_decide_ = false;  // it has asked to, at the end of this instant
  bool has_arrival_ = false;
  bool starts_single_ = true;   // nothing waits: a frame that comes alone to the free medium starts if shaping_ lets it
  bool starts_at_once_ = true;  // the same, and there is neither shaping nor extras
  TrafficClass sending_ = 0;    // the class of the frame under way, if there is shaping
  ClassSet strict_priority_classes_ = every_class;  // those that do not share bandwidth: the most urgent one goes first
  Link link_;
  // Touched when frames wait.
  Arrival arrival_;  // the first of this instant
  Shared* shared_ = nullptr;
  sim::TrueTime wake_at_ = sim::TrueTime::never();
  const PortConfig* config_ = nullptr;
  const LocalClock* clock_ = nullptr;
  std::unique_ptr<PortShaping> shaping_;
  std::unique_ptr<Extras> extras_;
  sim::TrueTime head_eligible_at_ =
      sim::TrueTime::never();  // when the head of the only class that waits may start: its gate has said so
  std::uint64_t frames_dropped_ = 0;
  Link* incoming_ = nullptr;
  PortQueues queues_;
  bool only_merges_ = false;            // it preempts, and there is nothing else
  bool has_new_head_ = false;           // a frame at the head of a queue was dropped for one that has come
  std::vector<Arrival> more_arrivals_;  // the others
  std::unique_ptr<SingleTalkerPort> single_talker_port_;  // see serve_one()
};

}  // namespace takt::models
