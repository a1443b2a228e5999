// SPDX-License-Identifier: Apache-2.0
// A secure channel of the server, spoken to by the client's half of the same functions.
#include <gtest/gtest.h>

#include "opcua/channel/secure_channel.hpp"
#include "transcript.hpp"

namespace takt::opcua {
namespace {

using namespace sim::literals;

const std::vector<std::byte> client_nonce(32, std::byte{0xC1});
const std::vector<std::byte> server_nonce(32, std::byte{0x5E});
const std::vector<std::byte> other_nonce(32, std::byte{0x77});

sim::LocalTime at(sim::Duration since) { return sim::LocalTime() + since; }

class Channel : public testing::TestWithParam<std::pair<SecurityPolicy, MessageSecurityMode>> {
 protected:
  ChannelSecurity security{GetParam().first, GetParam().second};
  SecureChannel channel{7, security, std::nullopt, 50};
  std::uint32_t sequence = 50;

  void SetUp() override { channel.issue(at(0_s), {}, 10'000, {1_s, 3600_s}, client_nonce, server_nonce); }

  std::vector<std::byte> chunk(std::uint32_t token, Octets nonce_of_server, std::uint32_t number,
                               const std::string& body = "0102") {
    Encoder encoder;
    encode_message_header(encoder, MessageType::Message);
    for (const std::uint32_t each : {std::uint32_t{7}, token, number, std::uint32_t{3}}) encoder.put(each);
    encoder.put_octets(test::octets_of(body));
    encoder.patch(4, static_cast<std::uint32_t>(encoder.position()));
    auto octets = encoder.take();
    if (is_secured(security.policy)) {
      TokenKeys keys = derive_keys(info(security.policy), client_nonce, nonce_of_server);
      seal(octets, keys.client, security.mode);
    }
    return octets;
  }
  StatusCode open(std::vector<std::byte> octets, sim::Duration since = 1_s) {
    return channel.open(octets, at(since), opened);
  }

  OpenedChunk opened;
};

TEST_P(Channel, OpensWhatFollows) {
  auto octets = chunk(1, server_nonce, 51, "aabbcc");
  EXPECT_EQ(channel.open(octets, at(1_s), opened), StatusCode::Good);
  EXPECT_EQ(test::hexadecimal({opened.body.begin(), opened.body.end()}), "aabbcc");
  EXPECT_EQ(opened.sequence.request_id, 3u);
}

TEST_P(Channel, RefusesReplaysAndGaps) {
  EXPECT_EQ(open(chunk(1, server_nonce, 51)), StatusCode::Good);
  EXPECT_EQ(open(chunk(1, server_nonce, 51)), StatusCode::BadSecurityChecksFailed);
  EXPECT_EQ(open(chunk(1, server_nonce, 53)), StatusCode::BadSecurityChecksFailed);
  EXPECT_EQ(open(chunk(1, server_nonce, 50)), StatusCode::BadSecurityChecksFailed);
  EXPECT_EQ(open(chunk(1, server_nonce, 52)), StatusCode::Good);
}

TEST_P(Channel, TheOldTokenIsGoodUntilTheNewOneIsUsed) {
  channel.issue(at(5_s), {}, 10'000, {1_s, 3600_s}, client_nonce, other_nonce);
  EXPECT_EQ(open(chunk(1, server_nonce, 51), 6_s), StatusCode::Good);
  EXPECT_EQ(open(chunk(2, other_nonce, 52), 7_s), StatusCode::Good);
  EXPECT_EQ(open(chunk(1, server_nonce, 53), 8_s), StatusCode::BadSecureChannelTokenUnknown);
}

TEST_P(Channel, AnswersWithTheOldTokenUntilTheClientUsesTheNewOne) {
  const auto token_of_answer = [&] {
    std::vector<std::byte> out;
    EXPECT_TRUE(channel.seal_message(1, client_nonce, {}, out));
    return uadp::load_little_endian<std::uint32_t>(out.data() + channel_header_octets);
  };
  channel.issue(at(5_s), {}, 10'000, {1_s, 3600_s}, client_nonce, other_nonce);
  EXPECT_EQ(token_of_answer(), 1u);
  EXPECT_EQ(open(chunk(2, other_nonce, 51), 7_s), StatusCode::Good);
  EXPECT_EQ(token_of_answer(), 2u);
}

TEST_P(Channel, TokensEndAQuarterAfterTheirLifetime) {
  EXPECT_EQ(open(chunk(1, server_nonce, 51), 12499_ms), StatusCode::Good);
  EXPECT_EQ(open(chunk(1, server_nonce, 52), 12500_ms), StatusCode::BadSecureChannelTokenUnknown);
  EXPECT_EQ(channel.ends(), at(12500_ms));
}

TEST_P(Channel, RefusesOtherChannelsAndTokens) {
  auto octets = chunk(1, server_nonce, 51);
  octets[message_header_octets] = std::byte{8};
  EXPECT_EQ(open(octets), StatusCode::BadTcpSecureChannelUnknown);
  EXPECT_EQ(open(chunk(2, server_nonce, 51)), StatusCode::BadSecureChannelTokenUnknown);
  EXPECT_EQ(open(chunk(0, server_nonce, 51)), StatusCode::BadSecureChannelTokenUnknown);
}

TEST_P(Channel, RefusesWhatWasTouched) {
  if (!is_secured(security.policy)) return;  // nobody sees it without a signature
  const auto good = chunk(1, server_nonce, 51);
  for (std::size_t i = symmetric_header_octets; i < good.size(); ++i) {
    auto octets = good;
    octets[i] ^= std::byte{1};
    EXPECT_EQ(open(octets), StatusCode::BadSecurityChecksFailed) << i;
  }
  for (std::size_t size = channel_header_octets; size < good.size(); ++size)
    EXPECT_NE(open({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)}), StatusCode::Good);
  EXPECT_EQ(open(good), StatusCode::Good);
}

TEST_P(Channel, LongMessagesGoInChunksThatFit) {
  const std::vector<std::byte> body(20'000, std::byte{0x42});
  SendLimits limits;
  std::vector<std::byte> out;
  ASSERT_TRUE(channel.seal_message(9, body, limits, out));
  std::size_t chunks = 0;
  std::size_t octets = 0;
  MessageSplitter splitter(limits.chunk_octets);
  splitter.feed(out);
  while (const auto message = splitter.next()) {
    std::vector<std::byte> copy(message->begin(), message->end());
    Octets clear = Octets(copy).subspan(symmetric_header_octets);
    if (is_secured(security.policy)) {
      TokenKeys keys = derive_keys(info(security.policy), client_nonce, server_nonce);
      const auto opened_chunk = opcua::open(copy, keys.server, security.mode);
      ASSERT_TRUE(opened_chunk);
      clear = *opened_chunk;
    }
    octets += clear.size() - sequence_header_octets;
    EXPECT_EQ(decode_message_header(*message)->chunk,
              octets == body.size() ? ChunkKind::Final : ChunkKind::Intermediate);
    EXPECT_EQ(uadp::load_little_endian<std::uint32_t>(clear.data()), ++chunks);
  }
  EXPECT_EQ(octets, body.size());
  EXPECT_EQ(chunks, 3u);
  limits.chunks = 2;
  EXPECT_FALSE(channel.seal_message(9, body, limits, out));
  limits.chunks = 0;
  limits.message_octets = 19'999;
  EXPECT_FALSE(channel.seal_message(9, body, limits, out));
}

INSTANTIATE_TEST_SUITE_P(
    Policies, Channel,
    testing::Values(std::pair(SecurityPolicy::None, MessageSecurityMode::None),
                    std::pair(SecurityPolicy::Basic256Sha256, MessageSecurityMode::Sign),
                    std::pair(SecurityPolicy::Basic256Sha256, MessageSecurityMode::SignAndEncrypt),
                    std::pair(SecurityPolicy::Aes128Sha256RsaOaep, MessageSecurityMode::SignAndEncrypt),
                    std::pair(SecurityPolicy::Aes256Sha256RsaPss, MessageSecurityMode::SignAndEncrypt)));

TEST(SequenceNumbers, Wrap) {
  EXPECT_TRUE(follows(2, 1));
  EXPECT_FALSE(follows(1, 1));
  EXPECT_TRUE(follows(0, 4'294'966'272U));
  EXPECT_TRUE(follows(1023, 4'294'967'295U));
  EXPECT_FALSE(follows(1024, 4'294'967'295U));
  EXPECT_FALSE(follows(0, 4'294'966'271U));
}

}  // namespace
}  // namespace takt::opcua
