// SPDX-License-Identifier: Apache-2.0
#include "interchange/import.hpp"

#include <algorithm>

#include "json/fields.hpp"
#include "json/printable.hpp"

namespace takt::interchange {
namespace {

using json::Node;

Node encoded(const auto& value) { return json::encode_value(value); }

/// The members with defaults of what stands under a key, whatever it stands in.
struct Default {
  std::string_view key;  ///< of a list, or of an object whose members are such values, or of the value itself
  Node value;
  std::string_view keep = {};  ///< is written even if it is as in a value without content
};

const std::vector<Default>& defaults() {
  using namespace scenario;
  static const std::vector<Default> all = [] {
    std::vector<Default> list;
    list.push_back({"links", encoded(Link{})});
    list.push_back({"streams", encoded(Stream{})});
    list.push_back({"egress", encoded(Egress{})});
    list.push_back({"gates", encoded(Gates{})});
    list.push_back({"shapers", encoded(Shaper{}), "class"});
    list.push_back({"preemption", encoded(Preemption{})});
    list.push_back({"ingress", encoded(Ingress{})});
    list.push_back({"filters", encoded(StreamFilterEntry{})});
    list.push_back({"meters", encoded(Meter{}), "cir"});
    list.push_back({"ats", encoded(AtsEntry{})});
    list.push_back({"redundancy", encoded(Redundancy{})});
    list.push_back({"null", encoded(NullIdentity{})});
    list.push_back({"clocks", encoded(Clocks{})});
    list.push_back({"gptp", encoded(Gptp{})});
    list.push_back({"servo", encoded(ServoSettings{})});
    list.push_back({"network", encoded(NetworkSection{})});
    return list;
  }();
  return all;
}

const Node& host_defaults() {
  static const Node node = encoded(scenario::Node{scenario::HostNode{}});
  return node;
}
const Node& switch_defaults() {
  static const Node node = encoded(scenario::Node{scenario::SwitchNode{}});
  return node;
}
const Node& station_defaults() {
  static const Node node = encoded(scenario::Node{scenario::StationNode{}});
  return node;
}

/// Takes out what is as in `model`, but for `keep`.
void drop(Node& object, const Node& model, std::string_view keep = {}) {
  std::erase_if(object.members, [&](const json::Member& member) {
    const Node* const usual = model.find(member.key);
    return member.key != keep && usual != nullptr && json::equal(*usual, member.value);
  });
}

void simplify(Node& node, std::string_view key);

void simplify_members(Node& object, std::string_view key) {
  for (json::Member& member : object.members) {
    if (key == "nodes" && member.value.find("kind") != nullptr) {
      const std::string kind = member.value.find("kind")->text;
      drop(member.value,
           kind == "host"     ? host_defaults()
           : kind == "switch" ? switch_defaults()
                              : station_defaults(),
           "kind");
      simplify_members(member.value, "node");
    } else {
      simplify(member.value, member.key);
    }
  }
}

void simplify(Node& node, std::string_view key) {
  if (node.kind == json::Kind::array) {
    for (Node& item : node.items) simplify(item, key);
  } else if (node.kind == json::Kind::object) {
    const auto found = std::ranges::find(defaults(), key, &Default::key);
    simplify_members(node, key);
    if (found != defaults().end()) drop(node, found->value, found->keep);
    // An entry of a gate list, of either kind.
    if (key == "entries")
      if (const Node* const mac = node.find("mac"); mac != nullptr && mac->text == "none")
        std::erase_if(node.members, [](const json::Member& member) { return member.key == "mac"; });
  }
}

}  // namespace

std::string device_of_file(std::string_view name) {
  std::size_t at = 0, groups = 0;
  while (groups < 4) {
    std::size_t end = at;
    while (end < name.size() && name[end] >= '0' && name[end] <= '9') ++end;
    if (end == at || end - at > 3) break;
    ++groups;
    at = end;
    if (groups == 4 || at == name.size() || name[at] != '.') break;
    ++at;
  }
  const bool is_address = groups == 4 && (at == name.size() || name[at] == '.');
  return std::string(name.substr(0, is_address ? at : name.find('.')));
}

void Imported::remark(RemarkKind kind, json::Place place, std::string text) {
  remarks.push_back({kind, std::move(place), std::move(text)});
}

std::string to_text(const Remark& remark) {
  constexpr std::string_view words[] = {"changed", "lost", "ignored", "odd"};
  std::string text = remark.place.file;
  if (remark.place.line != 0)
    text += ":" + std::to_string(remark.place.line) + ":" + std::to_string(remark.place.column);
  return json::printable(text + ": " + std::string(words[static_cast<std::size_t>(remark.kind)]) + ": " + remark.text);
}

std::string sparse_text(const scenario::Scenario& scenario) {
  Node node = encoded(scenario);
  simplify_members(node, "scenario");
  scenario::Scenario nothing;
  nothing.name = scenario.name;
  nothing.duration = scenario.duration;
  Node usual = encoded(nothing);
  for (const char* const key : {"name", "duration"})
    std::erase_if(usual.members, [&](const json::Member& member) { return member.key == key; });
  drop(node, usual);
  return json::pretty(node);
}

}  // namespace takt::interchange
