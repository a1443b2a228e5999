// SPDX-License-Identifier: Apache-2.0
// Keys from a key service: what of its answers is believed, and that a node that pulls loses nothing while keys change.
#include "security/pulled_keys.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "security/secure_channel.hpp"

namespace takt::security::pulled_keys_test {
namespace {

constexpr std::int64_t ms = 1'000'000;
constexpr double lifetime_ms = 1000;

Secret secret() { return Secret(32); }

/// A service whose keys are derived, as those of a file are.
struct Service {
  DerivedKeys keys{MessagePolicy::aes128_ctr, "cell", secret()};
  KeySchedule schedule{1, 0, 1000 * ms};
  std::uint32_t future = PulledKeys::future_keys;

  GivenKeys at(std::int64_t now_ns) const {
    const std::uint64_t changes = schedule.changes_until(now_ns);
    GivenKeys given{std::string(uri_of(MessagePolicy::aes128_ctr)), schedule.token_after(changes), {}, 0, lifetime_ms};
    for (std::uint64_t i = 0; i <= future; ++i) given.keys.push_back(*keys.key(schedule.token_after(changes + i)));
    given.time_to_next_ms =
        lifetime_ms - static_cast<double>((now_ns - schedule.first_ns) % schedule.lifetime_ns) / 1e6;
    return given;
  }
};

KeyRing empty_ring() {
  return {MessagePolicy::aes128_ctr,
          {1, std::numeric_limits<std::int64_t>::max(), 0},
          std::make_unique<ListedKeys>(1, std::vector<Secret>())};
}

std::vector<std::byte> word() {
  // UADP version 1 with PublisherId and GroupHeader: publisher 7, group 1, sequence number 1; one DataSetMessage of
  // four octets.
  const unsigned char octets[] = {0x31, 0x01, 0x07, 0x00, 0x01, 0x01, 0x00, 0x01, 0x00,
                                  0x01, 0x00, 0x01, 0x00, 1,    2,    3,    4};
  const auto bytes = std::as_bytes(std::span(octets));
  return {bytes.begin(), bytes.end()};
}

TEST(PulledKeys, HaveTheTokensOfTheService) {
  const Service service;
  PulledKeys keys(MessagePolicy::aes128_ctr);
  ASSERT_EQ(keys.take(service.at(5250 * ms), 5250 * ms), "");
  EXPECT_EQ(keys.schedule(), (KeySchedule{6, 5000 * ms, 1000 * ms}));
  EXPECT_EQ(keys.ends_ns(), 10'000 * ms) << "the current one and four behind it";
  EXPECT_EQ(keys.next_pull_ns(5250 * ms), 6250 * ms) << "not more often than each second";
  ASSERT_EQ(keys.take(service.at(6300 * ms), 6300 * ms), "");
  EXPECT_EQ(keys.schedule(), (KeySchedule{6, 5000 * ms, 1000 * ms})) << "with the one before, which late messages have";
  EXPECT_EQ(*keys.source()->key(6), *service.keys.key(6));
  ASSERT_EQ(keys.take(service.at(20'300 * ms), 20'300 * ms), "") << "after an outage";
  EXPECT_EQ(keys.schedule().first_token, 21u);
}

TEST(PulledKeys, WhatIsNotBelieved) {
  const Service service;
  PulledKeys keys(MessagePolicy::aes128_ctr);
  ASSERT_EQ(keys.take(service.at(5250 * ms), 5250 * ms), "");
  const KeySchedule before = keys.schedule();
  const auto refusal = [&](auto change) {
    GivenKeys given = service.at(6300 * ms);
    change(given);
    return keys.take(given, 6300 * ms);
  };
  EXPECT_EQ(refusal([](GivenKeys& given) { given.policy_uri = uri_of(MessagePolicy::aes256_ctr); }),
            "keys of another policy");
  EXPECT_EQ(refusal([](GivenKeys& given) { given.first_token = 0; }), "a token of 0");
  EXPECT_EQ(refusal([](GivenKeys& given) { given.keys.clear(); }), "no keys");
  EXPECT_EQ(refusal([](GivenKeys& given) { given.keys.assign(65, given.keys[0]); }), "more than 64 keys");
  EXPECT_EQ(refusal([](GivenKeys& given) { given.keys[2] = Secret(68); }),
            "a key of another length than its policy has");
  for (const double none :
       {0.0, -1.0, 99.0, 1e18, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(refusal([&](GivenKeys& given) { given.lifetime_ms = none; }),
              "a lifetime that is none: 100 ms to a year");
  EXPECT_EQ(refusal([](GivenKeys& given) { given.first_token = 5; }),
            "token 5 after token 7: keys that were used are not used again");
  EXPECT_EQ(keys.schedule(), before);
  EXPECT_EQ(*keys.source()->key(6), *service.keys.key(6));
  EXPECT_EQ(refusal([](GivenKeys& given) { given.first_token = 6; }), "") << "clocks differ a little";
}

// open62541 1.5.7 says a great negative number.
TEST(PulledKeys, AServiceThatDoesNotTellTheTime) {
  Service service;
  PulledKeys keys(MessagePolicy::aes128_ctr);
  for (const double none : {-11'644'480'000'000.0, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
    keys = PulledKeys(MessagePolicy::aes128_ctr);
    GivenKeys given = service.at(5250 * ms);
    given.time_to_next_ms = none;
    ASSERT_EQ(keys.take(given, 5250 * ms), "");
    EXPECT_EQ(keys.schedule().first_ns, 5250 * ms) << "as if it had begun now";
    given = service.at(5750 * ms);
    given.time_to_next_ms = none;
    ASSERT_EQ(keys.take(given, 5750 * ms), "");
    EXPECT_EQ(keys.schedule().first_ns, 5250 * ms) << "and not again";
    given = service.at(6100 * ms);
    given.time_to_next_ms = none;
    ASSERT_EQ(keys.take(given, 6100 * ms), "");
    EXPECT_EQ(keys.schedule(), (KeySchedule{6, 5100 * ms, 1000 * ms})) << "the next one is told earlier than expected";
  }
}

TEST(PulledKeys, AnotherKeyForATokenVoidsThoseBeforeIt) {
  const Service service;
  Service other;
  other.keys = DerivedKeys(MessagePolicy::aes128_ctr, "other", secret());
  PulledKeys keys(MessagePolicy::aes128_ctr);
  ASSERT_EQ(keys.take(service.at(5250 * ms), 5250 * ms), "");
  ASSERT_EQ(keys.take(other.at(6250 * ms), 6250 * ms), "");
  EXPECT_EQ(keys.schedule().first_token, 7u);
  EXPECT_EQ(*keys.source()->key(7), *other.keys.key(7));
}

/// A node that pulls, whose answers are late by up to `latency`.
struct Node {
  Node(std::uint16_t sender, std::int64_t latency)
      : windows(64),
        channel({MessageMode::sign_and_encrypt, Nonces::lives, sender, 1}, empty_ring(), ReplayMemory(windows)),
        latency_ns(latency) {}
  void pull(const Service& service, std::int64_t now) {
    if (now < next) return;
    ASSERT_EQ(keys.take(service.at(now - latency_ns), now), "");
    channel.keys().replace(keys.schedule(), keys.source());
    next = keys.next_pull_ns(now);
  }
  PulledKeys keys{MessagePolicy::aes128_ctr};
  std::vector<StoredWindow> windows;
  SecureChannel channel;
  std::int64_t latency_ns;
  std::int64_t next = 0;
};

// Twelve lifetimes, with answers of the service that are late by different times at each pull, so that what a node
// thinks of the change goes forth and back: no message is lost, tokens of a sender never go back, and no nonce is used
// twice.
TEST(PulledKeys, ChangesCostNothing) {
  const Service service;
  Node a(1, 0);
  Node b(2, 0);
  const auto clear = word();
  std::uint32_t last = 0;
  std::set<std::vector<std::byte>> nonces;
  std::size_t sent = 0;
  for (std::int64_t now = 3000 * ms; now < 15'000 * ms; now += 7 * ms) {
    a.latency_ns = (now / ms * 31) % 90 * ms;
    b.latency_ns = (now / ms * 17) % 90 * ms;
    a.pull(service, now);
    b.pull(service, now);
    const Octets sealed = a.channel.seal(clear, now);
    ASSERT_FALSE(sealed.empty()) << now;
    ++sent;
    nonces.insert({sealed.begin() + 15, sealed.begin() + 29});
    ASSERT_EQ(b.channel.open(sealed, now + 40 * ms).verdict, SecurityVerdict::good) << now;
    ASSERT_TRUE(last == 0 || a.channel.token() == last || a.channel.token() == last + 1) << now;
    last = a.channel.token();
  }
  EXPECT_EQ(last, 15u);
  EXPECT_EQ(nonces.size(), sent);
}

// A node with the file and a node that pulls agree.
TEST(PulledKeys, AreThoseOfTheFile) {
  const Service service;
  Node pulls(1, 20 * ms);
  std::vector<StoredWindow> windows(64);
  SecureChannel with_file({MessageMode::sign_and_encrypt, Nonces::lives, 2, 1},
                          {MessagePolicy::aes128_ctr, service.schedule, service.keys.clone()}, ReplayMemory(windows));
  const auto clear = word();
  for (std::int64_t now = 3000 * ms; now < 9000 * ms; now += 7 * ms) {
    pulls.pull(service, now);
    ASSERT_EQ(with_file.open(pulls.channel.seal(clear, now), now).verdict, SecurityVerdict::good) << now;
    ASSERT_EQ(pulls.channel.open(with_file.seal(clear, now), now).verdict, SecurityVerdict::good) << now;
  }
}

// Without the service a node goes on with what it has: here the current key, four behind it, and the last of them for
// two lifetimes more.
TEST(PulledKeys, BridgeAnOutage) {
  const Service service;
  Node node(1, 0);
  const auto clear = word();
  EXPECT_TRUE(node.channel.seal(clear, 5000 * ms).empty()) << "nothing is sent before there are keys";
  node.pull(service, 5500 * ms);
  for (std::int64_t now = 5500 * ms; now < 12'000 * ms; now += 100 * ms)
    ASSERT_FALSE(node.channel.seal(clear, now).empty()) << now;
  EXPECT_EQ(node.channel.token(), 10u);
  EXPECT_TRUE(node.channel.seal(clear, 12'000 * ms).empty());
  node.next = 0;
  node.pull(service, 12'500 * ms);
  EXPECT_FALSE(node.channel.seal(clear, 12'500 * ms).empty());
  EXPECT_EQ(node.channel.token(), 13u);
}

TEST(PulledKeys, KnowWhatTheyHaveNotHadBefore) {
  Service service;
  PulledKeys keys(MessagePolicy::aes128_ctr);
  ASSERT_EQ(keys.take(service.at(5250 * ms), 5250 * ms), "");
  EXPECT_TRUE(keys.has_news());
  ASSERT_EQ(keys.take(service.at(5750 * ms), 5750 * ms), "");
  EXPECT_FALSE(keys.has_news()) << "the same five";
  ASSERT_EQ(keys.take(service.at(6250 * ms), 6250 * ms), "");
  EXPECT_TRUE(keys.has_news()) << "one more behind them";
  Service other;
  other.keys = DerivedKeys(MessagePolicy::aes128_ctr, "other", secret());
  ASSERT_EQ(keys.take(other.at(6350 * ms), 6350 * ms), "");
  EXPECT_TRUE(keys.has_news()) << "others for the same tokens";
  ASSERT_EQ(keys.take(other.at(6450 * ms), 6450 * ms), "");
  EXPECT_FALSE(keys.has_news());
}

// Whoever sends with a later token than the current one has keys from somewhere.
TEST(KeyRing, KnowsWhichTokensAreMissing) {
  KeyRing ring(MessagePolicy::aes128_ctr, {3, 0, 100},
               std::make_unique<ListedKeys>(3, std::vector<Secret>(5, Secret(52))));
  EXPECT_EQ(ring.find(7, 250), nullptr)
      << "it is there, and its time has not come: the clock may be behind that of the service";
  EXPECT_TRUE(ring.is_missing(7, 250));
  EXPECT_TRUE(ring.is_missing(900, 250));
  for (const std::uint32_t token : {0U, 1U, 3U, 5U, 0x8000'0005U, 0xFFFF'FFFFU})
    EXPECT_FALSE(ring.is_missing(token, 250)) << token;
  EXPECT_TRUE(empty_ring().is_missing(1, 250)) << "nothing has come";
}

TEST(KeyRing, IsReplacedWithoutGoingBack) {
  std::vector<Secret> keys(5, Secret(52));
  KeyRing ring(MessagePolicy::aes128_ctr, {3, 0, 100}, std::make_unique<ListedKeys>(3, keys));
  EXPECT_EQ(ring.current(250)->token, 5u);
  ring.replace({3, 60, 100}, std::make_unique<ListedKeys>(3, keys));  // at 250 this is the time of token 4
  EXPECT_EQ(ring.current(250)->token, 5u);
  EXPECT_NE(ring.find(4, 250), nullptr);
  ring.replace({1, 250, 100}, std::make_unique<ListedKeys>(1, std::vector<Secret>(4, Secret(52))));
  EXPECT_FALSE(ring.current(250)) << "its last token is 4";
}

}  // namespace
}  // namespace takt::security::pulled_keys_test
