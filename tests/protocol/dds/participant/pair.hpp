// SPDX-License-Identifier: Apache-2.0
// Pair: a writer and a reader of two participants, matched.
#pragma once

#include <gtest/gtest.h>

#include "world.hpp"

namespace takt::dds {

struct Pair {
  explicit Pair(const WriterConfig& writing_config = writer_config(),
                const ReaderConfig& reading_config = reader_config(), const TimingProfile& timing = timing::fast_dds,
                std::size_t max_message = 1472)
      : Pair(writing_config, reading_config, with(timing, max_message)) {}
  Pair(const WriterConfig& writing_config, const ReaderConfig& reading_config, const ParticipantConfig& common) {
    ParticipantConfig config = common;
    config.prefix = World::config(1).prefix;
    config.address = World::config(1).address;
    writing = &world.add(config);
    config.prefix = World::config(2).prefix;
    config.address = World::config(2).address;
    reading = &world.add(config);
    writer = *writing->create_writer(writing_config, world.now).handle;
    reader = *reading->create_reader(reading_config, world.now).handle;
    world.match(*writing, writer, *reading, reader);
  }
  static ParticipantConfig with(const TimingProfile& timing, std::size_t max_message) {
    ParticipantConfig config = World::config(1);
    config.timing = timing;
    config.max_message = max_message;
    return config;
  }

  WriteResult write(std::uint32_t value, std::size_t size = 12, const InstanceKey& key = no_key) {
    const WriteResult result = writing->write(writer, key, payload_of(value, size), world.now);
    world.collect();
    return result;
  }
  std::vector<std::uint32_t> take() {
    std::vector<std::uint32_t> values = drain_values(*reading, reader, world.now);
    world.collect();
    return values;
  }
  /// What the writing side has sent since the last call.
  std::vector<std::string> sent() { return sent_by(0); }
  std::vector<std::string> sent_by(std::size_t participant) {
    std::vector<std::string> kinds;
    for (; seen[participant] < world.log.size(); ++seen[participant])
      if (world.log[seen[participant]].from == participant) kinds.push_back(world.log[seen[participant]].kinds());
    return kinds;
  }

  World world;
  Participant* writing = nullptr;
  Participant* reading = nullptr;
  WriterHandle writer;
  ReaderHandle reader;
  std::array<std::size_t, 2> seen{};
};

}  // namespace takt::dds
