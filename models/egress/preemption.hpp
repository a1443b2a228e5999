// SPDX-License-Identifier: Apache-2.0
// Where and how a preemptable frame may be cut (IEEE 802.3 clause 99, formerly 802.3br; IEEE 802.1Q clause 6.7.2).
//
// A preemptable frame travels as one or more mPackets, its fragments. Only the last one carries the frame's FCS; each
// other one ends with an mCRC. Every fragment has a preamble and is followed by an inter-packet gap:
//
//   first     preamble 7  SMD-S 1                data ..  mCRC 4  gap 12
//   further   preamble 6  SMD-C 1  FRAG_COUNT 1  data ..  mCRC 4  gap 12
//   last      preamble 6  SMD-C 1  FRAG_COUNT 1  data ..  FCS 4   gap 12
//
// Lengths of frames count from DA to FCS, as everywhere in takt; data octets of a fragment count without its mCRC.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "models/ethernet/sizes.hpp"
#include "sim/check.hpp"
#include "sim/units.hpp"

namespace takt::models {

/// The last fragment has at least as many octets of the frame, FCS included (99.4.7.7, MIN_REMAIN).
inline constexpr Octets minimum_final_fragment{64};

/// addFragSize, 0 to 3: how much more than the minimum the link partner wants in a fragment that is not the last
/// (30.14.1.7).
class AddFragSize {
 public:
  constexpr AddFragSize() = default;
  constexpr explicit AddFragSize(std::uint8_t value) : value_(value) {
    TAKT_CHECK(value <= 3, "addFragSize is 0 to 3");
  }
  constexpr std::uint8_t value() const { return value_; }
  constexpr bool operator==(const AddFragSize&) const = default;

 private:
  std::uint8_t value_ = 0;
};

/// The least data of a fragment that is not the last: 60, 124, 188 or 252 octets; with its mCRC 64 * (1 + addFragSize).
constexpr Octets minimum_fragment_data(AddFragSize add_frag_size) {
  return {64u * (1u + add_frag_size.value()) - mcrc.count};
}

/// The longest frame, or rest of one, that can't be cut: 123, 187, 251 or 315 octets.
constexpr Octets longest_uninterruptible(AddFragSize add_frag_size) {
  return minimum_fragment_data(add_frag_size) + minimum_final_fragment - Octets{1};
}

/// The longest time, in octets of the medium, that an express frame waits for a preemptable one: 143, 207, 271 or 335.
/// A MAC that is asked to hold has stopped after that: the least hold_advance.
constexpr Octets longest_express_wait(AddFragSize add_frag_size) {
  return wire_length(longest_uninterruptible(add_frag_size));
}

/// How many more octets of the present fragment go out before it may end with an mCRC; none if the frame goes to its
/// end.
///
/// `sent` are the data octets of this fragment that are out or under way, `remaining` those of the frame still to come,
/// FCS included. The cut leaves minimum_fragment_data in this fragment and minimum_final_fragment for the rest; the
/// rule asks for nothing else, so the rest may be cut again.
constexpr std::optional<Octets> earliest_cut(Octets sent, Octets remaining, AddFragSize add_frag_size) {
  const Octets minimum = minimum_fragment_data(add_frag_size);
  const Octets more = sent < minimum ? minimum - sent : Octets{0};
  if (remaining < more + minimum_final_fragment) return std::nullopt;
  return more;
}

/// The data octets of a fragment among the first `wire_octets` from its preamble on, at most `remaining_at_start`.
constexpr Octets data_octets_of(Octets wire_octets, Octets remaining_at_start) {
  if (wire_octets <= preamble_and_sfd) return {0};
  return std::min(wire_octets - preamble_and_sfd, remaining_at_start);
}

/// The same as earliest_cut() for a fragment that began, with its preamble, `wire_octets` ago (an octet under way
/// counts as out) and had `remaining_at_start` octets of the frame before it: the data that the fragment has when it is
/// cut.
constexpr std::optional<Octets> cut_after(Octets wire_octets, Octets remaining_at_start, AddFragSize add_frag_size) {
  const Octets sent = data_octets_of(wire_octets, remaining_at_start);
  const std::optional<Octets> more = earliest_cut(sent, remaining_at_start - sent, add_frag_size);
  if (!more) return std::nullopt;
  return sent + *more;
}

/// What a fragment that is cut after `data` octets occupies of the medium, from its preamble to the end of its gap.
constexpr Octets wire_length_of_cut_fragment(Octets data) { return wire_length(data + mcrc); }
/// What the last or only fragment occupies; `remaining` includes the FCS.
constexpr Octets wire_length_of_last_fragment(Octets remaining) { return wire_length(remaining); }

/// Start of an express frame: the ordinary SFD (Table 99-1).
inline constexpr std::uint8_t smd_e = 0xD5;
inline constexpr std::uint8_t smd_v = 0x07;                                          ///< verify request
inline constexpr std::uint8_t smd_r = 0x19;                                          ///< verify response
inline constexpr std::array<std::uint8_t, 4> smd_s = {0xE6, 0x4C, 0x7F, 0xB3};       ///< start of frame 0 to 3
inline constexpr std::array<std::uint8_t, 4> smd_c = {0x61, 0x52, 0x9E, 0x2A};       ///< continuation of frame 0 to 3
inline constexpr std::array<std::uint8_t, 4> frag_count = {0xE6, 0x4C, 0x7F, 0xB3};  ///< continuation 0 to 3 of a frame

/// What stands between preamble and data of an mPacket. `frag_count` is there in continuations.
struct FragmentHeader {
  std::uint8_t smd = smd_e;
  std::optional<std::uint8_t> frag_count;
  bool operator==(const FragmentHeader&) const = default;
};

/// Numbers the preemptable frames of a port modulo 4, and the continuations of each modulo 4 from 0 (99.3.4).
class FragmentSequence {
 public:
  FragmentHeader start_frame();
  FragmentHeader continue_frame();

 private:
  std::uint8_t next_frame_ = 0;
  std::uint8_t next_continuation_ = 0;
};

/// The mCRC of a fragment (99.3.6). `crc` is the reflected CRC-32 that an FCS is, over all data octets of the frame
/// from DA to the end of this fragment, as a number whose low octet is sent first; the mCRC is sent the same way.
constexpr std::uint32_t mcrc_of(std::uint32_t crc) { return crc ^ 0x0000'FFFFu; }

}  // namespace takt::models
