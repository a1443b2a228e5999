// SPDX-License-Identifier: Apache-2.0
// The two curves of textbook network calculus, in exact fractions: token buckets and rate-latency servers.
#pragma once

#include <optional>

#include "analysis/rational.hpp"

namespace takt::analysis {

/// alpha(t) = burst + rate * t for t > 0: at most so much comes in any interval of length t.
struct TokenBucket {
  Rational rate;
  Rational burst;
  bool operator==(const TokenBucket&) const = default;
  friend TokenBucket operator+(const TokenBucket& a, const TokenBucket& b) {
    return {a.rate + b.rate, a.burst + b.burst};
  }
};

/// beta(t) = rate * max(0, t - latency): at least so much is served in an interval of length t in which there is a
/// backlog.
struct RateLatency {
  Rational rate;
  Rational latency;
  bool operator==(const RateLatency&) const = default;
};

/// One server after the other, as one (min-plus convolution).
inline RateLatency convolution(const RateLatency& a, const RateLatency& b) {
  return {a.rate < b.rate ? a.rate : b.rate, a.latency + b.latency};
}

/// How far alpha runs ahead of beta in time: the delay through a FIFO server. Nothing if it is unbounded.
inline std::optional<Rational> horizontal_deviation(const TokenBucket& alpha, const RateLatency& beta) {
  if (alpha.rate > beta.rate || beta.rate == Rational()) return std::nullopt;
  return beta.latency + alpha.burst / beta.rate;
}

/// How far alpha runs ahead of beta in data: the backlog. Nothing if it is unbounded.
inline std::optional<Rational> vertical_deviation(const TokenBucket& alpha, const RateLatency& beta) {
  if (alpha.rate > beta.rate) return std::nullopt;
  return alpha.burst + alpha.rate * beta.latency;
}

/// What leaves the server (min-plus deconvolution): the burst grows by rate * latency. Nothing if it is unbounded.
inline std::optional<TokenBucket> output_bound(const TokenBucket& alpha, const RateLatency& beta) {
  if (alpha.rate > beta.rate) return std::nullopt;
  return TokenBucket{alpha.rate, alpha.burst + alpha.rate * beta.latency};
}

/// What a FIFO server leaves to the others beside `cross`: of the family beta(t) - cross(t - theta) the member whose
/// theta = latency + burst / rate is the least with a curve that is 0 up to theta. Nothing if nothing is left.
inline std::optional<RateLatency> left_over_fifo(const RateLatency& beta, const TokenBucket& cross) {
  if (cross.rate >= beta.rate) return std::nullopt;
  return RateLatency{beta.rate - cross.rate, beta.latency + cross.burst / beta.rate};
}

/// The same if nothing is known of the order in which the server takes its flows: beta(t) - cross(t).
inline std::optional<RateLatency> left_over_arbitrary(const RateLatency& beta, const TokenBucket& cross) {
  if (cross.rate >= beta.rate) return std::nullopt;
  const Rational rate = beta.rate - cross.rate;
  return RateLatency{rate, (beta.rate * beta.latency + cross.burst) / rate};
}

}  // namespace takt::analysis
