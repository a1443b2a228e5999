// SPDX-License-Identifier: Apache-2.0
// UA-TCP (OPC 10000-6, 7.1): the messages with which a connection begins and ends, and the header that all of them
// have.
#pragma once

#include "opcua/encoding/decoder.hpp"

namespace takt::opcua {

enum class MessageType : std::uint8_t { Hello, Acknowledge, Error, OpenChannel, Message, CloseChannel };
/// 'F' the last or only chunk of a message, 'C' one before, 'A' the message is given up.
enum class ChunkKind : std::uint8_t { Final, Intermediate, Abort };

inline constexpr std::size_t message_header_octets = 8;
/// With the id of the channel: OPN, MSG and CLO.
inline constexpr std::size_t channel_header_octets = 12;
/// No buffer may be smaller (OPC 10000-6, 7.1.2.3).
inline constexpr std::uint32_t least_buffer_octets = 8192;
inline constexpr std::size_t most_url_octets = 4096;

struct MessageHeader {
  MessageType type = MessageType::Error;
  ChunkKind chunk = ChunkKind::Final;
  std::uint32_t size = 0;  ///< of all octets, these included
};

/// Nothing if it is no header of UA-TCP; the size is not looked at.
std::optional<MessageHeader> decode_message_header(Octets octets);
/// The size is filled in when it is known.
void encode_message_header(Encoder& to, MessageType type, ChunkKind chunk = ChunkKind::Final);

struct Hello {
  static constexpr std::uint32_t encoding_id = 0;
  std::uint32_t protocol_version = 0;
  std::uint32_t receive_buffer_size = 0;
  std::uint32_t send_buffer_size = 0;
  std::uint32_t max_message_size = 0;  ///< of a response; 0: any
  std::uint32_t max_chunk_count = 0;   ///< of a response; 0: any
  Text endpoint_url;
  static constexpr auto members() {
    return std::tuple(&Hello::protocol_version, &Hello::receive_buffer_size, &Hello::send_buffer_size,
                      &Hello::max_message_size, &Hello::max_chunk_count, &Hello::endpoint_url);
  }
};

struct Acknowledge {
  static constexpr std::uint32_t encoding_id = 0;
  std::uint32_t protocol_version = 0;
  std::uint32_t receive_buffer_size = 0;
  std::uint32_t send_buffer_size = 0;
  std::uint32_t max_message_size = 0;  ///< of a request
  std::uint32_t max_chunk_count = 0;
  static constexpr auto members() {
    return std::tuple(&Acknowledge::protocol_version, &Acknowledge::receive_buffer_size, &Acknowledge::send_buffer_size,
                      &Acknowledge::max_message_size, &Acknowledge::max_chunk_count);
  }
};

struct ErrorMessage {
  static constexpr std::uint32_t encoding_id = 0;
  StatusCode error = StatusCode::Good;
  Text reason;
  static constexpr auto members() { return std::tuple(&ErrorMessage::error, &ErrorMessage::reason); }
};

/// HEL, ACK or ERR whole.
template <Structure T>
std::vector<std::byte> framed(MessageType type, const T& body) {
  Encoder encoder;
  encode_message_header(encoder, type);
  encode(encoder, body);
  encoder.patch(4, static_cast<std::uint32_t>(encoder.position()));
  return encoder.take();
}

/// Cuts the octets of a connection into messages. However they come, the same messages come out; no more than one is
/// kept.
class MessageSplitter {
 public:
  /// `most_octets` of one message, at least a HEL's.
  explicit MessageSplitter(std::size_t most_octets) : most_(most_octets) {}

  /// The octets that have come last. They are taken whole by `next` before more are fed.
  void feed(Octets octets);
  /// The next whole message, which lasts until the next call; nothing: more must come, or `failure` says why not.
  std::optional<Octets> next();
  /// Good while all is well; else what an ERR says.
  StatusCode failure() const { return failure_; }
  /// A part of a message is there.
  bool is_within_message() const { return used_ < kept_.size(); }

 private:
  std::size_t most_;
  std::vector<std::byte> kept_;
  std::size_t used_ = 0;  ///< octets of `kept_` that have been given out
  StatusCode failure_ = StatusCode::Good;
};

}  // namespace takt::opcua
