// SPDX-License-Identifier: Apache-2.0
// The worst that is found in networks of two or three streams and one to three switches, against all phases that there
// are: an oracle of its own, which shares nothing with takt, tries each of them.
//
// All times are multiples of a grain: four or twelve octets, since a frame occupies its link for 8 octets of preamble,
// itself and a gap of 12, and the next port has it after the first two. So the longest latency is
// found at phases that are multiples of the grain, or just beside them, in one of the orders in which streams may come
// that would meet there. TAKT_PHASED_NETWORKS=1000 tries as many networks.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <queue>
#include <string>
#include <vector>

#include "sim/random.hpp"
#include "tests/support/case_count.hpp"
#include "tests/questions/verify/support.hpp"

namespace takt::verify::phases_oracle_test {
namespace {

using sim::Duration;

constexpr std::int64_t octet_ps = 80'000;    // at 100 Mbit/s
constexpr std::int64_t parts_of_octet = 16;  // an order is made of parts of an octet

struct OracleStream {
  std::vector<int> ports;  // that it leaves by, from its talker on
  int pcp = 0;
  std::int64_t length = 0;  // with its preamble, in octets
  std::int64_t period = 0;  // in octets
};
struct OracleNetwork {
  std::string scenario;
  std::vector<OracleStream> streams;
  int ports = 0;
  std::int64_t grain = 4;
  std::int64_t duration = 0;  // in octets
};

/// The longest latency of each stream that has been delivered, in parts of an octet.
class Oracle {
 public:
  Oracle(const OracleNetwork& network, std::int64_t parts) : n_(network), parts_(parts) {}

  std::vector<std::int64_t> run(const std::vector<std::int64_t>& phases) {
    events_.clear();
    ports_.assign(static_cast<std::size_t>(n_.ports), Port());
    longest_.assign(n_.streams.size(), 0);
    for (std::size_t s = 0; s < n_.streams.size(); ++s)
      for (std::int64_t at = phases[s]; at < n_.duration * parts_; at += n_.streams[s].period * parts_)
        push({at, 0, static_cast<int>(s), 0, at});
    while (!events_.empty() && events_.front().at <= n_.duration * parts_) {
      // All that comes at one instant, then each port chooses.
      const std::int64_t now = events_.front().at;
      chosen_.clear();
      while (!events_.empty() && events_.front().at == now) {
        std::pop_heap(events_.begin(), events_.end());
        const Event event = events_.back();
        events_.pop_back();
        const OracleStream& stream = n_.streams[static_cast<std::size_t>(event.stream)];
        if (event.kind == 1) {
          chosen_.push_back(event.stream);  // the port is free
          continue;
        }
        if (static_cast<std::size_t>(event.hop) == stream.ports.size()) {
          longest_[static_cast<std::size_t>(event.stream)] =
              std::max(longest_[static_cast<std::size_t>(event.stream)], now - event.produced);
          continue;
        }
        const int port = stream.ports[static_cast<std::size_t>(event.hop)];
        ports_[static_cast<std::size_t>(port)].waiting.push_back(event);
        chosen_.push_back(port);
      }
      for (const int port : chosen_) choose(port, now);
    }
    return longest_;
  }

 private:
  struct Event {
    std::int64_t at = 0;
    int kind = 0;  // 0: a frame comes, 1: a port is free, whose number is `stream`
    int stream = 0;
    int hop = 0;
    std::int64_t produced = 0;
    bool operator<(const Event& other) const { return at > other.at; }  // the first one on top
  };
  struct Port {
    std::vector<Event> waiting;
    std::int64_t free_at = 0;
  };
  void push(const Event& event) {
    events_.push_back(event);
    std::push_heap(events_.begin(), events_.end());
  }
  void choose(int number, std::int64_t now) {
    Port& port = ports_[static_cast<std::size_t>(number)];
    if (port.waiting.empty() || port.free_at > now) return;
    auto first = port.waiting.begin();
    for (auto each = port.waiting.begin(); each != port.waiting.end(); ++each)
      if (n_.streams[static_cast<std::size_t>(each->stream)].pcp >
          n_.streams[static_cast<std::size_t>(first->stream)].pcp)
        first = each;
    const Event frame = *first;
    port.waiting.erase(first);
    const std::int64_t length = n_.streams[static_cast<std::size_t>(frame.stream)].length;
    port.free_at = now + (length + 12) * parts_;
    push({port.free_at, 1, number, 0, 0});
    push({now + length * parts_, 0, frame.stream, frame.hop + 1, frame.produced});
  }

