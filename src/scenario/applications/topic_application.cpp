#include "scenario/applications/topic_application.hpp"

#include <algorithm>
#include <utility>

#include "scenario/applications/dds_node.hpp"
#include "scenario/applications/gateway_bridge.hpp"
#include "sim/check.hpp"
#include "vocabulary/keys.hpp"

namespace takt::scenario {
namespace {

constexpr models::AlarmId threads_alarm = 0;   // those of participants follow

WindowCounter::Settings window_of(const ResolvedThread& thread, const ResolvedApplication& application, sim::Duration length, std::uint64_t expected) {
  return {length, thread.offset, expected, sim::LocalTime() + application.scheduler->after, thread.tests, application.scheduler->tolerance};
}

}  // namespace

TopicApplication::Live::Live(const ResolvedThread& thread, const ResolvedApplication& application, const SampleLayout& topic_layout, const std::string& path,
                             std::uint64_t seed)
    : settings(&thread),
      layout(&topic_layout),
      activations(thread.every, thread.offset, thread.response, seed, path + "/" + thread.name),
      calls(window_of(thread, application, thread.window, static_cast<std::uint64_t>(thread.window / thread.every)), application.scheduler_response, seed, path),
      sample(topic_layout.zeros()) {
  if (!thread.publishes) values.emplace(window_of(thread, application, thread.value_window, thread.values_expected), application.scheduler_response, seed, path);
}

TopicApplication::TopicApplication(Settings settings, ApplicationMonitor& monitor) : number_(settings.number), monitor_(&monitor), nodes_(std::move(settings.nodes)), bridge_(std::move(settings.bridge)) {
  const ResolvedApplication& application = *settings.application;
  for (std::size_t t = 0; t < application.threads.size(); ++t) {
    const ResolvedThread& thread = application.threads[t];
    Live& live = threads_.emplace_back(thread, application, (*settings.topics)[thread.topic].layout, settings.path, settings.seed);
    live.writer = std::move(settings.writers[t]);
    live.reader = std::move(settings.readers[t]);
    TAKT_CHECK((live.writer != nullptr) == thread.publishes && (live.reader != nullptr) != thread.publishes, "a thread publishes or subscribes");
    for (const ResolvedInput& input : thread.inputs)
      if (!input.stream.is_none()) heard_.emplace_back(input.stream, static_cast<std::uint32_t>(t));
    order_.push_back(static_cast<std::uint32_t>(t));
  }
  for (std::size_t n = 0; n < nodes_.size(); ++n)
    for (const ResolvedParticipant::Heard& heard : nodes_[n]->settings().hears) heard_.emplace_back(heard.stream, static_cast<std::uint32_t>(threads_.size() + n));
  std::sort(heard_.begin(), heard_.end());
  std::stable_partition(order_.begin(), order_.end(), [&](std::uint32_t t) { return !application.threads[t].publishes; });
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
    live.has_sample = false;
    live.publications = 0;
    live.activations.begin(now);
    live.calls.begin(now);
    if (live.values) live.values->begin(now);
  }
  plan(host);
  // Participants announce themselves when the run has begun, not while it is made: recorders come in between.
  for (std::size_t n = 0; n < nodes_.size(); ++n) host.set_exact_alarm(static_cast<models::AlarmId>(threads_alarm + 1 + n), now);
}

void TopicApplication::crash() {
  if (has_crashed_) return;
  has_crashed_ = true;
  const sim::LocalTime now = host_->now();
  for (Live& live : threads_) {
    live.activations.end(now);
    live.calls.close_until(now);
    live.calls.end();
    if (live.values) live.values->close_until(now);
    if (live.values) live.values->end();
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

void TopicApplication::receive(models::HostServices& host, models::StreamIndex stream, std::span<const std::byte> payload) {
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
    if (const auto outcome = live.writer ? live.writer->go_on(host) : std::nullopt) count(live.seen, *outcome);
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    nodes_[n]->settle(host);
    host.set_alarm(static_cast<models::AlarmId>(threads_alarm + 1 + n), nodes_[n]->next_wake());
  }
}

void TopicApplication::wake(models::HostServices& host, models::AlarmId alarm) {
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
      live.calls.end();
      live.calls.begin(now);
      if (live.values) live.values->end();
      if (live.values) live.values->begin(now);
      if (live.activations.next() > now) continue;
    }
    if (const auto response = live.activations.act()) call(host, t, now, *response);
  }
  plan(host);
  settle(host);
}

