// SPDX-License-Identifier: Apache-2.0
#include "papers/coexistence/variants.hpp"

#include <algorithm>
#include <variant>

namespace takt::papers::coexistence {
namespace {

using namespace sim::literals;  // NOLINT: units

constexpr std::uint8_t priority = 6;
constexpr sim::Duration cycle = 1_ms;
/// Enough for what real-time Linux needs to publish (tens of microseconds) and a switch with several frames for one
/// port at 100 Mb/s (9 us each).
constexpr sim::Duration window = 300_us;
/// Clocks are synchronised by then.
constexpr sim::Duration settled = 10_s;

scenario::Gates gates() {
  scenario::GateEntry reserved;
  reserved.open = {4, 5, 6, 7};
  reserved.interval = window;
  scenario::GateEntry everybody;
  everybody.open = {0, 1, 2, 3, 4, 5, 6, 7};
  everybody.interval = cycle - window;
  scenario::Gates made;
  made.entries = {reserved, everybody};
  return made;
}

void begin_later(scenario::Scheduler& scheduler, sim::Duration by) { scheduler.after = scheduler.after + by; }

}  // namespace

void use_real_time_linux(scenario::Scenario& scenario) {
  for (auto& [name, node] : scenario.network.nodes) {
    scenario::EndStation* const host = scenario::end_station_of(node);
    if (host == nullptr) continue;
    if (host->os.profile == scenario::OsProfile::general_purpose)
      host->os.profile = scenario::OsProfile::preempt_rt_arm;
    if (host->os.profile == scenario::OsProfile::virtual_machine)
      host->os.profile = scenario::OsProfile::virtual_machine_rt;
  }
  for (scenario::Application& application : scenario.applications)
    for (scenario::Thread& thread : application.threads) thread.response.reset();
  for (scenario::Gateway& gateway : scenario.gateways) {
    gateway.receive_response.reset();
    gateway.send_response.reset();
  }
}

void use_tsn(scenario::Scenario& scenario) {
  for (auto& [name, node] : scenario.network.nodes) {
    scenario::Egress egress;
    egress.gates = gates();
    std::visit([&](auto& any) { any.egress.push_back(egress); }, node);
    if (std::holds_alternative<scenario::SwitchNode>(node)) {
      scenario.clocks.gptp.emplace();
      scenario.clocks.gptp->nodes.emplace_back(name, scenario::GptpNode());
      scenario.clocks.gptp->nodes.back().second.priority1 = 100;
    }
  }
  for (scenario::Topic& topic : scenario.topics) topic.pcp = priority;
  const sim::Duration later = settled - scenario.applications.front().scheduler.after;
  scenario.duration = scenario.duration + later;
  // Clocks agree now, so that threads can: who listens does so half an interval after who speaks.
  for (scenario::Application& application : scenario.applications) {
    begin_later(application.scheduler, later);
    for (scenario::Thread& thread : application.threads)
      thread.offset = thread.subscribe ? thread.every / 2 : sim::Duration();
  }
  for (scenario::Gateway& gateway : scenario.gateways) {
    begin_later(gateway.scheduler, later);
    gateway.receive_offset = gateway.receive_every / 2;
    gateway.send_offset = {};
  }
}

void command_rarely(scenario::Scenario& scenario) {
  for (scenario::Application& application : scenario.applications)
    for (scenario::Thread& thread : application.threads)
      if (application.name == commanding_application && thread.name == commanding_thread) thread.every = 100_ms;
}

void unload(scenario::Scenario& scenario) { scenario.streams.clear(); }

}  // namespace takt::papers::coexistence
