// SPDX-License-Identifier: Apache-2.0
// Passive stream identification (IEEE 802.1CB clauses 6 and 9.1, IEEE 802.1CBdb): which stream does a frame belong to?
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <variant>
#include <vector>

#include "models/ethernet/frame.hpp"
#include "models/ethernet/mac_address.hpp"

namespace takt::models {

using StreamHandle = Index<struct StreamHandleTag>;  ///< what stream identification gives a frame; none: no stream

/// What identification sees of a frame; a plain value that refers to the frame's octets.
struct StreamHeader {
  MacAddress destination;
  MacAddress source;
  VlanId vlan = 0;  ///< of the tag; 0 if untagged or priority-tagged
  bool tagged = false;
  Priority priority = 0;
  std::span<const std::byte> msdu;  ///< from the EtherType on, VLAN tag removed; the first octets are enough
};

/// Which frames an entry looks at (tsnCpeNullDownTagged and its like).
enum class Tagged : std::uint8_t {
  tagged,    ///< with a VLAN tag whose VID is not 0
  priority,  ///< untagged, or with VID 0
  all,       ///< either
};

/// Type 1, null (6.4): destination address and VLAN. A VID of 0 in an entry means any VID; frames without a VID that
/// `tagged` lets in have none to compare.
struct NullIdentification {
  MacAddress destination;
  Tagged tagged = Tagged::all;
  VlanId vlan = 0;
  bool operator==(const NullIdentification&) const = default;
};

/// Type 2, source MAC and VLAN (6.5).
struct SourceMacAndVlanIdentification {
  MacAddress source;
  Tagged tagged = Tagged::all;
  VlanId vlan = 0;
  bool operator==(const SourceMacAndVlanIdentification&) const = default;
};

/// Type 5, mask-and-match (802.1CBdb): a frame matches where the bits under the mask equal those of `match`. A mask of
/// 0 matches everything. A frame with fewer MSDU octets than the mask does not match.
struct MaskAndMatchIdentification {
  MacAddress destination_mask;
  MacAddress destination_match;
  MacAddress source_mask;
  MacAddress source_match;
  std::vector<std::byte> msdu_mask;
  std::vector<std::byte> msdu_match;  ///< as many octets as the mask
  bool operator==(const MaskAndMatchIdentification&) const = default;
};

using IdentificationFunction =
    std::variant<NullIdentification, SourceMacAndVlanIdentification, MaskAndMatchIdentification>;

/// Whether one function identifies the frame.
bool identifies(const IdentificationFunction& function, const StreamHeader& header);

/// The stream identity table of a port (9.1), ordered: the first entry that matches gives its handle.
class StreamIdentityTable {
 public:
  struct Entry {
    StreamHandle handle;
    IdentificationFunction function;
  };
  void add(StreamHandle handle, IdentificationFunction function);
  /// The handle of the first entry that matches, or none.
  StreamHandle identify(const StreamHeader& header) const;
  const std::vector<Entry>& entries() const { return entries_; }

 private:
  std::vector<Entry> entries_;
};

}  // namespace takt::models
