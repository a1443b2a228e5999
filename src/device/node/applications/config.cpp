// SPDX-License-Identifier: Apache-2.0
#include "node/applications/config.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "application/opc_ua_topic.hpp"
#include "application/thread_filter.hpp"
#include "json/suggest.hpp"
#include "node/dds/participant.hpp"
#include "plant/keys.hpp"
#include "plant/topic_check.hpp"
#include "sim/check.hpp"

namespace takt::node {
namespace {

constexpr std::size_t most_message_octets = 1472;  // what UDP over IPv4 leaves of an Ethernet frame

/// OMG DDS 1.4, annex B, and '/', which implementations take too.
bool is_dds_name(const std::string& name) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto is_allowed = [&](char c) {
    return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '/';
  };
  return !name.empty() && !is_digit(name[0]) && std::all_of(name.begin(), name.end(), is_allowed);
}

/// Checks what the fields of a file mean together.
class Checker {
 public:
  Checker(LoadedApplications& loaded, json::Diagnostics& diagnostics)
      : loaded_(loaded), config_(loaded.config), diagnostics_(diagnostics) {}

  void run() {
    check_topics();
    number_publications();
    const auto is_elsewhere = [this](const auto& each) { return each.on != config_.node; };
    std::erase_if(config_.applications, is_elsewhere);
    std::erase_if(config_.gateways, is_elsewhere);
    if (config_.applications.empty() && config_.gateways.empty())
      diagnostics_.error(config_.where.at("node"), "nothing to run here",
                         {json::quote(config_.node), "a node that an application or a gateway is on"});
    std::set<std::string> names;
    for (const plant::Application& each : config_.applications) check_application(each, names);
    for (const plant::Gateway& each : config_.gateways) check_gateway(each, names);
    if (config_.security) load_security_of_topics(*config_.security);
    if (uses_opc_ua_ && !config_.transport)
      diagnostics_.error(config_.where.at("node"), "no transport", {"topics of OPC UA", "a \"transport\" for them"});
  }

 private:
  /// A WriterGroup for each publication of a topic, in the order of the file, which may tell of other nodes: the same
  /// numbers at all of them.
  void number_publications() {
    std::map<std::string, std::uint16_t> counts;
    for (const plant::Application& application : config_.applications)
      for (const Thread& thread : application.threads)
        if (thread.publish)
          number_publication({application.name, thread.name, *thread.publish, application.on, ++counts[*thread.publish],
                              thread.every});
    for (const plant::Gateway& gateway : config_.gateways)
      number_publication(
          {gateway.name, sending_thread, gateway.to, gateway.on, ++counts[gateway.to], gateway.send_every});
    std::vector<std::size_t> publications;
    for (const Topic& topic : config_.topics) publications.push_back(counts[topic.name]);
    plant::check_publishers(config_.topics, publications, diagnostics_);
    for (std::size_t i = 0; i < config_.topics.size(); ++i)
      loaded_.topics[i].writer_groups = std::max<std::uint16_t>(1, counts[config_.topics[i].name]);
  }

  void number_publication(const LoadedPublication& publication) {
    loaded_.writer_groups[{publication.application, publication.thread}] = publication.number;
    loaded_.publications.push_back(publication);
  }

