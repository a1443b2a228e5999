// SPDX-License-Identifier: Apache-2.0
// Damaged messages: nothing breaks, and sound ones go on being understood.
#include <gtest/gtest.h>

#include "sim/random.hpp"
#include "world.hpp"

namespace takt::dds {
namespace {

using namespace sim::literals;

TEST(Hostile, DamagedMessagesBreakNothing) {
  sim::RandomStream chance(1, "hostile", "octets");
  World world;
  Participant& one = world.add();
  Participant& two = world.add();
  WriterConfig writing = writer_config();
  writing.qos.durability.kind = DurabilityKind::transient_local;
  writing.qos.history.depth = 8;
  ReaderConfig reading = reader_config();
  reading.qos.durability.kind = DurabilityKind::transient_local;
  reading.qos.resource_limits.max_samples = 5;
  const WriterHandle writer = *one.create_writer(writing, start).handle;
  const ReaderHandle reader = *two.create_reader(reading, start).handle;
  world.match(one, writer, two, reader);
  for (std::uint32_t i = 1; i <= 3000; ++i) {
    one.write(writer, no_key, payload_of(i, i % 5 == 0 ? 4000 : 40), world.now);
    world.run_for(sim::Duration::from_ps(static_cast<std::int64_t>(chance.below(900'000'000'000))));
    const std::vector<Sent> log = std::exchange(world.log, {});
    for (const Sent& sent : log) {
      if (chance.below(4) != 0) continue;
      std::vector<std::byte> octets = sent.octets;
      // Behind the header, so that it still is of somebody who is known.
      for (std::uint64_t n = 1 + chance.below(4); n > 0; --n)
        octets[20 + chance.below(octets.size() - 20)] = static_cast<std::byte>(chance.below(256));
      if (chance.below(4) == 0) octets.resize(20 + chance.below(octets.size() - 20));
      for (const auto& participant : world.participants) participant->receive(octets, {}, world.now);
    }
    if (chance.below(2) == 0) two.take(reader, world.now);
  }
  EXPECT_LE(two.reader(reader).rtps.history().size(), 5u);
  EXPECT_GT(two.reader(reader).rtps.duplicates(), 100u);
}

}  // namespace
}  // namespace takt::dds
