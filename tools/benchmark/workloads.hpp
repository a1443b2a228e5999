// SPDX-License-Identifier: Apache-2.0
// The workloads that tools/bench measures; each runs once and says what it cost.
#pragma once

#include <cstddef>
#include <cstdint>

namespace takt::benchmark {

struct LineFigures {
  double cpu_seconds = 0;  ///< of the event loop
  std::uint64_t frame_hops = 0;
  std::uint64_t events = 0;
  std::size_t population = 0;  ///< most pending events
};
/// What every port of the line has besides strict priority.
enum class LineVariant {
  plain,
  gates,        ///< a gate list of eight entries of 31.25 us, one of which closes the class of the frames
  short_gates,  ///< the same with entries of 2.5 us: every second frame finds its gate closed
  gptp,         ///< gPTP at every node, clocks of up to 50 ppm
  preemption,   ///< the large frames may be cut; the small ones are express and come while a large one is being sent
};
/// host - 5 switches - host at 1 Gb/s: 100 octets of UDP payload every 200 us and 1000 octets every 20 us.
LineFigures run_line(double simulated_seconds, LineVariant variant = LineVariant::plain);

/// What streams or switches of that line have, described as a scenario: both streams are of class 5.
enum class LineFeature {
  none,
  credit_based_shaper,  ///< of 600 Mbit/s at every port
  asynchronous_shaper,  ///< a scheduler for each stream at every switch
  policing,             ///< at every switch a stream gate for the small frames and a meter for the large ones
  redundancy,           ///< two such lines; both streams go over both
};
LineFigures run_line_with(LineFeature feature, double simulated_seconds);

/// CPU seconds of a bare loop that pops an event and pushes one, `events` times at that population: takt's own queue,
/// and a plain 4-ary heap of records of 32 octets.
double bare_loop_own_queue(std::uint64_t events, std::size_t population);
double bare_loop_plain_heap(std::uint64_t events, std::size_t population);

struct TreeFigures {
  double cpu_seconds = 0;
  std::uint64_t frame_hops = 0;
  double setup_cpu_seconds = 0;  ///< from the text of the scenario to a run that can begin
  std::size_t setup_octets = 0;  ///< what the run keeps allocated
  std::size_t hosts = 0;
};
/// A tree of switches with that fanout and depth and `hosts_per_leaf` hosts at each leaf; every host sends 200 octets
/// each millisecond to another one that lies elsewhere in the tree.
TreeFigures run_tree(unsigned depth, unsigned fanout, unsigned hosts_per_leaf, double simulated_seconds);

struct PlantFigures {
  double cpu_seconds = 0;  ///< of the event loop
  std::uint64_t frame_hops = 0;
  double setup_cpu_seconds = 0;  ///< from the text of the scenario to a run that can begin
  std::size_t octets = 0;        ///< that are allocated at the end of the run
};
/// A grid of `side` x `side` switches at 10 Gb/s that forward in 1 us, ten hosts on each at 1 Gb/s. Every host sends
/// 200 octets each millisecond to a random other one: all at once, or spread over the period.
PlantFigures run_plant(unsigned side, bool spread, double simulated_seconds);

struct ParallelFigures {
  double one_wall_seconds = 0;  ///< by the clock, of the event loop on one thread
  double wall_seconds = 0;      ///< on several
  unsigned threads = 0;         ///< that there were
  bool is_same = false;         ///< the digest
};
/// That plant, first on one thread and then on so many.
ParallelFigures run_parallel_plant(unsigned side, bool spread, double simulated_seconds, unsigned threads);
/// A bare loop of the same events: ports that send in turn, routes as arrays, a ring of buckets.
PlantFigures run_bare_plant(unsigned side, bool spread, double simulated_seconds);

struct PairFigures {
  double cpu_seconds = 0;
  double simulated_seconds = 0;
};
/// scenarios/direct-link.json, started once and left running.
PairFigures run_pair(double simulated_seconds);
/// host - 99 switches - host at 1 Gb/s with gPTP and nothing else: drifting clocks, Sync every 125 ms.
PairFigures run_gptp_line(double simulated_seconds);

/// CPU seconds to parse, resolve and build a point of scenarios/robot-arm.json, as a study does; the mean of so many.
double point_setup(unsigned points);

struct BoundFigures {
  double cpu_seconds = 0;       ///< from the text of the scenario to all bounds
  double load_cpu_seconds = 0;  ///< the part before the analysis
  std::size_t streams = 0;
  std::size_t bounded = 0;  ///< those with a finite bound
  int rounds = 0;
};
/// A mesh of that many switches (a multiple of 10) with that many streams across it, bounded.
BoundFigures run_bound(unsigned switches, unsigned streams);

}  // namespace takt::benchmark
