// SPDX-License-Identifier: Apache-2.0
// The nodes of a group on a network without sockets and clocks, and a stranger in it: what it hears it may say again
// with other contents.
#pragma once

#include <unistd.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <queue>
#include <stdexcept>
#include <string>
#include <vector>

#include "node/config.hpp"
#include "node/node_status.hpp"
#include "node/statistics.hpp"
#include "node/transition_log.hpp"
#include "security/secure_channel.hpp"
#include "uadp/octets.hpp"
#include "wire/nesting.hpp"
#include "wire/program_node.hpp"

namespace takt::test {

/// What the nodes of a group are configured with.
struct WordBenchGroup {
  std::string programs;                                    ///< as in a node's file, one or several
  std::vector<std::pair<std::string, std::string>> nodes;  ///< names, and more members of their files
  std::string security = {};  ///< members of their "security", whose keys change every 40 ms
};

inline const WordBenchGroup& word_bench_group(const std::string& kind) {
  static const std::string data =
      R"(, "process_data": [{"name": "targets", "from": "plc", "fields": {"x": "Double"}}, {"name": "actual", "from": "left", "fields": {"y": "Int16"}}])";
  static const std::string one =
      R"({"name": "cell", "master": "plc", "slaves": ["left", "right"], "cycle": "1ms", "initialisation": "2ms")" +
      data;
  static const std::vector<std::pair<std::string, std::string>> three = {{"plc", ""}, {"left", ""}, {"right", ""}};
  static const std::map<std::string, WordBenchGroup> groups = {
      {"robust", {one + "}", three}},
      {"paper", {one + R"(, "variant": "paper"})", three}},
      {"all-to-all", {one + R"(, "subscription": "all-to-all", "publish": "on-change"})", three}},
      {"two",
       {R"({"name": "cell", "master": "plc", "slaves": ["left"], "cycle": "1ms"})", {{"plc", ""}, {"left", ""}}}},
      {"nested",
       {one + R"(}, {"name": "axes", "within": "cell", "master": "right", "slaves": ["x", "y"], "cycle": "1ms"})",
        {{"plc", ""}, {"left", ""}, {"right", ""}, {"x", ""}, {"y", ""}}}},
      {"roles",
       {R"({"name": "cell", "master": "plc", "cycle": "1ms", "announce_every": "5ms", "candidates": ["a", "b", "c"], "roles": [{"name": "left", "skill": "welding"}, {"name": "hand", "skill": "gripping"}]})",
        {{"plc", ""},
         {"a", R"(, "offers": ["welding"])"},
         {"b", R"(, "offers": ["welding"])"},
         {"c", R"(, "offers": ["gripping"])"}}}},
      {"secured", {one + "}", three, R"("mode": "sign-and-encrypt")"}},
      {"signed", {one + "}", three, R"("mode": "sign", "policy": "aes256-ctr")"}},
      {"roles-restart",
       {R"({"name": "cell", "master": "plc", "cycle": "1ms", "announce_every": "5ms", "on_replacement": "restart", "candidates": ["a", "b", "c"], "roles": [{"name": "left", "skill": "welding"}, {"name": "hand", "skill": "gripping"}]})",
        {{"plc", ""},
         {"a", R"(, "offers": ["welding"])"},
         {"b", R"(, "offers": ["welding"])"},
         {"c", R"(, "offers": ["gripping"])"}}}},
      {"nested-roles",
       {R"({"name": "line", "master": "plc", "slaves": ["left", "right"], "cycle": "1ms"},
           {"name": "cell", "within": "line", "master": "right", "cycle": "1ms", "announce_every": "5ms", "candidates": ["a", "b"], "roles": [{"name": "tool", "skill": "welding"}]})",
        {{"plc", ""},
         {"left", ""},
         {"right", ""},
         {"a", R"(, "offers": ["welding"])"},
         {"b", R"(, "offers": ["welding"])"}}}}};
  return groups.at(kind);
}

