// SPDX-License-Identifier: Apache-2.0
#include "interchange/inet/ned_network.hpp"

#include <algorithm>
#include <map>

#include "interchange/inet/expression.hpp"

namespace takt::interchange::inet {
namespace {

constexpr std::size_t most_parts = 10'000;  // of a network

class NetworkMaker {
 public:
  NetworkMaker(const std::vector<NedType>& types, Ini& ini, json::Diagnostics& diagnostics)
      : types_(types), ini_(ini), diagnostics_(diagnostics) {}

  std::optional<Network> run(const NedType& type) {
    network_.name = type.name;
    network_.place = type.place;
    std::vector<const NedType*> line;  // from the network to its last base
    for (const NedType* at = &type; at != nullptr && line.size() < 16;
         at = at->base.empty() ? nullptr : find(at->base, at))
      line.push_back(at);
    std::vector<NedAssignment> own;
    for (const NedType* const each : line)  // what is nearer comes first
      for (const NedAssignment& parameter : each->parameters) own.push_back(parameter);
    add_parameters(own, "");
    for (auto each = line.rbegin(); each != line.rend(); ++each)
      for (const NedSubmodule& submodule : (*each)->submodules) add_submodule(submodule);
    for (auto each = line.rbegin(); each != line.rend(); ++each)
      for (const NedConnection& connection : (*each)->connections) add_connection(connection, 0);
    if (diagnostics_.has_errors()) return std::nullopt;
    return std::move(network_);
  }

 private:
  /// A type of the files that is not the one it is asked for from, as types may extend one of the same name elsewhere.
  const NedType* find(const std::string& name, const NedType* from) const {
    const auto found =
        std::ranges::find_if(types_, [&](const NedType& each) { return each.name == name && &each != from; });
    return found == types_.end() ? nullptr : &*found;
  }
  std::string type_of_inet(std::string name, std::vector<const NedType*>* line = nullptr) const {
    const NedType* at = nullptr;
    for (int depth = 0; depth < 16; ++depth) {
      const NedType* const next = find(name, at);
      if (next == nullptr || next->kind == NedType::Kind::network) break;
      if (line != nullptr) line->push_back(next);
      if (next->base.empty()) break;
      at = next;
      name = next->base;
    }
    return name;
  }

  void error(const json::Place& place, std::string message, std::string found, std::string expected) {
    diagnostics_.error(place, std::move(message), {std::move(found), std::move(expected)});
  }

  void add_parameters(const std::vector<NedAssignment>& parameters, const std::string& node) {
    for (const NedAssignment& each : parameters) {
      IniLine line{network_.name + "." + (node.empty() ? "" : node + ".") + each.pattern, each.expression, each.place,
                   false};
      line.is_of_ned = true;
      if (each.is_default)
        ini_.lines().push_back(std::move(line));
      else
        ini_.lines().insert(ini_.lines().begin() + static_cast<std::ptrdiff_t>(fixed_++), std::move(line));
    }
  }

  /// A parameter of the network, or the variable of a loop.
  std::optional<Value> value_of(const std::string& name) {
    if (const auto found = variables_.find(name); found != variables_.end()) {
      Value value;
      value.amount = sim::int128{found->second} * 1'000'000'000'000;
      return value;
    }
    if (++depth_ > 16) return std::nullopt;
    const IniLine* const line = ini_.find(network_.name + "." + name);
    auto value = line == nullptr ? std::nullopt
                                 : evaluate(line->value, [&](const std::string& other) { return value_of(other); });
    --depth_;
    return value;
  }
  std::optional<Value> value(const std::string& expression) {
    return evaluate(expression, [&](const std::string& name) { return value_of(name); });
  }
  std::optional<std::int64_t> whole(const std::string& expression, const json::Place& place) {
    const auto found = value(expression);
    const auto number = found ? found->whole() : std::nullopt;
    if (number && *number >= -1 && *number <= static_cast<std::int64_t>(most_parts)) return number;
    error(place, "not a number that the files say", json::quote(expression),
          "a whole number, or parameters that have one");
    return std::nullopt;
  }
  std::optional<bool> truth(const std::string& expression, const json::Place& place) {
    const auto found = value(expression);
    if (found && found->kind == Value::Kind::truth) return found->truth;
    error(place, "not a condition that the files decide", json::quote(expression), "parameters that have a value");
    return std::nullopt;
  }

