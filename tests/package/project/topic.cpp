// SPDX-License-Identifier: Apache-2.0
// A sample goes from one DDS participant to another, matched by hand, through memory.
#include "dds/participant/participant.hpp"

int main() {
  using namespace takt;
  const sim::LocalTime now;
  dds::ParticipantConfig config;
  config.prefix.octets[0] = 1;
  dds::Participant here(config, now);
  config.prefix.octets[0] = 2;
  config.participant = 1;
  dds::Participant there(config, now);
  dds::WriterConfig writing;
  writing.topic = "speed";
  writing.type = "Speed";
  dds::ReaderConfig reading;
  reading.topic = "speed";
  reading.type = "Speed";
  const auto writer = here.create_writer(writing, now);
  const auto reader = there.create_reader(reading, now);
  if (!writer || !reader) return 1;
  here.match(*writer.handle, there.data_of(*reader.handle), now);
  there.match(*reader.handle, here.data_of(*writer.handle), now);
  const std::byte sample[]{std::byte{0},  std::byte{1}, std::byte{0}, std::byte{0},
                           std::byte{42}, std::byte{0}, std::byte{0}, std::byte{0}};  // CDR, little-endian
  here.write(*writer.handle, dds::no_key, sample, now);
  while (const auto datagram = here.next_datagram())
    there.receive(datagram->octets, datagram->destinations.front(), now);
  const auto taken = there.take(*reader.handle, now);
  return taken && taken->payload.at(4) == std::byte{42} ? 0 : 2;
}
