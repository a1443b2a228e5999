// SPDX-License-Identifier: Apache-2.0
// A whole server: connections, sessions, services, subscriptions; by octets that come at given times.
#include <gtest/gtest.h>

#include "support/opcua_bench.hpp"
#include "transcript.hpp"

namespace takt::opcua {
namespace {

using handshake::PublishedState;
using test::at;
using test::Bench;
using test::PlainClient;

struct Session : testing::Test {
  Bench bench{test::settings_with_users()};
  PlainClient client{bench};
  void SetUp() override {
    client.open();
    client.begin_session();
  }
  ReadValueId value(const NodeId& node, AttributeId attribute = AttributeId::Value) {
    ReadValueId what;
    what.node_id = node;
    what.attribute_id = static_cast<std::uint32_t>(attribute);
    return what;
  }
  DataValue read(const NodeId& node, AttributeId attribute = AttributeId::Value) {
    ReadRequest request;
    request.nodes_to_read.push_back(value(node, attribute));
    const auto response = client.ask<ReadResponse>(request);
    return response.results.empty() ? DataValue() : response.results[0];
  }
  ProgramNews transition(std::uint8_t number, PublishedState from, PublishedState to, std::int64_t ms) {
    ProgramNews news;
    news.kind = ProgramNews::Kind::transition;
    news.change = {number, from, to};
    news.time = at(ms).utc;
    return news;
  }
  std::uint32_t subscribe(double interval_ms = 100, std::uint32_t keep_alive = 3, std::uint32_t lifetime = 9) {
    CreateSubscriptionRequest request;
    request.requested_publishing_interval = interval_ms;
    request.requested_max_keep_alive_count = keep_alive;
    request.requested_lifetime_count = lifetime;
    request.publishing_enabled = true;
    return client.ask<CreateSubscriptionResponse>(request).subscription_id;
  }
  MonitoredItemCreateResult monitor(std::uint32_t subscription, const NodeId& node, std::uint32_t queue = 10) {
    CreateMonitoredItemsRequest request;
    request.subscription_id = subscription;
    MonitoredItemCreateRequest item;
    item.item_to_monitor = value(node);
    item.monitoring_mode = MonitoringMode::Reporting;
    item.requested_parameters.client_handle = 7;
    item.requested_parameters.queue_size = queue;
    item.requested_parameters.discard_oldest = true;
    request.items_to_create.push_back(item);
    return client.ask<CreateMonitoredItemsResponse>(request).results.at(0);
  }
  /// The texts of the values of all data changes that have come.
  std::vector<std::string> texts(const std::vector<PlainClient::Received>& all) {
    std::vector<std::string> found;
    for (const auto& each : all)
      for (const ExtensionObject& data : each.as<PublishResponse>().notification_message.notification_data)
        if (const auto change = structure_in<DataChangeNotification>(data))
          for (const auto& item : change->monitored_items)
            found.push_back(item.value.value->get<LocalizedText>()->text.value);
    return found;
  }
};

const NodeId current_state(1, "cell.CurrentState");

TEST_F(Session, ReadsWhatTheProgramSays) {
  EXPECT_EQ(*read(current_state).value->get<LocalizedText>(), LocalizedText("Halted"));
  EXPECT_EQ(*read(NodeId(1, "cell.CurrentState.Id")).value->get<NodeId>(), NodeId(2406));
  bench.server.news(transition(1, PublishedState::HaltedInit, PublishedState::Ready, 5), at(5));
  EXPECT_EQ(*read(NodeId(1, "cell.CurrentState.Number")).value->get<std::uint32_t>(), 12u);
  EXPECT_EQ(*read(NodeId(1, "cell.LastTransition.Number")).value->get<std::uint32_t>(), 1u);
  EXPECT_EQ(*read(NodeId(1, "cell.LastTransition.TransitionTime")).value->get<DateTime>(), at(5).utc);
  EXPECT_EQ(read(current_state).source_time, at(5).utc);
  EXPECT_EQ(read(NodeId(1, "nothing")).result(), StatusCode::BadNodeIdUnknown);
  EXPECT_EQ(read(current_state, AttributeId::Executable).result(), StatusCode::BadAttributeIdInvalid);
}

TEST_F(Session, CallsAreAnsweredWhenTheProgramHas) {
  ASSERT_EQ(client.sign_in("anna", "secret"), StatusCode::Good);
  CallRequest request;
  for (const NodeId& method : {NodeId(1, "cell.Start"), NodeId(2429)})
    request.methods_to_call.push_back({NodeId(1, "cell"), method, {}});
  request.methods_to_call.push_back({NodeId(1, "cell"), NodeId(1, "cell.CurrentState"), {}});
  request.methods_to_call.push_back({NodeId(1, "none"), NodeId(2429), {}});
  List<Variant> arguments;
  arguments.push_back(Variant(true));
  request.methods_to_call.push_back({NodeId(1, "cell"), NodeId(2429), arguments});
  client.send_request(request);
  EXPECT_TRUE(client.take().empty());
  ASSERT_EQ(bench.host.calls.size(), 2u);
  EXPECT_EQ(bench.host.calls[0].method, program::Method::Start);
  EXPECT_EQ(bench.host.calls[1].method, program::Method::Halt);
  bench.server.answered(bench.host.calls[1].serial, StatusCode::Good, at(1));
  EXPECT_TRUE(client.take().empty());
  bench.server.answered(bench.host.calls[0].serial, StatusCode::BadInvalidState, at(1));
  const auto all = client.take();
  ASSERT_EQ(all.size(), 1u);
  std::vector<StatusCode> results;
  for (const auto& each : all[0].as<CallResponse>().results) results.push_back(each.status_code);
  EXPECT_EQ(results, (std::vector{StatusCode::BadInvalidState, StatusCode::Good, StatusCode::BadMethodInvalid,
                                  StatusCode::BadNodeIdUnknown, StatusCode::BadTooManyArguments}));
}

TEST_F(Session, ACallThatNobodyAnswersTimesOut) {
  ASSERT_EQ(client.sign_in("anna", "secret"), StatusCode::Good);
  CallRequest request;
  request.methods_to_call.push_back({NodeId(1, "cell"), NodeId(2426), {}});
  client.send_request(request);
  bench.server.advance(at(4999));
  EXPECT_TRUE(client.take().empty());
  bench.server.advance(at(5000));
  EXPECT_EQ(client.take().at(0).as<CallResponse>().results.at(0).status_code, StatusCode::BadTimeout);
  bench.server.answered(bench.host.calls[0].serial, StatusCode::Good, at(5001));  // too late, and no harm
  EXPECT_TRUE(client.take().empty());
}

TEST_F(Session, WhoMayCall) {
  CallRequest request;
  request.methods_to_call.push_back({NodeId(1, "cell"), NodeId(2429), {}});
  const auto result = [&] { return client.ask<CallResponse>(request).results.at(0).status_code; };
  EXPECT_EQ(result(), StatusCode::BadUserAccessDenied);  // without a name
  ASSERT_EQ(client.sign_in("olaf", "secret"), StatusCode::Good);
  EXPECT_EQ(result(), StatusCode::BadUserAccessDenied);  // an observer
  EXPECT_TRUE(bench.host.calls.empty());
  ASSERT_EQ(client.sign_in("anna", "secret"), StatusCode::Good);
  client.send_request(request);
  EXPECT_EQ(bench.host.calls.size(), 1u);
}

TEST(Server, WithoutEncryptionNothingIsMovedUnlessTheSettingsSaySo) {
  for (const bool halt : {false, true}) {
    ServerSettings settings = test::settings_with_users();
    settings.calls_without_encryption = false;
    settings.halt_without_encryption = halt;
    Bench bench(settings);
    PlainClient client(bench);
    client.open();
    ASSERT_EQ(client.sign_in("anna", "secret"), StatusCode::Good);
    CallRequest request;
    for (const std::uint32_t method : {2426U, 2429U})
      request.methods_to_call.push_back({NodeId(1, "cell"), NodeId(method), {}});
    client.send_request(request);
    ASSERT_EQ(bench.host.calls.size(), halt ? 1u : 0u);
    if (halt) {
      EXPECT_EQ(bench.host.calls[0].method, program::Method::Halt);
    }
  }
}

// Five tries; then even the right password waits, from one second on (OPC 10000-4, 5.6.3).
TEST_F(Session, WrongPasswordsMakeTheirHostWait) {
  for (int i = 0; i < 5; ++i) EXPECT_EQ(client.sign_in("anna", "wrong"), StatusCode::BadUserAccessDenied);
  EXPECT_EQ(client.sign_in("anna", "secret"), StatusCode::BadUserAccessDenied);
  EXPECT_EQ(client.sign_in("anna", "secret", 999), StatusCode::BadUserAccessDenied);
  EXPECT_EQ(client.sign_in("anna", "secret", 100'000), StatusCode::Good);
}

// No transition is sampled away: Running for no time at all is told.
TEST_F(Session, EveryChangeIsPublishedInOrder) {
  const auto id = subscribe();
  EXPECT_EQ(monitor(id, current_state).status_code, StatusCode::Good);
  for (int i = 0; i < 3; ++i) client.send_request(PublishRequest());
  bench.server.news(transition(1, PublishedState::HaltedInit, PublishedState::Ready, 10), at(10));
  bench.server.news(transition(2, PublishedState::Ready, PublishedState::Running, 11), at(11));
  bench.server.news(transition(3, PublishedState::Running, PublishedState::Halted, 11), at(11));
  EXPECT_TRUE(client.take().empty());
  bench.server.advance(at(100));
  EXPECT_EQ(texts(client.take()), (std::vector<std::string>{"Halted", "Ready", "Running", "Halted"}));
}

TEST_F(Session, AQueueThatRunsOverSaysSo) {
  const auto id = subscribe();
  EXPECT_EQ(monitor(id, current_state, 2).revised_queue_size, 2u);
  client.send_request(PublishRequest());
  bench.server.news(transition(1, PublishedState::HaltedInit, PublishedState::Ready, 10), at(10));
  bench.server.news(transition(2, PublishedState::Ready, PublishedState::Running, 11), at(11));
  bench.server.advance(at(100));
  const auto all = client.take();
  const auto change = structure_in<DataChangeNotification>(
      all.at(0).as<PublishResponse>().notification_message.notification_data.at(0));
  ASSERT_EQ(change->monitored_items.size(), 2u);
  EXPECT_EQ(change->monitored_items[0].value.result(), StatusCode::GoodOverflow);
  EXPECT_EQ(change->monitored_items[1].value.result(), StatusCode::Good);
}

// The first expiry, then keep-alives each third one, and the end after nine without a request (OPC 10000-4, 5.14.1).
TEST_F(Session, KeepAliveAndLifetime) {
  subscribe();
  for (int i = 0; i < 2; ++i) client.send_request(PublishRequest());
  bench.server.advance(at(100));
  auto all = client.take();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].as<PublishResponse>().notification_message.sequence_number, 1u);
  EXPECT_TRUE(all[0].as<PublishResponse>().notification_message.notification_data.empty());
  for (const int ms : {200, 300}) bench.server.advance(at(ms));
  EXPECT_TRUE(client.take().empty());
  bench.server.advance(at(400));
  all = client.take();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].as<PublishResponse>().notification_message.sequence_number,
            1u);  // of the next one, which it does not use
  for (int ms = 500; ms <= 1200; ms += 100) bench.server.advance(at(ms));
  EXPECT_EQ(client.result_of(SetPublishingModeRequest{{}, true, {}}), StatusCode::BadNothingToDo);
  client.send_request(PublishRequest());  // eight expiries without one: it lives
  EXPECT_NE(client.take().at(0).result, StatusCode::BadNoSubscription);
  for (int ms = 1300; ms <= 2100; ms += 100) bench.server.advance(at(ms));
  client.take();
  EXPECT_EQ(client.result_of(PublishRequest()), StatusCode::BadNoSubscription);
}

