// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <set>

#include "interchange/lldp/lldp.hpp"
#include "interchange/ports.hpp"
#include "json/document.hpp"

namespace takt::interchange {
namespace {

/// What one machine says of one port.
struct Sight {
  std::string node, port;  ///< that sees
  std::string chassis;     ///< id of who is seen
  std::string name;        ///< of its system; may be empty
  std::string port_id, port_description;
  bool id_is_name = false;  ///< the port's id is the name of an interface
  std::optional<std::uint64_t> rate;
  json::Place place;
};

struct Machine {
  std::string name;
  std::string chassis;  ///< empty if nobody says it
  bool is_bridge = false;
  json::Place place;
  std::vector<Sight> sights;
};

class LldpReader {
 public:
  LldpReader(Imported& imported, json::Diagnostics& diagnostics) : imported_(imported), diagnostics_(diagnostics) {}

  void read(const InputFile& file) {
    const auto document = json::parse(file.text, file.name, diagnostics_);
    if (!document) return;
    document_ = &*document;
    const json::Node& root = document->root();
    const json::Node* const chassis = root.find("local-chassis");
    const json::Node* const seen = root.find("lldp");
    if (chassis == nullptr && seen == nullptr)
      return error(root, "not what lldpcli prints", "\"lldp\" (show neighbors) or \"local-chassis\" (show chassis)");
    Machine& machine = machine_of(file.device, {file.name, 0, 0, ""});
    if (chassis != nullptr) read_own(*chassis, machine);
    if (seen != nullptr)
      for (const json::Node* const part : parts(*seen)) {
        const json::Node* const interfaces = part->find("interface");
        if (interfaces != nullptr) read_interfaces(*interfaces, machine);
      }
  }

  std::vector<Machine> machines;

 private:
  json::Place place(const json::Node& node) const { return json::place_of(*document_->tree(), node); }
  void error(const json::Node& node, std::string message, std::string expected) {
    diagnostics_.error(place(node), std::move(message), {json::excerpt(node), std::move(expected)});
  }

  /// json0 has a list where json has an object or a text.
  static std::vector<const json::Node*> parts(const json::Node& node) {
    std::vector<const json::Node*> all;
    if (node.kind == json::Kind::array)
      for (const json::Node& item : node.items) all.push_back(&item);
    else
      all.push_back(&node);
    return all;
  }
  static std::string text(const json::Node* node) {
    if (node == nullptr) return {};
    const json::Node& first = *parts(*node).front();
    if (first.kind == json::Kind::object) return text(first.find("value"));
    return first.text;
  }
  static std::string text(const json::Node& node, std::string_view key) {
    const json::Node* const found = node.find(key);
    return found == nullptr || (found->kind == json::Kind::array && found->items.empty()) ? std::string() : text(found);
  }

  Machine& machine_of(const std::string& name, const json::Place& where) {
    for (Machine& machine : machines)
      if (machine.name == name) return machine;
    machines.push_back({name, {}, false, where, {}});
    return machines.back();
  }

  /// {NAME: {...}}, {"id": ...} without a name, or in json0 {"id": [...], "name": [...]}.
  static std::pair<std::string, const json::Node*> chassis_of(const json::Node& node) {
    const json::Node& chassis = *parts(node).front();
    if (chassis.kind != json::Kind::object) return {"", nullptr};
    if (chassis.find("id") != nullptr) return {text(chassis, "name"), &chassis};
    if (chassis.members.size() == 1 && chassis.members.front().value.kind == json::Kind::object)
      return {chassis.members.front().key, &chassis.members.front().value};
    return {"", nullptr};
  }

  static bool is_bridge(const json::Node& chassis) {
    const json::Node* const capabilities = chassis.find("capability");
    if (capabilities == nullptr) return false;
    for (const json::Node* const each : parts(*capabilities))
      if (const json::Node* const enabled = each->find("enabled");
          text(*each, "type") == "Bridge" && enabled != nullptr && enabled->boolean)
        return true;
    return false;
  }

  void read_own(const json::Node& node, Machine& machine) {
    for (const json::Node* const part : parts(node)) {
      const json::Node* const chassis = part->find("chassis");
      if (chassis == nullptr || (chassis->kind == json::Kind::array && chassis->items.empty()))
        return error(*part, "no chassis", "an object \"chassis\"");
      const auto [name, own] = chassis_of(*chassis);
      if (own == nullptr) return error(*chassis, "no chassis", "one with an \"id\"");
      if (!name.empty() && name != machine.name)
        imported_.remark(RemarkKind::odd, place(*own),
                         "the machine calls itself " + json::quote(name) + "; it is " + json::quote(machine.name) +
                             " by the name of its file");
      machine.chassis = text(*own, "id");
      machine.is_bridge = is_bridge(*own);
    }
  }

