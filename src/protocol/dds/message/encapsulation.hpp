// SPDX-License-Identifier: Apache-2.0
// The four octets before each serialized payload (DDSI-RTPS 10.2, DDS-XTypes 7.6.2.1.2): which representation, and how
// many octets fill it up.
#pragma once

#include <array>
#include <string_view>

#include "dds/message/octets.hpp"

namespace takt::dds {

/// Representation identifiers, big-endian on the wire; odd ones are little-endian.
enum class Encapsulation : std::uint16_t {
  cdr_be = 0x0000,
  cdr_le = 0x0001,
  pl_cdr_be = 0x0002,
  pl_cdr_le = 0x0003,
  cdr2_be = 0x0006,
  cdr2_le = 0x0007,
  d_cdr2_be = 0x0008,
  d_cdr2_le = 0x0009,
  pl_cdr2_be = 0x000A,
  pl_cdr2_le = 0x000B,
};

inline constexpr std::size_t encapsulation_size = 4;

/// How a payload is read, or why it is not: plain CDR of both versions and PL_CDR of the first are.
enum class Representation : std::uint8_t {
  cdr,        ///< XCDR1, alignment up to 8
  pl_cdr,     ///< parameter list of XCDR1
  cdr2,       ///< XCDR2 of final types, alignment up to 4
  delimited,  ///< XCDR2 of appendable types: refused
  pl_cdr2,    ///< XCDR2 of mutable types: refused
  foreign,    ///< any other identifier (XML, vendors'): refused
  truncated,  ///< not even four octets
};
inline constexpr std::array<std::string_view, 7> representation_names{
    "CDR", "PL_CDR", "CDR2", "D_CDR2", "PL_CDR2", "unknown representation", "truncated"};
constexpr std::string_view name_of(Representation representation) {
  return representation_names[static_cast<std::size_t>(representation)];
}
static_assert(static_cast<std::size_t>(Representation::truncated) + 1 == representation_names.size());

/// A serialized payload, taken apart.
struct Encapsulated {
  Representation representation = Representation::truncated;
  ByteOrder order = ByteOrder::big;
  Octets content;  ///< without what fills it up
  /// Whether CdrReader (cdr, cdr2) or ParameterReader (pl_cdr) can read it.
  bool is_readable() const { return representation <= Representation::cdr2; }
};

inline Encapsulated open_encapsulation(Octets payload) {
  if (payload.size() < encapsulation_size) return {};
  const auto id = load<std::uint16_t>(payload.data(), ByteOrder::big);
  constexpr std::array<Representation, 6> of_pair{Representation::cdr,       Representation::pl_cdr,
                                                  Representation::foreign,   Representation::cdr2,
                                                  Representation::delimited, Representation::pl_cdr2};
  Encapsulated result;
  result.representation = id / 2U < of_pair.size() ? of_pair[id / 2U] : Representation::foreign;
  result.order = id % 2 != 0 ? ByteOrder::little : ByteOrder::big;
  result.content = payload.subspan(encapsulation_size);
  const std::size_t filling = std::to_integer<std::size_t>(payload[3]) & 3U;
  if (filling <= result.content.size()) result.content = result.content.first(result.content.size() - filling);
  return result;
}

}  // namespace takt::dds
