// SPDX-License-Identifier: Apache-2.0
// What goes wrong, and the rerouting around it.
#include "tests/generator/maker.hpp"

namespace takt::generator {
namespace {

using Made = std::optional<Node>;

Made ends(Maker& m, const Scope&) {
  const auto& [a, b] = m.draw.any(m.world.links);
  return list({text(a), text(b)});
}

Made at(Maker& m, const Scope&) { return m.instant(); }
Made lasts(Maker& m, const Scope&) { return m.word(m.is_long() ? "1ms 5ms 20ms 50ms" : "10us 300us 1ms 2ms"); }

Made node(Maker& m, const Scope&) { return text(m.draw.any(m.world.nodes())); }
Made neighbour(Maker& m, const Scope& s) { return text(m.draw.any(m.world.neighbours.at(s.text("node")))); }

Made faults(Maker& m, const Scope& s) {
  Node made = Node::array();
  const auto some = [&](Feature feature, std::string_view tag) {
    if (!m.wants(feature)) return;
    for (std::size_t i = m.draw.between(1, 2); i > 0; --i) made.items.push_back(m.option("fault", tag, &s));
  };
  some(Feature::link_down, "link-down");
  some(Feature::frame_errors, "frame-errors");
  some(Feature::crash, "crash");
  if (m.streams > 0) some(Feature::babble, "babble");
  some(Feature::stuck_gate, "stuck-gate");
  some(Feature::clock_fault, "clock");
  if (made.items.empty()) return std::nullopt;
  return made;
}

}  // namespace

std::span<const Rule> fault_rules() {
  static const Rule rules[] = {
      {.key = "scenario.faults", .percent = 100, .make = faults},
      {.key = "scenario.rerouting", .feature = Feature::rerouting, .percent = 100},
      {.key = "rerouting.delay", .words = "0ns 10us 200us 1ms"},
      {.key = "link-down.link", .make = ends},
      {.key = "link-down.at", .make = at},
      {.key = "link-down.for", .percent = 70, .make = lasts},
      {.key = "frame-errors.link", .make = ends},
      {.key = "frame-errors.towards",
       .make = [](Maker& m, const Scope& s) -> Made {
         return text(s.made->find("link")->items[m.draw.below(2)].text);
       }},
      {.key = "frame-errors.loss", .percent = 50, .words = "0.1 0.01 0.5"},
      {.key = "frame-errors.burst_loss", .percent = 25},
      {.key = "frame-errors.corruption", .percent = 25, .words = "0.2 0.01"},
      {.key = "frame-errors.bit_error_rate", .percent = 15, .words = "0.00001 1e-7"},
      {.key = "frame-errors.duplication", .percent = 30, .words = "0.2 0.01"},
      {.key = "frame-errors.at", .percent = 60, .make = at},
      {.key = "frame-errors.for", .percent = 60, .make = lasts},
      {.key = "burst_loss.good_to_bad", .words = "0.1 0.01"},
      {.key = "burst_loss.bad_to_good", .words = "0.3 1.0"},
      {.key = "burst_loss.loss_in_good", .words = "0.0 0.01"},
      {.key = "burst_loss.loss_in_bad", .words = "1.0 0.5"},
      {.key = "crash.node", .make = node},
      {.key = "crash.at", .make = at},
      {.key = "crash.for", .percent = 70, .make = lasts},
      {.key = "babble.stream",
       .make = [](Maker& m, const Scope&) -> Made { return text("s" + std::to_string(m.draw.below(m.streams))); }},
      {.key = "babble.at", .make = at},
      {.key = "babble.for", .percent = 70, .make = lasts},
      {.key = "babble.every", .percent = 60, .words = "20us 50us"},
      {.key = "stuck-gate.node",
       .make = [](Maker& m, const Scope&) -> Made {
         return text(m.draw.any(!m.world.switches.empty() && !m.draw.one_in(4) ? m.world.switches : m.world.nodes()));
       }},
      {.key = "stuck-gate.to", .percent = 50, .make = neighbour},
      {.key = "stuck-gate.class", .words = "0 1 2 3 4 5 6 7"},
      {.key = "stuck-gate.at", .make = at},
      {.key = "stuck-gate.for", .percent = 70, .make = lasts},
      {.key = "clock-fault.node", .make = node},
      {.key = "clock-fault.at", .make = at},
      {.key = "clock-fault.step", .percent = 50, .words = "-1us 1us 50us -3ms 10ms"},
      {.key = "clock-fault.offset", .percent = 50, .words = "-100ppm 50ppm 1000ppm 0ppm"},
  };
  return rules;
}

}  // namespace takt::generator
