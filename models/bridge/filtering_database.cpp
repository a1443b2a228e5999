#include "models/bridge/filtering_database.hpp"

#include <algorithm>
#include <utility>

namespace takt::models {

FilteringDatabase::Slot& FilteringDatabase::slot_for(std::uint64_t key) {
  for (std::size_t at = sim::mix64(key) & mask_;; at = (at + 1) & mask_)
    if (slots_[at].key == key || slots_[at].key == no_key) return slots_[at];
}

void FilteringDatabase::grow() {
  std::vector<Slot> old(std::max<std::size_t>(4, slots_.size() * 2));
  old.swap(slots_);
  mask_ = slots_.size() - 1;
  for (const Slot& slot : old)
    if (slot.key != no_key) slot_for(slot.key) = slot;
}

void FilteringDatabase::add(VlanId vlan, AddressIndex address, std::uint16_t port) {
  if (2 * (entries_ + 1) > slots_.size()) grow();
  const std::uint64_t key = key_of(vlan, address);
  Slot& slot = slot_for(key);
  if (slot.key == no_key) {
    slot = {key, 0, 1, port};
    ++entries_;
    return;
  }
  const std::span<const std::uint16_t> known = find(vlan, address);
  if (std::find(known.begin(), known.end(), port) != known.end()) return;
  std::vector<std::uint16_t> ports(known.begin(), known.end());
  ports.insert(std::upper_bound(ports.begin(), ports.end(), port), port);
  // The longer list goes to the end; the old one stays unused. Sets are built once, so little is lost.
  slot.first = static_cast<std::uint32_t>(ports_.size());
  slot.count = static_cast<std::uint16_t>(ports.size());
  ports_.insert(ports_.end(), ports.begin(), ports.end());
}

}  // namespace takt::models
