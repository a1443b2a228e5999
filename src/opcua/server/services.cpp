#include "opcua/server/services.hpp"

#include <algorithm>

#include "opcua/address_space/key_service_nodes.hpp"

namespace takt::opcua {

Services::Services(const ServerSettings& settings, const Identity& identity, security::RandomOctets& random, ProgramHost& host, ServerLog& log, Responder& responder,
                   const std::vector<ProgramDescription>& programs, KeyService* keys, Now now)
    : settings_(settings), identity_(identity), random_(random), host_(host), keys_(keys), log_(log), responder_(responder), now_(now) {
  process_ = random_octets(8);
  std::vector<std::byte> first = random_octets(8);
  last_session_ = uadp::load_little_endian<std::uint32_t>(first.data()) & 0x7FFF'FFFFU;
  last_subscription_ = uadp::load_little_endian<std::uint32_t>(first.data() + 4) & 0x7FFF'FFFFU;
  add_server_nodes(now);
  add_program_types(space_);
  if (keys_ != nullptr) add_key_service(space_);
  for (const ProgramDescription& each : programs) programs_.push_back(std::make_unique<ProgramNodes>(space_, each, now.utc));
  space_.listen([this](const Node& node, AttributeId attribute) { changed(node, attribute); });
}

std::vector<std::byte> Services::random_octets(std::size_t count) {
  std::vector<std::byte> octets(count);
  random_.fill(octets);
  return octets;
}

void Services::set_standard(std::uint32_t id, Variant value) {
  Node* const node = space_.find(NodeId(id));
  if (node != nullptr) node->value.value = std::move(value);
}

/// OPC 10000-5, 6.3: what clients look at first, and our limits.
void Services::add_server_nodes(Now now) {
  const Limits& limits = settings_.limits;
  set_standard(2254, Variant::array(std::vector<Text>{Text(settings_.application_uri)}));
  set_standard(2255, Variant::array(std::vector<Text>{Text("http://opcfoundation.org/UA/"), Text(settings_.application_uri)}));
  set_standard(2267, Variant(std::uint8_t{255}));
  set_standard(2994, Variant(true));
  set_standard(2269, Variant::array(std::vector<Text>()));
  set_standard(2271, Variant::array(std::vector<Text>{Text("en")}));
  set_standard(2272, Variant(0.0));
  set_standard(2735, Variant(static_cast<std::uint16_t>(limits.continuation_points)));
  for (const std::uint32_t none : {2736U, 2737U}) set_standard(none, Variant(std::uint16_t{0}));
  for (const std::uint32_t operations : {11705U, 11707U, 11709U, 11710U, 11711U, 11712U, 11714U}) set_standard(operations, Variant(static_cast<std::uint32_t>(limits.operations)));
  const DecodingLimits decoding;
  set_standard(11702, Variant(static_cast<std::uint32_t>(decoding.array_elements)));
  for (const std::uint32_t texts : {11703U, 12911U}) set_standard(texts, Variant(static_cast<std::uint32_t>(decoding.text_octets)));
  set_standard(24095, Variant(static_cast<std::uint32_t>(limits.sessions)));
  set_standard(24096, Variant(static_cast<std::uint32_t>(limits.subscriptions)));
  set_standard(24098, Variant(static_cast<std::uint32_t>(limits.subscriptions_of_session)));
  set_standard(24104, Variant(static_cast<std::uint32_t>(limits.items)));
  set_standard(2294, Variant(false));
  for (const std::uint32_t redundancy : {2296U, 3709U}) set_standard(redundancy, Variant(std::int32_t{0}));

  BuildInfo build;
  build.product_name = Text("takt");
  build.product_uri = Text("urn:takt:node");
  build.manufacturer_name = Text("takt");
  build.software_version = Text(settings_.software_version);
  build.build_number = Text(settings_.software_version);
  set_standard(2257, Variant(now.utc));
  set_standard(2259, Variant(std::int32_t{0}));
  set_standard(2260, Variant(extension_of(build)));
  set_standard(2261, Variant(build.product_name));
  set_standard(2262, Variant(build.product_uri));
  set_standard(2263, Variant(build.manufacturer_name));
  set_standard(2264, Variant(build.software_version));
  set_standard(2265, Variant(build.build_number));
  set_standard(2266, Variant(DateTime()));
  set_standard(2992, Variant(std::uint32_t{0}));
  set_standard(2993, Variant(LocalizedText()));
  const auto made = [](auto value, DateTime time) {
    DataValue of;
    of.value = Variant(std::move(value));
    of.source_time = time;
    return of;
  };
  if (Node* const node = space_.find(NodeId(2258))) node->computed = [made](const ReadContext& context) { return made(context.now, context.now); };
  if (Node* const node = space_.find(NodeId(2256)))
    node->computed = [made, build, start = now.utc](const ReadContext& context) {
      ServerStatusDataType status;
      status.start_time = start;
      status.current_time = context.now;
      status.build_info = build;
      return made(extension_of(status), context.now);
    };
}

/// Every event has an id that no other one has, of this server or of one before a restart.
void Services::tell(const Event& told) {
  Event event = told;
  std::vector<std::byte> id = process_;
  id.resize(16);
  uadp::store_little_endian(id.data() + 8, ++events_);
  event.fields["EventId"] = Variant(Bytes(id));
  for (auto& [number, subscription] : subscriptions_) {
    const auto session = sessions_.find(subscription.session);
    // Audit events are for those that nobody can read along with; without a session nobody is there to be told.
    if (event.is_audit && (session == sessions_.end() || !session->second.security.is_encrypted())) continue;
    for (auto& [item_id, item] : subscription.items) {
      if (!item.is_of_events() || (item.what.node_id != NodeId(ids::server) && item.what.node_id != event.source)) continue;
      if (lets_pass(item.event_filter->where_clause, event, space_)) item.put(EventFieldList{item.client_handle, selected_fields(*item.event_filter, event)});
    }
  }
}

void Services::news(const ProgramNews& news) {
  if (news.program >= programs_.size()) return;
  for (const Event& event : programs_[news.program]->take(news)) tell(event);
}

void Services::answered(std::uint64_t serial, StatusCode status, Now now) {
  now_ = now;
  const auto found = methods_.find(serial);
  if (found == methods_.end()) return;  // too late: it has been answered with Bad_Timeout
  PendingMethod method = std::move(found->second);
  methods_.erase(found);
  method.record.status = status;
  for (const Event& event : programs_[method.program]->called(method.record)) tell(event);
  const auto call = calls_.find(method.call);
  if (call == calls_.end()) return;
  call->second.response.results[method.result].status_code = status;
  if (--call->second.missing == 0) finish(method.call, now);
}

void Services::finish(std::uint64_t number, Now now) {
  const auto call = calls_.find(number);
  PendingCall done = std::move(call->second);
  calls_.erase(call);
  respond(done.connection, done.request_id, done.handle, std::move(done.response), now);
}

void Services::disconnected(ConnectionId connection) {
  for (auto& [token, session] : sessions_) {
    if (session.connection != connection) continue;
    session.connection = 0;
    session.publishes.clear();
  }
  std::erase_if(calls_, [&](const auto& each) { return each.second.connection == connection; });
}

bool Services::has_session(ConnectionId connection) const {
  return std::any_of(sessions_.begin(), sessions_.end(), [&](const auto& each) { return each.second.connection == connection; });
}

void Services::advance(Now now) {
  now_ = now;
  std::vector<NodeId> ended;
  for (auto& [token, session] : sessions_) {
    if (session.ends <= now.local) ended.push_back(token);
    for (std::size_t i = 0; i < session.publishes.size();) {
      if (session.publishes[i].until > now.local) {
        ++i;
        continue;
      }
      fault(session.connection, session.publishes[i].request_id, session.publishes[i].request_handle, StatusCode::BadTimeout, now);
      session.publishes.erase(session.publishes.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  for (const NodeId& token : ended) end(token, false, StatusCode::BadSessionClosed, now);
  std::vector<std::uint32_t> due;
  for (const auto& [id, subscription] : subscriptions_)
    if (subscription.next_time() <= now.local) due.push_back(id);
  for (const std::uint32_t id : due)
    if (const auto found = subscriptions_.find(id); found != subscriptions_.end()) expire(found->second, now);
  std::vector<std::uint64_t> late;
  for (const auto& [number, call] : calls_)
    if (call.until <= now.local) late.push_back(number);
  for (const std::uint64_t number : late) {
    std::erase_if(methods_, [&](const auto& each) { return each.second.call == number; });
    finish(number, now);
  }
}

sim::LocalTime Services::next_time() const {
  sim::LocalTime next = sim::LocalTime::never();
  for (const auto& [token, session] : sessions_) {
    next = std::min(next, session.ends);
    for (const QueuedPublish& each : session.publishes) next = std::min(next, each.until);
  }
  for (const auto& [id, subscription] : subscriptions_) next = std::min(next, subscription.next_time());
  for (const auto& [number, call] : calls_) next = std::min(next, call.until);
  return next;
}

}  // namespace takt::opcua
