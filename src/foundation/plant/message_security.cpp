// SPDX-License-Identifier: Apache-2.0
#include "plant/message_security.hpp"

namespace takt::security {

using json::name;

const json::Enumeration& describe(json::Type<MessageMode>) {
  static constexpr json::EnumName names[] = {
      name(MessageMode::sign, "sign", "strangers are not heard, and can read"),
      name(MessageMode::sign_and_encrypt, "sign-and-encrypt", "strangers are not heard, and cannot read"),
  };
  static constexpr json::Enumeration table = json::enumeration<MessageMode>("a security mode", names);
  return table;
}

const json::Enumeration& describe(json::Type<MessagePolicy>) {
  static constexpr json::EnumName names[] = {
      name(MessagePolicy::aes128_ctr, "aes128-ctr", "PubSub-Aes128-CTR; keys of 52 octets"),
      name(MessagePolicy::aes256_ctr, "aes256-ctr", "PubSub-Aes256-CTR; keys of 68 octets"),
  };
  static constexpr json::Enumeration table = json::enumeration<MessagePolicy>("a security policy", names);
  return table;
}

}  // namespace takt::security

namespace takt::plant {

const json::Object& describe(json::Type<ProgramSecurity>) {
  using json::optional;
  static constexpr json::Field fields[] = {
      optional<&ProgramSecurity::mode>("mode", "What is done to each message; 46 octets more."),
      optional<&ProgramSecurity::policy>("policy", "By what: HMAC-SHA256 in both, and AES."),
  };
  static constexpr json::Object table = json::object<ProgramSecurity>(
      "program_security", "Messages of a program that are signed, or signed and encrypted (OPC 10000-14).", fields,
      {.shorthand = "mode"});
  return table;
}

}  // namespace takt::plant
