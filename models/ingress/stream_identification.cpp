// SPDX-License-Identifier: Apache-2.0
#include "models/ingress/stream_identification.hpp"

#include <utility>

namespace takt::models {
namespace {

bool vlan_matches(Tagged tagged, VlanId vlan, const StreamHeader& header) {
  const bool has_vid = header.tagged && header.vlan != 0;
  if (!has_vid) return tagged != Tagged::tagged;
  return tagged != Tagged::priority && (vlan == 0 || vlan == header.vlan);
}

bool matches(const NullIdentification& entry, const StreamHeader& header) {
  return entry.destination == header.destination && vlan_matches(entry.tagged, entry.vlan, header);
}

bool matches(const SourceMacAndVlanIdentification& entry, const StreamHeader& header) {
  return entry.source == header.source && vlan_matches(entry.tagged, entry.vlan, header);
}

bool matches(const MaskAndMatchIdentification& entry, const StreamHeader& header) {
  const auto differs = [](MacAddress address, MacAddress match, MacAddress mask) {
    return ((address.value ^ match.value) & mask.value) != 0;
  };
  if (differs(header.destination, entry.destination_match, entry.destination_mask)) return false;
  if (differs(header.source, entry.source_match, entry.source_mask)) return false;
  if (header.msdu.size() < entry.msdu_mask.size()) return false;
  for (std::size_t i = 0; i < entry.msdu_mask.size(); ++i)
    if (((header.msdu[i] ^ entry.msdu_match[i]) & entry.msdu_mask[i]) != std::byte{0}) return false;
  return true;
}

}  // namespace

bool identifies(const IdentificationFunction& function, const StreamHeader& header) {
  return std::visit([&](const auto& entry) { return matches(entry, header); }, function);
}

void StreamIdentityTable::add(StreamHandle handle, IdentificationFunction function) {
  TAKT_CHECK(!handle.is_none(), "an entry of the stream identity table names a stream");
  if (const auto* const entry = std::get_if<MaskAndMatchIdentification>(&function))
    TAKT_CHECK(entry->msdu_mask.size() == entry->msdu_match.size(), "an MSDU match has as many octets as its mask");
  entries_.push_back({handle, std::move(function)});
}

StreamHandle StreamIdentityTable::identify(const StreamHeader& header) const {
  for (const Entry& entry : entries_)
    if (identifies(entry.function, header)) return entry.handle;
  return {};
}

}  // namespace takt::models
