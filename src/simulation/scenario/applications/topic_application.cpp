// SPDX-License-Identifier: Apache-2.0
#include "scenario/applications/topic_application.hpp"

#include <algorithm>
#include <utility>

#include "scenario/applications/dds_node.hpp"
#include "scenario/applications/gateway_bridge.hpp"
#include "sim/check.hpp"

namespace takt::scenario {
namespace {

constexpr models::AlarmId threads_alarm = 0;  // those of participants follow

plant::Criterion::Settings window_of(const ResolvedThread& thread, const ResolvedApplication& application,
                                     sim::Duration length, std::uint64_t expected, sim::Duration from) {
  return {length.ps(),  thread.offset.ps(),
          expected,     std::max(application.scheduler->after, from).ps(),
          thread.tests, application.scheduler->tolerance.ps()};
}

}  // namespace

TopicApplication::Live::Live(const ResolvedThread& thread, const Settings& of, const application::TopicShape& shape)
    : settings(&thread),
      topic(&shape),
      activations(thread.every, thread.offset, thread.response, of.seed, of.path + "/" + thread.name, of.instants),
      seen(of.instants) {
  if (thread.publishes)
    publication.emplace(shape, thread.payload);
  else
    subscription.emplace(shape);
  const ResolvedApplication& application = *of.application;
  for (const sim::Duration from : of.instants) {
    windows.push_back({from,
                       WindowCounter(window_of(thread, application, thread.window,
                                               static_cast<std::uint64_t>(thread.window / thread.every), from),
                                     application.scheduler_response, of.seed, of.path),
                       {}});
    if (!thread.publishes && !thread.filter)
      windows.back().values.emplace(window_of(thread, application, thread.value_window, thread.values_expected, from),
                                    application.scheduler_response, of.seed, of.path);
  }
}

TopicApplication::TopicApplication(Settings settings, ApplicationMonitor& monitor)
    : number_(settings.number),
      monitor_(&monitor),
      nodes_(std::move(settings.nodes)),
      bridge_(std::move(settings.bridge)) {
  const ResolvedApplication& application = *settings.application;
  for (std::size_t t = 0; t < application.threads.size(); ++t) {
    const ResolvedThread& thread = application.threads[t];
    Live& live = threads_.emplace_back(thread, settings, (*settings.topics)[thread.topic].shape);
    live.writer = std::move(settings.writers[t]);
    live.reader = std::move(settings.readers[t]);
    TAKT_CHECK((live.writer != nullptr) == thread.publishes && (live.reader != nullptr) != thread.publishes,
               "a thread publishes or subscribes");
    for (const ResolvedInput& input : thread.inputs)
      if (!input.stream.is_none()) heard_.emplace_back(input.stream, static_cast<std::uint32_t>(t));
    order_.push_back(static_cast<std::uint32_t>(t));
  }
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    for (const ResolvedParticipant::Heard& heard : nodes_[n]->settings().hears)
      heard_.emplace_back(heard.stream, static_cast<std::uint32_t>(threads_.size() + n));
  std::sort(heard_.begin(), heard_.end());
  std::stable_partition(order_.begin(), order_.end(),
                        [&](std::uint32_t t) { return !application.threads[t].publishes; });
}

TopicApplication::~TopicApplication() = default;

void TopicApplication::start(models::HostServices& host) {
  host_ = &host;
  const sim::LocalTime now = host.now();
  for (const auto& node : nodes_) node->start(host);
  if (bridge_) bridge_->start();
  for (Live& live : threads_) {
    if (live.writer) live.writer->start(host);
    if (live.reader) live.reader->start(host);
    live.newest.clear();
    if (live.publication) live.publication->restart();
    live.seen.for_each([](Live::Seen& seen, sim::LocalTime) { seen.round_trips.restart(); });
    live.activations.begin(now);
    live.report_windows([&](WindowCounter& windows) { windows.begin(now); });
  }
  plan(host);
  // Participants announce themselves when the run has begun, not while it is made: recorders come in between.
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    host.set_exact_alarm(static_cast<models::AlarmId>(threads_alarm + 1 + n), now);
}

void TopicApplication::crash() {
  if (has_crashed_) return;
  has_crashed_ = true;
  const sim::LocalTime now = host_->now();
  for (Live& live : threads_) {
    live.activations.end(now);
    live.working = live.waiting = std::nullopt;
    live.report_windows([&](WindowCounter& windows) {
      windows.close_until(now);
      windows.end();
    });
    if (live.writer) live.writer->crash();
    if (live.reader) live.reader->crash();
  }
  for (const auto& node : nodes_) node->crash();
  if (bridge_) bridge_->crash();
  monitor_->on_crash(number_);
}

void TopicApplication::restart(models::HostServices& host) {
  crash();
  has_crashed_ = false;
  start(host);
}

void TopicApplication::receive(models::HostServices& host, models::StreamIndex stream,
                               std::span<const std::byte> payload) {
  const auto at = std::lower_bound(heard_.begin(), heard_.end(), std::pair(stream, std::uint32_t{0}));
  TAKT_CHECK(at != heard_.end() && at->first == stream, "a stream that this application listens to");
  if (at->second < threads_.size()) {
    threads_[at->second].reader->receive(host, payload);
    return;
  }
  nodes_[at->second - threads_.size()]->receive(host, stream, payload);
  settle(host);
}

void TopicApplication::settle(models::HostServices& host) {
  if (nodes_.empty()) return;
  for (std::size_t n = 0; n < nodes_.size(); ++n) nodes_[n]->settle(host);
  for (Live& live : threads_)
    if (const auto outcome = live.writer ? live.writer->go_on(host) : std::nullopt) count(live, host.now(), *outcome);
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    nodes_[n]->settle(host);
    host.set_alarm(static_cast<models::AlarmId>(threads_alarm + 1 + n), nodes_[n]->next_wake());
  }
}

