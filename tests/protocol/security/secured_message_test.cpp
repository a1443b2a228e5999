// SPDX-License-Identifier: Apache-2.0
// Secured messages: known answers, captures of open62541 1.5.7 and what was made of them (tests/golden/security), and
// properties of channels.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "hex.hpp"
#include "security/secure_channel.hpp"

namespace takt::security::secured_message_test {
namespace {

using nlohmann::json;
using test::from_hex;
using test::to_hex;

const std::filesystem::path golden = std::filesystem::path(TAKT_SOURCE_DIR) / "tests/golden/security";

json read(const std::filesystem::path& path) {
  std::ifstream file(path);
  return json::parse(file);
}

MessagePolicy policy_of(const json& group) {
  return group["securityPolicyUri"] == uri_of(MessagePolicy::aes128_ctr) ? MessagePolicy::aes128_ctr
                                                                         : MessagePolicy::aes256_ctr;
}
MessageMode mode_of(const json& group) {
  return group["securityMode"] == "Sign" ? MessageMode::sign : MessageMode::sign_and_encrypt;
}

/// Keys as a capture has them; each is the current one for 100 ns.
KeyRing ring_of(const json& group) {
  std::vector<Secret> keys;
  for (const json& key : group["keys"]) keys.emplace_back(Octets(from_hex(key["keyData"].get<std::string>())));
  const auto first = group["keys"][0]["securityTokenId"].get<std::uint32_t>();
  return {policy_of(group), {first, 0, 100}, std::make_unique<ListedKeys>(first, std::move(keys))};
}

struct Receiver {
  explicit Receiver(const json& group, Nonces nonces = Nonces::counted)
      : windows(64), channel({mode_of(group), nonces, 0, 0}, ring_of(group), ReplayMemory(windows)) {}
  std::vector<StoredWindow> windows;
  SecureChannel channel;
};

/// What the message would be without security: "clearHex" has its SecurityHeader still.
std::string without_security(const json& message) {
  auto octets = from_hex(message["clearHex"].get<std::string>());
  const auto at = static_cast<std::ptrdiff_t>(message["securityHeader"]["offset"].get<std::size_t>());
  octets.erase(octets.begin() + at, octets.begin() + at + static_cast<std::ptrdiff_t>(security_header_octets));
  octets[1] &= ~std::byte{0x10};
  return to_hex(octets);
}

TEST(SecuredMessages, OfOpen62541AreOpened) {
  std::size_t seen = 0;
  for (const auto& entry : std::filesystem::directory_iterator(golden)) {
    if (!entry.path().filename().string().starts_with('s') || entry.path().extension() != ".json") continue;
    SCOPED_TRACE(entry.path().filename());
    const json capture = read(entry.path());
    const bool counts = !entry.path().filename().string().starts_with("s11");
    Receiver receiver(capture["securityGroup"], counts ? Nonces::counted : Nonces::lenient);
    Receiver signed_only(capture["securityGroup"]);
    const auto first = capture["securityGroup"]["keys"][0]["securityTokenId"].get<std::uint32_t>();
    for (const json& message : capture["messages"]) {
      const auto octets = from_hex(message["hex"].get<std::string>());
      const auto token = sim::load<std::uint32_t>(
          octets.data() + message["securityHeader"]["offset"].get<std::size_t>() + 1, sim::ByteOrder::little);
      const std::int64_t now = 100 * (token - first) + 50;
      const Opened opened = receiver.channel.open(octets, now);
      ASSERT_EQ(opened.verdict, SecurityVerdict::good);
      EXPECT_EQ(to_hex(opened.clear), without_security(message));
      EXPECT_EQ(receiver.channel.open(octets, now).verdict, SecurityVerdict::replayed);
      ++seen;
      // Every bit is signed, but for those of the signature itself; and those of the flags are looked at first.
      for (std::size_t bit = 0; bit < 8 * octets.size(); bit += 7) {
        auto other = octets;
        other[bit / 8] ^= static_cast<std::byte>(1U << bit % 8);
        EXPECT_NE(receiver.channel.open(other, now).verdict, SecurityVerdict::good) << "bit " << bit;
      }
      for (std::size_t size = 0; size < octets.size(); ++size)
        EXPECT_NE(receiver.channel.open(Octets(octets).first(size), now).verdict, SecurityVerdict::good) << size;
    }
  }
  EXPECT_GE(seen, 60u) << "the captures are there";
}

TEST(SecuredMessages, WhatWasMadeOfThemIsRefused) {
  const std::map<std::string, SecurityVerdict> expected = {
      {"accept", SecurityVerdict::good},
      {"accept, and fetch keys", SecurityVerdict::good},
      {"accept with wrong values, or malformed", SecurityVerdict::good},
      {"unsecured", SecurityVerdict::unsecured},
      {"security mode", SecurityVerdict::mode},
      {"token", SecurityVerdict::token},
      {"signature", SecurityVerdict::signature},
      {"replayed", SecurityVerdict::replayed},
      {"nonce length", SecurityVerdict::header},
      {"malformed", SecurityVerdict::header},
      {"reserved", SecurityVerdict::header},
      {"footer", SecurityVerdict::header},
      {"truncated", SecurityVerdict::truncated},
      {"strict: replayed; told: accept", SecurityVerdict::replayed}};
  const json cases = read(golden / "negative.json")["cases"];
  ASSERT_EQ(cases.size(), 36u);
  for (const json& each : cases) {
    SCOPED_TRACE(each["case"].get<std::string>());
    Receiver receiver(each["receiver"]);
    const auto keys = static_cast<std::int64_t>(each["receiver"]["keys"].size());
    for (const json& message : each["messages"]) {
      const Opened opened = receiver.channel.open(from_hex(message["hex"].get<std::string>()), 100 * keys - 50);
      EXPECT_EQ(opened.verdict, expected.at(message["expected"].get<std::string>())) << message["hex"];
      EXPECT_EQ(opened.verdict == SecurityVerdict::good && opened.wants_keys,
                message["expected"] == "accept, and fetch keys");
    }
  }
}

// Worked by hand with the openssl command: a message of 87 octets in each mode and policy.
struct KnownAnswer {
  MessagePolicy policy;
  MessageMode mode;
  std::uint32_t token;
  std::string sealed;
};
TEST(SecuredMessages, KnownAnswers) {
  const std::string clear = "b101ba080f640001000000010007001b0a000000feffffff000000000000f83f000000000000d0bf01";
  const KnownAnswer answers[] = {
      {MessagePolicy::aes128_ctr, MessageMode::sign_and_encrypt, 1,
       "b111ba080f64000100000001000700030100000008a1a2a3a4010000001e209ad43fe359df81a0bfe6137a21b09a9683d55caaba8fb0f51"
       "3d6ecf59b70f44850ac25743ca8837b6462d72d3a8d0515e9bf22216b029a54"},
      {MessagePolicy::aes128_ctr, MessageMode::sign, 1,
       "b111ba080f64000100000001000700010100000008a1a2a3a4010000001b0a000000feffffff000000000000f83f000000000000d0bf013"
       "e42a38830bd503f0de7ca73d1c36570add51f3b3b4526d583b2bbe3f161cf74"},
      {MessagePolicy::aes256_ctr, MessageMode::sign_and_encrypt, 2,
       "b111ba080f64000100000001000700030200000008a1a2a3a402000000e90b5f0f0c451ab0b5e8d58d654de2697397eb72df902287b4e39"
       "8d5de4b9069171ed4c1ecd030266525c1b0316489bddf7257ea08f606ef12e5"},
  };
  for (const KnownAnswer& each : answers) {
    std::vector<std::byte> key(key_octets(each.policy));
    for (std::size_t i = 0; i < key.size(); ++i) key[i] = static_cast<std::byte>(i);
    std::vector<StoredWindow> windows(64);
    std::vector<Secret> keys;
    keys.emplace_back(Octets(key));
    SecureChannel channel({each.mode, Nonces::lives, 0xA2A1, 0xA4A3},
                          KeyRing(each.policy, {each.token, 0, 0}, std::make_unique<ListedKeys>(each.token, keys)),
                          ReplayMemory(windows));
    Octets sealed;
    for (std::uint32_t number = 0; number < each.token; ++number)
      sealed = channel.seal(from_hex(clear), 5);  // the third has number 2
    EXPECT_EQ(to_hex(sealed), each.sealed);
    const std::vector<std::byte> copy(sealed.begin(), sealed.end());
    const Opened opened = channel.open(copy, 5);
    ASSERT_EQ(opened.verdict, SecurityVerdict::good);
    EXPECT_EQ(to_hex(opened.clear), clear);
  }
}

/// A node of a group whose keys change every 1000 ns.
struct Node {
  Node(std::uint16_t sender, std::uint16_t life, std::vector<StoredWindow>& windows,
       MessageMode mode = MessageMode::sign_and_encrypt)
      : channel({mode, Nonces::lives, sender, life},
                KeyRing(MessagePolicy::aes128_ctr, {1, 0, 1000},
                        std::make_unique<DerivedKeys>(MessagePolicy::aes128_ctr, "cell", Secret(32))),
                ReplayMemory(windows)) {}
  std::vector<std::byte> seal(std::uint16_t publisher, std::int64_t now, std::uint16_t group = 1) {
    auto octets = from_hex("b10101000f0100010000000100070001020304");
    sim::store(octets.data() + 2, publisher, sim::ByteOrder::little);
    sim::store(octets.data() + 5, group, sim::ByteOrder::little);
    const Octets sealed = channel.seal(octets, now);
    return {sealed.begin(), sealed.end()};
  }
  SecurityVerdict open(const std::vector<std::byte>& octets, std::int64_t now) {
    return channel.open(octets, now).verdict;
  }
  SecureChannel channel;
};

// Clocks that differ, and messages that are late, by less than a lifetime together: none is lost at a change of keys,
// and none is taken twice.
TEST(SecuredMessages, AChangeOfKeysCostsNothing) {
  for (const std::int64_t skew : {-900, -400, -1, 0, 1, 400, 900}) {
    for (const std::int64_t delay : {std::int64_t{0}, std::int64_t{1}, std::int64_t{50}, std::int64_t{99}}) {
      std::vector<StoredWindow> windows(64);
      std::vector<StoredWindow> own(64);
      Node receiver(2, 1, windows);
      Node sender(1, 1, own);
      std::vector<std::vector<std::byte>> all;
      std::set<std::uint32_t> tokens;
      for (std::int64_t now = 2000; now < 12'000; now += 37) {
        all.push_back(sender.seal(7, now + skew));
        tokens.insert(sender.channel.token());
        ASSERT_EQ(receiver.open(all.back(), now + delay), SecurityVerdict::good)
            << "skew " << skew << ", delay " << delay << ", at " << now;
        for (const auto& old : {all.front(), all[all.size() / 2], all.back()})
          ASSERT_NE(receiver.open(old, now + delay), SecurityVerdict::good);
      }
      EXPECT_GE(tokens.size(), 10u);
    }
  }
}

// Restarted as often as one likes, and whoever sends as whom: no two messages under a key have the same nonce.
TEST(SecuredMessages, NoncesNeverRepeat) {
  std::set<std::pair<std::uint32_t, std::string>> nonces;
  std::size_t messages = 0;
  for (std::uint16_t life = 1; life <= 20; ++life) {
    for (std::uint16_t sender = 1; sender <= 4; ++sender) {
      std::vector<StoredWindow> windows(64);
      Node node(sender, life, windows);
      for (std::int64_t now = 0; now < 3000; now += 50) {
        for (std::uint16_t publisher = 1; publisher <= 2; ++publisher) {
          const auto octets = node.seal(publisher, now, publisher);
          nonces.emplace(node.channel.token(), to_hex(Octets(octets).subspan(15 + 6, 8)));
          ++messages;
        }
      }
    }
  }
  EXPECT_EQ(nonces.size(), messages);
}

// What was ever sent is said again: to a receiver that goes on, to one that was restarted with its memory, and by the
// sender's former lives.
TEST(SecuredMessages, NothingIsTakenTwice) {
  std::vector<StoredWindow> windows(64);
  std::vector<StoredWindow> own(64);
  std::vector<std::vector<std::byte>> all;
  auto receiver = std::make_unique<Node>(2, 1, windows);
  std::uint16_t life = 1;
  auto sender = std::make_unique<Node>(1, life, own);
  for (std::int64_t now = 0; now < 8000; now += 100) {
    if (now % 700 == 0) receiver = std::make_unique<Node>(2, 1, windows);
    if (now % 1100 == 0) sender = std::make_unique<Node>(1, ++life, own);
    for (const std::uint16_t publisher : {std::uint16_t{1}, std::uint16_t{5}}) {
      all.push_back(sender->seal(publisher, now));
      ASSERT_EQ(receiver->open(all.back(), now), SecurityVerdict::good) << now;
    }
    for (const auto& old : all) ASSERT_NE(receiver->open(old, now), SecurityVerdict::good) << now;
  }
}

TEST(SecuredMessages, AClockThatGoesBackUsesNoOldKey) {
  std::vector<StoredWindow> windows(64);
  Node node(1, 1, windows);
  node.seal(1, 5500);
  EXPECT_EQ(node.channel.token(), 6u);
  node.seal(1, 100);
  EXPECT_EQ(node.channel.token(), 6u);
}

// A clock that was set far ahead, and back again: with another life the node is heard at once, hears the others, and no
// nonce is used twice.
TEST(SecuredMessages, AClockThatWasFarAheadIsFollowedBack) {
  std::vector<StoredWindow> windows(64);
  std::vector<StoredWindow> own(64);
  Node receiver(2, 1, windows);
  Node node(1, 1, own);
  std::set<std::string> nonces;
  const auto say = [&](std::int64_t now) {
    const auto octets = node.seal(1, now);
    EXPECT_TRUE(nonces.insert(std::to_string(node.channel.token()) + to_hex(Octets(octets).subspan(15 + 6, 8))).second);
    return octets;
  };
  EXPECT_EQ(receiver.open(say(5500), 5500), SecurityVerdict::good);
  EXPECT_EQ(receiver.open(say(900'000), 5500), SecurityVerdict::token);
  EXPECT_EQ(receiver.open(say(5600), 5600), SecurityVerdict::token) << "a token is not gone back behind by itself";
  EXPECT_TRUE(node.channel.keys().was_ahead(5600));
  node.channel.begin_anew(2, 5600);
  EXPECT_EQ(receiver.open(say(5600), 5600), SecurityVerdict::good);
  EXPECT_FALSE(node.channel.keys().was_ahead(5600));
  EXPECT_EQ(node.open(receiver.seal(2, 5600), 5600), SecurityVerdict::good);
}

TEST(KeyRing, GoesOnForTwoLifetimesAndThenStops) {
  std::vector<Secret> keys(2, Secret(52));
  KeyRing ring(MessagePolicy::aes128_ctr, {0xFFFF'FFFF, 1000, 100}, std::make_unique<ListedKeys>(0xFFFF'FFFF, keys));
  EXPECT_FALSE(ring.current(999)) << "before the first key";
  EXPECT_EQ(ring.current(1000)->token, 0xFFFF'FFFFU);
  EXPECT_EQ(ring.current(1100)->token, 1u) << "0 is no token";
  EXPECT_NE(ring.find(0xFFFF'FFFFU, 1199), nullptr) << "the one before";
  EXPECT_EQ(ring.current(1399)->token, 1u);
  EXPECT_NE(ring.find(1, 1399), nullptr);
  EXPECT_FALSE(ring.current(1400));
  EXPECT_EQ(ring.find(1, 1400), nullptr);
  EXPECT_EQ(ring.find(0, 1400), nullptr);
}

TEST(KeyRing, TakesTheKeysAroundTheCurrentOne) {
  KeyRing ring(MessagePolicy::aes256_ctr, {1, 0, 100},
               std::make_unique<DerivedKeys>(MessagePolicy::aes256_ctr, "cell", Secret(32)));
  for (std::uint32_t token = 1; token <= 20; ++token)
    EXPECT_EQ(ring.find(token, 950) != nullptr, token >= 9 && token <= 11) << token;
}

// HKDF-Expand (RFC 5869) with HMAC-SHA256; worked with Python's hmac.
TEST(DerivedKeys, AreThoseOfTheDocumentation) {
  Secret secret(32);
  for (std::size_t i = 0; i < 32; ++i) secret.octets()[i] = static_cast<std::byte>(i);
  const DerivedKeys keys(MessagePolicy::aes128_ctr, "cell", secret);
  EXPECT_EQ(to_hex(keys.key(7)->octets()),
            "735340c8dd9ce588dbf95e225ae21e8ac44d0b0a1ceab4fdff729b3a6ef84439fb4bb35b2ace17ba7a5af3f6f74e2aa82e2e7362");
  EXPECT_FALSE(keys.key(0));
}

// A window is sound whatever was written of it when the process ended.
TEST(ReplayMemory, IsBounded) {
  std::vector<StoredWindow> windows(128);
  ReplayMemory memory(windows);
  std::size_t taken = 0;
  for (std::uint64_t publisher = 1; publisher <= 1000; ++publisher)
    taken += memory.take({publisher, 1, 1}, {5, 1, 1}) ? 1 : 0;
  EXPECT_GE(taken, 100u);
  EXPECT_LE(taken, 128u) << "no room for others under this key";
  for (std::uint64_t publisher = 1; publisher <= 1000; ++publisher)
    EXPECT_FALSE(memory.take({publisher, 1, 1}, {5, 1, 1}) && publisher <= 64) << publisher;
  EXPECT_TRUE(memory.take({5000, 1, 1}, {8, 1, 1})) << "those of keys that are gone make room";
}

TEST(Overhead, IsBelowTwoMicroseconds) {
#ifndef NDEBUG
  GTEST_SKIP() << "of a release build";
#endif
  std::vector<StoredWindow> windows(64);
  Node node(1, 1, windows);
  std::vector<std::byte> clear = from_hex("b10101000f010001000000010007001b070000");
  clear.resize(200);
  double best = 1e9;
  for (int batch = 0; batch < 50; ++batch) {
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < 200; ++i) ASSERT_FALSE(node.channel.seal(clear, 5).empty());
    best = std::min(best,
                    std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count() / 200);
  }
  double open = 1e9;
  for (int batch = 0; batch < 50; ++batch) {
    std::vector<std::vector<std::byte>> messages;
    for (int i = 0; i < 200; ++i) {
      const Octets sealed = node.channel.seal(clear, 5);
      messages.emplace_back(sealed.begin(), sealed.end());
    }
    const auto begin = std::chrono::steady_clock::now();
    for (const auto& message : messages) ASSERT_EQ(node.open(message, 5), SecurityVerdict::good);
    open = std::min(open,
                    std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count() / 200);
  }
  std::printf("200 octets: sealed in %.2f us, opened in %.2f us (the best of 50 times 200)\n", best, open);
  EXPECT_LE(best, 2.0);
  EXPECT_LE(open, 2.0);
}

}  // namespace
}  // namespace takt::security::secured_message_test
