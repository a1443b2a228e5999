// SPDX-License-Identifier: Apache-2.0
// Plug and produce in the simulator and by files of nodes, over a network without sockets: every station sends the same
// octets in the same order, from the first announcement to a replaced node. Only how often a message is repeated, and
// so its sequence number, may differ.
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <queue>

#include "models/network.hpp"
#include "node/config.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"
#include "sim/trace.hpp"
#include "uadp/octets.hpp"
#include "wire/program_node.hpp"

namespace takt::node::same_octets_roles_test {
namespace {

using namespace sim::literals;

const std::string shared =
    R"("name": "p", "master": "m", "cycle": "1ms", "publish": "on-change", "announce_every": "5ms", "on_replacement": "restart", "initialisation": "2ms",
 "roles": [{"name": "left", "skill": "welding"}, {"name": "hand", "skill": "gripping"}],
 "process_data": [{"name": "targets", "from": "m", "fields": {"x": {"type": "Double", "count": 2}}}, {"name": "seam", "from": "left", "fields": {"y": "Float"}}])";

/// What each stream (PublisherId, WriterGroupId) says, one thing after the other: repetitions and sequence numbers left
/// out.
class Said {
 public:
  void add(uadp::Octets octets) {
    const std::pair stream{uadp::load_little_endian<std::uint16_t>(octets.data() + 2),
                           uadp::load_little_endian<std::uint16_t>(octets.data() + 5)};
    const auto number = uadp::load_little_endian<std::uint16_t>(octets.data() + 13);
    const auto [last, is_first] = last_.emplace(stream, number);
    // A frame is seen at each port that it leaves; another node that has the role counts from 0.
    const auto ahead = static_cast<std::int16_t>(number - last->second);
    if (!is_first && ahead <= 0 && ahead > -8) return;
    last->second = number;
    std::vector<std::byte> message(octets.begin(), octets.end());
    for (const std::size_t at : {13u, 14u, 16u, 17u}) message[at] = std::byte{0};
    std::vector<std::vector<std::byte>>& all = streams[stream];
    if (all.empty() || all.back() != message) all.push_back(std::move(message));
  }
  std::map<std::pair<std::uint16_t, std::uint16_t>, std::vector<std::vector<std::byte>>> streams;

 private:
  std::map<std::pair<std::uint16_t, std::uint16_t>, std::uint16_t> last_;
};

/// Frames of a simulated run.
class Tap final : public sim::TraceSink {
 public:
  Tap(const models::Network& network, Said& said) : network_(network), said_(said) {}
  void record(const sim::TraceRecord& record) override {
    if (record.kind != static_cast<std::uint32_t>(models::Occurrence::started)) return;
    const models::Frame& frame = network_.traffic().frame(models::FrameIndex{static_cast<std::uint32_t>(record.what)});
    if (!frame.payload.is_none()) said_.add(network_.traffic().payload(frame.payload).view());
  }

 private:
  const models::Network& network_;
  Said& said_;
};

Said simulated() {
  const std::string text =
      R"({"name": "s", "duration": "200ms", "network": {"nodes": {"m": {"kind": "host"}, "a": {"kind": "host", "offers": ["welding"]},
 "b": {"kind": "host", "offers": ["welding"]}, "c": {"kind": "host", "offers": ["gripping"]}, "w": {"kind": "switch"}},
 "links": [{"ends": ["m", "w"]}, {"ends": ["a", "w"]}, {"ends": ["b", "w"]}, {"ends": ["c", "w"]}]}, "programs": [{)" +
      shared + R"(, "absent": ["b"]}],
 "script": [{"at": "20.3ms", "join": "b"}, {"at": "50.3ms", "program": "p", "call": "Start"}, {"at": "100.3ms", "leave": "a"}, {"at": "150.3ms", "program": "p", "call": "Suspend"}]})";
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(text, "s.json", {}, diagnostics);
  EXPECT_TRUE(resolved) << diagnostics.to_text();
  scenario::Run run(*resolved);
  Said said;
  Tap tap(run.network(), said);
  run.simulation().set_trace(&tap);
  run.advance();
  return said;
}

/// Members of a group over a network that delivers to all, 20 us later.
class Bench {
 public:
  explicit Bench(Said& said) : said_(said) {
    for (const char* const name : {"m", "a", "b", "c"}) stations_.push_back(std::make_unique<Station>(*this, name));
    for (const auto& each : stations_) each->carry_out(each->member->start(now_));
  }

  void at(sim::Duration time, std::function<void()> what) {
    events_.push({sim::LocalTime() + time, count_++, std::move(what)});
  }
  void call(program::Method method) {
    wire::NodeOutputs& outputs = stations_[0]->member->call(now_, method);
    EXPECT_EQ(outputs.status, program::StatusCode::Good);
    stations_[0]->carry_out(outputs);
  }
  void change(std::size_t station, Membership what) {
    wire::ProgramNode& candidate = *stations_[station]->member;
    stations_[station]->carry_out(what == Membership::join ? candidate.join(now_) : candidate.leave(now_));
  }
  void run(sim::Duration until) {
    while (!events_.empty() && events_.top().time <= sim::LocalTime() + until) {
      const Event event = events_.top();
      events_.pop();
      now_ = event.time;
      event.what();
    }
  }
  /// Messages that somebody took for those of another Program.
  std::uint64_t foreign() const {
    std::uint64_t sum = 0;
    for (const auto& each : stations_)
      if (each->member->endpoint() != nullptr) sum += each->member->endpoint()->counts().foreign;
    return sum;
  }
  std::vector<std::string> bound;

