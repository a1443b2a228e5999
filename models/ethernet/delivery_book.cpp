#include "models/ethernet/delivery_book.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::models {

DeliveryBook::Entry& DeliveryBook::entry_of(StreamIndex stream) {
  if (entries_.size() <= stream.value) entries_.resize(stream.value + std::size_t{1});
  entries_[stream.value].is_kept = true;
  return entries_[stream.value];
}

void DeliveryBook::keep_account(StreamIndex stream, sim::TrueTime from) { entry_of(stream).accounts.emplace_back().from = from; }

void DeliveryBook::keep_arrivals(StreamIndex stream, NodeIndex listener) { entry_of(stream).arrivals.push_back({listener, {}}); }

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
    if (arrivals.listener == listener) arrivals.ledger.arrive(frame.sequence);
}

void DeliveryBook::drop(const Frame& frame, DropReason reason) {
  if (!concerns(frame.stream)) return;
  Entry& entry = entries_[frame.stream.value];
  for (LaterAccount& account : entry.accounts) {
    if (frame.produced < account.from) continue;
    account.first_sequence = std::min(account.first_sequence, frame.sequence);
    ++account.dropped[static_cast<std::size_t>(reason)];
  }
  for (Arrivals& arrivals : entry.arrivals) {
    if (!arrivals.ledger.has_many_gaps()) continue;
    std::vector<std::uint64_t> boundaries;
    for (const LaterAccount& account : entry.accounts) boundaries.push_back(account.first_sequence);
    arrivals.ledger.fold(boundaries);
  }
}

void DeliveryBook::adopt(const DeliveryBook& other) {
  TAKT_CHECK(entries_.size() == other.entries_.size() && !keeps_arrivals() && !other.keeps_arrivals(), "parts of a run keep the same accounts, and no arrivals");
  for (std::size_t e = 0; e < entries_.size(); ++e) {
    for (std::size_t a = 0; a < entries_[e].accounts.size(); ++a) {
      LaterAccount& account = entries_[e].accounts[a];
      const LaterAccount& more = other.entries_[e].accounts[a];
      account.first_sequence = std::min(account.first_sequence, more.first_sequence);
      account.delivered += more.delivered;
      account.latency.add(more.latency);
      for (std::size_t reason = 0; reason < account.dropped.size(); ++reason) account.dropped[reason] += more.dropped[reason];
    }
  }
}

bool DeliveryBook::keeps_arrivals() const {
  return std::any_of(entries_.begin(), entries_.end(), [](const Entry& entry) { return !entry.arrivals.empty(); });
}

std::span<const LaterAccount> DeliveryBook::accounts(StreamIndex stream) const {
  return concerns(stream) ? std::span<const LaterAccount>(entries_[stream.value].accounts) : std::span<const LaterAccount>();
}

std::span<const DeliveryBook::Arrivals> DeliveryBook::arrivals(StreamIndex stream) const {
  return concerns(stream) ? std::span<const Arrivals>(entries_[stream.value].arrivals) : std::span<const Arrivals>();
}

}  // namespace takt::models
