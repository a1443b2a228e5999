// SPDX-License-Identifier: Apache-2.0
// A file with applications: what it means, and all that can be wrong with it.
#include "node/applications/config.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "node/dds/participant.hpp"

namespace takt::node {
namespace {

class ApplicationsFile : public ::testing::Test {
 protected:
  ApplicationsFile()
      : path_(std::filesystem::temp_directory_path() / ("takt-applications-" + std::to_string(::getpid()) + ".json")) {}
  ~ApplicationsFile() override { std::filesystem::remove(path_); }

  std::unique_ptr<LoadedApplications> load(const std::string& text) {
    std::ofstream(path_) << text;
    said_.clear();
    json::Diagnostics diagnostics;
    auto loaded = load_applications(path_.string(), diagnostics);
    for (const auto& each : diagnostics.sorted()) said_.push_back(each.place.pointer + ": " + each.message);
    return loaded;
  }
  bool is_one(const std::string& text) {
    std::ofstream(path_) << text;
    return is_applications_file(path_.string());
  }

  std::filesystem::path path_;
  std::vector<std::string> said_;
};

using Lines = std::vector<std::string>;

TEST_F(ApplicationsFile, IsToldFromThatOfAProgram) {
  EXPECT_TRUE(is_one(R"({"node": "a", "topics": []})"));
  EXPECT_FALSE(is_one(R"({"node": "a", "program": {}, "topics": []})"));
  EXPECT_FALSE(is_one(R"({"node": "a"})"));
  EXPECT_FALSE(is_one("nonsense"));
}

TEST_F(ApplicationsFile, OnlyWhatIsOnThisNodeIsKept) {
  const auto loaded = load(R"({
    "node": "a",
    "topics": [{"name": "x", "protocol": "opc-ua", "fields": {"n": "UInt32", "v": {"type": "Double", "count": 2}}},
               {"name": "y", "protocol": "opc-ua", "publisher_id": 9, "fields": {"n": "UInt32"}}],
    "applications": [{"name": "here", "on": "a", "threads": [{"name": "p", "publish": "x", "every": "5ms", "offset": "1ms"}]},
                     {"name": "there", "on": "b", "threads": [{"name": "p", "publish": "y", "every": "5ms"}]}],
    "transport": {"kind": "udp", "destinations": ["239.0.0.1"]}})");
  ASSERT_TRUE(loaded) << said_.size();
  ASSERT_EQ(loaded->config.applications.size(), 1u);
  EXPECT_EQ(loaded->config.applications[0].name, "here");
  EXPECT_EQ(loaded->topics[0].publisher_id, 1);
  EXPECT_EQ(loaded->topics[1].publisher_id, 9);
  EXPECT_EQ(loaded->topics[0].shape.fields[1].type, (uadp::RawField{uadp::BuiltInType::Double, true, 2, 0}));
  EXPECT_EQ(text_of(loaded->topics[0].shape.type.members[1]), "double[2]");
  EXPECT_EQ(loaded->topics[0].shape.type.name, "x");
}

TEST_F(ApplicationsFile, AllMistakesAreNamedAtOnce) {
  EXPECT_FALSE(load(R"({
    "node": "a",
    "topics": [{"name": "x", "protocol": "opc-ua", "fields": {"n": "UInt32"}, "domain": 3},
               {"name": "x", "protocol": "opc-ua", "publisher_id": 1, "fields": {"n": "UInt32"}},
               {"name": "z", "protocol": "opc-ua", "fields": {"n": "Double"}}],
    "applications": [{"name": "one", "on": "a", "threads": [{"name": "p", "publish": "x", "every": "5ms", "offset": "5ms"},
                                                {"name": "p", "publish": "x", "every": "5ms", "payload": {"copy_of": "z"}},
                                                {"name": "s", "subscribe": "nothing", "every": "5ms", "payload": "counter"}]}],
    "gateways": [{"name": "one", "on": "a", "from": "x", "to": "z", "receive_every": "1ms", "send_every": "1ms", "send_offset": "2ms"}]})"));
  EXPECT_EQ(said_, (Lines{"/node: no transport", "/topics/0/domain: not of OPC UA", "/topics/1/name: duplicate name",
                          "/topics/1/publisher_id: a PublisherId twice",
                          "/applications/0/threads/0/offset: an offset beyond the interval",
                          "/applications/0/threads/1/name: duplicate name",
                          "/applications/0/threads/1/publish: published twice",
                          "/applications/0/threads/1/payload/copy_of: not subscribed to",
                          "/applications/0/threads/1/payload/copy_of: other fields",
                          "/applications/0/threads/2/subscribe: no such topic",
                          "/applications/0/threads/2/payload: nothing is published", "/gateways/0/name: duplicate name",
                          "/gateways/0/to: no gateway", "/gateways/0/send_offset: an offset beyond the interval"}));
}

TEST_F(ApplicationsFile, AGatewayNeedsTypesThatMap) {
  if (!has_dds()) GTEST_SKIP() << "this build has no DDS";
  const auto with = [](const std::string& members) {
    return R"({"node": "a", "transport": {"kind": "udp", "destinations": ["239.0.0.1"]},
               "topics": [{"name": "x", "protocol": "opc-ua", "fields": {"n": "UInt32", "v": "Double"}}, {"name": "y", "protocol": "dds", "type": "A::B", "domain": 4, "fields": {)" +
           members +
           R"(}}], "gateways": [{"name": "g", "on": "a", "from": "x", "to": "y", "receive_every": "1ms", "send_every": "1ms"}]})";
  };
  const auto loaded = load(with(R"("v": "Double", "n": "UInt32")"));
  ASSERT_TRUE(loaded) << said_.front();
  EXPECT_EQ(loaded->topics[1].shape.type.name, "A::B");
  EXPECT_EQ(loaded->topics[1].domain, 4);
  EXPECT_TRUE(load(with(R"("n": "UInt32")"))) << "what is more is left out";
  EXPECT_FALSE(load(with(R"("n": "UInt32", "other": "Double")")));
  EXPECT_EQ(said_, Lines{"/gateways/0/to: types do not map"});
  EXPECT_FALSE(load(with(R"("n": "Int32", "v": "Float")")));
  EXPECT_EQ(said_, (Lines{"/gateways/0/to: types do not map", "/gateways/0/to: types do not map"}));
}

TEST_F(ApplicationsFile, NamesAndPoliciesThatDdsRefuses) {
  EXPECT_FALSE(load(
      R"({"node": "a", "topics": [{"name": "dds-topic", "protocol": "dds", "fields": {"n": "UInt32"}, "qos": {"durability": "persistent"}},
                                              {"name": "x", "protocol": "opc-ua", "fields": {"n": "UInt32"}}],
                        "applications": [{"name": "one", "on": "a", "threads": [{"name": "p", "publish": "x", "every": "5ms", "qos": {"depth": 3}}]}],
                        "transport": {"kind": "udp", "destinations": ["239.0.0.1"]}})"));
  EXPECT_EQ(said_, (Lines{"/topics/0/name: not a topic name of DDS", "/topics/0/qos/durability: not on a real node",
                          "/applications/0/threads/0/qos: not of OPC UA"}));
}

TEST_F(ApplicationsFile, TakesThePlantOfAScenarioButWhatOnlyASimulatorDoes) {
  const auto file = [](const std::string& topic, const std::string& thread) {
    return R"({"node": "a", "transport": {"kind": "udp", "destinations": ["239.0.0.1"]},
               "topics": [{"name": "x", "protocol": "opc-ua", "fields": {"n": "UInt32"}, "pcp": 5, "vlan": 3)" +
           topic + R"(}],
               "applications": [{"name": "one", "on": "a", "threads": [{"name": "s", "subscribe": "x", "every": "5ms", "response": {"uniform": {"from": "1us", "to": "9us"}})" +
           thread + "}]}]}";
  };
  EXPECT_TRUE(load(file("", "")));
  EXPECT_FALSE(load(file(R"(, "publication": "asynchronous")", "")));
  EXPECT_EQ(said_, Lines{"/topics/0/publication: not of OPC UA"});
}

TEST_F(ApplicationsFile, ResponsesAndSignalsAreThoseOfAScenario) {
  const auto file = [](const std::string& response, const std::string& more) {
    return R"({"node": "a", "transport": {"kind": "udp", "destinations": ["239.0.0.1"]}, "seed": 7, "topics": [{"name": "x", "protocol": "opc-ua", "fields": {"n": "UInt32"}}],
               "applications": [{"name": "one", "on": "a", "scheduler": {"response": "20us"}, "threads": [{"name": "s", "subscribe": "x", "every": "5ms", "response": )" +
           response + R"(, "signal": "valve"})" + more + "]}]}";
  };
  const auto loaded = load(file(R"({"uniform": {"from": "1us", "to": "9us"}})", ""));
  ASSERT_TRUE(loaded) << said_.front();
  EXPECT_EQ(loaded->config.seed, 7u);
  EXPECT_EQ(loaded->responses.at({"one", "s"}).least(), sim::Duration::from_ps(1'000'000));
  EXPECT_EQ(loaded->responses.at({"one", "s"}).greatest(), sim::Duration::from_ps(9'000'000));
  EXPECT_EQ(loaded->scheduler_responses.at("one").greatest(), sim::Duration::from_ps(20'000'000));
  EXPECT_FALSE(load(file(R"({"uniform": {"from": "9us", "to": "1us"}})", "")));
  EXPECT_EQ(said_, Lines{"/applications/0/threads/0/response/uniform: an empty interval"});
  EXPECT_FALSE(load(file(
      R"("1us")",
      R"(, {"name": "p", "publish": "x", "every": "5ms", "signal": "lamp"}, {"name": "t", "subscribe": "x", "every": "5ms", "signal": "valve"})")));
  EXPECT_EQ(said_, (Lines{"/applications/0/threads/1/signal: nothing is taken",
                          "/applications/0/threads/2/signal: duplicate name"}));
}

TEST_F(ApplicationsFile, WithoutDdsItIsRefusedByName) {
  if (has_dds()) GTEST_SKIP() << "this build has DDS";
  EXPECT_FALSE(load(R"({"node": "a", "topics": [{"name": "y", "protocol": "dds", "fields": {"n": "UInt32"}}],
                        "applications": [{"name": "one", "on": "a", "threads": [{"name": "p", "publish": "y", "every": "5ms"}]}]})"));
  EXPECT_EQ(said_, Lines{"/applications/0/threads/0/publish: DDS is not in this build"});
  EXPECT_NE(std::string(dds_needed).find("cyclonedds-dev"), std::string::npos);
}

}  // namespace
}  // namespace takt::node