TEST_F(Session, RepublishUntilAcknowledged) {
  const auto id = subscribe();
  monitor(id, current_state);
  client.send_request(PublishRequest());
  bench.server.advance(at(100));
  const auto first = client.take().at(0).as<PublishResponse>();
  EXPECT_EQ(first.notification_message.sequence_number, 1u);
  EXPECT_EQ(first.available_sequence_numbers, (std::vector<std::uint32_t>{1}));
  RepublishRequest again;
  again.subscription_id = id;
  again.retransmit_sequence_number = 1;
  EXPECT_EQ(client.ask<RepublishResponse>(again).notification_message.notification_data.size(), 1u);
  PublishRequest acknowledging;
  acknowledging.subscription_acknowledgements.push_back({id, 1});
  acknowledging.subscription_acknowledgements.push_back({id, 2});
  acknowledging.subscription_acknowledgements.push_back({id + 1, 1});
  client.send_request(acknowledging);
  bench.server.news(transition(1, PublishedState::HaltedInit, PublishedState::Ready, 150), at(150));
  bench.server.advance(at(200));
  const auto second = client.take().at(0).as<PublishResponse>();
  EXPECT_EQ(
      std::vector<StatusCode>(second.results),
      (std::vector{StatusCode::Good, StatusCode::BadSequenceNumberUnknown, StatusCode::BadSubscriptionIdInvalid}));
  EXPECT_EQ(client.result_of(again), StatusCode::BadMessageNotAvailable);
}

