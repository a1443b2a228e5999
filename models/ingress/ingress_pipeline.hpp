// SPDX-License-Identifier: Apache-2.0
// The ingress chain of a bridge: everything that the standards place between the medium and the queues and that knows
// streams.
//
//   1. stream identification                 802.1CB 6, 9.1     which stream, which member of it
//   2. decoding, individual recovery,        802.1CB 7.4.3      only where the stream is made one again: copies end
//   here, those that
//      sequence recovery (elimination)       to 7.6             pass lose their R-TAG and get the compound stream's
//      address
//   3. stream filter, maximum SDU            802.1Q 8.6.5.3
//   4. stream gate                           802.1Q 8.6.5.4     gives the internal priority value
//   5. flow meter                            802.1Q 8.6.5.5     gives drop_eligible
//   6. ATS scheduler                         802.1Q 8.6.5.6     gives the eligibility time
//   7. sequence generation, encoding, split  802.1CB 7.4.1, 7.7 only where the stream is split
//
// Recovery comes before policing because its functions stand in the stack of the reception port, below the forwarding
// process of which policing is part (802.1CB clause 8): a copy that is eliminated takes nothing from a meter's or a
// scheduler's bucket. A split stands behind policing: what is policed is the stream, once, and not its members. A gate
// sees the time at which the last bit was in, by the node's clock; intervals (meters, reset and latent error timers)
// are measured on the same clock without its steps.
//
// An ATS scheduler (8.6.11) sees the time at which the forwarding delay is over. The eligibility time that it gives is
// the one that follows from the last bit, later by the forwarding delay: a frame may be selected no earlier than its
// processing delay after its eligibility time. Otherwise a forwarding delay that is longer than the hold would let a
// burst out unshaped.
//
// What happens at one instant at several ports depends on the order of the calls (which copy passes, who takes the
// tokens), so the bridge calls in the order of its port numbers.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "models/clock/local_clock.hpp"
#include "models/frer/stream_recovery.hpp"
#include "models/frer/stream_split.hpp"
#include "models/ingress/ats_scheduler.hpp"
#include "models/ingress/ingress_chain.hpp"
#include "models/ingress/ingress_config.hpp"
#include "models/ingress/stream_gate.hpp"
#include "models/ingress/stream_table.hpp"

namespace takt::models {

class IngressPipeline final : public IngressChain {
 public:
  /// `where` is the component that drops are accounted to; `first_group` is the number of nodes (see mac_address_of);
  /// `forwarding_delay` is the bridge's fixed one. All references outlive the pipeline.
  IngressPipeline(Traffic& traffic, const IngressConfig& config, const LocalClock& clock, sim::ComponentId where,
                  std::uint32_t first_group, sim::Duration forwarding_delay);
  IngressPipeline(const IngressPipeline&) = delete;  // instances_ points into it
  IngressPipeline& operator=(const IngressPipeline&) = delete;

  std::span<const FrameIndex> pass(sim::Simulation& simulation, Ingress ingress) override;
  bool passes_as_it_is(Frame& frame, std::uint16_t port, sim::TrueTime on_wire) override;

  struct Meter {
    NamedFlowMeterConfig config;
    FlowMeter meter;
    std::array<std::uint64_t, 3> frames{};  ///< by FrameColor
    std::uint64_t discarded = 0;
  };
  struct Scheduler {
    AtsSchedulerConfig config;
    AtsScheduler scheduler;
    std::uint64_t passed = 0;
    std::uint64_t discarded = 0;  ///< would have stayed longer than the maximum residence time
    sim::Duration longest_hold;  ///< greatest eligibility time minus arrival, both with or without the forwarding delay
  };
  struct Split {
    StreamHandle stream;
    StreamSplit split;
  };
  struct Recovery {
    StreamHandle stream;
    StreamRecovery recovery;
  };