class WordBench {
 public:
  explicit WordBench(const std::string& kind) {
    static std::map<std::string, std::vector<std::shared_ptr<node::LoadedConfig>>> loaded;  // files are read once
    auto& configs = loaded[kind];
    const WordBenchGroup& group = word_bench_group(kind);
    for (std::size_t i = configs.size(); i < group.nodes.size(); ++i) configs.push_back(load(group, i));
    for (const auto& each : configs) nodes_.push_back(std::make_unique<Node>(*this, *each, nodes_.size()));
    for (const auto& node : nodes_)
      for (const auto& seat : node->seats) {
        if (node->loaded.config.security) seat->open_channel(1);
        seat->carry_out(seat->member.start(now_));
      }
  }

  std::size_t size() const { return nodes_.size(); }
  /// What became of messages of a secured group.
  std::uint64_t opened(security::SecurityVerdict verdict) const {
    const auto found = opened_.find(verdict);
    return found == opened_.end() ? 0 : found->second;
  }
  /// From now on everything that is said is written down, too.
  void record(std::vector<std::vector<std::byte>>& all) { record_ = &all; }
  /// A node of a secured group is killed and started again: it knows what its memory holds.
  void restart(std::size_t node, std::uint16_t life) {
    Seat& seat = *nodes_[node]->seats[0];
    for (std::uint64_t& alarm : seat.alarms) ++alarm;
    seat.member.crash();
    seat.open_channel(life);
    seat.carry_out(seat.member.start(now_));
  }
  /// The programs in which a node is.
  std::size_t seats(std::size_t node) const { return nodes_[node]->seats.size(); }
  wire::ProgramNode& member(std::size_t node, std::size_t seat = 0) { return nodes_[node]->seats[seat]->member; }
  program::StatusCode call(std::size_t node, program::Method method, std::size_t seat = 0) {
    wire::NodeOutputs& outputs = member(node, seat).call(now_, method);
    nodes_[node]->seats[seat]->carry_out(outputs);
    return outputs.status;
  }
  void finished(std::size_t node, std::size_t seat = 0) {
    nodes_[node]->seats[seat]->carry_out(member(node, seat).finished(now_));
  }
  void change(std::size_t node, node::Membership what) {
    if (member(node).candidate() != nullptr)
      nodes_[node]->seats[0]->carry_out(what == node::Membership::join ? member(node).join(now_)
                                                                       : member(node).leave(now_));
  }

  void run(sim::Duration duration) {
    const sim::LocalTime end = now_ + duration;
    while (!events_.empty() && events_.top().time <= end) {
      const Event event = events_.top();
      events_.pop();
      now_ = event.time;
      event.what();
    }
    now_ = end;
  }

  /// What was said last in each stream, in the order of PublisherId and WriterGroupId.
  std::vector<std::vector<std::byte>> heard() const {
    std::vector<std::vector<std::byte>> all;
    for (const auto& [stream, octets] : streams_) all.push_back(octets);
    return all;
  }
  /// The last message of a state, with this sequence number and these fields. Octets as text: "0b00".
  std::vector<std::byte> state_of(std::size_t participant, std::uint16_t ahead, const std::string& fields,
                                  std::size_t program = 0) const {
    const auto& format = *nodes_[0]->loaded.programs[program].endpoint.format;
    const auto found = streams_.find(
        {static_cast<std::uint16_t>(format.shape().first_publisher_id + participant), wire::state_writer_group});
    if (found == streams_.end()) throw std::runtime_error("nothing was said yet");
    std::vector<std::byte> octets = forged(found->second, ahead);
    for (std::size_t i = 0; 2 * i < fields.size(); ++i)
      octets.at(wire::fields_at + i) = static_cast<std::byte>(std::stoi(fields.substr(2 * i, 2), nullptr, 16));
    return octets;
  }
  /// The same message with later sequence numbers.
  static std::vector<std::byte> forged(std::vector<std::byte> message, std::uint16_t ahead) {
    for (const std::size_t at : {std::size_t{13}, std::size_t{16}}) {
      std::uint16_t number = 0;
      std::memcpy(&number, message.data() + at, 2);
      number = static_cast<std::uint16_t>(number + ahead);
      std::memcpy(message.data() + at, &number, 2);
    }
    return message;
  }
  /// All nodes hear it now.
  void say(const std::vector<std::byte>& octets) {
    for (const auto& node : nodes_)
      for (const auto& seat : node->seats) {
        const std::vector<std::byte> exact(octets);  // of its own: sanitizers see what is read behind it
        seat->hear(exact);
      }
  }

