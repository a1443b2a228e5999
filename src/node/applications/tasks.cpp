#include "node/applications/tasks.hpp"

#include <algorithm>

#include "gateway/field_values.hpp"
#include "sim/check.hpp"
#include "uadp/store_number.hpp"
#include "plant/keys.hpp"

namespace takt::node {
namespace {

using gateway::Direction;

std::optional<gateway::TypeMapping> own_mapping(const TopicEnd& topic, Direction direction) {
  if (!topic.is_dds) return std::nullopt;
  std::vector<std::string> problems;
  auto mapping = gateway::TypeMapping::make(direction, topic.shape->fields, topic.shape->type, {}, problems);
  TAKT_CHECK(mapping.has_value(), "the members of a topic are made from its fields");
  return mapping;
}

CallResult result_of(SendOutcome outcome) {
  return {.sent = outcome == SendOutcome::sent ? 1U : 0U, .timed_out = outcome == SendOutcome::timed_out ? 1U : 0U, .not_sent = outcome == SendOutcome::failed ? 1U : 0U};
}

class Publishing final : public Work {
 public:
  Publishing(const TopicEnd& topic, TopicWriter& writer, const std::optional<Payload>& payload, NewestSamples& newest)
      : writer_(writer), newest_(newest), payload_(payload.value_or(Payload{})), mapping_(own_mapping(topic, Direction::to_dds)) {
    const gateway::FieldValues zeros(topic.shape->fields);
    const uadp::Octets octets = zeros.octets();
    fields_.assign(octets.begin(), octets.end());
    value_ = place_of(*topic.shape, topic.shape->value_field);
    for (const std::size_t key : topic.shape->key_fields) keys_.push_back(place_of(*topic.shape, key));
  }

  CallResult call(std::int64_t) override {
    if (payload_.copy_of) {
      if (!newest_.get(*payload_.copy_of, fields_)) return {};
    } else {
      ++count_;
      for (const Place& key : keys_) store(key, plant::instance_of(payload_, count_));
      store(value_, payload_.pattern == Pattern::alternate ? count_ % 2 : count_);
    }
    if (mapping_ && mapping_->to_cdr(fields_, payload_octets_) != gateway::MappingError::none) return {};
    return result_of(writer_.write(mapping_ ? payload_octets_ : fields_));
  }

 private:
  /// The first value of a field among the Variants.
  struct Place {
    std::size_t at = 0;
    uadp::BuiltInType type = uadp::BuiltInType::Double;
  };
  static Place place_of(const TopicShape& shape, std::size_t field) {
    std::size_t at = 0;
    // Each is the octet of its type, the length of an array, and the values.
    const auto header = [&](std::size_t f) { return std::size_t{shape.fields[f].type.is_array ? 5U : 1U}; };
    for (std::size_t f = 0; f < field; ++f) at += header(f) + uadp::fixed_octets(shape.fields[f].type.type) * (shape.fields[f].type.is_array ? shape.fields[f].type.array_length : 1);
    return {at + header(field), shape.fields[field].type.type};
  }
  void store(const Place& place, std::uint64_t number) {
    const bool is_number = uadp::store_number(place.type, fields_.data() + place.at, number);
    TAKT_CHECK(is_number, "fields of topics are numbers");
  }

  TopicWriter& writer_;
  NewestSamples& newest_;
  Payload payload_;
  std::optional<gateway::TypeMapping> mapping_;
  std::vector<std::byte> fields_;
  std::vector<std::byte> payload_octets_;
  Place value_;
  std::vector<Place> keys_;
  std::uint64_t count_ = 0;
};

class Subscribing final : public Work {
 public:
  Subscribing(const std::string& name, const TopicEnd& topic, TopicReader& reader, std::uint32_t buffer, bool is_copied, NewestSamples& newest)
      : name_(name), reader_(reader), newest_(newest), buffer_(buffer), is_copied_(is_copied), mapping_(own_mapping(topic, Direction::to_opc_ua)) {}

  CallResult call(std::int64_t) override {
    CallResult result;
    for (const std::vector<std::byte>& value : reader_.take()) {
      // What is not of the type that was agreed is no value.
      if (mapping_ && mapping_->to_fields(value, fields_) != gateway::MappingError::none) continue;
      if (is_copied_) newest_.put(name_, mapping_ ? fields_ : value);
      ++result.taken;
    }
    result.buffered = std::min(result.taken, buffer_);
    return result;
  }
  std::uint64_t lost() const override { return reader_.lost(); }

 private:
  std::string name_;
  TopicReader& reader_;
  NewestSamples& newest_;
  std::uint32_t buffer_;
  bool is_copied_;
  std::optional<gateway::TypeMapping> mapping_;
  std::vector<std::byte> fields_;
};

class Receiving final : public Work {
 public:
  Receiving(TopicReader& reader, SharedChannel& channel) : reader_(reader), channel_(channel) {}

  CallResult call(std::int64_t now) override {
    CallResult result;
    const std::span<const std::vector<std::byte>> values = reader_.take();
    const std::lock_guard lock(channel_.mutex);
    for (const std::vector<std::byte>& value : values) channel_.channel.receive(value, channel_.local(now));
    result.taken = result.buffered = static_cast<std::uint32_t>(values.size());
    return result;
  }
  std::uint64_t lost() const override { return reader_.lost(); }

 private:
  TopicReader& reader_;
  SharedChannel& channel_;
};

class Sending final : public Work {
 public:
  Sending(TopicWriter& writer, SharedChannel& channel) : writer_(writer), channel_(channel) {}

  CallResult call(std::int64_t now) override {
    {
      const std::lock_guard lock(channel_.mutex);
      const auto next = channel_.channel.pull(channel_.local(now));
      if (!next) return {};
      value_.assign(next->octets.begin(), next->octets.end());
    }
    return result_of(writer_.write(value_));  // outside of the lock: a reliable writer may wait
  }

 private:
  TopicWriter& writer_;
  SharedChannel& channel_;
  std::vector<std::byte> value_;
};

}  // namespace

void NewestSamples::put(const std::string& topic, const std::vector<std::byte>& fields) {
  const std::lock_guard lock(mutex_);
  samples_[topic] = fields;
}

bool NewestSamples::get(const std::string& topic, std::vector<std::byte>& fields) const {
  const std::lock_guard lock(mutex_);
  const auto found = samples_.find(topic);
  if (found == samples_.end()) return false;
  fields = found->second;
  return true;
}

std::unique_ptr<Work> make_publishing(const TopicEnd& topic, TopicWriter& writer, const std::optional<Payload>& payload, NewestSamples& newest) {
  return std::make_unique<Publishing>(topic, writer, payload, newest);
}
std::unique_ptr<Work> make_subscribing(const std::string& name, const TopicEnd& topic, TopicReader& reader, std::uint32_t buffer, bool is_copied, NewestSamples& newest) {
  return std::make_unique<Subscribing>(name, topic, reader, buffer, is_copied, newest);
}
std::unique_ptr<Work> make_receiving(TopicReader& reader, SharedChannel& channel) { return std::make_unique<Receiving>(reader, channel); }
std::unique_ptr<Work> make_sending(TopicWriter& writer, SharedChannel& channel) { return std::make_unique<Sending>(writer, channel); }

}  // namespace takt::node
