// SPDX-License-Identifier: Apache-2.0
// What threads of applications publish and what they take, as the protocol of the topic carries it.
#pragma once

#include "application/topic_shape.hpp"

namespace takt::application {

/// The values of a thread that publishes. No call allocates once the first one has been made.
class Publication {
 public:
  /// The topic outlives it.
  Publication(const TopicShape& topic, const plant::Payload& payload);

  /// The application has started anew: it begins with the first value.
  void restart();
  /// The next value of its pattern; valid until the next call of either.
  uadp::Octets next();
  /// What another topic with the same types last said, as fields; nothing if one of them has no value.
  std::optional<uadp::Octets> copy(uadp::Octets fields);
  /// The fields of the last value of its pattern.
  uadp::Octets fields() const { return fields_; }

 private:
  void put_values(const json::NameMap<std::string>& values);

  const TopicShape* topic_;
  plant::Payload payload_;
  std::optional<gateway::TypeMapping> mapping_;
  std::vector<std::byte> fields_;
  std::size_t value_at_;  ///< where the pattern is in `fields_`
  std::vector<std::byte> carried_;
  std::uint64_t count_ = 0;
};

/// The values that a thread takes.
class Subscription {
 public:
  explicit Subscription(const TopicShape& topic) : mapping_(own_mapping(topic, gateway::Direction::to_opc_ua)) {}

  /// The fields of a value that has come, valid until the next call; nothing if it is not of the topic's type.
  std::optional<uadp::Octets> take(uadp::Octets value);

 private:
  std::optional<gateway::TypeMapping> mapping_;
  std::vector<std::byte> fields_;
};

}  // namespace takt::application
