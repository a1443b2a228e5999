// SPDX-License-Identifier: Apache-2.0
#include "studio/timeline.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <span>

#include "json/node.hpp"
#include "scenario/run/run.hpp"
#include "studio/timeline_sink.hpp"

namespace takt::studio {
namespace {

constexpr std::size_t most_exact = 400;  // frames of a row in a piece; more are told as
constexpr std::size_t buckets = 512;     // so many shares of busy time

/// Octets as the page's typed arrays read them: little-endian, numbers at multiples of their size.
class Octets {
 public:
  template <class T>
  void add(T value) {
    std::array<char, sizeof value> raw{};
    std::memcpy(raw.data(), &value, sizeof value);
    octets_.append(raw.data(), raw.size());
  }
  void align() { octets_.resize((octets_.size() + 7) / 8 * 8); }
  void put(std::size_t at, std::uint32_t value) { std::memcpy(octets_.data() + at, &value, sizeof value); }
  std::uint32_t size() const { return static_cast<std::uint32_t>(octets_.size()); }
  std::string take() { return std::move(octets_); }

 private:
  std::string octets_;
};

struct Stretch {
  std::int64_t from = 0;
  std::int64_t until = 0;
};

std::int64_t end_of(const Timeline::Sent& sent) { return sent.start + static_cast<std::int64_t>(sent.length); }

/// Those that are on the medium in that time.
std::span<const Timeline::Sent> within(const std::vector<Timeline::Sent>& sent, Stretch time) {
  auto first = std::lower_bound(sent.begin(), sent.end(), time.from,
                                [](const Timeline::Sent& each, std::int64_t at) { return each.start < at; });
  // What is under way at the beginning began before; drops, which take no time, may stand behind it.
  constexpr int farthest = 1000;
  auto before = first;
  for (int steps = 0; before != sent.begin() && steps < farthest; ++steps) {
    --before;
    if (end_of(*before) > time.from)
      first = before;
    else if ((before->flags & Timeline::Sent::dropped) == 0)
      break;
  }
  const auto last = std::lower_bound(first, sent.end(), time.until,
                                     [](const Timeline::Sent& each, std::int64_t at) { return each.start < at; });
  return {first, last};
}

void add_exact(std::span<const Timeline::Sent> sent, Stretch time, Octets& octets) {
  for (const Timeline::Sent& each : sent) octets.add(static_cast<double>(each.start - time.from));
  for (const Timeline::Sent& each : sent) octets.add(each.length);
  for (const Timeline::Sent& each : sent) octets.add(each.stream);
  for (const Timeline::Sent& each : sent) octets.add(each.sequence);
  for (const Timeline::Sent& each : sent) octets.add(each.flags);
}

/// How busy the medium is in each part of the time, of 255, the stream of the frame that takes most of it, and how many
/// frames were discarded, at most 255.
void add_buckets(std::span<const Timeline::Sent> sent, Stretch time, Octets& octets) {
  const double width = static_cast<double>(time.until - time.from) / buckets;
  std::vector<double> busy(buckets);
  std::vector<double> longest(buckets);
  std::vector<std::uint32_t> stream(buckets, 0xFFFF'FFFF);
  std::vector<std::uint8_t> discarded(buckets);
  for (const Timeline::Sent& each : sent) {
    if ((each.flags & Timeline::Sent::dropped) != 0) {
      std::uint8_t& count = discarded[std::min(
          static_cast<std::size_t>(std::max(0.0, static_cast<double>(each.start - time.from)) / width), buckets - 1)];
      if (count < 255) ++count;
      continue;
    }
    const double begin = std::max(0.0, static_cast<double>(each.start - time.from));
    const double end = std::min(static_cast<double>(time.until - time.from),
                                static_cast<double>(each.start - time.from) + static_cast<double>(each.length));
    for (auto b = static_cast<std::size_t>(begin / width); b < buckets && static_cast<double>(b) * width <= end; ++b) {
      const double share =
          std::min(end, static_cast<double>(b + 1) * width) - std::max(begin, static_cast<double>(b) * width);
      busy[b] += std::max(share, 0.0);
      if (stream[b] != 0xFFFF'FFFF && share <= longest[b]) continue;
      longest[b] = share;
      stream[b] = each.stream;
    }
  }
  for (const std::uint32_t each : stream) octets.add(each);
  for (const double each : busy) octets.add(static_cast<std::uint8_t>(std::clamp(each / width, 0.0, 1.0) * 255 + 0.5));
  for (const std::uint8_t each : discarded) octets.add(each);
}

/// The state at the beginning and each change; too many to be told apart are left out, with the count that they had.
std::uint32_t add_gates(const std::vector<Timeline::Gates>& gates, Stretch time, Octets& octets) {
  auto first = std::upper_bound(gates.begin(), gates.end(), time.from,
                                [](std::int64_t at, const Timeline::Gates& each) { return at < each.at; });
  if (first != gates.begin()) --first;
  const auto last = std::lower_bound(first, gates.end(), time.until,
                                     [](const Timeline::Gates& each, std::int64_t at) { return each.at < at; });
  const auto count = static_cast<std::size_t>(last - first);
  if (count > most_exact) return 0;
  for (auto each = first; each != last; ++each) octets.add(static_cast<double>(each->at - time.from));
  for (auto each = first; each != last; ++each) octets.add(each->open);
  return static_cast<std::uint32_t>(count);
}

}  // namespace

std::unique_ptr<Timeline> Timeline::record(const scenario::Resolved& resolved, sim::TrueTime from, const Limits& limits,
                                           const std::function<bool()>& interrupted) {
  scenario::Run run(resolved);
  auto timeline = std::make_unique<Timeline>();
  timeline->from_ = from;
  TimelineSink sink(run, limits, *timeline);
  run.explain_to(&sink);
  constexpr std::uint64_t events_a_slice = 50'000;
  for (bool is_over = false; !is_over && !sink.is_full();) {
    if (interrupted()) return nullptr;
    is_over = run.advance(events_a_slice);
  }
  run.explain_to(nullptr);
  sink.finish(run.simulation().now());
  return timeline;
}

std::string Timeline::summary() const {
  using json::Node;
  const auto time = [](std::int64_t ps) { return Node::of_integer(ps); };
  Node page = Node::object();
  page.add("from_ps", time(from_.ps()));
  page.add("to_ps", time(to_.ps()));
  page.add("whole", Node::of_bool(is_whole_));
  page.add("frames", Node::of_integer(static_cast<std::int64_t>(frames_)));
  Node streams = Node::array();
  for (const std::string& name : streams_) streams.items.push_back(Node::of_string(name));
  page.add("streams", std::move(streams));
  Node rows = Node::array();
  for (const Row& row : rows_) {
    Node made = Node::object();
    made.add("node", Node::of_string(row.node));
    made.add("port", Node::of_integer(row.port));
    made.add("to", Node::of_string(row.peer));
    made.add("gates", Node::of_bool(!row.gates.empty()));
    rows.items.push_back(std::move(made));
  }
  page.add("rows", std::move(rows));
  Node tracks = Node::array();
  for (const Track& track : tracks_) {
    Node states = Node::array();
    for (const auto& [at, name] : track.states) {
      Node state = Node::array();
      state.items.push_back(time(at));
      state.items.push_back(Node::of_string(name));
      states.items.push_back(std::move(state));
    }
    Node made = Node::object();
    made.add("program", Node::of_string(track.program));
    made.add("name", Node::of_string(track.name));
    made.add("states", std::move(states));
    tracks.items.push_back(std::move(made));
  }
  page.add("tracks", std::move(tracks));
  return json::compact(page);
}

std::string Timeline::piece(unsigned level, std::uint64_t index, std::size_t first, std::size_t count) const {
  const std::int64_t span = std::max<std::int64_t>(to_.ps() - from_.ps(), 1);
  const std::int64_t parts = std::int64_t{1} << std::min(level, greatest_level);
  const std::int64_t length = (span + parts - 1) / parts;
  first = std::min(first, rows_.size());
  count = std::min({count, most_rows, rows_.size() - first});
  Stretch time{to_.ps(), to_.ps()};
  if (index < static_cast<std::uint64_t>(parts))
    time = {from_.ps() + length * static_cast<std::int64_t>(index),
            from_.ps() + length * static_cast<std::int64_t>(index + 1)};

  Octets octets;
  constexpr std::size_t words = 6;  // of a row's head: kind, frames, where they stand, gates, where they stand, nothing
  octets.add(static_cast<std::uint32_t>(count));
  octets.add(std::uint32_t{0});
  for (std::size_t i = 0; i < words * count; ++i) octets.add(std::uint32_t{0});
  for (std::size_t i = 0; i < count; ++i) {
    const Row& row = rows_[first + i];
    const std::size_t head = 8 + i * words * 4;
    const auto sent = within(row.sent, time);
    octets.align();
    octets.put(head, sent.size() > most_exact ? 2 : 1);
    octets.put(head + 4, static_cast<std::uint32_t>(sent.size()));
    octets.put(head + 8, octets.size());
    if (sent.size() > most_exact)
      add_buckets(sent, time, octets);
    else
      add_exact(sent, time, octets);
    octets.align();
    octets.put(head + 16, octets.size());
    octets.put(head + 12, add_gates(row.gates, time, octets));
  }
  return octets.take();
}

}  // namespace takt::studio
