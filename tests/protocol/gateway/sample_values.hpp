// SPDX-License-Identifier: Apache-2.0
// Plant::Sample as a DataSet of OPC UA: its fields, their types, and the values that stock_publisher.c gives to number
// n.
#pragma once

#include <array>
#include <string>
#include <tuple>
#include <vector>

#include "gateway/type_mapping.hpp"
#include "pubsub/data_set.hpp"

namespace takt::gateway::testing {

using Sample = std::tuple<bool, std::int8_t, std::uint8_t, std::int16_t, std::uint16_t, std::int32_t, std::uint32_t,
                          std::int64_t, std::uint64_t, float, double, std::string, pubsub::BoundedString<16>,
                          uadp::Guid, std::array<double, 6>, std::array<bool, 3>, pubsub::ByteString,
                          std::vector<double>, std::vector<std::string>, uadp::DateTime, uadp::Status>;

inline constexpr std::array<const char*, std::tuple_size_v<Sample>> member_names = {
    "on",   "tiny",  "raw", "small", "usmall", "number", "unumber", "big",   "ubig",  "ratio", "speed",
    "name", "label", "id",  "axes",  "flags",  "blob",   "path",    "words", "stamp", "status"};

inline Sample sample_of(std::uint32_t n) {
  uadp::Guid id;
  uadp::store_little_endian(id.octets.data(), n);
  uadp::store_little_endian(id.octets.data() + 4, static_cast<std::uint16_t>(n));
  uadp::store_little_endian(id.octets.data() + 6, std::uint16_t{7});
  for (std::uint32_t i = 0; i < 8; ++i) id.octets[8 + i] = static_cast<std::byte>(n + i);
  std::array<double, 6> axes{};
  for (std::uint32_t i = 0; i < 6; ++i) axes[i] = n + 0.125 * i;
  std::array<bool, 3> flags{};
  for (std::uint32_t i = 0; i < 3; ++i) flags[i] = (n >> i) % 2 == 1;
  pubsub::ByteString blob;
  for (std::uint32_t i = 0; i < n % 5; ++i) blob.push_back(static_cast<std::byte>(n + i));
  std::vector<double> path;
  for (std::uint32_t i = 0; i < n % 9; ++i) path.push_back(0.5 * i - n);
  std::vector<std::string> words;
  for (std::uint32_t i = 0; i < n % 4; ++i) words.push_back("w" + std::to_string(i) + "-" + std::to_string(n));
  const auto signed_n = static_cast<std::int64_t>(n);
  return {n % 2 == 1,
          static_cast<std::int8_t>(-static_cast<int>(n % 100)),
          static_cast<std::uint8_t>(n),
          static_cast<std::int16_t>(-signed_n),
          static_cast<std::uint16_t>(3 * n),
          -static_cast<std::int32_t>(n * 100003U),
          n * 40000003U,
          -signed_n * 1'000'000'000'000,
          std::uint64_t{n} * 1'000'000'000'000'000U,
          0.5F * static_cast<float>(n),
          0.25 * n + 0.001,
          "sample " + std::to_string(n),
          pubsub::BoundedString<16>("L" + std::to_string(n % 1000)),
          id,
          axes,
          flags,
          blob,
          path,
          words,
          uadp::DateTime{132'000'000'000'000'000 + signed_n},
          uadp::Status{0x80000000U | n}};
}

inline std::vector<DataSetField> sample_fields() {
  const pubsub::DataSet<Sample> typed;
  std::vector<DataSetField> fields;
  for (std::size_t i = 0; i < typed.field_count(); ++i) fields.push_back({member_names[i], typed.field(i)});
  return fields;
}

/// As stock/plant.idl declares it: an array of OPC UA without a length is a sequence, here one with a bound.
inline IdlStruct sample_type() {
  IdlStruct type{"Plant::Sample", {}};
  for (const DataSetField& field : sample_fields()) {
    std::string problem;
    type.members.push_back(idl_member_of(field, problem).value());
    if (field.name == "path") type.members.back().length = 8;
  }
  return type;
}

}  // namespace takt::gateway::testing
