// SPDX-License-Identifier: Apache-2.0
// Any octets as a message of a Program: neither crash nor hang; what is understood is what its encoder writes again.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "wire/program_format.hpp"

namespace {

using namespace takt;

wire::ProgramFormat format_of(handshake::Variant variant) {
  wire::ProgramShape shape;
  shape.name = "cell";
  shape.variant = variant;
  shape.participants = {"plc", "left", "right"};
  shape.data_sets = {{"targets", 0, {{"x", uadp::BuiltInType::Double, 2}, {"on", uadp::BuiltInType::Boolean, 1}}},
                     {"actual", 1, {{"x", uadp::BuiltInType::Int16, 1}}}};
  shape.first_publisher_id = 100;
  return wire::ProgramFormat(shape);
}

[[noreturn]] void fail(const char* what) {
  std::fprintf(stderr, "%s\n", what);
  std::abort();
}

/// Where a message holds what decoding gives: all but the sequence number of the group and the status, which nobody
/// reads.
bool is_unread(std::size_t octet) { return octet == 13 || octet == 14 || octet == 18 || octet == 19; }

/// The same state with other octets, as decoding has it: one is known again by its octets only if it says the same.
void check_known(const wire::ProgramFormat& format, uadp::Octets octets, const handshake::Word& word) {
  wire::KnownState known;
  known.note(octets, word);
  std::vector<std::byte> other(octets.begin(), octets.end());
  for (std::byte& octet : other) {
    octet ^= std::byte{1};
    if (known.is_repeated_by(other)) {
      const auto message = format.decode(other);
      const auto sender = format.sender_of(other);
      if (!message || !sender ||
          std::get<wire::StateMessage>(*message) != known.message(static_cast<std::uint8_t>(*sender), other))
        fail("known as what it is not");
    }
    octet ^= std::byte{1};
  }
}

void check(const wire::ProgramFormat& format, uadp::Octets octets) {
  const auto message = format.decode(octets);
  if (!message) return;
  std::vector<std::byte> again(format.longest());
  const uadp::Octets written = std::visit([&](const auto& m) { return format.encode(m, again); }, *message);
  if (written.size() > octets.size()) fail("longer than it came");
  for (std::size_t i = 0; i < written.size(); ++i)
    if (!is_unread(i) && written[i] != octets[i]) fail("another message after a round trip");
  if (const auto* const state = std::get_if<wire::StateMessage>(&*message)) check_known(format, octets, state->word);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const wire::ProgramFormat robust = format_of(handshake::Variant::robust);
  static const wire::ProgramFormat paper = format_of(handshake::Variant::paper);
  const std::vector<std::byte> exact(reinterpret_cast<const std::byte*>(data),
                                     reinterpret_cast<const std::byte*>(data) + size);
  check(robust, exact);
  check(paper, exact);
  return 0;
}
