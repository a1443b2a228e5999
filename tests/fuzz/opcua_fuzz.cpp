// SPDX-License-Identifier: Apache-2.0
// Any octets at the server: the first says how they get there. Before a channel, as UA-TCP in pieces; in an OPN that is
// signed and encrypted; behind it as chunks; as requests of a session; as requests of which only fields are any.
// Neither crash nor hang, bounded memory, and another client is served as before.
#include "support/opcua_bench.hpp"

namespace {

using namespace takt;
using namespace takt::opcua;
using test::at;

/// Numbers of the input, 0 at its end.
class Source {
 public:
  explicit Source(Octets octets) : octets_(octets) {}
  std::uint8_t octet() {
    if (octets_.empty()) return 0;
    const auto first = static_cast<std::uint8_t>(octets_[0]);
    octets_ = octets_.subspan(1);
    return first;
  }
  Octets take(std::size_t most) {
    const Octets taken = octets_.first(std::min(most, octets_.size()));
    octets_ = octets_.subspan(taken.size());
    return taken;
  }
  bool is_empty() const { return octets_.empty(); }
  Octets rest() { return take(octets_.size()); }

 private:
  Octets octets_;
};

constexpr std::uint32_t requests[] = {422, 428, 461, 467, 473, 479, 527, 533, 554, 560, 566, 631, 673, 712,
                                      751, 763, 769, 781, 787, 793, 799, 847, 841, 832, 826, 391, 1};

NodeId any_node(Source& source) {
  static const NodeId nodes[] = {NodeId(84),
                                 NodeId(2253),
                                 NodeId(2256),
                                 NodeId(2258),
                                 NodeId(2391),
                                 NodeId(1, "cell"),
                                 NodeId(1, "cell.CurrentState"),
                                 NodeId(1, "cell.Start"),
                                 NodeId(2426),
                                 NodeId(1, "cell.ProgramDiagnostic"),
                                 NodeId(2255),
                                 NodeId(7, 7u)};
  return nodes[source.octet() % std::size(nodes)];
}

Text any_text(Source& source) {
  const Octets octets = source.take(source.octet() % 4U);
  return Text(std::string(reinterpret_cast<const char*>(octets.data()), octets.size()));
}

/// A request that is sound, with values that may be none.
void say_something(test::PlainClient& client, Source& source, std::uint32_t& subscription, std::int64_t now) {
  switch (source.octet() % 9) {
    case 0: {
      ReadRequest body;
      for (int i = source.octet() % 4; i >= 0; --i)
        body.nodes_to_read.push_back({any_node(source), source.octet() % 30U, any_text(source), {}});
      client.send_request(body, now);
      return;
    }
    case 1: {
      BrowseRequest body;
      BrowseDescription what;
      what.node_id = any_node(source);
      what.browse_direction = static_cast<BrowseDirection>(source.octet() % 4);
      what.reference_type_id = NodeId(source.octet());
      what.include_subtypes = source.octet() % 2 == 0;
      what.result_mask = source.octet();
      body.requested_max_references_per_node = source.octet() % 4U;
      body.nodes_to_browse.push_back(what);
      client.send_request(body, now);
      return;
    }
    case 2: {
      CreateSubscriptionRequest body;
      body.requested_publishing_interval = source.octet();
      body.requested_max_keep_alive_count = source.octet();
      body.max_notifications_per_publish = source.octet() % 4U;
      body.publishing_enabled = source.octet() % 4 != 0;
      client.take();
      subscription = client.ask<CreateSubscriptionResponse>(body, now).subscription_id;
      return;
    }
    case 3: {
      CreateMonitoredItemsRequest body;
      body.subscription_id = subscription;
      MonitoredItemCreateRequest item;
      item.item_to_monitor.node_id = any_node(source);
      item.item_to_monitor.attribute_id = source.octet() % 28U;
      item.monitoring_mode = static_cast<MonitoringMode>(source.octet() % 4);
      item.requested_parameters.queue_size = source.octet();
      if (item.item_to_monitor.attribute_id == 12) {
        EventFilter filter;
        filter.select_clauses.resize(1);
        filter.select_clauses[0].type_definition_id = NodeId(2041);
        filter.select_clauses[0].attribute_id = 13;
        filter.select_clauses[0].browse_path.push_back({0, Text("Message")});
        for (int i = source.octet() % 4; i > 0; --i) {
          ContentFilterElement element;
          element.filter_operator = static_cast<FilterOperator>(source.octet() % 18);
          for (int j = source.octet() % 4; j > 0; --j)
            element.filter_operands.push_back(source.octet() % 2 == 0
                                                  ? extension_of(ElementOperand{source.octet() % 5U})
                                                  : extension_of(LiteralOperand{Variant(NodeId(source.octet()))}));
          filter.where_clause.elements.push_back(element);
        }
        item.requested_parameters.filter = extension_of(filter);
      }
      body.items_to_create.push_back(item);
      client.send_request(body, now);
      return;
    }
    case 4:
      client.send_request(PublishRequest(), now);
      return;
    case 5: {
      CallRequest body;
      body.methods_to_call.push_back({NodeId(1, "cell"), any_node(source), {}});
      client.send_request(body, now);
      return;
    }
    case 6:
      client.begin_session(now);
      return;
    case 7: {
      CloseSessionRequest body;
      body.delete_subscriptions = source.octet() % 2 == 0;
      client.send_request(body, now);
      return;
    }
    default: {
      TransferSubscriptionsRequest body;
      body.subscription_ids.push_back(subscription + source.octet() % 2U);
      body.send_initial_values = true;
      client.send_request(body, now);
    }
  }
}

/// Of one message, and of the turn that it comes in: the requests of a turn, the longest one that ends it, events and
/// subscriptions.
constexpr std::uint64_t most_steps_of_message = 700'000;

/// What a message costs, from its beginning to its end.
class Cost {
 public:
  explicit Cost(const test::Bench& bench) : services_(bench.server.services()), before_(services_.steps()) {}
  Cost(const Cost&) = delete;
  Cost& operator=(const Cost&) = delete;
  ~Cost() {
    TAKT_CHECK(services_.steps() - before_ <= most_steps_of_message, "the work of a turn is bounded");
    TAKT_CHECK(services_.octets() <= Limits().all_octets, "what sessions hold is bounded");
  }

