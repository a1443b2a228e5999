// SPDX-License-Identifier: Apache-2.0
#include "models/ingress/stream_table.hpp"

#include <bit>

namespace takt::models {

StreamTable::StreamTable(std::span<const StreamIdentityEntry> entries, std::uint32_t first_group)
    : entries_(entries), first_group_(first_group) {
  for (std::uint32_t i = 0; i < entries.size(); ++i) {
    const StreamIdentityEntry& entry = entries[i];
    TAKT_CHECK(!entry.stream.is_none(), "an entry of the stream identity table names a stream");
    if (const auto* const address = std::get_if<AddressIdentification>(&entry.function))
      by_address_.push_back({address->destination,
                             address->tagged,
                             address->vlan,
                             {entry.stream, entry.member.value_or(no_member)},
                             i,
                             end});
    else
      others_.push_back(i);
  }
  heads_.assign(std::bit_ceil(2 * by_address_.size() + 1), end);
  mask_ = heads_.size() - 1;
  for (std::size_t i = by_address_.size(); i-- > 0;) {  // backwards, so that each chain is in the order of the table
    std::uint32_t& head = heads_[home_of(by_address_[i].destination)];
    by_address_[i].next = head;
    head = static_cast<std::uint32_t>(i);
  }
}

StreamTable::Found StreamTable::search_bucket(const Frame& frame, std::uint32_t by_address) const {
  const std::uint32_t limit = by_address == end ? end : by_address_[by_address].order;
  StreamHeader header;
  header.destination = mac_address_of(frame.destination, first_group_);
  header.source = mac_address_of(frame.source, first_group_);
  header.vlan = frame.vlan;
  header.tagged = frame.tagged;
  header.priority = frame.priority;
  for (const std::uint32_t i : others_) {
    if (i > limit) break;
    const StreamIdentityEntry& entry = entries_[i];
    const bool found = std::visit(
        [&](const auto& function) {
          if constexpr (std::is_same_v<std::decay_t<decltype(function)>, AddressIdentification>)
            return false;
          else
            return identifies(function, header);
        },
        entry.function);
    if (found) return {entry.stream, entry.member.value_or(no_member)};
  }
  return by_address == end ? Found{} : by_address_[by_address].found;
}

}  // namespace takt::models
