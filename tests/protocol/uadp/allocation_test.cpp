// SPDX-License-Identifier: Apache-2.0
// Neither encoding nor decoding allocates.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "uadp/encoder.hpp"
#include "uadp/periodic_fixed.hpp"

namespace {
std::uint64_t allocations = 0;  // of the whole process, which has one thread
}

void* operator new(std::size_t size) {
  ++allocations;
  void* const memory = std::malloc(size == 0 ? 1 : size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace takt::uadp {
namespace {

TEST(Allocation, NoneByTheCodec) {
  std::array<std::byte, 512> buffer{};
  const std::array<std::uint16_t, 2> ids{1, 2};
  const std::array<double, 20> values{};
  const std::uint64_t before = allocations;
  NetworkMessageHeader header;
  header.publisher_id = PublisherId::string("publisher with a long name, beyond small strings");
  NetworkMessageEncoder encoder(buffer, header, ids);
  for (int i = 0; i < 2; ++i) {
    encoder.begin({});
    encoder.field(std::span<const double>(values));
    encoder.field(std::string_view("text"));
    encoder.end();
  }
  NetworkMessage message;
  const DecodeStatus verdict = decode(encoder.finish(), message);
  std::size_t fields = 0;
  for (std::size_t i = 0; i < message.count(); ++i) {
    DataSetMessage each;
    decode(message.data_set_message(i), each);
    FieldReader reader(each);
    while (reader.next()) ++fields;
  }
  const std::uint64_t after = allocations;
  EXPECT_EQ(verdict, DecodeStatus::ok);
  EXPECT_EQ(fields, 4u);
  EXPECT_EQ(after, before);
}

TEST(Allocation, NoneByTheFixedLayout) {
  const PeriodicFixedLayout layout(
      {PublisherId::uint16(1), 1, 0, 1, {RawLayout({{BuiltInType::Int32}, {BuiltInType::Double}})}});
  std::array<std::byte, 64> buffer{};
  const std::uint64_t before = allocations;
  layout.start(buffer, 1);
  layout.set_header(buffer, 0, 1);
  store_value(buffer.data() + layout.field_offset(0, 1), 2.5);
  const bool matches = layout.matches(buffer);
  const double value = load_value<double>(buffer.data() + layout.field_offset(0, 1));
  const std::uint64_t after = allocations;
  EXPECT_TRUE(matches);
  EXPECT_EQ(value, 2.5);
  EXPECT_EQ(after, before);
}

}  // namespace
}  // namespace takt::uadp
