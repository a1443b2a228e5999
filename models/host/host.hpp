// The receiving side of a host: from the network interface to listeners and applications.
#pragma once

#include <vector>

#include "models/egress/egress_port.hpp"
#include "models/host/os_latency.hpp"
#include "models/host/process.hpp"

namespace takt::models {

class Host final : public sim::Component {
 public:
  Host(sim::Simulation& simulation, Traffic& traffic, NodeIndex node, const OsLatency& latency, std::string_view path);

  /// This host takes frames of the stream; `process`, if any, gets their octets. Frames of other streams are dropped.
  /// A second call for a stream replaces the process.
  void listen(StreamIndex stream, Process* process);

  void handle(sim::Simulation& simulation, const sim::Event& event) override;
  void prefetch(const sim::Event& event, Ahead ahead) const override;
  sim::ComponentId id() const { return source_.id(); }

 private:
  struct Listener {
    StreamIndex stream;
    Process* process = nullptr;
  };
  void deliver(sim::Simulation& simulation, FrameIndex frame);
  const Listener* listener_of(StreamIndex stream) const;

  Traffic* traffic_;
  std::vector<Listener> listeners_;  // ascending streams
  sim::EventSource source_;
  NodeIndex node_;
  bool receives_at_once_;            // a fixed latency lies in the events' times already
  LatencyLine receive_;
};

}  // namespace takt::models
