// SPDX-License-Identifier: Apache-2.0
#include "models/ethernet/delivery_book.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::models {

DeliveryBook::Entry& DeliveryBook::entry_of(StreamIndex stream) {
  if (entries_.size() <= stream.value) entries_.resize(stream.value + std::size_t{1});
  entries_[stream.value].is_kept = true;
  return entries_[stream.value];
}

void DeliveryBook::keep_account(StreamIndex stream, sim::TrueTime from) {
  entry_of(stream).accounts.emplace_back().from = from;
}

void DeliveryBook::keep_arrivals(StreamIndex stream, NodeIndex listener) {
  entry_of(stream).arrivals.push_back({listener});
}

void DeliveryBook::keep_timely(StreamIndex stream, NodeIndex listener, sim::Duration deadline) {
  entry_of(stream).timely.push_back({listener, deadline});
}

void DeliveryBook::deliver(const Frame& frame, NodeIndex listener, sim::TrueTime now) {
  if (!concerns(frame.stream)) return;
  Entry& entry = entries_[frame.stream.value];
  for (LaterAccount& account : entry.accounts) {
    if (frame.produced < account.from) continue;
    account.first_sequence = std::min(account.first_sequence, frame.sequence);
    ++account.delivered;
    account.latency.add(now - frame.produced);
  }
  for (Arrivals& arrivals : entry.arrivals)
    if (arrivals.listener == listener) arrive(arrivals, entry, frame);
  for (Timely& timely : entry.timely) {
    if (timely.listener != listener || now - frame.produced > timely.deadline) continue;
    if (timely.came.size() <= frame.sequence) timely.came.resize(frame.sequence + 1);
    timely.came[frame.sequence] = true;
  }
}

/// What is folded, and when, depends on what has come to this listener alone, so that it is the same in a divided run.
void DeliveryBook::arrive(Arrivals& arrivals, const Entry& entry, const Frame& frame) {
  arrivals.ledger.arrive(frame.sequence);
  arrivals.firsts.resize(entry.accounts.size(), std::numeric_limits<std::uint64_t>::max());
  for (std::size_t a = 0; a < entry.accounts.size(); ++a)
    if (frame.produced >= entry.accounts[a].from) arrivals.firsts[a] = std::min(arrivals.firsts[a], frame.sequence);
  if (arrivals.ledger.has_many_gaps()) arrivals.ledger.fold(arrivals.firsts);
}

void DeliveryBook::drop(const Frame& frame, DropReason reason) {
  if (!concerns(frame.stream)) return;
  Entry& entry = entries_[frame.stream.value];
  for (LaterAccount& account : entry.accounts) {
    if (frame.produced < account.from) continue;
    account.first_sequence = std::min(account.first_sequence, frame.sequence);
    ++account.dropped[static_cast<std::size_t>(reason)];
  }
}

void DeliveryBook::adopt(const DeliveryBook& other) {
  TAKT_CHECK(entries_.size() == other.entries_.size(), "parts of a run keep the same accounts");
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    for (std::size_t a = 0; a < entries_[e].accounts.size(); ++a) {
      LaterAccount& account = entries_[e].accounts[a];
      const LaterAccount& more = other.entries_[e].accounts[a];
      account.first_sequence = std::min(account.first_sequence, more.first_sequence);
      account.delivered += more.delivered;
      account.latency.add(more.latency);
      for (std::size_t reason = 0; reason < account.dropped.size(); ++reason)
        account.dropped[reason] += more.dropped[reason];
    }
    for (std::size_t l = 0; l < entries_[e].arrivals.size(); ++l) {
      const Arrivals& more = other.entries_[e].arrivals[l];
      if (more.ledger.is_empty()) continue;
      TAKT_CHECK(entries_[e].arrivals[l].ledger.is_empty(), "a listener is in one part");
      entries_[e].arrivals[l] = more;
    }
    for (std::size_t t = 0; t < entries_[e].timely.size(); ++t) {
      const Timely& more = other.entries_[e].timely[t];
      if (more.came.empty()) continue;
      TAKT_CHECK(entries_[e].timely[t].came.empty(), "a listener is in one part");
      entries_[e].timely[t] = more;
    }
  }
}

std::span<const LaterAccount> DeliveryBook::accounts(StreamIndex stream) const {
  return concerns(stream) ? std::span<const LaterAccount>(entries_[stream.value].accounts)
                          : std::span<const LaterAccount>();
}

std::span<const DeliveryBook::Arrivals> DeliveryBook::arrivals(StreamIndex stream) const {
  return concerns(stream) ? std::span<const Arrivals>(entries_[stream.value].arrivals) : std::span<const Arrivals>();
}

std::span<const DeliveryBook::Timely> DeliveryBook::timely(StreamIndex stream) const {
  return concerns(stream) ? std::span<const Timely>(entries_[stream.value].timely) : std::span<const Timely>();
}

}  // namespace takt::models