  /// What `takt ctl status` prints of each node, as JSON and as text, and the last line of its log.
  std::string ask() {
    std::string all;
    for (const auto& each : nodes_) {
      node::NodeStatus status{each->loaded.config.node, {}, now_.since_start().ps() / 1000};
      for (const auto& seat : each->seats)
        status.programs.push_back({&seat->of.program, &seat->member, &seat->cycles, &seat->peers, now_, 0});
      const std::string json = node::to_json(status);
      all += json + "\n" + node::status_text(json);
      node::TransitionLog(log_).ended(status);
    }
    return all;
  }
  bool all_in(handshake::PublishedState state) const {
    for (const auto& node : nodes_)
      for (const auto& seat : node->seats)
        if (!(seat->member.candidate() != nullptr && seat->member.endpoint() == nullptr) &&
            seat->member.state() != state)
          return false;
    return true;
  }

 private:
  struct Event {
    sim::LocalTime time;
    std::uint64_t number = 0;
    std::function<void()> what;
    bool operator<(const Event& other) const { return std::pair(time, number) > std::pair(other.time, other.number); }
  };
  struct Seat {
    Seat(WordBench& of_bench, const node::LoadedProgram& program, std::size_t node)
        : bench(of_bench),
          of(program),
          number(node),
          member(settings(program, node)),
          peers(member.peer_count()),
          log(of_bench.log_),
          alarms(member.alarm_count()) {}
    static wire::NodeSettings settings(wire::NodeSettings settings, std::size_t node) {
      settings.set_incarnation(static_cast<std::uint32_t>(1000 + node));
      return settings;
    }
    void carry_out(wire::NodeOutputs& outputs) {
      while (const auto output = outputs.next())
        std::visit([&](const auto& what) { (output->side == side ? this : nested)->act(what); }, output->what);
    }
    /// A message has come; what its security refuses is counted and goes no further.
    void hear(const std::vector<std::byte>& octets) {
      if (!channel) return carry_out(member.receive(bench.now_, octets));
      const security::Opened opened = channel->open(octets, ns());
      ++bench.opened_[opened.verdict];
      if (opened.verdict == security::SecurityVerdict::good) carry_out(member.receive(bench.now_, opened.clear));
    }
    /// The node is restarted: it has its windows, and another life.
    void open_channel(std::uint16_t life) {
      const auto& secured = *bench.nodes_[number]->loaded.config.security;
      windows.resize(security::ReplayMemory::most_streams);
      channel.emplace(security::ChannelSettings{secured.mode, security::Nonces::lives,
                                                static_cast<std::uint16_t>(1 + number), life},
                      bench.nodes_[number]->loaded.keys->ring(secured.key_lifetime), security::ReplayMemory(windows));
    }
    std::int64_t ns() const { return bench.now_.since_start().ps() / 1000; }
    void act(const wire::SetAlarm& set) {
      const std::uint64_t setting = ++alarms[set.alarm];
      bench.at(set.time, [this, alarm = set.alarm, setting] {
        if (alarms[alarm] == setting) carry_out(member.wake(bench.now_, alarm));
      });
    }
    void act(const wire::Publish& message) {
      const uadp::Octets sealed = channel ? channel->seal(message.octets, ns()) : uadp::Octets(message.octets);
      const std::vector<std::byte> copy(sealed.begin(), sealed.end());
      if (bench.record_ != nullptr) bench.record_->push_back(copy);
      bench.streams_[{uadp::load_little_endian<std::uint16_t>(copy.data() + 2), message.destination.writer_group_id}] =
          copy;
      for (const auto& other : bench.nodes_)
        if (other->number != number)
          for (const auto& seat : other->seats)
            if (seat->of.program.name == of.program.name)
              bench.at(bench.now_ + sim::Duration::from_ps(20'000'000), [to = seat.get(), copy] { to->hear(copy); });
      if (message.is_state()) peers.published(message.word, bench.now_);
    }
    void act(const wire::Stepped& step) { log.stepped(ns(), step.outputs, step.after); }
    void act(const wire::Heard& heard) { peers.heard(heard.peer, heard.word, bench.now_); }
    void act(const wire::ProcessDataMessage&) {}
    void act(const wire::RoleBound& bound) { peers.forget(bound.role); }
    void act(const wire::RoleTaken&) {}
    void act(const wire::RoleDropped&) { peers.forget(0); }

