// What a replayed run shows of some streams: the way of their slowest frames, and each message that came.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "explain/reaction_chain.hpp"
#include "scenario/run/run.hpp"
#include "sim/trace.hpp"

namespace takt::verify {

/// A frame at one egress port.
struct Passage {
  models::NodeIndex node;
  std::uint16_t port = 0;
  models::NodeIndex peer;
  sim::TrueTime came;          ///< to the queue
  sim::TrueTime left;          ///< its last bit is on the wire
};

using explain::Arrival;

class FrameLog final : public sim::TraceSink {
 public:
  /// The ways of frames of `stream` are kept, and the slowest and the fastest of those that are produced at `from` or later; of all streams in
  /// `messages` each arrival. The network outlives the log.
  FrameLog(const models::Network& network, std::optional<models::StreamIndex> stream, sim::TrueTime from, std::vector<bool> messages);

  void record(const sim::TraceRecord& record) override;

  const std::optional<Arrival>& slowest() const { return slowest_; }
  const std::optional<Arrival>& fastest() const { return fastest_; }
  /// The ports that the slowest frame has passed, from its talker on.
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
  void note_passage(const sim::TraceRecord& record, const Port& port, const models::Frame& frame);
  void note_arrival(const Arrival& arrival, std::uint64_t sequence);
  std::vector<Passage> way_to(const Arrival& arrival, std::uint64_t sequence) const;

  const models::Network* network_;
  std::vector<std::optional<Port>> ports_;                   // by component
  std::optional<models::StreamIndex> stream_;
  sim::TrueTime from_;
  std::vector<bool> messages_;                               // by stream
  std::map<std::uint64_t, std::vector<Passage>> passages_;   // of the stream, by sequence number
  std::optional<Arrival> slowest_;
  std::optional<Arrival> fastest_;
  std::vector<Passage> way_;
  std::vector<Arrival> arrivals_;
};

}  // namespace takt::verify
