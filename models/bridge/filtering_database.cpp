// SPDX-License-Identifier: Apache-2.0
#include "models/bridge/filtering_database.hpp"

#include <algorithm>
#include <utility>

namespace takt::models {

std::uint64_t& FilteringDatabase::word_for(std::uint64_t key) {
  for (std::size_t at = home_of(key);; at = (at + 1) & mask_)
    if ((words_[at] & key_mask) == key || words_[at] == empty_word) return words_[at];
}

void FilteringDatabase::grow() {
  std::vector<std::uint64_t> old(std::max<std::size_t>(4, words_.size() * 2), empty_word);
  old.swap(words_);
  mask_ = words_.size() - 1;
  for (const std::uint64_t word : old)
    if (word != empty_word) word_for(word & key_mask) = word;
}

void FilteringDatabase::make_set(std::uint64_t& word, std::vector<std::uint16_t> ports) {
  TAKT_CHECK(sets_.size() < 0xFFFF, "at most 65535 multicast entries in a bridge");
  sets_.push_back(std::move(ports));
  word = (word & key_mask) | several | (sets_.size() - 1);
}

void FilteringDatabase::add(VlanId vlan, AddressIndex address, std::uint16_t port) {
  TAKT_CHECK(port < (1u << 15) && !address.is_none() && vlan < 4095,
             "a filtering entry for a port, an address and a VLAN that exist");
  if (2 * (entries_ + 1) > words_.size()) grow();
  const std::uint64_t key = key_of(vlan, address);
  std::uint64_t& word = word_for(key);
  if (word == empty_word) {
    ++entries_;
    word = key | port;
    if (port != internal_port) return;
    make_set(word, {port});  // nobody finds it at once
    return;
  }
  const Entry entry(word);
  if (entry.is_one_port()) {
    if (entry.port() == port) return;
    make_set(word, {entry.port()});
  }
  std::vector<std::uint16_t>& ports = sets_[Entry(word).port()];
  const auto at = std::lower_bound(ports.begin(), ports.end(), port);
  if (at == ports.end() || *at != port) ports.insert(at, port);
}

void FilteringDatabase::assign(VlanId vlan, AddressIndex address, std::span<const std::uint16_t> ports) {
  if (find(vlan, address).found()) {
    const std::uint64_t key = key_of(vlan, address);
    std::uint64_t& word = word_for(key);
    if (Entry(word).is_one_port()) make_set(word, {});
    sets_[Entry(word).port()].clear();
  }
  for (const std::uint16_t port : ports) add(vlan, address, port);
}

}  // namespace takt::models
