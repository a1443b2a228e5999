// SPDX-License-Identifier: Apache-2.0
#include "gateway/key_layout.hpp"

#include <algorithm>

#include "gateway/md5.hpp"
#include "sim/check.hpp"

namespace takt::gateway {
namespace {

constexpr std::size_t header = 4;
std::size_t aligned(std::size_t at, std::size_t size) { return (at + size - 1) / size * size; }

}  // namespace

KeyLayout::KeyLayout(const IdlStruct& type, std::span<const std::string> keys) {
  std::size_t at = 0;
  for (const IdlMember& each : type.members) {
    TAKT_CHECK(info(each.kind).octets != 0 && each.collection != IdlCollection::sequence,
               "members of a struct with a key have places that do not change");
    const std::size_t size = info(each.kind).alignment;
    const std::size_t count =
        (each.collection == IdlCollection::array ? each.length : 1) * (info(each.kind).octets / size);
    at = aligned(at, size);
    if (std::find(keys.begin(), keys.end(), each.name) != keys.end()) {
      octets_ = aligned(octets_, size);
      members_.push_back({at, octets_, size, count});
      octets_ += size * count;
    }
    at += size * count;
  }
}

KeyHash KeyLayout::of_data(uadp::Octets payload) const { return hash_of(payload, &Member::in_data); }
KeyHash KeyLayout::of_key(uadp::Octets payload) const { return hash_of(payload, &Member::in_key); }

std::vector<std::uint8_t> KeyLayout::key_in(uadp::Octets payload, std::size_t Member::*place) const {
  std::vector<std::uint8_t> key(octets_);
  if (!copy_key(payload, place, key)) key.clear();
  return key;
}

/// `key` has its octets, and zeros where nothing is put. False: the payload is none of the struct.
bool KeyLayout::copy_key(uadp::Octets payload, std::size_t Member::*place, std::span<std::uint8_t> key) const {
  if (payload.size() < header || payload[0] != std::byte{0} || payload[1] > std::byte{1}) return false;
  const bool is_little = payload[1] == std::byte{1};
  const uadp::Octets body = payload.subspan(header);
  for (const Member& member : members_) {
    if (member.*place + member.size * member.count > body.size()) return false;
    for (std::size_t i = 0; i < member.size * member.count; ++i) {
      const std::size_t in_value = i % member.size;
      const std::size_t from = is_little ? i - in_value + (member.size - 1 - in_value) : i;
      key[member.in_key + i] = std::to_integer<std::uint8_t>(body[member.*place + from]);
    }
  }
  return true;
}

KeyHash KeyLayout::hash_of(uadp::Octets payload, std::size_t Member::*place) const {
  if (is_in_hash()) {
    KeyHash hash{};
    return copy_key(payload, place, hash) ? hash : KeyHash{};
  }
  std::vector<std::uint8_t> key(octets_);
  return copy_key(payload, place, key) ? md5(key) : KeyHash{};
}

}  // namespace takt::gateway
