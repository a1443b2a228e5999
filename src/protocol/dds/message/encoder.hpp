// SPDX-License-Identifier: Apache-2.0
// Writes an RTPS message with its submessages into octets that the caller owns; allocates nothing.
#pragma once

#include "dds/message/octets.hpp"
#include "dds/message/submessage.hpp"

namespace takt::dds {

/// Octets of the header of a message.
inline constexpr std::size_t message_header_size = 20;

/// Octets of a submessage with its header (the table of 9.4.5), payloads filled up to a multiple of 4.
std::size_t size_of(const Submessage& submessage);
std::size_t size_of(const Data& data);
std::size_t size_of(const DataFrag& data);

/// Use: construct; add each submessage; message(). What does not fit is left out as a whole, so the message is always
/// sound and the caller sends it and begins another one. Little-endian, unless a test asks for the other order.
class MessageEncoder {
 public:
  MessageEncoder(std::span<std::byte> target, const MessageHeader& header, ByteOrder order = ByteOrder::little);

  /// False if it does not fit, or is longer than 65535 octets; then nothing is added.
  bool add(const Submessage& submessage);

  /// The message as far as it goes; nothing if not even the header fits.
  Octets message() const { return writer_.finished(); }
  std::size_t size() const { return writer_.position(); }
  std::size_t room() const { return writer_.room(); }
  /// Whether there is nothing but the header.
  bool is_empty() const { return writer_.position() <= message_header_size; }

 private:
  Writer writer_;
  bool is_sound_ = true;  ///< the header fits
};

}  // namespace takt::dds
