// SPDX-License-Identifier: Apache-2.0
#include "interchange/inet/reader.hpp"
#include "sim/units.hpp"

namespace takt::interchange::inet {
namespace {

/// "500ppm", "-0.5 ppm" in 10^-12; null if it is none.
std::optional<std::int64_t> ppm_of(std::string text) {
  std::erase(text, ' ');
  if (!text.ends_with("ppm")) return std::nullopt;
  const bool is_negative = text.starts_with('-');
  const auto value = evaluate(text.substr(is_negative ? 1 : 0, text.size() - 3 - (is_negative ? 1 : 0)));
  if (!value || value->kind != Value::Kind::number || value->unit != Unit::none) return std::nullopt;
  const auto parts = static_cast<std::int64_t>(value->amount / 1'000'000);  // 10^-12 of a millionth
  return is_negative ? -parts : parts;
}

}  // namespace

/// The oscillator of a node, and whether and by which ports it is synchronised.
void InetReader::read_clock(const Submodule& node) {
  const bool is_synchronised = truth(node.name + ".hasTimeSynchronization") || node.type == "TsnClock";
  const IniLine* const type = line(node.name + ".clock.typename");
  const std::string kind = type == nullptr ? "" : text(node.name + ".clock.typename").value_or("");
  if (kind == "MultiClock")
    imported_.remark(RemarkKind::lost, type->place,
                     "several clocks of a node: takt's nodes have one, which each domain sets in turn");
  if (is_synchronised || kind == "OscillatorBasedClock" || kind == "SettableClock" || kind == "MultiClock")
    read_oscillator(node, is_synchronised || !kind.empty());
  if (!is_synchronised) return;
  scenario::Gptp& gptp = scenario_.clocks.gptp.has_value() ? *scenario_.clocks.gptp : scenario_.clocks.gptp.emplace();
  scenario_.clocks.model = scenario::ClockModel::free_running;
  synchronised_.insert(node.name);
  const std::uint64_t domains = number(node.name + ".gptp.numDomains", 16).value_or(1);
  line(node.name + ".gptp.typename");
  for (std::uint64_t d = 0; d < std::max<std::uint64_t>(domains, 1); ++d) {
    const std::string prefix =
        domains == 1 ? node.name + ".gptp." : node.name + ".gptp.domain[" + std::to_string(d) + "].";
    for (const char* const key : {"gptpNodeType", "syncInitialOffset", "pdelayInitialOffset"}) line(prefix + key);
    scenario::GptpNode made;
    made.roles = roles_of(node, prefix);
    if (!made.roles) continue;
    if (d == 0) {
      gptp.nodes.emplace_back(node.name, std::move(made));
      continue;
    }
    auto found = std::ranges::find(gptp.domains, static_cast<std::uint8_t>(d), &scenario::GptpDomain::domain);
    if (found == gptp.domains.end()) {
      gptp.domains.emplace_back();
      gptp.domains.back().domain = static_cast<std::uint8_t>(d);
      found = std::prev(gptp.domains.end());
    }
    found->nodes.emplace_back(node.name, std::move(made));
  }
}

/// "masterPorts" and "slavePort", by the neighbours at them; null if neither is said.
std::optional<std::vector<scenario::GptpPortRole>> InetReader::roles_of(const Submodule& node,
                                                                        const std::string& prefix) {
  std::vector<scenario::GptpPortRole> roles;
  const auto add = [&](const std::string& interface, scenario::GptpRole role, const json::Place& place) {
    std::uint32_t eth = 0;
    const bool is_eth =
        interface.starts_with("eth") &&
        std::from_chars(interface.data() + 3, interface.data() + interface.size(), eth).ec == std::errc();
    const auto peer = ports_[node.name].find(eth);
    if (!is_eth || peer == ports_[node.name].end())
      return error(place, "an interface that is not there", json::quote(interface) + " of " + node.name,
                   "eth0 and the like, with a cable");
    scenario::GptpPortRole made;
    made.to = peer->second;
    made.role = role;
    roles.push_back(std::move(made));
  };
  const IniLine* const masters = line(prefix + "masterPorts");
  const IniLine* const slave = line(prefix + "slavePort");
  if (masters == nullptr && slave == nullptr) return std::nullopt;
  if (masters != nullptr)
    if (const auto list = value(prefix + "masterPorts", json::Kind::array, "[\"eth0\", ..]"))
      for (const json::Node& each : list->items) add(each.text, scenario::GptpRole::time_transmitter, masters->place);
  if (slave != nullptr)
    if (const auto interface = text(prefix + "slavePort"); interface && !interface->empty())
      add(*interface, scenario::GptpRole::time_receiver, slave->place);
  return roles;
}

void InetReader::read_oscillator(const Submodule& node, bool counts) {
  const std::string prefix = node.name + ".clock.oscillator.";
  const auto type = text(prefix + "typename");
  line(prefix + "nominalTickLength");
  if (!type || *type == "IdealOscillator" || !counts) return;
  if (*type != "ConstantDriftOscillator" && *type != "RandomDriftOscillator")
    return error(line(prefix + "typename")->place, "an oscillator that is not read", json::quote(*type),
                 "ConstantDriftOscillator or RandomDriftOscillator");
  const IniLine* const rate_line =
      line(prefix + (*type == "ConstantDriftOscillator" ? "driftRate" : "initialDriftRate"));
  scenario::Clock clock;
  if (rate_line != nullptr) {
    std::string rate = rate_line->value;
    const std::size_t comma = rate.find(',');
    std::optional<std::int64_t> from, to;
    if (rate.starts_with("uniform(") && rate.ends_with(")") && comma != std::string::npos) {
      from = ppm_of(rate.substr(8, comma - 8));
      to = ppm_of(rate.substr(comma + 1, rate.size() - comma - 2));
    } else {
      from = to = ppm_of(rate);
    }
    if (!from || !to)
      return error(rate_line->place, "a drift that is not read", json::quote(rate), "ppm, or uniform(-A ppm, B ppm)");
    clock.offset.from = sim::FrequencyOffset{*from};
    clock.offset.to = sim::FrequencyOffset{*to};
  }
  bool wanders = false;
  for (const char* const key :
       {"driftRateChange", "changeInterval", "driftRateChangeLowerLimit", "driftRateChangeUpperLimit"})
    if (line(prefix + key) != nullptr) wanders = true;
  if (wanders)
    imported_.remark(
        RemarkKind::lost, line(prefix + "typename")->place,
        "how the drift of an oscillator changes by chance: write it as \"walk\" of the clock of " + node.name);
  scenario_.clocks.model = scenario::ClockModel::free_running;
  scenario_.clocks.nodes.emplace_back(node.name, std::move(clock));
}

/// Nodes that take no part, where others do.
void InetReader::end_clocks() {
  if (!scenario_.clocks.gptp) return;
  for (const auto& [name, node] : scenario_.network.nodes)
    if (!synchronised_.contains(name)) scenario_.clocks.gptp->without.push_back(name);
}

}  // namespace takt::interchange::inet
