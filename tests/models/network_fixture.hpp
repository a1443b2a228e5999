// SPDX-License-Identifier: Apache-2.0
// What the tests of networks share: building plans, running them, and applications that send and listen by table.
#pragma once

#include <cstring>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "models/network.hpp"

namespace takt::models::test {

using sim::DataRate;
using sim::Duration;
using sim::LocalTime;
using sim::TrueTime;
using namespace sim::literals;
using sim::operator""_Mbps;
using sim::operator""_Gbps;
using sim::operator""_B;

constexpr TrueTime at(Duration since_start) { return TrueTime() + since_start; }
constexpr LocalTime local(Duration since_start) { return LocalTime() + since_start; }

/// Addressing of a stream; the default is untagged and without further headers.
struct StreamOptions {
  std::optional<Priority> priority;
  VlanId vlan = 0;
  Octets headers{0};
};
constexpr StreamOptions udp{std::nullopt, 0, ipv4_and_udp_headers};

/// Builds a NetworkPlan node by node and link by link; streams find their way by breadth-first search, so all nodes and
/// links come before the streams. Ports are numbered in the order of the links.
class PlanBuilder {
 public:
  NetworkPlan plan;

  NodeIndex host(const std::string& name, std::uint32_t os_latency = 0) {
    return add({name, NodeKind::host, {}, 0, os_latency});
  }
  NodeIndex bridge(const std::string& name, Duration forwarding_delay = {}, std::uint32_t port_config = 0) {
    return add({name, NodeKind::bridge, forwarding_delay, port_config, 0});
  }
  NodeIndex station(const std::string& name, Duration forwarding_delay = {}, std::uint32_t port_config = 0,
                    std::uint32_t os_latency = 0) {
    return add({name, NodeKind::station, forwarding_delay, port_config, os_latency});
  }
  void link(NodeIndex a, NodeIndex b, DataRate rate = 1_Gbps, Duration delay = {}) {
    plan.links.push_back({{a, ports_[a.value]++}, {b, ports_[b.value]++}, rate, delay});
  }
  std::uint32_t port_config(const PortConfig& config) {
    plan.port_configs.push_back(config);
    return static_cast<std::uint32_t>(plan.port_configs.size() - 1);
  }
  std::uint32_t os_latency(const OsLatency& latency) {
    plan.os_latencies.push_back(latency);
    return static_cast<std::uint32_t>(plan.os_latencies.size() - 1);
  }

  /// One listener: unicast, on the shortest path, the same for all talkers. Several: a group address of its own, along
  /// the tree of shortest paths from the talker.
  StreamIndex stream(NodeIndex talker, std::vector<NodeIndex> listeners, const StreamOptions& options = {}) {
    const bool unicast = listeners.size() == 1;
    const AddressIndex address{unicast ? listeners[0].value : first_group + groups_++};
    for (const NodeIndex listener : listeners) {
      const std::vector<Step> steps = unicast ? path_from_tree_of(listener, talker) : path_to_tree_of(talker, listener);
      for (const Step& step : steps)
        if (plan.nodes[step.node.value].forwards() || ports_[step.node.value] > 1)
          plan.filtering.push_back({step.node, options.vlan, address, step.port});
      if (plan.nodes[listener.value].forwards())
        plan.filtering.push_back({listener, options.vlan, address, internal_port});
    }
    plan.streams.push_back({"stream" + std::to_string(plan.streams.size()), talker, address, options.vlan,
                            options.priority, options.headers, std::move(listeners)});
    return {static_cast<std::uint32_t>(plan.streams.size() - 1)};
  }
  // Not inlined: GCC 12 then sees uninitialised members in the variant that are not there.
  [[gnu::noinline]] void talk(StreamIndex stream, Octets payload, const TalkerSchedule& schedule) {
    plan.talkers.push_back({stream, payload, schedule});
  }
  /// One frame at each of these times.
  void send_at(StreamIndex stream, Octets payload, const std::vector<Duration>& times) {
    TraceSchedule schedule;
    for (const Duration time : times) schedule.entries.push_back({local(time), payload});
    talk(stream, payload, schedule);
  }

 private:
  static constexpr std::uint32_t first_group = 1'000'000;
  struct Step {
    NodeIndex node;
    std::uint16_t port = 0;  // towards the next node
  };

  NodeIndex add(NodePlan node) {
    plan.nodes.push_back(std::move(node));
    ports_.push_back(0);
    return {static_cast<std::uint32_t>(plan.nodes.size() - 1)};
  }

  /// For each node its way one step closer to the root, and the way back. Hosts do not forward.
  struct Towards {
    NodeIndex next;
    std::uint16_t port = 0;       // of this node, towards the root
    std::uint16_t back_port = 0;  // of the next node, away from the root
  };
  std::vector<Towards> tree_of(NodeIndex root) const {
    std::vector<Towards> tree(plan.nodes.size());
    tree[root.value].next = root;
    std::deque<NodeIndex> open{root};
    for (; !open.empty(); open.pop_front()) {
      const NodeIndex here = open.front();
      if (here != root && !plan.nodes[here.value].forwards()) continue;
      for (const LinkPlan& each : plan.links) {
        for (const auto& [from, to] : {std::pair(each.a, each.b), std::pair(each.b, each.a)}) {
          if (from.node != here || !tree[to.node.value].next.is_none()) continue;
          tree[to.node.value] = {here, to.port, from.port};
          open.push_back(to.node);
        }
      }
    }
    return tree;
  }
  /// The nodes from `talker` to `root` with the port that each uses.
  std::vector<Step> path_from_tree_of(NodeIndex root, NodeIndex talker) const {
    const std::vector<Towards> tree = tree_of(root);
    std::vector<Step> steps;
    for (NodeIndex node = talker; node != root; node = tree[node.value].next)
      steps.push_back({node, tree[node.value].port});
    return steps;
  }
  /// The nodes from `root` to `listener` (listed backwards) with the port that each uses.
  std::vector<Step> path_to_tree_of(NodeIndex root, NodeIndex listener) const {
    const std::vector<Towards> tree = tree_of(root);
    std::vector<Step> steps;
    for (NodeIndex node = listener; node != root; node = tree[node.value].next)
      steps.push_back({tree[node.value].next, tree[node.value].back_port});
    return steps;
  }

