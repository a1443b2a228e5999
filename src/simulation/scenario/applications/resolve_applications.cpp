// SPDX-License-Identifier: Apache-2.0
#include "scenario/applications/resolve_applications.hpp"

#include <algorithm>
#include <set>
#include <string_view>
#include <utility>

#include "application/thread_filter.hpp"
#include "json/suggest.hpp"
#include "models/ethernet/sizes.hpp"
#include "plant/keys.hpp"
#include "plant/limits.hpp"
#include "plant/qos_of_thread.hpp"
#include "plant/topic_check.hpp"
#include "scenario/applications/dds_qos.hpp"
#include "scenario/applications/expected_values.hpp"
#include "scenario/applications/opc_ua_port.hpp"
#include "scenario/applications/resolve_dds.hpp"
#include "scenario/resolved/resolved_dds.hpp"
#include "scenario/resolve/known_names.hpp"
#include "scenario/resolve/os_profiles.hpp"

namespace takt::scenario {
namespace {

using plant::most_publishers;
constexpr std::uint32_t all_that_came = 65'536;  // a gateway has a buffer of its own
constexpr std::uint32_t unknown_topic = 0xFFFF'FFFF;
constexpr Duration shortest_interval = 10_us;  // the table refuses shorter ones

std::vector<std::string_view> names_of(const auto& things) {
  std::vector<std::string_view> names;
  for (const auto& each : things) names.push_back(each.name);
  return names;
}

/// The least multiple of `step` that is not shorter.
Duration multiple(Duration length, Duration step) {
  const std::int64_t times = (length.ps() + step.ps() - 1) / step.ps();
  return step * times;
}

class ApplicationResolver {
 public:
  ApplicationResolver(Resolved& resolved, StreamBuilder& builder, std::size_t& publishers,
                      json::Diagnostics& diagnostics)
      : r_(resolved), builder_(builder), publishers_(publishers), diagnostics_(diagnostics) {}

  void run() {
    const std::size_t errors_before = diagnostics_.errors();
    r_.dds = std::make_shared<ResolvedDds>();
    for (const Topic& topic : r_.scenario.topics) add(topic);
    check_domains();
    for (const Application& application : r_.scenario.applications) add(application);
    for (const Gateway& gateway : r_.scenario.gateways) add(gateway);
    for (const Persistence& service : r_.scenario.persistence) add(service);
    for (ResolvedApplication& application : r_.applications) check_threads(application);
    check_hosts();
    if (diagnostics_.errors() != errors_before || is_refused() || !is_complete())
      return;  // numbers below stand for what was found
    check_publishers();
    if (diagnostics_.errors() != errors_before) return;
    for (std::uint32_t t = 0; t < r_.topics.size(); ++t) connect(t);
    resolve_dds(r_, builder_, diagnostics_);
    for (ResolvedApplication& application : r_.applications) set_windows(application);
    check_links();
  }

 private:
  /// Each has a host and topics; what lacks them may have been refused before.
  bool is_complete() const {
    return std::all_of(r_.applications.begin(), r_.applications.end(), [](const ResolvedApplication& each) {
      return !each.node.is_none() &&
             std::none_of(each.threads.begin(), each.threads.end(),
                          [](const ResolvedThread& thread) { return thread.topic == unknown_topic; });
    });
  }

  /// Whether a part of topics or applications could not be read: who meets whom is not known then.
  bool is_refused() const {
    constexpr std::string_view lists[] = {"topics", "domains", "applications", "gateways", "persistence"};
    return std::any_of(std::begin(lists), std::end(lists),
                       [&](std::string_view list) { return diagnostics_.is_refused(r_.scenario.where.at(list)); });
  }

