// SPDX-License-Identifier: Apache-2.0
#include "dds/history/writer_history.hpp"

#include "dds/history/expiry.hpp"

namespace takt::dds {

WriterHistory::WriterHistory(const Settings& settings) : settings_(settings), deadlines_(settings.deadline) {
  TAKT_CHECK(settings_.history.per_instance() >= 1, "a history has room");
}

std::optional<NoRoom> WriterHistory::obstacle(const InstanceKey& key, sim::LocalTime now) {
  expire(now);
  const HistorySettings& limits = settings_.history;
  const auto at = instances_.find(key);
  if (at == instances_.end() && instances_.size() >= limits.max_instances) return NoRoom::max_instances;
  const bool replaces =
      !limits.keep_all && at != instances_.end() && at->second.numbers.size() >= limits.per_instance();
  if (replaces) return std::nullopt;
  if (at != instances_.end() && at->second.numbers.size() >= limits.per_instance() && !give_up(at->second))
    return NoRoom::max_samples_per_instance;
  if (changes_.size() >= limits.max_samples && !give_up_any()) return NoRoom::max_samples;
  return std::nullopt;
}

const CacheChange& WriterHistory::add(ChangeKind kind, const InstanceKey& key, std::span<const std::byte> payload,
                                      sim::LocalTime now) {
  CacheChange change;
  change.kind = kind;
  change.key = key;
  change.source = now;
  change.payload.assign(payload.begin(), payload.end());
  return add(std::move(change), now);
}

const CacheChange& WriterHistory::add(CacheChange change, sim::LocalTime now) {
  change.number = last_ + 1;
  change.expires = expiry_of(change.source, settings_.lifespan);
  const ChangeKind kind = change.kind;
  const InstanceKey key = change.key;
  place(std::move(change));
  unregisters(kind) ? deadlines_.forget(key) : deadlines_.updated(key, now);
  return changes_.rbegin()->second;
}

void WriterHistory::restore(CacheChange change) { place(std::move(change)); }

void WriterHistory::place(CacheChange change) {
  TAKT_CHECK(change.number > last_, "numbers grow");
  last_ = change.number;
  Instance& instance = instances_[change.key];
  while (!settings_.history.keep_all && instance.numbers.size() >= settings_.history.per_instance()) {
    const auto oldest = changes_.find(*instance.numbers.begin());
    instance.numbers.erase(instance.numbers.begin());  // not by remove(), which might forget the instance
    erase(oldest);
  }
  TAKT_CHECK(changes_.size() < settings_.history.max_samples, "there is room for a change that is added");
  instance.numbers.insert(change.number);
  instance.unregistered = unregisters(change.kind);
  if (change.expires != sim::LocalTime::never()) expiries_.insert({change.expires, change.number});
  changes_.emplace_hint(changes_.end(), change.number, std::move(change));
}

const CacheChange* WriterHistory::find(SequenceNumber number) const {
  const auto at = changes_.find(number);
  return at == changes_.end() ? nullptr : &at->second;
}

const CacheChange* WriterHistory::at_or_after(SequenceNumber number) const {
  const auto at = changes_.lower_bound(number);
  return at == changes_.end() ? nullptr : &at->second;
}

SequenceNumber WriterHistory::first() const { return changes_.empty() ? last_ + 1 : changes_.begin()->first; }

WriterHistory::Changes::iterator WriterHistory::remove(Changes::iterator change) {
  const auto instance = instances_.find(change->second.key);
  TAKT_CHECK(instance != instances_.end(), "each change has an instance");
  instance->second.numbers.erase(change->first);
  if (instance->second.unregistered && instance->second.numbers.empty()) instances_.erase(instance);
  return erase(change);
}

WriterHistory::Changes::iterator WriterHistory::erase(Changes::iterator change) {
  expiries_.erase({change->second.expires, change->first});
  if (settings_.removed) settings_.removed(change->first, change->first == last_);
  return changes_.erase(change);
}

void WriterHistory::release(SequenceNumber number) {
  if (number <= released_below_) return;
  auto at = changes_.begin();
  if (settings_.keeps_released) at = changes_.lower_bound(released_below_);
  released_below_ = number;
  if (!settings_.keeps_released) {
    while (at != changes_.end() && at->first < number) at = remove(at);
    return;
  }
  // All that a transient-local history drops: instances that are gone for good.
  std::set<InstanceKey> gone;
  for (; at != changes_.end() && at->first < number; ++at) {
    const Instance& instance = instances_.at(at->second.key);
    if (instance.unregistered && *instance.numbers.rbegin() == at->first) gone.insert(at->second.key);
  }
  for (const InstanceKey& key : gone) {
    const std::set<SequenceNumber> numbers = instances_.at(key).numbers;
    for (const SequenceNumber each : numbers) remove(changes_.find(each));
  }
}

bool WriterHistory::give_up(const Instance& instance) {
  if (instance.numbers.empty() || *instance.numbers.begin() >= released_below_) return false;
  remove(changes_.find(*instance.numbers.begin()));
  return true;
}

bool WriterHistory::give_up_any() {
  if (changes_.empty() || changes_.begin()->first >= released_below_) return false;
  remove(changes_.begin());
  return true;
}

void WriterHistory::expire(sim::LocalTime now) {
  while (!expiries_.empty() && expiries_.begin()->first <= now) remove(changes_.find(expiries_.begin()->second));
}

}  // namespace takt::dds
