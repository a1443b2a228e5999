// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/os_profiles.hpp"

#include <array>
#include <utility>
#include <vector>

namespace takt::scenario {
namespace {

using sim::Distribution;

/// A delay with a body and a rare, bounded tail. The body is a shifted exponential with this least value and average,
/// cut where the tail begins; the tail is uniform from there to the greatest value. Bounded, so that worst cases exist.
struct BodyAndTail {
  Duration least;
  Duration average;
  Duration tail_from;
  Duration greatest;
  std::uint32_t tail_parts_per_billion;
};

struct Profile {
  OsProfile name;
  BodyAndTail wake_up;
  BodyAndTail transmit;
  BodyAndTail receive;
};

constexpr std::array<Profile, 6> profiles = {{
    {OsProfile::preempt_rt,
     {1_us, 3_us, 10_us, 50_us, 10'000},
     {3_us, 5_us, 8_us, 30_us, 10'000},
     {6_us, 9_us, 15_us, 50_us, 10'000}},
    {OsProfile::preempt_rt_isolated,
     {1_us, 2_us, 4_us, 11_us, 1'000},
     {3_us, 4_us, 6_us, 11_us, 1'000},
     {6_us, 7_us, 10_us, 20_us, 1'000}},
    {OsProfile::preempt_rt_arm,
     {6_us, 9_us, 20_us, 66_us, 10'000},
     {8_us, 12_us, 25_us, 80_us, 10'000},
     {20_us, 31_us, 60_us, 136_us, 10'000}},
    {OsProfile::general_purpose,
     {1_us, 10_us, 100_us, 20_ms, 100'000},
     {5_us, 12_us, 30_us, 5_ms, 100'000},
     {15_us, 40_us, 100_us, 10_ms, 100'000}},
    {OsProfile::virtual_machine,
     {2_us, 15_us, 200_us, 30_ms, 100'000},
     {20_us, 35_us, 60_us, 30_ms, 100'000},
     {20_us, 50_us, 160_us, 30_ms, 100'000}},
    {OsProfile::virtual_machine_rt,
     {3_us, 8_us, 20_us, 50_us, 10'000},
     {20_us, 30_us, 60_us, 100_us, 10'000},
     {20_us, 30_us, 60_us, 100_us, 10'000}},
}};

/// A shifted exponential is not one of the kernel's distributions; a table of 256 equally likely quantiles stands for
/// it, so that its average is right to a fraction of a percent.
Distribution shifted_exponential(const BodyAndTail& d) {
  constexpr int steps = 256;
  std::vector<Distribution::Point> points;
  points.reserve(steps);
  // -log(1 - u) at the middle of each step, by summing the series of 1/(1-u): exact enough and free of libm.
  double sum = 0.0;
  double previous = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double u = (i + 0.5) / steps;
    const double width = (u - previous) / 8;
    for (int part = 0; part < 8; ++part) {
      const double left = previous + part * width;
      sum += width / 6 * (1 / (1 - left) + 4 / (1 - left - width / 2) + 1 / (1 - left - width));
    }
    previous = u;
    const auto excess = static_cast<std::int64_t>(sum * static_cast<double>((d.average - d.least).ps()) + 0.5);
    points.push_back({d.least + Duration::from_ps(excess), 1});
  }
  return Distribution::empirical(std::move(points)).clamped(d.least, d.tail_from);
}

Distribution mixture_of(const BodyAndTail& d) {
  return Distribution::mixture(shifted_exponential(d), Distribution::uniform(d.tail_from, d.greatest),
                               d.tail_parts_per_billion)
      .clamped(d.least, d.greatest);
}

}  // namespace

constexpr Duration longest_receive = Duration::from_ps(10'000'000'000'000);

models::OsLatency os_latency_of(const OperatingSystem& os, json::Diagnostics& diagnostics) {
  models::OsLatency latency;
  for (const Profile& profile : profiles) {
    if (profile.name != os.profile) continue;
    latency.wake_up = mixture_of(profile.wake_up);
    latency.transmit = mixture_of(profile.transmit);
    latency.receive = mixture_of(profile.receive);
  }
  if (os.wake_up) latency.wake_up = distribution_of(*os.wake_up, diagnostics);
  if (os.transmit) latency.transmit = distribution_of(*os.transmit, diagnostics);
  if (os.receive) latency.receive = distribution_of(*os.receive, diagnostics);
  // A constant one is added to the delay of the cable, which a port keeps in 44 bits of ps.
  if (latency.receive.is_constant() && latency.receive.greatest() > longest_receive)
    diagnostics.error(os.where.at("receive"), "too long to receive",
                      {json::to_text(latency.receive.greatest()), "at most " + json::to_text(longest_receive)});
  return latency;
}

}  // namespace takt::scenario
