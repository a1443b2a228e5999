// SPDX-License-Identifier: Apache-2.0
// Any octets as an RTPS message: neither crash nor hang; what is understood survives a round trip.
#include <vector>

#include "dds/discovery/data.hpp"
#include "dds/message/cdr_reader.hpp"
#include "dds/message/decoder.hpp"
#include "dds/message/encoder.hpp"
#include "sim/check.hpp"

namespace {

using namespace takt;

/// What was understood survives a round trip, but for the rounding of durations, which the first one does.
template <class Data>
void try_discovery(dds::Octets payload) {
  static std::vector<std::byte> buffer(1U << 17);  // not made anew for each input, which took most of the time
  static std::vector<std::byte> other(1U << 17);
  Data first, second, third;
  if (decode(payload, first) != dds::DataVerdict::ok) return;
  const dds::Octets once = encode(buffer, first);
  if (once.empty()) return;
  TAKT_CHECK(decode(once, second) == dds::DataVerdict::ok, "what was understood is sound when written again");
  const dds::Octets twice = encode(other, second);
  TAKT_CHECK(decode(twice, third) == dds::DataVerdict::ok && third == second, "a value survives");
}

void read_payload(dds::Octets payload) {
  try_discovery<dds::ParticipantData>(payload);
  try_discovery<dds::PublicationData>(payload);
  try_discovery<dds::SubscriptionData>(payload);
  try_discovery<dds::ParticipantMessageData>(payload);
  dds::CdrReader reader(payload);
  reader.get_string();
  reader.get_sequence<double>();
  while (!reader.failed() && reader.left() != 0) reader.get<std::uint16_t>();
}

/// The submessages that were understood, written again; nothing if they do not fit.
std::vector<std::byte> canonical(dds::Octets octets) {
  static std::vector<std::byte> buffer(1U << 18);
  dds::MessageDecoder decoder(octets);
  dds::MessageEncoder encoder(buffer, decoder.header());
  while (decoder.next()) {
    if (const auto* const data = std::get_if<dds::Data>(&decoder.submessage())) read_payload(data->payload);
    if (!encoder.add(decoder.submessage())) return {};
  }
  return {encoder.message().begin(), encoder.message().end()};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::vector<std::byte> once = canonical(std::as_bytes(std::span(data, size)));
  if (once.empty() || dds::MessageDecoder(std::as_bytes(std::span(data, size))).verdict() != dds::MessageStatus::ok)
    return 0;
  dds::MessageDecoder again(once);
  while (again.next()) continue;
  TAKT_CHECK(again.verdict() == dds::MessageStatus::ok && again.skipped() == 0,
             "what was understood is sound when written again");
  TAKT_CHECK(canonical(once) == once, "the canonical form is its own canonical form");
  return 0;
}
