// SPDX-License-Identifier: Apache-2.0
// What ports do: gates, shapers, preemption and the rest of "egress"; the gates of a whole network.
#include <algorithm>

#include "tests/generator/maker.hpp"

namespace takt::generator {
namespace {

using Made = std::optional<Node>;

Node numbers(const std::vector<int>& values) {
  Node made = Node::array();
  for (const int value : values) made.items.push_back(number(static_cast<std::uint64_t>(value)));
  return made;
}

bool to_hosts(Maker& m, const Scope& s) {
  return s.has("to") ? !m.world.forwards(s.text("to")) : m.world.switches.size() == 1;
}

std::vector<int> taken(const Scope& s, std::string_view key) {
  std::vector<int> values;
  const Node* const there = s.made->find(key);
  if (there == nullptr) return values;
  for (const Node& each : there->items) {
    const Node* const value = each.kind == json::Kind::object ? each.find("class") : &each;
    values.push_back(std::stoi(value->text));
  }
  return values;
}

bool wants_egress(const Maker& m) {
  for (const Feature each : {Feature::gates, Feature::hold, Feature::shapers, Feature::ets, Feature::max_sdu,
                             Feature::preemption, Feature::cut_through, Feature::untagged, Feature::ats})
    if (m.wants(each)) return true;
  return false;
}

/// One entry for all ports, and some for single neighbours.
Made egress_of_switch(Maker& m, const Scope& s) {
  if (!wants_egress(m)) return std::nullopt;
  Node made = Node::array();
  const bool apart =
      m.wants(Feature::cut_through) && m.wants(Feature::untagged);  // they meet at one switch, but not at one port
  if (!apart && !m.draw.one_in(4)) made.items.push_back(m.object("egress", &s, s.name, 0));
  const auto known = m.world.neighbours.find(s.name);
  if (known != m.world.neighbours.end()) {
    std::set<std::string> seen;
    for (std::size_t n = 0; n < known->second.size(); ++n)
      if ((apart || made.items.empty() || m.draw.one_in(3)) && seen.insert(known->second[n]).second)
        made.items.push_back(m.object("egress", &s, s.name, n + 1));
  }
  std::erase_if(made.items,
                [](const Node& each) { return each.members.size() == (each.find("to") != nullptr ? 1u : 0u); });
  if (made.items.empty()) return std::nullopt;
  return made;
}

/// An entry says what its place in the list is: 0 is for all ports.
Made egress_to(Maker& m, const Scope& s) {
  if (s.number == 0) return std::nullopt;
  return text(m.world.neighbours.at(s.name).at(s.number - 1));
}

bool has_cqf(const Scope& s) { return s.around("switch") != nullptr || s.around("generator") != nullptr; }

Made entries_of_gates(Maker& m, const Scope& s) {
  std::vector<Node> entries;
  const std::size_t count = m.draw.below(4);
  for (std::size_t i = 0; i < count; ++i) entries.push_back(m.object("gate_entry", &s, {}, i));
  // One that is open to all, long enough for the longest frame.
  entries.push_back(m.object("gate_entry", &s, {}, 100));
  if (m.draw.one_in(2)) entries.push_back(m.object("gate_entry", &s, {}, count));
  return list(std::move(entries));
}

Made shaped_classes(Maker& m, const Scope& s) {
  Node made = Node::array();
  const std::vector<int> some = m.classes(3);
  for (const int q : some.empty() ? std::vector<int>{static_cast<int>(m.draw.below(8))} : some)
    made.items.push_back(m.object("shaper", &s, {}, static_cast<std::size_t>(q)));
  return made;
}

/// Two classes or more without another algorithm; of a host that launches frames none. The number of a share holds its
/// class and percentage.
Made shares(Maker& m, const Scope& s) {
  if (s.around("host") != nullptr && m.wants(Feature::launch)) return std::nullopt;
  std::vector<int> others = taken(s, "shapers");
  for (const int q : taken(s, "ats")) others.push_back(q);
  const std::vector<int> some = m.classes(2, others);
  if (some.size() < 2) return std::nullopt;
  Node made = Node::array();
  std::size_t left = 100;
  for (std::size_t i = 0; i < some.size(); ++i) {
    const std::size_t share = i + 1 == some.size() ? left : 1 + m.draw.below(left - (some.size() - i - 1));
    made.items.push_back(m.object("share", &s, {}, static_cast<std::size_t>(some[i]) * 1000 + share));
    left -= share;
  }
  return made;
}

/// All classes of a host that shapes a stream, which is to be its own; none if it launches frames or shapes them
/// otherwise.
Made talker_classes(Maker& m, const Scope& s, const std::string& host) {
  if (m.wants(Feature::launch) || !taken(s, "shapers").empty() || m.streams == 0) return std::nullopt;
  if (!m.shaped_at.try_emplace("s" + std::to_string(m.draw.below(m.streams)), host).second) return std::nullopt;
  return numbers({0, 1, 2, 3, 4, 5, 6, 7});
}

Made talker_schedulers(Maker& m, const Scope& s) {
  Node made = Node::array();
  for (const auto& [stream, host] : m.shaped_at)
    if (host == s.name) made.items.push_back(m.object("talker_ats", &s, stream));
  if (made.items.empty()) return std::nullopt;
  return made;
}
/// A stream that it will send, if no other talker has it; the class may not be one of its ports, which is refused.
Made station_schedulers(Maker& m, const Scope& s) {
  if (m.wants(Feature::launch) || m.streams == 0) return std::nullopt;
  const Node* const egress = s.made->find("egress");
  if (egress == nullptr || egress->items.empty() || egress->items[0].find("ats") == nullptr) return std::nullopt;
  const std::string stream = "s" + std::to_string(m.draw.below(m.streams));
  if (!m.shaped_at.try_emplace(stream, s.name).second) return std::nullopt;
  return list({m.object("talker_ats", &s, stream)});
}

/// Classes that share bandwidth are all preemptable or all express.
Made preemptable_classes(Maker& m, const Scope& s) {
  const std::vector<int> shared = taken(*s.around("egress"), "ets");
  std::vector<int> without = shared;
  if (m.wants(Feature::gptp)) without.push_back(7);  // gPTP has priority 7
  const bool may_share = !m.wants(Feature::gptp) || std::ranges::find(shared, 7) == shared.end();
  std::vector<int> some = m.classes(2, without);
  if (!shared.empty() && may_share && (some.empty() || m.draw.one_in(2)))
    some.insert(some.end(), shared.begin(), shared.end());
  for (int q = 0; q < 8 && some.size() < (shared.empty() ? 2 : 1); ++q)
    if (std::ranges::find(without, q) == without.end()) some.push_back(q);
  return numbers(some);
}

Made own_number(Maker&, const Scope& s) { return number(s.number); }

Made port_of_a_node(Maker& m, const Scope&) {
  return text(m.draw.any(!m.world.switches.empty() && !m.draw.one_in(6) ? m.world.switches : m.world.nodes()));
}
Made neighbour_of_node(Maker& m, const Scope& s) { return text(m.draw.any(m.world.neighbours.at(s.text("node")))); }

}  // namespace

std::span<const Rule> port_rules() {
  static const Rule rules[] = {
      {.key = "switch.egress", .percent = 90, .make = egress_of_switch},
      {.key = "station.egress", .percent = 90, .make = egress_of_switch},
      {.key = "host.egress",
       .percent = 30,
       .make = [](Maker& m, const Scope& s) -> Made {
         if (!wants_egress(m)) return std::nullopt;
         Node made = m.object("egress", &s, s.name, 0);
         if (made.members.empty()) return std::nullopt;
         return list({std::move(made)});
       }},
      {.key = "host.ats", .feature = Feature::ats, .percent = 100, .make = talker_schedulers},
      {.key = "station.ats", .feature = Feature::ats, .percent = 40, .make = station_schedulers},
      {.key = "talker_ats.stream", .make = [](Maker&, const Scope& s) -> Made { return text(s.name); }},
      {.key = "talker_ats.rate",
       .make = [](Maker& m, const Scope&) -> Made {
         return m.word(m.is_slow() ? "1Mbps 3Mbps" : "4Mbps 12Mbps 33333333bps");
       }},
      {.key = "talker_ats.burst", .words = "1560B 2000B 5000B"},
      {.key = "generator.egress",
       .percent = 60,
       .make = [](Maker& m, const Scope& s) -> Made {
         if (!wants_egress(m)) return std::nullopt;
         Node made = m.object("egress", &s, {}, 0);
         if (made.members.empty()) return std::nullopt;
         return list({std::move(made)});
       }},
      {.key = "egress.to", .percent = 100, .make = egress_to},
      {.key = "egress.gates",
       .feature = Feature::gates,
       .percent = 75,
       .make = [](Maker& m, const Scope& s) -> Made {
         if (m.wants(Feature::cqf) && has_cqf(s) && !m.draw.one_in(20))
           return std::nullopt;  // CQF makes the gates of a switch
         return m.object("gates", &s);
       }},
      {.key = "egress.shapers", .feature = Feature::shapers, .percent = 75, .make = shaped_classes},
      {.key = "egress.max_sdu",
       .feature = Feature::max_sdu,
       .percent = 75,
       .make = [](Maker& m, const Scope& s) -> Made {
         Node made = Node::array();
         const std::size_t first = m.draw.below(8);
         made.items.push_back(m.object("max_sdu", &s, {}, first));
         if (m.draw.one_in(2)) made.items.push_back(m.object("max_sdu", &s, {}, (first + 1) % 8));
         return made;
       }},
      {.key = "egress.ats",
       .feature = Feature::ats,
       .percent = 80,
       .make = [](Maker& m, const Scope& s) -> Made {
         if (const Scope* const host = s.around("host")) return talker_classes(m, s, host->name);
         const std::vector<int> some = m.classes(2, taken(s, "shapers"));
         if (some.empty()) return std::nullopt;
         return numbers(some);
       }},
      {.key = "egress.ets", .feature = Feature::ets, .percent = 80, .make = shares},
      {.key = "egress.preemption", .feature = Feature::preemption, .percent = 80},
      {.key = "egress.cut_through",
       .feature = Feature::cut_through,
       .percent = 80,
       .make = [](Maker& m, const Scope& s) -> Made {
         if (s.around("host") != nullptr) return std::nullopt;
         // A port that strips tags does not cut through: one that may does not take what the other feature needs.
         if (m.wants(Feature::untagged) && to_hosts(m, s) && m.draw.one_in(2)) return std::nullopt;
         std::vector<int> others = taken(s, "ats");
         if (const Node* const preemption = s.made->find("preemption"))
           for (const Node& each : preemption->find("preemptable")->items) others.push_back(std::stoi(each.text));
         const std::vector<int> some = m.classes(2, others);
         if (some.empty()) return std::nullopt;
         return numbers(some);
       }},
      {.key = "egress.untagged",
       .feature = Feature::untagged,
       .percent = 80,
       .make = [](Maker& m, const Scope& s) -> Made {
         // Ports to hosts only.
         if (!to_hosts(m, s) || s.has("cut_through")) return std::nullopt;
         return Node::of_bool(true);
       }},
      {.key = "gates.cycle",
       .percent = 15,
       .make = [](Maker& m, const Scope&) -> Made {
         return m.word(m.is_slow() ? "3ms 5ms" : "500us 700us 1ms 1234567ps");
       }},
      {.key = "gates.base_time", .percent = 50, .words = "0ns -1ms 37us 500us -123456789ps"},
      {.key = "gates.running",
       .percent = 40,
       .make = [](Maker&, const Scope& s) -> Made {
         // Of the lists with which a node starts, and that may have begun.
         const bool is_set_later =
             s.around("script_entry") != nullptr || (s.has("base_time") && s.text("base_time").front() != '-');
         return is_set_later ? Made() : Made(Node::of_bool(true));
       }},
      {.key = "gates.extension", .percent = 20, .words = "20us 100us 1ms"},
      {.key = "gates.entries", .make = entries_of_gates},
      {.key = "gate_entry.open",
       .make = [](Maker& m, const Scope& s) -> Made {
         if (s.number != 100) return numbers(m.classes(2));
         std::vector<int> open = {0, 1, 2, 3, 4, 5, 6, 7};
         if (m.wants(Feature::gptp) && m.draw.one_in(12))
           open.pop_back();  // gPTP waits for ever, unless another entry opens its class
         return numbers(open);
       }},
      {.key = "gate_entry.for",
       .make = [](Maker& m, const Scope& s) -> Made {
         if (s.number == 100) return m.word(m.is_slow() ? "1300us" : "130us 125us 200us");
         return m.word("5us 10us 20us 50us 12360ns 123360ns 1ns");
       }},
      {.key = "gate_entry.mac", .feature = Feature::hold, .percent = 60},
      {.key = "shaper.class", .make = own_number},
      {.key = "shaper.idle_slope",
       .make = [](Maker& m, const Scope&) -> Made {
         // Over a whole cycle of which the gate is open for a part a slope is several times as steep.
         bool gated = false;
         for (const Feature each : {Feature::gates, Feature::hold, Feature::cqf, Feature::set_gates,
                                    Feature::automatic_gates, Feature::listed_gates})
           gated |= m.wants(each);
         return m.word(m.is_slow() ? "1Mbps 1500kbps 2Mbps"
                       : gated     ? "3Mbps 7Mbps 10Mbps 10666667bps"
                                   : "10Mbps 33Mbps 7Mbps 20Mbps 75Mbps");
       }},
      {.key = "share.class", .make = [](Maker&, const Scope& s) -> Made { return number(s.number / 1000); }},
      {.key = "share.bandwidth", .make = [](Maker&, const Scope& s) -> Made { return number(s.number % 1000); }},
      {.key = "max_sdu.class", .make = own_number},
      {.key = "max_sdu.size", .words = "100B 500B 1000B 1500B"},
      {.key = "preemption.preemptable", .make = preemptable_classes},
      {.key = "preemption.add_frag_size", .percent = 50, .words = "0 1 2 3"},
      {.key = "preemption.hold_advance", .percent = 25, .words = "0ns 5us 30us"},
      {.key = "preemption.release_advance", .percent = 25, .words = "1us 10us"},
      {.key = "scenario.gates",
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made {
         if (!m.wants(Feature::automatic_gates) && !m.wants(Feature::listed_gates))
           return m.draw.one_in(20) ? Made(text("none")) : std::nullopt;
         return m.short_or_object("network_gates", &s);
       }},
      {.key = "network_gates.plan",
       .percent = 100,
       .make = [](Maker& m, const Scope&) -> Made {
         return text(m.wants(Feature::automatic_gates) ? "auto" : "listed");
       }},
      // Not "auto": `takt schedule` settles it, and other commands refuse it.
      {.key = "network_gates.margin", .feature = Feature::automatic_gates, .percent = 40, .words = "0ns 100ns 1us"},
      {.key = "network_gates.classes",
       .feature = Feature::automatic_gates,
       .percent = 100,
       .make = [](Maker& m, const Scope&) -> Made {
         // Those of the programs, if there are programs.
         return m.groups.empty() || m.draw.one_in(2) ? Made(numbers({6})) : std::nullopt;
       }},
      {.key = "network_gates.guard", .feature = Feature::automatic_gates, .percent = 40},
      {.key = "network_gates.lists",
       .feature = Feature::listed_gates,
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made {
         Node made = Node::array();
         std::set<std::string> ports;
         for (std::size_t i = 0; i < 3; ++i) {
           Node each = m.object("set_gates", &s);
           if (ports.insert(each.find("node")->text).second) made.items.push_back(std::move(each));
         }
         return made;
       }},
      {.key = "set_gates.node", .make = port_of_a_node},
      {.key = "set_gates.to", .percent = 50, .make = neighbour_of_node},
      {.key = "set_gates.gates"},
  };
  return rules;
}

}  // namespace takt::generator
