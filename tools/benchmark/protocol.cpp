// SPDX-License-Identifier: Apache-2.0
// The hot path of protocol code, as lines of JSON for tools/bench.
//
//   takt_bench_protocol uadp ROUNDS              CPU time of encode + decode, and of what cannot be spared
//   takt_bench_protocol handshake PEERS STEPS    received words at a master; counted by callgrind
//   takt_bench_protocol changes PEERS ROUNDS     start, suspend, resume, halt of a group; counted by callgrind
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <vector>

#include "handshake/participant.hpp"
#include "measure.hpp"
#include "uadp/periodic_fixed.hpp"
#include "uadp/value.hpp"

namespace {

using namespace takt;

constexpr std::size_t doubles = 20;

struct Values {
  std::int32_t state = 0;
  std::array<double, doubles> axes{};
};

/// The optimiser neither knows what is in memory behind this nor may leave out what was written before.
void touch(void* memory) { asm volatile("" : : "g"(memory) : "memory"); }

uadp::PeriodicFixedLayout layout() {
  std::vector<uadp::RawField> fields = {{uadp::BuiltInType::Int32}};
  fields.insert(fields.end(), doubles, {uadp::BuiltInType::Double});
  return uadp::PeriodicFixedLayout(
      {uadp::PublisherId::uint16(100), 1, 0x2F0E1A00, 1, {uadp::RawLayout(std::move(fields))}});
}

[[gnu::noinline]] void encode(const uadp::PeriodicFixedLayout& layout, const Values& values, std::uint16_t number,
                              std::span<std::byte> target) {
  layout.start(target, number);
  layout.set_header(target, 0, number);
  uadp::store_value(target.data() + layout.field_offset(0, 0), values.state);
  layout.store_values(target, 0, 1, std::span(values.axes));
}

[[gnu::noinline]] bool decode(const uadp::PeriodicFixedLayout& layout, uadp::Octets octets, std::uint16_t number,
                              Values& values) {
  if (!layout.matches(octets) || layout.sequence_number(octets, 0) != number) return false;
  values.state = uadp::load_value<std::int32_t>(octets.data() + layout.field_offset(0, 0));
  layout.load_values(octets, 0, 1, std::span(values.axes));
  return true;
}

/// What no codec can spare: the octets once, and each field from where it stands.
[[gnu::noinline]] void copy_and_load(const std::byte* from, std::byte* to, std::size_t octets, Values& values) {
  std::memcpy(to, from, octets);
  touch(to);
  std::memcpy(&values.state, to + 20, sizeof values.state);
  for (std::size_t i = 0; i < doubles; ++i) std::memcpy(&values.axes[i], to + 24 + 8 * i, sizeof(double));
}

int run_uadp(long rounds) {
  const uadp::PeriodicFixedLayout fixed = layout();
  std::vector<std::byte> message(fixed.size());
  std::vector<std::byte> copy(fixed.size());
  Values values;
  for (std::size_t i = 0; i < doubles; ++i) values.axes[i] = 0.5 * static_cast<double>(i);
  Values received;
  double codec = 0;
  double bare = 0;
  constexpr long slices = 20;  // by turns, so that a change of the CPU's speed meets both
  for (long slice = 0; slice < slices; ++slice) {
    double begin = benchmark::cpu_seconds();
    for (long i = 0; i < rounds / slices; ++i) {
      encode(fixed, values, static_cast<std::uint16_t>(i), message);
      touch(message.data());
      if (!decode(fixed, message, static_cast<std::uint16_t>(i), received)) return 1;
      touch(&received);
    }
    codec += benchmark::cpu_seconds() - begin;
    begin = benchmark::cpu_seconds();
    for (long i = 0; i < rounds / slices; ++i) {
      copy_and_load(message.data(), copy.data(), message.size(), received);
      touch(&received);
    }
    bare += benchmark::cpu_seconds() - begin;
  }
  std::printf("{\"octets\": %zu, \"codec_ns\": %.3f, \"copy_ns\": %.3f}\n", message.size(),
              codec / static_cast<double>(rounds) * 1e9, bare / static_cast<double>(rounds) * 1e9);
  return 0;
}

handshake::Config config(std::size_t index, std::size_t slaves) {
  handshake::Config made;
  made.role = index == 0 ? handshake::Role::master : handshake::Role::slave;
  made.index = static_cast<std::uint8_t>(index);
  made.slaves = static_cast<std::uint8_t>(slaves);
  made.incarnation = 7;
  return made;
}

/// A group in memory; counts how many peers its steps looked at.
struct Group {
  explicit Group(std::size_t slaves) {
    for (std::size_t p = 0; p <= slaves; ++p) participants.emplace_back(config(p, slaves));
  }

