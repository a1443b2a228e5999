// SPDX-License-Identifier: Apache-2.0
// One measured run of one workload, as a line of JSON; tools/bench calls it again and again, in turn with others.
//
//   takt_bench
//   line|line-gates|line-short-gates|line-preemption|line-gptp|line-scenario|line-cbs|line-ats|line-psfp|line-frer
//   SECONDS | queue-own EVENTS POPULATION | queue-plain EVENTS POPULATION
//            | tree DEPTH FANOUT HOSTS_PER_LEAF SECONDS | pair|gptp-line SECONDS | point-setup POINTS
//            | bound SWITCHES STREAMS | plant|bare-plant SIDE at-once|spread SECONDS | parallel-plant SIDE
//            at-once|spread SECONDS THREADS
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "scenario/run/huge_heap.hpp"
#include "workloads.hpp"

namespace {

using namespace takt::benchmark;  // NOLINT

int usage() {
  std::fputs(
      "usage: takt_bench "
      "line|line-gates|line-short-gates|line-preemption|line-gptp|line-scenario|line-cbs|line-ats|line-psfp|line-frer "
      "SECONDS | queue-own EVENTS POPULATION | queue-plain EVENTS POPULATION |\n"
      "       tree DEPTH FANOUT HOSTS_PER_LEAF SECONDS | pair|gptp-line SECONDS | point-setup POINTS | bound SWITCHES "
      "STREAMS |\n"
      "       plant|bare-plant SIDE at-once|spread SECONDS | parallel-plant SIDE at-once|spread SECONDS THREADS\n",
      stderr);
  return 2;
}

std::optional<LineVariant> line_variant(std::string_view workload) {
  if (workload == "line") return LineVariant::plain;
  if (workload == "line-gates") return LineVariant::gates;
  if (workload == "line-short-gates") return LineVariant::short_gates;
  if (workload == "line-gptp") return LineVariant::gptp;
  if (workload == "line-preemption") return LineVariant::preemption;
  return std::nullopt;
}

std::optional<LineFeature> line_feature(std::string_view workload) {
  if (workload == "line-scenario") return LineFeature::none;
  if (workload == "line-cbs") return LineFeature::credit_based_shaper;
  if (workload == "line-ats") return LineFeature::asynchronous_shaper;
  if (workload == "line-psfp") return LineFeature::policing;
  if (workload == "line-frer") return LineFeature::redundancy;
  return std::nullopt;
}

unsigned number(const char* text) { return static_cast<unsigned>(std::strtoul(text, nullptr, 10)); }

}  // namespace

int main(int argc, char** argv) {
  takt::scenario::put_heap_on_huge_pages();  // as takt run does
  const std::string_view workload = argc > 1 ? argv[1] : "";
  const std::optional<LineVariant> line = line_variant(workload);
  const std::optional<LineFeature> feature = line_feature(workload);
  if ((line || feature) && argc == 3) {
    const LineFigures f = line ? run_line(std::atof(argv[2]), *line) : run_line_with(*feature, std::atof(argv[2]));
    std::printf(R"({"cpu_s": %.9f, "frame_hops": %llu, "events": %llu, "population": %zu})"
                "\n",
                f.cpu_seconds, static_cast<unsigned long long>(f.frame_hops), static_cast<unsigned long long>(f.events),
                f.population);
  } else if ((workload == "queue-own" || workload == "queue-plain") && argc == 4) {
    const std::uint64_t events = std::strtoull(argv[2], nullptr, 10);
    const std::size_t population = number(argv[3]);
    const double seconds =
        workload == "queue-own" ? bare_loop_own_queue(events, population) : bare_loop_plain_heap(events, population);
    std::printf(R"({"cpu_s": %.9f})"
                "\n",
                seconds);
  } else if (workload == "tree" && argc == 6) {
    const TreeFigures f = run_tree(number(argv[2]), number(argv[3]), number(argv[4]), std::atof(argv[5]));
    std::printf(R"({"cpu_s": %.9f, "frame_hops": %llu, "setup_cpu_s": %.9f, "setup_octets": %zu, "hosts": %zu})"
                "\n",
                f.cpu_seconds, static_cast<unsigned long long>(f.frame_hops), f.setup_cpu_seconds, f.setup_octets,
                f.hosts);
  } else if ((workload == "plant" || workload == "bare-plant") && argc == 5 &&
             (std::string_view(argv[3]) == "at-once" || std::string_view(argv[3]) == "spread")) {
    const auto run = workload == "plant" ? run_plant : run_bare_plant;
    const PlantFigures f = run(number(argv[2]), std::string_view(argv[3]) == "spread", std::atof(argv[4]));
    std::printf(R"({"cpu_s": %.9f, "frame_hops": %llu, "setup_cpu_s": %.9f, "octets": %zu})"
                "\n",
                f.cpu_seconds, static_cast<unsigned long long>(f.frame_hops), f.setup_cpu_seconds, f.octets);
  } else if (workload == "parallel-plant" && argc == 6) {
    const ParallelFigures f =
        run_parallel_plant(number(argv[2]), std::string_view(argv[3]) == "spread", std::atof(argv[4]), number(argv[5]));
    std::printf(R"({"one_wall_s": %.9f, "wall_s": %.9f, "threads": %u, "same": %s})"
                "\n",
                f.one_wall_seconds, f.wall_seconds, f.threads, f.is_same ? "true" : "false");
  } else if ((workload == "pair" || workload == "gptp-line") && argc == 3) {
    const PairFigures f = workload == "pair" ? run_pair(std::atof(argv[2])) : run_gptp_line(std::atof(argv[2]));
    std::printf(R"({"cpu_s": %.9f, "simulated_s": %.9f})"
                "\n",
                f.cpu_seconds, f.simulated_seconds);
  } else if (workload == "point-setup" && argc == 3) {
    std::printf(R"({"cpu_s": %.9f})"
                "\n",
                point_setup(number(argv[2])));
  } else if (workload == "bound" && argc == 4) {
    const BoundFigures f = run_bound(number(argv[2]), number(argv[3]));
    std::printf(R"({"cpu_s": %.9f, "load_cpu_s": %.9f, "streams": %zu, "bounded": %zu, "rounds": %d})"
                "\n",
                f.cpu_seconds, f.load_cpu_seconds, f.streams, f.bounded, f.rounds);
  } else {
    return usage();
  }
  return 0;
}
