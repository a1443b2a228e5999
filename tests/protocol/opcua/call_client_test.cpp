// SPDX-License-Identifier: Apache-2.0
// The client that calls GetSecurityKeys, and the server that answers it: octet for octet, without a network; and
// servers that answer anything else.
#include "opcua/client/call_client.hpp"

#include <gtest/gtest.h>

#include "opcua/channel/password.hpp"
#include "support/key_service_bench.hpp"
#include "support/opcua_bench.hpp"

namespace takt::opcua {
namespace {

using test::at;
using test::KeyBench;

TEST(KeyService, GivesKeysOverAnEncryptedChannel) {
  KeyBench bench;
  const auto client = bench.pull({Text("cell"), 0, 2});
  ASSERT_EQ(client->problem(), "");
  ASSERT_EQ(client->result().status_code, StatusCode::Good);
  const auto keys = keys_in(client->result());
  ASSERT_TRUE(keys);
  EXPECT_EQ(keys->policy_uri, "http://opcfoundation.org/UA/SecurityPolicy#PubSub-Aes128-CTR");
  EXPECT_EQ(keys->first_token, 7u);
  ASSERT_EQ(keys->keys.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(keys->keys[i], bench.service.key(7 + static_cast<std::uint32_t>(i)));
  EXPECT_EQ(keys->time_to_next_ms, 250.0);
  EXPECT_EQ(keys->lifetime_ms, 1000.0);
  EXPECT_EQ(bench.service.users, (std::vector<std::string>{"left"}));
  EXPECT_EQ(bench.server.services().sessions(), 0u) << "it has closed what it has opened";
}

// A certificate that is taken off the list ends its channel and its session, in the middle of whatever they do.
TEST(KeyService, WhoIsTrustedNoMoreGoes) {
  KeyBench bench;
  const auto client = bench.client(call_of({Text("cell"), 0, 2}));
  const ConnectionId id = bench.server.connected("192.0.2.9:1000", at(0));
  for (int i = 0; i < 20 && bench.server.services().sessions() == 0; ++i) {
    bench.server.received(id, client->output(), at(0));
    client->sent(client->output().size());
    const Octets output = bench.server.output(id);
    const std::vector<std::byte> octets(output.begin(), output.end());
    bench.server.sent(id, octets.size(), at(0));
    client->received(octets, at(0));
  }
  ASSERT_EQ(bench.server.services().sessions(), 1u);
  bench.server.check_trust(at(1));
  EXPECT_FALSE(bench.server.is_closing(id));
  bench.server.trust({});
  bench.server.check_trust(at(2));
  EXPECT_TRUE(bench.server.is_closing(id));
  EXPECT_EQ(bench.server.services().sessions(), 0u);
}

/// An OPN of the client of the bench, with this sequence number.
std::vector<std::byte> open_of(SecurityTokenRequestType type, std::uint32_t channel, std::uint32_t number) {
  OpenSecureChannelRequest request;
  request.request_type = type;
  request.security_mode = MessageSecurityMode::SignAndEncrypt;
  request.client_nonce = Bytes(std::vector<std::byte>(nonce_octets));
  request.requested_lifetime = 60'000;
  Encoder body;
  encode_message(body, request);
  const auto& server = test::test_identity().certificate;
  return *sealed_open(channel, info(SecurityPolicy::Basic256Sha256), {number, number}, body.octets(),
                      test::other_identity(), &server);
}

TEST(KeyService, WhatComesBehindARenewalWaitsWithIt) {
  KeyBench bench;
  const ConnectionId id = bench.server.connected("192.0.2.9:1000", at(0));
  Hello hello;
  hello.receive_buffer_size = hello.send_buffer_size = 65536;
  hello.endpoint_url = Text("opc.tcp://127.0.0.1:4840");
  bench.server.received(id, framed(MessageType::Hello, hello), at(0));
  bench.server.sent(id, bench.server.output(id).size(), at(0));
  bench.server.received(id, open_of(SecurityTokenRequestType::Issue, 0, 1), at(0));
  const Octets answer = bench.server.output(id);
  AsymmetricHeader header;
  const auto clear_from = decode_asymmetric_header(answer, header);
  ASSERT_TRUE(clear_from);
  const auto opened = open_asymmetric(answer, *clear_from, info(SecurityPolicy::Basic256Sha256),
                                      test::other_identity().key, test::test_identity().certificate.key());
  ASSERT_TRUE(opened);
  Decoder decoder(Octets(*opened).subspan(sequence_header_octets));
  NodeId type;
  OpenSecureChannelResponse response;
  decode(decoder, type);
  decode(decoder, response);
  ASSERT_FALSE(decoder.failed());
  SecureChannel channel(response.security_token.channel_id,
                        {SecurityPolicy::Basic256Sha256, MessageSecurityMode::SignAndEncrypt},
                        test::test_identity().certificate, 1, Side::client, 2);
  const std::vector<std::byte> nonce(nonce_octets);
  channel.take(response.security_token, at(0).local, nonce, response.server_nonce.value);
  bench.server.sent(id, answer.size(), at(0));

  std::vector<std::byte> both = open_of(SecurityTokenRequestType::Renew, channel.id(), 2);
  GetEndpointsRequest request;
  request.endpoint_url = hello.endpoint_url;
  Encoder body;
  encode_message(body, request);
  ASSERT_TRUE(channel.seal_message(3, body.octets(), {65536, 0, 0}, both));
  bench.server.received(id, both, at(1));
  MessageSplitter splitter(1 << 20);
  splitter.feed(bench.server.output(id));
  std::vector<MessageType> answers;
  while (const auto message = splitter.next()) answers.push_back(decode_message_header(*message)->type);
  EXPECT_EQ(answers, (std::vector{MessageType::OpenChannel, MessageType::Message})) << bench.log.last;
}

TEST(KeyService, OctetsMayComeOneByOne) {
  KeyBench bench;
  bench.piece = 1;
  EXPECT_EQ(bench.pull({Text("cell"), 0, 2})->problem(), "");
}

TEST(KeyService, AnyPolicyWillDo) {
  for (const SecurityPolicy policy : {SecurityPolicy::Aes128Sha256RsaOaep, SecurityPolicy::Aes256Sha256RsaPss}) {
    KeyBench bench;
    bench.settings.policy = policy;
    EXPECT_EQ(bench.pull({Text("cell"), 0, 2})->problem(), "") << info(policy).name;
  }
}

// Observers, operators and engineers have no need of keys; groups are nobody's business who may not have them.
TEST(KeyService, IsForThoseWhoMayHaveKeys) {
  KeyBench bench;
  for (const char* const user : {"olaf", "anna", "emil"}) {
    bench.settings.user = user;
    for (const char* const group : {"cell", "none"})
      EXPECT_EQ(bench.pull({Text(group), 0, 2})->result().status_code, StatusCode::BadUserAccessDenied) << user;
  }
  EXPECT_TRUE(bench.service.users.empty());
  bench.settings.user = "left";
  EXPECT_EQ(bench.pull({Text("none"), 0, 2})->result().status_code, StatusCode::BadNotFound);
}

TEST(KeyService, RefusesArgumentsThatAreNone) {
  KeyBench bench;
  const auto result = [&](List<Variant> arguments) {
    CallMethodRequest call = call_of({});
    call.input_arguments = std::move(arguments);
    return bench.call(call)->result();
  };
  EXPECT_EQ(result({}).status_code, StatusCode::BadArgumentsMissing);
  EXPECT_EQ(result({Variant(Text("cell")), Variant(0U), Variant(0U), Variant(0U)}).status_code,
            StatusCode::BadTooManyArguments);
  const auto mistyped = result({Variant(Text("cell")), Variant(0.0), Variant(0U)});
  EXPECT_EQ(mistyped.status_code, StatusCode::BadInvalidArgument);
  EXPECT_EQ(mistyped.input_argument_results,
            (std::vector{StatusCode::Good, StatusCode::BadTypeMismatch, StatusCode::Good}));
  CallMethodRequest other = call_of({Text("cell"), 0, 0});
  other.method_id = NodeId(2426);
  EXPECT_EQ(bench.call(other)->result().status_code, StatusCode::BadMethodInvalid);
}

// Key access is for keys: Programs are moved by others.
TEST(KeyService, WhoMayHaveKeysMovesNothing) {
  KeyBench bench;
  CallMethodRequest halt;
  halt.object_id = NodeId(1, "cell");
  halt.method_id = NodeId(2429);
  EXPECT_EQ(bench.call(halt)->result().status_code, StatusCode::BadUserAccessDenied);
  EXPECT_TRUE(bench.host.calls.empty());
}

TEST(KeyService, GivesNothingInClear) {
  KeyBench bench;
  test::PlainClientOf<KeyBench> client(bench);
  client.open();
  ASSERT_EQ(client.sign_in("left", "secret"), StatusCode::Good);
  CallRequest request;
  request.methods_to_call.push_back(call_of({Text("cell"), 0, 0}));
  const auto response = client.ask<CallResponse>(request);
  EXPECT_EQ(response.results.at(0).status_code, StatusCode::BadSecurityModeInsufficient);
  EXPECT_TRUE(response.results.at(0).output_arguments.empty());
  EXPECT_TRUE(bench.service.users.empty());
}

TEST(KeyService, IsInTheAddressSpaceOnlyWhereThereIsOne) {
  KeyBench with;
  EXPECT_NE(with.server.services().space().find(NodeId(ids::publish_subscribe)), nullptr);
  const Node* const outputs = with.server.services().space().find(NodeId(15217));
  ASSERT_NE(outputs, nullptr);
  EXPECT_EQ(outputs->value.value->values.size(), 5u);
  const test::Bench without;
  EXPECT_EQ(without.server.services().space().find(NodeId(ids::publish_subscribe)), nullptr);
}

TEST(CallClient, SpeaksToTheCertificateThatItKnowsOnly) {
  KeyBench bench;
  bench.trusted = test::other_identity().certificate;  // the server has another one
  EXPECT_EQ(bench.pull({Text("cell"), 0, 2})->problem(), "it refuses: Bad_CertificateInvalid");
}

TEST(CallClient, WrongPasswordsAreRefused) {
  KeyBench bench;
  bench.settings.password = security::Secret(std::as_bytes(std::span("wrong", 5)));
  EXPECT_EQ(bench.pull({Text("cell"), 0, 2})->problem(), "it refuses the sign-in: Bad_UserAccessDenied");
}

TEST(CallClient, AServerThatDoesNotTrustIt) {
  KeyBench bench;
  bench.server.trust({});
  EXPECT_EQ(bench.pull({Text("cell"), 0, 2})->problem(), "it refuses: Bad_SecurityChecksFailed");
}

TEST(CallClient, CertificatesEnd) {
  KeyBench bench;
  Now late = at(0);
  late.utc.ticks += std::int64_t{200'000'000} * 10'000'000;
  const CallClient client(bench.settings, test::other_identity(), bench.trusted, bench.random,
                          call_of({Text("cell"), 0, 2}), late);
  EXPECT_EQ(client.problem(), "its certificate is not valid now");
  EXPECT_TRUE(client.output().empty());
}

TEST(CallClient, WaitsSoLongAndNoLonger) {
  KeyBench bench;
  const auto client = bench.client(call_of({Text("cell"), 0, 0}));
  client->advance(at(9'999));
  EXPECT_FALSE(client->is_over());
  client->advance(at(10'000));
  EXPECT_EQ(client->problem(), "no answer within 10000 ms");
}

TEST(CallClient, AnEndInTheMiddle) {
  KeyBench bench;
  const auto client = bench.client(call_of({Text("cell"), 0, 0}));
  client->ended();
  EXPECT_EQ(client->problem(), "it closed the connection behind Hello");
}

// Each octet of each answer, changed: there is a problem, or all went well where the octet says nothing; never a key
// that the service has not given.
TEST(CallClient, AnswersThatWereTouched) {
  KeyBench sound;
  std::size_t octets = 0;
  sound.touch = [&](std::byte&) { ++octets; };
  sound.pull({Text("cell"), 0, 2});
  std::size_t problems = 0;
  for (std::size_t which = 0; which < octets; which += 1 + which / 40) {
    KeyBench bench;
    std::size_t seen = 0;
    bench.touch = [&](std::byte& octet) {
      if (seen++ == which) octet ^= std::byte{0x11};
    };
    const auto client = bench.pull({Text("cell"), 0, 2});
    if (!client->is_over()) client->ended();
    problems += client->problem().empty() ? 0 : 1;
    if (client->problem().empty()) {
      EXPECT_EQ(keys_in(client->result())->keys.at(0), bench.service.key(7)) << which;
    }
  }
  EXPECT_GT(problems, 100u);
}

TEST(CallClient, NoMessagesAtAll) {
  for (const std::string& said :
       {std::string("HTTP/1.1 400 Bad Request\r\n\r\n"), std::string("MSGF\x40\0\0\0\0\0\0\0", 12),
        std::string("ACKF\xFF\xFF\xFF\xFF", 8), std::string("ACKF\x08\0\0\0", 8), std::string("ERRF\x08\0\0\0", 8)}) {
    KeyBench bench;
    const auto client = bench.client(call_of({Text("cell"), 0, 0}));
    client->received(std::as_bytes(std::span(said)), at(0));
    client->ended();
    EXPECT_TRUE(client->is_over());
    EXPECT_NE(client->problem(), "");
  }
}

TEST(SecurityKeys, OutputsThatAreNone) {
  KeyBench bench;
  const CallMethodResult sound = bench.pull({Text("cell"), 0, 2})->result();
  ASSERT_TRUE(keys_in(sound));
  for (std::size_t i = 0; i < 5; ++i) {
    CallMethodResult result = sound;
    result.output_arguments[i] = Variant();
    EXPECT_FALSE(keys_in(result)) << i;
    result.output_arguments.erase(result.output_arguments.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_FALSE(keys_in(result)) << i;
  }
}

}  // namespace
}  // namespace takt::opcua
