// SPDX-License-Identifier: Apache-2.0
// NetworkMessages of UADP with security (OPC 10000-14, 7.2.4.4.3): sealed to be sent, opened when they have come.
//
//   flags and ids | SecurityHeader | payload | signature
//   <----------------- signed ---------------->
//                                   <encrypted>
//
// Sans-IO, and nothing allocates once it has had its longest message: times, keys and memory of windows are given.
#pragma once

#include <optional>
#include <vector>

#include "security/key_ring.hpp"
#include "security/replay_window.hpp"

namespace takt::security {

/// What the octets of nonces mean, and so what is a replay.
enum class Nonces : std::uint8_t {
  /// Random is sender and life, the number counts all that this life of the sender has signed with the key. So no two
  /// nonces under a key are the same, and a node that was restarted is heard at once.
  lives,
  /// As the standard asks: the number counts, whatever Random is. A publisher that begins anew under the same key is
  /// not heard until the next one.
  counted,
  /// For peers whose number does not count (open62541 1.5.7): a nonce must not be among the last ones of its stream.
  /// What is older than these is left to sequence numbers of messages.
  lenient,
};

struct ChannelSettings {
  MessageMode mode = MessageMode::sign_and_encrypt;  ///< not none
  Nonces nonces = Nonces::lives;
  std::uint16_t sender = 0;  ///< no other node that sends with these keys has it
  std::uint16_t life = 0;    ///< another one at each start under the same key
};

/// What speaks against a message.
enum class SecurityVerdict : std::uint8_t {
  good,
  malformed,  ///< no NetworkMessage
  unsecured,
  mode,    ///< signed only where messages are encrypted, or the other way round
  header,  ///< encrypted and not signed, reserved bits, a footer, a nonce of another length
  token,
  truncated,
  signature,
  replayed,
};

struct Opened {
  SecurityVerdict verdict = SecurityVerdict::malformed;
  /// The same message as it would be without security; lasts until the next one. Empty unless the verdict is good.
  Octets clear;
  /// Keys are to be fetched now. Of a good message: its publisher says that those that are there are about to be void.
  /// With the verdict token: it has a later one than the current one, which anybody can write.
  bool wants_keys = false;
};

class SecureChannel {
 public:
  /// `memory` outlives it; two channels do not share one.
  SecureChannel(const ChannelSettings& settings, KeyRing keys, ReplayMemory memory);

  /// The sealed message, which lasts until the next one; empty if there is no key for now, the octets are no
  /// NetworkMessage without security, or the key has signed all that it may.
  Octets seal(Octets clear, std::int64_t now_ns);
  Opened open(Octets message, std::int64_t now_ns);

  /// Another life, after the clock was far ahead: what was signed with the keys of now before has other nonces.
  void begin_anew(std::uint16_t life, std::int64_t now_ns) {
    settings_.life = life;
    keys_.come_back(now_ns);
    token_ = 0;
    number_ = 0;
  }

  const ChannelSettings& settings() const { return settings_; }
  KeyRing& keys() { return keys_; }
  /// With which it has sealed last; 0: none yet.
  std::uint32_t token() const { return token_; }
  /// Messages that were not sealed.
  std::uint64_t unsealed() const { return unsealed_; }

 private:
  bool is_fresh(const StreamKey& stream, std::uint32_t token, Octets nonce);
  bool is_fresh_leniently(const StreamKey& stream, std::uint32_t token, Octets nonce);

  ChannelSettings settings_;
  KeyRing keys_;
  ReplayMemory memory_;
  std::uint32_t token_ = 0;
  std::uint32_t number_ = 0;  ///< of the last message under that token
  std::uint64_t unsealed_ = 0;
  std::vector<std::byte> sealed_;
  std::vector<std::byte> opened_;

  /// Of a lenient channel: the last nonces of a stream.
  struct Remembered {
    static constexpr std::size_t nonces = 64;
    StreamKey stream;
    std::array<std::uint64_t, nonces> last{};
    std::uint32_t token = 0;
    std::size_t next = 0;
  };
  static constexpr std::size_t most_remembered = 256;
  std::vector<Remembered> remembered_;
};

}  // namespace takt::security