void TopicApplication::plan(models::HostServices& host) {
  sim::LocalTime next = sim::LocalTime::never();
  for (const Live& live : threads_) next = std::min(next, live.activations.next());
  host.set_exact_alarm(threads_alarm, next);
}

void TopicApplication::call(models::HostServices& host, std::uint32_t thread, sim::LocalTime now, sim::Duration response) {
  Live& live = threads_[thread];
  live.seen.response.add(response);
  live.calls.add(now);
  monitor_->on_call(number_, thread, live.activations.done());
  if (live.writer)
    publish(host, live, now);
  else
    take(host, thread, now);
}

void TopicApplication::publish(models::HostServices& host, Live& live, sim::LocalTime now) {
  if (bridge_) {
    const auto sample = bridge_->pull(now);
    if (!sample) return;
    std::copy(sample->begin(), sample->end(), live.sample.begin());
  } else if (live.settings->copies) {
    const Live& source = threads_[*live.settings->copies];
    if (!source.has_sample) return;
    live.sample = source.sample;
  } else {
    ++live.publications;
    live.layout->set_keys(live.sample, vocabulary::instance_of(live.settings->payload, live.publications));
    live.layout->set_first(live.sample, live.settings->pattern == Pattern::alternate ? live.publications % 2 : live.publications);
  }
  count(live.seen, live.writer->write(host, live.sample));
}

void TopicApplication::count(ThreadFigures& seen, WriteOutcome outcome) {
  switch (outcome) {
    case WriteOutcome::published: ++seen.published; break;
    case WriteOutcome::refused: ++seen.refused; break;
    case WriteOutcome::timed_out: ++seen.timed_out; break;
    case WriteOutcome::waits: break;
  }
}

void TopicApplication::take(models::HostServices& host, std::uint32_t thread, sim::LocalTime now) {
  Live& live = threads_[thread];
  std::uint64_t count = 0;
  while (const auto sample = live.reader->next(host)) {
    ++count;
    live.has_sample = true;
    std::copy(sample->begin(), sample->end(), live.sample.begin());
    if (bridge_) bridge_->receive(*sample, now);
  }
  if (count == 0) return;
  const std::uint64_t kept = std::min<std::uint64_t>(count, live.settings->buffer);
  live.seen.arrived += count;
  live.seen.buffered += kept;
  live.seen.overwritten += count - kept;
  live.values->add(now, kept);
  monitor_->on_values(number_, thread, count);
  if (live.settings->signal) monitor_->set_signal(*live.settings->signal, !live.layout->first_is_zero(live.sample));
}

ThreadFigures TopicApplication::figures(std::size_t thread, sim::LocalTime now) const {
  const Live& live = threads_[thread];
  ThreadFigures figures = live.seen;
  figures.activations = live.activations.decided(now);
  figures.done = live.activations.done();
  figures.lost = live.reader ? live.reader->lost() : 0;
  figures.overwritten += live.reader ? live.reader->displaced() : 0;
  WindowCounter calls = live.calls;
  if (!live.activations.has_jumped(now)) calls.close_until(now);
  figures.calls = calls.figures();
  if (live.values) {
    WindowCounter values = *live.values;
    if (!live.activations.has_jumped(now)) values.close_until(now);
    figures.values = values.figures();
  }
  return figures;
}

}  // namespace takt::scenario
