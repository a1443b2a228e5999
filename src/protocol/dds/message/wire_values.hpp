// SPDX-License-Identifier: Apache-2.0
// The small values that submessages and parameters are made of (DDSI-RTPS 9.3, 9.4.2), read and written.
#pragma once

#include "dds/message/octets.hpp"
#include "dds/message/submessage.hpp"

namespace takt::dds {

inline constexpr std::size_t locator_size = 24;

namespace detail {
template <std::size_t Size>
void get_octets(Reader& reader, std::array<std::uint8_t, Size>& octets) {
  const Octets source = reader.take(Size);
  for (std::size_t i = 0; i < source.size(); ++i) octets[i] = std::to_integer<std::uint8_t>(source[i]);
}
template <std::size_t Size>
void put_octets(Writer& writer, const std::array<std::uint8_t, Size>& octets) {
  writer.put_octets(std::as_bytes(std::span(octets)));
}
/// Octets whose order does not depend on the submessage's.
inline std::uint32_t get_big_endian(Reader& reader, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8 | reader.get<std::uint8_t>();
  return value;
}
inline void put_big_endian(Writer& writer, std::uint32_t value, std::size_t size) {
  for (std::size_t i = size; i != 0; --i) writer.put(static_cast<std::uint8_t>(value >> (8 * (i - 1))));
}
}  // namespace detail

inline GuidPrefix get_guid_prefix(Reader& reader) {
  GuidPrefix prefix;
  detail::get_octets(reader, prefix.octets);
  return prefix;
}
inline void put(Writer& writer, const GuidPrefix& prefix) { detail::put_octets(writer, prefix.octets); }

inline EntityId get_entity_id(Reader& reader) { return {detail::get_big_endian(reader, 4)}; }
inline void put(Writer& writer, EntityId id) { detail::put_big_endian(writer, id.value, 4); }

inline Guid get_guid(Reader& reader) {
  const GuidPrefix prefix = get_guid_prefix(reader);
  return {prefix, get_entity_id(reader)};
}
inline void put(Writer& writer, const Guid& guid) {
  put(writer, guid.prefix);
  put(writer, guid.entity);
}

inline ProtocolVersion get_protocol_version(Reader& reader) {
  const auto major = reader.get<std::uint8_t>();
  return {major, reader.get<std::uint8_t>()};
}
inline void put(Writer& writer, ProtocolVersion version) {
  writer.put(version.major);
  writer.put(version.minor);
}

inline VendorId get_vendor_id(Reader& reader) {
  return {static_cast<std::uint16_t>(detail::get_big_endian(reader, 2))};
}
inline void put(Writer& writer, VendorId vendor) { detail::put_big_endian(writer, vendor.value, 2); }

inline SequenceNumber get_sequence_number(Reader& reader) {
  const std::int64_t high = reader.get<std::int32_t>();
  return {high * (std::int64_t{1} << 32) + reader.get<std::uint32_t>()};
}
inline void put(Writer& writer, SequenceNumber number) {
  writer.put(static_cast<std::int32_t>(number.value >> 32));
  writer.put(static_cast<std::uint32_t>(number.value & 0xFFFF'FFFF));
}

inline Time get_time(Reader& reader) {
  const auto seconds = reader.get<std::int32_t>();
  return {seconds, reader.get<std::uint32_t>()};
}
inline void put(Writer& writer, Time time) {
  writer.put(time.seconds);
  writer.put(time.fraction);
}
inline Duration get_duration(Reader& reader) {
  const auto seconds = reader.get<std::int32_t>();
  return {seconds, reader.get<std::uint32_t>()};
}
inline void put(Writer& writer, Duration duration) {
  writer.put(duration.seconds);
  writer.put(duration.fraction);
}

inline Locator get_locator(Reader& reader) {
  Locator locator;
  locator.kind = static_cast<LocatorKind>(reader.get<std::int32_t>());
  locator.port = reader.get<std::uint32_t>();
  detail::get_octets(reader, locator.address);
  return locator;
}
inline void put(Writer& writer, const Locator& locator) {
  writer.put(static_cast<std::int32_t>(locator.kind));
  writer.put(locator.port);
  detail::put_octets(writer, locator.address);
}

template <class N>
void put_bits(Writer& writer, const NumberSet<N>& set) {
  writer.put(set.bit_count());
  for (std::size_t i = 0; i < set.word_count(); ++i) writer.put(set.word(i));
}
inline void put(Writer& writer, const SequenceNumberSet& set) {
  put(writer, set.base());
  put_bits(writer, set);
}
inline void put(Writer& writer, const FragmentNumberSet& set) {
  writer.put(set.base().value);
  put_bits(writer, set);
}

}  // namespace takt::dds