  // For reports and for management; in the order of the configuration.
  const IngressConfig& config() const { return *config_; }
  const StreamFilterTable& stream_filters() const { return filters_; }
  StreamFilterTable& stream_filters() { return filters_; }
  std::vector<StreamGate>& stream_gates() { return gates_; }
  const std::vector<StreamGate>& stream_gates() const { return gates_; }
  std::vector<Meter>& flow_meters() { return meters_; }
  const std::vector<Meter>& flow_meters() const { return meters_; }
  const std::vector<Scheduler>& ats_schedulers() const { return schedulers_; }
  /// The groups of the configuration.
  const std::vector<AtsGroup>& ats_groups() const { return groups_; }
  const std::vector<Split>& splits() const { return splits_; }
  /// With what their timers have done until `now`.
  const std::vector<Recovery>& recoveries(sim::TrueTime now);
  /// Frames that belong to no stream of the table.
  std::uint64_t unidentified_frames() const { return unidentified_frames_; }

 private:
  static constexpr std::uint32_t none = 0xFFFF'FFFF;
  /// What is done to the frames of a stream.
  struct Functions {
    std::uint32_t recovery = none;
    std::uint32_t split = none;
    std::array<std::uint32_t, 8> filter_of_priority{};  ///< the first that matches
  };

  /// What a stream filter leads to; null where there is nothing.
  struct Instances {
    enum class Kind : std::uint8_t { meter, scheduler, other };  ///< that alone, or something else
    Kind kind = Kind::other;
    StreamFilter* filter = nullptr;
    StreamGate* gate = nullptr;
    Meter* meter = nullptr;
    Scheduler* scheduler = nullptr;
  };

  /// Of the frames of a stream that is neither recovered nor split, by priority: the filter that leads to a meter or a
  /// scheduler alone; null: another one, or none.
  using Alone = std::array<const Instances*, 8>;

  [[gnu::noinline]] static bool finds_enough(const Instances& instances, Frame& frame, sim::LocalTime arrival,
                                             AtsGroup* group);
  static void mark_eligible(Frame& frame, sim::LocalTime arrival);
  [[gnu::noinline]] std::span<const FrameIndex> pass_slow(sim::Simulation& simulation, Ingress ingress);
  bool police(sim::Simulation& simulation, FrameIndex& index, const Ingress& ingress, const Functions& functions);
  bool discard(sim::Simulation& simulation, FrameIndex frame, DropReason reason);
  std::optional<sim::LocalTime> shape(Scheduler& scheduler, const Frame& frame, std::uint16_t port,
                                      sim::LocalTime arrival);
  AtsGroup& group_of(const Scheduler& scheduler, const Frame& frame, std::uint16_t port);
  /// Null if it has not been asked for yet.
  AtsGroup* known_group_of(const Scheduler& scheduler, const Frame& frame, std::uint16_t port);
  void make_groups_of(std::uint16_t port);
  static Octets length_for(const Scheduler& scheduler, const Frame& frame);
  static Octets msdu_of(const Frame& frame);
  const Functions& functions_of(StreamHandle stream) const {
    return stream.is_none() ? functions_.back() : functions_[stream.value];
  }
  void lay_out_functions();

  Traffic* traffic_;
  const IngressConfig* config_;
  const LocalClock* clock_;
  sim::ComponentId where_;
  sim::Duration forwarding_delay_;
  StreamTable streams_;
  std::vector<Functions> functions_;  // by stream handle; the last one is that of frames of no stream
  StreamFilterTable filters_;
  std::vector<StreamGate> gates_;
  std::vector<Meter> meters_;
  std::vector<Scheduler> schedulers_;
  std::vector<AtsGroup> groups_;
  std::vector<Instances> instances_;   // by filter
  std::vector<Alone> alone_;           // by stream handle
  std::vector<AtsGroup> port_groups_;  // by reception port and traffic class
  std::uint32_t ports_with_groups_ = 0;
  std::vector<Split> splits_;
  std::vector<Recovery> recoveries_;
  std::uint64_t unidentified_frames_ = 0;
  FrameIndex out_;
};

}  // namespace takt::models
