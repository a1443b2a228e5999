// SPDX-License-Identifier: Apache-2.0
// tshark understands every submessage and finds nothing to complain about.
#include "dds/dissector.hpp"

#include <gtest/gtest.h>

#include "dds/message/decoder.hpp"
#include "dds/message/samples.hpp"

namespace takt::dds {
namespace {

using namespace test;

TEST(Dissector, KnowsEverySubmessage) {
  ASSERT_TRUE(has_tshark()) << "this test needs tshark";
  std::vector<Datagram> datagrams;
  std::vector<std::string> expected;
  std::vector<std::byte> buffer(4096);
  for (const ByteOrder order : {ByteOrder::little, ByteOrder::big}) {
    for (const Submessage& each : every_submessage()) {
      MessageEncoder encoder(buffer, some_header, order);
      encoder.add(InfoDestination{other_prefix});
      ASSERT_TRUE(encoder.add(each));
      Datagram datagram;
      datagram.at_us = static_cast<std::int64_t>(datagrams.size());
      datagram.payload = copy(encoder.message());
      MessageDecoder decoder(datagram.payload);
      while (decoder.next()) continue;
      constexpr const char* digits = "0123456789abcdef";
      const auto id = static_cast<unsigned>(decoder.kind());
      expected.push_back(std::string("0x0e,0x") + digits[id >> 4] + digits[id & 0xF]);
      datagrams.push_back(std::move(datagram));
    }
  }
  const TemporaryFile file("submessages.pcap");
  write_pcap(file.path(), datagrams);
  const Dissected dissected = dissect(file.path());
  ASSERT_EQ(dissected.protocols.size(), datagrams.size());
  for (const std::string& protocols : dissected.protocols) EXPECT_EQ(protocols, "raw:ip:udp:rtps");
  EXPECT_EQ(dissected.submessages, expected);
  EXPECT_EQ(dissected.complaints, std::vector<std::string>());
}

// The test above can fail.
TEST(Dissector, ComplainsAboutDamage) {
  ASSERT_TRUE(has_tshark()) << "this test needs tshark";
  std::vector<std::byte> buffer(4096);
  MessageEncoder encoder(buffer, some_header);
  encoder.add(Heartbeat{some_reader, some_writer, {1}, {1}, 1, false, false});
  Datagram datagram;
  datagram.payload = copy(encoder.message().first(encoder.size() - 6));
  const TemporaryFile file("damage.pcap");
  write_pcap(file.path(), {datagram});
  EXPECT_FALSE(dissect(file.path()).complaints.empty());
}

}  // namespace
}  // namespace takt::dds
