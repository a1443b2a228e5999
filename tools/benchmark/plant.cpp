// SPDX-License-Identifier: Apache-2.0
// A plant: a grid of switches, ten hosts on each, one stream a host to a random other one. Beside it a bare loop of the
// same events, which knows nothing but ports that send in turn and routes that were looked up before: what such a
// network could cost.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "measure.hpp"
#include "scenario/resolve.hpp"
#include "scenario/division/divided_run.hpp"
#include "scenario/run/run.hpp"
#include "workloads.hpp"

namespace takt::benchmark {
namespace {

constexpr std::uint32_t hosts_per_switch = 10;
constexpr std::int64_t period_ps = 1'000'000'000;

/// Whom each host sends to.
std::vector<std::uint32_t> listeners(std::uint32_t hosts) {
  std::mt19937 draw(1);
  std::vector<std::uint32_t> of_host(hosts);
  for (std::uint32_t h = 0; h < hosts; ++h) {
    do of_host[h] = static_cast<std::uint32_t>(draw() % hosts);
    while (of_host[h] == h);
  }
  return of_host;
}

std::int64_t offset_ns(std::uint32_t host, bool spread) { return spread ? std::int64_t{host} * 7919 % 1'000'000 : 0; }

std::string plant_text(unsigned side, bool spread, double simulated_seconds) {
  const std::uint32_t hosts = side * side * hosts_per_switch;
  const std::vector<std::uint32_t> to = listeners(hosts);
  std::string text =
      R"({"name": "plant", "duration": ")" + std::to_string(static_cast<long long>(simulated_seconds * 1e6)) +
      R"(us", "network": {"generate": [{"topology": "mesh", "rows": )" + std::to_string(side) + R"(, "columns": )" +
      std::to_string(side) + R"(, "hosts_per_switch": )" + std::to_string(hosts_per_switch) +
      R"(, "rate": "10Gbps", "host_rate": "1Gbps", "length": "10m", "forwarding_delay": "1us"}]}, "streams": [)";
  for (std::uint32_t h = 0; h < hosts; ++h)
    text += (h > 0 ? "," : "") + std::string(R"({"name": "s)") + std::to_string(h + 1) + R"(", "from": "h)" +
            std::to_string(h + 1) + R"(", "to": "h)" + std::to_string(to[h] + 1) +
            R"(", "payload": "200B", "every": "1ms", "offset": ")" + std::to_string(offset_ns(h, spread)) + R"(ns"})";
  return text + "]}";
}

// The bare loop. Times are picoseconds.
struct BareEvent {
  std::int64_t time;
  std::uint32_t what;   // a port at whose far end a frame arrives; or a talker
  std::uint32_t frame;  // no_frame: of a talker
};
constexpr std::uint32_t no_frame = 0xFFFF'FFFF;

/// Buckets of 256 ns, a ring of them. Nothing arrives sooner than a frame's length, the cable and the forwarding after
/// it was sent, which is longer: a bucket gets nothing while it is worked on, and can be sorted once.
class Ring {
 public:
  static constexpr std::int64_t width = 256'000;
  void push(const BareEvent& event) { buckets_[index(event.time)].push_back(event); }
  std::vector<BareEvent>& at(std::int64_t time) { return buckets_[index(time)]; }

 private:
  static std::size_t index(std::int64_t time) { return static_cast<std::size_t>(time / width) % 8192; }
  std::vector<std::vector<BareEvent>> buckets_{8192};
};

class BarePlant {
 public:
  BarePlant(unsigned side, bool spread)
      : side_(side),
        hosts_(side * side * hosts_per_switch),
        ports_(std::size_t{side} * side * ports_of_switch + hosts_) {
    for (std::uint32_t s = 0; s < side * side; ++s)
      for (std::uint32_t direction = 0; direction < 4; ++direction)
        ports_[s * ports_of_switch + direction].octet_ps = 800;
    const std::vector<std::uint32_t> to = listeners(hosts_);
    for (std::uint32_t h = 0; h < hosts_; ++h) {
      add_route(h, to[h]);
      ring_.push({offset_ns(h, spread) * 1000, h, no_frame});
    }
  }

  std::uint64_t run(double simulated_seconds) {
    const auto end = static_cast<std::int64_t>(simulated_seconds * 1e12);
    std::vector<BareEvent> now;
    for (std::int64_t at = 0; at < end; at += Ring::width) {
      now.swap(ring_.at(at));
      std::sort(now.begin(), now.end(), [](const BareEvent& a, const BareEvent& b) {
        return a.time != b.time ? a.time < b.time : a.what < b.what;
      });
      for (std::size_t i = 0; i < now.size(); ++i) {
        look_ahead(now, i);
        take(now[i]);
      }
      now.clear();
    }
    return frame_hops_;
  }

 private:
  static constexpr std::uint32_t ports_of_switch = 4 + hosts_per_switch;  // east, west, south, north, hosts
  struct Port {
    std::int64_t free_at = 0;
    std::uint32_t octet_ps = 8000;
    std::uint32_t frames = 0;
    std::uint64_t octets = 0;
  };
  struct Frame {
    std::uint32_t stream, hop;
    std::int64_t sent;
  };
  struct Stream {
    std::uint32_t first, hops;
    std::uint64_t delivered = 0;
    std::int64_t total = 0, longest = 0;
  };

