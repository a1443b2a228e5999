// SPDX-License-Identifier: Apache-2.0
// Whether what a writer offers is what a reader requests (DDS 1.4, 2.2.3), and if not, by which policy and why.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dds/qos/policies.hpp"

namespace takt::dds {

/// Ids of DDS 1.4 (annex "IDL PSM"), as OFFERED_INCOMPATIBLE_QOS tells them.
enum class PolicyId : std::uint8_t {
  durability = 2,
  presentation = 3,
  deadline = 4,
  latency_budget = 5,
  ownership = 6,
  liveliness = 8,
  partition = 10,
  reliability = 11,
  destination_order = 12,
  data_representation = 23,  ///< of DDS-XTypes
};
/// "reliability" ...
std::string_view name_of(PolicyId policy);

struct Mismatch {
  PolicyId policy = PolicyId::reliability;
  std::string reason;  ///< "offered BEST_EFFORT, requested RELIABLE"
  bool operator==(const Mismatch&) const = default;
};

/// All that does not fit, in the order of the rules' table; empty: the two match.
std::vector<Mismatch> mismatches_of(const DataWriterQos& offered, const DataReaderQos& requested);

/// Whether two sets of partitions have a name in common. A name with * ? or [...] (POSIX fnmatch) stands for all names
/// that fit; two of these do not fit each other.
bool have_common_partition(const Partition& a, const Partition& b);

/// POSIX fnmatch without flags but for escapes: * any text, ? one letter, [abc], [a-z], [!a-z].
bool fits_pattern(std::string_view pattern, std::string_view name);

/// Data representations of DDS-XTypes. No list stands for XCDR1.
enum class DataRepresentation : std::int16_t { xcdr1 = 0, xml = 1, xcdr2 = 2 };

/// What a writer and a reader are, as far as matching goes.
struct WriterDescription {
  std::string_view topic;
  std::string_view type;
  const DataWriterQos* qos = nullptr;
  const std::vector<DataRepresentation>* representations = nullptr;
};
struct ReaderDescription {
  std::string_view topic;
  std::string_view type;
  const DataReaderQos* qos = nullptr;
  const std::vector<DataRepresentation>* representations = nullptr;
};

enum class Relation : std::uint8_t {
  other_topic,   ///< nothing to do with each other
  other_type,    ///< INCONSISTENT_TOPIC: one topic, two types
  incompatible,  ///< OFFERED_ and REQUESTED_INCOMPATIBLE_QOS
  matched,
};

struct Matching {
  Relation relation = Relation::other_topic;
  std::vector<Mismatch> mismatches;  ///< of `incompatible`
  std::string reason;                ///< of `other_type` and `incompatible`, for people
  bool is_match() const { return relation == Relation::matched; }
};

Matching match(const WriterDescription& writer, const ReaderDescription& reader);

}  // namespace takt::dds
