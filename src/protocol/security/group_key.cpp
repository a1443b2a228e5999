// SPDX-License-Identifier: Apache-2.0
#include "security/group_key.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::security {
namespace {

Octets part(MessagePolicy policy, Octets key, std::size_t begin, std::size_t count) {
  TAKT_CHECK(key.size() == key_octets(policy), "a key has the length of its policy");
  return key.subspan(begin, count);
}

}  // namespace

GroupKey::GroupKey(MessagePolicy policy, Octets key)
    : signing_(Hash::sha256, part(policy, key, 0, signing_key_octets)),
      encrypting_(part(policy, key, signing_key_octets, encrypting_key_octets(policy))) {
  const Octets nonce = key.last(key_nonce_octets);
  std::copy(nonce.begin(), nonce.end(), key_nonce_.begin());
}

/// KeyNonce, MessageNonce, and the number of the block as a big-endian number from 1 on.
void GroupKey::crypt(Octets nonce, std::span<std::byte> payload) {
  TAKT_CHECK(nonce.size() == message_nonce_octets, "the nonce of a message has 8 octets");
  AesBlock block{};
  const auto behind = std::copy(key_nonce_.begin(), key_nonce_.end(), block.begin());
  std::copy(nonce.begin(), nonce.end(), behind);
  block.back() = std::byte{1};
  encrypting_.apply(block, payload);
}

}  // namespace takt::security
