// SPDX-License-Identifier: Apache-2.0
// What a replayed run shows: the ports that one frame has passed, and each message of some streams that came.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "explain/frame_finder.hpp"
#include "explain/reaction_chain.hpp"
#include "scenario/run/run.hpp"
#include "sim/trace.hpp"

namespace takt::verify {

/// A frame at one egress port.
struct Passage {
  models::NodeIndex node;
  std::uint16_t port = 0;
  models::NodeIndex peer;
  sim::TrueTime came;  ///< to the queue
  sim::TrueTime left;  ///< its last bit is on the wire
};

using explain::Arrival;

class FrameLog final : public sim::TraceSink {
 public:
  /// The way of the frame of `delivery` to its listener is kept; of all streams in `messages` each arrival. The network
  /// outlives the log.
  FrameLog(const models::Network& network, std::optional<explain::Delivery> delivery, std::vector<bool> messages);

  void record(const sim::TraceRecord& record) override;

  /// The delivery, once it has taken place.
  const std::optional<Arrival>& delivered() const { return delivered_; }
  /// The ports that its frame has passed, from its talker on.
  const std::vector<Passage>& way() const { return way_; }
  /// In the order of time.
  const std::vector<Arrival>& arrivals() const { return arrivals_; }

 private:
  struct Port {
    models::NodeIndex node;
    std::uint16_t number = 0;
    models::NodeIndex peer;
    sim::Duration octet_time;
  };
  const Port* port_of(sim::ComponentId component) const;
  void note_passage(const sim::TraceRecord& record, const Port& port);
  std::vector<Passage> way_to(const Arrival& arrival) const;

  const models::Network* network_;
  std::vector<std::optional<Port>> ports_;  // by component
  std::optional<explain::Delivery> delivery_;
  std::vector<bool> messages_;     // by stream
  std::vector<Passage> passages_;  // of the frame
  std::optional<Arrival> delivered_;
  std::vector<Passage> way_;
  std::vector<Arrival> arrivals_;
};

}  // namespace takt::verify
