// SPDX-License-Identifier: Apache-2.0
// Topics, applications, gateways and persistence services.
#include <algorithm>

#include "tests/generator/maker.hpp"

namespace takt::generator {
namespace {

using Made = std::optional<Node>;

bool wants_applications(const Maker& m) { return m.wants(Feature::opc_ua) || m.wants(Feature::dds); }

const Node& topic(const Maker& m, std::size_t number) { return m.root().find("topics")->items[number]; }
std::string name_of(const Maker& m, std::size_t number) { return topic(m, number).find("name")->text; }
bool is_dds(const Maker& m, std::size_t number) { return topic(m, number).find("protocol")->text == "dds"; }

/// With gateways and both protocols the topics take turns.
Made protocol(Maker& m, const Scope& s) {
  if (!m.wants(Feature::dds)) return text("opc-ua");
  if (!m.wants(Feature::opc_ua)) return text("dds");
  return text(s.number % 2 == 0 ? "opc-ua" : "dds");
}

bool is_of_dds(const Scope& s) { return s.text("protocol") == "dds"; }

Made fields(Maker& m, const Scope& s) {
  // A gateway finds fields by their names; the same in all topics.
  if (const auto kept = m.kept.find("fields"); kept != m.kept.end() && (m.wants(Feature::gateways) || m.draw.one_in(2)))
    return kept->second;
  Node made = Node::object();
  for (std::size_t i = 0; i < m.draw.between(1, 3) || i < 2; ++i) {
    const std::string name = "f" + std::to_string(i);
    made.add(name, m.short_or_object("topic_field", &s, name));
  }
  m.kept["fields"] = made;
  return made;
}

/// Each topic is published by one host and subscribed to by others.
Made applications(Maker& m, const Scope& s) {
  if (!wants_applications(m)) return std::nullopt;
  Node made = Node::array();
  for (std::size_t i = 0; i < m.topics + m.draw.between(0, 2); ++i)
    made.items.push_back(m.object("application", &s, {}, i));
  return made;
}

/// Application n publishes topic n, from the n-th host.
bool publishes(const Maker& m, const Scope& application) { return application.number < m.topics; }
std::size_t host_of(const Maker& m, std::size_t number) { return number % m.world.hosts.size(); }

/// The topic that it publishes, and some of those from other hosts.
Made threads(Maker& m, const Scope& s) {
  std::vector<std::size_t> others;
  for (std::size_t t = 0; t < m.topics; ++t)
    if (host_of(m, t) != host_of(m, s.number)) others.push_back(t);
  m.draw.shuffle(others);
  if (others.size() > 1) others.resize(m.draw.between(publishes(m, s) ? 0 : 1, 2));
  m.kept["subscribed"] = Node::array();
  m.kept.erase("repeats");  // what the application publishes is a counter, until it says otherwise
  for (const std::size_t t : others) m.kept["subscribed"].items.push_back(text(name_of(m, t)));
  Node made = Node::array();
  if (publishes(m, s)) made.items.push_back(m.object("thread", &s, name_of(m, s.number), 0));
  for (const std::size_t t : others) made.items.push_back(m.object("thread", &s, name_of(m, t), made.items.size()));
  return made;
}

bool is_publisher(const Maker& m, const Scope& thread) {
  return thread.number == 0 && publishes(m, *thread.around("application"));
}
Made published(Maker& m, const Scope& s) { return is_publisher(m, s) ? Made(text(s.name)) : std::nullopt; }
Made subscribed(Maker& m, const Scope& s) { return is_publisher(m, s) ? std::nullopt : Made(text(s.name)); }

std::string fields_of(const Maker& m, const std::string& name) {
  for (std::size_t i = 0; i < m.topics; ++i)
    if (name_of(m, i) == name) return json::compact(*topic(m, i).find("fields"));
  return {};
}

/// A topic with the same fields that the application subscribes to.
Made copied(Maker& m, const Scope& s) {
  const std::string own = s.around("thread")->text("publish");
  for (const Node& each : m.kept["subscribed"].items)
    if (fields_of(m, each.text) == fields_of(m, own)) {
      m.kept["repeats"] = each;
      return each;
    }
  return std::nullopt;
}
Made pattern(Maker& m, const Scope&) {
  Node made = m.word("counter alternate");
  if (made.text == "alternate") m.kept["repeats"] = made;
  return made;
}

bool uses_dds(const Maker& m, const Scope& s) {
  for (const std::string_view key : {"publish", "subscribe"})
    for (std::size_t i = 0; i < m.topics; ++i)
      if (s.text(key) == name_of(m, i)) return is_dds(m, i);
  return false;
}
bool has_keys(const Maker& m, const Scope& s) {
  const Scope* const thread = s.around("thread");
  for (std::size_t i = 0; i < m.topics; ++i)
    if (thread->text("publish") == name_of(m, i)) return topic(m, i).find("keys") != nullptr;
  return false;
}

/// DDS has numbers only, and fields may be shared by all topics. The first is a number, for patterns.
Made field_type(Maker& m, const Scope& s) {
  if (!m.wants(Feature::dds) && s.name != "f0" && m.draw.one_in(3)) return m.word("String DateTime Guid ByteString");
  return m.word("Boolean SByte Byte Int16 UInt16 Int32 UInt32 Int64 UInt64 Float Double");
}
bool has_length(const Scope& s) { return s.text("type") == "String" || s.text("type") == "ByteString"; }

/// Of the first field of the topic that is no number and single.
Made field_values(Maker& m, const Scope& s) {
  const Scope* const thread = s.around("thread");
  if (!s.has("pattern")) return std::nullopt;
  for (std::size_t i = 0; i < m.topics; ++i) {
    if (name_of(m, i) != thread->text("publish")) continue;
    for (const auto& member : topic(m, i).find("fields")->members) {
      const std::string& name = member.key;
      const Node& field = member.value;
      const std::string type = field.find("type") != nullptr ? field.find("type")->text : field.text;
      if (field.find("count") != nullptr) continue;
      Node made = Node::object();
      if (type == "String") made.add(name, text(m.draw.one_in(2) ? "a" : ""));
      if (type == "ByteString") made.add(name, text("ff"));
      if (type == "DateTime") made.add(name, text("2024-01-17T21:20:00.5Z"));
      if (type == "Guid") made.add(name, text("72962b91-fa75-4ae6-8d28-b404dc7daf63"));
      if (!made.members.empty()) return made;
    }
  }
  return std::nullopt;
}

/// Of the first field, which is a number.
Made content_filter(Maker& m, const Scope& s) {
  if (!s.has("subscribe") || !uses_dds(m, s)) return std::nullopt;
  for (std::size_t i = 0; i < m.topics; ++i) {
    if (name_of(m, i) != s.text("subscribe")) continue;
    const std::string f0 = topic(m, i).find("fields")->find("f0")->find("count") != nullptr ? "f0[0]" : "f0";
    switch (m.draw.below(4)) {
      case 0:
        return text(f0 + " > 1");
      case 1:
        return text("NOT (" + f0 + " = 0 OR " + f0 + " = 2)");
      case 2:
        return text(f0 + " BETWEEN 0 AND 3.5");
      default:
        return text(f0 + " <> " + f0);
    }
  }
  return std::nullopt;
}

/// Words as a list.
Node words(std::initializer_list<std::string_view> all) {
  std::vector<Node> items;
  for (const std::string_view each : all) items.push_back(text(each));
  return list(std::move(items));
}

/// All tell publications apart; without PublisherId by ids of the topic's own.
Made network_message(Maker& m, const Scope& s) {
  const bool has_publisher = s.has("publisher") || s.around("topic")->has("publisher_id");
  switch (m.draw.below(has_publisher ? 3 : 4)) {
    case 0:
      return words(
          {"PublisherId", "GroupHeader", "WriterGroupId", "GroupVersion", "NetworkMessageNumber", "SequenceNumber"});
    case 1:
      return words({"PublisherId", "GroupHeader", "WriterGroupId", "PayloadHeader", "Timestamp", "PicoSeconds"});
    case 2:
      return words({"PublisherId", "GroupHeader", "WriterGroupId", "SequenceNumber", "PayloadHeader"});
    default:
      return words({"GroupHeader", "WriterGroupId", "PayloadHeader"});
  }
}
bool has_payload_header(const Scope& s) {
  const Node* const parts = s.made->find("network_message");
  return parts == nullptr ||
         std::ranges::any_of(parts->items, [](const Node& each) { return each.text == "PayloadHeader"; });
}

/// Room for all fields, whatever their encoding, and whatever headers and DataValues have besides.
Made configured_size(Maker& m, const Scope& s) {
  constexpr std::uint64_t most = 1000;
  std::uint64_t octets = 40;
  for (const json::Member& member : s.around("topic")->made->find("fields")->members) {
    const Node& field = member.value;
    const auto number_of = [&field](const char* key) {
      return field.find(key) == nullptr ? std::uint64_t{0}
                                        : static_cast<std::uint64_t>(std::stoul(field.find(key)->text));
    };
    octets += 40 + std::max<std::uint64_t>(1, number_of("count")) * (20 + number_of("max_length"));
  }
  return octets > most ? std::nullopt : Made(number(octets + m.draw.below(20)));
}

Made any_host(Maker& m, const Scope&) { return text(m.draw.any(m.world.hosts)); }
Made interval(Maker& m, const Scope&) { return m.word("500us 1ms 2ms 1500us"); }
Made phase(Maker& m, const Scope&) { return m.word("0us 100us 250us 499us"); }

Made topic_of(const Maker& m, std::size_t number) {
  return number < m.topics ? Made(text(name_of(m, number))) : std::nullopt;
}

/// What the application publishes with the same fields, if it is a counter.
Made outgoing(Maker& m, const Scope& s) {
  const Scope* const application = s.around("application");
  if (!s.has("subscribe") || !publishes(m, *application) || m.kept.contains("repeats")) return std::nullopt;
  const std::string topic = name_of(m, application->number);
  return fields_of(m, topic) == fields_of(m, s.text("subscribe")) ? Made(text(topic)) : std::nullopt;
}

}  // namespace

std::span<const Rule> application_rules() {
  static const Rule rules[] = {
      {.key = "scenario.topics", .percent = 100, .make = [](Maker& m, const Scope& s) -> Made { return wants_applications(m) ? Made(m.objects("topic", m.topics, s)) : std::nullopt; }},
      {.key = "scenario.domains", .feature = Feature::dds, .percent = 40, .make = [](Maker& m, const Scope& s) -> Made { return m.objects("domain", 1, s); }},
      {.key = "scenario.applications", .percent = 100, .make = applications},
      {.key = "scenario.gateways", .feature = Feature::gateways, .percent = 100, .make = [](Maker& m, const Scope& s) -> Made { return m.objects("gateway", 1, s); }},
      {.key = "scenario.persistence", .feature = Feature::persistence, .percent = 100, .make = [](Maker& m, const Scope& s) -> Made { return m.objects("persistence", 1, s); }},
      {.key = "topic.name", .make = [](Maker&, const Scope& s) -> Made { return text("t" + std::to_string(s.number)); }},
      {.key = "topic.protocol", .make = protocol},
      {.key = "topic.fields", .make = fields},
      {.key = "topic.publisher_id", .percent = 20, .make = [](Maker&, const Scope& s) -> Made { return is_of_dds(s) ? std::nullopt : Made(number(20'000 + s.number)); }},
      {.key = "topic.uadp", .feature = Feature::opc_ua, .percent = 40, .make = [](Maker& m, const Scope& s) -> Made { return is_of_dds(s) ? std::nullopt : Made(m.object("uadp", &s, {}, s.number)); }},
      {.key = "topic_field.type", .make = field_type},
      {.key = "topic_field.count", .percent = 30, .words = "1 2 3"},
      {.key = "topic_field.max_length", .percent = 100, .make = [](Maker& m, const Scope& s) -> Made { return has_length(s) ? Made(m.word("1 5 40")) : std::nullopt; }},
      {.key = "uadp.publisher", .percent = 40, .make = [](Maker& m, const Scope& s) -> Made { return s.around("topic")->has("publisher_id") ? std::nullopt : Made(m.object("uadp_publisher", &s, {}, s.number)); }},
      {.key = "uadp_publisher.byte", .make = [](Maker& m, const Scope& s) -> Made { return m.draw.one_in(4) ? Made(number(1 + s.number)) : std::nullopt; }},
      {.key = "uadp_publisher.uint32", .percent = 100, .make = [](Maker& m, const Scope& s) -> Made { return s.has("byte") || m.draw.one_in(2) ? std::nullopt : Made(number(70'000 + s.number)); }},
      {.key = "uadp_publisher.uint64", .percent = 100, .make = [](Maker& m, const Scope& s) -> Made { return s.has("byte") || s.has("uint32") || m.draw.one_in(2) ? std::nullopt : Made(number(5'000'000'000 + s.number)); }},
      {.key = "uadp_publisher.string", .percent = 100, .make = [](Maker&, const Scope& s) -> Made { return s.has("byte") || s.has("uint32") || s.has("uint64") ? std::nullopt : Made(text("p" + std::to_string(s.number))); }},
      {.key = "uadp.writer_group_id", .percent = 100, .make = [](Maker&, const Scope& s) -> Made { return number(1 + 100 * s.number); }},
      {.key = "uadp.data_set_writer_id", .percent = 30, .words = "1 7 65535"},
      {.key = "uadp.network_message", .percent = 60, .make = network_message},
      {.key = "uadp.data_set_message", .percent = 40, .make = [](Maker& m, const Scope&) -> Made { return m.draw.one_in(2) ? words({"Timestamp", "PicoSeconds", "Status", "MajorVersion", "MinorVersion", "SequenceNumber"}) : words({"Status", "SequenceNumber"}); }},
      {.key = "uadp.encoding", .percent = 60},
      {.key = "uadp.data_value", .percent = 60, .make = [](Maker& m, const Scope& s) -> Made { return s.text("encoding") != "DataValue" ? Made() : m.draw.one_in(2) ? words({"SourceTimestamp", "SourcePicoSeconds", "StatusCode"}) : words({"ServerPicoSeconds", "ServerTimestamp"}); }},
      {.key = "uadp.key_frame_count", .percent = 60, .make = [](Maker& m, const Scope& s) -> Made { return s.text("encoding") != "RawData" && has_payload_header(s) ? Made(m.word("2 5")) : std::nullopt; }},
      {.key = "uadp.group_version", .percent = 20, .words = "0 760000000"},
      {.key = "uadp.major_version", .percent = 20, .words = "0 760000001"},
      {.key = "uadp.configured_size", .percent = 20, .make = configured_size},
      {.key = "uadp.minor_version", .percent = 20, .words = "0 760000002"},
      {.key = "topic.pcp", .percent = 60, .words = "0 2 4 5"},
      {.key = "topic.vlan", .percent = 20, .make = [](Maker& m, const Scope& s) -> Made { return s.has("pcp") ? m.word("0 10") : Made(); }},
      {.key = "topic.keys", .feature = Feature::dds, .percent = 30, .make = [](Maker&, const Scope& s) -> Made { return is_of_dds(s) ? Made(list({text("f0")})) : std::nullopt; }},
      {.key = "topic.type", .feature = Feature::dds, .percent = 20, .make = [](Maker& m, const Scope& s) -> Made { return is_of_dds(s) ? Made(m.word("Plant::Order Sample")) : std::nullopt; }},
      {.key = "topic.domain", .feature = Feature::dds, .percent = 20, .make = [](Maker& m, const Scope& s) -> Made { return is_of_dds(s) ? Made(number(m.draw.below(2))) : std::nullopt; }},
      {.key = "topic.qos", .feature = Feature::dds, .percent = 100, .make = [](Maker& m, const Scope& s) -> Made { return is_of_dds(s) && (m.wants(Feature::persistence) || m.draw.one_in(2)) ? Made(m.object("qos", &s)) : std::nullopt; }},
      {.key = "topic.publication", .feature = Feature::dds, .percent = 40, .make = [](Maker& m, const Scope& s) -> Made { return is_of_dds(s) ? Made(m.word("synchronous asynchronous")) : std::nullopt; }},
      {.key = "topic.flow_control", .feature = Feature::dds, .percent = 40, .make = [](Maker& m, const Scope& s) -> Made { return s.text("publication") == "asynchronous" ? Made(m.object("flow_control", &s)) : std::nullopt; }},
      {.key = "flow_control.octets", .words = "500 2000"},
      {.key = "flow_control.every", .words = "100us 1ms"},
      {.key = "qos.reliability", .percent = 60},
      {.key = "qos.max_blocking_time", .percent = 15, .words = "0us 1ms 100ms"},
      {.key = "qos.durability", .percent = 100, .make = [](Maker& m, const Scope& s) -> Made {
         if (m.wants(Feature::persistence) && s.around("thread") == nullptr) return m.word("transient persistent");
         return m.draw.one_in(3) ? m.word("volatile transient-local") : Made();
       }},
      {.key = "qos.history", .percent = 30},
      {.key = "qos.depth", .percent = 30, .make = [](Maker& m, const Scope& s) -> Made { return s.text("history") != "keep-all" ? Made(m.word("1 4")) : std::nullopt; }},
      {.key = "qos.deadline", .percent = 15, .words = "2ms 5ms"},
      {.key = "qos.latency_budget", .percent = 15, .words = "0us 100us"},
      {.key = "qos.liveliness", .percent = 15},
      {.key = "qos.lease_duration", .percent = 15, .words = "5ms 100ms"},
      {.key = "qos.ownership", .percent = 15},
      {.key = "qos.ownership_strength", .percent = 15, .make = [](Maker& m, const Scope& s) -> Made { return s.text("ownership") == "exclusive" ? Made(number(m.draw.below(5))) : std::nullopt; }},
      {.key = "qos.lifespan", .percent = 15, .words = "1ms 10ms"},
      {.key = "qos.time_based_filter", .percent = 15, .words = "0us 1ms"},
      {.key = "qos.destination_order", .percent = 15},
      {.key = "qos.resource_limits", .percent = 20},
      {.key = "qos.durability_service", .percent = 30},
      {.key = "qos.partition", .percent = 15, .make = [](Maker& m, const Scope&) -> Made { return m.draw.one_in(2) ? list({text("cell*")}) : list({text("cell1"), text("")}); }},
      {.key = "resource_limits.max_samples", .percent = 50, .words = "8 100"},
      {.key = "resource_limits.max_instances", .percent = 50, .words = "4 8"},
      {.key = "resource_limits.max_samples_per_instance", .percent = 50, .words = "4 8"},
      {.key = "durability_service.cleanup_delay", .words = "0us 1ms"},
      {.key = "durability_service.history"},
      {.key = "durability_service.depth", .words = "1 3"},
      {.key = "durability_service.resource_limits"},
      {.key = "domain.id", .make = [](Maker& m, const Scope&) -> Made {
         for (std::size_t i = 0; i < m.topics; ++i)
           if (is_dds(m, i)) return topic(m, i).find("domain") != nullptr ? *topic(m, i).find("domain") : number(0);
         return number(0);
       }},
      {.key = "domain.discovery", .percent = 70},
      {.key = "domain.server", .percent = 100, .make = [](Maker&, const Scope& s) -> Made { return s.text("discovery") == "server" ? Made(text("a0")) : std::nullopt; }},
      {.key = "domain.announce_every", .percent = 60, .words = "1ms 2ms 10ms"},
      {.key = "domain.multicast", .percent = 40},
      {.key = "domain.lease_duration", .percent = 60, .make = [](Maker& m, const Scope& s) -> Made { return s.has("announce_every") ? m.word("20ms 1s") : Made(); }},
      {.key = "application.name", .make = [](Maker&, const Scope& s) -> Made { return text("a" + std::to_string(s.number)); }},
      {.key = "application.on", .make = [](Maker& m, const Scope& s) -> Made { return text(m.world.hosts[host_of(m, s.number)]); }},
      {.key = "application.threads", .make = threads},
      {.key = "application.scheduler", .percent = 50},
      {.key = "scheduler.window", .percent = 60, .words = "2ms 4ms 5ms"},
      {.key = "scheduler.after", .percent = 40, .words = "0us 1ms 2ms"},
      {.key = "scheduler.tests", .percent = 20, .words = "1 3"},
      {.key = "scheduler.response", .percent = 20},
      {.key = "scheduler.tolerance", .percent = 20, .words = "10us 1ms"},
      {.key = "thread.name", .make = [](Maker&, const Scope& s) -> Made { return text("th" + std::to_string(s.number)); }},
      {.key = "thread.publish", .percent = 60, .make = published},
      {.key = "thread.subscribe", .percent = 60, .make = subscribed},
      {.key = "thread.every", .make = interval},
      {.key = "thread.offset", .percent = 60, .make = phase},
      {.key = "thread.response", .percent = 50},
      {.key = "thread.tests", .percent = 15, .words = "1 3"},
      {.key = "thread.payload", .percent = 50, .make = [](Maker& m, const Scope& s) -> Made { return s.has("publish") ? Made(m.short_or_object("payload", &s)) : std::nullopt; }},
      {.key = "thread.buffer", .percent = 40, .make = [](Maker& m, const Scope& s) -> Made { return s.has("subscribe") ? Made(m.word("1 4")) : std::nullopt; }},
      {.key = "thread.signal", .feature = Feature::signals, .percent = 80, .make = [](Maker& m, const Scope& s) -> Made { return s.has("subscribe") ? Made(m.short_or_object("signal", &s, s.around("application")->text("name") + "-" + s.text("name"))) : std::nullopt; }},
      {.key = "thread.filter", .feature = Feature::dds, .percent = 25, .make = content_filter},
      {.key = "thread.round_trip", .percent = 30, .make = outgoing},
      {.key = "thread.qos", .percent = 20, .make = [](Maker& m, const Scope& s) -> Made { return uses_dds(m, s) ? Made(m.object("qos", &s)) : std::nullopt; }},
      {.key = "payload.pattern", .percent = 60, .make = pattern},
      {.key = "payload.copy_of", .percent = 60, .make = copied},
      {.key = "payload.instance", .percent = 30, .make = [](Maker& m, const Scope& s) -> Made { return !s.has("copy_of") && has_keys(m, s) ? Made(number(m.draw.below(3))) : std::nullopt; }},
      {.key = "payload.values", .percent = 70, .make = field_values},
      {.key = "payload.instances", .percent = 50, .make = [](Maker& m, const Scope& s) -> Made { return !s.has("copy_of") && has_keys(m, s) ? Made(number(m.draw.between(1, 3))) : std::nullopt; }},
      {.key = "signal.name", .make = [](Maker&, const Scope& s) -> Made { return text("out-" + s.name); }},
      {.key = "signal.pulse", .percent = 40, .words = "500us 1ms"},
      {.key = "gateway.name", .make = [](Maker&, const Scope& s) -> Made { return text("g" + std::to_string(s.number)); }},
      {.key = "gateway.on", .make = any_host},
      {.key = "gateway.from", .make = [](Maker& m, const Scope&) -> Made { return topic_of(m, m.draw.below(2)); }},
      {.key = "gateway.to", .make = [](Maker& m, const Scope& s) -> Made { return topic_of(m, s.text("from") == name_of(m, 0) ? 1 : 0); }},
      {.key = "gateway.receive_every", .make = interval},
      {.key = "gateway.receive_offset", .percent = 50, .make = phase},
      {.key = "gateway.receive_response", .percent = 40},
      {.key = "gateway.send_every", .make = interval},
      {.key = "gateway.send_offset", .percent = 50, .make = phase},
      {.key = "gateway.send_response", .percent = 40},
      {.key = "gateway.buffer", .percent = 50, .words = "1 4"},
      {.key = "gateway.overflow", .percent = 50},
      {.key = "gateway.stale_after", .percent = 30, .words = "1ms 10ms"},
      {.key = "gateway.scheduler", .percent = 30},
      {.key = "persistence.name", .make = [](Maker&, const Scope& s) -> Made { return text("k" + std::to_string(s.number)); }},
      {.key = "persistence.on", .make = [](Maker& m, const Scope&) -> Made { return text(m.world.hosts.back()); }},
      {.key = "persistence.topics", .make = [](Maker& m, const Scope&) -> Made {
         Node made = Node::array();
         for (std::size_t i = 0; i < m.topics; ++i)
           if (is_dds(m, i)) made.items.push_back(text(name_of(m, i)));
         return made;
       }},
  };
  return rules;
}

}  // namespace takt::generator
