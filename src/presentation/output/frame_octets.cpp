// SPDX-License-Identifier: Apache-2.0
#include "output/frame_octets.hpp"

#include <algorithm>

#include "models/ethernet/sizes.hpp"

namespace takt::output {
namespace {

using models::Frame;

constexpr std::size_t ipv4_header = 20;
constexpr std::size_t udp_header = 8;
constexpr std::uint8_t udp_protocol = 17;

/// The one bounded writer of network byte order: what does not fit is not written.
class NetworkWriter {
 public:
  explicit NetworkWriter(std::span<std::byte> target) : target_(target) {}
  void put8(std::uint64_t value) {
    if (used_ < target_.size()) target_[used_++] = static_cast<std::byte>(value & 0xFF);
  }
  void put16(std::uint64_t value) { put8(value >> 8), put8(value); }
  void put32(std::uint64_t value) { put16(value >> 16), put16(value); }
  void put48(std::uint64_t value) { put16(value >> 32), put32(value); }
  void put64(std::uint64_t value) { put32(value >> 32), put32(value); }
  void put(std::span<const std::byte> octets) {
    for (const std::byte octet : octets) put8(std::to_integer<unsigned>(octet));
  }
  std::size_t room() const { return target_.size() - used_; }
  std::span<std::byte> rest() const { return target_.subspan(used_); }

 private:
  std::span<std::byte> target_;
  std::size_t used_ = 0;
};

/// The Internet checksum (RFC 1071): the ones' complement of the ones' complement sum of 16-bit words.
class InternetChecksum {
 public:
  void add16(std::uint64_t word) { sum_ += word & 0xFFFF; }
  void add32(std::uint64_t word) { add16(word >> 16), add16(word); }
  void add(std::span<const std::byte> octets) {
    for (std::size_t i = 0; i < octets.size(); ++i)
      sum_ += std::to_integer<std::uint64_t>(octets[i]) << (i % 2 == 0 ? 8 : 0);
  }
  std::uint16_t value() const {
    std::uint64_t sum = sum_;
    while (sum > 0xFFFF) sum = (sum & 0xFFFF) + (sum >> 16);
    return static_cast<std::uint16_t>(~sum);
  }

