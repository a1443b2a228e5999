// SPDX-License-Identifier: Apache-2.0
// Every scalar type, alone and in arrays, there and back.
#include "uadp/variant.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "uadp/message_json.hpp"

namespace takt::uadp {
namespace {

template <class T>
std::vector<T> samples() {
  if constexpr (std::same_as<T, bool>) {
    return {true, false};
  } else if constexpr (std::same_as<T, DateTime>) {
    return {{133500000000000000}, {0}, {-1}};
  } else if constexpr (std::same_as<T, Guid>) {
    Guid guid;
    for (unsigned i = 0; i < 16; ++i) guid.octets[i] = static_cast<std::byte>(i);
    return {guid, {}};
  } else if constexpr (std::same_as<T, Status>) {
    return {{0x80AF0000}, {0}};
  } else if constexpr (std::same_as<T, std::string_view>) {
    return {"", "a", "\xCE\xA9"};
  } else {
    return {std::numeric_limits<T>::lowest(), T{}, T{1}, std::numeric_limits<T>::max()};
  }
}

template <class T>
class Scalars : public testing::Test {};
using All = testing::Types<bool, std::int8_t, std::uint8_t, std::int16_t, std::uint16_t, std::int32_t, std::uint32_t,
                           std::int64_t, std::uint64_t, float, double, std::string_view, DateTime, Guid, Status>;
TYPED_TEST_SUITE(Scalars, All);

TYPED_TEST(Scalars, GoThereAndBack) {
  using T = TypeParam;
  std::array<std::byte, 256> buffer{};
  for (const T& value : samples<T>()) {
    Writer writer(buffer);
    put_variant(writer, value);
    Reader reader(writer.finished());
    const Variant variant = get_variant(reader);
    ASSERT_FALSE(reader.failed());
    EXPECT_EQ(reader.left(), 0u);
    EXPECT_EQ(variant.type, BuiltIn<T>::type);
    EXPECT_EQ(variant.template get<T>(), value);
    EXPECT_FALSE(variant.template at<T>(0)) << "a scalar is no array";
    if constexpr (!std::same_as<T, bool>) {
      EXPECT_FALSE(variant.template get<bool>()) << "no conversion";
    }
  }
}

TYPED_TEST(Scalars, GoThereAndBackInArrays) {
  using T = TypeParam;
  std::array<std::byte, 256> buffer{};
  std::array<T, 4> values{};
  const std::vector<T> all = samples<T>();
  for (std::size_t i = 0; i < all.size(); ++i) values[i] = all[i];
  Writer writer(buffer);
  put_variant(writer, std::span<const T>(values.data(), all.size()));
  Reader reader(writer.finished());
  const Variant variant = get_variant(reader);
  ASSERT_FALSE(reader.failed());
  ASSERT_TRUE(variant.is_array);
  ASSERT_EQ(variant.size(), all.size());
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(variant.template at<T>(i), values[i]);
  EXPECT_FALSE(variant.template at<T>(all.size()));
  EXPECT_FALSE(variant.template get<T>());
  std::array<std::byte, 256> again{};
  Writer copy(again);
  put_variant(copy, variant);
  EXPECT_EQ(hex_of(copy.finished()), hex_of(writer.finished()));
}

TEST(Variants, AByteStringIsAView) {
  std::array<std::byte, 16> buffer{};
  Writer writer(buffer);
  const std::vector<std::byte> three = octets_of("010203");
  put_variant(writer, ByteStringView{three});
  EXPECT_EQ(hex_of(writer.finished()), "0f03000000010203");
  Reader reader(writer.finished());
  EXPECT_EQ(hex_of(get_variant(reader).get<ByteStringView>().value().octets), "010203");
}

// Types without a C++ type of their own are stepped over, whole, and written back as they came.
TEST(Variants, EveryOtherTypeIsKept) {
  const std::vector<std::string> encoded = {
      "00",  // Null
      "10"
      "02000000"
      "3c3e",  // XmlElement
      "11"
      "0005",  // NodeId, two octets
      "11"
      "01050203",  // four octets
      "11"
      "02010002000000",  // numeric
      "11"
      "03010001000000"
      "61",  // string
      "11"
      "040100"
      "000102030405060708090a0b0c0d0e0f",  // Guid
      "12"
      "c00501000000"
      "61"
      "02000000",  // ExpandedNodeId with URI and server
      "14"
      "0100"
      "01000000"
      "61",  // QualifiedName
      "15"
      "03"
      "02000000"
      "656e"
      "01000000"
      "61",  // LocalizedText
      "16"
      "0005"
      "01"
      "02000000"
      "ffff",  // ExtensionObject with octets
      "16"
      "0005"
      "00",  // without a body
      "17"
      "03"
      "0101"
      "00000080",  // DataValue
      "19"
      "7f"
      "01000000020000000300000004000000"
      "01000000"
      "61"
      "00000080"
      "00",  // DiagnosticInfo in a DiagnosticInfo
  };
  for (const std::string& hex : encoded) {
    SCOPED_TRACE(hex);
    const std::vector<std::byte> octets = octets_of(hex);
    Reader reader(octets);
    const Variant variant = get_variant(reader);
    ASSERT_FALSE(reader.failed());
    EXPECT_EQ(reader.left(), 0u);
    std::array<std::byte, 64> buffer{};
    Writer writer(buffer);
    put_variant(writer, variant);
    EXPECT_EQ(hex_of(writer.finished()), hex);
    for (std::size_t length = 0; length < octets.size(); ++length) {
      Reader cut{Octets(octets).first(length)};
      get_variant(cut);
      EXPECT_TRUE(cut.failed()) << length << " octets";
    }
  }
}

TEST(Variants, DimensionsAreKept) {
  const std::string hex =
      "c30400000001020304"
      "020000000200000002000000";
  const std::vector<std::byte> octets = octets_of(hex);
  Reader reader(octets);
  const Variant variant = get_variant(reader);
  ASSERT_FALSE(reader.failed());
  EXPECT_EQ(variant.at<std::uint8_t>(3), 4);
  std::array<std::byte, 64> buffer{};
  Writer writer(buffer);
  put_variant(writer, variant);
  EXPECT_EQ(hex_of(writer.finished()), hex);
}

}  // namespace
}  // namespace takt::uadp
