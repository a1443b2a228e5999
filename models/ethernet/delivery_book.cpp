#include "models/ethernet/delivery_book.hpp"

#include <algorithm>

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

std::span<const LaterAccount> DeliveryBook::accounts(StreamIndex stream) const {
  return concerns(stream) ? std::span<const LaterAccount>(entries_[stream.value].accounts) : std::span<const LaterAccount>();
}

std::span<const DeliveryBook::Arrivals> DeliveryBook::arrivals(StreamIndex stream) const {
  return concerns(stream) ? std::span<const Arrivals>(entries_[stream.value].arrivals) : std::span<const Arrivals>();
}

}  // namespace takt::models
