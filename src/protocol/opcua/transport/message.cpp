// SPDX-License-Identifier: Apache-2.0
#include "opcua/transport/message.hpp"

#include <algorithm>

namespace takt::opcua {
namespace {

struct TypeName {
  MessageType type;
  std::string_view name;
};
constexpr TypeName types[] = {{MessageType::Hello, "HEL"},   {MessageType::Acknowledge, "ACK"},
                              {MessageType::Error, "ERR"},   {MessageType::OpenChannel, "OPN"},
                              {MessageType::Message, "MSG"}, {MessageType::CloseChannel, "CLO"}};
constexpr std::string_view chunks = "FCA";

}  // namespace

std::optional<MessageHeader> decode_message_header(Octets octets) {
  if (octets.size() < message_header_octets) return std::nullopt;
  const std::string_view name(reinterpret_cast<const char*>(octets.data()), 3);
  const auto type =
      std::find_if(std::begin(types), std::end(types), [&](const TypeName& each) { return each.name == name; });
  const std::size_t chunk = chunks.find(static_cast<char>(octets[3]));
  if (type == std::end(types) || chunk == std::string_view::npos) return std::nullopt;
  // Only messages of a channel come in parts; OPN and CLO are whole.
  if (type->type != MessageType::Message && chunk != 0) return std::nullopt;
  return MessageHeader{type->type, static_cast<ChunkKind>(chunk),
                       uadp::load_little_endian<std::uint32_t>(octets.data() + 4)};
}

void encode_message_header(Encoder& to, MessageType type, ChunkKind chunk) {
  const std::string_view name = types[static_cast<std::size_t>(type)].name;
  to.put_octets(std::as_bytes(std::span(name.data(), name.size())));
  to.put(static_cast<std::uint8_t>(chunks[static_cast<std::size_t>(chunk)]));
  to.put(std::uint32_t{0});
}

void MessageSplitter::feed(Octets octets) {
  if (failure_ != StatusCode::Good) return;
  kept_.erase(kept_.begin(), kept_.begin() + static_cast<std::ptrdiff_t>(used_));
  used_ = 0;
  kept_.insert(kept_.end(), octets.begin(), octets.end());
}

std::optional<Octets> MessageSplitter::next() {
  if (failure_ != StatusCode::Good) return std::nullopt;
  const Octets left = Octets(kept_).subspan(used_);
  if (left.size() < message_header_octets) return std::nullopt;
  const auto header = decode_message_header(left);
  if (!header) {
    failure_ = StatusCode::BadTcpMessageTypeInvalid;
  } else if (header->size > most_) {
    failure_ = StatusCode::BadTcpMessageTooLarge;
  } else if (header->size <
             (header->type >= MessageType::OpenChannel ? channel_header_octets : message_header_octets)) {
    failure_ = StatusCode::BadTcpMessageTypeInvalid;
  }
  if (failure_ != StatusCode::Good || left.size() < header->size) return std::nullopt;
  used_ += header->size;
  return left.first(header->size);
}

}  // namespace takt::opcua