  void add(const Topic& topic) {
    if (std::any_of(r_.topics.begin(), r_.topics.end(),
                    [&](const ResolvedTopic& other) { return other.description->name == topic.name; }))
      diagnostics_.error(topic.where.at("name"), "duplicate name",
                         {json::quote(topic.name) + " a second time", "a name of its own for each topic"});
    if (topic.name.find('/') != std::string::npos)
      diagnostics_.error(topic.where.at("name"), "not a name for a topic",
                         {json::quote(topic.name), "no '/', which stands in the names of its streams"});
    if (!topic.pcp && topic.vlan != 0)
      diagnostics_.error(topic.where.at("vlan"), "a VLAN without a priority",
                         {"\"vlan\" alone", "\"pcp\" too, since the tag carries both"});
    if (diagnostics_.is_refused(topic.where.at("protocol"))) {
      diagnostics_.consequence();
    } else if (topic.protocol == Protocol::opc_ua) {
      for (const auto& [present, key] :
           {std::pair(!topic.keys.empty(), "keys"), std::pair(topic.type.has_value(), "type"),
            std::pair(topic.domain.has_value(), "domain"), std::pair(topic.qos.has_value(), "qos"),
            std::pair(topic.publication.has_value(), "publication"),
            std::pair(topic.flow_control.has_value(), "flow_control")})
        if (present) refuse_of_dds(topic.where.at(key), key);
    } else if (topic.publisher_id) {
      diagnostics_.error(topic.where.at("publisher_id"), "does not belong to DDS",
                         {"\"publisher_id\"", "a topic with \"protocol\": \"opc-ua\""});
    } else if (topic.flow_control && topic.publication != Publication::asynchronous) {
      diagnostics_.error(topic.where.at("flow_control"), "flow control of synchronous publication",
                         {"\"flow_control\"", "\"publication\": \"asynchronous\""});
    }
    const bool is_read = !diagnostics_.is_refused(topic.where.at("fields")) &&
                         !diagnostics_.is_refused(topic.where.at("protocol")) &&
                         !diagnostics_.is_refused(topic.where.at("uadp"));
    const std::size_t errors_so_far = diagnostics_.errors();
    if (is_read) plant::check_fields_and_layout(topic, diagnostics_);
    const bool are_fields_refused = !is_read || diagnostics_.errors() != errors_so_far;
    ResolvedTopic made;
    made.description = &topic;
    // Topics of DDS count, so that a topic has the number that it has in the file of a node.
    ++publishers_;
    made.publisher_id = topic.publisher_id.value_or(static_cast<std::uint16_t>(publishers_));
    if (publishers_ == most_publishers + 1)
      diagnostics_.error(topic.where.place(), "too many topics and participants of programs",
                         {std::to_string(publishers_), "at most " + std::to_string(most_publishers)});
    const std::size_t errors_before = diagnostics_.errors();
    if (!diagnostics_.is_refused(topic.where.at("fields")))
      plant::check_keys(topic.where, topic.keys, topic.fields, diagnostics_);
    const bool has_sound_keys = !topic.keys.empty() && !are_fields_refused && topic.protocol == Protocol::dds &&
                                diagnostics_.errors() == errors_before;
    made.shape = application::shape_of(topic, has_sound_keys ? topic.keys : std::vector<std::string>());
    r_.topics.push_back(std::move(made));
    if (topic.protocol == Protocol::opc_ua && !topic.fields.empty() && !are_fields_refused &&
        application::longest_message(r_.topics.back().shape, {1, 1}) == 0)
      diagnostics_.error(
          topic.where.at("fields"), "a sample too long for a NetworkMessage",
          {std::to_string(r_.topics.back().shape.longest().size()) + " octets of values with their types",
           "fields that fit 1472 octets with their headers"});
    else if (topic.protocol == Protocol::opc_ua && !topic.fields.empty() && !are_fields_refused && topic.uadp)
      application::check_configured_size(topic, r_.topics.back().shape, diagnostics_);
  }

  void refuse_of_dds(const json::Place& place, std::string_view key) {
    diagnostics_.error(place, "does not belong to OPC UA", {json::quote(key), "a topic with \"protocol\": \"dds\""});
  }

  void check_domains() {
    std::set<std::uint16_t> seen;
    for (const Domain& domain : r_.scenario.domains) {
      if (!seen.insert(domain.id).second)
        diagnostics_.error(domain.where.at("id"), "a domain twice", {std::to_string(domain.id), "each domain once"});
      if (std::none_of(r_.scenario.topics.begin(), r_.scenario.topics.end(), [&](const Topic& topic) {
            return topic.protocol == Protocol::dds && topic.domain.value_or(0) == domain.id;
          }))
        diagnostics_.error_unless(topics_are_refused(), domain.where.at("id"), "a domain without topics",
                                  {std::to_string(domain.id), "the domain of a topic with \"protocol\": \"dds\""});
      if ((domain.discovery == Discovery::server) != domain.server.has_value())
        diagnostics_.error(domain.where.at(domain.server ? "server" : "discovery"),
                           domain.server ? "a server without discovery by one" : "discovery by a server without one",
                           {domain.server ? json::quote(*domain.server) : "no \"server\"",
                            domain.server ? "\"discovery\": \"server\"" : "\"server\", the name of an application"});
    }
  }

