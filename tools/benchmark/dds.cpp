// SPDX-License-Identifier: Apache-2.0
// A DDS writer and a reader in memory, as a line of JSON for tools/bench.
//
//   takt_bench_dds best-effort|reliable OCTETS SAMPLES   CPU time of a sample that is written, sent, received and taken
//
// reliable: KEEP_ALL with a HEARTBEAT on each sample and an ACKNACK back, the costliest way.
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

#include "dds/participant/participant.hpp"
#include "measure.hpp"

namespace {

using namespace takt;
using namespace takt::sim::literals;

dds::ParticipantConfig participant(std::uint8_t number) {
  dds::ParticipantConfig config;
  config.prefix.octets = {1, 0xFA, number};
  config.address = 0x0A000000u + number;
  config.timing.piggyback_interval = 0_ms;
  config.timing.heartbeat_response_delay = 0_ms;
  return config;
}

void carry(dds::Participant& from, dds::Participant& to, sim::LocalTime now) {
  while (const auto datagram = from.next_datagram()) to.receive(datagram->octets, {}, now);
  while (from.next_event()) {
  }
}

int run(bool reliable, std::size_t octets, long samples) {
  sim::LocalTime now = sim::LocalTime::from_ps(0);
  dds::Participant writing(participant(1), now);
  dds::Participant reading(participant(2), now);
  dds::WriterConfig writer_config;
  dds::ReaderConfig reader_config;
  writer_config.topic = reader_config.topic = "topic";
  writer_config.type = reader_config.type = "Type";
  writer_config.qos.reliability.kind = reader_config.qos.reliability.kind =
      reliable ? dds::ReliabilityKind::reliable : dds::ReliabilityKind::best_effort;
  writer_config.qos.history.kind = reader_config.qos.history.kind = dds::HistoryKind::keep_all;
  writer_config.qos.resource_limits.max_samples = 16;
  const dds::WriterHandle writer = *writing.create_writer(writer_config, now).handle;
  const dds::ReaderHandle reader = *reading.create_reader(reader_config, now).handle;
  writing.match(writer, reading.data_of(reader), now);
  reading.match(reader, writing.data_of(writer), now);
  std::vector<std::byte> payload(octets);
  long taken = 0;
  const double begin = benchmark::cpu_seconds();
  for (long i = 0; i < samples; ++i) {
    now += 1_us;
    if (writing.next_wake() <= now) writing.wake(now);
    if (reading.next_wake() <= now) reading.wake(now);
    if (writing.write(writer, dds::no_key, payload, now).verdict != dds::WriteVerdict::written) return 1;
    carry(writing, reading, now);
    carry(reading, writing, now);
    while (reading.take(reader, now)) ++taken;
  }
  const double seconds = benchmark::cpu_seconds() - begin;
  std::printf("{\"samples\": %ld, \"octets\": %zu, \"ns\": %.1f}\n", taken, octets,
              seconds / static_cast<double>(samples) * 1e9);
  return taken == samples ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view kind = argc > 1 ? argv[1] : "";
  if (argc == 4 && (kind == "best-effort" || kind == "reliable"))
    return run(kind == "reliable", static_cast<std::size_t>(std::atol(argv[2])), std::atol(argv[3]));
  std::fputs("usage: takt_bench_dds best-effort|reliable OCTETS SAMPLES\n", stderr);
  return 2;
}
