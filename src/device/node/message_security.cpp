// SPDX-License-Identifier: Apache-2.0
#include "node/message_security.hpp"

namespace takt::security {

const json::Enumeration& describe(json::Type<Nonces>) {
  static constexpr json::EnumName names[] = {
      json::name(Nonces::lives, "lives",
                 "of takt: the sender, how often it has been started, and a count; who begins anew is heard at once"),
      json::name(
          Nonces::counted, "counted",
          "of OPC 10000-14: a number that grows; who begins anew under the same key is not heard until the next one"),
      json::name(Nonces::lenient, "lenient",
                 "of open62541 1.5: numbers that do not grow; only the last 64 nonces of a publisher are no replays "
                 "under the same key, and none of them after a restart of this node"),
  };
  static constexpr json::Enumeration table = json::enumeration<Nonces>("what nonces mean", names);
  return table;
}

}  // namespace takt::security

namespace takt::node {

using namespace sim::literals;  // NOLINT: units in limits

const json::Object& describe(json::Type<KeyServiceAccess>) {
  using json::optional;
  using json::required;
  static constexpr json::Field fields[] = {
      required<&KeyServiceAccess::endpoint>("endpoint",
                                            "\"opc.tcp://10.0.0.1:4840\": IPv4 address, or the name of a host, and "
                                            "port of the service. A name is looked up before each pull.",
                                            {.min_length = 1, .max_length = 256}),
      required<&KeyServiceAccess::certificate>("certificate",
                                               "A file with the certificate of the service (DER or PEM), from the "
                                               "folder of this file. No other one is trusted.",
                                               {.min_length = 1, .max_length = 4096}),
      required<&KeyServiceAccess::user>("user",
                                        "As whom this node signs in: at a service of takt a user with key-access.",
                                        {.min_length = 1, .max_length = 64}),
      required<&KeyServiceAccess::password_file>(
          "password_file",
          "A file with the password on its first line. It is refused if others than its owner may read it.",
          {.min_length = 1, .max_length = 4096}),
      optional<&KeyServiceAccess::pki>("pki",
                                       "Folder of the key and the certificate of this node, made at the first start; "
                                       "that of its server, or NODE-pki beside this file, if absent.",
                                       {.min_length = 1, .max_length = 4096}),
  };
  static constexpr json::Object table = json::object<KeyServiceAccess>(
      "key_service_access", "A Security Key Service (OPC 10000-14, 8.3) that keys are pulled from.", fields);
  return table;
}

const json::Object& describe(json::Type<MessageSecurity>) {
  using json::optional;
  static constexpr json::Field fields[] = {
      optional<&MessageSecurity::mode>("mode", "What is done to each message; 46 octets more."),
      optional<&MessageSecurity::policy>("policy", "By what: HMAC-SHA256 in both, and AES."),
      optional<&MessageSecurity::keys>("keys",
                                       "A file with the keys of their SecurityGroup, from the folder of this file. It "
                                       "is refused if others than its owner may read it. Or",
                                       {.min_length = 1, .max_length = 4096}),
      optional<&MessageSecurity::key_service>("key_service", "a key service that gives them."),
      optional<&MessageSecurity::group>("group", "The SecurityGroup; needed with a key service.",
                                        {.min_length = 1, .max_length = 256}),
      optional<&MessageSecurity::memory>(
          "memory",
          "Where this node keeps what it must not forget when it is restarted. NODE.memory in $STATE_DIRECTORY, as "
          "root in /var/lib/takt, otherwise in ~/.local/state/takt, if absent.",
          {.min_length = 1, .max_length = 4096}),
      optional<&MessageSecurity::nonces>("nonces",
                                         "What the nonces of messages that are heard mean, so what is a replay. Of "
                                         "topics only; messages of programs have those of takt."),
      optional<&MessageSecurity::sender>(
          "sender",
          "Number of this node in its nonces: no other node that sends with these keys has it. Of topics only; the "
          "PublisherId of a topic that nobody else publishes to, if absent.",
          {.min = 1}),
      optional<&MessageSecurity::key_lifetime>(
          "key_lifetime", "How long each key of a file is used; 1 h if absent. A key service tells it.",
          {.min = 10_ms, .max = 3600_s * 24}),
  };
  static constexpr std::string_view members[] = {"keys", "key_service"};
  static constexpr json::Group groups[] = {json::exactly_one_of(members)};
  static constexpr json::Object table = json::object<MessageSecurity>(
      "message_security",
      "Messages of programs, or of topics of OPC UA, that are signed, or signed and encrypted (OPC 10000-14).", fields,
      {.groups = groups, .shorthand = "keys"});
  return table;
}

}  // namespace takt::node
