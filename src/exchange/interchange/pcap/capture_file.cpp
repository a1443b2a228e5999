// SPDX-License-Identifier: Apache-2.0
#include "interchange/pcap/capture_file.hpp"

#include <fmt/format.h>

#include <limits>
#include <optional>
#include <vector>

#include "sim/time.hpp"

namespace takt::interchange {
namespace {

using sim::ByteOrder;
using sim::OctetSpan;
using Reader = sim::OctetReader<ByteOrder>;
using Take = std::function<bool(const CapturedFrame&)>;

constexpr std::uint32_t ethernet = 1;
constexpr std::int64_t ns_in_a_second = 1'000'000'000;

/// Which order makes `magic` of the first four octets.
std::optional<ByteOrder> order_for(OctetSpan octets, std::uint32_t magic) {
  if (octets.size() < sizeof magic) return std::nullopt;
  for (const ByteOrder order : {ByteOrder::little, ByteOrder::big})
    if (sim::load<std::uint32_t>(octets.data(), order) == magic) return order;
  return std::nullopt;
}

std::string cut_short(std::size_t frames) { return fmt::format("the file ends within what follows frame {}", frames); }

/// The format of libpcap: a header of 24 octets, and 16 before each frame.
std::string read_pcap(OctetSpan file, ByteOrder order, std::int64_t ns_of_a_fraction, const Take& take) {
  Reader reader(file, order);
  reader.take(20);
  const std::uint32_t link_type = reader.get<std::uint32_t>() & 0x0FFF'FFFF;  // above: whether there is an FCS
  if (reader.failed()) return cut_short(0);
  if (link_type != ethernet) return "no Ethernet";
  for (std::size_t count = 0; reader.left() > 0; ++count) {
    CapturedFrame frame;
    frame.time_ns = std::int64_t{reader.get<std::uint32_t>()} * ns_in_a_second;
    frame.time_ns += std::int64_t{reader.get<std::uint32_t>()} * ns_of_a_fraction;
    const auto captured = reader.get<std::uint32_t>();
    frame.length = reader.get<std::uint32_t>();
    frame.octets = reader.take(captured);
    if (reader.failed()) return cut_short(count);
    if (!take(frame)) return {};
  }
  return {};
}

/// draft-ietf-opsawg-pcapng.
class Pcapng {
 public:
  Pcapng(OctetSpan file, const Take& take) : file_(file), take_(take) {}

  std::string read() {
    while (!file_.empty() && goes_on_) {
      if (is_section_header(file_))
        if (std::string problem = begin_section(); !problem.empty()) return problem;
      Reader reader(file_, order_);
      const auto type = reader.get<std::uint32_t>();
      const auto length = reader.get<std::uint32_t>();
      if (reader.failed() || length < 12 || length % 4 != 0 || length > file_.size()) return cut_short(frames_);
      if (std::string problem = read_block(type, file_.subspan(8, length - 12)); !problem.empty()) return problem;
      file_ = file_.subspan(length);
    }
    return frames_ > 0 && !has_ethernet_ ? "no Ethernet" : "";
  }

  static bool is_section_header(OctetSpan octets) { return order_for(octets, section_header).has_value(); }

 private:
  struct Interface {
    bool is_ethernet = false;
    std::uint8_t resolution = 6;  // 10^-6, or 2^-n with the highest bit
    std::int64_t offset = 0;      // seconds
  };
  static constexpr std::uint32_t section_header = 0x0A0D'0D0A;  // the same in both orders
  static constexpr std::uint32_t byte_order_magic = 0x1A2B'3C4D;
  static constexpr std::uint32_t interface_description = 1, simple_packet = 3, enhanced_packet = 6;
  static constexpr std::uint16_t if_tsresol = 9, if_tsoffset = 14;
  static constexpr std::size_t most_interfaces = std::size_t{1} << 20;

  std::string begin_section() {
    const auto order = file_.size() < 12 ? std::nullopt : order_for(file_.subspan(8), byte_order_magic);
    if (!order) return "a section of pcapng without a byte order";
    order_ = *order;
    before_ += static_cast<std::uint32_t>(interfaces_.size());
    interfaces_.clear();
    return {};
  }