void TopicApplication::wake(models::HostServices& host, models::AlarmId alarm) {
  if (alarm >= job_alarm(0)) {
    job_is_done(host, static_cast<std::uint32_t>(alarm - job_alarm(0)));
    settle(host);
    return;
  }
  if (alarm != threads_alarm) {
    nodes_[alarm - threads_alarm - std::size_t{1}]->wake(host);
    settle(host);
    return;
  }
  const sim::LocalTime now = host.now();
  for (const std::uint32_t t : order_) {
    Live& live = threads_[t];
    if (live.activations.next() > now) continue;
    if (live.activations.has_jumped(now)) {
      live.activations.begin(now);
      live.report_windows([&](WindowCounter& windows) {
        windows.end();
        windows.begin(now);
      });
      if (live.activations.next() > now) continue;
    }
    if (const auto call = live.activations.act()) begin(host, t, *call);
  }
  plan(host);
  settle(host);
}

/// The thread is ready: what it does takes place when its processor has done it. While that lasts it takes up nothing
/// new; of what it has missed meanwhile it takes up the last.
void TopicApplication::begin(models::HostServices& host, std::uint32_t thread, const Activations::Call& call) {
  Live& live = threads_[thread];
  if (live.working) {
    live.waiting = call;
    return;
  }
  if (host.begin_job(thread, job_alarm(thread))) {
    live.working = call;
    return;
  }
  live.activations.finish(call);
  this->call(host, thread, host.now(), call.response);
}

void TopicApplication::job_is_done(models::HostServices& host, std::uint32_t thread) {
  Live& live = threads_[thread];
  const sim::LocalTime now = host.now();
  const Activations::Call done = *std::exchange(live.working, std::nullopt);
  if (const auto response = live.activations.response_at(done, now)) {
    live.activations.finish(done);
    call(host, thread, now, *response);
  }
  if (const auto next = std::exchange(live.waiting, std::nullopt)) begin(host, thread, *next);
}

void TopicApplication::plan(models::HostServices& host) {
  sim::LocalTime next = sim::LocalTime::never();
  for (const Live& live : threads_) next = std::min(next, live.activations.next());
  host.set_exact_alarm(threads_alarm, next);
}

void TopicApplication::call(models::HostServices& host, std::uint32_t thread, sim::LocalTime now,
                            sim::Duration response) {
  Live& live = threads_[thread];
  const sim::LocalTime due = live.activations.last_due();
  live.seen.add(due, [&](Live::Seen& seen) { seen.figures.response.add(response); });
  for (Live::Windows& each : live.windows) each.calls.add(due);
  monitor_->on_call(number_, thread, live.activations.done());
  if (live.writer)
    publish(host, live, now, due);
  else
    take(host, thread, now, due);
}

