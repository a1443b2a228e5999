// SPDX-License-Identifier: Apache-2.0
// The header layout UADP-Periodic-Fixed (OPC 10000-14, A.2.1): every octet at an offset that is known beforehand.
//
// The hot path: a NetworkMessage is a prototype with numbers stored into it, and the receiver compares the constant
// octets and loads. Byte for byte what NetworkMessageEncoder writes.
#pragma once

#include <cstring>
#include <vector>

#include "sim/check.hpp"
#include "uadp/publisher_id.hpp"
#include "uadp/raw_layout.hpp"
#include "uadp/value.hpp"

namespace takt::uadp {

class PeriodicFixedLayout {
 public:
  struct Settings {
    PublisherId publisher_id;  ///< UInt16 or UInt64 by A.2.1; any numeric type is accepted
    std::uint16_t writer_group_id = 1;
    std::uint32_t group_version = 0;  ///< VersionTime; 0 is "none yet"
    std::uint16_t network_message_number = 1;
    std::vector<RawLayout> data_sets;                ///< in ascending order of the DataSetWriterIds
    std::vector<std::size_t> configured_sizes = {};  ///< of the DataSetMessages, 0: as long as they are; may be shorter
  };

  /// Allocates; nothing after does.
  explicit PeriodicFixedLayout(const Settings& settings);

  /// Octets of the NetworkMessage.
  std::size_t size() const { return prototype_.size(); }
  /// DataSetOffset: octets from the begin of the NetworkMessage to a DataSetMessage.
  std::size_t data_set_offset(std::size_t data_set) const { return data_sets_[data_set].begin; }
  /// Octets from the begin of the NetworkMessage to a field.
  std::size_t field_offset(std::size_t data_set, std::size_t field) const {
    return data_sets_[data_set].field_offsets[field];
  }
  /// Of all fields of a DataSetMessage: what a loop over them should ask once.
  std::span<const std::size_t> field_offsets(std::size_t data_set) const { return data_sets_[data_set].field_offsets; }

  /// Fields of one type that stand one after another, from `field` on: stored and loaded as one, with one look at the
  /// layout. They must be scalars of the type of T. `target` and `octets` must have size() octets.
  template <FixedScalar T, std::size_t Count>
  void store_values(std::span<std::byte> target, std::size_t data_set, std::size_t field,
                    std::span<const T, Count> values) const;
  template <FixedScalar T, std::size_t Count>
  void load_values(Octets octets, std::size_t data_set, std::size_t field, std::span<T, Count> values) const;

  /// Puts the constant octets and the sequence number of the group; the fields are zeros. `target` must have size()
  /// octets.
  void start(std::span<std::byte> target, std::uint16_t sequence_number) const;
  /// The same of a layout that has so many octets, as is known beforehand.
  template <std::size_t octets>
  void start(std::span<std::byte> target, std::uint16_t sequence_number) const;
  /// Puts the header of a DataSetMessage; `status` is the upper half of a StatusCode.
  void set_header(std::span<std::byte> target, std::size_t data_set, std::uint16_t sequence_number,
                  std::uint16_t status = 0) const;

  /// True if these octets are a message of this layout: long enough, and all constant octets as they should be.
  /// A DataSetMessage that is not valid makes it false.
  bool matches(Octets octets) const;
  std::uint16_t group_sequence_number(Octets octets) const {
    return load_little_endian<std::uint16_t>(octets.data() + sequence_at_);
  }
  std::uint16_t sequence_number(Octets octets, std::size_t data_set) const {
    return load_little_endian<std::uint16_t>(octets.data() + data_sets_[data_set].begin + 1);
  }
  std::uint16_t status(Octets octets, std::size_t data_set) const {
    return load_little_endian<std::uint16_t>(octets.data() + data_sets_[data_set].begin + 3);
  }

  /// DataSetFlags1, sequence number, status.
  static constexpr std::size_t header_octets = 5;

