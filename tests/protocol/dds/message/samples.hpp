// SPDX-License-Identifier: Apache-2.0
// One of each submessage, for the tests of the codec.
#pragma once

#include <vector>

#include "dds/message/encoder.hpp"
#include "dds/octets.hpp"

namespace takt::dds::test {

inline constexpr EntityId some_reader = EntityId::user(0x000102, EntityKind::reader_with_key);
inline constexpr EntityId some_writer = EntityId::user(0x000203, EntityKind::writer_with_key);
inline constexpr GuidPrefix some_prefix{{0x01, 0xFA, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}};
inline constexpr GuidPrefix other_prefix{{0x01, 0x10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20}};
inline constexpr MessageHeader some_header{{}, takt_vendor, some_prefix};

/// CDR_LE and two 32-bit numbers.
inline const std::vector<std::byte>& some_payload() {
  static const std::vector<std::byte> payload = octets_of("00010000 01000000 02000000");
  return payload;
}

inline InlineQos some_inline_qos() {
  return {status_info::disposed, KeyHash{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16}};
}

template <class N>
NumberSet<N> set_of(N base, std::initializer_list<std::int64_t> offsets) {
  NumberSet<N> set(base);
  for (const std::int64_t offset : offsets) set.insert(base + offset);
  return set;
}

/// Every kind, with and without its optional parts.
inline std::vector<Submessage> every_submessage() {
  static const std::vector<std::byte> big(1000, std::byte{7});
  DataFrag frag{some_reader, some_writer, {9}, {}, PayloadKind::data, {2}, 2, 400, 1000, Octets(big).first(600)};
  DataFrag frag_with_key = frag;
  frag_with_key.inline_qos = some_inline_qos();
  frag_with_key.payload_kind = PayloadKind::key;
  const Locator unicast = Locator::udp_v4(0x0A000001, 7411);
  const Locator multicast = Locator::udp_v4(discovery_group, 7401);
  return {
      Pad{},
      InfoTimestamp{Time{17, 0x8000'0000U}},
      Data{some_reader, some_writer, {7}, {}, PayloadKind::data, some_payload()},
      Data{{},
           some_writer,
           {(std::int64_t{3} << 32) + 5},
           {status_info::disposed | status_info::unregistered, {}},
           PayloadKind::key,
           some_payload()},
      Data{some_reader, some_writer, {8}, some_inline_qos(), PayloadKind::none, {}},
      InfoTimestamp{},
      frag,
      frag_with_key,
      Heartbeat{some_reader, some_writer, {1}, {0}, 1, false, false},
      Heartbeat{some_reader, some_writer, {5}, {(std::int64_t{1} << 33) + 1}, 2, true, true},
      HeartbeatFrag{some_reader, some_writer, {9}, {3}, 4},
      InfoDestination{other_prefix},
      AckNack{some_reader, some_writer, SequenceNumberSet{SequenceNumber{12}}, 1, true},
      AckNack{some_reader, some_writer, set_of<SequenceNumber>({12}, {0, 5, 33, 255}), 2, false},
      NackFrag{some_reader, some_writer, {9}, set_of<FragmentNumber>({1}, {0, 2}), 3},
      Gap{some_reader, some_writer, {3}, set_of<SequenceNumber>({6}, {1})},
      Gap{some_reader, some_writer, {3}, SequenceNumberSet{SequenceNumber{6}}},
      InfoSource{{2, 2}, {0x0110}, other_prefix},
      InfoReply{{unicast}, {}},
      InfoReply{{unicast, unicast}, std::vector<Locator>{multicast}},
  };
}

}  // namespace takt::dds::test