  void add_route(std::uint32_t from, std::uint32_t to) {
    const auto first = static_cast<std::uint32_t>(route_.size());
    route_.push_back(side_ * side_ * ports_of_switch + from);
    std::uint32_t x = from / hosts_per_switch % side_, y = from / hosts_per_switch / side_;
    const std::uint32_t to_x = to / hosts_per_switch % side_, to_y = to / hosts_per_switch / side_;
    const auto leave_by = [&](std::uint32_t port) { route_.push_back((y * side_ + x) * ports_of_switch + port); };
    for (; x < to_x; ++x) leave_by(0);
    for (; x > to_x; --x) leave_by(1);
    for (; y < to_y; ++y) leave_by(2);
    for (; y > to_y; --y) leave_by(3);
    leave_by(4 + to % hosts_per_switch);
    streams_.push_back({first, static_cast<std::uint32_t>(route_.size()) - first});
  }

  void look_ahead(const std::vector<BareEvent>& now, std::size_t i) const {
    const auto frame_at = [&](std::size_t ahead) {
      return i + ahead < now.size() && now[i + ahead].frame != no_frame ? &frames_[now[i + ahead].frame] : nullptr;
    };
    if (const Frame* const frame = frame_at(12)) __builtin_prefetch(frame);
    if (const Frame* const frame = frame_at(8))
      __builtin_prefetch(&route_[streams_[frame->stream].first + frame->hop + 1]);
    if (const Frame* const frame = frame_at(4); frame != nullptr && frame->hop + 1 < streams_[frame->stream].hops)
      __builtin_prefetch(&ports_[route_[streams_[frame->stream].first + frame->hop + 1]], 1);
  }

  void take(const BareEvent& event) {
    if (event.frame == no_frame) {
      std::uint32_t slot = static_cast<std::uint32_t>(frames_.size());
      if (free_.empty()) {
        frames_.emplace_back();
      } else {
        slot = free_.back();
        free_.pop_back();
      }
      frames_[slot] = {event.what, 0, event.time};
      ring_.push({event.time + period_ps, event.what, no_frame});
      send(route_[streams_[event.what].first], slot, event.time);
      return;
    }
    Frame& frame = frames_[event.frame];
    Stream& stream = streams_[frame.stream];
    if (++frame.hop < stream.hops) return send(route_[stream.first + frame.hop], event.frame, event.time);
    ++stream.delivered;
    stream.total += event.time - frame.sent;
    stream.longest = std::max(stream.longest, event.time - frame.sent);
    free_.push_back(event.frame);
  }

  /// First come, first served: when a frame leaves is known when it comes.
  void send(std::uint32_t number, std::uint32_t frame, std::int64_t now) {
    constexpr std::int64_t octets = 200 + 28 + 18, preamble = 8, gap = 12;
    Port& port = ports_[number];
    const std::int64_t done = std::max(now, port.free_at) + (octets + preamble) * port.octet_ps;
    port.free_at = done + gap * port.octet_ps;
    ++port.frames;
    port.octets += octets;
    ++frame_hops_;
    ring_.push({done + 50'000 + 1'000'000, number, frame});
  }

  std::uint32_t side_, hosts_;
  std::vector<Port> ports_;
  std::vector<Stream> streams_;
  std::vector<std::uint32_t> route_;
  std::vector<Frame> frames_;
  std::vector<std::uint32_t> free_;
  Ring ring_;
  std::uint64_t frame_hops_ = 0;
};

}  // namespace

PlantFigures run_plant(unsigned side, bool spread, double simulated_seconds) {
  PlantFigures figures;
  const std::string text = plant_text(side, spread, simulated_seconds);
  const std::size_t octets_before = allocated_octets();
  const double setup_before = cpu_seconds();
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(text, "plant.json", {}, diagnostics);
  if (!resolved) {
    std::fputs(diagnostics.to_text().c_str(), stderr);
    std::abort();
  }
  auto run = std::make_unique<scenario::Run>(*resolved);
  figures.setup_cpu_seconds = cpu_seconds() - setup_before;
  const double before = cpu_seconds();
  run->advance();
  figures.cpu_seconds = cpu_seconds() - before;
  figures.octets = allocated_octets() - octets_before;
  for (std::uint32_t n = 0; n < run->network().plan().nodes.size(); ++n)
    for (const models::EgressPort& port : run->network().ports(models::NodeIndex{n}))
      figures.frame_hops += port.frames_sent();
  return figures;
}

ParallelFigures run_parallel_plant(unsigned side, bool spread, double simulated_seconds, unsigned threads) {
  ParallelFigures figures;
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(plant_text(side, spread, simulated_seconds), "plant.json", {}, diagnostics);
  if (!resolved) {
    std::fputs(diagnostics.to_text().c_str(), stderr);
    std::abort();
  }
  const auto seconds = [](auto&& what) {
    const auto before = std::chrono::steady_clock::now();
    what();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  };
  std::uint64_t digest = 0;
  {
    scenario::Run run(*resolved);
    figures.one_wall_seconds = seconds([&] { run.advance(); });
    digest = run.simulation().digest().value();
  }
  const scenario::Division division = scenario::divide(*resolved, threads);
  scenario::DividedRun run(*resolved, division);
  figures.threads = division.parts;
  figures.wall_seconds = seconds([&] { run.advance(run.end()); });
  figures.is_same = run.gathered().simulation().digest().value() == digest;
  return figures;
}

PlantFigures run_bare_plant(unsigned side, bool spread, double simulated_seconds) {
  PlantFigures figures;
  const double setup_before = cpu_seconds();
  BarePlant plant(side, spread);
  figures.setup_cpu_seconds = cpu_seconds() - setup_before;
  const double before = cpu_seconds();
  figures.frame_hops = plant.run(simulated_seconds);
  figures.cpu_seconds = cpu_seconds() - before;
  return figures;
}

}  // namespace takt::benchmark
