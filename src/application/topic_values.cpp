#include "application/topic_values.hpp"

#include "plant/keys.hpp"
#include "sim/check.hpp"
#include "uadp/store_number.hpp"

namespace takt::application {

Publication::Publication(const TopicShape& topic, const plant::Payload& payload)
    : topic_(&topic), payload_(payload), mapping_(own_mapping(topic, gateway::Direction::to_dds)), fields_(topic.zeros()) {}

void Publication::restart() { count_ = 0; }

uadp::Octets Publication::next() {
  ++count_;
  const auto store = [this](const TopicShape::Place& place, std::uint64_t number) {
    const bool is_number = uadp::store_number(place.type, fields_.data() + place.offset, number);
    TAKT_CHECK(is_number, "fields of topics are numbers");
  };
  for (const TopicShape::Place& key : topic_->keys) store(key, plant::instance_of(payload_, count_));
  store(topic_->value, payload_.pattern == plant::Pattern::alternate ? count_ % 2 : count_);
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
