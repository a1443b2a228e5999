// SPDX-License-Identifier: Apache-2.0
// A topic as protocol code sees it: the fields of a DataSet, and of DDS the struct that stands for them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gateway/key_layout.hpp"
#include "gateway/type_mapping.hpp"
#include "plant/application.hpp"

namespace takt::application {

/// Values of a topic stand in memory as all its fields, Variants one behind the other (OPC 10000-6, 5.2.2.16). So OPC
/// UA carries them; DDS carries the struct in CDR.
struct TopicShape {
  /// The first value of a field.
  struct Place {
    std::size_t offset = 0;
    uadp::BuiltInType type = uadp::BuiltInType::Double;
  };

  bool is_dds = false;
  std::vector<gateway::DataSetField> fields;
  gateway::IdlStruct type;
  gateway::KeyLayout key;  ///< of DDS; in a payload
  std::vector<Place> keys;
  Place value;                    ///< of the first field that is a number and no key: what a pattern says
  plant::UadpLayout layout = {};  ///< of OPC UA

  /// Octets of all values alone.
  std::size_t octets() const;
  /// All zeros and empty; the places above are in it.
  std::vector<std::byte> zeros() const;
  /// The longest values: zeros, texts with all octets that they may have.
  std::vector<std::byte> longest() const;
  /// Whether the first value is zero.
  bool is_zero(uadp::Octets value_of_topic) const;
};

/// `keys` have been checked; none of OPC UA.
TopicShape shape_of(const plant::Topic& topic, const std::vector<std::string>& keys);

/// Whether values of one may be published to the other: the same types in the same order.
bool have_same_types(const TopicShape& one, const TopicShape& other);

/// Between fields and struct of one topic. Nothing of OPC UA, which carries the fields themselves.
std::optional<gateway::TypeMapping> own_mapping(const TopicShape& topic, gateway::Direction direction);
/// From a topic of one protocol to one of the other: fields and members are found by their names. Nothing if there is a
/// problem; each is a line.
std::optional<gateway::TypeMapping> mapping_between(const TopicShape& from, const TopicShape& to,
                                                    std::vector<std::string>& problems);

}  // namespace takt::application
