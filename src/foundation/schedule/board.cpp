// SPDX-License-Identifier: Apache-2.0
#include "schedule/board.hpp"

#include <algorithm>
#include <numeric>

#include "sim/check.hpp"

namespace takt::schedule {

Periods::Periods(const Problem& problem) {
  of_stream_.reserve(problem.streams.size());
  for (const Stream& stream : problem.streams) periods_.push_back(stream.period);
  std::sort(periods_.begin(), periods_.end());
  periods_.erase(std::unique(periods_.begin(), periods_.end()), periods_.end());
  for (const Stream& stream : problem.streams)
    of_stream_.push_back(static_cast<std::uint32_t>(std::lower_bound(periods_.begin(), periods_.end(), stream.period) -
                                                    periods_.begin()));
  common_.resize(periods_.size() * periods_.size());
  for (std::size_t a = 0; a < periods_.size(); ++a)
    for (std::size_t b = 0; b < periods_.size(); ++b)
      common_[a * periods_.size() + b] = std::gcd(periods_[a], periods_[b]);
}

void Periods::add(Ps period) {
  const auto known = std::find(periods_.begin(), periods_.end(), period);
  of_stream_.push_back(static_cast<std::uint32_t>(known - periods_.begin()));
  if (known != periods_.end()) return;
  periods_.push_back(period);
  common_.resize(periods_.size() * periods_.size());
  for (std::size_t a = 0; a < periods_.size(); ++a)
    for (std::size_t b = 0; b < periods_.size(); ++b)
      common_[a * periods_.size() + b] = std::gcd(periods_[a], periods_[b]);
}

namespace {

/// An instant, which may lie before 0, within a period.
Ps phase(Ps at, Ps period) {
  if (at >= 0 && at < period) return at;  // mostly, and a division takes long
  const Ps rest = at % period;
  return rest < 0 ? rest + period : rest;
}

/// How much later something at `at` (within the period) must begin to be behind all that it meets at this place of the
/// row without a free place between.
Ps push_in_row(const Board::Row& row, Ps period, Ps at, Ps length) {
  const auto& slots = row.slots;
  const auto behind =
      std::lower_bound(slots.begin(), slots.end(), at, [](const Board::Slot& slot, Ps t) { return slot.at < t; });
  const auto count = static_cast<std::size_t>(slots.end() - slots.begin());
  auto index = static_cast<std::size_t>(behind - slots.begin());
  Ps here = at;
  // The one before may reach here, round the end of the period as well.
  const Board::Slot& before = slots[index == 0 ? count - 1 : index - 1];
  const Ps reach = before.at - (index == 0 ? period : 0) + before.length;
  if (reach > here) here = reach;
  // Then whatever begins before the end of what is asked about; once round at most.
  Ps turn = 0;
  for (std::size_t seen = 0; seen <= count; ++seen, ++index) {
    if (index == count) index = 0, turn += period;
    const Board::Slot& slot = slots[index];
    if (slot.at + turn >= here + length) break;
    here = std::max(here, slot.at + turn + slot.length);
  }
  return here - at;
}

}  // namespace

void Board::add(LinkIndex link, std::uint32_t period, Ps at, Ps length, StreamIndex stream) {
  auto& rows = rows_[link];
  auto row = std::find_if(rows.begin(), rows.end(), [&](const Row& each) { return each.period == period; });
  if (row == rows.end()) row = rows.insert(rows.end(), Row{period, 0, {}});
  const Ps there = phase(at, (*periods_)[period]);
  row->longest = std::max(row->longest, length);
  const auto place =
      std::lower_bound(row->slots.begin(), row->slots.end(), there, [](const Slot& slot, Ps t) { return slot.at < t; });
  row->slots.insert(place, Slot{there, length, stream});
}

void Board::remove(LinkIndex link, std::uint32_t period, Ps at, StreamIndex stream) {
  for (Row& row : rows_[link]) {
    if (row.period != period) continue;
    const Ps there = phase(at, (*periods_)[period]);
    auto place =
        std::lower_bound(row.slots.begin(), row.slots.end(), there, [](const Slot& slot, Ps t) { return slot.at < t; });
    while (place != row.slots.end() && place->at == there && place->stream != stream) ++place;
    TAKT_CHECK(place != row.slots.end() && place->stream == stream, "what leaves the board was there");
    row.slots.erase(place);
    return;
  }
  TAKT_CHECK(false, "what leaves the board was there");
}

Ps Board::push(LinkIndex link, std::uint32_t period, Ps at, Ps length) const {
  for (const Row& row : rows_[link]) {
    if (row.slots.empty()) continue;
    const Ps theirs = (*periods_)[row.period];
    const Ps every = periods_->common(period, row.period);
    if (theirs / every > static_cast<Ps>(8 * row.slots.size())) {
      // More places than slots: each slot is asked whether they meet anywhere.
      for (const Slot& slot : row.slots) {
        const Ps behind = phase(at - slot.at, every);
        if (behind < slot.length) return slot.length - behind;
        if (every - behind < length) return every - behind + slot.length;
      }
      continue;
    }
    for (Ps place = phase(at, every); place < theirs; place += every)
      if (const Ps push = push_in_row(row, theirs, place, length); push != 0) return push;
  }
  return 0;
}

}  // namespace takt::schedule
