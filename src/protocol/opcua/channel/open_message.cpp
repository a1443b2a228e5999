// SPDX-License-Identifier: Apache-2.0
#include "opcua/channel/open_message.hpp"

namespace takt::opcua {

std::optional<std::vector<std::byte>> sealed_open(std::uint32_t channel, const PolicyInfo& policy,
                                                  const SequenceHeader& sequence, Octets body, const Identity& own,
                                                  const security::Certificate* other) {
  AsymmetricHeader header;
  header.policy_uri = Text(policy.uri);
  if (other != nullptr) {
    header.sender_certificate = Bytes({own.certificate.der().begin(), own.certificate.der().end()});
    header.receiver_thumbprint = Bytes({other->thumbprint().begin(), other->thumbprint().end()});
  }
  Encoder encoder;
  encode_message_header(encoder, MessageType::OpenChannel);
  encoder.put(channel);
  encode(encoder, header);
  const std::size_t clear_from = encoder.position();
  encoder.put(sequence.sequence_number);
  encoder.put(sequence.request_id);
  encoder.put_octets(body);
  encoder.patch(4, static_cast<std::uint32_t>(encoder.position()));
  std::vector<std::byte> chunk = encoder.take();
  if (other != nullptr && !seal_asymmetric(chunk, clear_from, policy, own.key, other->key())) return std::nullopt;
  return chunk;
}

}  // namespace takt::opcua