  std::vector<std::uint16_t> ports_;
  std::uint32_t groups_ = 0;
};

/// Keeps all trace records.
class TraceLog final : public sim::TraceSink {
 public:
  void record(const sim::TraceRecord& record) override { records.push_back(record); }
  std::vector<sim::TraceRecord> of(Occurrence kind) const {
    std::vector<sim::TraceRecord> found;
    for (const sim::TraceRecord& record : records)
      if (record.kind == static_cast<std::uint32_t>(kind)) found.push_back(record);
    return found;
  }
  std::vector<sim::TraceRecord> records;
};

/// A simulation with its network.
struct NetworkRun {
  explicit NetworkRun(NetworkPlan plan, std::uint64_t seed = 1, std::uint64_t tie_shuffle = 0) : simulation(seed) {
    simulation.set_tie_shuffle(tie_shuffle);
    network.emplace(simulation, std::move(plan));
  }
  /// Starts the network and runs it to that time.
  NetworkRun& until(Duration end) {
    if (!started) network->start();
    started = true;
    simulation.run(at(end));
    return *this;
  }
  const Stream& stream(StreamIndex index) const { return network->traffic().stream(index); }
  const EgressPort& port(NodeIndex node, std::size_t port) const { return network->ports(node)[port]; }
  std::uint64_t digest() const { return simulation.digest().value(); }

  sim::Simulation simulation;
  std::optional<Network> network;
  bool started = false;
};

/// Sends payloads of given lengths at given local times; the first eight octets, if there are as many, hold the number
/// of the frame within its stream.
class Sender final : public Application {
 public:
  struct Item {
    LocalTime time;
    StreamIndex stream;
    std::size_t length = 0;
  };
  explicit Sender(std::vector<Item> items) : items_(std::move(items)) {}

  AlarmId alarm_count() const override { return 1; }
  void start(HostServices& host) override { arm(host); }
  void receive(HostServices&, StreamIndex, std::span<const std::byte>) override {}
  void wake(HostServices& host, AlarmId) override {
    // With a wake-up latency several items may be due.
    for (; next_ < items_.size() && items_[next_].time <= host.now(); ++next_) {
      const Item& item = items_[next_];
      if (sequences_.size() <= item.stream.value) sequences_.resize(item.stream.value + std::size_t{1});
      std::vector<std::byte> payload(item.length);
      const std::uint64_t sequence = sequences_[item.stream.value]++;
      if (payload.size() >= sizeof sequence) std::memcpy(payload.data(), &sequence, sizeof sequence);
      host.send(item.stream, payload);
    }
    arm(host);
  }

 private:
  void arm(HostServices& host) {
    if (next_ < items_.size()) host.set_alarm(0, items_[next_].time);
  }
  std::vector<Item> items_;
  std::size_t next_ = 0;
  std::vector<std::uint64_t> sequences_;
};

/// Notes what arrives and when.
class Listener final : public Application {
 public:
  struct Arrival {
    LocalTime time;
    StreamIndex stream;
    std::uint64_t sequence = 0;
    std::size_t length = 0;
  };
  AlarmId alarm_count() const override { return 0; }
  void start(HostServices&) override {}
  void receive(HostServices& host, StreamIndex stream, std::span<const std::byte> payload) override {
    Arrival arrival{host.now(), stream, 0, payload.size()};
    if (payload.size() >= sizeof arrival.sequence)
      std::memcpy(&arrival.sequence, payload.data(), sizeof arrival.sequence);
    arrivals.push_back(arrival);
  }
  void wake(HostServices&, AlarmId) override {}

  std::vector<Arrival> arrivals;
};

/// Puts an application on a host and returns it.
template <class App, class... Arguments>
App& install(Network& network, NodeIndex host, const std::string& name, Arguments&&... arguments) {
  auto application = std::make_unique<App>(std::forward<Arguments>(arguments)...);
  App& reference = *application;
  network.add_process(host, name, std::move(application));
  return reference;
}

/// A listener on a host that takes the octets of these streams.
inline Listener& listen(Network& network, NodeIndex host, const std::vector<StreamIndex>& streams) {
  auto application = std::make_unique<Listener>();
  Listener& reference = *application;
  Process& process = network.add_process(host, "listener", std::move(application));
  for (const StreamIndex stream : streams) network.listen(host, stream, &process);
  return reference;
}

/// talker - bridges - listener in a line, all links alike.
struct Line {
  Line(std::size_t bridges, DataRate rate, Duration delay, Duration forwarding_delay = {}) {
    talker = builder.host("talker");
    NodeIndex last = talker;
    for (std::size_t i = 0; i < bridges; ++i) {
      const NodeIndex next = builder.bridge("sw" + std::to_string(i + 1), forwarding_delay);
      builder.link(last, next, rate, delay);
      last = next;
    }
    listener = builder.host("listener");
    builder.link(last, listener, rate, delay);
  }
  PlanBuilder builder;
  NodeIndex talker;
  NodeIndex listener;
};

}  // namespace takt::models::test