  void check_topics() {
    std::set<std::string> names;
    std::set<std::uint16_t> ids;
    for (std::size_t i = 0; i < config_.topics.size(); ++i) {
      const Topic& topic = config_.topics[i];
      if (!names.insert(topic.name).second)
        diagnostics_.error(topic.where.at("name"), "duplicate name",
                           {json::quote(topic.name), "a name of its own for each topic"});
      LoadedTopic& loaded = loaded_.topics.emplace_back();
      loaded.publisher_id = topic.publisher_id.value_or(static_cast<std::uint16_t>(i + 1));
      loaded.domain = topic.domain.value_or(0);
      const bool is_dds = topic.protocol == Protocol::dds;
      if (plant::has_uint16_publisher(topic) && !ids.insert(loaded.publisher_id).second)
        diagnostics_.error(topic.where.at("publisher_id"), "a PublisherId twice",
                           {std::to_string(loaded.publisher_id), "one of its own for each topic"});
      if (is_dds && topic.publisher_id)
        diagnostics_.error(topic.where.at("publisher_id"), "not of DDS", {"a PublisherId", "a topic of OPC UA"});
      for (const auto& [is_there, key] :
           {std::pair{!topic.keys.empty(), "keys"}, std::pair{topic.type.has_value(), "type"},
            std::pair{topic.domain.has_value(), "domain"}, std::pair{topic.qos.has_value(), "qos"},
            std::pair{topic.publication.has_value(), "publication"},
            std::pair{topic.flow_control.has_value(), "flow_control"}})
        if (!is_dds && is_there)
          diagnostics_.error(topic.where.at(key), "not of OPC UA", {json::quote(key), "a topic of DDS"});
      if (is_dds && !is_dds_name(topic.name))
        diagnostics_.error(topic.where.at("name"), "not a topic name of DDS",
                           {json::quote(topic.name), "letters, digits, '_' and '/', and no digit first"});
      if (topic.qos) check_qos(*topic.qos);
      if (is_dds && topic.publication == plant::Publication::asynchronous)
        diagnostics_.error(topic.where.at("publication"), "not on a real node",
                           {"asynchronous publication, which is not asked of Cyclone DDS", "\"synchronous\""});
      const std::size_t errors_before = diagnostics_.errors();
      plant::check_fields_and_layout(topic, diagnostics_);
      if (is_dds) plant::check_keys(topic.where, topic.keys, topic.fields, diagnostics_);
      const bool is_sound = diagnostics_.errors() == errors_before;
      loaded.is_sound = is_sound;
      loaded.shape = application::shape_of(topic, is_dds && is_sound ? topic.keys : std::vector<std::string>());
      if (!is_dds && is_sound) application::check_configured_size(topic, loaded.shape, diagnostics_);
      if (!is_dds && is_sound && application::longest_message(loaded.shape, {1, 1}) == 0)
        diagnostics_.error(topic.where.at("fields"), "a sample too long for a NetworkMessage",
                           {std::to_string(loaded.shape.longest().size()) + " octets of values with their types",
                            "fields that fit " + std::to_string(most_message_octets) + " octets with their headers"});
    }
  }

  /// Nonces of two nodes differ by a number that is a node's alone.
  void load_security_of_topics(const MessageSecurity& security) {
    if (!uses_opc_ua_)
      return diagnostics_.error(
          security.where.place(), "nothing to secure",
          {"no topic of OPC UA here", "a topic of OPC UA that this node publishes or subscribes to"});
    LoadedSecurity found = load_security(security, diagnostics_);
    auto made = std::make_shared<LoadedConfig>();
    made->config.node = config_.node;
    made->config.clock = config_.clock;
    made->config.security = security;
    made->keys = std::move(found.keys);
    made->key_access = std::move(found.access);
    made->sender = security.sender.value_or(own_publisher_id());
    const bool publishes =
        std::any_of(loaded_.publications.begin(), loaded_.publications.end(),
                    [&](const LoadedPublication& each) { return is_of_opc_ua(each) && each.on == config_.node; });
    if (publishes && made->sender == 0)
      diagnostics_.error(security.where.place(), "nonces without a number of this node",
                         {"no topic with a PublisherId that is a UInt16 and that this node alone publishes to",
                          "\"sender\": a number that no other node with these keys has"});
    for (std::size_t i = 0; i < config_.topics.size(); ++i) {
      if (config_.topics[i].protocol != Protocol::opc_ua) continue;
      // ExtendedFlags1 may have to be added, too.
      const std::size_t longest =
          application::longest_message(loaded_.topics[i].shape, {1, 1}) + security::added_octets(security.mode) + 1;
      if (longest > most_message_octets)
        diagnostics_.error(config_.topics[i].where.at("fields"), "a sample too long for a NetworkMessage",
                           {std::to_string(longest) + " octets with all headers and a signature",
                            "at most " + std::to_string(most_message_octets)});
    }
    loaded_.secured = std::move(made);
  }

  bool is_of_opc_ua(const LoadedPublication& publication) const {
    return std::any_of(config_.topics.begin(), config_.topics.end(), [&](const Topic& topic) {
      return topic.name == publication.topic && topic.protocol == Protocol::opc_ua;
    });
  }

  /// That of a topic to which this node alone publishes, by one publication; 0 if there is none.
  std::uint16_t own_publisher_id() const {
    for (const LoadedPublication& each : loaded_.publications)
      for (std::size_t i = 0; i < config_.topics.size(); ++i)
        if (each.on == config_.node && config_.topics[i].name == each.topic &&
            plant::has_uint16_publisher(config_.topics[i]) && loaded_.topics[i].writer_groups == 1)
          return loaded_.topics[i].publisher_id;
    return 0;
  }

  void check_qos(const plant::Qos& qos) {
    if (qos.durability && *qos.durability > plant::Durability::transient_local)
      diagnostics_.error(
          qos.where.at("durability"), "not on a real node",
          {"transient or persistent data, which Cyclone DDS does not keep", "volatile or transient-local"});
    if (qos.durability_service)
      diagnostics_.error(
          qos.where.at("durability_service"), "not on a real node",
          {"what a persistence service keeps, and Cyclone DDS has none", "volatile or transient-local data"});
  }

