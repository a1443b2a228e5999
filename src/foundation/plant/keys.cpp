// SPDX-License-Identifier: Apache-2.0
#include "plant/keys.hpp"

#include <algorithm>

#include "json/suggest.hpp"
#include "plant/topic_check.hpp"

namespace takt::plant {
namespace {

bool is_key(const std::vector<std::string>& keys, const std::string& name) {
  return std::find(keys.begin(), keys.end(), name) != keys.end();
}

}  // namespace

void check_keys(const json::Source& topic, const std::vector<std::string>& keys,
                const json::NameMap<TopicField>& fields, json::Diagnostics& diagnostics) {
  std::vector<std::string_view> names;
  for (const auto& [name, field] : fields) names.push_back(name);
  bool all_known = true;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (std::find(names.begin(), names.end(), keys[k]) != names.end()) continue;
    all_known = false;
    diagnostics.error(topic.at("keys", k), "a key that is no field",
                      {json::quote(keys[k]), "the name of a field of the topic", json::suggest(keys[k], names)});
  }
  if (!all_known || keys.empty()) return;
  if (std::all_of(names.begin(), names.end(), [&](std::string_view name) { return is_key(keys, std::string(name)); }))
    diagnostics.error(topic.at("keys"), "keys and nothing else",
                      {"all fields are keys", "a field that is none, for the value"});
}

void check_instances(const Payload& payload, bool has_keys, json::Diagnostics& diagnostics) {
  if (has_keys) return;
  for (const char* const key : {"instance", "instances"})
    if (payload.where.has(key))
      diagnostics.error(payload.where.at(key), "an instance of a topic without keys",
                        {json::quote(key), "a topic of DDS with \"keys\""});
}

std::size_t value_field(const json::NameMap<TopicField>& fields, const std::vector<std::string>& keys) {
  auto found = std::find_if(fields.begin(), fields.end(),
                            [&](const auto& each) { return !is_key(keys, each.first) && is_number(each.second.type); });
  if (found == fields.end())
    found = std::find_if(fields.begin(), fields.end(), [&](const auto& each) { return !is_key(keys, each.first); });
  return found == fields.end() ? 0 : static_cast<std::size_t>(found - fields.begin());
}

std::uint64_t instance_of(const Payload& payload, std::uint64_t publication) {
  const std::uint64_t number = payload.instances.value_or(1);
  return payload.instance.value_or(0) + (publication + number - 1) % number;
}

}  // namespace takt::plant
