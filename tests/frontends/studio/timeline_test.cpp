// SPDX-License-Identifier: Apache-2.0
// The timeline of the studio: it holds what the run did, and its pieces tell it, whatever the zoom.
#include "studio/timeline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <set>
#include <tuple>

#include "evaluation/evaluate.hpp"
#include "explain/way_recorder.hpp"
#include "scenario/resolve.hpp"
#include "scenario/run/run.hpp"

namespace takt::studio {
namespace {

std::unique_ptr<scenario::Resolved> shipped(const std::string& file) {
  json::Diagnostics diagnostics;
  auto resolved =
      scenario::load_file(std::string(TAKT_SOURCE_DIR) + "/scenarios/" + file, {"duration=200ms"}, diagnostics);
  EXPECT_TRUE(resolved) << diagnostics.to_text();
  return resolved;
}

const auto never = [] { return false; };

/// Every port that a frame was sent by, as explanations tell it: another witness of the same run.
class Departures final : public explain::WaySink {
 public:
  bool wants(models::StreamIndex) const override { return true; }
  void ended(const explain::Way& way) override {
    for (const explain::Hop& hop : way.hops)
      if (hop.started != sim::TrueTime::never())
        all.emplace(hop.port.node.value, hop.port.port, hop.started.ps(), way.frame.stream.value, way.frame.sequence);
  }
  std::set<std::tuple<std::uint32_t, std::uint16_t, std::int64_t, std::uint32_t, std::uint64_t>> all;
};

class OfScenario : public testing::TestWithParam<const char*> {};

TEST_P(OfScenario, HoldsEachDepartureOnce) {
  const auto resolved = shipped(GetParam());
  scenario::Run run(*resolved);
  Departures departures;
  explain::WayRecorder recorder(run.network(), departures);
  run.explain_to(&recorder);
  run.advance();
  recorder.finish(run.simulation().now());
  ASSERT_GT(departures.all.size(), 100u);

  const auto timeline = Timeline::record(*resolved, sim::TrueTime(), {}, never);
  ASSERT_TRUE(timeline);
  EXPECT_EQ(timeline->to(), run.end());
  std::map<std::string, std::uint32_t> node;
  for (std::uint32_t n = 0; n < resolved->plan.nodes.size(); ++n) node[resolved->plan.nodes[n].name] = n;
  std::size_t sent = 0;
  for (const Timeline::Row& row : timeline->rows()) {
    EXPECT_TRUE(std::is_sorted(row.sent.begin(), row.sent.end(),
                               [](const auto& a, const auto& b) { return a.start < b.start; }));
    std::int64_t free = 0;
    for (const Timeline::Sent& each : row.sent) {
      if ((each.flags & (Timeline::Sent::dropped | Timeline::Sent::continued)) != 0) continue;
      EXPECT_GE(each.start, free - 1) << "two frames on one medium";
      free = each.start + static_cast<std::int64_t>(each.length * 0.999999F);
      const bool is_ours = departures.all.contains({node[row.node], row.port, each.start, each.stream, each.sequence});
      sent += is_ours ? 1 : 0;
      EXPECT_TRUE(is_ours || run.network().traffic().streams()[each.stream].link_local)
          << "only messages of gPTP have no ways: " << row.node << ' ' << each.start;
    }
  }
  EXPECT_EQ(sent, departures.all.size());
}

INSTANTIATE_TEST_SUITE_P(Scenarios, OfScenario,
                         testing::Values("tsn/gates-on-a-line.json", "tsn/preemption-on-a-line.json",
                                         "tsn/frer-ring.json", "clocks/two-sources-and-a-gate-with-gptp.json"));

/// A piece as the page decodes it.
struct Piece {
  explicit Piece(std::string octets) : octets_(std::move(octets)) {}
  template <class T>
  T at(std::size_t place) const {
    T value{};
    EXPECT_LE(place + sizeof value, octets_.size());
    EXPECT_EQ(place % sizeof value, 0u) << "typed arrays want numbers at multiples of their size";
    if (place + sizeof value <= octets_.size()) std::memcpy(&value, octets_.data() + place, sizeof value);
    return value;
  }
  std::uint32_t word(std::size_t n) const { return at<std::uint32_t>(4 * n); }
  std::uint32_t rows() const { return word(0); }
  std::uint32_t kind(std::size_t row) const { return word(2 + 6 * row); }
  std::uint32_t count(std::size_t row) const { return word(3 + 6 * row); }
  std::uint32_t place(std::size_t row) const { return word(4 + 6 * row); }
  std::uint32_t gates(std::size_t row) const { return word(5 + 6 * row); }
  std::uint32_t gates_place(std::size_t row) const { return word(6 + 6 * row); }
  std::string octets_;
};

TEST(Pieces, TellEachFrameWhereThereAreFewAndHowBusyItWasWhereThereAreMany) {
  const auto resolved = shipped("tsn/gates-on-a-line.json");
  const auto timeline = Timeline::record(*resolved, sim::TrueTime(), {}, never);
  ASSERT_TRUE(timeline);
  const std::int64_t span = timeline->to().ps();
  std::size_t exact = 0;
  std::size_t many = 0;
  for (const unsigned level : {0U, 3U, 7U}) {
    const std::int64_t length = (span + (std::int64_t{1} << level) - 1) >> level;
    for (std::uint64_t index = 0; index < (1ULL << level); ++index) {
      const Piece piece(timeline->piece(level, index, 0, Timeline::most_rows));
      ASSERT_EQ(piece.rows(), timeline->rows().size());
      const auto begin = static_cast<std::int64_t>(index) * length;
      for (std::size_t r = 0; r < piece.rows(); ++r) {
        const Timeline::Row& row = timeline->rows()[r];
        std::vector<const Timeline::Sent*> expected;
        double busy = 0;
        for (const Timeline::Sent& each : row.sent) {
          const auto end = each.start + static_cast<std::int64_t>(each.length);
          const bool is_within = each.start < begin + length && (each.start >= begin || end > begin);
          if (!is_within) continue;
          expected.push_back(&each);
          busy += static_cast<double>(std::min(end, begin + length) - std::max(each.start, begin));
        }
        ASSERT_EQ(piece.count(r), expected.size());
        if (piece.kind(r) == 1) {
          exact += expected.size();
          for (std::size_t n = 0; n < expected.size(); ++n) {
            EXPECT_EQ(begin + static_cast<std::int64_t>(piece.at<double>(piece.place(r) + 8 * n)), expected[n]->start);
            EXPECT_EQ(piece.at<std::uint32_t>(piece.place(r) + 8 * expected.size() + 4 * (2 * expected.size() + n)),
                      expected[n]->sequence);
          }
          continue;
        }
        ++many;
        EXPECT_GT(expected.size(), 400u);
        double shares = 0;
        for (std::size_t b = 0; b < 512; ++b) shares += piece.at<std::uint8_t>(piece.place(r) + 4 * 512 + b);
        EXPECT_NEAR(shares / 255 * static_cast<double>(length) / 512, busy,
                    0.02 * busy + static_cast<double>(length) / 500)
            << "row " << r << " of piece " << index;
      }
    }
  }
  EXPECT_GT(exact, 1000u);
  EXPECT_GT(many, 0u) << "or the second half was not looked at";
}

constexpr const char* gated = R"({
  "name": "gated", "duration": "10ms",
  "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}, "s": {"kind": "switch", "egress": [{"gates": {"entries": [{"open": [7], "for": "300us"}, {"open": [0, 1], "for": "700us"}]}}]}},
              "links": [{"ends": ["a", "s"], "rate": "1Gbps", "length": "10m"}, {"ends": ["s", "b"], "rate": "1Gbps", "length": "10m"}]},
  "streams": [{"name": "x", "from": "a", "to": "b", "payload": "100B", "every": "1ms", "pcp": 0}]
})";