    WordBench& bench;
    const node::LoadedProgram& of;
    std::size_t number;
    wire::ProgramNode member;
    handshake::Side side = handshake::Side::outer;
    Seat* nested = nullptr;
    node::CycleStatistics cycles;
    node::PeerWatch peers;
    node::TransitionLog log;
    std::vector<security::StoredWindow> windows;
    std::optional<security::SecureChannel> channel;
    std::vector<std::uint64_t> alarms;  ///< which setting of each is the valid one
  };
  struct Node {
    Node(WordBench& bench, const node::LoadedConfig& of, std::size_t place) : loaded(of), number(place) {
      for (const node::LoadedProgram& program : of.programs)
        seats.push_back(std::make_unique<Seat>(bench, program, place));
      for (std::size_t i = 0; i < seats.size(); ++i)
        if (const auto outer = of.programs[i].outer) {
          seats[*outer]->nested = seats[i].get();
          seats[i]->nested = seats[*outer].get();
          seats[i]->side = handshake::Side::inner;
          nesting = std::make_unique<wire::Nesting>(seats[*outer]->member, seats[i]->member);
        }
    }
    const node::LoadedConfig& loaded;
    std::size_t number;
    std::vector<std::unique_ptr<Seat>> seats;
    std::unique_ptr<wire::Nesting> nesting;
  };

  static std::shared_ptr<node::LoadedConfig> load(const WordBenchGroup& group, std::size_t node) {
    const std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("takt-word-bench-" + std::to_string(::getpid()) + ".json");
    const std::filesystem::path keys = path.string() + ".keys";
    if (!group.security.empty()) {
      const bool is_256 = group.security.find("aes256") != std::string::npos;
      std::ofstream(keys) << R"({"group": "cell", "policy": ")" << (is_256 ? "aes256-ctr" : "aes128-ctr")
                          << R"(", "secret": ")" << std::string(64, '5') << "\"}";
      std::filesystem::permissions(keys, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
    }
    std::ofstream(path) << R"({"node": ")" << group.nodes[node].first
                        << R"(", "transport": {"kind": "ethernet", "interface": "eth0"}, "programs": [)"
                        << group.programs << "]" << group.nodes[node].second
                        << (group.security.empty() ? ""
                                                   : R"(, "security": {"key_lifetime": "40ms", "keys": ")" +
                                                         keys.string() + "\", " + group.security + "}")
                        << "}";
    json::Diagnostics diagnostics;
    std::shared_ptr<node::LoadedConfig> loaded = node::load_config(path.string(), diagnostics);
    std::filesystem::remove(path);
    std::filesystem::remove(keys);
    if (!loaded) throw std::runtime_error(diagnostics.to_text());
    return loaded;
  }
  void at(sim::LocalTime time, std::function<void()> what) { events_.push({time, count_++, std::move(what)}); }

  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> sink_{std::fopen("/dev/null", "w")};
  node::Log log_{sink_.get()};
  sim::LocalTime now_;
  std::map<security::SecurityVerdict, std::uint64_t> opened_;
  std::vector<std::vector<std::byte>>* record_ = nullptr;
  std::uint64_t count_ = 0;
  std::priority_queue<Event> events_;
  std::map<std::pair<std::uint16_t, std::uint16_t>, std::vector<std::byte>> streams_;
  std::vector<std::unique_ptr<Node>> nodes_;
};

}  // namespace takt::test
