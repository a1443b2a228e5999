#include "node/message_security.hpp"

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

namespace takt::node {

using namespace sim::literals;  // NOLINT: units in limits

const json::Object& describe(json::Type<MessageSecurity>) {
  using json::optional;
  using json::required;
  static constexpr json::Field fields[] = {
      optional<&MessageSecurity::mode>("mode", "What is done to each message; 46 octets more."),
      optional<&MessageSecurity::policy>("policy", "By what: HMAC-SHA256 in both, and AES."),
      required<&MessageSecurity::keys>("keys", "A file with the keys of their SecurityGroup, from the folder of this file. It is refused if others than its owner may read it.", {.min_length = 1, .max_length = 4096}),
      optional<&MessageSecurity::memory>("memory", "Where this node keeps what it must not forget when it is restarted. NODE.memory in $STATE_DIRECTORY, as root in /var/lib/takt, otherwise in ~/.local/state/takt, if absent.",
                                         {.min_length = 1, .max_length = 4096}),
      optional<&MessageSecurity::key_lifetime>("key_lifetime", "How long each key is used; 1 h if absent.", {.min = 10_ms, .max = 3600_s * 24}),
  };
  static constexpr json::Object table = json::object<MessageSecurity>("message_security", "Messages of programs that are signed, or signed and encrypted (OPC 10000-14).", fields, {.shorthand = "keys"});
  return table;
}

}  // namespace takt::node