TEST(Pieces, TellTheGatesFromTheStateAtTheBeginningOn) {
  json::Diagnostics diagnostics;
  const auto resolved = scenario::load_text(gated, "gated.json", {}, diagnostics);
  ASSERT_TRUE(resolved) << diagnostics.to_text();
  const auto timeline = Timeline::record(*resolved, sim::TrueTime(), {}, never);
  ASSERT_TRUE(timeline);
  const auto row = std::find_if(timeline->rows().begin(), timeline->rows().end(),
                                [](const Timeline::Row& each) { return !each.gates.empty(); }) -
                   timeline->rows().begin();
  ASSERT_LT(static_cast<std::size_t>(row), timeline->rows().size());
  const Piece piece(timeline->piece(2, 1, static_cast<std::size_t>(row), 1));  // 2.5 ms to 5 ms
  const std::uint32_t count = piece.gates(0);
  ASSERT_EQ(count, 5u);  // as it stands, and at 3, 3.3, 4 and 4.3 ms
  const std::array<double, 5> at = {2.3e9 - 2.5e9, 0.5e9, 0.8e9, 1.5e9, 1.8e9};
  const std::array<std::uint32_t, 5> open = {0x03, 0x80, 0x03, 0x80, 0x03};
  for (std::size_t n = 0; n < count; ++n) {
    EXPECT_EQ(piece.at<double>(piece.gates_place(0) + 8 * n), at[n]);
    EXPECT_EQ(piece.at<std::uint32_t>(piece.gates_place(0) + 8 * count + 4 * n), open[n]);
  }
}

TEST(Pieces, BeyondWhatIsThereAreEmpty) {
  const auto resolved = shipped("direct-link.json");
  const auto timeline = Timeline::record(*resolved, sim::TrueTime(), {}, never);
  ASSERT_TRUE(timeline);
  for (const auto& [level, index, first, count] :
       std::vector<std::tuple<unsigned, std::uint64_t, std::size_t, std::size_t>>{
           {0, 1, 0, 64},
           {40, ~0ULL, 0, 64},
           {99, 3, 0, 64},
           {0, 0, 1000, 64},
           {0, 0, ~std::size_t{0}, ~std::size_t{0}},
           {0, 0, 1, ~std::size_t{0}}}) {
    const Piece piece(timeline->piece(level, index, first, count));
    EXPECT_LE(piece.rows(), timeline->rows().size());
    for (std::size_t r = 0; r < piece.rows(); ++r) EXPECT_LE(piece.place(r), piece.octets_.size());
  }
}

