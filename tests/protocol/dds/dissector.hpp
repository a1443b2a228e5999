// SPDX-License-Identifier: Apache-2.0
// RTPS messages as a capture, and what tshark says about them.
#pragma once

#include <string>
#include <vector>

#include "dds/message/locator.hpp"
#include "dds/message/octets.hpp"

namespace takt::dds::test {

/// A UDP datagram over IPv4.
struct Datagram {
  std::int64_t at_us = 0;
  std::uint32_t from_ip = 0x0A000001;
  std::uint16_t from_port = 7410;
  std::uint32_t to_ip = 0x0A000002;
  std::uint16_t to_port = 7411;
  std::vector<std::byte> payload;
};

/// Writes a capture of raw IP packets with sound checksums.
void write_pcap(const std::string& path, const std::vector<Datagram>& datagrams);

/// The UDP datagrams of a capture of Ethernet frames with IPv4, in the format pcap.
std::vector<Datagram> read_pcap(const std::string& path);

bool has_tshark();

/// What tshark finds in a capture; one row a frame.
struct Dissected {
  std::vector<std::string> protocols;    ///< "raw:ip:udp:rtps"
  std::vector<std::string> submessages;  ///< ids, as "0x09,0x15"
  std::vector<std::string> complaints;   ///< malformed fields and expert messages; none if all is well
};
Dissected dissect(const std::string& path);

/// A file that is removed in the end.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& name);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace takt::dds::test
