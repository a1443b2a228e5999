// SPDX-License-Identifier: Apache-2.0
#include "dds/dissector.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "dds/message/octets.hpp"

namespace takt::dds::test {
namespace {

std::uint32_t sum_of(Octets octets) {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < octets.size(); ++i)
    sum += std::to_integer<std::uint32_t>(octets[i]) << (i % 2 == 0 ? 8 : 0);
  return sum;
}

std::uint16_t checksum(std::uint32_t sum) {
  while (sum >> 16 != 0) sum = (sum & 0xFFFF) + (sum >> 16);
  return static_cast<std::uint16_t>(~sum);
}

std::vector<std::byte> packet_of(const Datagram& datagram) {
  std::vector<std::byte> packet(28 + datagram.payload.size());
  Writer writer(packet, ByteOrder::big);
  const auto udp_length = static_cast<std::uint16_t>(8 + datagram.payload.size());
  writer.put(std::uint16_t{0x4500});
  writer.put(static_cast<std::uint16_t>(20 + udp_length));
  writer.put(std::uint32_t{0});
  writer.put(std::uint16_t{0x4011});
  writer.put(std::uint16_t{0});
  writer.put(datagram.from_ip);
  writer.put(datagram.to_ip);
  writer.put(datagram.from_port);
  writer.put(datagram.to_port);
  writer.put(udp_length);
  writer.put(std::uint16_t{0});
  writer.put_octets(datagram.payload);
  const Octets octets(packet);
  writer.patch(10, checksum(sum_of(octets.first(20))));
  writer.patch(26, checksum(sum_of(octets.subspan(12)) + 17 + udp_length));
  return packet;
}

std::string output_of(const std::string& command) {
  std::FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error(command);
  std::string text;
  std::array<char, 4096> part;
  for (std::size_t got = 0; (got = std::fread(part.data(), 1, part.size(), pipe)) != 0;) text.append(part.data(), got);
  if (pclose(pipe) != 0) throw std::runtime_error(command);
  return text;
}

}  // namespace

void write_pcap(const std::string& path, const std::vector<Datagram>& datagrams) {
  std::ofstream file(path, std::ios::binary);
  const auto put = [&](std::uint32_t number) {
    std::array<std::byte, 4> octets;
    store(octets.data(), number, ByteOrder::little);
    file.write(reinterpret_cast<const char*>(octets.data()), 4);
  };
  constexpr std::uint32_t raw_ip = 101;
  for (const std::uint32_t number : {0xA1B2C3D4U, 0x0004'0002U, 0U, 0U, 65535U, raw_ip}) put(number);
  for (const Datagram& datagram : datagrams) {
    const std::vector<std::byte> packet = packet_of(datagram);
    put(static_cast<std::uint32_t>(datagram.at_us / 1'000'000));
    put(static_cast<std::uint32_t>(datagram.at_us % 1'000'000));
    put(static_cast<std::uint32_t>(packet.size()));
    put(static_cast<std::uint32_t>(packet.size()));
    file.write(reinterpret_cast<const char*>(packet.data()), static_cast<std::streamsize>(packet.size()));
  }
}

std::vector<Datagram> read_pcap(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const Octets all = std::as_bytes(std::span(text));
  constexpr std::size_t file_header = 24, frame_header = 16, ethernet = 14, ip_and_udp = 28;
  std::vector<Datagram> datagrams;
  std::optional<std::int64_t> begin_us;
  for (std::size_t at = file_header; at + frame_header <= all.size();) {
    const auto number = [&](std::size_t offset) {
      return std::int64_t{load<std::uint32_t>(all.data() + at + offset, ByteOrder::little)};
    };
    const std::int64_t now_us = number(0) * 1'000'000 + number(4);
    const auto size = static_cast<std::size_t>(number(8));
    const Octets frame = all.subspan(at + frame_header, size);
    at += frame_header + size;
    if (frame.size() < ethernet + ip_and_udp || frame[23] != std::byte{17}) continue;
    const std::byte* const ip = frame.data() + ethernet;
    Datagram datagram;
    begin_us = begin_us.value_or(now_us);
    datagram.at_us = now_us - *begin_us;
    datagram.from_ip = load<std::uint32_t>(ip + 12, ByteOrder::big);
    datagram.to_ip = load<std::uint32_t>(ip + 16, ByteOrder::big);
    datagram.from_port = load<std::uint16_t>(ip + 20, ByteOrder::big);
    datagram.to_port = load<std::uint16_t>(ip + 22, ByteOrder::big);
    const std::size_t length = load<std::uint16_t>(ip + 24, ByteOrder::big);
    const Octets payload = frame.subspan(ethernet + ip_and_udp, length - 8);
    datagram.payload.assign(payload.begin(), payload.end());
    datagrams.push_back(std::move(datagram));
  }
  return datagrams;
}

bool has_tshark() { return std::system("command -v tshark >/dev/null 2>&1") == 0; }

Dissected dissect(const std::string& path) {
  const std::string text =
      output_of("tshark -n -r '" + path +
                "' -o ip.check_checksum:TRUE -o udp.check_checksum:TRUE -T fields -e frame.protocols -e rtps.sm.id"
                " -e _ws.malformed -e _ws.expert.message 2>/dev/null");
  Dissected result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> fields;
    std::istringstream columns(line + "\t|");
    for (std::string field; std::getline(columns, field, '\t');) fields.push_back(field);
    result.protocols.push_back(fields.at(0));
    result.submessages.push_back(fields.at(1));
    for (std::size_t i = 2; i + 1 < fields.size(); ++i)
      if (!fields[i].empty())
        result.complaints.push_back("frame " + std::to_string(result.protocols.size()) + ": " + fields[i]);
  }
  return result;
}

TemporaryFile::TemporaryFile(const std::string& name)
    : path_((std::filesystem::temp_directory_path() / ("takt-" + std::to_string(getpid()) + "-" + name)).string()) {}
TemporaryFile::~TemporaryFile() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace takt::dds::test