TEST_F(Session, SubscriptionsOutliveTheirSessionAndAreTakenOver) {
  const auto id = subscribe();
  monitor(id, current_state);
  CloseSessionRequest close;
  close.delete_subscriptions = false;
  client.ask<CloseSessionResponse>(close);
  client.begin_session();
  TransferSubscriptionsRequest transfer;
  transfer.subscription_ids.push_back(id);
  transfer.subscription_ids.push_back(id + 1);
  transfer.send_initial_values = true;
  const auto response = client.ask<TransferSubscriptionsResponse>(transfer);
  EXPECT_EQ(response.results.at(0).status_code, StatusCode::Good);
  EXPECT_EQ(response.results.at(1).status_code, StatusCode::BadSubscriptionIdInvalid);
  client.send_request(PublishRequest());
  bench.server.advance(at(100));
  EXPECT_EQ(texts(client.take()), (std::vector<std::string>{"Halted"}));
}

TEST_F(Session, EventsAreSelectedAndFiltered) {
  const auto id = subscribe();
  CreateMonitoredItemsRequest request;
  request.subscription_id = id;
  MonitoredItemCreateRequest item;
  item.item_to_monitor = value(NodeId(ids::server), AttributeId::EventNotifier);
  item.monitoring_mode = MonitoringMode::Reporting;
  EventFilter filter;
  for (const std::vector<std::string>& path :
       {std::vector<std::string>{"Transition", "Number"}, {"Message"}, {"Unknown"}}) {
    SimpleAttributeOperand clause;
    clause.type_definition_id = NodeId(ids::base_event_type);
    clause.attribute_id = 13;
    for (const std::string& name : path) clause.browse_path.push_back({0, Text(name)});
    filter.select_clauses.push_back(clause);
  }
  LiteralOperand type;
  type.value = Variant(NodeId(ids::program_transition_event_type));
  ContentFilterElement of_type;
  of_type.filter_operator = FilterOperator::OfType;
  of_type.filter_operands.push_back(extension_of(type));
  filter.where_clause.elements.push_back(of_type);
  item.requested_parameters.filter = extension_of(filter);
  request.items_to_create.push_back(item);
  const auto created = client.ask<CreateMonitoredItemsResponse>(request).results.at(0);
  ASSERT_EQ(created.status_code, StatusCode::Good);
  const auto told = structure_in<EventFilterResult>(created.filter_result);
  ASSERT_TRUE(told);
  EXPECT_EQ(std::vector<StatusCode>(told->select_clause_results),
            (std::vector{StatusCode::Good, StatusCode::Good, StatusCode::BadNodeIdUnknown}));
  client.send_request(PublishRequest());
  bench.server.news(transition(2, PublishedState::Ready, PublishedState::Running, 10), at(10));
  bench.server.advance(at(100));
  const auto events = structure_in<EventNotificationList>(
      client.take().at(0).as<PublishResponse>().notification_message.notification_data.at(0));
  ASSERT_TRUE(events);
  ASSERT_EQ(events->events.size(), 1u);  // not the audit event: the channel is not encrypted, and it is of another type
  EXPECT_EQ(events->events[0].event_fields[0], Variant(std::uint32_t{2}));
  EXPECT_EQ(events->events[0].event_fields[1], Variant(LocalizedText("cell: Ready to Running")));
  EXPECT_TRUE(events->events[0].event_fields[2].is_null());
}

