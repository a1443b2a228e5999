// SPDX-License-Identifier: Apache-2.0
// What switches do to frames that come in: identification, policing, ATS, CQF.
#include "tests/generator/maker.hpp"

namespace takt::generator {
namespace {

using Made = std::optional<Node>;

std::string named(std::string_view prefix, std::size_t n) { return std::string(prefix) + std::to_string(n); }

template <std::size_t N>
Made own_name(const char (&prefix)[N], const Scope& s) {
  return text(named(prefix, s.number));
}

bool wants_ingress(const Maker& m) {
  for (const Feature each : {Feature::policing, Feature::ats, Feature::cqf, Feature::identification})
    if (m.wants(each)) return true;
  return false;
}

/// A filter for most streams; then one by priority and one for the rest, now and then.
Made filters(Maker& m, const Scope& s) {
  Node made = Node::array();
  for (std::size_t i = 0; i < m.streams; ++i) made.items.push_back(m.object("stream_filter", &s, {}, i));
  if (m.wants(Feature::identification)) made.items.insert(made.items.begin(), m.object("stream_filter", &s, "x0", 100));
  if (made.items.empty() || m.draw.one_in(4)) made.items.push_back(m.object("stream_filter", &s, {}, 200));
  return made;
}

Made filtered_stream(Maker&, const Scope& s) {
  if (s.number == 200) return std::nullopt;
  return text(s.number == 100 ? s.name : named("s", s.number));
}

Made gate_of_filter(Maker& m, const Scope&) {
  if (m.wants(Feature::cqf) && (!m.wants(Feature::policing) || m.draw.one_in(2))) return text("cqf");
  if (!m.wants(Feature::policing)) return std::nullopt;
  return m.word("g0 g1");
}

/// For frames of any length, or in all schedulers for short ones, of which they hold some of a burst.
Made ats_burst(Maker& m, const Scope&) {
  if (!m.kept.contains("large_buckets") && !m.kept.contains("small_buckets"))
    m.kept.try_emplace(m.draw.one_in(2) ? "small_buckets" : "large_buckets", text("yes"));
  return m.word(m.kept.contains("small_buckets") ? "172B 350B 600B" : "1560B 2000B 5000B");
}

Made residence(Maker& m, const Scope&) { return m.word("100us 500us 2ms"); }

}  // namespace

std::span<const Rule> ingress_rules() {
  static const Rule rules[] = {
      {.key = "station.ingress",
       .percent = 85,
       .make = [](Maker& m, const Scope& s) -> Made {
         return wants_ingress(m) ? Made(m.object("ingress", &s)) : std::nullopt;
       }},
      {.key = "switch.ingress",
       .percent = 85,
       .make = [](Maker& m, const Scope& s) -> Made {
         return wants_ingress(m) ? Made(m.object("ingress", &s)) : std::nullopt;
       }},
      {.key = "generator.ingress",
       .percent = 85,
       .make = [](Maker& m, const Scope& s) -> Made {
         return wants_ingress(m) ? Made(m.object("ingress", &s)) : std::nullopt;
       }},
      {.key = "ingress.streams",
       .feature = Feature::identification,
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made {
         return m.objects("identified_stream", m.draw.between(1, 2), s);
       }},
      {.key = "ingress.filters", .percent = 95, .make = filters},
      {.key = "ingress.gates",
       .feature = Feature::policing,
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made { return m.objects("stream_gate", 2, s); }},
      {.key = "ingress.meters",
       .feature = Feature::policing,
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made { return m.objects("flow_meter", 2, s); }},
      {.key = "ingress.ats",
       .feature = Feature::ats,
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made { return m.objects("ats_scheduler", 3, s); }},
      {.key = "ingress.ats_groups",
       .feature = Feature::ats,
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made { return m.objects("ats_group", 1, s); }},
      {.key = "ingress.max_residence_time", .feature = Feature::ats, .percent = 30, .make = residence},
      {.key = "ingress.cqf",
       .feature = Feature::cqf,
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made {
         auto kept = m.kept.find("cqf");  // the same in all switches, but for one now and then
         if (kept == m.kept.end()) kept = m.kept.emplace("cqf", m.object("cqf", &s)).first;
         return m.draw.one_in(20) ? m.object("cqf", &s) : kept->second;
       }},
      {.key = "identified_stream.name", .make = [](Maker&, const Scope& s) -> Made { return own_name("x", s); }},
      {.key = "identified_stream.null", .percent = 40},
      {.key = "identified_stream.source", .percent = 40},
      {.key = "identified_stream.mask", .percent = 40},
      {.key = "null_identification.destination",
       .percent = 50,
       .make = [](Maker& m, const Scope&) -> Made { return text(m.draw.any(m.world.hosts)); }},
      {.key = "null_identification.stream",
       .percent = 50,
       .make = [](Maker& m, const Scope&) -> Made {
         return m.streams > 0 ? Made(text(named("s", m.draw.below(m.streams)))) : std::nullopt;
       }},
      {.key = "null_identification.vlan", .percent = 20, .words = "0 10"},
      {.key = "source_identification.source",
       .make = [](Maker& m, const Scope&) -> Made { return text(m.draw.any(m.world.hosts)); }},
      {.key = "source_identification.vlan", .percent = 20, .words = "0 10"},
      {.key = "mask_identification.destination",
       .percent = 50,
       .words = "02-00-5E-00-00-01 03-00-5E-00-00-00 00-00-00-00-00-00"},
      {.key = "mask_identification.destination_mask",
       .percent = 50,
       .words = "FF-FF-FF-00-00-00 00-00-00-00-00-01 01-00-00-00-00-00"},
      {.key = "mask_identification.source", .percent = 50, .words = "02-00-5E-00-00-01 02-00-5E-00-00-02"},
      {.key = "mask_identification.source_mask", .percent = 50, .words = "FF-FF-FF-FF-FF-FF 00-00-00-00-00-03"},
      {.key = "stream_filter.stream", .percent = 100, .make = filtered_stream},
      {.key = "stream_filter.pcp", .percent = 10, .words = "0 3 6"},
      {.key = "stream_filter.max_sdu", .feature = Feature::policing, .percent = 25, .words = "200B 600B 1400B 1506B"},
      {.key = "stream_filter.block_oversize",
       .feature = Feature::policing,
       .percent = 10,
       .make = [](Maker&, const Scope& s) -> Made {
         return s.has("max_sdu") ? Made(Node::of_bool(true)) : std::nullopt;
       }},
      {.key = "stream_filter.gate", .percent = 45, .make = gate_of_filter},
      {.key = "stream_filter.meter", .feature = Feature::policing, .percent = 40, .words = "m0 m1"},
      {.key = "stream_filter.ats", .feature = Feature::ats, .percent = 70, .words = "a0 a1 a2"},
      {.key = "stream_gate.name", .make = [](Maker&, const Scope& s) -> Made { return own_name("g", s); }},
      {.key = "stream_gate.open", .percent = 15},
      {.key = "stream_gate.ipv", .percent = 15, .words = "0 3 5 7"},
      {.key = "stream_gate.cycle", .percent = 15, .words = "300us 1ms"},
      {.key = "stream_gate.base_time", .percent = 50, .words = "0ns 13us -5us 1ms"},
      {.key = "stream_gate.running",
       .percent = 40,
       .make = [](Maker&, const Scope& s) -> Made {
         return s.has("base_time") && s.text("base_time") == "-5us" ? Made(Node::of_bool(true)) : std::nullopt;
       }},
      {.key = "stream_gate.extension", .percent = 10, .words = "20us 100us"},
      {.key = "stream_gate.entries",
       .percent = 80,
       .make = [](Maker& m, const Scope& s) -> Made {
         return m.objects("stream_gate_entry", m.draw.between(1, 3), s);
       }},
      {.key = "stream_gate.block_invalid_rx", .percent = 10, .words = "true"},
      {.key = "stream_gate.block_octets_exceeded", .percent = 10, .words = "true"},
      {.key = "stream_gate_entry.open",
       .make = [](Maker& m, const Scope& s) -> Made { return Node::of_bool(s.number == 0 || m.draw.one_in(2)); }},
      {.key = "stream_gate_entry.ipv",
       .percent = 40,
       .make = [](Maker& m, const Scope& s) -> Made {
         return s.made->find("open")->boolean ? m.word("0 1 2 3 4 5 6 7") : Made();
       }},
      {.key = "stream_gate_entry.for", .words = "40us 100us 77us"},
      {.key = "stream_gate_entry.octets",
       .percent = 20,
       .make = [](Maker& m, const Scope& s) -> Made {
         return s.made->find("open")->boolean ? m.word("1600B 6000B") : Made();
       }},
      {.key = "flow_meter.name", .make = [](Maker&, const Scope& s) -> Made { return own_name("m", s); }},
      {.key = "flow_meter.cir",
       .make = [](Maker& m, const Scope&) -> Made { return m.word(m.is_slow() ? "2Mbps" : "5Mbps 20Mbps 0bps"); }},
      {.key = "flow_meter.cbs", .words = "1600B 4000B"},
      {.key = "flow_meter.eir", .percent = 50, .words = "1Mbps 3Mbps 0bps"},
      {.key = "flow_meter.ebs", .percent = 50, .words = "1600B 0B"},
      {.key = "flow_meter.block_red", .percent = 10},
      {.key = "ats_scheduler.name", .make = [](Maker&, const Scope& s) -> Made { return own_name("a", s); }},
      {.key = "ats_scheduler.rate",
       .make = [](Maker& m, const Scope&) -> Made {
         return m.word(m.is_slow() ? "1Mbps 3Mbps" : "5Mbps 12Mbps 33333333bps");
       }},
      {.key = "ats_scheduler.burst", .make = ats_burst},
      {.key = "ats_scheduler.group", .percent = 30, .words = "all0"},
      {.key = "ats_group.name", .make = [](Maker&, const Scope& s) -> Made { return own_name("all", s); }},
      {.key = "ats_group.max_residence_time", .percent = 60, .make = residence},
      {.key = "cqf.cycle",
       .make = [](Maker& m, const Scope&) -> Made { return m.word(m.is_slow() ? "3ms" : "250us 300us"); }},
      {.key = "cqf.classes",
       .make = [](Maker& m, const Scope&) -> Made {
         return m.draw.one_in(2) ? list({number(5), number(6)}) : list({number(4), number(5), number(6)});
       }},
      {.key = "cqf.buffers",
       .percent = 30,
       .make = [](Maker&, const Scope& s) -> Made { return number(s.made->find("classes")->items.size()); }},
      {.key = "cqf.pcp",
       .percent = 70,
       .make = [](Maker& m, const Scope&)
           -> Made { return m.draw.one_in(2) ? list({number(5), number(6)}) : list({number(6)}); }},
      {.key = "cqf.base_time", .percent = 30, .words = "0ns 50us -7us"},
      {.key = "cqf.dead_time", .percent = 20, .words = "5us 10us"},
      {.key = "cqf.offset",
       .percent = 20,
       .make = [](Maker& m, const Scope& s)
           -> Made { return s.made->find("classes")->items.size() > 2 ? Made(m.word("5us 20us")) : std::nullopt; }},
  };
  return rules;
}

}  // namespace takt::generator
