// SPDX-License-Identifier: Apache-2.0
#include "opcua/server/services.hpp"

#include <algorithm>

#include "opcua/address_space/key_service_nodes.hpp"

namespace takt::opcua {
namespace {

constexpr std::uint64_t steps_of_turn =
    50'000;  // for events, and again for subscriptions that are due: some milliseconds each
constexpr std::uint64_t steps_of_event = 200;
constexpr std::size_t most_waiting_events = 256;

}  // namespace

Services::Services(const ServerSettings& settings, const Identity& identity, security::RandomOctets& random,
                   ProgramHost& host, ServerLog& log, Responder& responder,
                   const std::vector<ProgramDescription>& programs, KeyService* keys, Now now)
    : settings_(settings),
      identity_(identity),
      random_(random),
      host_(host),
      keys_(keys),
      log_(log),
      responder_(responder),
      now_(now) {
  all_octets_ = std::make_shared<OctetAccount>(settings.limits.all_octets, nullptr);
  all_buffers_ = std::make_shared<OctetAccount>(settings.limits.all_octets, nullptr);
  process_ = random_octets(8);
  std::vector<std::byte> first = random_octets(8);
  last_session_ = uadp::load_little_endian<std::uint32_t>(first.data()) & 0x7FFF'FFFFU;
  last_subscription_ = uadp::load_little_endian<std::uint32_t>(first.data() + 4) & 0x7FFF'FFFFU;
  add_server_nodes(now);
  add_program_types(space_);
  if (keys_ != nullptr) add_key_service(space_);
  for (const ProgramDescription& each : programs)
    programs_.push_back(std::make_unique<ProgramNodes>(space_, each, now.utc));
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
  set_standard(
      2255, Variant::array(std::vector<Text>{Text("http://opcfoundation.org/UA/"), Text(settings_.application_uri)}));
  set_standard(2267, Variant(std::uint8_t{255}));
  set_standard(2994, Variant(true));
  set_standard(2269, Variant::array(std::vector<Text>()));
  set_standard(2271, Variant::array(std::vector<Text>{Text("en")}));
  set_standard(2272, Variant(0.0));
  set_standard(2735, Variant(static_cast<std::uint16_t>(limits.continuation_points)));
  for (const std::uint32_t none : {2736U, 2737U}) set_standard(none, Variant(std::uint16_t{0}));
  for (const std::uint32_t operations : {11705U, 11707U, 11709U, 11710U, 11711U, 11712U, 11714U})
    set_standard(operations, Variant(static_cast<std::uint32_t>(limits.operations)));
  const DecodingLimits decoding;
  set_standard(11702, Variant(static_cast<std::uint32_t>(decoding.array_elements)));
  for (const std::uint32_t texts : {11703U, 12911U})
    set_standard(texts, Variant(static_cast<std::uint32_t>(decoding.text_octets)));
  set_standard(24095, Variant(static_cast<std::uint32_t>(limits.sessions)));
  set_standard(24096, Variant(static_cast<std::uint32_t>(limits.subscriptions)));
  set_standard(24098, Variant(static_cast<std::uint32_t>(limits.subscriptions_of_session)));
  set_standard(24099, Variant(static_cast<std::uint32_t>(limits.select_clauses)));
  set_standard(24100, Variant(static_cast<std::uint32_t>(limits.where_operands)));
  set_standard(31916, Variant(static_cast<std::uint32_t>(std::max(limits.queue, limits.event_queue))));
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
  if (Node* const node = space_.find(NodeId(2258)))
    node->computed = [made](const ReadContext& context) { return made(context.now, context.now); };
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
  spend(steps_of_event);
  if (event_items_.empty()) return;
  if (waiting_events_.size() < most_waiting_events)
    waiting_events_.push_back(std::make_shared<const EventRecord>(std::move(event), events_));
  else
    has_lost_events_ = true;
}

/// Each event to one item after the other, until the budget of this turn is used up: whoever has many, or large
/// filters, keeps nobody waiting who calls.
void Services::distribute_events() {
  const std::uint64_t until = steps_ + steps_of_turn;
  while (!waiting_events_.empty()) {
    const std::shared_ptr<const EventRecord> record = waiting_events_.front();
    for (auto at = event_items_.upper_bound(told_); at != event_items_.end(); ++at) {
      told_ = *at;
      Subscription& subscription = subscriptions_.at(at->first);
      distribute(record, subscription, subscription.items.at(at->second));
      if (steps_ >= until) return;
    }
    told_ = {};
    waiting_events_.pop_front();
  }
  if (!std::exchange(has_lost_events_, false)) return;
  for (const auto& [subscription, item] : event_items_) subscriptions_.at(subscription).items.at(item).lose_events();
}

void Services::distribute(const std::shared_ptr<const EventRecord>& record, Subscription& subscription,
                          MonitoredItem& item) {
  spend(1);
  const Event& event = record->event();
  if (record->number() <= item.events_before ||
      (item.what.node_id != NodeId(ids::server) && item.what.node_id != event.source))
    return;
  const auto session = sessions_.find(subscription.session);
  // Audit events are for those that nobody can read along with; without a session nobody is there to be told.
  if (event.is_audit && (session == sessions_.end() || !session->second.security.is_encrypted())) return;
  spend(item.event_filter->steps());
  if (item.event_filter->lets_pass(*record, space_)) item.put(record);
}

std::shared_ptr<OctetAccount> Services::account_in(Accounts& accounts, const std::string& holder,
                                                   const std::shared_ptr<OctetAccount>& above) const {
  std::erase_if(accounts, [](const auto& each) { return each.second.expired(); });
  std::weak_ptr<OctetAccount>& known = accounts[holder];
  auto account = known.lock();
  if (!account) known = account = std::make_shared<OctetAccount>(settings_.limits.user_octets, above);
  return account;
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
    session.left = now_.local;
    session.publishes.clear();
  }
  std::erase_if(calls_, [&](const auto& each) { return each.second.connection == connection; });
}

