// SPDX-License-Identifier: Apache-2.0
// What management sets of a redundant stream: where it is split into member streams, and where these become one again
// (IEEE 802.1CB clauses 7.4.1, 7.4.3, 7.5, 7.7). Plain data, the same for bridges and hosts.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "models/ethernet/frame.hpp"
#include "models/frer/latent_error_detection.hpp"
#include "models/frer/sequence_recovery.hpp"
#include "sim/time.hpp"

namespace takt::models {

/// One member of a compound stream: what its frames are addressed to, so that the filtering databases lead them along a
/// path of their own. A VLAN other than 0 asks for frames with a tag.
struct StreamMember {
  AddressIndex destination;
  VlanId vlan = 0;
  std::uint16_t port = 0;  ///< through which the node that splits sends the member; bridges go by their filtering
                           ///< databases, and by this where they must not send back
  bool operator==(const StreamMember&) const = default;
};

/// Sequence generation, encoding and splitting. A frame that carries an R-TAG already keeps its number.
struct StreamSplitConfig {
  std::vector<StreamMember> members;  ///< at least one
  bool operator==(const StreamSplitConfig&) const = default;
};

/// Decoding, individual recovery, sequence recovery, latent error detection.
struct StreamRecoveryConfig {
  std::vector<StreamMember> members;
  SequenceRecoveryConfig recovery;  ///< of the compound stream; individual_recovery is false
  /// Also recovers each member stream at each reception port by itself before, with the same algorithm and history:
  /// takes out what a member stream brings twice, such as the frames of a babbling sender.
  bool individual_recovery = false;
  /// frerSeqRcvyResetMSec: without a passed frame for so long the function takes any number again. Positive.
  sim::Duration reset_timeout = sim::Duration::from_ps(1'000'000'000'000);
  std::optional<LatentErrorDetectionConfig> latent_error_detection;
  bool keep_r_tag = false;   ///< false: frames go on without their R-TAG
  AddressIndex destination;  ///< what frames that pass are addressed to from here on: the compound stream's address
  VlanId vlan = 0;
  bool operator==(const StreamRecoveryConfig&) const = default;
};

/// A host that splits a stream of which it is the talker.
struct HostSplitPlan {
  StreamIndex stream;
  StreamSplitConfig split;
};

/// A host that recovers a stream to which it listens.
struct HostRecoveryPlan {
  NodeIndex host;
  StreamIndex stream;
  StreamRecoveryConfig recovery;
};

}  // namespace takt::models
