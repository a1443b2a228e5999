// SPDX-License-Identifier: Apache-2.0
// Topics whose messages are secured, on real nodes over loopback: what one says the other hears, strangers it does not,
// and open62541 as far as it is told to.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <thread>

#include "node/applications/describe_topics.hpp"
#include "node/applications/host.hpp"
#include "support/reservation.hpp"

namespace takt::node {
namespace {

namespace fs = std::filesystem;
const fs::path golden = fs::path(TAKT_SOURCE_DIR) / "tests/golden/security";

class SecuredTopics : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_);
    write_private("cell.keys", R"({"group": "cell", "secret": ")" + std::string(64, '5') + "\"}");
    write_private("cell256.keys",
                  R"({"group": "cell", "policy": "aes256-ctr", "secret": ")" + std::string(64, '5') + "\"}");
    write_private("other.keys", R"({"group": "cell", "secret": ")" + std::string(64, '6') + "\"}");
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write_private(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    ::chmod((folder_ / name).c_str(), 0600);
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// `a` publishes x, `b` subscribes to it. `security` of the file of this node, or "".
  std::unique_ptr<LoadedApplications> load(const std::string& node, const std::string& security,
                                           json::Diagnostics& diagnostics, const std::string& uadp = "{}") const {
    const int own = ports_.number() + (node == "a" ? 0 : 1);
    return load_applications_text(
        R"({"node": ")" + node +
            R"(", "topics": [{"name": "x", "protocol": "opc-ua", "fields": {"n": "UInt32", "v": {"type": "Double", "count": 4}}, "uadp": )" +
            uadp + R"(}],
      "applications": [{"name": "p", "on": "a", "threads": [{"name": "t", "publish": "x", "every": "2ms"}]}, {"name": "s", "on": "b", "threads": [{"name": "t", "subscribe": "x", "every": "2ms", "buffer": 1000}]}],
      "transport": {"kind": "udp", "interface": "lo", "port": )" +
            std::to_string(own) + R"(, "destinations": ["127.0.0.1:)" +
            std::to_string(ports_.number() + (node == "a" ? 1 : 0)) + "\"]}" +
            (security.empty() ? "" : R"(, "security": )" + security) + "}",
        "file", diagnostics);
  }
  std::string security(const std::string& node, const std::string& keys = "cell.keys",
                       const std::string& more = "") const {
    return R"({"keys": ")" + path(keys) + R"(", "memory": ")" + path(node + ".memory") + "\"" + more + "}";
  }

  struct Seen {
    ApplicationsReport publisher;
    ApplicationsReport subscriber;
    const ThreadStatistics& sent() const { return publisher.all.at(0).threads.at(0); }
    const ThreadStatistics& taken() const { return subscriber.all.at(0).threads.at(0); }
    std::uint64_t count(wire::Verdict verdict) const {
      std::uint64_t sum = 0;
      for (const HeardSource& each : subscriber.sources) sum += each.count(verdict);
      return sum;
    }
  };
  Seen run(const std::string& of_publisher, const std::string& of_subscriber, const std::string& uadp = "{}") const {
    json::Diagnostics diagnostics;
    const auto a = load("a", of_publisher, diagnostics, uadp);
    const auto b = load("b", of_subscriber, diagnostics, uadp);
    EXPECT_TRUE(a && b) << diagnostics.to_text();
    if (!a || !b) return {};
    std::string problem;
    std::string warnings;
    const auto publisher = ApplicationHost::make(*a, problem, warnings);
    const auto subscriber = ApplicationHost::make(*b, problem, warnings);
    EXPECT_TRUE(publisher && subscriber) << problem;
    if (!publisher || !subscriber) return {};
    std::atomic<bool> is_over = false;
    std::thread listening([&] {
      subscriber->run([](const void* flag) { return static_cast<const std::atomic<bool>*>(flag)->load(); }, &is_over);
    });
    std::atomic<int> asked = 0;
    publisher->run([](const void* count) { return ++*static_cast<std::atomic<int>*>(const_cast<void*>(count)) > 8; },
                   &asked);  // each time 50 ms later
    is_over = true;
    listening.join();
    return {publisher->report(), subscriber->report()};
  }

  fs::path folder_ = fs::temp_directory_path() / ("takt-secured-topics-" + std::to_string(::getpid()));
  testing::Reservation ports_ = testing::Reservation::ports();
};

