// The sending side of a port: queues, transmission selection, medium. The same class serves hosts and bridges.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "models/egress/frame_queue.hpp"
#include "models/egress/port_config.hpp"
#include "models/egress/port_shaping.hpp"
#include "models/ethernet/sizes.hpp"
#include "models/ethernet/traffic.hpp"
#include "sim/simulation.hpp"

namespace takt::models {

/// Event kinds that a node understands.
enum class NodeEvent : sim::EventKind {
  frame_arrived = 0,  ///< the last bit is in and the node's fixed delay is over; argument: see ArrivalArgument
  first_free = 16,    ///< kinds from here on belong to the node type
};

/// The argument of frame_arrived: which frame came in through which port of the node.
struct ArrivalArgument {
  FrameIndex frame;
  std::uint16_t port = 0;
  static constexpr std::uint64_t pack(FrameIndex frame, std::uint16_t port) {
    return static_cast<std::uint64_t>(port) << 32 | frame.value;
  }
  static constexpr ArrivalArgument unpack(std::uint64_t argument) {
    return {FrameIndex{static_cast<std::uint32_t>(argument)}, static_cast<std::uint16_t>(argument >> 32)};
  }
};

/// The far end of a link, as the sending port needs it.
struct LinkEnd {
  sim::ComponentId node;
  std::uint16_t port = 0;
  /// From the last bit leaving the sender to the event at the node: propagation plus the node's fixed delay (forwarding delay of
  /// a bridge, fixed receive latency of a host). Folding them saves an event for each frame and hop. At most 17 s.
  sim::Duration delay;
};

class alignas(64) EgressPort final : public sim::Component {
 public:
  /// What all ports of a network share.
  struct Shared {
    Traffic* traffic = nullptr;
    QueueEntryPool entries;
  };

  EgressPort() = default;

  /// Connects the port. `octet_time` is that of the link; `config` and `clock` outlive the port.
  void connect(sim::Simulation& simulation, Shared& shared, const PortConfig& config, const LocalClock& clock, sim::Duration octet_time,
               LinkEnd far_end);

  /// Hands the port a frame at the present instant. Frames that come at one instant are put into a canonical order, by
  /// `rank` (the ingress port in a bridge, the talker in a host), so that it does not matter which was handed over first.
  void offer(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank) {
    if (!settling_) {
      settling_ = true;
      simulation.settle_later(*this);
    }
    if (!has_arrival_) {
      has_arrival_ = true;
      arrival_ = {frame, rank};
    } else {
      more_arrivals_.push_back({frame, rank});
    }
  }

  /// The same as the last act of an event handler: spares the detour if nothing else happens at this instant.
  void offer_last(sim::Simulation& simulation, FrameIndex frame, std::uint32_t rank) {
    if (!simulation.instant_is_complete()) [[unlikely]] {
      offer(simulation, frame, rank);
      return;
    }
    if (!detours_ && simulation.now() >= busy_until_) [[likely]] {
      start(simulation, frame);
      return;
    }
    has_arrival_ = true;
    arrival_ = {frame, rank};
    settle_many(simulation);
  }

  /// The medium may have become free, or a class may have become eligible.
  void handle(sim::Simulation& simulation, const sim::Event& event) override;
  /// All frames of this instant are here: selects, starts, queues.
  void settle(sim::Simulation& simulation) override;

  /// Brings what a frame touches at a free port towards the cache.
  void prefetch_hot() const { __builtin_prefetch(this, 1); }

  /// Management sets ConfigChange: another gate list (IEEE 802.1Q 8.6.9.3).
  ConfigChange request_gates(sim::Simulation& simulation, const GateConfig& gates);
  /// What the port has beyond strict priority, or null.
  PortShaping* shaping() const { return shaping_.get(); }

  sim::ComponentId id() const { return source_.id(); }
  const PortQueues& queues() const { return queues_; }
  /// Each frame is one event of the port; its other events are wake-ups.
  std::uint64_t frames_sent() const { return source_.count() - wake_ups_; }
  /// Octets that occupied the medium, preamble and inter-packet gap included.
  std::uint64_t wire_octets_sent() const { return wire_octets_sent_; }
  std::uint64_t frames_dropped() const { return frames_dropped_; }

 private:
  struct Arrival {
    FrameIndex frame;
    std::uint32_t rank = 0;
  };

  void settle_many(sim::Simulation& simulation);
  void settle_one(sim::Simulation& simulation, FrameIndex frame);
  Selection select(sim::TrueTime now, ClassSet candidates);
  void start_selected(sim::Simulation& simulation, FrameIndex frame, TrafficClass q, bool queue_is_empty);
  bool passes_max_sdu(sim::Simulation& simulation, FrameIndex frame);
  void start(sim::Simulation& simulation, FrameIndex frame);
  void admit(sim::Simulation& simulation, FrameIndex frame);
  void wake_at(sim::Simulation& simulation, sim::TrueTime time);
  TrafficClass class_of(FrameIndex frame) const {
    return config_->traffic_class_of_priority[shared_->traffic->frame(frame).priority];
  }

  // One cache line holds all that a frame touches at a port that is free.
  bool settling_ = false;
  bool has_arrival_ = false;
  bool detours_ = false;                     // a queue holds a frame, or there is more than strict priority
  std::uint16_t peer_port_ = 0;
  sim::ComponentId peer_node_;
  std::uint64_t octet_time_ps_ : 20 = 0;
  std::uint64_t peer_delay_ps_ : 44 = 0;     // see LinkEnd::delay
  sim::TrueTime busy_until_;
  sim::EventSource source_;
  Shared* shared_ = nullptr;
  std::uint64_t wire_octets_sent_ = 0;
  // Touched when frames wait.
  Arrival arrival_;
  sim::TrueTime wake_at_ = sim::TrueTime::never();
  std::uint64_t wake_ups_ = 0;
  std::uint64_t frames_dropped_ = 0;
  const PortConfig* config_ = nullptr;
  const LocalClock* clock_ = nullptr;
  std::unique_ptr<PortShaping> shaping_;
  PortQueues queues_;
  std::vector<Arrival> more_arrivals_;
};

}  // namespace takt::models