  /// Nothing follows from topics of which a part could not be read.
  bool topics_are_refused() const { return diagnostics_.is_refused(r_.scenario.where.at("topics")); }

  std::uint32_t topic_of(const std::string& name, const json::Place& place) {
    for (std::uint32_t t = 0; t < r_.topics.size(); ++t)
      if (r_.topics[t].description->name == name) return t;
    // An empty name was refused by the table.
    if (!name.empty())
      diagnostics_.error_unless(
          !are_all_named(r_.scenario.topics, r_.scenario.where.at("topics"), diagnostics_), place, "unknown topic",
          {json::quote(name), "the name of a topic", json::suggest(name, names_of(r_.scenario.topics))});
    return unknown_topic;
  }

  /// Of a thread whose interval was refused nothing follows: neither an overload nor an offset beyond.
  static Duration interval_of(Duration every) { return every < shortest_interval ? 3600_s : every; }

  ResolvedApplication begin(const std::string& name, const std::string& host, const Scheduler& scheduler,
                            const json::Source& where) {
    ResolvedApplication made;
    made.name = name;
    made.where = where;
    // An empty name was refused by the table.
    if (const auto node = host.empty() ? std::nullopt : builder_.host(host, where.at("on")))
      made.node = models::NodeIndex{*node};
    made.scheduler = &scheduler;
    if (scheduler.response) made.scheduler_response = distribution_of(*scheduler.response, diagnostics_);
    return made;
  }

  sim::Distribution response_of(const std::optional<Latency>& latency, const ResolvedApplication& application) {
    if (latency) return distribution_of(*latency, diagnostics_);
    if (application.node.is_none()) return sim::Distribution::constant({});
    return r_.plan.os_latencies[r_.plan.nodes[application.node.value].os_latency].wake_up;
  }

  void check_offset(Duration offset, Duration every,
                    const json::Place& place) {  // an interval that was refused counts as an hour
    if (offset >= every && offset > Duration())
      diagnostics_.error(place, "an offset beyond the interval",
                         {json::to_text(offset), "less than " + json::to_text(every)});
  }

  void add(const Application& application) {
    ResolvedApplication made = begin(application.name, application.on, application.scheduler, application.where);
    for (const Thread& thread : application.threads) {
      ResolvedThread one;
      one.name = thread.name;
      one.where = thread.where;
      one.publishes = thread.publish.has_value();
      one.every = interval_of(thread.every);
      one.topic = unknown_topic;
      one.offset = thread.offset;
      check_offset(thread.offset, one.every, thread.where.at("offset"));
      if (thread.publish) one.topic = topic_of(*thread.publish, thread.where.at("publish"));
      if (thread.subscribe) one.topic = topic_of(*thread.subscribe, thread.where.at("subscribe"));
      one.response = response_of(thread.response, made);
      one.tests = thread.tests ? thread.tests : application.scheduler.tests;
      one.buffer = thread.buffer.value_or(1);
      const auto refuse = [&](bool present, std::string_view key, std::string_view other) {
        if (present)
          diagnostics_.error(thread.where.at(key), "does not belong to this thread",
                             {json::quote(key), "a thread with " + json::quote(other)});
      };
      refuse(one.publishes && thread.buffer, "buffer", "subscribe");
      refuse(one.publishes && thread.signal, "signal", "subscribe");
      refuse(one.publishes && thread.round_trip, "round_trip", "subscribe");
      refuse(one.publishes && thread.filter, "filter", "subscribe");
      refuse(!one.publishes && thread.payload, "payload", "publish");
      if (!one.publishes && one.topic < r_.topics.size() &&
          !diagnostics_.is_refused(r_.topics[one.topic].description->where.at("fields")) &&
          !diagnostics_.is_refused(r_.topics[one.topic].description->where.at("protocol")))
        one.filter = application::filter_of(thread, r_.topics[one.topic].shape, diagnostics_);
      if (thread.qos && one.topic < r_.topics.size() &&
          !diagnostics_.is_refused(r_.topics[one.topic].description->where.at("protocol")) &&
          r_.topics[one.topic].description->protocol == Protocol::opc_ua)
        refuse_of_dds(thread.where.at("qos"), "qos");
      if (one.topic < r_.topics.size()) one.qos = plant::merged(r_.topics[one.topic].description->qos, thread.qos);
      one.own_qos = thread.qos ? &*thread.qos : nullptr;
      if (thread.payload && one.publishes) {
        one.payload = *thread.payload;
        if (one.topic < r_.topics.size() &&
            !diagnostics_.is_refused(r_.topics[one.topic].description->where.at("keys")))
          plant::check_instances(*thread.payload,
                                 !r_.topics[one.topic].description->keys.empty() && !thread.payload->copy_of,
                                 diagnostics_);
      }
      if (one.publishes && one.topic < r_.topics.size()) check_payload(thread, *r_.topics[one.topic].description);
      if (thread.signal) add_signal(*thread.signal, one, made);
      made.threads.push_back(std::move(one));
    }
    for (std::size_t t = 0; t < application.threads.size(); ++t)
      if (application.threads[t].payload && application.threads[t].payload->copy_of)
        find_source(*application.threads[t].payload, application, made, t);
    for (std::size_t t = 0; t < application.threads.size(); ++t)
      if (application.threads[t].round_trip && application.threads[t].subscribe)
        find_outgoing(application.threads[t], application, made, t);
    r_.applications.push_back(std::move(made));
  }