TEST_F(SecuredTopics, AreHeardByWhoHasTheKeys) {
  // A Byte as PublisherId: such messages have no ExtendedFlags1 until they are secured.
  const std::string others = R"({"publisher": {"byte": 9}, "encoding": "RawData"})";
  for (const std::string& uadp : {std::string("{}"), others})
    for (const auto& [keys, more] : {std::pair{"cell.keys", ""}, std::pair{"cell.keys", R"(, "mode": "sign")"},
                                     std::pair{"cell256.keys", R"(, "policy": "aes256-ctr")"}}) {
      const std::string with_sender = std::string(more) + R"(, "sender": 5)";
      const Seen seen = run(security("a", keys, with_sender), security("b", keys, more), uadp);
      SCOPED_TRACE(more + uadp);
      EXPECT_GT(seen.sent().sent, 20u);
      EXPECT_EQ(seen.sent().not_sent, 0u);
      EXPECT_EQ(seen.taken().taken + seen.taken().lost, seen.sent().sent);
      EXPECT_GE(seen.taken().taken + 5, seen.sent().sent);
      EXPECT_EQ(seen.count(wire::Verdict::taken), seen.taken().taken);
      ASSERT_TRUE(seen.publisher.security && seen.subscriber.security);
      EXPECT_EQ(seen.publisher.security->group, "cell");
      EXPECT_NE(seen.publisher.security->token, 0u);
    }
}

TEST_F(SecuredTopics, StrangersAreNotHeardAndTheirNumberIsTold) {
  const auto refused = [](const Seen& seen, wire::Verdict verdict) {
    EXPECT_GT(seen.sent().sent, 20u);
    EXPECT_EQ(seen.taken().taken, 0u);
    EXPECT_GE(seen.count(verdict) + 5, seen.sent().sent);
    EXPECT_NE(to_text(seen.subscriber).find(std::string("refused of 127.0.0.1:")), std::string::npos)
        << to_text(seen.subscriber);
    EXPECT_NE(to_json(seen.subscriber).find("\"verdict\": \"" + std::string(wire::name_of(verdict)) + "\""),
              std::string::npos)
        << to_json(seen.subscriber);
  };
  refused(run("", security("b")), wire::Verdict::unsecured);
  refused(run(security("a", "other.keys"), security("b")), wire::Verdict::signature);
  refused(run(security("a", "cell.keys", R"(, "mode": "sign")"), security("b")), wire::Verdict::security_mode);
  refused(run(security("a"), ""), wire::Verdict::secured);
}

TEST_F(SecuredTopics, WhoIsRestartedIsHeardAtOnce) {
  for (int life = 0; life < 3; ++life) {
    const Seen seen = run(security("a"), security("b"));
    EXPECT_GE(seen.taken().taken + 5, seen.sent().sent) << life;
    EXPECT_EQ(seen.count(wire::Verdict::replayed), 0u);
  }
}

TEST_F(SecuredTopics, WhatIsRefusedInAFile) {
  const auto said = [&](const std::string& node, const std::string& security, const std::string& uadp = "{}") {
    json::Diagnostics diagnostics;
    const auto loaded = load(node, security, diagnostics, uadp);
    EXPECT_EQ(loaded == nullptr, diagnostics.has_errors());
    std::string all;
    for (const auto& each : diagnostics.sorted()) all += each.place.pointer + ": " + each.message;
    return all;
  };
  EXPECT_EQ(said("a", security("a")), "");
  const std::string byte = R"({"publisher": {"byte": 9}})";
  EXPECT_EQ(said("a", security("a"), byte), "/security: nonces without a number of this node");
  EXPECT_EQ(said("b", security("b"), R"({"configured_size": 1380})"), "");
  EXPECT_EQ(said("b", security("b"), R"({"configured_size": 1400, "data_set_message": []})").find("a sample too long"),
            std::string::npos)
      << "1400 + 46 + 1 and a short header fit";
  EXPECT_NE(said("a", security("a", "cell.keys", R"(, "policy": "aes256-ctr")")).find("keys of another policy"),
            std::string::npos);
  EXPECT_NE(said("a", security("a", "cell.keys", R"(, "sender": 0)")).find("/security/sender"), std::string::npos);
  EXPECT_NE(said("a", security("a", "cell.keys", R"(, "nonces": "any")")).find("/security/nonces"), std::string::npos);
  json::Diagnostics diagnostics;
  const auto loaded = load("a", security("a"), diagnostics);
  EXPECT_EQ(description_of(*loaded).security, "sign-and-encrypt");
}

