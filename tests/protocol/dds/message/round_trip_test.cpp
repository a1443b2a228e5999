// SPDX-License-Identifier: Apache-2.0
// What is encoded is decoded to the same, in both byte orders.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "dds/message/decoder.hpp"
#include "dds/message/fragments.hpp"
#include "dds/message/samples.hpp"

namespace takt::dds {
namespace {

using namespace test;

template <class T>
bool same(const T& a, const T& b) {
  return a == b;
}
bool same_octets(Octets a, Octets b) { return std::equal(a.begin(), a.end(), b.begin(), b.end()); }
template <class T>
bool same_sample(const T& a, const T& b) {
  return a.reader == b.reader && a.writer == b.writer && a.sequence_number == b.sequence_number &&
         a.inline_qos == b.inline_qos && a.payload_kind == b.payload_kind && same_octets(a.payload, b.payload);
}
bool same(const Data& a, const Data& b) { return same_sample(a, b); }
bool same(const DataFrag& a, const DataFrag& b) {
  return same_sample(a, b) && a.first_fragment == b.first_fragment && a.fragment_count == b.fragment_count &&
         a.fragment_size == b.fragment_size && a.sample_size == b.sample_size;
}
bool same_submessage(const Submessage& a, const Submessage& b) {
  return a.index() == b.index() &&
         std::visit([&](const auto& each) { return same(each, std::get<std::decay_t<decltype(each)>>(b)); }, a);
}

/// Whether the submessages survive.
bool survive(const std::vector<Submessage>& submessages, ByteOrder order) {
  std::vector<std::byte> buffer(60'000);
  MessageEncoder encoder(buffer, some_header, order);
  for (const Submessage& each : submessages)
    if (!encoder.add(each)) return false;
  const std::vector<std::byte> octets = copy(encoder.message());
  MessageDecoder decoder(octets);
  std::size_t count = 0;
  while (decoder.next()) {
    if (count == submessages.size() || !same_submessage(submessages[count], decoder.submessage())) return false;
    ++count;
  }
  return decoder.verdict() == MessageStatus::ok && decoder.skipped() == 0 && count == submessages.size() &&
         decoder.header() == some_header;
}

TEST(RoundTrip, OfEverySubmessage) {
  EXPECT_TRUE(survive(every_submessage(), ByteOrder::little));
  EXPECT_TRUE(survive(every_submessage(), ByteOrder::big));
  for (const Submessage& each : every_submessage()) EXPECT_TRUE(survive({each}, ByteOrder::big)) << each.index();
}

// What RapidCheck draws: numbers, which shrink.
std::uint64_t below(std::uint64_t end) {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::uint64_t>(0, end));
}
bool either() { return below(2) == 1; }
EntityId any_entity() { return {*rc::gen::arbitrary<std::uint32_t>()}; }
SequenceNumber any_number() { return {1 + static_cast<std::int64_t>(below(either() ? 300 : std::uint64_t{1} << 62))}; }
template <std::size_t Size>
std::array<std::uint8_t, Size> any_octets() {
  return *rc::gen::arbitrary<std::array<std::uint8_t, Size>>();
}
InlineQos any_inline_qos() {
  InlineQos qos;
  if (either()) qos.status_info = static_cast<std::uint32_t>(below(4));
  if (either()) qos.key_hash = any_octets<16>();
  if (either()) qos.original_writer = {{{any_octets<12>()}, any_entity()}, any_number()};
  return qos;
}
template <class N>
NumberSet<N> any_set(N base) {
  NumberSet<N> set(base);
  const auto count = below(20);
  for (std::uint64_t i = 0; i < count; ++i) set.insert(base + static_cast<std::int64_t>(below(256)));
  return set;
}
Locator any_locator() { return {LocatorKind::udp_v6, *rc::gen::arbitrary<std::uint32_t>(), any_octets<16>()}; }
std::vector<Locator> any_locators() {
  std::vector<Locator> locators(below(4));
  for (Locator& locator : locators) locator = any_locator();
  return locators;
}
GuidPrefix any_prefix() { return {any_octets<12>()}; }

const std::vector<std::byte>& noise() {
  static const std::vector<std::byte> octets = [] {
    std::vector<std::byte> some(4096);
    for (std::size_t i = 0; i < some.size(); ++i) some[i] = static_cast<std::byte>(i * i * 31 >> 3);
    return some;
  }();
  return octets;
}

Submessage any_data() {
  Data data{any_entity(), any_entity(), any_number(), any_inline_qos(), static_cast<PayloadKind>(below(3)), {}};
  if (data.payload_kind != PayloadKind::none) data.payload = Octets(noise()).first(4 + 4 * below(500));
  return data;
}
Submessage any_data_frag() {
  const std::uint32_t sample_size = 1 + static_cast<std::uint32_t>(below(4096));
  const auto fragment_size = static_cast<std::uint16_t>(1 + below(sample_size));
  const std::uint32_t count = fragment_count(sample_size, fragment_size);
  const auto first = static_cast<std::uint32_t>(1 + below(count));
  DataFrag data = fragments_of(Octets(noise()).first(sample_size), {first},
                               static_cast<std::uint16_t>(1 + below(count - first + 1)), fragment_size);
  data.reader = any_entity();
  data.writer = any_entity();
  data.sequence_number = any_number();
  data.inline_qos = any_inline_qos();
  data.payload_kind = either() ? PayloadKind::data : PayloadKind::key;
  return data;
}
Submessage any_heartbeat() {
  const SequenceNumber first = any_number();
  return Heartbeat{any_entity(),
                   any_entity(),
                   first,
                   first.previous() + static_cast<std::int64_t>(below(100)),
                   *rc::gen::arbitrary<std::uint32_t>(),
                   either(),
                   either()};
}

Submessage any_submessage() {
  switch (below(12)) {
    case 0:
      return any_data();
    case 1:
      return any_data_frag();
    case 2:
      return any_heartbeat();
    case 3:
      return HeartbeatFrag{any_entity(),
                           any_entity(),
                           any_number(),
                           {1 + static_cast<std::uint32_t>(below(1000))},
                           *rc::gen::arbitrary<std::uint32_t>()};
    case 4:
      return AckNack{any_entity(), any_entity(), any_set(any_number()), *rc::gen::arbitrary<std::uint32_t>(), either()};
    case 5:
      return NackFrag{any_entity(), any_entity(), any_number(),
                      any_set(FragmentNumber{1 + static_cast<std::uint32_t>(below(1000))}), 1};
    case 6: {
      const SequenceNumber start = any_number();
      return Gap{any_entity(), any_entity(), start, any_set(start + static_cast<std::int64_t>(below(50)))};
    }
    case 7:
      return InfoTimestamp{
          either() ? std::optional(Time{*rc::gen::arbitrary<std::int32_t>(), *rc::gen::arbitrary<std::uint32_t>()})
                   : std::nullopt};
    case 8:
      return InfoSource{
          {2, static_cast<std::uint8_t>(below(6))}, {static_cast<std::uint16_t>(below(65536))}, any_prefix()};
    case 9:
      return InfoDestination{any_prefix()};
    case 10:
      return InfoReply{any_locators(), either() ? std::optional(any_locators()) : std::nullopt};
    default:
      return Pad{};
  }
}

TEST(RoundTrip, OfWhateverIsDrawn) {
  EXPECT_TRUE(rc::check("messages survive", [] {
    std::vector<Submessage> submessages(below(12));
    for (Submessage& each : submessages) each = any_submessage();
    RC_ASSERT(survive(submessages, ByteOrder::little));
    RC_ASSERT(survive(submessages, ByteOrder::big));
  }));
}

}  // namespace
}  // namespace takt::dds
