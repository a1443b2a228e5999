// SPDX-License-Identifier: Apache-2.0
// Streams and redundancy.
#include <algorithm>

#include "tests/generator/maker.hpp"

namespace takt::generator {
namespace {

using Made = std::optional<Node>;

std::vector<std::string> receivers(const Scope& s) {
  const Node* const to = s.made->find("to");
  if (to == nullptr) return {};
  if (to->kind == json::Kind::string) return {to->text};
  std::vector<std::string> names;
  for (const Node& each : to->items) names.push_back(each.text);
  return names;
}

Node way(const std::vector<std::string>& nodes) {
  Node made = Node::array();
  for (const std::string& each : nodes) made.items.push_back(text(each));
  return made;
}

/// The same as a path, which takes the second of two links between neighbours now and then.
Node path_of(Maker& m, const std::vector<std::string>& nodes) {
  Node made = way(nodes);
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const bool has_second = m.world.forwards(nodes[i]) && m.world.forwards(nodes[i + 1]) &&
                            std::ranges::count(m.world.neighbours.at(nodes[i]), nodes[i + 1]) > 1;
    if (has_second && m.draw.one_in(2)) made.items[i] = text(nodes[i] + second_link);
  }
  return made;
}

Made to(Maker& m, const Scope& s) {
  std::vector<std::string> others = m.world.hosts;
  std::erase(others, s.text("from"));
  m.draw.shuffle(others);
  const std::size_t count = m.wants(Feature::multicast) && others.size() > 1 && !m.draw.one_in(3)
                                ? m.draw.between(2, std::min<std::size_t>(3, others.size()))
                                : 1;
  if (count == 1) return m.draw.one_in(5) ? list({text(others[0])}) : text(others[0]);
  others.resize(count);
  return way(others);
}

Made path(Maker& m, const Scope& s) {
  const std::vector<std::string> listeners = receivers(s);
  if (listeners.size() != 1) return std::nullopt;
  const std::vector<std::string> nodes = m.world.path(m.draw, s.text("from"), listeners[0]);
  if (nodes.size() < 2) return std::nullopt;
  return path_of(m, nodes);
}

bool is_redundant(Maker& m, const Scope& s) {
  const std::vector<std::string> listeners = receivers(s);
  if (listeners.size() > 1) return m.world.switches.size() > 2 && !s.has("path") && m.draw.one_in(2);  // over two trees
  return m.world.switches.size() > 2 &&
         m.world.neighbours.at(s.text("from"))[0] != m.world.neighbours.at(listeners[0])[0] && !s.has("path") &&
         !s.has("route");
}

/// Two paths that share no switch but the first and the last one; of a ladder any two.
Made paths(Maker& m, const Scope& s) {
  const Scope* const stream = s.around("stream");
  const std::vector<std::string> listeners = receivers(*stream);
  if (listeners.size() > 1) return std::nullopt;
  const std::string from = stream->text("from"), last = listeners.at(0);
  const std::vector<std::string> first = m.world.path(m.draw, from, last);
  if (first.size() < 4) return std::nullopt;
  // Those of a ladder may meet.
  const std::set<std::string> avoided =
      s.has("ladder") ? std::set<std::string>() : std::set<std::string>(first.begin() + 2, first.end() - 2);
  const std::vector<std::string> second = m.world.path(m.draw, first[1], first[first.size() - 2], avoided);
  if (second.size() < 2) return std::nullopt;
  std::vector<std::string> whole = {from};
  whole.insert(whole.end(), second.begin(), second.end());
  whole.push_back(last);
  if (whole == first) return std::nullopt;
  const bool has_ports = !s.has("ladder");
  return list({has_ports ? path_of(m, first) : way(first), has_ports ? path_of(m, whole) : way(whole)});
}

/// A place at the end of the paths.
Made end_of_paths(Maker& m, const Scope& s, bool at_talker) {
  const Scope* const stream = s.around("stream");
  if (receivers(*stream).size() > 1) return std::nullopt;
  const std::string host = at_talker ? stream->text("from") : receivers(*stream).at(0);
  return text(m.draw.one_in(2) ? host : m.world.neighbours.at(host)[0]);
}

Made every(Maker& m, const Scope&) {
  if (m.wants(Feature::automatic_gates)) return m.word("1ms 2ms");
  if (m.is_slow()) return m.word("2ms 3ms 5ms");
  // Periods with a common multiple that is far away: bounds may then forget some of the phases.
  if (!m.is_long() && m.draw.one_in(3)) return text(std::to_string(3040 * (80 + m.draw.below(400))) + "ns");
  return m.word(m.is_long() ? "1ms 2ms 5ms 3333us" : "125us 200us 250us 333us 500us 1ms");
}

Made payload(Maker& m, const Scope&) {
  if (m.kept.contains("small_buckets")) return m.word("18B 60B 100B");
  if (m.kept.contains("mtu") && m.draw.one_in(3)) return m.word("1473B 4000B 8972B");
  if (m.wants(Feature::cut_through) && m.draw.one_in(2)) return m.word("200B 900B");  // headers of one instant
  return m.word(m.is_slow() ? "18B 60B 100B 400B" : "18B 60B 100B 200B 500B 900B 1200B 1400B");
}

/// Bursts are what small buckets hold.
Made burst(Maker& m, const Scope& s) {
  if (!m.kept.contains("small_buckets") && !m.draw.one_in(2)) return std::nullopt;
  return m.object("bursts", &s);
}

}  // namespace