void TopicApplication::publish(models::HostServices& host, Live& live, sim::LocalTime now, sim::LocalTime due) {
  const auto value = next_of(live, now);
  if (!value) return;
  const WriteOutcome outcome = live.writer->write(host, *value);
  count(live, due, outcome);
  if (!live.settings->is_measured || outcome == WriteOutcome::refused) return;
  for (Live& each : threads_)
    if (each.settings->round_trip && &threads_[*each.settings->round_trip] == &live)
      each.seen.add(due, [&](Live::Seen& seen) { seen.round_trips.published(live.publication->fields(), now); });
}

std::optional<uadp::Octets> TopicApplication::next_of(Live& live, sim::LocalTime now) {
  if (bridge_) return bridge_->pull(now);
  if (!live.settings->copies) return live.publication->next();
  const Live& source = threads_[*live.settings->copies];
  return source.newest.empty() ? std::nullopt : live.publication->copy(source.newest);
}

void TopicApplication::count(Live& live, sim::LocalTime began, WriteOutcome outcome) {
  live.seen.add(began, [&](Live::Seen& seen) {
    switch (outcome) {
      case WriteOutcome::published:
        ++seen.figures.published;
        break;
      case WriteOutcome::refused:
        ++seen.figures.refused;
        break;
      case WriteOutcome::timed_out:
        ++seen.figures.timed_out;
        break;
      case WriteOutcome::waits:
        break;
    }
  });
}

void TopicApplication::take(models::HostServices& host, std::uint32_t thread, sim::LocalTime now, sim::LocalTime due) {
  Live& live = threads_[thread];
  live.seen.add(due, [&](Live::Seen& seen) {
    if (seen.lost_before) return;
    seen.lost_before = live.reader->lost();
    seen.displaced_before = live.reader->displaced();
    seen.filtered_before = live.reader->filtered();
  });
  std::uint64_t count = 0;
  while (const auto value = live.reader->next(host)) {
    if (bridge_) {
      bridge_->receive(*value, now);
    } else {
      const auto fields = live.subscription->take(*value);
      if (!fields) continue;
      live.newest.assign(fields->begin(), fields->end());
      if (live.settings->round_trip)
        live.seen.add(due, [&](Live::Seen& seen) { seen.round_trips.taken(*fields, now); });
    }
    ++count;
  }
  if (count == 0) return;
  const std::uint64_t kept = std::min<std::uint64_t>(count, live.settings->buffer);
  live.seen.add(due, [&](Live::Seen& seen) {
    seen.figures.arrived += count;
    seen.figures.buffered += kept;
    seen.figures.overwritten += count - kept;
  });
  for (Live::Windows& each : live.windows)
    if (each.values) each.values->add(due, kept);
  monitor_->on_values(number_, thread, count);
  if (live.settings->signal) monitor_->set_signal(*live.settings->signal, !live.topic->is_zero(live.newest), now - due);
}

ThreadFigures TopicApplication::figures(std::size_t thread, sim::LocalTime now, sim::Duration from) const {
  const Live& live = threads_[thread];
  const Live::Seen& seen = live.seen.from(from);
  ThreadFigures figures = seen.figures;
  if (live.settings->round_trip) figures.round_trip = seen.round_trips.figures();
  figures.activations = live.activations.decided(now, from);
  figures.done = live.activations.done(from);
  if (live.reader) {
    // Without a call since then nothing is known of it.
    const bool is_all = from == sim::Duration();
    if (is_all || seen.lost_before) figures.lost = live.reader->lost() - (is_all ? 0 : *seen.lost_before);
    if (live.settings->filter && (is_all || seen.lost_before))
      figures.filtered = live.reader->filtered() - (is_all ? 0 : seen.filtered_before);
    if (is_all || seen.lost_before)
      figures.overwritten += live.reader->displaced() - (is_all ? 0 : seen.displaced_before);
  }
  const auto windows = std::find_if(live.windows.begin(), live.windows.end(),
                                    [&](const Live::Windows& each) { return each.from == from; });
  TAKT_CHECK(windows != live.windows.end(), "figures are asked of instants from which windows are counted");
  const auto at_the_end = [&](WindowCounter counter) {
    if (!live.activations.has_jumped(now)) counter.close_until(now);
    return counter.figures();
  };
  figures.calls = at_the_end(windows->calls);
  if (windows->values) figures.values = at_the_end(*windows->values);
  return figures;
}

}  // namespace takt::scenario