 private:
  const Services& services_;
  std::uint64_t before_;
};

void feed_structured(test::Bench& bench, Source& source) {
  test::PlainClient client(bench);
  const auto most = source.octet();
  client.open(0, 3'600'000, most < 128 ? 0U : most * 4U);
  client.begin_session();
  std::uint32_t subscription = 0;
  std::int64_t now = 0;
  for (int i = 0; i < 200 && !source.is_empty(); ++i) {
    const Cost cost(bench);
    const auto what = source.octet();
    if (what < 180) say_something(client, source, subscription, now);
    if (what % 4 == 0) bench.server.advance(at(now += 1 + source.octet()));
    if (what % 4 == 1) {
      ProgramNews news;
      news.kind = ProgramNews::Kind::transition;
      news.change = {static_cast<std::uint8_t>(source.octet() % 10), handshake::PublishedState::Halted,
                     static_cast<handshake::PublishedState>(11 + source.octet() % 5)};
      news.time = at(now).utc;
      bench.server.news(news, at(now));
    }
    if (what % 4 == 2)
      for (const auto& call : std::exchange(bench.host.calls, {}))
        bench.server.answered(call.serial, StatusCode::Good, at(now));
    if (what % 8 == 3) client.take();
  }
}

void feed_bodies(test::Bench& bench, Source& source) {
  test::PlainClient client(bench);
  client.open();
  client.begin_session();
  for (int i = 0; i < 20 && !source.is_empty(); ++i) {
    const Cost cost(bench);
    Encoder encoder;
    encode(encoder, NodeId(requests[source.octet() % std::size(requests)]));
    if (source.octet() % 4 != 0) {
      RequestHeader header;
      header.authentication_token = client.token;
      encode(encoder, header);
    }
    encoder.put_octets(source.take(source.octet()));
    client.send_body(encoder.octets());
  }
}

void feed_chunks(test::Bench& bench, Source& source) {
  test::PlainClient client(bench);
  client.open();
  while (!source.is_empty()) {
    const Cost cost(bench);
    const Octets part = source.take(1U + source.octet());
    client.send(part);
  }
}

/// An OPN that a trusted client has signed and encrypted, of any body; or of any octets in its headers.
void feed_open(Source& source) {
  ServerSettings settings = test::test_settings();
  settings.endpoints.push_back({SecurityPolicy::Basic256Sha256, MessageSecurityMode::SignAndEncrypt});
  test::Bench bench(settings);
  const Identity& who = test::test_identity();
  TrustList trust;
  trust.trusted.push_back(who.certificate);
  bench.server.trust(trust);
  const ConnectionId id = bench.server.connected("192.0.2.3:1", at(0));
  bench.server.received(
      id, framed(MessageType::Hello, Hello{0, 65'536, 65'536, 0, 0, Text("opc.tcp://127.0.0.1:4840")}), at(0));
  const PolicyInfo& policy = info(SecurityPolicy::Basic256Sha256);
  const bool is_sound = source.octet() % 4 != 0;
  AsymmetricHeader header;
  header.policy_uri = Text(policy.uri);
  header.sender_certificate = Bytes({who.certificate.der().begin(), who.certificate.der().end()});
  header.receiver_thumbprint = Bytes({who.certificate.thumbprint().begin(), who.certificate.thumbprint().end()});
  for (int i = is_sound ? 0 : source.octet() % 8; i > 0; --i)
    header.sender_certificate.value[(source.octet() * 256U + source.octet()) % header.sender_certificate.value.size()] =
        static_cast<std::byte>(source.octet());
  Encoder encoder;
  encode_message_header(encoder, MessageType::OpenChannel);
  encoder.put(std::uint32_t{0});
  encode(encoder, header);
  const std::size_t clear_from = encoder.position();
  encoder.put(std::uint32_t{1});
  encoder.put(std::uint32_t{1});
  if (source.octet() % 2 == 0) {
    OpenSecureChannelRequest request;
    request.request_type = static_cast<SecurityTokenRequestType>(source.octet() % 3);
    request.security_mode = static_cast<MessageSecurityMode>(source.octet() % 5);
    request.client_nonce = Bytes(std::vector<std::byte>(source.octet() % 40U));
    request.requested_lifetime = source.octet();
    encode_message(encoder, request);
  }
  encoder.put_octets(source.take(300));
  std::vector<std::byte> chunk = encoder.take();
  TAKT_CHECK(seal_asymmetric(chunk, clear_from, policy, who.key, who.certificate.key()), "the test's key can be used");
  bench.server.received(id, chunk, at(1));
  bench.server.received(id, source.rest(), at(2));
  security::Certificate::from_der(source.rest());
}

void feed_octets(test::Bench& bench, Source& source) {
  const ConnectionId id = bench.server.connected("192.0.2.2:1", at(0));
  const std::size_t piece = 1U + source.octet();
  while (!source.is_empty()) bench.server.received(id, source.take(piece), at(0));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  test::Bench bench;
  Source source(std::as_bytes(std::span(data, size)));
  switch (source.octet() % 5) {
    case 0:
      feed_octets(bench, source);
      break;
    case 1:
      feed_chunks(bench, source);
      break;
    case 2:
      feed_bodies(bench, source);
      break;
    case 4:
      feed_open(source);
      break;
    default:
      feed_structured(bench, source);
  }
  TAKT_CHECK(bench.server.services().sessions() <= 75, "sessions are bounded");
  // Another client, who comes a day later and has done nothing wrong.
  constexpr std::int64_t later = 86'400'000;
  bench.server.advance(at(later));
  test::PlainClient other(bench, later);
  other.open(later);
  other.begin_session(later);
  ReadRequest read;
  read.nodes_to_read.push_back({NodeId(2259), 13, {}, {}});
  TAKT_CHECK(other.ask<ReadResponse>(read, later).results.size() == 1, "others are served as before");
  return 0;
}