 private:
  struct Event {
    sim::LocalTime time;
    std::uint64_t number = 0;
    std::function<void()> what;
    bool operator<(const Event& other) const { return std::pair(time, number) > std::pair(other.time, other.number); }
  };
  struct Station {
    Station(Bench& bench_of, const std::string& name) : bench(bench_of) {
      const std::map<std::string, std::string> offers = {{"m", ""},
                                                         {"a", R"(, "offers": ["welding"])"},
                                                         {"b", R"(, "offers": ["welding"], "absent": true)"},
                                                         {"c", R"(, "offers": ["gripping"])"}};
      const std::string path = std::string(::testing::TempDir()) + "takt-node-same-roles.json";
      std::ofstream(path) << R"({"node": ")" << name
                          << R"(", "transport": {"kind": "ethernet", "interface": "eth0"}, "program": {)" << shared
                          << R"(, "candidates": ["a", "b", "c"]})" << offers.at(name) << "}";
      json::Diagnostics diagnostics;
      loaded = load_config(path, diagnostics);
      std::filesystem::remove(path);
      if (!loaded) throw std::runtime_error(diagnostics.to_text());
      wire::NodeSettings settings = loaded->programs[0];
      settings.set_incarnation(name == "m" ? 1 : 0);  // a candidate's life is one more
      member = std::make_unique<wire::ProgramNode>(settings);
      alarms.resize(member->alarm_count());
    }
    void carry_out(wire::NodeOutputs& outputs) {
      while (const auto* const output = outputs.next())
        std::visit([this](const auto& what) { act(what); }, output->what);
    }
    void act(const wire::SetAlarm& set) {
      const std::uint64_t setting = ++alarms[set.alarm];
      bench.at(set.time.since_start(), [this, alarm = set.alarm, setting] {
        if (alarms[alarm] == setting) carry_out(member->wake(bench.now_, alarm));
      });
    }
    void act(const wire::Publish& message) {
      bench.said_.add(message.octets);
      for (const auto& other : bench.stations_) {
        if (other.get() == this) continue;
        bench.at(bench.now_.since_start() + 20_us,
                 [to = other.get(), copy = std::vector<std::byte>(message.octets.begin(), message.octets.end())] {
                   to->carry_out(to->member->receive(to->bench.now_, copy));
                 });
      }
    }
    void act(const wire::RoleBound& bound) {
      bench.bound.push_back(std::to_string(bound.role) +
                            (bound.binding.bound() ? std::string(1, "abc"[bound.binding.candidate]) : "-"));
    }
    void act(const auto&) {}

    Bench& bench;
    std::unique_ptr<LoadedConfig> loaded;
    std::unique_ptr<wire::ProgramNode> member;
    std::vector<std::uint64_t> alarms;  ///< which setting of each is the valid one
  };

  Said& said_;
  sim::LocalTime now_;
  std::uint64_t count_ = 0;
  std::priority_queue<Event> events_;
  std::vector<std::unique_ptr<Station>> stations_;
};

TEST(SameOctets, OfMastersAndCandidates) {
  Said there = simulated();
  Said here;
  Bench bench(here);
  bench.at(20_ms + 300_us, [&] { bench.change(2, Membership::join); });
  bench.at(50_ms + 300_us, [&] { bench.call(program::Method::Start); });
  bench.at(100_ms + 300_us, [&] { bench.change(1, Membership::leave); });
  bench.at(150_ms + 300_us, [&] { bench.call(program::Method::Suspend); });
  bench.run(200_ms);
  EXPECT_EQ(bench.bound, (std::vector<std::string>{"0a", "1c", "0b"}));
  EXPECT_EQ(bench.foreign(), 0u);  // though all hear all: announcements and tables that are for others
  // The master's state, table and data; the announcements of a, b and c; both roles' states, and data of the left one.
  ASSERT_EQ(here.streams.size(), 9u);
  ASSERT_EQ(there.streams.size(), here.streams.size());
  for (const auto& [stream, messages] : here.streams) {
    const auto& simulated_messages = there.streams[stream];
    EXPECT_EQ(messages.size(), simulated_messages.size()) << stream.first << "/" << stream.second;
    for (std::size_t i = 0; i < std::min(messages.size(), simulated_messages.size()); ++i)
      EXPECT_EQ(messages[i], simulated_messages[i]) << stream.first << "/" << stream.second << " message " << i;
  }
}

}  // namespace
}  // namespace takt::node::same_octets_roles_test
