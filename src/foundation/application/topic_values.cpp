// SPDX-License-Identifier: Apache-2.0
#include "application/topic_values.hpp"

#include <algorithm>

#include "plant/field_text.hpp"
#include "plant/keys.hpp"
#include "plant/protocol.hpp"
#include "sim/check.hpp"
#include "uadp/store_number.hpp"

namespace takt::application {
namespace {

/// Before the values of a Variant: its type, and the length of an array.
std::size_t value_header(const gateway::DataSetField& field) { return field.type.is_array ? 5 : 1; }

}  // namespace

Publication::Publication(const TopicShape& topic, const plant::Payload& payload)
    : topic_(&topic),
      payload_(payload),
      mapping_(own_mapping(topic, gateway::Direction::to_dds)),
      fields_(topic.zeros()),
      value_at_(topic.value.offset) {
  if (!payload.values.empty()) put_values(payload.values);
}

/// Values are as long as they are, so that what stands behind them moves. Topics with keys have none.
void Publication::put_values(const json::NameMap<std::string>& values) {
  std::vector<std::byte> with_values;
  uadp::Reader reader(fields_);
  for (const gateway::DataSetField& field : topic_->fields) {
    const std::size_t begin = reader.position();
    if (begin == topic_->value.offset - value_header(field)) value_at_ = with_values.size() + value_header(field);
    uadp::get_variant(reader);
    const uadp::Octets zero = reader.since(begin);
    const auto given =
        std::find_if(values.begin(), values.end(), [&](const auto& each) { return each.first == field.name; });
    if (given == values.end()) {
      with_values.insert(with_values.end(), zero.begin(), zero.end());
      continue;
    }
    const auto octets = plant::octets_of_text(plant::topic_type_of(field.type.type), given->second);
    TAKT_CHECK(octets.has_value(), "values of fields have been checked");
    with_values.push_back(zero[0]);
    with_values.insert(with_values.end(), octets->begin(), octets->end());
  }
  fields_ = std::move(with_values);
}

void Publication::restart() { count_ = 0; }

uadp::Octets Publication::next() {
  ++count_;
  const auto store = [this](uadp::BuiltInType type, std::size_t at, std::uint64_t number) {
    const bool is_number = uadp::store_number(type, fields_.data() + at, number);
    TAKT_CHECK(is_number, "a pattern is in a field that is a number");
  };
  for (const TopicShape::Place& key : topic_->keys) store(key.type, key.offset, plant::instance_of(payload_, count_));
  store(topic_->value.type, value_at_, payload_.pattern == plant::Pattern::alternate ? count_ % 2 : count_);
  const std::optional<uadp::Octets> carried = copy(fields_);
  TAKT_CHECK(carried.has_value(), "fields of the topic's types");
  return *carried;
}

std::optional<uadp::Octets> Publication::copy(uadp::Octets fields) {
  if (!mapping_) return fields;
  if (mapping_->to_cdr(fields, carried_) != gateway::MappingError::none) return std::nullopt;
  return carried_;
}

std::optional<uadp::Octets> Subscription::take(uadp::Octets value) {
  if (!mapping_) return value;
  if (mapping_->to_fields(value, fields_) != gateway::MappingError::none) return std::nullopt;
  return fields_;
}

}  // namespace takt::application