  void check_payload(const Thread& thread, const Topic& topic) {
    if (diagnostics_.is_refused(thread.where.at("payload")) || diagnostics_.is_refused(topic.where.at("fields")))
      return;  // it counts already
    plant::check_payload(thread.payload.value_or(Payload()), topic, thread.where.at("publish"), diagnostics_);
  }

  /// Who publishes to a topic is known when all applications and gateways are.
  void check_publishers() {
    std::vector<std::size_t> publications(r_.topics.size());
    for (const ResolvedApplication& application : r_.applications)
      for (const ResolvedThread& thread : application.threads)
        if (thread.publishes) ++publications[thread.topic];
    plant::check_publishers(r_.scenario.topics, publications, diagnostics_);
  }

  /// The thread of the application whose values come back to this one.
  void find_outgoing(const Thread& asked, const Application& application, ResolvedApplication& made,
                     std::size_t thread) {
    const json::Place place = asked.where.at("round_trip");
    std::vector<std::string_view> published;
    std::optional<std::uint32_t> from;
    for (std::uint32_t t = 0; t < application.threads.size(); ++t) {
      if (!application.threads[t].publish) continue;
      published.push_back(*application.threads[t].publish);
      if (published.back() == *asked.round_trip && !from) from = t;
    }
    if (!from) {
      const bool is_unclear =
          std::any_of(application.threads.begin(), application.threads.end(), [&](const Thread& each) {
            return !each.where.is_known() || diagnostics_.is_refused(each.where.at("publish"));
          });
      diagnostics_.error_unless(
          is_unclear && diagnostics_.has_errors(), place, "a round trip of what is not sent",
          {json::quote(*asked.round_trip), "a topic that a thread of " + json::quote(application.name) + " publishes",
           json::suggest(*asked.round_trip, published)});
      return;
    }
    const std::optional<Payload>& payload = application.threads[*from].payload;
    if (payload && (payload->copy_of || payload->pattern == Pattern::alternate))
      diagnostics_.error(place, "a round trip of values that repeat",
                         {json::quote(*asked.round_trip) + ", which is no counter",
                          "a topic that a thread publishes with the pattern \"counter\""});
    const std::uint32_t out = made.threads[*from].topic, back = made.threads[thread].topic;
    if (out == unknown_topic || back == unknown_topic) return;
    if (!application::have_same_types(r_.topics[out].shape, r_.topics[back].shape))
      diagnostics_.error_unless(
          topics_are_refused(), place, "a round trip of other fields",
          {"fields of other types or numbers",
           "the same types in the same order as in " + json::quote(r_.topics[back].description->name)});
    made.threads[thread].round_trip = from;
    made.threads[*from].is_measured = true;
  }

  void add_signal(const Signal& signal, ResolvedThread& thread, const ResolvedApplication& application) {
    for (const ResolvedSignal& other : r_.signals)
      if (other.name == signal.name)
        diagnostics_.error(signal.where.place(), "duplicate name",
                           {json::quote(signal.name) + " a second time", "a name of its own for each signal"});
    thread.signal = static_cast<std::uint32_t>(r_.signals.size());
    r_.signals.push_back({signal.name, signal.pulse.value_or(thread.every),
                          static_cast<std::uint32_t>(r_.applications.size()),
                          static_cast<std::uint32_t>(application.threads.size())});
  }

