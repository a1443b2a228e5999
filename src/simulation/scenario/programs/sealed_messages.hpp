// SPDX-License-Identifier: Apache-2.0
// The messages of one member of a simulated Program whose messages are secured: sealed and opened as on a real node,
// with a key that everybody may know.
//
// The key is that of token 1, derived (security::DerivedKeys) from the Program's name and a secret of 32 octets that
// are zero, and lasts for ever.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "plant/message_security.hpp"
#include "security/secure_channel.hpp"

namespace takt::scenario {

class SealedMessages {
 public:
  /// `sender`: its number in nonces. `streams`: that it may hear.
  SealedMessages(const plant::ProgramSecurity& security, std::string group, std::uint16_t sender, std::size_t streams);
  SealedMessages(const SealedMessages&) = delete;
  SealedMessages& operator=(const SealedMessages&) = delete;

  /// Lasts until the next one.
  security::Octets seal(security::Octets clear);
  /// Nothing if it is refused. Lasts until the next one.
  std::optional<security::Octets> open(security::Octets sealed);
  /// Another life; what has come of whom is remembered.
  void restart();

 private:
  void begin_life();

  plant::ProgramSecurity security_;
  std::string group_;
  std::uint16_t sender_;
  std::uint16_t life_ = 1;
  std::vector<security::StoredWindow> windows_;
  std::optional<security::SecureChannel> channel_;
};

}  // namespace takt::scenario
