// SPDX-License-Identifier: Apache-2.0
#include "evaluation/collect_streams.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <tuple>

#include "sim/check.hpp"

namespace takt::evaluation {

using namespace results;
namespace {

using models::StreamIndex;
using Drops = std::array<std::uint64_t, static_cast<std::size_t>(models::DropReason::count)>;

/// A frame that is under way, and how many copies share its record.
struct UnderWay {
  StreamIndex stream;
  std::uint64_t sequence = 0;
  TrueTime produced;
  std::uint32_t copies = 0;
};

/// All of them, by stream and then by sequence number.
std::vector<UnderWay> under_way(const models::Traffic& traffic) {
  std::vector<UnderWay> frames;
  traffic.for_each_live([&](const models::Frame& frame) {
    frames.push_back({frame.stream, frame.sequence, frame.produced, frame.references});
  });
  std::sort(frames.begin(), frames.end(), [](const UnderWay& a, const UnderWay& b) {
    return std::tie(a.stream, a.sequence, a.copies) < std::tie(b.stream, b.sequence, b.copies);
  });
  return frames;
}

std::span<const UnderWay> of_stream(const std::vector<UnderWay>& frames, StreamIndex stream) {
  const auto range = std::equal_range(frames.begin(), frames.end(), UnderWay{stream, 0, {}, 0},
                                      [](const UnderWay& a, const UnderWay& b) { return a.stream < b.stream; });
  return {range.first, range.second};
}

/// The account of the frames that were produced at `from` or later: that of the whole run, or one that begins later.
struct Account {
  std::uint64_t first = 0;  ///< sequence number
  std::uint64_t delivered = 0;
  const Drops* dropped = nullptr;
  const sim::Histogram* latency = nullptr;
};

std::optional<Account> account_of(const models::Traffic& traffic, StreamIndex index, TrueTime from,
                                  std::span<const UnderWay> frames) {
  const models::Stream& stream = traffic.stream(index);
  if (from == TrueTime()) return Account{0, stream.delivered, &stream.dropped, &stream.latency};
  const auto accounts = traffic.book().accounts(index);
  const auto found = std::find_if(accounts.begin(), accounts.end(),
                                  [&](const models::LaterAccount& account) { return account.from == from; });
  if (found == accounts.end()) return std::nullopt;
  Account account{std::min(found->first_sequence, stream.sent), found->delivered, &found->dropped, &found->latency};
  for (const UnderWay& frame : frames)
    if (frame.produced >= from) account.first = std::min(account.first, frame.sequence);
  return account;
}

/// What no copy brings to a listener any more, and how old the oldest is that one still waits for.
void count_losses(std::span<const models::DeliveryBook::Arrivals> arrivals, std::span<const UnderWay> frames,
                  std::uint64_t first, TrueTime now, StreamResult& result) {
  for (const models::DeliveryBook::Arrivals& each : arrivals) {
    result.lost += each.ledger.missing(first, first + result.sent);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const bool is_further_copy = i > 0 && frames[i - 1].sequence == frames[i].sequence;
      if (is_further_copy || frames[i].sequence < first || each.ledger.has(frames[i].sequence)) continue;
      --result.lost;
      result.oldest_in_flight = std::max(result.oldest_in_flight.value_or(Duration()), now - frames[i].produced);
    }
  }
}

StreamResult result_of(const scenario::Run& run, StreamIndex index, TrueTime from, std::span<const UnderWay> frames) {
  const models::Traffic& traffic = run.network().traffic();
  const models::Stream& stream = traffic.stream(index);
  const auto arrivals = traffic.book().arrivals(index);
  StreamResult result;
  result.name = stream.name;
  result.of_program = run.resolved().streams[index.value].of_program;
  result.listeners = stream.listeners;
  result.has_copies = !arrivals.empty();
  const auto account = account_of(traffic, index, from, frames);
  if (!account) return result;
  result.sent = stream.sent - account->first;
  result.delivered = account->delivered;
  for (const UnderWay& frame : frames)
    if (frame.sequence >= account->first) result.in_flight += frame.copies;
  for (std::size_t reason = 0; reason < account->dropped->size(); ++reason)
    if (const std::uint64_t count = (*account->dropped)[reason]; count > 0)
      result.dropped.emplace_back(models::name_of(static_cast<models::DropReason>(reason)), count);
  result.copies = result.delivered + result.dropped_in_all() + result.in_flight - result.sent;
  TAKT_CHECK(from != TrueTime() || result.in_flight == stream.in_flight(),
             "what is under way is what the account of its stream misses");
  const TrueTime now = run.simulation().now();
  if (result.has_copies) {
    count_losses(arrivals, frames, account->first, now, result);
  } else {
    // Copies that sequence recovery takes out are what redundancy is for.
    result.lost =
        result.dropped_in_all() - (*account->dropped)[static_cast<std::size_t>(models::DropReason::duplicate)];
    for (const UnderWay& frame : frames)
      if (frame.sequence >= account->first)
        result.oldest_in_flight = std::max(result.oldest_in_flight.value_or(Duration()), now - frame.produced);
  }
  if (!account->latency->empty()) {
    result.latency = summary_of(*account->latency);
    account->latency->for_each_bucket([&](Duration low, Duration high, std::uint64_t n) {
      result.histogram.push_back({low, high, n});
    });
  }
  return result;
}

}  // namespace

LatencySummary summary_of(const sim::Histogram& histogram) {
  return {histogram.minimum(),           histogram.mean(),    histogram.percentile(50, 100),
          histogram.percentile(99, 100), histogram.maximum(), histogram.standard_deviation()};
}

std::vector<StreamResult> streams_of(const scenario::Run& run, Duration from) {
  const std::vector<UnderWay> frames = under_way(run.network().traffic());
  std::vector<StreamResult> results;
  // Behind the streams of the scenario may stand that of gPTP.
  for (std::uint32_t s = 0; s < run.resolved().streams.size(); ++s)
    results.push_back(result_of(run, {s}, TrueTime() + from, of_stream(frames, {s})));
  return results;
}

std::vector<std::pair<std::string, std::uint64_t>> drops_of(const scenario::Run& run, Duration from) {
  const models::Traffic& traffic = run.network().traffic();
  Drops sums{};
  for (std::uint32_t s = 0; s < traffic.streams().size(); ++s)
    if (const auto account = account_of(traffic, {s}, TrueTime() + from, {}))
      for (std::size_t reason = 0; reason < sums.size(); ++reason) sums[reason] += (*account->dropped)[reason];
  std::vector<std::pair<std::string, std::uint64_t>> drops;
  for (std::size_t reason = 0; reason < sums.size(); ++reason)
    if (sums[reason] > 0) drops.emplace_back(models::name_of(static_cast<models::DropReason>(reason)), sums[reason]);
  return drops;
}

}  // namespace takt::evaluation