  /// The thread of the application whose samples are published again.
  void find_source(const Payload& payload, const Application& application, ResolvedApplication& made,
                   std::size_t thread) {
    std::vector<std::string_view> subscribed;
    for (std::uint32_t t = 0; t < application.threads.size(); ++t) {
      if (!application.threads[t].subscribe) continue;
      subscribed.push_back(*application.threads[t].subscribe);
      if (subscribed.back() != *payload.copy_of) continue;
      made.threads[thread].copies = t;
    }
    if (!made.threads[thread].copies) {
      const bool is_unclear =
          std::any_of(application.threads.begin(), application.threads.end(), [&](const Thread& each) {
            return !each.where.is_known() || diagnostics_.is_refused(each.where.at("subscribe"));
          });
      diagnostics_.error_unless(is_unclear && diagnostics_.has_errors(), payload.where.at("copy_of"),
                                "a copy of what is not there",
                                {json::quote(*payload.copy_of),
                                 "a topic that a thread of " + json::quote(application.name) + " subscribes to",
                                 json::suggest(*payload.copy_of, subscribed)});
      return;
    }
    if (made.threads[*made.threads[thread].copies].topic == unknown_topic ||
        made.threads[thread].topic == unknown_topic)
      return;
    if (!application::have_same_types(r_.topics[made.threads[*made.threads[thread].copies].topic].shape,
                                      r_.topics[made.threads[thread].topic].shape))
      diagnostics_.error_unless(topics_are_refused(), payload.where.at("copy_of"), "a copy of other fields",
                                {"fields of other types or numbers",
                                 "the same types in the same order as in " +
                                     json::quote(r_.topics[made.threads[thread].topic].description->name)});
  }

  void add(const Gateway& gateway) {
    ResolvedApplication made = begin(gateway.name, gateway.on, gateway.scheduler, gateway.where);
    made.gateway = ResolvedGateway{gateway.buffer, gateway.overflow, gateway.stale_after};
    const std::uint32_t from = topic_of(gateway.from, gateway.where.at("from"));
    const std::uint32_t to = topic_of(gateway.to, gateway.where.at("to"));
    const bool both_known = from != unknown_topic && to != unknown_topic;
    if (both_known && r_.topics[from].description->protocol == r_.topics[to].description->protocol)
      diagnostics_.error_unless(topics_are_refused(), gateway.where.at("to"), "a gateway within one protocol",
                                {"both topics are of " + std::string(spelling(r_.topics[from].description->protocol)),
                                 "a topic of OPC UA and one of DDS; a thread with \"copy_of\" copies within one"});
    else if (both_known)
      check_mapping(gateway, r_.topics[from], r_.topics[to]);
    for (const bool sends : {false, true}) {
      ResolvedThread thread;
      thread.name = sends ? "send" : "receive";
      thread.where = gateway.where;
      thread.publishes = sends;
      thread.topic = sends ? to : from;
      thread.every = interval_of(sends ? gateway.send_every : gateway.receive_every);
      thread.offset = sends ? gateway.send_offset : gateway.receive_offset;
      check_offset(thread.offset, thread.every, gateway.where.at(sends ? "send_offset" : "receive_offset"));
      thread.response = response_of(sends ? gateway.send_response : gateway.receive_response, made);
      thread.tests = gateway.scheduler.tests;
      thread.buffer = all_that_came;
      if (thread.topic < r_.topics.size())
        thread.qos = plant::merged(r_.topics[thread.topic].description->qos, std::nullopt);
      if (!sends && !thread.qos.depth) thread.qos.depth = gateway.buffer;
      made.threads.push_back(std::move(thread));
    }
    r_.applications.push_back(std::move(made));
  }

  void add(const Persistence& service) {
    static const Scheduler unused;
    ResolvedApplication made = begin(service.name, service.on, unused, service.where);
    made.service.emplace();
    for (std::size_t t = 0; t < service.topics.size(); ++t) {
      const json::Place place = service.where.at("topics", t);
      const std::uint32_t topic = topic_of(service.topics[t], place);
      if (topic == unknown_topic) continue;
      if (r_.topics[topic].description->protocol != Protocol::dds) {
        if (diagnostics_.is_refused(r_.topics[topic].description->where.at("protocol"))) continue;
        refuse_of_dds(place, "persistence");
        continue;
      }
      ResolvedService::Kept kept{topic, std::nullopt, 0, plant::merged(r_.topics[topic].description->qos, std::nullopt),
                                 place};
      if (kept.qos.durability.value_or(Durability::volatile_) < Durability::transient)
        diagnostics_.error_unless(topics_are_refused(), place, "a topic that is not kept",
                                  {json::quote(service.topics[t]),
                                   "a topic whose \"qos\" has \"durability\": \"transient\" or \"persistent\""});
      made.service->topics.push_back(std::move(kept));
    }
    r_.applications.push_back(std::move(made));
  }

