// SPDX-License-Identifier: Apache-2.0
// The member streams of a redundant stream: their paths, where they part and where they meet again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "scenario/resolved/resolved.hpp"

namespace takt::scenario {

/// Paths that run together from the sender to paths[i][split], for all i, and from the node that has `after_merge`
/// nodes behind it to the receiver.
struct MemberPaths {
  std::vector<Path> paths;
  std::size_t split = 0;        ///< 0: the sender
  std::size_t after_merge = 0;  ///< 0: the receiver
  std::size_t number = 0;       ///< paths[i][number] numbers the frames; at most split
  std::size_t merge(const Path& path) const { return path.size() - 1 - after_merge; }
};

/// The paths that the description asks for, from host to host. Nothing if there are none (reported, with the reason).
std::optional<MemberPaths> lay_members(const Resolved& resolved, const Redundancy& redundancy, std::uint32_t from,
                                       std::uint32_t to, json::Diagnostics& diagnostics);

/// The same for several receivers: two trees. The paths to the first receiver come first.
std::optional<MemberPaths> lay_member_trees(const Resolved& resolved, const Redundancy& redundancy, std::uint32_t from,
                                            const std::vector<std::pair<std::uint32_t, json::Place>>& to,
                                            json::Diagnostics& diagnostics);

/// What of a redundant stream goes from one node to the next.
struct OnHop {
  std::optional<std::size_t> member;  ///< between split and merge
  bool r_tagged = false;
};
/// For each hop of the stream's path with that number.
std::vector<OnHop> on_hops(const Resolved& resolved, const ResolvedRedundancy& redundancy, std::size_t path);

/// Which members go where, and what nodes do to them: fills relays, members and member_of_link of a ladder with these
/// paths. `member` makes a new member for the link out of a node.
void lay_ladder(const MemberPaths& paths, ResolvedRedundancy& redundancy,
                const std::function<models::StreamMember(std::uint32_t from, std::uint32_t to)>& member);

/// Where in a bridge or host members become one stream again, and what they are addressed to behind it: `in` and `out`
/// are numbers of members; without `out` it is the compound stream. The rest as recovery_config() has it.
models::StreamRecoveryConfig ladder_recovery(const Resolved& resolved, const ResolvedRedundancy& redundancy,
                                             const ResolvedRedundancy::Relay& relay, json::Diagnostics& diagnostics);

/// What the description says of recovery; `compound` is what frames are addressed to behind it. A history that is
/// shorter than the lead that one path may have is a warning.
models::StreamRecoveryConfig recovery_config(const Resolved& resolved, const ResolvedRedundancy& redundancy,
                                             json::Diagnostics& diagnostics);
/// What splits the compound stream where it is numbered: the number alone, or a frame for each member.
models::StreamSplitConfig numbering_config(const Resolved& resolved, const ResolvedRedundancy& redundancy);

}  // namespace takt::scenario