TEST_F(Session, LimitsAreKept) {
  CreateSubscriptionRequest request;
  std::size_t made = 0;
  while (client.ask<CreateSubscriptionResponse>(request).subscription_id != 0) ++made;
  EXPECT_EQ(made, 20u);
  EXPECT_EQ(client.result_of(request), StatusCode::BadTooManySubscriptions);
  ReadRequest many;
  many.nodes_to_read.resize(1001);
  EXPECT_EQ(client.result_of(many), StatusCode::BadTooManyOperations);
  EXPECT_EQ(client.result_of(ReadRequest()), StatusCode::BadNothingToDo);
  for (int i = 0; i < 40; ++i) client.send_request(PublishRequest());
  EXPECT_TRUE(client.take().empty());
  EXPECT_EQ(client.result_of(PublishRequest()), StatusCode::BadTooManyPublishRequests);
}

TEST_F(Session, ATokenIsGoodOnItsChannelOnly) {
  PlainClient other(bench);
  other.open();
  other.token = client.token;
  EXPECT_EQ(other.result_of(ReadRequest()), StatusCode::BadSecureChannelIdInvalid);
  other.token = NodeId(1, 5u);
  EXPECT_EQ(other.result_of(ReadRequest()), StatusCode::BadSessionIdInvalid);
  EXPECT_EQ(client.result_of(ReadRequest()), StatusCode::BadNothingToDo);  // it is still good there
}

