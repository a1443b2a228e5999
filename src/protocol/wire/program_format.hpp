// SPDX-License-Identifier: Apache-2.0
// The messages of a Program in UADP-Periodic-Fixed: words and process data. See README.md for the octets.
#pragma once

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "handshake/word.hpp"
#include "uadp/periodic_fixed.hpp"
#include "wire/program_shape.hpp"
#include "wire/verdict.hpp"

namespace takt::wire {

/// EtherType of UADP without IP (OPC 10000-14, 7.3.3).
inline constexpr std::uint16_t uadp_ether_type = 0xB62C;
/// The port of UADP over UDP (OPC 10000-14, 7.3.2).
inline constexpr std::uint16_t uadp_udp_port = 4840;

inline constexpr std::uint16_t state_writer_group = 1;
/// Of data set 0.
inline constexpr std::uint16_t first_data_writer_group = 2;

/// Where the fields of every message begin.
inline constexpr std::uint32_t fields_at = 20;

/// Octets of a state message.
constexpr std::uint32_t state_octets(handshake::Variant variant) {
  return fields_at + (variant == handshake::Variant::paper ? 4 : 22);
}
/// Octets of a message of process data, whose run stands before the user's fields.
constexpr std::uint32_t process_data_octets(std::uint32_t user_octets) { return fields_at + 4 + user_octets; }

/// A participant's published word. `paper` sends its state only.
struct StateMessage {
  std::uint8_t sender = 0;     ///< participant
  std::uint16_t sequence = 0;  ///< of the sender's state messages; wraps
  handshake::Word word;
  bool operator==(const StateMessage&) const = default;
};

/// A state message that ProgramFormat::decode has read, to know the next one of its sender by its octets: all but the
/// sequence numbers are the same.
class KnownState {
 public:
  /// Precondition: decode has read `word` from `octets`.
  void note(uadp::Octets octets, const handshake::Word& word) {
    if (octets.size() < size) return;  // `paper`: too short to be worth it
    std::copy_n(octets.begin(), size, octets_.begin());
    word_ = word;
    is_known_ = true;
  }
  bool is_repeated_by(uadp::Octets octets) const {
    return is_known_ && octets.size() >= size && is_same<8>(octets, 0) && is_same<8>(octets, group_sequence_at - 8) &&
           is_same<1>(octets, data_set_at) && is_same<8>(octets, status_at) && is_same<8>(octets, status_at + 8) &&
           is_same<8>(octets, status_at + 16);
  }
  /// What octets that repeat it are; `sender` is its own.
  StateMessage message(std::uint8_t sender, uadp::Octets octets) const {
    return {sender, uadp::load_little_endian<std::uint16_t>(octets.data() + data_set_at + 1), word_};
  }

 private:
  // In UADP-Periodic-Fixed with a UInt16 PublisherId (OPC 10000-14, A.2.1.2): two sequence numbers are not compared.
  static constexpr std::size_t size = state_octets(handshake::Variant::robust);
  static constexpr std::size_t group_sequence_at = 13;
  static constexpr std::size_t data_set_at = 15;
  static constexpr std::size_t status_at = data_set_at + 3;
  static_assert(status_at + 24 == size);
  template <std::size_t count>
  bool is_same(uadp::Octets octets, std::size_t at) const {
    return std::memcmp(octets_.data() + at, octets.data() + at, count) == 0;
  }

  std::array<std::byte, size> octets_{};
  handshake::Word word_;
  bool is_known_ = false;
};

struct ProcessDataMessage {
  std::uint8_t sender = 0;     ///< participant; follows from the data set
  std::uint8_t data_set = 0;   ///< index in the Program
  std::uint16_t sequence = 0;  ///< of this data set; wraps
  std::uint32_t run = 0;       ///< in which the sender is Running
  uadp::Octets fields;         ///< the user's fields, as they stand in the message; somebody else owns them
};

using ProgramMessage = std::variant<StateMessage, ProcessDataMessage>;

/// Makes and reads the messages of one Program. Constant, so all its participants may share one.
class ProgramFormat {
 public:
  explicit ProgramFormat(ProgramShape shape);

  const ProgramShape& shape() const { return shape_; }
  std::uint32_t group_version() const { return group_version_; }
  std::size_t participants() const { return participants_; }
  /// Octets of the longest message.
  std::size_t longest() const;

  /// Writes the message into `target`, which has room for it, and returns what was written.
  uadp::Octets encode(const StateMessage& message, std::span<std::byte> target) const;
  /// The same. Without `fields` they are zeros; otherwise they have the length of the data set's.
  uadp::Octets encode(const ProcessDataMessage& message, std::span<std::byte> target) const;

  /// Nothing if the octets are no message of this Program, or say what no participant says. Octets behind a message
  /// (padding of Ethernet) are passed over.
  std::optional<ProgramMessage> decode(uadp::Octets octets) const;
  /// The same of a message that probably is process data; false if it is none that decode() takes.
  bool decode(uadp::Octets octets, ProcessDataMessage& message) const;
  /// The participant of whom the octets are, if they are a message of this Program at all.
  std::optional<std::size_t> sender_of(uadp::Octets octets) const {
    if (octets.size() < fields_at) return std::nullopt;
    const auto id = uadp::load_little_endian<std::uint16_t>(octets.data() + publisher_id_at);
    const std::size_t sender = static_cast<std::uint16_t>(id - shape_.first_publisher_id);
    return sender < participants() ? std::optional(sender) : std::nullopt;
  }
  /// Why `decode` gives nothing for these octets.
  Verdict refusal_of(uadp::Octets octets) const;

 private:
  std::optional<ProgramMessage> decode_state(std::uint8_t sender, uadp::Octets octets) const;
  bool decode_data(std::size_t data_set, uadp::Octets octets, ProcessDataMessage& message) const;

  static constexpr std::size_t publisher_id_at =
      2;  // in UADP-Periodic-Fixed with a UInt16 PublisherId (OPC 10000-14, A.2.1.2)

  ProgramShape shape_;
  std::size_t participants_;
  std::uint32_t group_version_;
  std::vector<uadp::PeriodicFixedLayout> states_;  ///< by participant
  std::vector<uadp::PeriodicFixedLayout> data_;    ///< by data set
};

}  // namespace takt::wire
