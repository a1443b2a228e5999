// SPDX-License-Identifier: Apache-2.0
// Process data that answers process data: the round trip to the picosecond, and what is refused.
#include "evaluation/evaluate.hpp"
#include "scenario/programs/reply_worker.hpp"
#include "support.hpp"

namespace takt::scenario::test::replies_test {
namespace {

std::string pair(const std::string& more,
                 const std::string& processing = R"("processing": {"per_message": "30us", "per_field": "2us"})") {
  const std::string host = R"({"kind": "host", "os": {"transmit": "10us", "receive": "20us"}, )" + processing + "}";
  return R"({"name": "t", "duration": "100ms", "network": {"nodes": {"m": )" + host + R"(, "s": )" + host +
         R"(}, "links": [{"ends": ["m", "s"], "delay": "100ns"}]},
 "programs": [{"name": "p", "master": "m", "slaves": ["s"], "cycle": "1ms", "process_data": [
   {"name": "forth", "from": "m", "fields": {"a": {"type": "Double", "count": 2}, "b": "Int32"}},
   {"name": "back", "from": "s", "fields": {"a": {"type": "Double", "count": 3}}}])" +
         more + R"(}], "script": [{"at": "10.5ms", "program": "p", "call": "Start"}]})";
}

TEST(Replies, RoundTripToThePicosecond) {
  const auto resolved = sound(pair(R"(, "replies": [{"to": "forth", "with": "back"}])"));
  LiveRun run(*resolved);
  run.advance();
  const results::RunResult result = evaluation::evaluate(run, false);
  ASSERT_EQ(result.programs[0].round_trips.size(), 1u);
  const results::RoundTripResult& trip = result.programs[0].round_trips[0];
  EXPECT_EQ(trip.request, "forth");
  EXPECT_EQ(trip.reply, "back");
  // The state goes first: 42 octets of UADP in a frame with 18 of Ethernet and VLAN and 4 of FCS, then the data behind
  // preamble and gap. forth: 20 + 4 + 20 = 44 octets, 66 in the frame; state 42, 64 in the frame; 8 of preamble each, a
  // gap of 12 between.
  const std::int64_t forth = 8'000 * ((8 + 18 + 42 + 4) + 12 + (8 + 18 + 44 + 4));
  // back: 20 + 4 + 24 = 48 octets; nothing else on the link then.
  const std::int64_t back = 8'000 * (8 + 18 + 48 + 4);
  const std::int64_t work = 30'000'000 + 3 * 2'000'000;
  ASSERT_TRUE(trip.time && trip.one_way);
  EXPECT_EQ(trip.time->min.ps(),
            10'000'000 + forth + 100'000 + 20'000'000 + work + 10'000'000 + back + 100'000 + 20'000'000);
  EXPECT_EQ(trip.time->max, trip.time->min);
  EXPECT_EQ(trip.one_way->max.ps(), 10'000'000 + forth + 100'000 + 20'000'000 + work);
  EXPECT_EQ(trip.count, result.streams[3].delivered);  // every request was answered, and no reply went out besides
  EXPECT_GT(trip.count, 80u);
  EXPECT_LE(result.streams[2].delivered - trip.count, 1u);
}

TEST(Replies, WithoutRepliesBothArePublishedEveryCycle) {
  const auto resolved = sound(pair(""));
  LiveRun run(*resolved);
  run.advance();
  const results::RunResult result = evaluation::evaluate(run, false);
  EXPECT_TRUE(result.programs[0].round_trips.empty());
  EXPECT_GT(result.streams[3].sent, 80u);
}

// Work that takes longer than the cycle: one after the other, and what is too much is lost, not kept.
TEST(Replies, WorkQueues) {
  const auto resolved =
      sound(pair(R"(, "replies": [{"to": "forth", "with": "back"}])", R"("processing": {"per_message": "1500us"})"));
  LiveRun run(*resolved);
  run.advance();
  const results::RunResult result = evaluation::evaluate(run, false);
  const results::RoundTripResult& trip = result.programs[0].round_trips[0];
  EXPECT_NEAR(static_cast<double>(trip.count), 86 / 1.5, 3);
  EXPECT_GT(trip.time->max, trip.time->min * 10);
}

TEST(Replies, WorkerLosesWhatIsTooMuch) {
  const auto resolved = sound(pair(R"(, "replies": [{"to": "forth", "with": "back"}])"));
  ReplyWorker worker(resolved->programs[0], 1, 1, "s/p");
  EXPECT_TRUE(worker.answers(0));
  EXPECT_FALSE(worker.answers(1));
  EXPECT_EQ(worker.take({0, 7}), sim::Duration::from_ps(36'000'000));
  for (std::uint16_t i = 0; i < 300; ++i) EXPECT_FALSE(worker.take({0, i}));
  EXPECT_EQ(worker.lost(), 45u);  // 256 wait
  const ReplyWorker::Done done = worker.done();
  EXPECT_EQ(done.request.sequence, 7);
  EXPECT_EQ(done.next, sim::Duration::from_ps(36'000'000));
  worker.forget();
  EXPECT_TRUE(worker.take({0, 1}));
}

TEST(Replies, MistakesAreTold) {
  const auto refused = [](const std::string& replies, const std::string& with) {
    const Loaded loaded = load(pair(R"(, "replies": )" + replies));
    EXPECT_FALSE(loaded.resolved) << replies;
    EXPECT_NE(loaded.diagnostics.to_text().find(with), std::string::npos) << loaded.diagnostics.to_text();
  };
  refused(R"([{"to": "fort", "with": "back"}])", "did you mean \"forth\"");
  refused(R"([{"to": "forth", "with": "forth"}])", "a reply to oneself");
  refused(R"([{"to": "forth", "with": "back"}, {"to": "back", "with": "forth"}])", "a reply to a reply");
  refused(R"([{"to": "forth", "with": "back"}, {"to": "forth", "with": "back"}])", "a reply to two things");
  const Loaded used =
      load(pair(R"(, "replies": [{"to": "forth", "with": "back"}])",
                R"("processing": {"per_field": {"fixed": "1us", "tail": {"from": "3us", "to": "2us"}}})"));
  EXPECT_FALSE(used.resolved);
}

TEST(Replies, ATailIsAsRareAsItSays) {
  const auto resolved = sound(pair(
      R"(, "replies": [{"to": "forth", "with": "back"}])",
      R"("processing": {"per_field": {"fixed": "1us", "tail": {"from": "2us", "to": "3us", "per_million": 250000}}})"));
  ReplyWorker worker(resolved->programs[0], 1, 1, "s/p");
  int rare = 0;
  for (int i = 0; i < 10'000; ++i) {
    const sim::Duration work = *worker.take({0, 1});
    EXPECT_GE(work.ps(), 3'000'000);
    EXPECT_LE(work.ps(), 9'000'000);
    if (work.ps() > 3'000'000) ++rare;
    worker.forget();
  }
  EXPECT_NEAR(rare, 2500, 200);  // four standard deviations are 173
}

}  // namespace
}  // namespace takt::scenario::test::replies_test
