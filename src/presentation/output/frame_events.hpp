// SPDX-License-Identifier: Apache-2.0
// What became of each frame, as it happens: what files and tables of frames are made of.
#pragma once

#include <string_view>
#include <vector>

#include "models/moment.hpp"
#include "output/port_directory.hpp"
#include "sim/trace.hpp"

namespace takt::output {

enum class FrameEnd : std::uint8_t { delivered, dropped, under_way };
/// "delivered", "dropped", "under way".
std::string_view name_of(FrameEnd end);

/// One row: a frame has reached a listener, a copy was dropped, or it has still to come when all is over.
struct FrameEvent {
  static constexpr std::int32_t none = -1;
  std::uint32_t stream = 0;    ///< index of the traffic's streams
  std::uint64_t sequence = 0;  ///< from 0, within the stream
  FrameEnd end = FrameEnd::delivered;
  std::int32_t node = none;  ///< the listener, or where it was dropped
  std::int32_t port = none;  ///< none: the node itself
  sim::TrueTime produced;
  sim::TrueTime at;                ///< of what is under way: nothing
  models::DropReason reason = {};  ///< of a dropped one
};

/// Hands the events of all frames to whoever is derived from it. Messages of gPTP, which end at the next node, are left
/// out.
class FrameEvents : public sim::TraceSink {
 public:
  /// The network outlives this.
  explicit FrameEvents(const models::Network& network);
  /// It is told of things later than they happen, each with its moment.
  void look_at(const models::Moment& moment) { view_.look_at(moment); }
  void record(const sim::TraceRecord& record) final;

 protected:
  virtual void take(const FrameEvent& event) = 0;
  /// Tells of what is under way, in an order of its own; when all is over.
  void emit_rest();
  const models::Network& network() const { return *network_; }

 private:
  void place(sim::ComponentId component, FrameEvent& event) const;

  const models::Network* network_;
  models::View view_;
  PortDirectory directory_;
  std::vector<std::int32_t> node_of_component_;  // of those that are no ports
};

}  // namespace takt::output