TEST(Server, SessionsAreBoundedAndThoseNeverActivatedGoFirst) {
  ServerSettings settings = test::test_settings();
  settings.limits.sessions = 2;
  Bench bench(settings);
  PlainClient client(bench);
  client.open();
  client.begin_session();
  const NodeId first = client.token;
  client.token = NodeId();
  const auto idle = client.ask<CreateSessionResponse>(CreateSessionRequest()).authentication_token;
  EXPECT_FALSE(idle.is_null());
  client.begin_session();  // instead of the idle one
  EXPECT_EQ(bench.server.services().sessions(), 2u);
  client.token = first;
  EXPECT_EQ(client.result_of(ReadRequest()), StatusCode::BadNothingToDo);
  client.token = NodeId();
  EXPECT_EQ(client.result_of(CreateSessionRequest()), StatusCode::BadTooManySessions);
}

TEST(Server, ThoseWhoDoNotComeFurtherGo) {
  Bench bench;
  PlainClient silent(bench);
  PlainClient without_session(bench);
  without_session.open();
  bench.server.advance(at(9'999));
  EXPECT_FALSE(bench.server.is_closing(silent.id()));
  bench.server.advance(at(10'000));
  EXPECT_TRUE(bench.server.is_closing(silent.id()));
  EXPECT_FALSE(bench.server.is_closing(without_session.id()));
  bench.server.advance(at(60'000));
  EXPECT_TRUE(bench.server.is_closing(without_session.id()));
  bench.server.disconnected(silent.id());
}

TEST(Server, ClientsThatDoNotReadAreNotWaitedFor) {
  ServerSettings settings = test::test_settings();
  settings.limits.output_octets = 100'000;
  Bench bench(settings);
  PlainClient client(bench);
  client.open();
  client.begin_session();
  BrowseRequest request;
  for (int i = 0; i < 100; ++i) {
    BrowseDescription what;
    what.node_id = NodeId(ids::program_state_machine_type);
    what.result_mask = 63;
    request.nodes_to_browse.push_back(what);
  }
  for (int i = 0; i < 10; ++i) client.send_request(request);
  EXPECT_TRUE(bench.server.is_closing(client.id()));
  EXPECT_LT(bench.server.output(client.id()).size(), 100'000u);
}

// It says that it takes messages of one octet: whatever is said to it is too long, and it goes, in the middle of
// whatever waits for it.
TEST(Server, AClientThatTakesNothingGoes) {
  Bench bench;
  PlainClient client(bench);
  client.open(0, 3'600'000, 1);
  client.send_request(GetEndpointsRequest());
  EXPECT_TRUE(bench.server.is_closing(client.id()));
  bench.server.advance(at(1));
  EXPECT_EQ(bench.server.next_time(), sim::LocalTime::never());  // nothing is waited for any more
  bench.server.disconnected(client.id());
}

// The client's side of a recorded conversation with another server: the same services succeed here. Ids in answers are
// ours, so those that the client repeats are replaced.
TEST(Server, ARecordedClientIsServed) {
  Bench bench;
  const ConnectionId id = bench.server.connected("192.0.2.1:1000", at(0));
  std::vector<std::byte> channel;
  std::vector<std::byte> token;
  std::map<std::uint32_t, std::string> asked;
  std::map<std::string, std::size_t> answered;
  for (auto message : test::transcript("none")) {
    if (!message.from_client) continue;
    if (message.type == "MSG" || message.type == "CLO")
      std::copy(channel.begin(), channel.end(), message.octets.begin() + 8);
    // The session's token is 16 octets there and 32 here: requests of a session are written anew with it.
    if (message.type == "MSG") {
      Decoder decoder(Octets(message.octets).subspan(symmetric_header_octets + sequence_header_octets));
      NodeId type;
      decode(decoder, type);
      const std::size_t token_at = symmetric_header_octets + sequence_header_octets + decoder.position();
      NodeId former;
      decode(decoder, former);
      if (!former.is_null()) {
        std::vector<std::byte> changed(message.octets.begin(),
                                       message.octets.begin() + static_cast<std::ptrdiff_t>(token_at));
        changed.insert(changed.end(), token.begin(), token.end());
        changed.insert(
            changed.end(),
            message.octets.begin() +
                static_cast<std::ptrdiff_t>(symmetric_header_octets + sequence_header_octets + decoder.position()),
            message.octets.end());
        uadp::store_little_endian(changed.data() + 4, static_cast<std::uint32_t>(changed.size()));
        message.octets = changed;
      }
      asked[uadp::load_little_endian<std::uint32_t>(message.octets.data() + symmetric_header_octets + 4)] =
          message.encoding_id;
    }
    bench.server.received(id, message.octets, at(message.number));
    for (const auto& call : std::exchange(bench.host.calls, {}))
      bench.server.answered(call.serial, StatusCode::Good, at(message.number));
    const Octets output = bench.server.output(id);
    MessageSplitter splitter(1 << 20);
    splitter.feed(output);
    while (const auto answer = splitter.next()) {
      const auto header = decode_message_header(*answer);
      ASSERT_NE(header->type, MessageType::Error) << message.number;
      if (header->type == MessageType::OpenChannel) channel.assign(answer->begin() + 8, answer->begin() + 12);
      if (header->type != MessageType::Message) continue;
      const auto request = uadp::load_little_endian<std::uint32_t>(answer->data() + symmetric_header_octets + 4);
      Decoder decoder(answer->subspan(symmetric_header_octets + sequence_header_octets));
      NodeId type;
      ResponseHeader response;
      decode(decoder, type);
      decode(decoder, response);
      if (type == NodeId(CreateSessionResponse::encoding_id)) {
        NodeId session;
        NodeId session_token;
        decode(decoder, session);
        decode(decoder, session_token);
        Encoder encoder;
        encode(encoder, session_token);
        token = encoder.take();
      }
      if (is_good(response.service_result)) ++answered[asked[request]];
    }
    bench.server.sent(id, output.size(), at(message.number));
  }
  for (const char* const type :
       {"i=428", "i=461", "i=467", "i=554", "i=527", "i=631", "i=787", "i=712", "i=673", "i=473"})
    EXPECT_GT(answered[type], 0u) << type;
  EXPECT_TRUE(bench.server.is_closing(id));  // CLO
  EXPECT_EQ(bench.log.refusals, 0u) << bench.log.last;
}

}  // namespace
}  // namespace takt::opcua