  /// The topic, which is used here; nothing if there is none.
  std::optional<std::size_t> use(const std::string& name, const json::Place& place, bool publishes = false) {
    const auto found = std::find_if(config_.topics.begin(), config_.topics.end(),
                                    [&](const Topic& topic) { return topic.name == name; });
    if (found == config_.topics.end()) {
      std::vector<std::string_view> names;
      for (const Topic& topic : config_.topics) names.push_back(topic.name);
      diagnostics_.error(place, "no such topic", {json::quote(name), "one of the topics", json::suggest(name, names)});
      return std::nullopt;
    }
    const bool is_opc_ua = found->protocol == Protocol::opc_ua;
    uses_opc_ua_ = uses_opc_ua_ || is_opc_ua;
    if (publishes && is_opc_ua && !published_.insert(name).second)
      diagnostics_.error(
          place, "published twice",
          {json::quote(name), "one thread of an application for each topic of OPC UA that it publishes to"});
    if (found->protocol == Protocol::dds && !has_dds())
      diagnostics_.error(place, "DDS is not in this build", {json::quote(name) + ", a topic of DDS", dds_needed});
    return static_cast<std::size_t>(found - config_.topics.begin());
  }

  void check_phase(const json::Source& where, const char* key, Duration offset, Duration every) {
    if (offset > Duration() && offset >= every)
      diagnostics_.error(where.at(key), "an offset beyond the interval",
                         {json::to_text(offset), "less than " + json::to_text(every)});
  }

  void check_application(const plant::Application& application, std::set<std::string>& names) {
    if (!names.insert(application.name).second)
      diagnostics_.error(application.where.at("name"), "duplicate name",
                         {json::quote(application.name), "a name of its own for each application and gateway"});
    std::set<std::string> threads;
    published_.clear();
    add_scheduler(application.name, application.scheduler);
    for (const Thread& thread : application.threads) {
      if (!threads.insert(thread.name).second)
        diagnostics_.error(thread.where.at("name"), "duplicate name",
                           {json::quote(thread.name), "a name of its own for each thread"});
      check_phase(thread.where, "offset", thread.offset, thread.every);
      const char* const role = thread.publish ? "publish" : "subscribe";
      const auto topic = use(thread.publish ? *thread.publish : thread.subscribe.value_or(""), thread.where.at(role),
                             thread.publish.has_value());
      if (topic && thread.payload && thread.publish)
        plant::check_instances(*thread.payload, !config_.topics[*topic].keys.empty() && !thread.payload->copy_of,
                               diagnostics_);
      if (topic && thread.publish)
        plant::check_payload(thread.payload.value_or(Payload()), config_.topics[*topic], thread.where.at("publish"),
                             diagnostics_);
      if (thread.payload && !thread.publish)
        diagnostics_.error(thread.where.at("payload"), "nothing is published",
                           {"a payload", "a thread that publishes"});
      if (thread.buffer && !thread.subscribe)
        diagnostics_.error(thread.where.at("buffer"), "nothing is taken", {"a buffer", "a thread that subscribes"});
      if (thread.qos && topic && config_.topics[*topic].protocol != Protocol::dds)
        diagnostics_.error(thread.where.at("qos"), "not of OPC UA", {"quality of service", "a topic of DDS"});
      if (thread.qos) check_qos(*thread.qos);
      if (thread.filter && !thread.subscribe)
        diagnostics_.error(thread.where.at("filter"), "nothing is taken", {"a filter", "a thread that subscribes"});
      else if (topic && loaded_.topics[*topic].is_sound)
        if (auto filter = application::filter_of(thread, loaded_.topics[*topic].shape, diagnostics_))
          loaded_.filters.insert_or_assign({application.name, thread.name}, std::move(*filter));
      add_response(application.name, thread.name, thread.response);
      if (thread.signal) check_signal(thread);
      if (thread.round_trip)
        diagnostics_.error(thread.where.at("round_trip"), "not on a real node",
                           {"round trips", "takt run, which measures them"});
      if (topic && thread.payload && thread.payload->copy_of) check_copy(application, *thread.payload, *topic);
    }
  }

  void add_response(const std::string& of, const std::string& thread, const std::optional<plant::Latency>& response) {
    if (response)
      loaded_.responses.insert_or_assign({of, thread}, application::distribution_of(*response, diagnostics_));
  }

  void add_scheduler(const std::string& of, const Scheduler& scheduler) {
    if (scheduler.response)
      loaded_.scheduler_responses.insert_or_assign(of, application::distribution_of(*scheduler.response, diagnostics_));
  }

