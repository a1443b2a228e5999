// SPDX-License-Identifier: Apache-2.0
// Octets of a connection become messages, however they come.
#include <gtest/gtest.h>

#include "opcua/transport/message.hpp"
#include "transcript.hpp"

namespace takt::opcua {
namespace {

std::vector<std::byte> client_side() {
  std::vector<std::byte> all;
  for (const auto& message : test::transcript("none"))
    if (message.from_client) all.insert(all.end(), message.octets.begin(), message.octets.end());
  return all;
}

/// The messages, one behind the other with their number, if the octets come in pieces of so many.
std::pair<std::size_t, std::vector<std::byte>> split(Octets octets, std::size_t piece) {
  MessageSplitter splitter(65536);
  std::pair<std::size_t, std::vector<std::byte>> out{};
  for (std::size_t at = 0; at < octets.size(); at += piece) {
    splitter.feed(octets.subspan(at, std::min(piece, octets.size() - at)));
    while (const auto message = splitter.next()) {
      ++out.first;
      out.second.insert(out.second.end(), message->begin(), message->end());
    }
  }
  EXPECT_EQ(splitter.failure(), StatusCode::Good);
  EXPECT_FALSE(splitter.is_within_message());
  return out;
}

TEST(Splitter, ThePiecesDoNotMatter) {
  const auto octets = client_side();
  const auto once = split(octets, octets.size());
  EXPECT_GT(once.first, 30u);
  EXPECT_EQ(once.second, octets);
  for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, std::size_t{8}, std::size_t{57}, std::size_t{1000}})
    EXPECT_EQ(split(octets, piece), once) << piece;
}

StatusCode failure_of(const std::string& hexadecimal) {
  MessageSplitter splitter(8192);
  splitter.feed(test::octets_of(hexadecimal));
  EXPECT_FALSE(splitter.next());
  // It stays so, whatever comes.
  const StatusCode failure = splitter.failure();
  splitter.feed(test::octets_of("48454c4608000000"));
  if (failure != StatusCode::Good) {
    EXPECT_FALSE(splitter.next());
  }
  return failure;
}

TEST(Splitter, RefusesByTheHeaderAlone) {
  EXPECT_EQ(failure_of("4d534746ffffff7f"), StatusCode::BadTcpMessageTooLarge);
  EXPECT_EQ(failure_of("4d53474601200000"), StatusCode::BadTcpMessageTooLarge);     // 8193
  EXPECT_EQ(failure_of("4d53474600200000"), StatusCode::Good);                      // 8192: the rest must come
  EXPECT_EQ(failure_of("4d5347460b000000"), StatusCode::BadTcpMessageTypeInvalid);  // shorter than its header
  EXPECT_EQ(failure_of("4d53475808000000"), StatusCode::BadTcpMessageTypeInvalid);  // MSGX
  EXPECT_EQ(failure_of("4f504e4320000000"), StatusCode::BadTcpMessageTypeInvalid);  // OPN is never in parts
  EXPECT_EQ(failure_of("4745542f00000000"), StatusCode::BadTcpMessageTypeInvalid);  // "GET/"
}

}  // namespace
}  // namespace takt::opcua