  void read_interfaces(const json::Node& node, Machine& machine) {
    for (const json::Node* const part : parts(node)) {
      if (part->kind != json::Kind::object) {
        error(*part, "not an interface", "an object");
        continue;
      }
      if (part->find("name") != nullptr && part->find("chassis") != nullptr)
        read_sight(text(*part, "name"), *part, machine);
      else
        for (const json::Member& member : part->members) read_sight(member.key, member.value, machine);
    }
  }

  void read_sight(const std::string& port, const json::Node& node, Machine& machine) {
    const json::Node* const chassis = node.kind == json::Kind::object ? node.find("chassis") : nullptr;
    const json::Node* const remote = node.kind == json::Kind::object ? node.find("port") : nullptr;
    const auto is_there = [](const json::Node* each) {
      return each != nullptr && !(each->kind == json::Kind::array && each->items.empty());
    };
    if (!is_there(chassis) || !is_there(remote)) return error(node, "no neighbour", "\"chassis\" and \"port\"");
    const auto [name, seen] = chassis_of(*chassis);
    const json::Node& their = *parts(*remote).front();
    if (seen == nullptr || their.kind != json::Kind::object)
      return error(node, "no neighbour", "a chassis and a port with ids");
    Sight sight{machine.name, port, text(*seen, "id"), name, text(their, "id"), text(their, "descr"),
                false,        {},   place(node)};
    if (const json::Node* const id = their.find("id"); is_there(id))
      sight.id_is_name = text(*parts(*id).front(), "type") == "ifname" || text(*parts(*id).front(), "type") == "local";
    if (const json::Node* const negotiation = their.find("auto-negotiation"); is_there(negotiation))
      sight.rate = rate_of(text(*parts(*negotiation).front(), "current"));
    machine.sights.push_back(std::move(sight));
  }

  /// "10GbaseT - ...", "1000BaseTFD - ...", "100BaseTXFD"; "2p5GigT" is 2.5 Gb/s.
  static std::optional<std::uint64_t> rate_of(const std::string& type) {
    const auto is_digit = [&](std::size_t at) { return at < type.size() && type[at] >= '0' && type[at] <= '9'; };
    std::size_t at = 0;
    std::uint64_t number = 0, tenths = 0;
    while (is_digit(at) && number < 1'000'000) number = number * 10 + static_cast<std::uint64_t>(type[at++] - '0');
    if (at > 0 && at < type.size() && (type[at] == 'p' || type[at] == '.') && is_digit(at + 1)) {
      tenths = static_cast<std::uint64_t>(type[at + 1] - '0');
      at += 2;
    }
    if (number == 0 && tenths == 0) return std::nullopt;
    return (number * 10 + tenths) * (at < type.size() && (type[at] == 'G' || type[at] == 'g') ? 100'000'000 : 100'000);
  }

  Imported& imported_;
  json::Diagnostics& diagnostics_;
  const json::Document* document_ = nullptr;
};

class Joiner {
 public:
  Joiner(std::vector<Machine>& machines, Imported& imported) : machines_(machines), imported_(imported) {}