TEST(Recording, EndsWhereThereIsNoRoomAndSaysSo) {
  const auto resolved = shipped("tsn/gates-on-a-line.json");
  const auto whole = Timeline::record(*resolved, sim::TrueTime(), {}, never);
  const auto part = Timeline::record(*resolved, sim::TrueTime(), {.frames = 1000}, never);
  ASSERT_TRUE(whole && part);
  EXPECT_NE(whole->summary().find("\"whole\": true"), std::string::npos) << whole->summary().substr(0, 200);
  EXPECT_NE(part->summary().find("\"whole\": false"), std::string::npos);
  EXPECT_NE(part->summary().find("\"frames\": 1000,"), std::string::npos);
  EXPECT_LT(part->to(), whole->to());
  for (const Timeline::Row& row : part->rows())
    EXPECT_TRUE(row.sent.empty() || row.sent.back().start <= part->to().ps());
}

TEST(Recording, BeginsLaterIfAskedTo) {
  const auto resolved = shipped("tsn/gates-on-a-line.json");
  const auto whole = Timeline::record(*resolved, sim::TrueTime(), {}, never);
  const auto from = sim::TrueTime() + sim::Duration::from_ps(whole->to().ps() / 2);
  const auto late = Timeline::record(*resolved, from, {}, never);
  ASSERT_TRUE(late);
  for (std::size_t r = 0; r < whole->rows().size(); ++r) {
    const auto& all = whole->rows()[r].sent;
    const auto first = std::find_if(all.begin(), all.end(), [&](const auto& each) { return each.start >= from.ps(); });
    ASSERT_EQ(late->rows()[r].sent.size(), static_cast<std::size_t>(all.end() - first));
    for (std::size_t n = 0; n < late->rows()[r].sent.size(); ++n)
      EXPECT_EQ(late->rows()[r].sent[n].start, first[static_cast<std::ptrdiff_t>(n)].start);
  }
}

/// Frames that a filter, a meter or a stream gate discards have no port of their own; those of a longest SDU neither.
TEST(Recording, HoldsEachFrameThatWasDiscarded) {
  for (const char* const change : {"duration=200ms", "/streams/0/offset=500us", "/streams/0/payload=400B"}) {
    json::Diagnostics diagnostics;
    const auto resolved = scenario::load_file(std::string(TAKT_SOURCE_DIR) + "/scenarios/tsn/policing.json",
                                              {"duration=200ms", change}, diagnostics);
    ASSERT_TRUE(resolved) << diagnostics.to_text();
    scenario::Run run(*resolved);
    run.advance();
    const results::RunResult result = evaluation::evaluate(run, false);
    const auto timeline = Timeline::record(*resolved, sim::TrueTime(), {}, never);
    for (std::uint32_t s = 0; s < result.streams.size(); ++s) {
      std::uint64_t discarded = 0;
      for (const Timeline::Row& row : timeline->rows())
        discarded +=
            static_cast<std::uint64_t>(std::count_if(row.sent.begin(), row.sent.end(), [&](const Timeline::Sent& each) {
              return (each.flags & Timeline::Sent::dropped) != 0 && each.stream == s;
            }));
      EXPECT_EQ(discarded, result.streams[s].dropped_in_all()) << change << ' ' << result.streams[s].name;
    }
    EXPECT_GT(result.streams[1].dropped_in_all(), 100u);
    // Seen from afar, too: how many ended in each part of the time.
    const Piece piece(timeline->piece(0, 0, 0, Timeline::most_rows));
    std::uint64_t told = 0;
    for (std::size_t r = 0; r < piece.rows(); ++r)
      for (std::size_t b = 0; piece.kind(r) == 2 && b < 512; ++b)
        told += piece.at<std::uint8_t>(piece.place(r) + 5 * 512 + b);
    EXPECT_GE(told, result.streams[1].dropped_in_all()) << change;
  }
}

TEST(Recording, OfAProgramTellsItsStates) {
  const auto resolved = shipped("first-cell.json");
  const auto timeline = Timeline::record(*resolved, sim::TrueTime(), {}, never);
  ASSERT_TRUE(timeline);
  ASSERT_FALSE(timeline->tracks().empty());
  EXPECT_EQ(timeline->tracks().front().states.front(), (std::pair<std::int64_t, std::string>(0, "Halted")));
  EXPECT_TRUE(std::any_of(timeline->tracks().begin(), timeline->tracks().end(), [](const auto& track) {
    return std::any_of(track.states.begin(), track.states.end(),
                       [](const auto& each) { return each.second == "Running"; });
  }));
}

TEST(Recording, IsGivenUpWhenNobodyWantsIt) {
  const auto resolved = shipped("tsn/gates-on-a-line.json");
  EXPECT_EQ(Timeline::record(*resolved, sim::TrueTime(), {}, [] { return true; }), nullptr);
}

}  // namespace
}  // namespace takt::studio
