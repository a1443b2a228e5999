// SPDX-License-Identifier: Apache-2.0
// What passed between a stock client and a stock server is read, and written again octet for octet: bodies, framing,
// keys, signatures, encryption.
#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "opcua/channel/chunk.hpp"
#include "opcua/services/monitored_items.hpp"
#include "opcua/services/session.hpp"
#include "opcua/services/subscriptions.hpp"
#include "opcua/services/view.hpp"
#include "security/key_derivation.hpp"
#include "transcript.hpp"

namespace takt::opcua {
namespace {

using test::hexadecimal;
using test::RecordedKeys;
using test::RecordedMessage;
using test::transcript;

using Rewriter = std::function<std::vector<std::byte>(Octets)>;

/// Reads a body without its type id and writes it again.
template <Structure T>
Rewriter rewriter() {
  return [](Octets octets) -> std::vector<std::byte> {
    Decoder decoder(octets);
    T body;
    decode(decoder, body);
    EXPECT_FALSE(decoder.failed());
    EXPECT_EQ(decoder.left(), 0u);
    return encoded(body);
  };
}

template <Structure... T>
std::map<std::uint32_t, Rewriter> rewriters() {
  return {{T::encoding_id, rewriter<T>()}...};
}

const std::map<std::uint32_t, Rewriter>& all_rewriters() {
  static const auto all =
      rewriters<ServiceFault, OpenSecureChannelRequest, OpenSecureChannelResponse, CloseSecureChannelRequest,
                GetEndpointsRequest, GetEndpointsResponse, CreateSessionRequest, CreateSessionResponse,
                ActivateSessionRequest, ActivateSessionResponse, CloseSessionRequest, CloseSessionResponse,
                BrowseRequest, BrowseResponse, TranslateBrowsePathsToNodeIdsRequest,
                TranslateBrowsePathsToNodeIdsResponse, ReadRequest, ReadResponse, WriteRequest, WriteResponse,
                CallRequest, CallResponse, CreateSubscriptionRequest, CreateSubscriptionResponse,
                DeleteSubscriptionsRequest, DeleteSubscriptionsResponse, CreateMonitoredItemsRequest,
                CreateMonitoredItemsResponse, PublishRequest, PublishResponse>();
  return all;
}

void expect_same_body(Octets sequence_header_and_body, const std::string& where) {
  const Octets body = sequence_header_and_body.subspan(sequence_header_octets);
  Decoder decoder(body);
  NodeId type;
  decode(decoder, type);
  const auto found = all_rewriters().find(type.standard());
  ASSERT_NE(found, all_rewriters().end()) << where << ": " << to_text(type);
  const Octets rest = body.subspan(decoder.position());
  EXPECT_EQ(hexadecimal(found->second(rest)), hexadecimal({rest.begin(), rest.end()}))
      << where << ": " << to_text(type);
}

TEST(Golden, BodiesAreWrittenAsTheyWereRead) {
  std::size_t seen = 0;
  for (const std::string name : {"none", "basic256sha256"})
    for (const RecordedMessage& message : transcript(name)) {
      if (message.type == "HEL" || message.type == "ACK") continue;
      const std::string where = name + " " + std::to_string(message.number);
      Octets clear = message.clear;
      if (message.clear.empty()) {
        AsymmetricHeader header;
        const std::size_t from =
            message.type == "OPN" ? decode_asymmetric_header(message.octets, header).value() : symmetric_header_octets;
        clear = Octets(message.octets).subspan(from);
      }
      expect_same_body(clear, where);
      ++seen;
    }
  EXPECT_GT(seen, 150u);
}

template <Structure T>
void expect_same_frame(const RecordedMessage& message, MessageType type) {
  Decoder decoder(Octets(message.octets).subspan(message_header_octets));
  T body;
  decode(decoder, body);
  ASSERT_FALSE(decoder.failed());
  EXPECT_EQ(hexadecimal(framed(type, body)), hexadecimal(message.octets));
}

TEST(Golden, HelloAndAcknowledge) {
  std::size_t seen = 0;
  for (const RecordedMessage& message : transcript("none")) {
    if (message.type == "HEL") expect_same_frame<Hello>(message, MessageType::Hello);
    if (message.type == "ACK") expect_same_frame<Acknowledge>(message, MessageType::Acknowledge);
    seen += message.type == "HEL" || message.type == "ACK" ? 1 : 0;
  }
  EXPECT_EQ(seen, 2u);
}

/// Both sides of a secured conversation, followed from its OPNs on.
class Secured : public testing::Test {
 protected:
  const PolicyInfo& policy = info(SecurityPolicy::Basic256Sha256);
  const std::optional<security::PrivateKey> client_key =
      security::PrivateKey::from_pem(test::golden_file("client.key.pem"));
  const std::optional<security::PrivateKey> server_key =
      security::PrivateKey::from_pem(test::golden_file("server.key.pem"));
  const std::optional<security::Certificate> client = security::Certificate::from_pem(test::golden_file("client.pem"));
  const std::optional<security::Certificate> server = security::Certificate::from_pem(test::golden_file("server.pem"));
};

TEST_F(Secured, OpenChunksAreOpened) {
  ASSERT_TRUE(client_key && server_key && client && server);
  std::size_t seen = 0;
  for (const RecordedMessage& message : transcript("basic256sha256")) {
    if (message.type != "OPN" || message.clear.empty()) continue;
    AsymmetricHeader header;
    const auto from = decode_asymmetric_header(message.octets, header);
    ASSERT_TRUE(from);
    EXPECT_EQ(header.policy_uri, policy.uri);
    const auto& sender = message.from_client ? *client : *server;
    const auto& receiver = message.from_client ? *server : *client;
    EXPECT_EQ(header.receiver_thumbprint.value,
              std::vector<std::byte>(receiver.thumbprint().begin(), receiver.thumbprint().end()));
    EXPECT_EQ(security::Certificate::from_der(header.sender_certificate.value), sender);
    const auto opened =
        open_asymmetric(message.octets, *from, policy, message.from_client ? *server_key : *client_key, sender.key());
    ASSERT_TRUE(opened) << message.number;
    EXPECT_EQ(hexadecimal(*opened), hexadecimal(message.clear));
    ++seen;
    // One octet that differs, anywhere, and it is refused.
    for (const std::size_t at : {std::size_t{0}, std::size_t{20}, *from, message.octets.size() - 1}) {
      auto broken = message.octets;
      broken[at] ^= std::byte{1};
      EXPECT_FALSE(
          open_asymmetric(broken, *from, policy, message.from_client ? *server_key : *client_key, sender.key()))
          << at;
    }
  }
  EXPECT_GE(seen, 4u);
}

TEST_F(Secured, KeysFollowFromTheNonces) {
  std::vector<std::byte> client_nonce;
  std::size_t seen = 0;
  for (const RecordedMessage& message : transcript("basic256sha256")) {
    if (message.type != "OPN" || message.clear.empty()) continue;
    Decoder decoder(Octets(message.clear).subspan(sequence_header_octets));
    NodeId type;
    decode(decoder, type);
    if (message.from_client) {
      OpenSecureChannelRequest request;
      decode(decoder, request);
      client_nonce = request.client_nonce.value;
      continue;
    }
    OpenSecureChannelResponse response;
    decode(decoder, response);
    ASSERT_TRUE(message.keys);
    const std::size_t octets = ChunkKeys::octets(policy);
    const auto of = [](const security::Secret& secret) {
      return hexadecimal({secret.octets().begin(), secret.octets().end()});
    };
    EXPECT_EQ(of(security::p_sha256(response.server_nonce.value, client_nonce, octets)),
              hexadecimal(message.keys->client));
    EXPECT_EQ(of(security::p_sha256(client_nonce, response.server_nonce.value, octets)),
              hexadecimal(message.keys->server));
    ++seen;
  }
  EXPECT_GE(seen, 2u);
}

TEST_F(Secured, MessagesAreOpenedAndSealedToTheSameOctets) {
  std::map<std::uint32_t, RecordedKeys> keys;
  std::size_t seen = 0;
  for (const RecordedMessage& message : transcript("basic256sha256")) {
    if (message.keys) keys[message.keys->token] = *message.keys;
    if ((message.type != "MSG" && message.type != "CLO") || message.clear.empty()) continue;
    const auto token = uadp::load_little_endian<std::uint32_t>(message.octets.data() + channel_header_octets);
    ASSERT_TRUE(keys.contains(token));
    ChunkKeys of(policy, message.from_client ? keys[token].client : keys[token].server);
    auto chunk = message.octets;
    const auto opened = open(chunk, of, MessageSecurityMode::SignAndEncrypt);
    ASSERT_TRUE(opened) << message.number;
    EXPECT_EQ(hexadecimal({opened->begin(), opened->end()}), hexadecimal(message.clear));
    std::vector<std::byte> again(message.octets.begin(), message.octets.begin() + symmetric_header_octets);
    again.insert(again.end(), message.clear.begin(), message.clear.end());
    seal(again, of, MessageSecurityMode::SignAndEncrypt);
    EXPECT_EQ(hexadecimal(again), hexadecimal(message.octets)) << message.number;
    ++seen;
    for (const std::size_t at :
         {std::size_t{3}, std::size_t{12}, std::size_t{16}, message.octets.size() / 2, message.octets.size() - 1}) {
      auto broken = message.octets;
      broken[at] ^= std::byte{0x10};
      EXPECT_FALSE(open(broken, of, MessageSecurityMode::SignAndEncrypt)) << at;
    }
  }
  EXPECT_GT(seen, 60u);
}

}  // namespace
}  // namespace takt::opcua