 private:
  std::uint64_t sum_ = 0;
};

void put16_at(std::span<std::byte> octets, std::size_t at, std::uint16_t value) {
  NetworkWriter(octets.subspan(at, 2)).put16(value);
}

void put_payload(NetworkWriter& writer, const Frame& frame, const FrameEncoding& encoding) {
  if (encoding.payload) {
    writer.put(*encoding.payload);
    return;
  }
  constexpr std::uint32_t mark = 0x54'41'4B'54;  // TAKT
  writer.put32(mark);
  writer.put32(frame.stream.value);
  writer.put64(frame.sequence);
  for (std::uint64_t octet = 16; writer.room() > 0; ++octet) writer.put8(octet);
}

/// `msdu` begins after the EtherType and is all zeros; what stays zero behind the datagram is padding.
void put_ipv4_and_udp(std::span<std::byte> msdu, const Frame& frame, const FrameEncoding& encoding) {
  const std::size_t room = msdu.size();
  TAKT_CHECK(room >= ipv4_header + udp_header, "a frame with UDP over IPv4 has room for their headers");
  const std::size_t payload =
      std::min(encoding.payload ? encoding.payload->size() : room, room - ipv4_header - udp_header);
  const std::span<std::byte> datagram = msdu.first(ipv4_header + udp_header + payload);
  const std::span<std::byte> udp = datagram.subspan(ipv4_header);
  const std::uint32_t source = ipv4_address_of(frame.source, encoding.first_group);
  const std::uint32_t destination =
      encoding.ip_group != 0 ? encoding.ip_group : ipv4_address_of(frame.destination, encoding.first_group);

  NetworkWriter writer(datagram);
  writer.put8(0x45);                                        // version 4, five words
  writer.put8(static_cast<unsigned>(frame.priority) << 5);  // DSCP: the class selector of the priority
  writer.put16(datagram.size());
  writer.put16(frame.sequence);  // identification
  writer.put16(0x4000);          // don't fragment
  writer.put8(64);               // time to live
  writer.put8(udp_protocol);
  writer.put16(0);  // checksum, below
  writer.put32(source);
  writer.put32(destination);
  InternetChecksum header;
  header.add(datagram.first(ipv4_header));
  put16_at(datagram, 10, header.value());

  const std::uint32_t port = first_udp_port + frame.stream.value % 16384;
  writer.put16(encoding.udp_source_port != 0 ? encoding.udp_source_port : port);
  writer.put16(encoding.udp_port != 0 ? encoding.udp_port : port);
  writer.put16(udp.size());
  writer.put16(0);  // checksum, below
  put_payload(writer, frame, encoding);
  InternetChecksum checksum;
  checksum.add32(source);
  checksum.add32(destination);
  checksum.add16(udp_protocol);
  checksum.add16(udp.size());
  checksum.add(udp);
  put16_at(udp, 6, checksum.value() == 0 ? std::uint16_t{0xFFFF} : checksum.value());  // 0 would mean: none (RFC 768)
}

}  // namespace

std::uint32_t ipv4_address_of(models::AddressIndex address, std::uint32_t first_group) {
  const bool group = address.value >= first_group;
  const std::uint32_t host = address.value + (group ? 0 : 1);
  TAKT_CHECK(host < 1u << 24, "an address index fits into three octets");
  return (group ? 239u : 10u) << 24 | host;
}

std::span<const std::byte> encode_frame(const Frame& frame, const FrameEncoding& encoding, FrameBuffer& buffer) {
  TAKT_CHECK(frame.length >= models::minimum_frame.count && frame.length <= buffer.size(),
             "a frame has 64 octets to those of the longest jumbo frame");
  const std::span<std::byte> octets =
      std::span(buffer).first(frame.length - std::size_t{models::frame_check_sequence.count});
  std::fill(octets.begin(), octets.end(), std::byte{0});
  NetworkWriter writer(octets);
  // RFC 1112, 6.4: the low 23 bits of the group's address.
  const std::uint64_t of_group = 0x0100'5E00'0000 | (encoding.ip_group & 0x7F'FFFF);
  writer.put48(encoding.ip_group != 0 ? of_group
                                      : models::mac_address_of(frame.destination, encoding.first_group).value);
  writer.put48(models::mac_address_of(frame.source, encoding.first_group).value);
  if (frame.tagged) {
    writer.put16(0x8100);
    writer.put16(static_cast<unsigned>(frame.priority) << 13 | (encoding.drop_eligible ? 1u << 12 : 0u) | frame.vlan);
  }
  if (encoding.r_tag) writer.put(models::encode_r_tag(*encoding.r_tag));
  if (encoding.headers == models::ipv4_and_udp_headers) {
    writer.put16(0x0800);
    put_ipv4_and_udp(writer.rest(), frame, encoding);
    return octets;
  }
  writer.put16(encoding.ether_type);
  for (std::uint32_t i = 0; i < encoding.headers.count; ++i) writer.put8(0);
  put_payload(writer, frame, encoding);
  return octets;
}

std::span<const std::byte> encode_frame(const models::Network& network, models::FrameIndex index, FrameBuffer& buffer) {
  const Frame& frame = network.traffic().frame(index);
  return encode_frame(
      network, frame,
      frame.payload.is_none() ? std::span<const std::byte>() : network.traffic().payload(frame.payload).view(), buffer);
}

std::span<const std::byte> encode_frame(const models::Network& network, const Frame& frame,
                                        std::span<const std::byte> payload, FrameBuffer& buffer) {
  const models::Stream& stream = network.traffic().stream(frame.stream);
  FrameEncoding encoding;
  encoding.first_group = static_cast<std::uint32_t>(network.plan().nodes.size());
  encoding.headers = stream.headers;
  if (!frame.payload.is_none()) encoding.payload = payload;
  if (stream.ether_type != 0) encoding.ether_type = stream.ether_type;
  encoding.udp_port = stream.udp_port;
  encoding.udp_source_port = stream.udp_source_port;
  encoding.ip_group = stream.ip_group;
  if (frame.r_tagged) encoding.r_tag = frame.r_tag_sequence;
  encoding.drop_eligible = frame.drop_eligible;
  return encode_frame(frame, encoding, buffer);
}

}  // namespace takt::output