  void check_signal(const Thread& thread) {
    if (!thread.subscribe)
      diagnostics_.error(thread.where.at("signal"), "nothing is taken",
                         {"a digital output", "a thread that subscribes"});
    if (!signals_.insert(thread.signal->name).second)
      diagnostics_.error(thread.signal->where.place(), "duplicate name",
                         {json::quote(thread.signal->name) + " a second time", "a name of its own for each signal"});
  }

  void check_copy(const plant::Application& application, const Payload& payload, std::size_t to) {
    const json::Place place = payload.where.at("copy_of");
    const auto from = use(*payload.copy_of, place);
    if (!from) return;
    const bool is_taken = std::any_of(application.threads.begin(), application.threads.end(),
                                      [&](const Thread& each) { return each.subscribe == payload.copy_of; });
    if (!is_taken)
      diagnostics_.error(place, "not subscribed to",
                         {json::quote(*payload.copy_of), "a topic that a thread of this application subscribes to"});
    if (!application::have_same_types(loaded_.topics[*from].shape, loaded_.topics[to].shape))
      diagnostics_.error(place, "other fields",
                         {json::quote(*payload.copy_of), "a topic with fields of the same types in the same order"});
  }

  void check_gateway(const plant::Gateway& gateway, std::set<std::string>& names) {
    if (!names.insert(gateway.name).second)
      diagnostics_.error(gateway.where.at("name"), "duplicate name",
                         {json::quote(gateway.name), "a name of its own for each application and gateway"});
    published_.clear();
    add_scheduler(gateway.name, gateway.scheduler);
    add_response(gateway.name, receiving_thread, gateway.receive_response);
    add_response(gateway.name, sending_thread, gateway.send_response);
    check_phase(gateway.where, "receive_offset", gateway.receive_offset, gateway.receive_every);
    check_phase(gateway.where, "send_offset", gateway.send_offset, gateway.send_every);
    const auto from = use(gateway.from, gateway.where.at("from"));
    const auto to = use(gateway.to, gateway.where.at("to"), true);
    if (!from || !to) return;
    if (config_.topics[*from].protocol == config_.topics[*to].protocol) {
      diagnostics_.error(gateway.where.at("to"), "no gateway",
                         {json::quote(gateway.to) + ", of the same protocol as " + json::quote(gateway.from),
                          "a topic of the other protocol"});
      return;
    }
    std::vector<std::string> problems;
    application::mapping_between(loaded_.topics[*from].shape, loaded_.topics[*to].shape, problems);
    for (const std::string& problem : problems)
      diagnostics_.error(
          gateway.where.at("to"), "types do not map",
          {problem, "in both topics fields of the same names and types; what is more in \"from\" is left out"});
  }

  LoadedApplications& loaded_;
  ApplicationsConfig& config_;
  json::Diagnostics& diagnostics_;
  bool uses_opc_ua_ = false;
  std::set<std::string> published_;  ///< topics of OPC UA, by the present application or gateway
  std::set<std::string> signals_;
};

}  // namespace

std::size_t LoadedApplications::topic(const std::string& name) const {
  const auto found =
      std::find_if(config.topics.begin(), config.topics.end(), [&](const Topic& each) { return each.name == name; });
  TAKT_CHECK(found != config.topics.end(), "names have been checked");
  return static_cast<std::size_t>(found - config.topics.begin());
}

bool is_applications_file(const std::string& path) {
  json::Diagnostics unheard;
  const auto document = json::parse_file(path, unheard);
  if (!document) return false;
  const auto has = [&](const char* key) { return document->root().find(key) != nullptr; };
  return !has("program") && !has("programs") && (has("applications") || has("gateways") || has("topics"));
}

namespace {

std::unique_ptr<LoadedApplications> load(const std::optional<json::Document>& document,
                                         json::Diagnostics& diagnostics) {
  if (!document) return nullptr;
  auto loaded = std::make_unique<LoadedApplications>();
  json::decode(*document, loaded->config, diagnostics);
  if (diagnostics.has_errors()) return nullptr;
  Checker(*loaded, diagnostics).run();
  return diagnostics.has_errors() ? nullptr : std::move(loaded);
}

}  // namespace

std::unique_ptr<LoadedApplications> load_applications(const std::string& path, json::Diagnostics& diagnostics) {
  return load(json::parse_file(path, diagnostics), diagnostics);
}

std::unique_ptr<LoadedApplications> load_applications_text(const std::string& text, const std::string& name,
                                                           json::Diagnostics& diagnostics) {
  return load(json::parse(text, name, diagnostics), diagnostics);
}

}  // namespace takt::node