void Services::end_sessions(const std::function<bool(const Session&)>& is_over, Now now) {
  std::vector<NodeId> tokens;
  for (const auto& [token, session] : sessions_)
    if (is_over(session)) tokens.push_back(token);
  for (const NodeId& token : tokens) end(token, true, StatusCode::BadSessionClosed, now);
}

const Session* Services::session_on(ConnectionId connection) const {
  const auto found = std::find_if(sessions_.begin(), sessions_.end(), [&](const auto& each) {
    return each.second.connection == connection && each.second.is_active;
  });
  return found == sessions_.end() ? nullptr : &found->second;
}

bool Services::has_session(ConnectionId connection) const { return session_on(connection) != nullptr; }

bool Services::is_urgent(ConnectionId connection, const CallRequest& call) const {
  const auto found = sessions_.find(call.request_header.authentication_token);
  return found != sessions_.end() && found->second.is_active && found->second.connection == connection &&
         found->second.rank() == 2;
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
      fault(session.connection, session.publishes[i].request_id, session.publishes[i].request_handle,
            StatusCode::BadTimeout, now);
      session.publishes.erase(session.publishes.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  for (const NodeId& token : ended) end(token, false, StatusCode::BadSessionClosed, now);
  distribute_events();
  expire_due(now);
  std::vector<std::uint64_t> late;
  for (const auto& [number, call] : calls_)
    if (call.until <= now.local) late.push_back(number);
  for (const std::uint64_t number : late) {
    std::erase_if(methods_, [&](const auto& each) { return each.second.call == number; });
    finish(number, now);
  }
}

/// Those that have waited longest first, up to the budget of this turn.
void Services::expire_due(Now now) {
  std::vector<std::pair<sim::LocalTime, std::uint32_t>> due;
  for (const auto& [id, subscription] : subscriptions_)
    if (const sim::LocalTime at = subscription.next_time(settings_.limits.orphan_subscription); at <= now.local)
      due.emplace_back(at, id);
  std::sort(due.begin(), due.end());
  const std::uint64_t until = steps_ + steps_of_turn;
  for (const auto& [at, id] : due) {
    if (steps_ >= until) return;
    if (const auto found = subscriptions_.find(id); found != subscriptions_.end()) expire(found->second, now);
  }
}

sim::LocalTime Services::next_time() const {
  if (!waiting_events_.empty()) return now_.local;
  sim::LocalTime next = sim::LocalTime::never();
  for (const auto& [token, session] : sessions_) {
    next = std::min(next, session.ends);
    for (const QueuedPublish& each : session.publishes) next = std::min(next, each.until);
  }
  for (const auto& [id, subscription] : subscriptions_)
    next = std::min(next, subscription.next_time(settings_.limits.orphan_subscription));
  for (const auto& [number, call] : calls_) next = std::min(next, call.until);
  return next;
}

}  // namespace takt::opcua
