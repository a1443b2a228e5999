// SPDX-License-Identifier: Apache-2.0
// The receiving side of a host: from the network interface to listeners and applications.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "models/bridge/internal_port.hpp"
#include "models/egress/egress_port.hpp"
#include "models/frer/host_redundancy.hpp"
#include "models/host/cpu.hpp"
#include "models/host/os_latency.hpp"
#include "models/host/process.hpp"

namespace takt::models {

class alignas(64) Host final : public sim::Component, public InternalReceiver, public CpuUser {
 public:
  /// `ports` are its network interfaces. Frames that come by several ways, by several interfaces or through the bridge
  /// of a station, may come at one instant: the receive latency begins when the node has handled its last event of the
  /// instant, in the order of the ports, and lies in no event's time before. The latter also holds where a thread of a
  /// processor takes them in.
  Host(sim::Simulation& simulation, Traffic& traffic, NodeIndex node, const OsLatency& latency, std::string_view path,
       std::span<EgressPort> ports, const LocalClock& clock, bool eliminates_duplicates, bool has_stack_thread);

  /// This host takes frames of the stream; `process`, if any, gets their octets. Frames of other streams are dropped.
  /// Further calls for a stream add processes, each of which gets them.
  void listen(StreamIndex stream, Process* process);

  /// The host takes copies of the stream that come more than once out (IEEE 802.1CB).
  void recover(StreamIndex stream, const StreamRecoveryConfig& config) {
    redundancy_.add(stream, config, id());
    reception_checks_.require_always();
  }
  /// Deliveries here are entered in Traffic::book() as well.
  void keep_book() {
    keeps_book_ = true;
    reception_checks_.require_always();
  }
  /// The thread of the host's processor on which each frame that comes is a job of the protocol stack.
  void take_in_on(Cpu& cpu, std::uint32_t thread) {
    cpu_ = &cpu;
    stack_thread_ = thread;
    reception_checks_.require_always();
  }
  /// Takes the link-local frames.
  void set_link_local_receiver(LinkLocalReceiver* receiver) { link_local_ = receiver; }
  ListenerRedundancy& redundancy() { return redundancy_; }
  /// Emits a trace record per arrival.
  void trace_arrivals() {
    tells_arrivals_ = true;
    reception_checks_.require_always();
  }
  /// The latency of each frame that comes, for the only link by which frames come, to be drawn there; null if more
  /// happens when a frame comes.
  LatencyLine* drawn_latency() {
    return receives_at_once_ || reception_checks_.is_needed() || eliminates_duplicates_ || cpu_ != nullptr ? nullptr
                                                                                                           : &receive_;
  }
  /// Without a trace sink it would be drawn there: then arrivals are events for the sink only.
  void arrive_for_recorder() { arrives_for_recorder_ = true; }
  /// A host that is down takes no frames.
  void set_up(bool up) {
    up_ = up;
    reception_checks_.require_always();
  }

  void handle(sim::Simulation& simulation, const sim::Event& event) override;
  void decide(sim::Simulation& simulation) override;
  void receive_internally(sim::Simulation& simulation, FrameIndex frame, std::uint16_t port) override;
  void job_ended(sim::Simulation& simulation, std::uint64_t job, Ending ending) override;
  void prefetch(const sim::Event& event, Ahead ahead) const override;
  sim::ComponentId id() const { return source_.id(); }
  ReceptionChecks& reception_checks() { return reception_checks_; }

 private:
  struct Listener {
    StreamIndex stream;
    Process* process = nullptr;
    sim::Digest::Key delivery;  ///< Traffic::delivery_key of the stream here
  };
  struct Arrived {
    FrameIndex frame;
    std::uint16_t port = 0;
  };
  std::optional<FrameIndex> check_reception(sim::Simulation& simulation, ArrivalArgument arrival);
  bool is_in_doubt(ArrivalArgument arrival) const;
  std::optional<FrameIndex> recover(sim::Simulation& simulation, FrameIndex frame, std::uint16_t port);
  /// When what comes now is through the operating system. Jobs of a thread come one by one, so that their order is
  /// theirs.
  sim::TrueTime through(sim::TrueTime now) {
    return cpu_ != nullptr ? receive_.pass_strictly(now) : receive_.pass(now);
  }
  void gather(sim::Simulation& simulation, const Arrived& arrived);
  void gather_last(sim::Simulation& simulation, const Arrived& arrived);
  void pass_through_system(sim::Simulation& simulation, const Arrived& arrived);
  bool only_counts(const Frame& frame, const Listener* listener) const;
  void accept(sim::Simulation& simulation, sim::EventKind kind, ArrivalArgument arrival);
  [[gnu::noinline]] void receive(sim::Simulation& simulation, sim::EventKind kind, ArrivalArgument arrival);
  [[gnu::noinline]] void receive_slow(sim::Simulation& simulation, sim::EventKind kind, ArrivalArgument arrival);
  void deliver_noted(sim::Simulation& simulation, FrameIndex index, const Frame& frame, const Listener* listener);
  void deliver(sim::Simulation& simulation, FrameIndex index, const Frame& frame, const Listener* listener);
  const Listener* listener_of(StreamIndex stream) const;

  // What a frame touches that is delivered at once: one cache line.
  Traffic* traffic_;
  bool receives_at_once_;  // a fixed latency lies in the events' times already
  bool has_no_latency_;    // nor does any latency pass in its operating system
  ReceptionChecks reception_checks_;
  bool up_ = true;
  bool keeps_book_ = false;
  bool eliminates_duplicates_;
  bool tells_arrivals_ = false;
  bool arrives_for_recorder_ = false;
  std::vector<Listener> listeners_;  // ascending streams
  // The rest.
  sim::EventSource source_;
  NodeIndex node_;
  LatencyLine receive_;
  std::span<EgressPort> ports_;
  const LocalClock* clock_;
  LinkLocalReceiver* link_local_ = nullptr;
  sim::Duration fixed_receive_;  // that latency
  ListenerRedundancy redundancy_;
  std::vector<Arrived> arrived_;  // at this instant, by several ways
  Cpu* cpu_ = nullptr;            // null: what comes takes no time of a processor
  std::uint32_t stack_thread_ = 0;
};

}  // namespace takt::models