 private:
  /// Scalars of one type that follow one another.
  struct Run {
    BuiltInType type{};
    std::size_t count = 0;  ///< 0 where there is no scalar
  };
  struct DataSet {
    std::size_t begin = 0;
    std::vector<std::size_t> field_offsets;
    std::vector<Run> runs;  ///< that begin at a field
  };
  /// Where such fields are, of which there must be `count`.
  template <FixedScalar T>
  std::size_t offset_of_run(std::size_t data_set, std::size_t field, std::size_t count) const;

  std::vector<std::byte> prototype_;
  std::size_t sequence_at_ = 0;  ///< the last two octets of the header
  std::vector<DataSet> data_sets_;
};

// Inline, for they are a few instructions each.

inline void PeriodicFixedLayout::start(std::span<std::byte> target, std::uint16_t sequence_number) const {
  TAKT_CHECK(target.size() >= prototype_.size(), "the target has room for the layout");
  std::memcpy(target.data(), prototype_.data(), prototype_.size());
  store_little_endian(target.data() + sequence_at_, sequence_number);
}

template <std::size_t octets>
void PeriodicFixedLayout::start(std::span<std::byte> target, std::uint16_t sequence_number) const {
  TAKT_CHECK(prototype_.size() == octets && target.size() >= octets,
             "the layout has its length, and the target room for it");
  std::memcpy(target.data(), prototype_.data(), octets);
  store_little_endian(target.data() + sequence_at_, sequence_number);
}

inline void PeriodicFixedLayout::set_header(std::span<std::byte> target, std::size_t data_set,
                                            std::uint16_t sequence_number, std::uint16_t status) const {
  std::byte* const begin = target.data() + data_sets_[data_set].begin;
  store_little_endian(begin + 1, sequence_number);
  store_little_endian(begin + 3, status);
}

inline bool PeriodicFixedLayout::matches(Octets octets) const {
  if (octets.size() < prototype_.size()) return false;
  // Constant are the octets before the sequence number, 12 at least: in words that may overlap.
  const std::size_t last = sequence_at_ - 8;
  for (std::size_t at = 0; at < last; at += 8)
    if (load_little_endian<std::uint64_t>(octets.data() + at) !=
        load_little_endian<std::uint64_t>(prototype_.data() + at))
      return false;
  if (load_little_endian<std::uint64_t>(octets.data() + last) !=
      load_little_endian<std::uint64_t>(prototype_.data() + last))
    return false;
  for (const DataSet& each : data_sets_)
    if (octets[each.begin] != prototype_[each.begin]) return false;
  return true;
}

template <FixedScalar T>
std::size_t PeriodicFixedLayout::offset_of_run(std::size_t data_set, std::size_t field, std::size_t count) const {
  const DataSet& of = data_sets_[data_set];
  TAKT_CHECK(field < of.runs.size() && of.runs[field].type == BuiltIn<T>::type && of.runs[field].count >= count,
             "so many fields of the type follow one another");
  return of.field_offsets[field];
}

template <FixedScalar T, std::size_t Count>
void PeriodicFixedLayout::store_values(std::span<std::byte> target, std::size_t data_set, std::size_t field,
                                       std::span<const T, Count> values) const {
  std::byte* const at = target.data() + offset_of_run<T>(data_set, field, values.size());
  TAKT_CHECK(target.size() >= prototype_.size(), "the target has room for the layout");
  if constexpr (is_encoded_as_it_is<T>) {
    std::memcpy(at, values.data(), values.size_bytes());
  } else {
    for (std::size_t i = 0; i < values.size(); ++i) store_value(at + i * fixed_octets(BuiltIn<T>::type), values[i]);
  }
}

template <FixedScalar T, std::size_t Count>
void PeriodicFixedLayout::load_values(Octets octets, std::size_t data_set, std::size_t field,
                                      std::span<T, Count> values) const {
  const std::byte* const at = octets.data() + offset_of_run<T>(data_set, field, values.size());
  TAKT_CHECK(octets.size() >= prototype_.size(), "the octets are a message of the layout");
  if constexpr (is_encoded_as_it_is<T>) {
    std::memcpy(values.data(), at, values.size_bytes());
  } else {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = load_value<T>(at + i * fixed_octets(BuiltIn<T>::type));
  }
}

}  // namespace takt::uadp