  void check_mapping(const Gateway& gateway, const ResolvedTopic& from, const ResolvedTopic& to) {
    std::vector<std::string> problems;
    if (application::mapping_between(from.shape, to.shape, problems)) return;
    if (topics_are_refused()) return diagnostics_.consequence();
    for (const std::string& problem : problems)
      diagnostics_.error(
          gateway.where.at("to"), "fields that do not map",
          {problem, "in both topics fields of the same names and types; what is more in \"from\" is left out"});
  }

  void check_threads(ResolvedApplication& application) {
    std::set<std::string_view> names;
    std::set<std::pair<std::uint32_t, bool>> topics;
    for (const ResolvedThread& thread : application.threads) {
      if (thread.name.find('/') != std::string::npos)
        diagnostics_.error(thread.where.at("name"), "not a name for a thread", {json::quote(thread.name), "no '/'"});
      if (!thread.name.empty() && !names.insert(thread.name).second)
        diagnostics_.error(
            thread.where.at("name"), "duplicate name",
            {json::quote(thread.name) + " a second time", "a name of its own for each thread of an application"});
      const std::string_view role = thread.publishes ? "publish" : "subscribe";
      if (thread.topic != unknown_topic && !topics.insert({thread.topic, thread.publishes}).second)
        diagnostics_.error(
            thread.where.at(role), "a topic twice in one application",
            {"another thread has the same \"" + std::string(role) + "\"", "one thread for each topic and direction"});
    }
  }

  /// What others hear has no path then, which is reported where it is said. What nobody hears is said here.
  void check_links() {
    for (const ResolvedApplication& application : r_.applications)
      if (r_.topology.neighbours[application.node.value].empty())
        diagnostics_.error_unless(diagnostics_.has_errors(), application.where.at("on"),
                                  "an application on a host without a link",
                                  {json::quote(r_.topology.nodes[application.node.value].name), "a host with a link"});
  }

  /// Frames do not leave a host to come back.
  void check_hosts() {
    struct Use {
      std::uint32_t topic;
      std::uint32_t host;
      bool publishes;
    };
    std::vector<Use> uses;
    for (const ResolvedApplication& application : r_.applications) {
      if (application.node.is_none()) continue;
      for (const ResolvedThread& thread : application.threads) {
        if (thread.topic == unknown_topic) continue;
        for (const Use& other : uses) {
          if (other.topic != thread.topic || other.host != application.node.value ||
              other.publishes == thread.publishes)
            continue;
          diagnostics_.error(thread.where.place(), "a topic that stays within a host",
                             {json::quote(r_.topics[thread.topic].description->name) +
                                  " is published and subscribed on " + json::quote(r_.topology.nodes[other.host].name),
                              "publisher and subscriber on two hosts"});
        }
        uses.push_back({thread.topic, application.node.value, thread.publishes});
      }
    }
    for (const ResolvedApplication& application : r_.applications)
      for (std::size_t k = 0;
           application.service && !application.node.is_none() && k < application.service->topics.size(); ++k) {
        const ResolvedService::Kept& kept = application.service->topics[k];
        if (std::any_of(uses.begin(), uses.end(),
                        [&](const Use& use) { return use.topic == kept.topic && use.host == application.node.value; }))
          diagnostics_.error(kept.where, "a topic that stays within a host",
                             {json::quote(r_.topics[kept.topic].description->name) + " is used and kept on " +
                                  json::quote(r_.topology.nodes[application.node.value].name),
                              "a persistence service on a host of its own"});
      }
  }

