// SPDX-License-Identifier: Apache-2.0
// Words that a stranger forges, to the nodes of a group: of both variants, nested and with roles. Nobody crashes,
// everybody can be asked for status, statistics and the last line of its log after each word, and when the stranger is
// silent again a Start takes all to Running.
//
// The input: the kind of the group, then one operation after the other. A forged message is one that was heard before
// with other octets.
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "support/word_bench.hpp"

namespace {

using namespace takt;
using handshake::PublishedState;

constexpr std::array<const char*, 7> kinds = {"robust", "paper", "all-to-all",  "nested",
                                              "roles",  "two",   "nested-roles"};
constexpr int most_operations = 60;

class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}
  bool is_empty() const { return left_ == 0; }
  std::uint8_t next() {
    if (left_ == 0) return 0;
    --left_;
    return *data_++;
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

sim::Duration milliseconds(int count) { return sim::Duration::from_ps(1'000'000'000) * count; }

/// Sequence numbers a little and far ahead, and some octets of the fields replaced from a place on.
void forge(test::WordBench& bench, Input& input) {
  const auto heard = bench.heard();
  if (heard.empty()) return;
  constexpr std::array<std::uint16_t, 8> ahead = {0, 1, 1, 2, 100, 16384, 32768, 65535};
  const std::uint8_t which = input.next();
  std::vector<std::byte> message =
      test::WordBench::forged(heard[which % heard.size()], ahead[input.next() % ahead.size()]);
  for (std::uint8_t parts = static_cast<std::uint8_t>(1 + input.next() % 3); parts > 0; --parts) {
    std::size_t at = wire::fields_at + input.next() % 32U;
    for (std::uint8_t count = static_cast<std::uint8_t>(input.next() % 24); count > 0 && at < message.size(); --count)
      message[at++] = static_cast<std::byte>(input.next());
  }
  bench.say(message);
}

void operate(test::WordBench& bench, Input& input) {
  const std::uint8_t operation = input.next();
  const std::size_t node = input.next() % bench.size();
  const std::size_t seat = bench.seats(node) - 1;
  switch (operation % 8) {
    case 0:
      bench.call(node, program::methods[input.next() % program::methods.size()].method, seat);
      break;
    case 1:
      bench.finished(node, seat);
      break;
    case 2:
      bench.change(node, input.next() % 2 == 0 ? node::Membership::join : node::Membership::leave);
      break;
    case 3:
      bench.call(0, program::Method::Start);
      break;
    case 4:
      bench.run(milliseconds(1 + input.next() % 16));
      break;
    default:
      forge(bench, input);
  }
  if (bench.ask().empty()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  const std::string kind = kinds[input.next() % kinds.size()];
  test::WordBench bench(kind);
  bench.run(milliseconds(20));
  for (int operations = 0; operations < most_operations && !input.is_empty(); ++operations) operate(bench, input);
  if (kind == "paper") return 0;  // whose words say too little to tell a forged one from a late one
  for (std::size_t i = 1; i < bench.size(); ++i) bench.change(i, node::Membership::join);
  bench.run(milliseconds(100));
  // A Program that has finished, or is suspended, is halted first.
  if (!bench.all_in(PublishedState::Running) && !bench.all_in(PublishedState::Halted))
    bench.call(0, program::Method::Halt);
  bench.run(milliseconds(30));
  if (!bench.all_in(PublishedState::Running)) bench.call(0, program::Method::Start);
  bench.run(milliseconds(60));
  if (!bench.all_in(PublishedState::Running)) {
    std::fprintf(stderr, "not started:\n%s", bench.ask().c_str());
    std::abort();
  }
  return 0;
}
