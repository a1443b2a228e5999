// SPDX-License-Identifier: Apache-2.0
// Reliable delivery on a medium that loses, duplicates and reorders: every sample once and in order.
// TAKT_DELIVERIES=10000 draws so many cases.
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cstdlib>

#include "sim/random.hpp"
#include "tests/support/case_count.hpp"
#include "world.hpp"

namespace takt::dds {
namespace {

using namespace sim::literals;

/// Draws for each copy of each message.
World::Medium bad_medium(sim::RandomStream& chance, std::uint64_t lost_percent, std::uint64_t duplicated_percent) {
  return [&chance, lost_percent, duplicated_percent](const Sent&) {
    std::vector<sim::Duration> delays;
    const auto delay = [&] {
      return sim::Duration::from_ps(static_cast<std::int64_t>(50'000'000 + chance.below(3'000'000'000)));
    };  // 50 us to 3 ms
    if (chance.below(100) >= lost_percent) delays.push_back(delay());
    if (chance.below(100) < duplicated_percent) delays.push_back(delay());
    return delays;
  };
}

struct Case {
  std::size_t writers = 1;
  std::size_t readers = 1;
  std::size_t samples = 20;  ///< of each writer
  std::int32_t writer_limit = 4;
  std::int32_t reader_limit = unlimited;
  std::size_t payload = 12;  ///< octets at most
  std::uint64_t lost_percent = 20;
  std::uint64_t duplicated_percent = 20;
  std::size_t profile = 1;
  bool asynchronous = false;
  bool multicast = false;
  std::uint64_t seed = 1;
};

/// Writers write as fast as they may; readers take when they like. What each reader has taken of each writer.
std::vector<std::map<Guid, std::vector<std::uint32_t>>> deliver(const Case& c, bool& finished) {
  sim::RandomStream chance(c.seed, "medium", "delivery");
  World world;
  world.keeps_log = false;
  world.medium = bad_medium(chance, c.lost_percent, c.duplicated_percent);
  std::vector<std::pair<Participant*, WriterHandle>> writers;
  std::vector<std::pair<Participant*, ReaderHandle>> readers;
  const auto config = [&](std::size_t number) {
    ParticipantConfig made = World::config(static_cast<std::uint8_t>(number));
    made.timing = timing::all[c.profile];
    if (c.multicast) made.multicast_group = 0xEFFF0002;
    made.flow_controllers = {{"slow", FlowScheduler::round_robin, 3000, 1_ms}};
    return made;
  };
  for (std::size_t i = 0; i < c.writers; ++i) {
    Participant& participant = world.add(config(world.participants.size() + 1));
    WriterConfig made = writer_config();
    made.qos.history.kind = HistoryKind::keep_all;
    made.qos.resource_limits.max_samples = c.writer_limit;
    made.qos.reliability.max_blocking_time = infinite;
    made.asynchronous = c.asynchronous;
    if (c.asynchronous) made.flow_controller = "slow";
    const Created<WriterHandle> writer = participant.create_writer(made, world.now);
    writers.emplace_back(&participant, *writer.handle);
  }
  for (std::size_t i = 0; i < c.readers; ++i) {
    Participant& participant = world.add(config(world.participants.size() + 1));
    ReaderConfig made = reader_config();
    made.qos.resource_limits.max_samples = c.reader_limit;
    const Created<ReaderHandle> reader = participant.create_reader(made, world.now);
    readers.emplace_back(&participant, *reader.handle);
  }
  for (auto& [writing, writer] : writers)
    for (auto& [reading, reader] : readers) world.match(*writing, writer, *reading, reader);

  std::vector<std::uint32_t> written(c.writers);
  std::vector<std::map<Guid, std::vector<std::uint32_t>>> taken(c.readers);
  const auto is_finished = [&] {
    for (const auto& of_reader : taken) {
      if (of_reader.size() < c.writers) return false;
      for (const auto& [guid, values] : of_reader)
        if (values.size() < c.samples) return false;
    }
    return true;
  };
  std::vector<bool> may_write(c.writers, true);
  const sim::LocalTime end = start + 4000_s;
  while (!(finished = is_finished()) && world.now < end) {
    for (std::size_t i = 0; i < c.writers; ++i) {
      while (may_write[i] && written[i] < c.samples) {
        const std::vector<std::byte> payload = payload_of(written[i], rounded_up(8 + chance.below(c.payload), 4));
        const WriteResult result = writers[i].first->write(writers[i].second, no_key, payload, world.now);
        if (result.verdict == WriteVerdict::written)
          ++written[i];
        else
          may_write[i] = false;
        if (chance.below(3) == 0) break;
      }
    }
    world.collect();
    const sim::Duration pause = sim::Duration::from_ps(static_cast<std::int64_t>(chance.below(5'000'000'000)));
    world.run_for(pause);
    for (const auto& [who, event] : world.events)
      if (event.kind == EventKind::writable) may_write[who] = true;
    world.events.clear();
    for (std::size_t i = 0; i < c.readers; ++i) {
      for (std::uint64_t n = chance.below(4); n > 0; --n) {
        const std::optional<Sample> sample = readers[i].first->take(readers[i].second, world.now);
        if (sample) taken[i][sample->info.writer].push_back(value_of(*sample).value_or(0xDEAD));
      }
    }
  }
  return taken;
}

void every_sample_once_and_in_order(const Case& c) {
  bool finished = false;
  const auto taken = deliver(c, finished);
  RC_ASSERT(finished);
  std::vector<std::uint32_t> all(c.samples);
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  for (const auto& of_reader : taken) {
    RC_ASSERT(of_reader.size() == c.writers);
    for (const auto& [writer, values] : of_reader) RC_ASSERT(values == all);
  }
}

void check(const char* what, int count, const std::function<void()>& property) {
  rc::detail::TestParams params = rc::detail::configuration().testParams;
  params.maxSuccess = static_cast<int>(support::case_count("TAKT_DELIVERIES", static_cast<std::uint64_t>(count)));
  rc::detail::TestMetadata metadata;
  metadata.id = what;
  const rc::detail::TestResult result = rc::detail::checkTestable(property, metadata, params);
  if (!result.template is<rc::detail::SuccessResult>()) {
    std::ostringstream text;
    rc::detail::printResultMessage(result, text);
    FAIL() << text.str();
  }
}

Case any_case() {
  Case c;
  c.samples = 12;
  c.writer_limit = *rc::gen::inRange(1, 7);
  c.reader_limit = *rc::gen::element(unlimited, 1, 3);
  c.lost_percent = *rc::gen::inRange<std::uint64_t>(0, 45);
  c.duplicated_percent = *rc::gen::inRange<std::uint64_t>(0, 45);
  c.profile = *rc::gen::inRange<std::size_t>(0, 3);
  c.asynchronous = *rc::gen::arbitrary<bool>();
  c.multicast = *rc::gen::arbitrary<bool>();
  c.seed = *rc::gen::inRange<std::uint64_t>(0, 1'000'000'000);
  return c;
}

TEST(Delivery, OfOneWriterToOneReader) {
  check("one to one", 200, [] { every_sample_once_and_in_order(any_case()); });
}

TEST(Delivery, OfSamplesInFragments) {
  check("fragments", 60, [] {
    Case c = any_case();
    c.payload = 6000;
    every_sample_once_and_in_order(c);
  });
}

TEST(Delivery, OfSeveralWritersToSeveralReaders) {
  check("several", 60, [] {
    Case c = any_case();
    c.writers = *rc::gen::inRange<std::size_t>(1, 4);
    c.readers = *rc::gen::inRange<std::size_t>(1, 4);
    c.payload = *rc::gen::element<std::size_t>(12, 12, 4000);
    every_sample_once_and_in_order(c);
  });
}

TEST(Delivery, IsTheSameEveryTime) {
  Case c;
  c.writers = 2;
  c.readers = 3;
  c.payload = 4000;
  bool finished = false;
  EXPECT_EQ(deliver(c, finished), deliver(c, finished));
  EXPECT_TRUE(finished);
}

}  // namespace
}  // namespace takt::dds