  void add_submodule(const NedSubmodule& submodule) {
    if (submodule.condition == "typename!=\"\"") {
    }  // it is there unless nothing is chosen
    else if (!submodule.condition.empty()) {
      const auto holds = truth(submodule.condition, submodule.place);
      if (!holds || !*holds) return;
    }
    std::int64_t count = 1;
    if (!submodule.size.empty()) {
      const auto size = whole(submodule.size, submodule.place);
      if (!size) return;
      count = *size;
      sizes_[submodule.name] = count;
    }
    for (std::int64_t i = 0; i < count && network_.submodules.size() < most_parts; ++i) {
      const std::string name = submodule.size.empty() ? submodule.name : submodule.name + "[" + std::to_string(i) + "]";
      add_parameters(submodule.parameters, name);
      std::string type = submodule.type;
      if (submodule.is_chosen) {
        const IniLine* const line = ini_.find(network_.name + "." + name + ".typename");
        const auto chosen = value(line != nullptr ? line->value : submodule.chosen);
        if (!chosen || chosen->kind != Value::Kind::text) {
          error(line != nullptr ? line->place : submodule.place, "a type that the files do not say",
                json::quote(line != nullptr ? line->value : submodule.chosen),
                name + ".typename = \"TsnDevice\", or a default of NED");
          continue;
        }
        type = chosen->text.substr(chosen->text.rfind('.') == std::string::npos ? 0 : chosen->text.rfind('.') + 1);
      }
      if (type.empty()) continue;
      std::vector<const NedType*> line;
      const std::string known = type_of_inet(type, &line);
      for (const NedType* const each : line) add_parameters(each->parameters, name);
      network_.submodules.push_back({name, known, submodule.place});
    }
  }

  void add_connection(const NedConnection& connection, std::size_t bracket) {
    if (network_.connections.size() >= most_parts || diagnostics_.full()) return;
    if (bracket < connection.brackets.size()) {
      const NedConnection::Bracket& each = connection.brackets[bracket];
      if (each.name.empty()) {
        if (const auto holds = truth(each.from, connection.place); holds && *holds)
          add_connection(connection, bracket + 1);
        return;
      }
      const auto from = whole(each.from, connection.place), to = whole(each.to, connection.place);
      if (!from || !to) return;
      for (std::int64_t i = *from; i <= *to; ++i) {
        variables_[each.name] = i;
        add_connection(connection, bracket + 1);
      }
      variables_.erase(each.name);
      return;
    }
    Connection made;
    made.place = connection.place;
    if (!connection.a.is_ethernet || !connection.b.is_ethernet)
      return error(connection.place, "a connection that is no cable",
                   json::quote(connection.a.node + " and " + connection.b.node),
                   "NODE.ethg: of INET's nodes, not of what is within one");
    if (!set_end(connection.a, connection.place, made.a, made.a_eth) ||
        !set_end(connection.b, connection.place, made.b, made.b_eth))
      return;
    std::vector<const NedType*> line;
    made.channel = type_of_inet(connection.channel, &line);
    std::vector<NedAssignment> parameters = connection.parameters;
    for (const NedType* const type : line)
      for (const NedAssignment& parameter : type->parameters) parameters.push_back(parameter);
    for (const NedAssignment& parameter : parameters) {
      std::optional<std::string>* const into = parameter.pattern == "datarate" ? &made.datarate
                                               : parameter.pattern == "length" ? &made.length
                                               : parameter.pattern == "delay"  ? &made.delay
                                                                               : nullptr;
      if (into != nullptr && !*into)
        *into = parameter.expression;
      else if (into == nullptr && parameter.pattern != "thruputDisplayFormat" &&
               parameter.pattern != "displayAsTooltip")
        error(parameter.place, "a parameter of a channel that is not read", json::quote(parameter.pattern),
              "datarate, length or delay");
    }
    network_.connections.push_back(std::move(made));
  }
  bool set_end(const NedEnd& end, const json::Place& place, std::string& node, std::uint32_t& eth) {
    node = end.node;
    if (!end.index.empty()) {
      const auto index = whole(end.index, place);
      if (!index) return false;
      node += "[" + std::to_string(*index) + "]";
    }
    if (end.gate.empty()) {
      eth = next_eth_[node]++;
      return true;
    }
    const auto gate = whole(end.gate, place);
    if (!gate || *gate < 0) return false;
    eth = static_cast<std::uint32_t>(*gate);
    next_eth_[node] = std::max(next_eth_[node], eth + 1);
    return true;
  }

  const std::vector<NedType>& types_;
  Ini& ini_;
  json::Diagnostics& diagnostics_;
  Network network_;
  std::size_t fixed_ = 0;
  int depth_ = 0;
  std::map<std::string, std::int64_t> variables_, sizes_;
  std::map<std::string, std::uint32_t> next_eth_;
};

}  // namespace

std::optional<Network> network_of(const std::vector<NedType>& types, const std::string& name, Ini& ini,
                                  json::Diagnostics& diagnostics) {
  const auto found = std::ranges::find_if(
      types, [&](const NedType& each) { return each.kind == NedType::Kind::network && each.name == name; });
  if (found == types.end()) return std::nullopt;
  return NetworkMaker(types, ini, diagnostics).run(*found);
}

}  // namespace takt::interchange::inet
