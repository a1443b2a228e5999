// SPDX-License-Identifier: Apache-2.0
// What the run must show: limits around what happens, so that some hold and some do not.
#include "tests/generator/maker.hpp"

namespace takt::generator {
namespace {

using Made = std::optional<Node>;

std::string any_name(Maker& m, std::string_view key) {
  const Node* const there = m.root().find(key);
  return there == nullptr ? std::string() : m.draw.any(there->items).find("name")->text;
}

/// A stream, or a stream of a program.
Made stream(Maker& m, const Scope&) {
  const bool has_programs = m.root().find("programs") != nullptr;
  if (has_programs && (m.streams == 0 || m.draw.one_in(2))) {
    const Node& program = m.draw.any(m.root().find("programs")->items);
    if (program.find("slaves") != nullptr)
      return text(program.find("name")->text + "/state/" + m.draw.any(program.find("slaves")->items).text);
  }
  return m.streams > 0 ? Made(text("s" + std::to_string(m.draw.below(m.streams)))) : std::nullopt;
}

Made of_program(Maker& m, const Scope& s) {
  if (!s.has("reaction")) return std::nullopt;
  return text(s.has("tree") ? "p0" : any_name(m, "programs"));
}

/// An application or gateway and one of its limits.
Made application(Maker& m, const Scope&) {
  const bool of_gateway = m.root().find("gateways") != nullptr && m.draw.one_in(3);
  const std::string name = any_name(m, of_gateway ? "gateways" : "applications");
  return name.empty() ? std::nullopt : Made(text(name));
}

/// Whether a thread of it has a content filter: how many values it lets pass nobody knows.
bool filters(const Maker& m, const std::string& application) {
  const Node* const applications = m.root().find("applications");
  if (applications == nullptr) return false;
  for (const Node& each : applications->items)
    for (const Node& thread : each.find("threads")->items)
      if (each.find("name")->text == application && thread.find("filter") != nullptr) return true;
  return false;
}

/// All, or some.
Made clocks(Maker& m, const Scope&) {
  if (!m.wants(Feature::gptp) && !m.wants(Feature::oscillators)) return std::nullopt;
  const std::vector<std::string> all = m.world.nodes();
  if (all.size() < 2 || m.draw.one_in(3)) return text("*");
  Node made = Node::array();
  for (const std::string& name : m.draw.some(all, m.draw.between(2, std::min<std::size_t>(all.size(), 4))))
    made.items.push_back(text(name));
  return made;
}

Made signal(Maker& m, const Scope&) {
  std::vector<std::string> names;
  if (const Node* const applications = m.root().find("applications"))
    for (const Node& each : applications->items)
      for (const Node& thread : each.find("threads")->items)
        if (const Node* const found = thread.find("signal"))
          names.push_back(found->kind == json::Kind::string ? found->text : found->find("name")->text);
  return names.empty() ? std::nullopt : Made(text(m.draw.any(names)));
}

Made figure(Maker& m, const Scope&) {
  if (m.wants(Feature::processors) && m.draw.one_in(2))
    return m.word("/cpus/*/threads/*/response_ps/max /cpus/*/threads/*/late /cpus/*/threads/*/refused");
  return m.word(
      m.root().find("programs") != nullptr
          ? "reaction.start.max dropped delivered latency.max queue utilisation /programs/*/reactions/*/duration_ps"
          : "dropped delivered latency.max latency.mean queue utilisation events /streams/*/sent /ports/*/frames");
}

bool is_time(const Scope& s) {
  const std::string figure = s.text("figure");
  return (figure.starts_with("latency") || figure.starts_with("reaction") || figure.ends_with("_ps") ||
          figure.find("_ps/") != std::string::npos) &&
         s.text("take") != "count";
}

bool asks_for_several(const Scope& s) { return s.has("stream") || s.has("reaction"); }

Made limit_of_figure(Maker& m, const Scope& s) {
  if (!s.has("figure")) return std::nullopt;
  if (is_time(s) && !s.has("unit")) return m.word("100us 5ms 1s");
  return Node::of_literal(m.draw.word("0 1 10 1000 0.5"));
}

}  // namespace

std::span<const Rule> requirement_rules() {
  static const Rule rules[] = {
      {.key = "scenario.require",
       .percent = 90,
       .make = [](Maker& m, const Scope& s) -> Made { return m.objects("requirement", m.draw.between(1, 4), s); }},
      {.key = "requirement.name",
       .percent = 30,
       .make = [](Maker&, const Scope& s) -> Made { return text("REQ-" + std::to_string(s.number)); }},
      {.key = "requirement.reaction",
       .percent = 80,
       .make = [](Maker& m, const Scope&) -> Made {
         return m.root().find("programs") != nullptr ? m.word("start start halt suspend resume reset") : Made();
       }},
      {.key = "requirement.cause",
       .percent = 40,
       .make = [](Maker& m, const Scope& s) -> Made {
         if (!s.has("reaction")) return std::nullopt;
         return m.word(s.text("reaction") == "halt" ? "command crash restart cut silence leave mismatch nested"
                                                    : "command nested");
       }},
      {.key = "requirement.stream", .percent = 70, .make = stream},
      {.key = "requirement.sync",
       .percent = 60,
       .make = [](Maker& m, const Scope&) -> Made {
         return m.wants(Feature::gptp) ? m.word("100ns 1us 100us 1s") : Made();
       }},
      {.key = "requirement.clocks", .percent = 40, .make = clocks},
      {.key = "requirement.application", .percent = 60, .make = application},
      {.key = "requirement.signal", .percent = 40, .make = signal},
      {.key = "requirement.figure", .percent = 15, .make = figure},
      {.key = "requirement.program", .percent = 60, .make = of_program},
      {.key = "requirement.within",
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made {
         if (s.has("clocks")) return m.word("100ns 1us 100us 1s");
         return s.has("reaction") ? m.word("500us 2ms 5ms 1s") : Made();
       }},
      {.key = "requirement.tree",
       .feature = Feature::nesting,
       .percent = 40,
       .make = [](Maker&, const Scope& s) -> Made {
         return s.text("program") == "p0" ? Made(Node::of_bool(true)) : std::nullopt;
       }},
      {.key = "requirement.latency",
       .percent = 70,
       .make = [](Maker& m, const Scope& s) -> Made {
         if (!s.has("stream")) return std::nullopt;
         return m.draw.one_in(4) ? Made(m.object("duration_limit", &s)) : m.word("20us 100us 500us 2ms 1s");
       }},
      {.key = "duration_limit.at_most",
       .percent = 100,
       .make = [](Maker& m, const Scope&) -> Made { return m.word("20us 500us 1s"); }},
      {.key = "duration_limit.equal",
       .percent = 100,
       .make = [](Maker& m, const Scope&) -> Made { return m.word("20us 100us"); }},
      {.key = "duration_limit.within",
       .percent = 80,
       .make = [](Maker& m, const Scope& s) -> Made { return s.has("equal") ? m.word("0ns 10us 1s") : Made(); }},
      {.key = "requirement.jitter",
       .percent = 30,
       .make = [](Maker& m, const Scope& s) -> Made {
         return s.has("stream") ? m.word("0us 20us 200us 5ms") : Made();
       }},
      {.key = "requirement.dropped",
       .percent = 40,
       .make = [](Maker& m, const Scope& s) -> Made {
         return s.has("stream") ? Made(number(m.draw.one_in(2) ? 0 : 5)) : std::nullopt;
       }},
      {.key = "requirement.delivered",
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made {
         if (!s.has("stream")) return std::nullopt;
         const bool has_other = s.has("latency") || s.has("jitter") || s.has("dropped");
         return !has_other || m.draw.one_in(4) ? m.word("1 5 1000") : Made();
       }},
      {.key = "requirement.lost_in_a_row",
       .percent = 15,
       .make = [](Maker& m, const Scope& s) -> Made { return s.has("stream") ? m.word("0 1 3") : Made(); }},
      {.key = "requirement.late_in_a_row",
       .percent = 15,
       .make = [](Maker& m, const Scope& s) -> Made { return asks_for_several(s) ? m.word("0 1 2") : Made(); }},
      {.key = "requirement.met",
       .percent = 15,
       .make = [](Maker& m, const Scope& s) -> Made { return asks_for_several(s) ? m.word("0 1 3") : Made(); }},
      {.key = "requirement.of",
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made { return s.has("met") ? m.word("3 4 10") : Made(); }},
      {.key = "requirement.deadline",
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made {
         if (!s.has("late_in_a_row") && !s.has("met")) return std::nullopt;
         if (s.has("stream") && !s.has("late_in_a_row") && m.draw.one_in(2)) return std::nullopt;
         return m.word("20us 200us 2ms 1s");
       }},
      {.key = "requirement.given",
       .percent = 25,
       .make = [](Maker& m, const Scope& s) -> Made {
         const bool is_of_clocks = (s.has("sync") && !s.has("node")) || (s.has("clocks") && m.wants(Feature::gptp));
         return is_of_clocks ? Made(Node::of_bool(true)) : std::nullopt;
       }},
      {.key = "requirement.node",
       .percent = 50,
       .make = [](Maker& m, const Scope& s) -> Made {
         return s.has("sync") ? Made(text(m.draw.any(m.world.nodes()))) : std::nullopt;
       }},
      {.key = "requirement.after",
       .percent = 60,
       .make = [](Maker& m, const Scope& s) -> Made {
         return s.has("sync") || s.has("clocks") ? Made(text(std::to_string(m.duration_us / 2) + "us")) : std::nullopt;
       }},
      {.key = "requirement.thread",
       .percent = 25,
       .make = [](Maker&, const Scope& s) -> Made {
         return s.text("application").starts_with("a") ? Made(text("th0")) : std::nullopt;
       }},
      {.key = "requirement.success",
       .percent = 90,
       .make = [](Maker& m, const Scope& s) -> Made { return s.has("application") ? m.word("50 90.5 100") : Made(); }},
      {.key = "requirement.buffered",
       .percent = 40,
       .make = [](Maker& m, const Scope& s) -> Made {
         return s.has("application") && !filters(m, s.text("application")) ? m.word("10 80") : Made();
       }},
      {.key = "requirement.irregular",
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made { return s.has("signal") ? m.word("10 100") : Made(); }},
      {.key = "requirement.only",
       .percent = 60,
       .make = [](Maker&, const Scope& s) -> Made {
         if (!s.text("figure").starts_with("/programs")) return std::nullopt;
         Node made = Node::object();
         made.add("kind", text("start"));
         return made;
       }},
      {.key = "requirement.take",
       .percent = 60,
       .make = [](Maker& m, const Scope& s) -> Made {
         return s.text("figure").starts_with("/") ? m.word("max min mean sum count") : Made();
       }},
      {.key = "requirement.unit",
       .percent = 60,
       .make = [](Maker& m, const Scope& s) -> Made { return is_time(s) ? m.word("ns us ms") : Made(); }},
      {.key = "requirement.at_most", .percent = 100, .make = limit_of_figure},
      {.key = "requirement.at_least", .percent = 100, .make = limit_of_figure},
      {.key = "requirement.equal", .percent = 100, .make = limit_of_figure},
  };
  return rules;
}

}  // namespace takt::generator
