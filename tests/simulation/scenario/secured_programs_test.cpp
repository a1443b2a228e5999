// SPDX-License-Identifier: Apache-2.0
// Programs whose messages are secured: their octets and times to the picosecond, and what is refused.
#include "evaluation/evaluate.hpp"
#include "plant/protocol.hpp"
#include "scenario/programs/sealed_messages.hpp"
#include "support.hpp"
#include "wire/program_format.hpp"

namespace takt::scenario::test::secured_programs_test {
namespace {

/// A request and its answer between two hosts; what securing takes of each.
std::string pair(const std::string& security, const std::string& cryptography = "") {
  const auto host = [&](const std::string& name) {
    return "\"" + name + R"(": {"kind": "host")" + cryptography + R"(, "processing": {"per_message": "30us"}})";
  };
  return R"({"name": "t", "duration": "100ms", "network": {"nodes": {)" + host("m") + ", " + host("s") +
         R"(}, "links": [{"ends": ["m", "s"], "delay": "100ns"}]},
 "programs": [{"name": "p", "master": "m", "slaves": ["s"], "cycle": "1ms")" +
         security + R"(, "process_data": [
   {"name": "forth", "from": "m", "fields": {"a": {"type": "Double", "count": 2}, "b": "Int32"}},
   {"name": "back", "from": "s", "fields": {"a": {"type": "Double", "count": 3}}}], "replies": [{"to": "forth", "with": "back"}]}],
 "script": [{"at": "10.5ms", "program": "p", "call": "Start"}]})";
}

TEST(SecuredPrograms, RoundTripToThePicosecond) {
  constexpr std::int64_t seal = 700'000;
  constexpr std::int64_t open = 900'000;
  for (const auto& [security, cryptography, added, time] :
       {std::tuple("", "", 0, 0), std::tuple(R"(, "security": "sign")", "", 46, 0),
        std::tuple(R"(, "security": {"mode": "sign-and-encrypt", "policy": "aes256-ctr"})",
                   R"(, "cryptography": {"seal": "700ns", "open": "900ns"})", 46, 1)}) {
    SCOPED_TRACE(security);
    const auto resolved = sound(pair(security, cryptography));
    LiveRun run(*resolved);
    run.advance();
    const results::RunResult result = evaluation::evaluate(run, false);
    ASSERT_EQ(result.programs[0].round_trips.size(), 1u);
    const results::RoundTripResult& trip = result.programs[0].round_trips[0];
    // As in Replies.RoundTripToThePicosecond: 42, 44 and 48 octets of UADP, and what security adds to each.
    const std::int64_t forth = 8'000 * ((8 + 18 + 42 + 4 + added) + 12 + (8 + 18 + 44 + 4 + added));
    const std::int64_t back = 8'000 * (8 + 18 + 48 + 4 + added);
    ASSERT_TRUE(trip.time && trip.one_way);
    EXPECT_EQ(trip.one_way->max.ps(), time * (seal + open) + forth + 100'000 + 30'000'000);
    EXPECT_EQ(trip.time->min.ps(), 2 * time * (seal + open) + forth + back + 200'000 + 30'000'000);
    EXPECT_EQ(trip.time->max, trip.time->min);
    EXPECT_GT(trip.count, 80u);
  }
}

// On a thread of 10 us each that is busy with nothing else. Of the state and the data that the master sends in a turn
// the data wait for the state: on the wire, which both come to by then, and at the slave, whose thread opens and hears
// the state first. So sealing the state, the 46 octets that the state has more, and opening both are what securing
// costs.
TEST(SecuredPrograms, OnAProcessorTheyOccupyTheThread) {
  const std::string processor =
      R"(, "cpu": {"threads": [{"name": "t", "priority": 1, "execution": "10us", "runs": ["p"]}]})";
  const auto one_way = [&](const std::string& security, const std::string& cryptography) {
    const auto resolved = sound(pair(security, cryptography + processor));
    LiveRun run(*resolved);
    run.advance();
    const results::RunResult result = evaluation::evaluate(run, false);
    const results::RoundTripResult& trip = result.programs.at(0).round_trips.at(0);
    EXPECT_GT(trip.count, 80u);
    return trip.one_way->max.ps();
  };
  const std::int64_t clear = one_way("", "");
  EXPECT_EQ(one_way(R"(, "security": "sign")", "") - clear, 46 * 8'000);
  EXPECT_EQ(one_way(R"(, "security": "sign")", R"(, "cryptography": {"seal": "700ns", "open": "900ns"})") - clear,
            700'000 + 46 * 8'000 + 2 * 900'000);
}

// What is on the wire is what a node sends: as long, and without a readable word.
TEST(SecuredPrograms, StreamsAreAsLongAsSealedMessages) {
  const auto resolved = sound(pair(R"(, "security": {"policy": "aes256-ctr"})"));
  const ResolvedProgram& program = resolved->programs[0];
  const wire::ProgramFormat format(plant::shape_of(*program.description, program.first_publisher_id));
  SealedMessages sends(*program.description->security, "p", 1, 4);
  SealedMessages hears(*program.description->security, "p", 2, 4);
  std::vector<std::byte> room(format.longest());
  const wire::StateMessage message{0, 7, {1, handshake::PublishedState::Halted, {}, 0}};
  const uadp::Octets clear = format.encode(message, room);
  const security::Octets sealed = sends.seal(clear);
  EXPECT_EQ(sealed.size(), resolved->streams[program.members[0].state.value].largest_payload.count);
  EXPECT_FALSE(format.decode(sealed).has_value());
  const auto opened = hears.open(sealed);
  ASSERT_TRUE(opened.has_value());
  EXPECT_TRUE(std::ranges::equal(*opened, clear));
  EXPECT_FALSE(hears.open(sealed).has_value()) << "once";
  hears.restart();
  EXPECT_FALSE(hears.open(sealed).has_value()) << "windows outlive a restart";
  sends.restart();
  EXPECT_TRUE(hears.open(sends.seal(clear)).has_value()) << "another life is heard at once";
}

// A member that crashes and comes back is heard, and what was being opened is lost with it.
TEST(SecuredPrograms, ACrashIsSurvived) {
  const std::string text = pair(R"(, "security": {})", R"(, "cryptography": {"seal": "5us", "open": "400us"})");
  const auto resolved = sound(
      text.substr(0, text.size() - 2) +
      R"(, {"at": "60ms", "program": "p", "call": "Start"}], "faults": [{"kind": "crash", "node": "s", "at": "30.1ms", "for": "100us"}]})");
  LiveRun run(*resolved);
  run.advance();
  EXPECT_EQ(run.state(0, 0), handshake::PublishedState::Running);
  EXPECT_EQ(run.state(0, 1), handshake::PublishedState::Running);
}

}  // namespace
}  // namespace takt::scenario::test::secured_programs_test
