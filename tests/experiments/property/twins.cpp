// SPDX-License-Identifier: Apache-2.0
#include "tests/experiments/property/twins.hpp"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "sim/random.hpp"

namespace takt::property {
namespace {

using Json = nlohmann::ordered_json;

Json parsed(const std::string& text) { return Json::parse(text, nullptr, true, true); }

template <class Range>
void shuffle(Range& range, sim::RandomStream& chance) {
  for (std::size_t i = range.size(); i > 1; --i)
    std::swap(range[i - 1], range[static_cast<std::size_t>(chance.below(i))]);
}

void shuffle_members(Json& object, sim::RandomStream& chance) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  shuffle(keys, chance);
  Json made = Json::object();
  for (const std::string& key : keys) made[key] = object[key];
  object = std::move(made);
}

/// The order of nodes is that of their numbers, and so another transformation.
void shuffle_all_members(Json& value, sim::RandomStream& chance, std::string_view under) {
  if (value.is_object() && under != "nodes") shuffle_members(value, chance);
  if (!value.is_structured()) return;
  for (auto& [key, child] : value.items())
    shuffle_all_members(child, chance, value.is_object() ? std::string_view(key) : std::string_view());
}

struct Quantity {
  std::int64_t number = 0;
  std::string unit;
};
std::optional<Quantity> quantity_of(const std::string& text) {
  Quantity made;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), made.number);
  if (error != std::errc() || end == text.data()) return std::nullopt;
  made.unit = std::string(end, text.data() + text.size());
  return made;
}

/// A unit and the next smaller one, of which it has so many.
struct Unit {
  std::string_view name;
  std::string_view smaller;
  std::int64_t has = 0;
};
constexpr Unit times[] = {{"s", "ms", 1000}, {"ms", "us", 1000}, {"us", "ns", 1000}, {"ns", "ps", 1000}};
constexpr Unit rates[] = {{"Gbps", "Mbps", 1000}, {"Mbps", "kbps", 1000}, {"kbps", "bps", 1000}};

template <std::size_t N>
const Unit* find(const Unit (&units)[N], const std::string& name) {
  const Unit* const found =
      std::find_if(std::begin(units), std::end(units), [&](const Unit& unit) { return unit.name == name; });
  return found == std::end(units) ? nullptr : found;
}

/// Calls `change` with each text that is a value. False as soon as it says so.
bool change_texts(Json& value, const std::function<bool(std::string&)>& change) {
  if (value.is_string()) {
    auto text = value.get<std::string>();
    if (!change(text)) return false;
    value = text;
  }
  if (value.is_structured())
    for (auto& child : value)
      if (!change_texts(child, change)) return false;
  return true;
}

/// Its ends as they are written, since a port that has a number is another one; what takes time on it.
std::string words_of(const scenario::Resolved& resolved, std::size_t number) {
  const models::LinkPlan& link = resolved.plan.links[number];
  std::vector<std::string> ends;
  if (number < resolved.scenario.network.links.size())
    ends = resolved.scenario.network.links[number].ends;  // those of generators follow
  else
    ends = {resolved.plan.nodes[link.a.node.value].name, resolved.plan.nodes[link.b.node.value].name};
  std::ranges::sort(ends);
  return ends.front() + " - " + ends.back() + ", " + std::to_string(link.rate.bits_per_second) + " b/s, " +
         std::to_string(link.delay.ps()) + " ps";
}

bool is_switch(const Json& node) { return node.value("kind", "") == "switch"; }

}  // namespace

Twin with_other_keys(const std::string& text, std::uint64_t seed) {
  sim::RandomStream chance(seed, "keys", "twin");
  Json twin = parsed(text);
  shuffle_all_members(twin, chance, {});
  return {twin.dump(), {}, 1};
}

Twin with_other_units(const std::string& text) {
  Json twin = parsed(text);
  change_texts(twin, [](std::string& value) {
    const auto quantity = quantity_of(value);
    if (!quantity) return true;
    const Unit* const time = find(times, quantity->unit);
    const Unit* const rate = find(rates, quantity->unit);
    if (const Unit* const unit = time != nullptr ? time : rate;
        unit != nullptr && std::abs(quantity->number) < 1'000'000'000'000)
      value = std::to_string(quantity->number * unit->has) + std::string(unit->smaller);
    return true;
  });
  return {twin.dump(), {}, 1};
}

Twin with_unused_switch(const std::string& text) {
  Json twin = parsed(text);
  Json& nodes = twin["network"]["nodes"];
  if (!nodes.is_object()) return {};
  std::string first;
  for (const auto& [name, node] : nodes.items())
    if (first.empty() && is_switch(node)) first = name;
  if (first.empty()) return {};
  nodes["an unused switch"] = {{"kind", "switch"}};
  twin["network"]["links"].push_back({{"ends", {"an unused switch", first}}});
  return {twin.dump(), {}, 1};
}

