// SPDX-License-Identifier: Apache-2.0
#include "schedule_instances/proof.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "json/node.hpp"
#include "schedule/crossings.hpp"
#include "schedule/timing.hpp"

namespace takt::schedule_instances {

using namespace schedule;

namespace {

std::string time_text(Ps time) { return fmt::format("{:.6g} us", static_cast<double>(time) / 1e6); }

}  // namespace

std::string kind_of(const Certificate& certificate) {
  static constexpr const char* kinds[] = {"latency", "load", "interval", "folded", "pair", "clausal"};
  return kinds[static_cast<std::size_t>(certificate.kind)];
}

std::string proof_of(const Problem& problem, const Certificate& certificate) {
  using Kind = Certificate::Kind;
  const Timing timing(problem, GateTiming::flowing);
  const std::string crossing = certificate.in_time ? "must cross it to be in time" : "must cross it";
  switch (certificate.kind) {
    case Kind::latency: {
      const Stream& stream = problem.streams[certificate.streams.front()];
      const Crossings crossings(problem);
      const Ps least = crossings.arrival(stream, certificate.listener, crossings.earliest_starts(stream));
      if (least == never)
        return fmt::format("no way leads {} to {}", json::quote(stream.name),
                           json::quote(problem.nodes[certificate.listener].name));
      Ps limit = stream.latency.value_or(longest_time);
      if (stream.deadline) limit = std::min(limit, *stream.deadline - stream.release);
      return fmt::format("{} takes at least {} to {} and has {}", json::quote(stream.name), time_text(least),
                         json::quote(problem.nodes[certificate.listener].name), time_text(limit));
    }
    case Kind::load: {
      double sum = 0;
      for (const StreamIndex s : certificate.streams)
        sum += static_cast<double>(timing.work(problem.streams[s], problem.links[certificate.links.front()])) /
               static_cast<double>(problem.streams[s].period);
      std::string links;
      for (const LinkIndex l : certificate.links)
        links += (links.empty() ? "" : ", ") + json::quote(problem.links[l].name);
      if (certificate.links.size() > 1)
        return fmt::format("{} streams load {} by {:.2f} % together (each must cross one of them)",
                           certificate.streams.size(), links,
                           sum / static_cast<double>(certificate.links.size()) * 100);
      return fmt::format("{} streams load {} by {:.2f} % ({})", certificate.streams.size(), links, sum * 100, crossing);
    }
    case Kind::interval:
      return fmt::format("{} frames must be sent on {} from {} to {}, and take longer", certificate.jobs.size(),
                         json::quote(problem.links[certificate.links.front()].name), time_text(certificate.from),
                         time_text(certificate.until));
    case Kind::pair:
      return fmt::format(
          "{} and {} meet on some link that both must cross, whatever their phases: neither may wait long enough for "
          "the other",
          json::quote(problem.streams[certificate.streams[0]].name),
          json::quote(problem.streams[certificate.streams[1]].name));
    case Kind::clausal: {
      std::string names;
      constexpr std::size_t most = 8;
      for (std::size_t i = 0; i < std::min(most, certificate.streams.size()); ++i)
        names += (i == 0 ? "" : ", ") + json::quote(problem.streams[certificate.streams[i]].name);
      if (certificate.streams.size() > most) names += fmt::format(" and {} more", certificate.streams.size() - most);
      return fmt::format("{} streams have no place beside each other, by {} clauses and {} steps: {}",
                         certificate.streams.size(), certificate.clauses.axioms.size(),
                         certificate.clauses.steps.size(), names);
    }
    case Kind::folded: {
      double sum = 0;
      for (const StreamIndex s : certificate.streams)
        sum += static_cast<double>(timing.work(problem.streams[s], problem.links[certificate.links.front()])) /
               static_cast<double>(std::gcd(problem.streams[s].period, certificate.modulus));
      return fmt::format("{} strictly periodic streams fill {:.2f} % of each {} on {} ({})", certificate.streams.size(),
                         sum * 100, time_text(certificate.modulus),
                         json::quote(problem.links[certificate.links.front()].name), crossing);
    }
  }
  return {};
}

}  // namespace takt::schedule_instances
