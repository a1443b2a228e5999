// SPDX-License-Identifier: Apache-2.0
// What files say of the instances of a topic of DDS, and what can be wrong with it.
#pragma once

#include <string>
#include <vector>

#include "plant/application.hpp"
#include "plant/program.hpp"

namespace takt::plant {

/// `topic` is where the topic with these keys is written. Each key is a field, and one field at least is none.
void check_keys(const json::Source& topic, const std::vector<std::string>& keys,
                const json::NameMap<TopicField>& fields, json::Diagnostics& diagnostics);
/// Instances belong to a topic that has keys.
void check_instances(const Payload& payload, bool has_keys, json::Diagnostics& diagnostics);

/// The field that a pattern is in: the first that is a number and no key; the first that is no key if there is none.
std::size_t value_field(const json::NameMap<TopicField>& fields, const std::vector<std::string>& keys);
/// The instance of a thread's publication, which it counts from 1 on: its instances come by turns.
std::uint64_t instance_of(const Payload& payload, std::uint64_t publication);

}  // namespace takt::plant
