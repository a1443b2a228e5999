// SPDX-License-Identifier: Apache-2.0
// PublisherId (OPC 10000-14, 7.2.4.4.2): who sent a NetworkMessage, unique in the network.
#pragma once

#include <compare>
#include <cstdint>
#include <string_view>

namespace takt::uadp {

/// The value is the code in ExtendedFlags1, bits 0 to 2.
enum class PublisherIdType : std::uint8_t { Byte, UInt16, UInt32, UInt64, String };

struct PublisherId {
  PublisherIdType type = PublisherIdType::UInt16;
  std::uint64_t number = 0;  ///< of the four numeric types; must fit
  std::string_view text;     ///< of a String; somebody else owns it

  static constexpr PublisherId byte(std::uint8_t number) { return {PublisherIdType::Byte, number, {}}; }
  static constexpr PublisherId uint16(std::uint16_t number) { return {PublisherIdType::UInt16, number, {}}; }
  static constexpr PublisherId uint32(std::uint32_t number) { return {PublisherIdType::UInt32, number, {}}; }
  static constexpr PublisherId uint64(std::uint64_t number) { return {PublisherIdType::UInt64, number, {}}; }
  static constexpr PublisherId string(std::string_view text) { return {PublisherIdType::String, 0, text}; }

  constexpr bool operator==(const PublisherId&) const = default;
};

}  // namespace takt::uadp
