// Any octets as an RTPS message: neither crash nor hang; what is understood survives a round trip.
#include <vector>

#include "dds/message/cdr_reader.hpp"
#include "dds/message/decoder.hpp"
#include "dds/message/encoder.hpp"
#include "sim/check.hpp"

namespace {

using namespace takt;

void read_payload(dds::Octets payload) {
  dds::CdrReader reader(payload);
  reader.get_string();
  reader.get_sequence<double>();
  while (!reader.failed() && reader.left() != 0) reader.get<std::uint16_t>();
}

/// The submessages that were understood, written again; nothing if they do not fit.
std::vector<std::byte> canonical(dds::Octets octets) {
  std::vector<std::byte> buffer(1U << 18);
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
  if (once.empty() || dds::MessageDecoder(std::as_bytes(std::span(data, size))).verdict() != dds::Verdict::ok) return 0;
  dds::MessageDecoder again(once);
  while (again.next()) continue;
  TAKT_CHECK(again.verdict() == dds::Verdict::ok && again.skipped() == 0, "what was understood is sound when written again");
  TAKT_CHECK(canonical(once) == once, "the canonical form is its own canonical form");
  return 0;
}