  std::string read_block(std::uint32_t type, OctetSpan body) {
    switch (type) {
      case interface_description:
        return describe(body);
      case enhanced_packet:
        return read_packet(body);
      case simple_packet:
        return "frames without times (Simple Packet Blocks)";
      default:
        return {};
    }
  }

  std::string describe(OctetSpan body) {
    if (before_ + interfaces_.size() >= most_interfaces) return fmt::format("more than {} interfaces", most_interfaces);
    Reader reader(body, order_);
    Interface& made = interfaces_.emplace_back();
    made.is_ethernet = reader.get<std::uint16_t>() == ethernet;
    reader.take(6);  // how much of a frame is captured does not matter here
    while (reader.left() >= 4) {
      const auto code = reader.get<std::uint16_t>();
      const auto length = reader.get<std::uint16_t>();
      if (code == 0) break;
      Reader value(reader.take(length), order_);
      if (code == if_tsresol) made.resolution = value.get<std::uint8_t>();
      if (code == if_tsoffset) made.offset = value.get<std::int64_t>();
      reader.align(4);
    }
    return reader.failed() ? cut_short(frames_) : std::string();
  }

  std::string read_packet(OctetSpan body) {
    Reader reader(body, order_);
    const auto interface = reader.get<std::uint32_t>();
    const std::uint64_t high = reader.get<std::uint32_t>();
    const std::uint64_t time = high << 32 | reader.get<std::uint32_t>();
    const auto captured = reader.get<std::uint32_t>();
    CapturedFrame frame;
    frame.length = reader.get<std::uint32_t>();
    frame.octets = reader.take(captured);
    if (reader.failed()) return cut_short(frames_);
    if (interface >= interfaces_.size())
      return fmt::format("a frame of interface {}, which the file does not describe, after frame {}", interface,
                         frames_);
    ++frames_;
    if (!interfaces_[interface].is_ethernet) return {};
    const auto time_ns = nanoseconds(time, interfaces_[interface]);
    if (!time_ns) return fmt::format("a time beyond 292 years at frame {}", frames_);
    frame.interface = before_ + interface;
    frame.time_ns = *time_ns;
    has_ethernet_ = true;
    goes_on_ = take_(frame);
    return {};
  }

  static std::optional<std::int64_t> nanoseconds(std::uint64_t time, const Interface& interface) {
    const std::uint8_t digits = interface.resolution & 0x7F;
    sim::int128 ns = time;
    if ((interface.resolution & 0x80) != 0) {
      ns = digits > 95 ? 0 : ns * ns_in_a_second >> digits;  // less than 2^94
    } else {
      for (int i = digits; i < 9; ++i) ns *= 10;
      for (int i = 9; i < digits; ++i) ns /= 10;
    }
    ns += sim::int128{interface.offset} * ns_in_a_second;
    if (ns < std::numeric_limits<std::int64_t>::min() || ns > std::numeric_limits<std::int64_t>::max())
      return std::nullopt;
    return static_cast<std::int64_t>(ns);
  }

  OctetSpan file_;
  const Take& take_;
  ByteOrder order_ = ByteOrder::little;
  std::vector<Interface> interfaces_;
  std::uint32_t before_ = 0;  // interfaces of former sections
  std::size_t frames_ = 0;
  bool has_ethernet_ = false;
  bool goes_on_ = true;
};

}  // namespace

std::string read_captured_frames(std::string_view file, const Take& take) {
  const OctetSpan octets = std::as_bytes(std::span(file.data(), file.size()));
  if (Pcapng::is_section_header(octets)) return Pcapng(octets, take).read();
  if (const auto order = order_for(octets, 0xA1B2'C3D4)) return read_pcap(octets, *order, 1000, take);
  if (const auto order = order_for(octets, 0xA1B2'3C4D)) return read_pcap(octets, *order, 1, take);
  return file.empty() ? "an empty file" : "neither the beginning of pcap nor of pcapng";
}

}  // namespace takt::interchange
