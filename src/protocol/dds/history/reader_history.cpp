// SPDX-License-Identifier: Apache-2.0
#include "dds/history/reader_history.hpp"

namespace takt::dds {

ReaderHistory::Place ReaderHistory::place_of(const Arrival& arrival) const {
  if (settings_.by_source) return {arrival.source.ps(), arrival.writer, arrival.number};
  return {arrivals_, {}, {}};
}

/// DDS 1.4, 2.2.3.9.2: the strongest writer that is alive; of equally strong ones the one with the lower GUID, so that
/// all readers agree.
bool ReaderHistory::may_write(const Instance& instance, const Arrival& arrival) const {
  if (!settings_.exclusive || !instance.owner || instance.owner->second == arrival.writer) return true;
  const auto& [strength, guid] = *instance.owner;
  return arrival.ownership_strength != strength ? arrival.ownership_strength > strength : arrival.writer < guid;
}

/// What leaves no room for one more sample of the instance; end() stands for an instance that is new.
std::optional<RejectedBy> ReaderHistory::obstacle(const Instances::iterator& at) const {
  const HistorySettings& limits = settings_.history;
  if (at == instances_.end() && instances_.size() >= limits.max_instances) return RejectedBy::instances_limit;
  const bool is_full = at != instances_.end() && at->second.places.size() >= limits.per_instance();
  if (is_full) return limits.keep_all ? std::optional(RejectedBy::samples_per_instance_limit) : std::nullopt;
  if (samples_.size() >= limits.max_samples) return RejectedBy::samples_limit;
  return std::nullopt;
}

bool ReaderHistory::has_room(const InstanceKey& key, sim::LocalTime now) {
  purge(now);
  return !obstacle(instances_.find(key));
}

Admission ReaderHistory::add(const Arrival& arrival, sim::LocalTime now) {
  purge(now);
  Instances::iterator at = instances_.find(arrival.key);
  if (arrival.kind != ChangeKind::alive) return end(at, arrival, now);
  if (arrival.expires <= now) return Admission::expired;
  // It is none of what this reader reads: no instance, deadline or owner follows from it.
  if (settings_.passes && !settings_.passes(arrival.payload)) {
    ++filtered_;
    return Admission::filtered;
  }

  const Place place = place_of(arrival);
  if (at != instances_.end()) {
    Instance& instance = at->second;
    instance.writers.insert(arrival.writer);
    if (!may_write(instance, arrival)) return Admission::not_owner;
    if (arrival.is_past && !settings_.history.keep_all && instance.accepted && arrival.source < instance.newest)
      return Admission::outdated;
    if (settings_.by_source && instance.taken && place < *instance.taken) return Admission::outdated;
    if (instance.accepted && now - *instance.accepted < settings_.minimum_separation) {
      deadlines_.updated(arrival.key, now);  // the writer keeps its deadline, whatever the reader leaves out
      return Admission::filtered;
    }
    const bool replaces = !settings_.history.keep_all && instance.places.size() >= settings_.history.per_instance();
    if (replaces && place < *instance.places.begin()) return Admission::outdated;
  }
  if (const std::optional<RejectedBy> reason = obstacle(at)) return reject(*reason, arrival.key);

  if (at == instances_.end()) at = instances_.try_emplace(arrival.key).first;
  Instance& instance = at->second;
  while (!settings_.history.keep_all && instance.places.size() >= settings_.history.per_instance())
    remove(samples_.find(*instance.places.begin()));
  revive(instance);
  instance.writers.insert(arrival.writer);
  if (settings_.exclusive) instance.owner = {arrival.ownership_strength, arrival.writer};
  instance.newest = instance.accepted ? std::max(instance.newest, arrival.source) : arrival.source;
  instance.accepted = now;
  instance.places.insert(place);
  deadlines_.updated(arrival.key, now);
  ++arrivals_;
  if (arrival.expires != sim::LocalTime::never()) expiries_.insert({arrival.expires, place});
  Stored& stored = samples_[place];
  stored.expires = arrival.expires;
  stored.sample.info = {arrival.writer, arrival.number, arrival.key, arrival.source, now};
  stored.sample.info.identity = arrival.identity;
  stored.sample.info.disposed_generation_count = instance.disposed_generations;
  stored.sample.info.no_writers_generation_count = instance.no_writers_generations;
  stored.sample.payload.assign(arrival.payload.begin(), arrival.payload.end());
  return Admission::accepted;
}

void ReaderHistory::revive(Instance& instance) {
  if (instance.state == InstanceState::alive) return;
  ++(instance.state == InstanceState::not_alive_disposed ? instance.disposed_generations
                                                         : instance.no_writers_generations);
  instance.state = InstanceState::alive;
  instance.is_new = true;
  instance.purge_at = sim::LocalTime::never();
}

/// Disposed, unregistered or both.
Admission ReaderHistory::end(Instances::iterator at, const Arrival& arrival, sim::LocalTime now) {
  if (at == instances_.end()) return Admission::accepted;  // nobody here knows the instance
  Instance& instance = at->second;
  const bool allowed = may_write(instance, arrival);
  const Place place = place_of(arrival);
  const bool is_outdated = settings_.by_source && ((instance.taken && place < *instance.taken) ||
                                                   (!instance.places.empty() && place < *instance.places.rbegin()));
  Stored told;
  told.sample.info = {arrival.writer, arrival.number, arrival.key, arrival.source, now, false};
  told.sample.info.identity = arrival.identity;
  if (disposes(arrival.kind) && allowed && !is_outdated && instance.state == InstanceState::alive)
    leave(at, InstanceState::not_alive_disposed, told);
  if (unregisters(arrival.kind)) {
    instance.writers.erase(arrival.writer);
    if (instance.owner && instance.owner->second == arrival.writer) instance.owner.reset();
    if (instance.writers.empty() && instance.state == InstanceState::alive)
      leave(at, InstanceState::not_alive_no_writers, told);
    forget_if_over(at);
  }
  return !allowed ? Admission::not_owner : is_outdated ? Admission::outdated : Admission::accepted;
}

/// The instance ends; a sample without data tells it, behind all that are there. It takes no room from the others.
void ReaderHistory::leave(Instances::iterator at, InstanceState state, const Stored& told) {
  Instance& instance = at->second;
  instance.state = state;
  deadlines_.forget(at->first);
  if (instance.invalid) invalid_.erase(*instance.invalid);
  Place place = settings_.by_source
                    ? Place{told.sample.info.source_timestamp.ps(), told.sample.info.writer, told.sample.info.number}
                    : Place{arrivals_++, {}, {}};
  if (!instance.places.empty() && place < *instance.places.rbegin()) place = *instance.places.rbegin();
  while (invalid_.contains(place) || samples_.contains(place))
    ++place.number;  // one writer ends several instances at once
  instance.invalid = place;
  Stored& stored = invalid_[place];
  stored = told;
  stored.sample.info.disposed_generation_count = instance.disposed_generations;
  stored.sample.info.no_writers_generation_count = instance.no_writers_generations;
  const sim::Duration delay = state == InstanceState::not_alive_disposed
                                  ? settings_.data_lifecycle.autopurge_disposed_samples_delay
                                  : settings_.data_lifecycle.autopurge_nowriter_samples_delay;
  instance.purge_at = told.sample.info.reception_timestamp.plus_saturated(delay);
  if (instance.purge_at != sim::LocalTime::never()) purges_.insert({instance.purge_at, at->first});
}

Admission ReaderHistory::reject(RejectedBy reason, const InstanceKey& key) {
  ++rejected_.total_count;
  rejected_.last_reason = reason;
  rejected_.last_instance = key;
  return Admission::rejected;
}

void ReaderHistory::remove(std::map<Place, Stored>::iterator stored) {
  TAKT_CHECK(stored != samples_.end(), "an instance knows its samples");
  const auto at = instances_.find(stored->second.sample.info.key);
  TAKT_CHECK(at != instances_.end(), "each sample has an instance");
  at->second.places.erase(stored->first);
  expiries_.erase({stored->second.expires, stored->first});
  samples_.erase(stored);
}

/// Instances that have ended are kept only for what the application has not seen, and for who may write them.
void ReaderHistory::forget_if_over(Instances::iterator at) {
  const Instance& instance = at->second;
  if (instance.state == InstanceState::alive || !instance.places.empty() || instance.invalid) return;
  if (settings_.exclusive && !instance.writers.empty()) return;
  deadlines_.forget(at->first);
  instances_.erase(at);
}

void ReaderHistory::purge(sim::LocalTime now) {
  while (!expiries_.empty() && expiries_.begin()->first <= now) {
    const auto stored = samples_.find(expiries_.begin()->second);
    const auto at = instances_.find(stored->second.sample.info.key);
    remove(stored);
    forget_if_over(at);
  }
  while (!purges_.empty() && purges_.begin()->first <= now) {
    const auto [time, key] = *purges_.begin();
    purges_.erase(purges_.begin());
    const auto at = instances_.find(key);
    if (at == instances_.end() || at->second.purge_at != time) continue;
    while (!at->second.places.empty()) remove(samples_.find(*at->second.places.begin()));
    if (at->second.invalid) invalid_.erase(*at->second.invalid);
    at->second.invalid.reset();
    forget_if_over(at);
  }
}

std::optional<Sample> ReaderHistory::take(sim::LocalTime now) {
  purge(now);
  if (!has_samples()) return std::nullopt;
  const bool is_data = !samples_.empty() && (invalid_.empty() || samples_.begin()->first < invalid_.begin()->first);
  const auto stored = is_data ? samples_.begin() : invalid_.begin();
  const auto at = instances_.find(stored->second.sample.info.key);
  TAKT_CHECK(at != instances_.end(), "each sample has an instance");
  Sample sample = std::move(stored->second.sample);
  sample.info.instance_state = at->second.state;
  sample.info.is_new_instance = at->second.is_new;
  at->second.is_new = false;
  at->second.taken = stored->first;
  if (is_data) {
    at->second.places.erase(stored->first);
    expiries_.erase({stored->second.expires, stored->first});
    samples_.erase(stored);
  } else {
    at->second.invalid.reset();
    invalid_.erase(stored);
  }
  forget_if_over(at);
  return sample;
}

std::vector<Sample> ReaderHistory::read(sim::LocalTime now) {
  purge(now);
  std::vector<Sample> all;
  auto data = samples_.begin();
  auto invalid = invalid_.begin();
  while (data != samples_.end() || invalid != invalid_.end()) {
    const bool is_data = data != samples_.end() && (invalid == invalid_.end() || data->first < invalid->first);
    Stored& stored = (is_data ? data++ : invalid++)->second;
    all.push_back(stored.sample);
    stored.sample.info.is_read = true;
    const Instance& instance = instances_.at(stored.sample.info.key);
    all.back().info.instance_state = instance.state;
    all.back().info.is_new_instance = instance.is_new;
  }
  for (const Sample& sample : all) instances_.at(sample.info.key).is_new = false;
  return all;
}

void ReaderHistory::writer_gone(const Guid& writer, sim::LocalTime now) {
  for (auto next = instances_.begin(); next != instances_.end();) {
    const auto at = next++;
    Instance& instance = at->second;
    if (instance.owner && instance.owner->second == writer) instance.owner.reset();
    if (instance.writers.erase(writer) == 0) continue;
    Stored told;
    told.sample.info = {writer, {}, at->first, now, now, false};
    told.sample.info.identity = writer;
    if (instance.writers.empty() && instance.state == InstanceState::alive)
      leave(at, InstanceState::not_alive_no_writers, told);
    forget_if_over(at);
  }
}

void ReaderHistory::advance(sim::LocalTime now) {
  deadlines_.advance(now, [&](const InstanceKey& key) {
    ++deadline_missed_.total_count;
    deadline_missed_.last_instance = key;
    instances_.at(key).owner.reset();
  });
}

std::optional<Guid> ReaderHistory::owner_of(const InstanceKey& key) const {
  const auto at = instances_.find(key);
  if (at == instances_.end() || !at->second.owner) return std::nullopt;
  return at->second.owner->second;
}

}  // namespace takt::dds
