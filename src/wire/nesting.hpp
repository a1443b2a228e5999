// Joins two endpoints of one node: slave of an outer group, master of an inner one (handshake/coupling.hpp).
#pragma once

#include "handshake/coupling.hpp"
#include "wire/program_endpoint.hpp"

namespace takt::wire {

class Nesting {
 public:
  /// Both were made with `nested` in their Config. All references outlive the nesting, which outlives all use of the endpoints.
  Nesting(ProgramEndpoint& outer, EndpointHost& outer_host, ProgramEndpoint& inner, EndpointHost& inner_host);
  Nesting(const Nesting&) = delete;
  Nesting& operator=(const Nesting&) = delete;

  // For the two endpoints:
  /// One of them has taken a step.
  void settle();
  /// The local initialisation of one has ended.
  void initialised(const ProgramEndpoint& endpoint, std::uint32_t run);
  /// The node has lost its memory.
  void forget() { coupling_ = {}; }

 private:
  ProgramEndpoint* outer_;
  EndpointHost* outer_host_;
  ProgramEndpoint* inner_;
  EndpointHost* inner_host_;
  handshake::Coupling coupling_;
  bool settling_ = false;  // the steps that it takes itself come back to it
};

}  // namespace takt::wire