  void step(std::size_t participant, const handshake::Input& input) {
    const handshake::Intent before = participants[participant].intent();
    const handshake::Outputs outputs = participants[participant].step(input);
    // A new intent sorts all peers anew; otherwise a word concerns its sender, and nothing else concerns anybody.
    looked_at += participants[participant].intent() != before ? participants[participant].peer_count() : 1;
    ++steps;
    if (outputs.begin_initialisation) step(participant, handshake::Input::initialised(outputs.initialisation_run));
  }
  /// Everybody hears the others of the star once.
  void exchange() {
    ++sequence;
    for (std::size_t s = 1; s < participants.size(); ++s)
      step(0, handshake::Input::received(s - 1, participants[s].word(), sequence));
    for (std::size_t s = 1; s < participants.size(); ++s)
      step(s, handshake::Input::received(0, participants[0].word(), sequence));
  }
  void call(std::size_t participant, program::Method method) {
    step(participant, handshake::Input::command(method));
    for (int i = 0; i < 6; ++i) exchange();
  }

  std::vector<handshake::Participant<64>> participants;
  std::uint16_t sequence = 0;
  std::uint64_t steps = 0;
  std::uint64_t looked_at = 0;
};

int run_handshake(std::size_t peers, long steps) {
  Group group(peers);
  group.exchange();
  group.call(0, program::Method::Start);
  if (group.participants[0].state() != handshake::PublishedState::Running) return 1;
  std::vector<handshake::Word> words;
  for (std::size_t s = 1; s <= peers; ++s) words.push_back(group.participants[s].word());
  std::uint64_t taken = 0;
  for (long i = 0; i < steps; ++i) {
    const std::size_t peer = static_cast<std::size_t>(i) % peers;
    if (peer == 0) ++group.sequence;
    const handshake::Outputs outputs =
        group.participants[0].step(handshake::Input::received(peer, words[peer], group.sequence));
    taken += outputs.ignored ? 0 : 1;
  }
  std::printf("{\"steps\": %ld, \"looked_at\": %llu}\n", steps, static_cast<unsigned long long>(taken));
  return taken == static_cast<std::uint64_t>(steps) ? 0 : 1;
}

int run_changes(std::size_t peers, long rounds) {
  Group group(peers);
  group.exchange();
  for (long i = 0; i < rounds; ++i) {
    group.call(0, program::Method::Start);
    group.call(peers, program::Method::Suspend);
    group.call(0, program::Method::Resume);
    group.call(peers, program::Method::Halt);
    if (group.participants[0].state() != handshake::PublishedState::Halted) return 1;
  }
  std::printf("{\"steps\": %llu, \"looked_at\": %llu}\n", static_cast<unsigned long long>(group.steps),
              static_cast<unsigned long long>(group.looked_at));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view workload = argc > 1 ? argv[1] : "";
  if (workload == "uadp" && argc == 3) return run_uadp(std::atol(argv[2]));
  if (workload == "handshake" && argc == 4)
    return run_handshake(static_cast<std::size_t>(std::atol(argv[2])), std::atol(argv[3]));
  if (workload == "changes" && argc == 4)
    return run_changes(static_cast<std::size_t>(std::atol(argv[2])), std::atol(argv[3]));
  std::fputs("usage: takt_bench_protocol uadp ROUNDS | handshake PEERS STEPS | changes PEERS ROUNDS\n", stderr);
  return 2;
}
