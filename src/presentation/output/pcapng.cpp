// SPDX-License-Identifier: Apache-2.0
#include "output/pcapng.hpp"

#include <array>

#include "sim/octets.hpp"

namespace takt::output::pcapng {
namespace {

enum class BlockType : std::uint32_t { section_header = 0x0A0D0D0A, interface_description = 1, enhanced_packet = 6 };

// Codes of options; what a code means depends on the block. 0 ends a list.
constexpr std::uint16_t shb_userappl = 4, if_name = 2, if_speed = 8, if_tsresol = 9, if_fcslen = 13, epb_flags = 2;

constexpr std::uint32_t byte_order_magic = 0x1A2B'3C4D;
constexpr std::uint16_t link_type_ethernet = 1;
constexpr std::uint32_t no_snapshot_length = 0;
constexpr std::uint32_t outbound = 2;  // bits 0 and 1 of epb_flags

/// A block as it grows; everything is padded to whole words.
class Block {
 public:
  Block(std::string& to, BlockType type) : to_(to), begin_(to.size()) {
    put(static_cast<std::uint32_t>(type));
    put(std::uint32_t{0});  // the length, which end() knows
  }

  template <sim::Number T>
  void put(T value) {
    std::array<std::byte, sizeof(T)> octets;
    sim::store(octets.data(), value, sim::ByteOrder::little);
    to_.append(reinterpret_cast<const char*>(octets.data()), octets.size());
  }
  void put(std::string_view octets) {
    to_.append(octets);
    pad();
  }
  void put_option(std::uint16_t code, std::string_view octets) {
    const std::string_view value = octets.substr(0, 0xFFFF);
    put(code);
    put(static_cast<std::uint16_t>(value.size()));
    put(value);
  }
  template <sim::Number T>
  void put_option(std::uint16_t code, T value) {
    put(code);
    put(static_cast<std::uint16_t>(sizeof value));
    put(value);
    pad();
  }
  /// After options, if there were any.
  void end_options() { put(std::uint32_t{0}); }

  void end() {
    const auto length = static_cast<std::uint32_t>(to_.size() - begin_ + 4);
    put(length);
    sim::store(reinterpret_cast<std::byte*>(to_.data() + begin_ + 4), length, sim::ByteOrder::little);
  }

 private:
  void pad() { to_.append(sim::rounded_up(to_.size() - begin_, 4) - (to_.size() - begin_), '\0'); }

  std::string& to_;
  std::size_t begin_;
};

}  // namespace

void add_section_header(std::string& to, std::string_view application) {
  Block block(to, BlockType::section_header);
  block.put(byte_order_magic);
  block.put(std::uint16_t{1});  // version 1.0
  block.put(std::uint16_t{0});
  block.put(~std::uint64_t{0});  // the length of the section is not known yet
  block.put_option(shb_userappl, application);
  block.end_options();
  block.end();
}

void add_interface(std::string& to, const Interface& interface) {
  Block block(to, BlockType::interface_description);
  block.put(link_type_ethernet);
  block.put(std::uint16_t{0});
  block.put(no_snapshot_length);
  block.put_option(if_name, interface.name);
  block.put_option(if_speed, interface.bits_per_second);
  block.put_option(if_tsresol, time_resolution);
  block.put_option(if_fcslen, std::uint8_t{0});
  block.end_options();
  block.end();
}

void add_outbound_packet(std::string& to, std::uint32_t interface, std::int64_t time_ns,
                         std::span<const std::byte> octets) {
  TAKT_CHECK(time_ns >= 0, "a capture counts from the beginning of the run");
  const auto time = static_cast<std::uint64_t>(time_ns);
  const auto length = static_cast<std::uint32_t>(octets.size());
  Block block(to, BlockType::enhanced_packet);
  block.put(interface);
  block.put(static_cast<std::uint32_t>(time >> 32));
  block.put(static_cast<std::uint32_t>(time & 0xFFFF'FFFF));
  block.put(length);  // captured
  block.put(length);  // on the wire
  block.put(std::string_view(reinterpret_cast<const char*>(octets.data()), octets.size()));
  block.put_option(epb_flags, outbound);
  block.end_options();
  block.end();
}

}  // namespace takt::output::pcapng