  /// From each publisher of the topic a stream to all that subscribe to it.
  void connect(std::uint32_t topic) {
    const Topic& description = *r_.topics[topic].description;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> publishers;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> subscribers;
    for (std::uint32_t a = 0; a < r_.applications.size(); ++a)
      for (std::uint32_t t = 0; t < r_.applications[a].threads.size(); ++t)
        if (r_.applications[a].threads[t].topic == topic)
          (r_.applications[a].threads[t].publishes ? publishers : subscribers).emplace_back(a, t);
    if (publishers.empty() || subscribers.empty()) {
      diagnostics_.warning(description.where.at("name"),
                           publishers.empty() ? "a topic that nobody publishes" : "a topic that nobody subscribes to",
                           {json::quote(description.name)});
      if (publishers.empty()) return;
    }
    for (std::size_t p = 0; p < publishers.size(); ++p)
      r_.applications[publishers[p].first].threads[publishers[p].second].writer_group =
          static_cast<std::uint16_t>(p + 1);
    if (subscribers.empty()) return;
    if (description.protocol == Protocol::dds) {
      // Of an exclusive topic readers get the samples of the strongest writer.
      const auto strength = [&](const auto& each) {
        return r_.applications[each.first].threads[each.second].qos.ownership_strength.value_or(0);
      };
      const bool exclusive = description.qos && description.qos->ownership == plant::Ownership::exclusive;
      const auto strongest = *std::max_element(publishers.begin(), publishers.end(),
                                               [&](const auto& x, const auto& y) { return strength(x) < strength(y); });
      for (const auto& [heard_by, of] : subscribers)
        for (const auto& [a, t] : publishers)
          if ((!exclusive || std::pair(a, t) == strongest) &&
              share_a_partition(r_.applications[a].threads[t], r_.applications[heard_by].threads[of]))
            r_.applications[heard_by].threads[of].inputs.push_back({a, t, {}});
      return;
    }
    for (const auto& [a, t] : publishers) {
      ResolvedApplication& application = r_.applications[a];
      ResolvedThread& thread = application.threads[t];
      NewStream wanted;
      wanted.name = description.name + "/" + application.name;
      wanted.where = description.where;
      wanted.from = application.node.value;
      std::set<std::uint32_t> hosts;
      for (const auto& [heard_by, of] : subscribers)
        if (hosts.insert(r_.applications[heard_by].node.value).second)
          wanted.to.push_back({r_.applications[heard_by].node.value, r_.applications[heard_by].where.at("on")});
      wanted.priority = description.pcp;
      wanted.vlan = description.vlan;
      wanted.headers = models::ipv4_and_udp_headers;
      wanted.is_group = true;
      wanted.udp_port = opc_ua_udp_port;
      wanted.payload = Octets{static_cast<std::uint32_t>(
          application::longest_message(r_.topics[topic].shape, address_of(r_.topics[topic], thread)))};
      const auto index = builder_.add(wanted);
      if (!index) continue;
      thread.stream = *index;
      StreamDemand& demand = r_.streams[index->value].demand;
      demand.frames_per_second = 1e12 / static_cast<double>(thread.every.ps());
      demand.wire_bits_per_second =
          demand.frames_per_second * 8.0 *
          models::wire_length(models::frame_length(wanted.headers + wanted.payload, description.pcp.has_value())).count;
      for (const auto& [heard_by, of] : subscribers)
        r_.applications[heard_by].threads[of].inputs.push_back({a, t, *index});
    }
  }

  static bool share_a_partition(const ResolvedThread& writer, const ResolvedThread& reader) {
    return dds::have_common_partition({writer.qos.partition.value_or(std::vector<std::string>())},
                                      {reader.qos.partition.value_or(std::vector<std::string>())});
  }

  void set_windows(ResolvedApplication& application) {
    for (ResolvedThread& thread : application.threads) {
      thread.window = multiple(application.scheduler->window, thread.every);
      thread.value_window = thread.window;
      if (thread.publishes) continue;
      for (const ResolvedInput& input : thread.inputs)
        thread.value_window =
            std::max(thread.value_window, multiple(application.scheduler->window, slowest_interval(r_, input)));
      for (const ResolvedInput& input : thread.inputs)
        thread.values_expected += takt::scenario::values_expected(r_, input, thread.value_window);
    }
  }

  Resolved& r_;
  StreamBuilder& builder_;
  std::size_t& publishers_;
  json::Diagnostics& diagnostics_;
};

}  // namespace

void resolve_applications(Resolved& resolved, StreamBuilder& builder, std::size_t& publishers,
                          json::Diagnostics& diagnostics) {
  ApplicationResolver(resolved, builder, publishers, diagnostics).run();
}

}  // namespace takt::scenario