Twin with_other_names(const std::string& text) {
  Json twin = parsed(text);
  Twin made;
  std::map<std::string, std::string> names;
  Json nodes = Json::object();
  for (const auto& [name, node] : twin["network"]["nodes"].items()) {
    names[name] = "the node " + name;
    nodes[names[name]] = node;
  }
  twin["network"]["nodes"] = nodes;
  for (const Json& stream : twin["streams"]) {
    const auto name = stream.at("name").get<std::string>();
    if (names.contains(name)) return {};
    names[name] = made.name_of[name] = "the stream " + name;
  }
  change_texts(twin, [&](std::string& value) {
    if (const auto found = names.find(value); found != names.end()) value = found->second;
    return true;
  });
  made.text = twin.dump();
  return made;
}

Twin with_other_streams(const std::string& text, std::uint64_t seed) {
  sim::RandomStream chance(seed, "streams", "twin");
  Json twin = parsed(text);
  if (!twin.contains("streams") || twin["streams"].size() < 2) return {};
  shuffle(twin["streams"], chance);
  return {twin.dump(), {}, 1};
}

Twin with_other_nodes(const std::string& text, std::uint64_t seed) {
  sim::RandomStream chance(seed, "nodes", "twin");
  Json twin = parsed(text);
  if (!twin["network"].contains("nodes")) return {};
  shuffle_members(twin["network"]["nodes"], chance);
  return {twin.dump(), {}, 1};
}

Twin with_other_links(const std::string& text, std::uint64_t seed) {
  sim::RandomStream chance(seed, "links", "twin");
  Json twin = parsed(text);
  if (!twin["network"].contains("links")) return {};
  shuffle(twin["network"]["links"], chance);
  for (Json& link : twin["network"]["links"])
    if (link.size() <= 3 && chance.below(2) == 0)
      std::reverse(link["ends"].begin(), link["ends"].end());  // ends have nothing of their own
  return {twin.dump(), {}, 1};
}

Twin ten_times_slower(const std::string& text) {
  Json twin = parsed(text);
  const bool is_possible = change_texts(twin, [](std::string& value) {
    auto quantity = quantity_of(value);
    if (!quantity) return true;
    if (find(times, quantity->unit) != nullptr || quantity->unit == "ps" || quantity->unit == "m" ||
        quantity->unit == "km") {
      value = std::to_string(10 * quantity->number) + quantity->unit;
    } else if (quantity->unit == "bps") {
      if (quantity->number % 10 != 0) return false;
      value = std::to_string(quantity->number / 10) + quantity->unit;
    } else if (const Unit* const rate = find(rates, quantity->unit)) {
      value = std::to_string(quantity->number * 100) + std::string(rate->smaller);
    }
    return true;
  });
  return is_possible ? Twin{twin.dump(), {}, 10} : Twin{};
}

std::vector<std::string> passed_by(const scenario::Resolved& resolved, const scenario::ResolvedStream& stream) {
  std::vector<std::string> passed;
  for (const scenario::Path& path : stream.paths)
    for (std::size_t at = 0; at < path.size(); ++at) {
      passed.push_back(resolved.plan.nodes[path[at]].name);
      if (at + 1 == path.size()) continue;
      const std::uint16_t port = scenario::port_out(resolved.topology, path, at);
      const auto starts_here = [&](const models::LinkPlan& link) {
        return (link.a.node.value == path[at] && link.a.port == port) ||
               (link.b.node.value == path[at] && link.b.port == port);
      };
      const auto link = std::ranges::find_if(resolved.plan.links, starts_here);
      passed.push_back(words_of(resolved, static_cast<std::size_t>(link - resolved.plan.links.begin())));
    }
  return passed;
}

std::string without_ties_and_chance(const std::string& text, std::uint64_t seed) {
  Json made = parsed(text);
  for (Json& stream : made["streams"]) {
    sim::RandomStream chance(seed, stream.at("name").get<std::string>(), "twin");
    for (const char* const random : {"exponential", "normal"})
      if (stream.contains(random)) {
        stream.erase(random);
        stream["every"] = "700us";
      }
    stream.erase("jitter");
    if (stream.contains("every") && chance.below(3) == 0)  // a common multiple that is far away
      stream["every"] = std::to_string(3'040 * (80 + chance.below(400))) + "ns";
    stream["offset"] = std::to_string(1'000'000 + chance.below(900'000'000)) + "ps";
  }
  for (auto& [name, node] : made["network"]["nodes"].items()) {
    node.erase("forwarding_jitter");
    node.erase("os");
    if (!node.contains("ingress") || !node["ingress"].contains("cqf"))
      continue;  // its own times are a nanosecond longer than the cable
    Json& cqf = node["ingress"]["cqf"];
    cqf[cqf.at("classes").size() == 2 ? "dead_time" : "offset"] = "5us";
  }
  return made.dump();
}

}  // namespace takt::property