/// What open62541 1.5.7 sent, to a node that has its keys: how many of the messages are taken when all are sent twice,
/// and how many come again.
class OfOpen62541 : public SecuredTopics {
 protected:
  struct Heard {
    std::uint64_t messages = 0;
    std::uint64_t taken = 0;
    std::uint64_t replayed = 0;
  };
  Heard hear(const std::string& capture, const std::string& nonces) {
    json::Diagnostics diagnostics;
    const auto document = json::parse_file((golden / (capture + ".json")).string(), diagnostics);
    EXPECT_TRUE(document) << diagnostics.to_text();
    const json::Node& root = document->root();
    const json::Node& key = root.find("securityGroup")->find("keys")->items.at(0);
    write_private("stock.keys", R"({"group": "g", "keys": [")" + key.find("keyData")->text + R"("], "first_token": )" +
                                    key.find("securityTokenId")->text + R"(, "first_at": )" +
                                    std::to_string(std::time(nullptr) - 60) + "}");
    fs::remove(path("b.memory"));
    const auto loaded = load_applications_text(
        R"({"node": "b", "topics": [{"name": "x", "protocol": "opc-ua", "publisher_id": 2234, "fields": {"n": "Int32", "a": "Double", "b": "Double", "c": "Double", "d": "Double", "e": "Double"},
        "uadp": {"writer_group_id": 100, "network_message": ["PublisherId", "GroupHeader", "WriterGroupId", "SequenceNumber", "PayloadHeader"], "data_set_message": []}}],
      "applications": [{"name": "s", "on": "b", "threads": [{"name": "t", "subscribe": "x", "every": "2ms", "buffer": 1000}]}],
      "transport": {"kind": "udp", "interface": "lo", "port": )" +
            std::to_string(ports_.number()) + R"(, "destinations": ["127.0.0.1:9"]}, "security": )" +
            security("b", "stock.keys", R"(, "nonces": ")" + nonces + "\"") + "}",
        "file", diagnostics);
    EXPECT_TRUE(loaded) << diagnostics.to_text();
    std::string problem;
    std::string warnings;
    const auto host = ApplicationHost::make(*loaded, problem, warnings);
    EXPECT_TRUE(host) << problem;
    Heard heard;
    send_twice(*root.find("messages"), heard);  // they wait in the socket
    std::atomic<int> asked = 0;
    host->run([](const void* count) { return ++*static_cast<std::atomic<int>*>(const_cast<void*>(count)) > 3; },
              &asked);
    const ApplicationsReport report = host->report();
    heard.taken = report.all.at(0).threads.at(0).taken;
    for (const HeardSource& each : report.sources) heard.replayed += each.count(wire::Verdict::replayed);
    return heard;
  }

 private:
  void send_twice(const json::Node& messages, Heard& heard) const {
    const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
    sockaddr_in to = {};
    to.sin_family = AF_INET;
    to.sin_port = htons(ports_.number());
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    for (int i = 0; i < 2; ++i)
      for (const json::Node& each : messages.items) {
        const std::string& hex = each.find("hex")->text;
        std::vector<unsigned char> octets;
        for (std::size_t at = 0; at < hex.size(); at += 2)
          octets.push_back(static_cast<unsigned char>(std::stoul(hex.substr(at, 2), nullptr, 16)));
        ::sendto(socket, octets.data(), octets.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
        heard.messages += 1;
      }
    ::close(socket);
  }
};

// Of s02 the application that used it set the number of each nonce, as the standard asks; of s11 it is as it comes:
// always 1.
TEST_F(OfOpen62541, IsHeardAsItsNoncesAreToldToBe) {
  const Heard counted = hear("s02_encrypt_aes128", "counted");
  EXPECT_EQ(counted.messages, 16u);
  EXPECT_EQ(counted.taken, 8u);
  EXPECT_EQ(counted.replayed, 8u);
  const Heard stock = hear("s11_stock_nonce", "counted");
  EXPECT_EQ(stock.taken, 1u);
  EXPECT_EQ(stock.replayed, 15u);
  const Heard lenient = hear("s11_stock_nonce", "lenient");
  EXPECT_EQ(lenient.taken, 8u);
  EXPECT_EQ(lenient.replayed, 8u) << "the same nonce is a replay all the same";
}

}  // namespace
}  // namespace takt::node
