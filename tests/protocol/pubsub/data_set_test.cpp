// SPDX-License-Identifier: Apache-2.0
// DataSet<T> for every type that it may have: described, sent, taken.
#include "pubsub/data_set.hpp"

#include <gtest/gtest.h>

#include "sim/check.hpp"

namespace takt::pubsub {
namespace {

using uadp::BuiltInType;

template <class T>
T sample() {
  if constexpr (std::same_as<T, uadp::DateTime>) {
    return {133500000000000000};
  } else if constexpr (std::same_as<T, uadp::Guid>) {
    uadp::Guid guid;
    guid.octets[3] = std::byte{7};
    return guid;
  } else if constexpr (std::same_as<T, uadp::Status>) {
    return {0x80AF0000};
  } else if constexpr (std::same_as<T, std::string> || std::same_as<T, BoundedString<8>>) {
    return T(std::string_view("abc"));
  } else if constexpr (std::same_as<T, ByteString>) {
    return {std::byte{1}, std::byte{2}};
  } else {
    return T(1);
  }
}

template <class T>
void expect_round_trip(const T& value) {
  DataSet<T> sent(value);
  DataSet<T> received;
  std::array<std::byte, 256> buffer{};
  uadp::Writer writer(buffer);
  sent.put(writer, 0);
  uadp::Reader reader(writer.finished());
  const uadp::Variant variant = uadp::get_variant(reader);
  ASSERT_FALSE(reader.failed());
  EXPECT_EQ(variant.type, sent.field(0).type);
  EXPECT_TRUE(received.can_take(0, variant));
  EXPECT_TRUE(received.take(0, variant));
  EXPECT_TRUE(received.get() == value);
  if (const auto layout = raw_layout_of(sent)) {
    std::array<std::byte, 256> raw{};
    uadp::Writer raw_writer(raw);
    ASSERT_TRUE(layout->put(raw_writer, 0, variant));
    DataSet<T> from_raw;
    EXPECT_TRUE(from_raw.take(0, layout->at(raw_writer.finished(), 0).value()));
    EXPECT_TRUE(from_raw.get() == value);
  }
}

template <class T>
class Types : public testing::Test {};
using All = testing::Types<bool, std::int8_t, std::uint8_t, std::int16_t, std::uint16_t, std::int32_t, std::uint32_t,
                           std::int64_t, std::uint64_t, float, double, uadp::DateTime, uadp::Guid, uadp::Status,
                           std::string, BoundedString<8>, ByteString>;
TYPED_TEST_SUITE(Types, All);

TYPED_TEST(Types, AsAScalar) { expect_round_trip(sample<TypeParam>()); }
TYPED_TEST(Types, AsAnArray) {
  expect_round_trip(std::array<TypeParam, 3>{sample<TypeParam>(), {}, sample<TypeParam>()});
}
TYPED_TEST(Types, AsAVector) {
  expect_round_trip(std::vector<TypeParam>{sample<TypeParam>(), sample<TypeParam>()});
  expect_round_trip(std::vector<TypeParam>{});
}

TEST(DataSets, ATupleHasAFieldForEachElement) {
  DataSet<std::tuple<std::int32_t, std::array<double, 6>, BoundedString<5>>> data_set;
  ASSERT_EQ(data_set.field_count(), 3u);
  EXPECT_EQ(data_set.field(0), (uadp::RawField{BuiltInType::Int32}));
  EXPECT_EQ(data_set.field(1), (uadp::RawField{BuiltInType::Double, true, 6}));
  EXPECT_EQ(data_set.field(2), (uadp::RawField{BuiltInType::String, false, 0, 5}));
  EXPECT_EQ(raw_layout_of(data_set)->size(), 4u + (4 + 48) + (4 + 5));
  EXPECT_FALSE(raw_layout_of(DataSet<std::string>())) << "a std::string has no longest length";
  EXPECT_FALSE(raw_layout_of(DataSet<std::vector<double>>()));
}

TEST(DataSets, TakeNothingOfAnotherTypeOrLength) {
  DataSet<std::array<double, 2>> data_set({1.0, 2.0});
  std::array<std::byte, 64> buffer{};
  const auto is_taken = [&](const auto& value) {
    uadp::Writer writer(buffer);
    put_field(writer, value);
    uadp::Reader reader(writer.finished());
    const uadp::Variant variant = uadp::get_variant(reader);
    EXPECT_EQ(data_set.can_take(0, variant), data_set.take(0, variant)) << "both say the same";
    return data_set.get() != std::array<double, 2>{1.0, 2.0};
  };
  EXPECT_FALSE(is_taken(3.0));
  EXPECT_FALSE(is_taken(std::array<float, 2>{3, 4}));
  EXPECT_FALSE(is_taken(std::array<double, 3>{3, 4, 5}));
  EXPECT_TRUE(is_taken(std::array<double, 2>{3, 4}));
}

TEST(DataSets, SetCountsAndNotifyTells) {
  DataSet<double> data_set(1.5);
  const std::uint64_t before = data_set.version();
  data_set.set(2.5);
  EXPECT_NE(data_set.version(), before);
  double told = 0;
  data_set.on_received([&](double value) { told = value; });
  data_set.notify();
  EXPECT_EQ(told, 2.5);
}

}  // namespace
}  // namespace takt::pubsub
