// SPDX-License-Identifier: Apache-2.0
// What the faults of a scenario take away: links that go down, nodes that crash, and where rerouting may lead frames
// meanwhile.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scenario/resolved/resolved.hpp"

namespace takt::analysis {

/// From when to when something is down; to the end if it does not come back.
struct Outage {
  sim::TrueTime down;
  sim::TrueTime up = sim::TrueTime::never();
};

/// Within the simulated time; what the script does at its end or later is left out.
class Outages {
 public:
  explicit Outages(const scenario::Resolved& resolved);

  bool any() const { return any_; }
  /// The link, or one of its ends, is down at some time.
  bool uses_link(std::uint32_t link) const { return links_[link]; }
  /// When: of the link itself, and of the nodes at its ends.
  std::vector<Outage> of_link(std::uint32_t link) const;
  bool uses_node(models::NodeIndex node) const { return nodes_[node.value]; }

 private:
  const scenario::Resolved* resolved_;
  bool any_ = false;
  std::vector<bool> links_;
  std::vector<bool> nodes_;
};

/// A way that frames may take, and to which of the stream's listeners; or to where they are lost.
struct PossiblePath {
  static constexpr std::size_t nobody = static_cast<std::size_t>(-1);
  scenario::Path path;
  std::vector<bool>
      is_bypassed;  ///< by node: the relay of a station that is down joins the cables before and behind it
  std::size_t listener = nobody;
};

/// All ways that frames of a stream to that address may take over the run, if rerouting changes filtering entries of it
/// or relays join cables on its way: those of each configuration, and those that begin in one and end in a later one,
/// since frames are under way when entries change. Empty if nothing changes for the stream; nothing at all if a frame
/// may go in circles, or the ways are too many to look at.
std::optional<std::vector<PossiblePath>> possible_paths(const scenario::Resolved& resolved,
                                                        const scenario::ResolvedStream& stream, models::VlanId vlan,
                                                        models::AddressIndex address);

/// Whether a relay may join the cables of some station within the simulated time.
bool has_bypass(const scenario::Resolved& resolved);

}  // namespace takt::analysis
