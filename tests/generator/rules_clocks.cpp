// SPDX-License-Identifier: Apache-2.0
// Oscillators and gPTP.
#include "tests/generator/maker.hpp"

namespace takt::generator {
namespace {

using Made = std::optional<Node>;

/// Some nodes with an object each.
Node by_node(Maker& m, const Scope& s, std::string_view definition, std::size_t most) {
  Node made = Node::object();
  const std::vector<std::string> all = m.world.nodes();
  for (const std::string& name : m.draw.some(all, m.draw.between(1, std::min(most, all.size()))))
    made.add(name, m.short_or_object(definition, &s, name));
  return made;
}

/// One port listens or none does; each neighbour once.
Made roles(Maker& m, const Scope& s) {
  const auto& neighbours = m.world.neighbours.at(s.name);
  Node made = Node::array();
  std::set<std::string> seen;
  for (std::size_t n = 0; n < neighbours.size(); ++n)
    if (seen.insert(neighbours[n]).second) made.items.push_back(m.object("gptp_role", &s, neighbours[n], n));
  return made;
}

}  // namespace

std::span<const Rule> clock_rules() {
  static const Rule rules[] = {
      {.key = "scenario.clocks",
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made {
         if (!m.wants(Feature::oscillators) && !m.wants(Feature::gptp)) return std::nullopt;
         return m.short_or_object("clocks", &s);
       }},
      {.key = "clocks.model",
       .percent = 25,
       .make = [](Maker& m, const Scope&) -> Made {
         return text(m.wants(Feature::gptp) || m.wants(Feature::clock_fault) || !m.draw.one_in(6) ? "free-running"
                                                                                                  : "ideal");
       }},
      {.key = "clocks.all",
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made {
         // Clocks that are to fail must be there.
         return m.wants(Feature::clock_fault) || !m.draw.one_in(4) ? Made(m.object("clock", &s)) : std::nullopt;
       }},
      {.key = "clocks.nodes",
       .percent = 40,
       .make = [](Maker& m, const Scope& s) -> Made { return by_node(m, s, "clock", 3); }},
      {.key = "clocks.gptp", .feature = Feature::gptp, .percent = 100},
      {.key = "clock.ideal", .percent = 8, .words = "true"},
      {.key = "clock.offset", .percent = 80},
      {.key = "clock.drift", .percent = 15},
      {.key = "clock.temperature", .percent = 10},
      {.key = "clock.walk", .percent = 10},
      {.key = "clock.table",
       .percent = 8,
       .make = [](Maker& m, const Scope& s) -> Made { return m.objects("frequency_at", m.draw.between(1, 3), s); }},
      {.key = "clock.update", .percent = 15, .words = "100us 1ms 10ms"},
      {.key = "clock.initial", .percent = 20, .words = "-1us 100us 5ms 1s"},
      {.key = "clock.granularity", .percent = 25, .words = "1ps 8ns 40ns"},
      {.key = "clock.jitter", .percent = 25, .words = "0ns 2ns 8ns"},
      {.key = "clock.tx_latency", .percent = 10, .words = "50ns 200ns"},
      {.key = "clock.rx_latency", .percent = 10, .words = "50ns 200ns"},
      {.key = "clock.tx_correction", .percent = 8, .words = "0ns 60ns"},
      {.key = "clock.rx_correction", .percent = 8, .words = "0ns 60ns"},
      {.key = "frequency.fixed", .percent = 60, .words = "-50ppm 10ppm 100ppm 0ppm"},
      {.key = "frequency.from",
       .percent = 60,
       .make = [](Maker& m, const Scope& s) -> Made {
         return s.has("fixed") ? std::nullopt : Made(m.word("-100ppm -50ppm 5ppm"));
       }},
      {.key = "frequency.to",
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made {
         return s.has("from") ? Made(m.word("50ppm 100ppm")) : std::nullopt;
       }},
      {.key = "temperature.amplitude", .words = "1ppm 10ppm"},
      {.key = "temperature.period", .words = "10ms 1s"},
      {.key = "temperature.any_phase", .percent = 30},
      {.key = "temperature.phase", .words = "0.0 0.25 1.0"},
      {.key = "walk.step", .words = "1ppb 100ppb"},
      {.key = "walk.bound", .words = "1ppm 5ppm"},
      {.key = "frequency_at.at",
       .make = [](Maker&, const Scope& s) -> Made { return text(std::to_string(s.number * 3) + "ms"); }},
      {.key = "frequency_at.frequency", .words = "-5ppm 0ppm 20ppm"},
      {.key = "gptp.log_sync_interval", .percent = 90, .words = "-7 -6 -5"},
      {.key = "gptp.log_announce_interval", .percent = 90, .words = "-7 -6 -5"},
      {.key = "gptp.log_pdelay_interval", .percent = 90, .words = "-7 -6"},
      {.key = "gptp.log_gptp_capable_interval", .percent = 20, .words = "-7 -6"},
      {.key = "gptp.sync_receipt_timeout", .percent = 20, .words = "2 3 5"},
      {.key = "gptp.announce_receipt_timeout", .percent = 20, .words = "2 3 5"},
      {.key = "gptp.boundary", .percent = 20},
      {.key = "gptp_node.boundary", .percent = 15},
      {.key = "gptp_node.time", .percent = 20},
      {.key = "announced_time.utc_offset", .percent = 60, .words = "36 37 38"},
      {.key = "announced_time.source", .percent = 40, .words = "32 160"},
      {.key = "gptp.processing", .percent = 12},
      {.key = "gptp.drift_tracking", .percent = 20},
      {.key = "gptp.rate_ratio_window", .percent = 20, .words = "1 4 8"},
      {.key = "gptp.average_link_delay", .percent = 20, .words = "1 4"},
      {.key = "gptp.drift_window", .percent = 20, .words = "0 4 8"},
      // Beyond the least ones are all links, or some: then the network is in parts.
      {.key = "gptp.link_delay_threshold", .percent = 25, .words = "1ns 40ns 800ns 5us 20us"},
      {.key = "gptp.nodes",
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made {
         if (!m.wants(Feature::hot_standby) && m.draw.one_in(3)) return std::nullopt;
         return by_node(m, s, "gptp_node", 3);
       }},
      {.key = "gptp.domains",
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made {
         if (!m.wants(Feature::hot_standby) && !m.draw.one_in(5)) return std::nullopt;
         return m.objects("gptp_domain", m.draw.one_in(4) ? 2 : 1, s);
       }},
      {.key = "gptp.hot_standby", .feature = Feature::hot_standby, .percent = 100, .words = "true"},
      {.key = "gptp.standby_thresholds", .feature = Feature::hot_standby, .percent = 30},
      {.key = "standby_thresholds.offset_max", .percent = 50, .words = "100ns 1us 10us"},
      {.key = "standby_thresholds.offset_met", .percent = 30, .words = "1 4 8"},
      {.key = "standby_thresholds.offset_exceeded", .percent = 30, .words = "1 2 4"},
      {.key = "standby_thresholds.rx_sync_count", .percent = 30, .words = "1 4 8"},
      {.key = "standby_thresholds.primary_secondary_offset", .percent = 50, .words = "0s 1us 100us"},
      {.key = "standby_thresholds.waiting_time", .percent = 30, .words = "0s 1ms 1s"},
      {.key = "gptp.report_every", .percent = 30, .words = "1ms 10ms 100us"},
      // Who asks must speak gPTP.
      {.key = "gptp.without",
       .percent = 10,
       .make = [](Maker& m, const Scope& s) -> Made {
         return s.has("interval_requests") ? std::nullopt : Made(list({text(m.draw.any(m.world.hosts))}));
       }},
      {.key = "gptp.interval_requests",
       .percent = 20,
       .make = [](Maker& m, const Scope& s) -> Made { return m.objects("interval_request", m.draw.between(1, 3), s); }},
      {.key = "interval_request.at", .make = [](Maker& m, const Scope&) -> Made { return m.instant(); }},
      {.key = "interval_request.node",
       .make = [](Maker& m, const Scope&) -> Made {
         return text(m.draw.any(m.draw.one_in(3) || m.world.switches.empty() ? m.world.hosts : m.world.switches));
       }},
      {.key = "interval_request.to",
       .make = [](Maker& m, const Scope& s) -> Made {
         return text(m.draw.any(m.world.neighbours.at(s.text("node"))));
       }},
      {.key = "interval_request.domain", .percent = 30, .words = "0"},
      {.key = "interval_request.sync", .percent = 100, .words = "-7 -5 -4 126 127"},
      {.key = "interval_request.announce", .percent = 50, .words = "-7 -5 -4 126 127"},
      {.key = "interval_request.link_delay", .percent = 40, .words = "-7 -6 -5 126 127"},
      {.key = "servo.first_step_threshold", .percent = 30, .words = "0s 1us 20us"},
      {.key = "servo.step_threshold", .percent = 30, .words = "0s 1us 1ms"},
      {.key = "servo.max_frequency", .percent = 20, .words = "100ppm 1000ppm"},
      // A domain of a hot standby has somebody who may be its grandmaster.
      {.key = "gptp_node.priority1",
       .percent = 100,
       .make = [](Maker& m, const Scope&) -> Made {
         if (m.wants(Feature::hot_standby)) return Node::of_literal(m.draw.word("100 128 200 248"));
         return m.draw.one_in(2) ? Made(Node::of_literal(m.draw.word("100 128 200 248 255"))) : std::nullopt;
       }},
      {.key = "gptp_node.priority2", .percent = 20, .words = "1 248"},
      {.key = "gptp_node.clock_class", .percent = 15, .words = "6 248"},
      {.key = "gptp_node.clock_accuracy", .percent = 15, .words = "32 254"},
      {.key = "gptp_node.roles", .percent = 10, .make = roles},
      {.key = "gptp_role.to", .make = [](Maker&, const Scope& s) -> Made { return text(s.name); }},
      {.key = "gptp_role.role",
       .make = [](Maker& m, const Scope& s) -> Made {
         return s.number == 0 ? m.word("time-receiver time-transmitter") : m.word("time-transmitter passive disabled");
       }},
      {.key = "gptp_domain.domain",
       .make = [](Maker&, const Scope& s) -> Made { return number(s.number == 0 ? 1 : 20); }},
      {.key = "gptp_domain.nodes",
       .percent = 100,
       .make = [](Maker& m, const Scope& s) -> Made {
         if (!m.wants(Feature::hot_standby) && m.draw.one_in(3)) return std::nullopt;
         return by_node(m, s, "gptp_node", 2);
       }},
  };
  return rules;
}

}  // namespace takt::generator