  const OracleNetwork& n_;
  std::int64_t parts_;
  std::vector<Event> events_;
  std::vector<Port> ports_;
  std::vector<int> chosen_;
  std::vector<std::int64_t> longest_;
};

/// Switches in a line, hosts at them, a class of its own for each stream. Nothing if a link has too much to do.
std::optional<OracleNetwork> random_network(std::uint64_t number) {
  sim::RandomStream chance(number, "phases", "oracle");
  const auto pick = [&](std::int64_t from, std::int64_t to) {
    return from + static_cast<std::int64_t>(chance.below(static_cast<std::uint64_t>(to - from + 1)));
  };
  OracleNetwork made;
  made.grain = pick(0, 3) == 0 ? 4 : 12;
  const int switches = static_cast<int>(pick(1, 3));
  const int hosts = static_cast<int>(pick(2, 4));
  const int count = static_cast<int>(pick(2, 3));
  std::vector<int> at;  // its switch
  for (int h = 0; h < hosts; ++h) at.push_back(static_cast<int>(pick(0, switches - 1)));
  // Ports: of host h number h, of its switch towards it hosts + h, of switch s towards s + 1 and back behind those.
  const auto to_host = [&](int h) { return hosts + h; };
  const auto up = [&](int s) { return 2 * hosts + 2 * s; };
  const auto down = [&](int s) { return 2 * hosts + 2 * s + 1; };  // from s + 1 to s
  made.ports = 2 * hosts + 2 * switches;
  std::string nodes, links, streams, require;
  for (int s = 0; s < switches; ++s) {
    nodes += "\"s" + std::to_string(s) + "\": {\"kind\": \"switch\"}, ";
    if (s > 0)
      links += "{\"ends\": [\"s" + std::to_string(s - 1) + "\", \"s" + std::to_string(s) +
               "\"], \"rate\": \"100Mbps\", \"delay\": \"0s\"}, ";
  }
  for (int h = 0; h < hosts; ++h) {
    nodes += std::string(h > 0 ? ", " : "") + "\"h" + std::to_string(h) + "\": {\"kind\": \"host\", \"os\": \"none\"}";
    links += std::string(h > 0 ? ", " : "") + "{\"ends\": [\"h" + std::to_string(h) + "\", \"s" +
             std::to_string(at[static_cast<std::size_t>(h)]) + "\"], \"rate\": \"100Mbps\", \"delay\": \"0s\"}";
  }
  std::array<int, 6> classes{2, 3, 4, 5, 6, 7};
  std::vector<double> load(static_cast<std::size_t>(made.ports), 0);
  const std::int64_t base = 12 * pick(24, 30);
  for (int i = 0; i < count; ++i) {
    std::swap(classes[static_cast<std::size_t>(i)], classes[static_cast<std::size_t>(pick(i, 5))]);
    const int from = static_cast<int>(pick(0, hosts - 1));
    const int to = static_cast<int>((from + pick(1, hosts - 1)) % hosts);
    OracleStream stream;
    stream.pcp = classes[static_cast<std::size_t>(i)];
    stream.length = made.grain == 12 ? 12 * pick(6, 12) : 4 * pick(18, 36);
    stream.period = base * pick(1, 2);
    stream.ports.push_back(from);
    for (int s = at[static_cast<std::size_t>(from)]; s != at[static_cast<std::size_t>(to)];) {
      const bool is_up = s < at[static_cast<std::size_t>(to)];
      stream.ports.push_back(is_up ? up(s) : down(s - 1));
      s += is_up ? 1 : -1;
    }
    stream.ports.push_back(to_host(to));
    for (const int port : stream.ports)
      if ((load[static_cast<std::size_t>(port)] +=
           static_cast<double>(stream.length + 12) / static_cast<double>(stream.period)) > 0.95)
        return std::nullopt;
    const std::string name = "f" + std::to_string(i);
    // Addresses, tag, EtherType and FCS have 22 octets.
    streams += std::string(i > 0 ? ", " : "") + "{\"name\": \"" + name + "\", \"from\": \"h" + std::to_string(from) +
               "\", \"to\": \"h" + std::to_string(to) + "\", \"encapsulation\": \"ethernet\", \"payload\": \"" +
               std::to_string(stream.length - 30) + "B\", \"pcp\": " + std::to_string(stream.pcp) + ", \"every\": \"" +
               std::to_string(stream.period * octet_ps) + "ps\"}";
    require += std::string(i > 0 ? ", " : "") + "{\"stream\": \"" + name + "\", \"latency\": \"1s\"}";
    made.streams.push_back(std::move(stream));
  }
  made.duration = 2 * base * 6;
  made.scenario = "{\"name\": \"phases\", \"duration\": \"" + std::to_string(made.duration * octet_ps) +
                  "ps\", \"allow_overload\": true, \"network\": {\"nodes\": {" + nodes + "}, \"links\": [" + links +
                  "]}, \"streams\": [" + streams + "], \"require\": [" + require + "]}";
  return made;
}

/// Over all phases, the first stream's being 0, and all orders; in grains.
std::vector<std::int64_t> exhaustive_worst(const OracleNetwork& network) {
  Oracle oracle(network, parts_of_octet);
  const std::size_t count = network.streams.size();
  std::vector<std::int64_t> worst(count, 0);
  std::vector<std::int64_t> order(count);
  std::iota(order.begin(), order.end(), 0);
  const std::int64_t step = network.grain * parts_of_octet;
  do {
    std::vector<std::int64_t> phases(count, 0);
    const std::int64_t last = count > 2 ? network.streams[2].period / network.grain : 1;
    for (std::int64_t b = 0; b < network.streams[1].period / network.grain; ++b)
      for (std::int64_t c = 0; c < last; ++c) {
        for (std::size_t s = 0; s < count; ++s) phases[s] = (s == 1 ? b : s == 2 ? c : 0) * step + order[s];
        const std::vector<std::int64_t> longest = oracle.run(phases);
        for (std::size_t s = 0; s < count; ++s) worst[s] = std::max(worst[s], longest[s]);
      }
  } while (std::next_permutation(order.begin(), order.end()));
  for (std::int64_t& each : worst) each = (each + step / 2) / step;
  return worst;
}

TEST(PhasesOracle, TheWorstFoundIsTheWorstOfAllPhases) {
  const std::size_t wanted = support::case_count("TAKT_PHASED_NETWORKS", 60);
  std::size_t streams = 0, equal = 0, exhaustive = 0;
  std::uint64_t number = 0;
  for (std::size_t networks = 0; networks < wanted; ++number) {
    const std::optional<OracleNetwork> network = random_network(number);
    if (!network) continue;
    ++networks;
    const std::vector<std::int64_t> worst = exhaustive_worst(*network);
    Options options;
    options.search.seeds = 1;
    options.search.events = 6'000'000;
    const Verification found = verify(*resolved(network->scenario), options);
    ASSERT_EQ(found.lines.size(), worst.size());
    for (std::size_t s = 0; s < worst.size(); ++s) {
      const std::int64_t grain_ps = network->grain * octet_ps;
      const std::int64_t takt = (found.lines[s].adversarial->ps() + grain_ps / 2) / grain_ps;
      ++streams;
      equal += takt == worst[s];
      exhaustive += found.lines[s].exhaustive || found.lines[s].ended == Ended::bound_reached;
      EXPECT_LE(takt, worst[s]) << "network " << number << " stream " << s << ": the oracle is wrong\n"
                                << network->scenario;
      if (found.lines[s].exhaustive || found.lines[s].ended == Ended::bound_reached) {
        EXPECT_EQ(takt, worst[s]) << "network " << number << " stream " << s << "\n" << network->scenario;
      }
      if (takt != worst[s])
        std::printf("network %lu, stream %zu: %ld of %ld, %s\n", static_cast<unsigned long>(number), s,
                    static_cast<long>(takt), static_cast<long>(worst[s]), name_of(found.lines[s].ended));
    }
  }
  std::printf("%zu of %zu streams of %zu networks: the worst of all phases; of %zu it is said\n", equal, streams,
              wanted, exhaustive);
  EXPECT_GE(static_cast<double>(equal), 0.999 * static_cast<double>(streams));
  EXPECT_GE(2 * exhaustive, streams);
}

}  // namespace
}  // namespace takt::verify::phases_oracle_test