  scenario::Scenario run() {
    learn_chassis();
    scenario::Scenario scenario;
    scenario.name = "lldp";
    scenario.duration = sim::Duration::from_ps(100'000'000'000);
    for (const Machine& machine : machines_)
      scenario.network.nodes.emplace_back(machine.name, machine.is_bridge ? scenario::Node(scenario::SwitchNode{})
                                                                          : scenario::Node(scenario::HostNode{}));
    for (const Machine& machine : machines_) report_shared_ports(machine);
    for (const Machine& machine : machines_)
      for (const Sight& sight : machine.sights) join(sight, scenario);
    for (const Machine& machine : machines_) report_gaps(machine);
    return scenario;
  }

 private:
  /// Who has no chassis file is known by what the others see of him.
  void learn_chassis() {
    for (const Machine& machine : machines_)
      if (!machine.chassis.empty()) node_of_[machine.chassis] = machine.name;
    for (const Machine& machine : machines_)
      for (const Sight& sight : machine.sights) {
        const auto known = std::ranges::find(machines_, sight.name, &Machine::name);
        if (known != machines_.end() && known->chassis.empty()) node_of_.try_emplace(sight.chassis, known->name);
      }
  }

  static std::size_t count_at(const Machine& machine, const std::string& port) {
    return static_cast<std::size_t>(std::ranges::count(machine.sights, port, &Sight::port));
  }
  const Machine* machine(const std::string& name) const {
    const auto found = std::ranges::find(machines_, name, &Machine::name);
    return found == machines_.end() ? nullptr : &*found;
  }

  void report_shared_ports(const Machine& machine) {
    std::set<std::string> told;
    for (const Sight& sight : machine.sights)
      if (count_at(machine, sight.port) > 1 && told.insert(sight.port).second)
        imported_.remark(
            RemarkKind::lost, sight.place,
            machine.name + ":" + sight.port + " sees " + std::to_string(count_at(machine, sight.port)) +
                " neighbours: a hub or a bridge without LLDP stands there, so these are no links from end to end");
  }

  static bool is_port(const Sight& sight, const std::string& port) {
    return sight.port_id == port || sight.port_description == port;
  }
  static std::string port_name(const Sight& sight) {
    return sight.id_is_name || sight.port_description.empty() ? sight.port_id : sight.port_description;
  }

  void join(const Sight& sight, scenario::Scenario& scenario) {
    const Machine& here = *machine(sight.node);
    if (count_at(here, sight.port) > 1) return;
    const auto named = node_of_.find(sight.chassis);
    const Machine* const there = named == node_of_.end() ? nullptr : machine(named->second);
    if (there == nullptr) {
      imported_.remark(RemarkKind::lost, sight.place,
                       sight.node + ":" + sight.port + " sees " + (sight.name.empty() ? sight.chassis : sight.name) +
                           ", of which no file is given: no link");
      return;
    }
    const auto back = std::ranges::find_if(there->sights, [&](const Sight& each) {
      const auto who = node_of_.find(each.chassis);
      return who != node_of_.end() && who->second == sight.node && is_port(sight, each.port) &&
             is_port(each, sight.port);
    });
    if (back == there->sights.end()) {
      imported_.remark(RemarkKind::lost, sight.place,
                       sight.node + ":" + sight.port + " sees " + there->name + ":" + port_name(sight) +
                           ", which does not see it: no link");
      return;
    }
    if (count_at(*there, back->port) > 1) return;
    const std::string a = sight.node + ":" + sight.port, b = there->name + ":" + back->port;
    if (!joined_.insert(std::minmax(a, b)).second) return;
    scenario::Link link;
    link.ends = {end_of(sight.node, sight.port), end_of(there->name, back->port)};
    const auto rate = sight.rate && back->rate ? std::min(*sight.rate, *back->rate)
                      : sight.rate             ? sight.rate
                                               : back->rate;
    if (rate)
      link.rate = sim::DataRate{*rate};
    else
      imported_.remark(RemarkKind::odd, sight.place, a + " to " + b + ": no rate is told; 1 Gb/s");
    if (sight.rate && back->rate && *sight.rate != *back->rate)
      imported_.remark(RemarkKind::odd, sight.place, a + " and " + b + " tell different rates; the lower one");
    const auto pair = std::minmax(sight.node, there->name);
    if (!pairs_.insert(pair).second)
      imported_.remark(RemarkKind::odd, sight.place, "two links join " + pair.first + " and " + pair.second);
    scenario.network.links.push_back(std::move(link));
  }

  /// The number at the end of the interface's name, if nobody has it; else the next that is free.
  std::string end_of(const std::string& node, const std::string& interface) {
    std::set<std::uint16_t>& used = ports_[node];
    std::uint16_t port = port_of_interface(interface).value_or(0);
    if (port > 1000 || used.contains(port)) port = 0;
    while (used.contains(port)) ++port;
    used.insert(port);
    if (port_of_interface(interface) != port)
      imported_.remark(RemarkKind::changed, machine(node)->place,
                       node + ":" + interface + " is port " + std::to_string(port));
    return node + ":" + std::to_string(port);
  }

  void report_gaps(const Machine& machine) {
    if (!machine.is_bridge) return;
    std::set<std::uint16_t> seen;
    std::string stem;
    for (const Sight& sight : machine.sights)
      if (const auto port = port_of_interface(sight.port); port && *port < 1000) {
        seen.insert(*port);
        stem = sight.port.substr(0, sight.port.find_last_not_of("0123456789") + 1);
      }
    for (std::uint16_t port = 0; !seen.empty() && port < *seen.rbegin(); ++port)
      if (!seen.contains(port) && port >= *seen.begin())
        imported_.remark(RemarkKind::lost, machine.place,
                         machine.name + ":" + stem + std::to_string(port) +
                             " sees nobody: what is there, if anything, runs no LLDP");
  }

  std::vector<Machine>& machines_;
  Imported& imported_;
  std::map<std::string, std::string> node_of_;  // by chassis id
  std::map<std::string, std::set<std::uint16_t>> ports_;
  std::set<std::pair<std::string, std::string>> joined_, pairs_;
};

}  // namespace

Imported import_lldp(const ImportRequest& request, json::Diagnostics& diagnostics) {
  Imported imported;
  LldpReader reader(imported, diagnostics);
  for (const InputFile& file : request.files) reader.read(file);
  if (diagnostics.has_errors()) return imported;
  scenario::Scenario scenario = Joiner(reader.machines, imported).run();
  if (!diagnostics.has_errors()) imported.scenario = std::move(scenario);
  return imported;
}

}  // namespace takt::interchange
