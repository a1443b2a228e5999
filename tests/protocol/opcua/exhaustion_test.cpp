// SPDX-License-Identifier: Apache-2.0
// Who uses up what: each attack on the server as octets that come at given times, and what the others get meanwhile.
#include <gtest/gtest.h>

#include "support/opcua_bench.hpp"

namespace takt::opcua {
namespace {

using handshake::PublishedState;
using test::at;
using test::Bench;
using test::PlainClient;

struct Exhaustion : testing::Test {
  Bench bench{test::settings_with_users()};

  static ProgramNews running(std::int64_t ms) {
    ProgramNews news;
    news.kind = ProgramNews::Kind::transition;
    news.change = {2, PublishedState::Ready, PublishedState::Running};
    news.time = at(ms).utc;
    return news;
  }
  static std::uint32_t subscribe(PlainClient& client, double interval_ms = 1000, std::uint32_t lifetime = 10'000'000,
                                 std::uint32_t keep_alive = 1'000'000) {
    CreateSubscriptionRequest request;
    request.requested_publishing_interval = interval_ms;
    request.requested_lifetime_count = lifetime;
    request.requested_max_keep_alive_count = keep_alive;
    request.publishing_enabled = true;
    return client.ask<CreateSubscriptionResponse>(request).subscription_id;
  }
  static SimpleAttributeOperand message_clause() {
    SimpleAttributeOperand clause;
    clause.type_definition_id = NodeId(2041);
    clause.attribute_id = 13;
    clause.browse_path.push_back({0, Text("Message")});
    return clause;
  }
  static EventFilter selecting(std::size_t clauses) {
    EventFilter filter;
    for (std::size_t i = 0; i < clauses; ++i) filter.select_clauses.push_back(message_clause());
    return filter;
  }
  /// Two lists of literals, of which the first holds the second.
  static EventFilter comparing(std::size_t literals) {
    EventFilter filter = selecting(1);
    for (int i = 0; i < 2; ++i) {
      ContentFilterElement element;
      element.filter_operator = FilterOperator::InList;
      element.filter_operands.push_back(i == 0 ? extension_of(ElementOperand{1})
                                               : extension_of(LiteralOperand{Variant(Text("x"))}));
      for (std::size_t j = 0; j < literals; ++j) element.filter_operands.push_back(extension_of(LiteralOperand()));
      filter.where_clause.elements.push_back(element);
    }
    return filter;
  }
  static StatusCode monitor_events(PlainClient& client, std::uint32_t subscription, const EventFilter& filter,
                                   std::uint32_t queue = 100'000) {
    CreateMonitoredItemsRequest request;
    request.subscription_id = subscription;
    MonitoredItemCreateRequest item;
    item.item_to_monitor = {NodeId(ids::server), static_cast<std::uint32_t>(AttributeId::EventNotifier), {}, {}};
    item.monitoring_mode = MonitoringMode::Reporting;
    item.requested_parameters.queue_size = queue;
    item.requested_parameters.discard_oldest = true;
    item.requested_parameters.filter = extension_of(filter);
    request.items_to_create.push_back(item);
    const auto response = client.ask<CreateMonitoredItemsResponse>(request);
    return response.results.empty() ? StatusCode::BadUnexpectedError : response.results[0].status_code;
  }
  static void close(PlainClient& client, bool with_subscriptions) {
    CloseSessionRequest request;
    request.delete_subscriptions = with_subscriptions;
    client.ask<CloseSessionResponse>(request);
  }
  /// Without a name; the result of the activation.
  static StatusCode begin(PlainClient& client, std::int64_t ms) {
    client.token = NodeId();
    client.token = client.ask<CreateSessionResponse>(CreateSessionRequest(), ms).authentication_token;
    return client.token.is_null() ? StatusCode::BadTooManySessions : client.result_of(ActivateSessionRequest(), ms);
  }
  static CallRequest call(std::uint32_t method, std::size_t times = 1) {
    CallRequest request;
    for (std::size_t i = 0; i < times; ++i) request.methods_to_call.push_back({NodeId(1, "cell"), NodeId(method), {}});
    return request;
  }
  /// Long, and nothing comes of it: there is no such type of references.
  static BrowseRequest browse_of_nothing() {
    BrowseRequest request;
    for (int i = 0; i < 1000; ++i) {
      BrowseDescription what;
      what.node_id = NodeId(58);
      what.reference_type_id = NodeId(47);
      what.node_class_mask = 128;
      request.nodes_to_browse.push_back(what);
    }
    return request;
  }
  /// Steps of one turn: what a call that comes now has to wait for at most.
  std::uint64_t steps_of_turn(std::int64_t ms) {
    const std::uint64_t before = bench.server.services().steps();
    bench.server.advance(at(ms));
    return bench.server.services().steps() - before;
  }
};

constexpr std::uint32_t start = 2426, halt = 2429;

// An event to a filter costs what the filter is long: no element twice, whatever points to it.
TEST_F(Exhaustion, WorkOfAFilterIsBoundedByItsSize) {
  const DecodedFilter filter(comparing(999));
  EXPECT_EQ(filter.steps(), 1u + 2 * 1000);
  Event event;
  event.fields["Message"] = Variant(LocalizedText("m"));
  EXPECT_FALSE(filter.lets_pass(EventRecord(event, 1), bench.server.services().space()));
}

// A pyramid of And: evaluated as a tree it has 2^30 leaves.
TEST_F(Exhaustion, ElementsThatShareOthersAreAskedOnce) {
  EventFilter filter = selecting(1);
  for (std::uint32_t i = 1; i < 32; ++i) {
    ContentFilterElement element;
    element.filter_operator = FilterOperator::And;
    for (int j = 0; j < 2; ++j) element.filter_operands.push_back(extension_of(ElementOperand{i}));
    filter.where_clause.elements.push_back(element);
  }
  ContentFilterElement last;
  last.filter_operator = FilterOperator::IsNull;
  last.filter_operands.push_back(extension_of(LiteralOperand()));
  filter.where_clause.elements.push_back(last);
  ASSERT_TRUE(check_filter(filter, bench.server.services().space(), Limits()).is_usable);
  EXPECT_TRUE(DecodedFilter(filter).lets_pass(EventRecord(Event(), 1), bench.server.services().space()));
}

// Filters of 20 kB, as many as there is room for, and then transitions: each turn is short, and a Halt goes out before
// what is left of them.
TEST_F(Exhaustion, AHaltDoesNotWaitForEvents) {
  PlainClient observer(bench);
  observer.open();
  observer.begin_session();
  const auto subscription = subscribe(observer);
  std::size_t made = 0;
  for (int i = 0; i < 100; ++i) made += is_good(monitor_events(observer, subscription, comparing(999))) ? 1U : 0U;
  EXPECT_GT(made, 5u);
  EXPECT_LT(made, 100u);  // then they have as much memory as a session may
  PlainClient anna(bench);
  anna.open();
  ASSERT_EQ(anna.sign_in("anna", "secret"), StatusCode::Good);
  for (int i = 0; i < 100; ++i) bench.server.news(running(1), at(1));
  EXPECT_LT(steps_of_turn(1), 60'000u);
  EXPECT_EQ(bench.server.next_time(), at(1).local);  // more is to be done
  anna.send_request(call(halt), 1);
  ASSERT_EQ(bench.host.calls.size(), 1u);
  EXPECT_EQ(bench.host.calls[0].method, program::Method::Halt);
}

// Whatever else has come in the turn, and in the order in which the calls came: a Start before a Halt does not follow
// it.
TEST_F(Exhaustion, CallsComeBeforeRequestsInTheirOrder) {
  PlainClient anna(bench);
  anna.open();
  ASSERT_EQ(anna.sign_in("anna", "secret"), StatusCode::Good);
  PlainClient emil(bench);
  emil.open();
  ASSERT_EQ(emil.sign_in("anna", "secret"), StatusCode::Good);
  PlainClient flood(bench);
  flood.open();
  flood.begin_session();
  // All of it has come before the turn.
  for (int i = 0; i < 40; ++i) flood.send_later(browse_of_nothing(), 1);
  anna.send_later(call(start), 1);
  emil.send_later(call(halt), 1);
  anna.send_later(call(start), 1);
  anna.send_later(call(halt), 1);
  bench.server.serve_calls(at(1));
  std::vector<program::Method> methods;
  for (const auto& each : bench.host.calls) methods.push_back(each.method);
  EXPECT_EQ(methods, (std::vector{program::Method::Start, program::Method::Halt, program::Method::Start,
                                  program::Method::Halt}));
  EXPECT_TRUE(flood.take().empty());
}

// Each of them costs little; together they are more than a turn, so the other's come between them.
TEST_F(Exhaustion, WhoFloodsWithRequestsWaitsForHimself) {
  PlainClient flood(bench);
  flood.open();
  flood.begin_session();
  PlainClient anna(bench);
  anna.open();
  ASSERT_EQ(anna.sign_in("anna", "secret"), StatusCode::Good);
  for (int i = 0; i < 40; ++i) flood.send_later(browse_of_nothing(), 1);
  ReadRequest read;
  read.nodes_to_read.push_back({NodeId(2259), 13, {}, {}});
  anna.send_later(read, 1);
  bench.server.advance(at(1));
  EXPECT_EQ(anna.take().size(), 1u);
}

// An observer's calls are refused, each with an event; they are no way around the budgets, and leave no trace in the
// diagnostic of the Program.
TEST_F(Exhaustion, RefusedCallsAreCheap) {
  PlainClient observer(bench);
  observer.open();
  observer.begin_session();
  const auto subscription = subscribe(observer);
  for (int i = 0; i < 20; ++i) monitor_events(observer, subscription, comparing(999));
  for (int i = 0; i < 20; ++i) observer.send_request(call(halt, 1000), 1);
  EXPECT_TRUE(bench.host.calls.empty());
  EXPECT_LT(steps_of_turn(2), 160'000u);
  PlainClient anna(bench);
  anna.open();
  ASSERT_EQ(anna.sign_in("anna", "secret"), StatusCode::Good);
  anna.send_request(call(halt), 2);
  ASSERT_EQ(bench.host.calls.size(), 1u);
}

TEST_F(Exhaustion, FiltersQueuesAndMessagesAreCounted) {
  PlainClient observer(bench);
  observer.open();
  observer.begin_session();
  std::size_t refused = 0;
  for (int i = 0; i < 20; ++i) {
    const auto subscription = subscribe(observer, 10);
    for (int j = 0; j < 20; ++j)
      refused +=
          monitor_events(observer, subscription, selecting(900)) == StatusCode::BadTooManyMonitoredItems ? 1U : 0U;
  }
  EXPECT_GT(refused, 0u);
  const std::size_t filters = bench.server.services().octets();
  for (int i = 1; i < 2000; ++i) {
    bench.server.news(running(i * 10), at(i * 10));
    for (int turns = 0; turns < 100 && bench.server.next_time() <= at(i * 10).local; ++turns)
      bench.server.advance(at(i * 10));
    if (i % 100 == 0) observer.send_request(PublishRequest(), i * 10);
    observer.take();
  }
  EXPECT_GE(bench.server.services().octets(), filters);
  EXPECT_LE(bench.server.services().octets(), Limits().session_octets);
}

TEST_F(Exhaustion, ManySelectClausesAreNoFilter) {
  PlainClient observer(bench);
  observer.open();
  observer.begin_session();
  EXPECT_EQ(monitor_events(observer, subscribe(observer), selecting(2200)), StatusCode::BadEventFilterInvalid);
}

// All that was held is given back with the session.
TEST_F(Exhaustion, WhatWasCountedIsGivenBack) {
  {
    PlainClient client(bench);
    client.open();
    client.begin_session();
    monitor_events(client, subscribe(client), comparing(100));
    EXPECT_GT(bench.server.services().octets(), 0u);
    close(client, true);
  }
  EXPECT_EQ(bench.server.services().octets(), 0u);
}

TEST_F(Exhaustion, SessionsThatWereLeftGoForThoseWhoCome) {
  for (int i = 0; i < 50; ++i) {
    PlainClient left(bench);
    left.open();
    left.begin_session();
    bench.server.disconnected(left.id());
  }
  PlainClient other(bench);
  other.open();
  EXPECT_EQ(begin(other, 0),
            StatusCode::BadTooManySessions);  // they may come back, and one host has no more places than it has
  PlainClient anna(bench);
  anna.open();
  EXPECT_EQ(anna.sign_in("anna", "secret"), StatusCode::Good);  // users come before those without a name
  bench.server.advance(at(10'000));
  PlainClient later(bench, 10'000);
  later.open(10'000);
  EXPECT_EQ(begin(later, 10'000), StatusCode::Good);
}

TEST_F(Exhaustion, SessionsInUseAreSharedEvenly) {
  std::vector<std::unique_ptr<PlainClient>> olafs;
  for (int i = 0; i < 50; ++i) {
    olafs.push_back(std::make_unique<PlainClient>(bench));
    olafs.back()->open();
    ASSERT_EQ(olafs.back()->sign_in("olaf", "secret"), StatusCode::Good);
  }
  PlainClient more(bench);
  more.open();
  EXPECT_EQ(more.sign_in("olaf", "secret"), StatusCode::BadTooManySessions);
  PlainClient anna(bench);
  anna.open();
  EXPECT_EQ(anna.sign_in("anna", "secret"), StatusCode::Good);
}

// An hour at most, and minutes without a session; and while others want to subscribe, an orphan goes at once.
TEST_F(Exhaustion, SubscriptionsEnd) {
  for (int i = 0; i < 10; ++i) {
    PlainClient client(bench);
    client.open();
    client.begin_session();
    CreateSubscriptionRequest request;
    request.requested_publishing_interval = 3'600'000;
    request.requested_lifetime_count = 10'000'000;
    request.requested_max_keep_alive_count = 1'000'000;
    for (int j = 0; j < 20; ++j) {
      const auto made = client.ask<CreateSubscriptionResponse>(request);
      EXPECT_LE(made.revised_publishing_interval * made.revised_lifetime_count, 3'600'000);
      EXPECT_GE(made.revised_lifetime_count, 3 * made.revised_max_keep_alive_count);
    }
    close(client, false);
    bench.server.disconnected(client.id());
  }
  EXPECT_EQ(bench.server.services().subscriptions(), 200u);
  PlainClient anna(bench);
  anna.open();
  ASSERT_EQ(anna.sign_in("anna", "secret"), StatusCode::Good);
  EXPECT_NE(subscribe(anna), 0u);
  bench.server.advance(at(120'000));
  EXPECT_EQ(bench.server.services().subscriptions(), 1u);
}

// 750 connections a second that say nothing: who says something gets through.
TEST_F(Exhaustion, SilentConnectionsGoBeforeThoseThatSignIn) {
  PlainClient anna(bench);
  anna.send(framed(MessageType::Hello, Hello{0, 65'536, 65'536, 0, 0, Text("opc.tcp://127.0.0.1:4840")}));
  for (int i = 0; i < 1000; ++i) bench.server.connected("192.0.2.1:" + std::to_string(2000 + i), at(i));
  EXPECT_FALSE(bench.server.is_closing(anna.id()));
  PlainClient other(bench, 1000);
  other.open(1000);
  EXPECT_EQ(begin(other, 1000), StatusCode::Good);
}

TEST_F(Exhaustion, TheHostWithMostConnectionsGivesOne) {
  const ConnectionId quiet = bench.server.connected("192.0.2.7:1", at(0));
  for (int i = 0; i < 300; ++i) bench.server.connected("192.0.2.1:" + std::to_string(2000 + i), at(1 + i));
  EXPECT_FALSE(bench.server.is_closing(quiet));
}

// Discovery is for everybody: what it can make the server hold is short.
TEST_F(Exhaustion, StrangersThatDoNotReadHoldLittle) {
  PlainClient stranger(bench);
  stranger.open();
  for (int i = 0; i < 1000; ++i) stranger.send_request(GetEndpointsRequest());
  EXPECT_LT(bench.server.output(stranger.id()).size(), 128u << 10);
  EXPECT_FALSE(bench.server.takes_octets(stranger.id()));
}

// Parts of a message that never ends: without a session 64 KiB are kept, with one a MiB.
TEST_F(Exhaustion, ChunksWithoutAnEndEnd) {
  for (const bool has_session : {false, true}) {
    PlainClient client(bench);
    client.open();
    if (has_session) client.begin_session();
    std::size_t sent = 0;
    for (; sent < 100 && !bench.server.is_closing(client.id()); ++sent) {
      auto chunk = client.chunk_of(std::vector<std::byte>(20'000));
      chunk[3] = std::byte{'C'};
      // Of one request: its number stays.
      uadp::store_little_endian(chunk.data() + symmetric_header_octets + 4, std::uint32_t{1000});
      client.send(chunk);
    }
    EXPECT_EQ(sent, has_session ? 53u : 4u);
  }
}

TEST_F(Exhaustion, AMessageBeforeAChannelIsOfNone) {
  PlainClient client(bench);
  client.send(framed(MessageType::Hello, Hello{0, 65'536, 65'536, 0, 0, Text("opc.tcp://127.0.0.1:4840")}));
  client.octets();
  client.send_request(GetEndpointsRequest());
  const auto answer = client.octets();
  Decoder decoder(Octets(answer).subspan(message_header_octets));
  ErrorMessage error;
  decode(decoder, error);
  EXPECT_EQ(error.error, StatusCode::BadTcpSecureChannelUnknown);
}

}  // namespace
}  // namespace takt::opcua
