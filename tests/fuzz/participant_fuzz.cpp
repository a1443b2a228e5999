// SPDX-License-Identifier: Apache-2.0
// Any messages to a DDS participant with discovery, a writer and a reader: neither crash nor hang nor growth; what it
// says itself stays sound.
//
// The input is messages, each behind its length in two octets, little-endian.
#include <vector>

#include "dds/message/decoder.hpp"
#include "dds/participant/world.hpp"
#include "sim/check.hpp"

namespace {

using namespace takt;

constexpr std::int32_t most_samples = 5;
constexpr int most_wakes = 10'000;  // of a second and a few messages: what needs more does not end

class Target {
 public:
  Target() : participant_(config(), dds::start) {
    dds::WriterConfig writing = dds::writer_config();
    writing.qos.durability.kind = dds::DurabilityKind::transient_local;
    writer_ = *participant_.create_writer(writing, dds::start).handle;
    dds::ReaderConfig reading = dds::reader_config();
    reading.qos.durability.kind = dds::DurabilityKind::transient_local;
    reading.qos.resource_limits.max_samples = most_samples;
    reader_ = *participant_.create_reader(reading, dds::start).handle;
    participant_.write(writer_, dds::no_key, dds::payload_of(1, 4000), dds::start);
  }

  void receive(dds::Octets message) {
    participant_.receive(message, dds::Locator::udp_v4(0x0A000002, 7411), now_);
    speak();
    pass(sim::Duration::from_ps(50'000'000'000));
    TAKT_CHECK(participant_.reader(reader_).rtps.history().size() <= most_samples,
               "a reader holds what its limits say");
    if (++received_ % 3 == 0) participant_.take(reader_, now_);
  }
  void pass(sim::Duration duration) {
    const sim::LocalTime end = now_ + duration;
    while (participant_.next_wake() <= end) {
      TAKT_CHECK(++wakes_ < most_wakes, "time passes");
      now_ = std::max(now_, participant_.next_wake());
      participant_.wake(now_);
      speak();
    }
    now_ = end;
  }

 private:
  static dds::ParticipantConfig config() {
    dds::ParticipantConfig config = dds::World::config(1);
    config.discovery.emplace();
    return config;
  }
  void speak() {
    while (const auto datagram = participant_.next_datagram()) {
      dds::MessageDecoder decoder(datagram->octets);
      while (decoder.next()) continue;
      TAKT_CHECK(decoder.verdict() == dds::MessageStatus::ok && decoder.skipped() == 0, "what is said is sound");
    }
    while (participant_.next_event()) continue;
  }

  dds::Participant participant_;
  dds::WriterHandle writer_;
  dds::ReaderHandle reader_;
  sim::LocalTime now_ = dds::start;
  int received_ = 0;
  int wakes_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Target target;
  dds::Octets left = std::as_bytes(std::span(data, size));
  for (int messages = 0; left.size() >= 2 && messages < 100; ++messages) {
    const std::size_t wanted = std::to_integer<std::size_t>(left[0]) + 256 * std::to_integer<std::size_t>(left[1]);
    left = left.subspan(2);
    const std::vector<std::byte> message(left.begin(),
                                         left.begin() + static_cast<std::ptrdiff_t>(std::min(wanted, left.size())));
    left = left.subspan(message.size());
    target.receive(message);
  }
  target.pass(sim::Duration::from_ps(1'000'000'000'000));
  return 0;
}