std::span<const Rule> traffic_rules() {
  static const Rule rules[] = {
      {.key = "scenario.streams",
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made {
         return m.streams > 0 ? Made(m.objects("stream", m.streams, s)) : std::nullopt;
       }},
      {.key = "stream.name",
       .make = [](Maker&, const Scope& s) -> Made { return text("s" + std::to_string(s.number)); }},
      {.key = "stream.from",
       .make = [](Maker& m, const Scope& s) -> Made {
         const auto shaped = m.shaped_at.find(s.text("name"));
         return text(shaped != m.shaped_at.end() ? shaped->second : m.draw.any(m.world.hosts));
       }},
      {.key = "stream.to", .make = to},
      {.key = "stream.payload", .percent = 90, .make = payload},
      {.key = "stream.encapsulation", .percent = 25},
      {.key = "stream.pcp",
       .percent = 80,
       .make = [](Maker& m, const Scope& s) -> Made {
         // What windows are laid out for comes at known times.
         return m.word(m.wants(Feature::automatic_gates) && !s.has("every") ? "0 1 2 3 4 5 7" : "0 1 2 3 4 5 6 7 6 6");
       }},
      {.key = "stream.host_priority",
       .percent = 50,
       .make = [](Maker& m, const Scope& s) -> Made {
         return s.has("pcp") || m.wants(Feature::automatic_gates) ? Made() : m.word("0 1 3 5 7");
       }},
      {.key = "stream.vlan",
       .percent = 20,
       .make = [](Maker& m, const Scope& s) -> Made { return s.has("pcp") ? m.word("0 1 10 4094") : Made(); }},
      {.key = "stream.every", .percent = 60, .make = every},
      {.key = "stream.exponential", .percent = 15},
      {.key = "stream.normal", .percent = 20},
      {.key = "stream.burst", .percent = 40, .make = burst},
      {.key = "stream.trace", .feature = Feature::traces, .percent = 50, .words = "bursts.csv steady.csv"},
      {.key = "stream.offset",
       .percent = 60,
       .make = [](Maker& m, const Scope& s) -> Made {
         if (m.wants(Feature::cut_through) && m.draw.one_in(2)) return text("0us");
         return m.word(s.has("every") ? "0us 1us 10us 37us 100us 6303712ps 143201492ps 29084018ps auto auto"
                                      : "0us 1us 10us 37us 100us 6303712ps");
       }},
      {.key = "stream.until", .percent = 8, .words = "3ms 20ms"},
      {.key = "stream.jitter",
       .percent = 20,
       .make = [](Maker& m, const Scope& s) -> Made {
         return s.has("every") && !(m.wants(Feature::automatic_gates) && s.text("pcp") == "6")
                    ? Made(m.word("10us 100us"))
                    : std::nullopt;
       }},
      {.key = "stream.launch", .feature = Feature::launch, .percent = 50, .words = "0ns 10us 100us"},
      {.key = "stream.path", .feature = Feature::explicit_path, .percent = 50, .make = path},
      {.key = "stream.route",
       .percent = 20,
       .make = [](Maker& m, const Scope& s) -> Made {
         return receivers(s).size() == 1 && !s.has("path") && !m.wants(Feature::rerouting) ? m.word("auto") : Made();
       }},
      {.key = "stream.redundancy",
       .feature = Feature::redundancy,
       .percent = 80,
       .make = [](Maker& m, const Scope& s) -> Made {
         return is_redundant(m, s) ? Made(m.short_or_object("redundancy", &s)) : std::nullopt;
       }},
      {.key = "exponential_gaps.mean",
       .make = [](Maker& m, const Scope&) -> Made {
         return m.word(m.is_slow() || m.is_long() ? "3ms 5ms" : "200us 500us 1ms");
       }},
      {.key = "normal_gaps.mean",
       .make = [](Maker& m, const Scope&) -> Made {
         return m.word(m.is_slow() || m.is_long() ? "3ms 5ms" : "300us 500us 1ms");
       }},
      {.key = "normal_gaps.deviation", .words = "1ps 20us 100us 1ms"},
      {.key = "normal_gaps.min",
       .percent = 70,
       .make = [](Maker& m, const Scope&) -> Made {
         return m.word(m.is_slow() || m.is_long() ? "0ns 1ms 2500us 3ms" : "0ns 50us 250us 300us");
       }},
      {.key = "normal_gaps.max", .percent = 50, .words = "6ms 20ms"},
      {.key = "bursts.frames", .words = "1 2 3 4 5 6"},
      {.key = "bursts.every",
       .make = [](Maker& m, const Scope&) -> Made { return m.word(m.is_slow() || m.is_long() ? "10ms" : "1ms 2ms"); }},
      {.key = "bursts.spacing", .percent = 60, .words = "0ns 6720ns 50us"},
      {.key = "redundancy.count",
       .percent = 60,
       .make = [](Maker&, const Scope& s) -> Made { return s.has("ladder") ? Made() : number(2); }},
      {.key = "redundancy.paths", .percent = 70, .make = paths},
      {.key = "redundancy.vlans",
       .percent = 20,
       .make = [](Maker&, const Scope& s) -> Made {
         return s.around("stream")->has("pcp") ? Made(list({number(101), number(102)})) : std::nullopt;
       }},
      {.key = "redundancy.ladder",
       .percent = 20,
       .make = [](Maker&, const Scope& s) -> Made {
         return receivers(*s.around("stream")).size() == 1 && !s.has("vlans") ? Made(Node::of_bool(true))
                                                                              : std::nullopt;
       }},
      {.key = "redundancy.number",
       .percent = 25,
       .make = [](Maker&, const Scope& s) -> Made {
         return receivers(*s.around("stream")).size() == 1 ? Made(text(s.around("stream")->text("from")))
                                                           : std::nullopt;
       }},
      {.key = "redundancy.split",
       .percent = 25,
       .make = [](Maker& m, const Scope& s) -> Made {
         return s.has("ladder") || s.has("number") ? Made() : end_of_paths(m, s, true);
       }},
      {.key = "redundancy.merge",
       .percent = 25,
       .make = [](Maker& m, const Scope& s) -> Made { return s.has("ladder") ? Made() : end_of_paths(m, s, false); }},
      {.key = "redundancy.history", .percent = 50, .words = "2 8 31 64"},
      {.key = "redundancy.reset_timeout", .percent = 40, .words = "200us 1ms 1s"},
      {.key = "redundancy.take_untagged", .percent = 15},
      {.key = "redundancy.latent_errors", .percent = 20},
      {.key = "latent_errors.difference", .percent = 50, .words = "0 2"},
      {.key = "latent_errors.period", .percent = 50, .words = "1ms 2s"},
      {.key = "latent_errors.reset_period", .percent = 50, .words = "2ms 30s"},
  };
  return rules;
}

}  // namespace takt::generator
