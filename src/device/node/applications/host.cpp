// SPDX-License-Identifier: Apache-2.0
#include "node/applications/host.hpp"

#include <algorithm>
#include <mutex>

#include "node/applications/deadlines.hpp"
#include "node/applications/tasks.hpp"
#include "node/applications/thread_group.hpp"
#include "node/real_node.hpp"
#include "node/secured_socket.hpp"
#include "plant/qos_of_thread.hpp"
#include "sim/check.hpp"

namespace takt::node {
namespace {

constexpr std::int64_t longest_sleep_ns = 50'000'000;  // so long after its end a thread still sleeps

std::int64_t ns_of(Duration duration) { return duration.ps() / 1000; }

std::int64_t monotonic_ns() { return DeadlineClock(ClockName::monotonic).now(); }

class DdsTopicWriter final : public TopicWriter {
 public:
  explicit DdsTopicWriter(DdsWriter& writer) : writer_(writer) {}
  SendOutcome write(uadp::Octets value) override { return writer_.write(value); }

 private:
  DdsWriter& writer_;
};

class DdsTopicReader final : public TopicReader {
 public:
  explicit DdsTopicReader(DdsReader& reader) : reader_(reader) {}
  std::span<const std::vector<std::byte>> take() override { return reader_.take(); }

 private:
  DdsReader& reader_;
};

gateway::BufferSettings buffer_of(const plant::Gateway& given) {
  constexpr gateway::Overflow overflows[] = {gateway::Overflow::overwrite_oldest, gateway::Overflow::drop_newest,
                                             gateway::Overflow::keep_latest};
  return {.capacity = given.buffer,
          .overflow = overflows[static_cast<std::size_t>(given.overflow)],
          .stale_after = given.stale_after};
}

}  // namespace

/// A thread of an application or gateway.
struct ApplicationHost::Task {
  std::unique_ptr<Work> work;
  Duration every;
  Duration offset;
  std::optional<std::uint64_t> tests;
  ThreadStatistics statistics;             ///< the thread's own until it has ended
  std::mutex mutex;                        ///< of the criteria: the thread adds, the scheduler looks
  std::optional<plant::Criterion> calls;   ///< since the scheduler runs, and so the next
  std::optional<plant::Criterion> values;  ///< of those that take all that comes
  bool gets_all = true;                    ///< no content filter keeps anything out
  std::optional<std::int64_t> window_end;  ///< of the window for which the next look was drawn
  std::int64_t look_at = 0;
  application::OutputLevel<sim::LocalTime> level;  ///< of the signal; the thread's own
  std::optional<std::int64_t> signal_epoch;

  /// The least multiple of the interval that is not shorter.
  std::int64_t window_of(const Scheduler& scheduler) const {
    return (ns_of(scheduler.window) + ns_of(every) - 1) / ns_of(every) * ns_of(every);
  }

  void begin_tests(const Scheduler& scheduler, std::int64_t now) {
    const std::int64_t length = window_of(scheduler);
    const auto expected = static_cast<std::uint64_t>(length / ns_of(every));
    const std::lock_guard lock(mutex);
    calls.emplace(plant::Criterion::Settings{length, ns_of(offset), expected, now + ns_of(scheduler.after),
                                             tests ? tests : scheduler.tests, ns_of(scheduler.tolerance)});
    calls->begin(now);
    if (gets_all && (statistics.role == "subscribe" || statistics.role == "receive")) values = calls;
  }

  /// There was a call for the activation that was due then, and so many values of it are in the buffer.
  void add(std::int64_t due, std::uint32_t buffered) {
    const std::lock_guard lock(mutex);
    if (calls) calls->add(due);
    if (values) values->add(due, buffered);
  }

  /// When the scheduler looks: at the end of the open window, and so long after as is drawn for it. Nothing when all
  /// tests are done. Asked by the scheduler alone.
  std::optional<std::int64_t> next_look(const sim::Distribution& response, sim::RandomStream& chance) {
    const std::lock_guard lock(mutex);
    const auto window = calls->open();
    if (!window) return std::nullopt;
    if (window->to != window_end) {
      window_end = window->to;
      look_at = window->to + ns_of(response.draw(chance));
    }
    return look_at;
  }

  void look(std::int64_t now) {
    const std::lock_guard lock(mutex);
    calls->look(now);
    if (values) values->look(now);
  }

  /// The call for the activation that was due then has taken something.
  void set_signal(bool high, std::int64_t due, std::int64_t now) {
    if (!statistics.signal) return;
    if (!signal_epoch) signal_epoch = now;  // clocks count from long before, and local time ends after 106 days
    const auto local = sim::LocalTime::from_ps((now - *signal_epoch) * 1000);
    SignalStatistics& signal = *statistics.signal;
    const auto edge = level.set(high, local);
    if (!edge) return;
    signal.figures.latency.add(Duration::from_ps((now - due) * 1000));
    level.count(*edge, local, signal.pulse, signal.figures);
  }
};

/// An application or gateway with its scheduler.
struct ApplicationHost::Watched {
  std::string name;
  Scheduler scheduler;
  NewestSamples newest;
  std::unique_ptr<SharedChannel> channel;  ///< of a gateway
  std::vector<std::unique_ptr<Task>> tasks;

  Task& add(std::unique_ptr<Work> work, Duration every, Duration offset, const char* role,
            const std::string& thread_name, const std::string& topic) {
    auto task = std::make_unique<Task>();
    task->work = std::move(work);
    task->every = every;
    task->offset = offset;
    task->statistics.name = thread_name;
    task->statistics.role = role;
    task->statistics.topic = topic;
    task->statistics.every_ns = ns_of(every);
    return *tasks.emplace_back(std::move(task));
  }
};

ApplicationHost::ApplicationHost(const LoadedApplications& loaded) : loaded_(loaded) {}

ApplicationHost::~ApplicationHost() = default;

std::unique_ptr<ApplicationHost> ApplicationHost::make(const LoadedApplications& loaded, std::string& problem,
                                                       std::string& warnings, KeyMailbox* keys) {
  // Before any thread is made: threads inherit it.
  if (loaded.config.realtime)
    if (const std::string refused = ask_for_real_time(); !refused.empty())
      warnings += "without real time: " + refused + "\n";
  std::unique_ptr<ApplicationHost> host(new ApplicationHost(loaded));
  return host->open(problem, keys) ? std::move(host) : nullptr;
}

bool ApplicationHost::open(std::string& problem, KeyMailbox* keys) {
  const ApplicationsConfig& config = loaded_.config;
  if (config.transport) {
    std::unique_ptr<Socket> socket =
        std::visit([&problem](const auto& transport) { return open_socket(transport, problem); }, *config.transport);
    if (!socket) return false;
    if (loaded_.secured) {
      security_ = NodeSecurity::make(*loaded_.secured, keys, problem);
      if (!security_) return false;
      socket = std::make_unique<SecuredSocket>(std::move(socket), *security_);
    }
    opc_ua_ = std::make_unique<OpcUaTopics>(std::move(socket), &monotonic_ns);
  }
  return std::all_of(config.applications.begin(), config.applications.end(),
                     [&](const auto& each) { return add_application(each, problem); }) &&
         std::all_of(config.gateways.begin(), config.gateways.end(),
                     [&](const auto& each) { return add_gateway(each, problem); });
}

DdsParticipant* ApplicationHost::participant_of(std::uint16_t domain, std::string& problem) {
  for (const auto& [id, participant] : participants_)
    if (id == domain) return participant.get();
  std::unique_ptr<DdsParticipant> participant = open_dds(domain, loaded_.config.dds.interface.value_or(""), problem);
  if (!participant) return nullptr;
  return participants_.emplace_back(domain, std::move(participant)).second.get();
}

TopicWriter* ApplicationHost::writer_of(const std::string& topic, std::uint16_t writer_group,
                                        const std::optional<plant::Qos>& qos, std::string& problem) {
  const std::size_t index = loaded_.topic(topic);
  const LoadedTopic& loaded = loaded_.topics[index];
  if (!loaded.shape.is_dds) return &opc_ua_->add_writer(loaded, writer_group);
  DdsParticipant* const participant = participant_of(loaded.domain, problem);
  DdsWriter* const writer =
      participant == nullptr
          ? nullptr
          : participant->add_writer(
                {topic, loaded.shape.type.name, plant::merged(loaded_.config.topics[index].qos, qos), loaded.shape.key},
                problem);
  return writer == nullptr ? nullptr : dds_writers_.emplace_back(std::make_unique<DdsTopicWriter>(*writer)).get();
}

TopicReader* ApplicationHost::reader_of(const std::string& topic, const std::optional<plant::Qos>& qos,
                                        const gateway::ContentFilter* filter, std::string& problem) {
  const std::size_t index = loaded_.topic(topic);
  const LoadedTopic& loaded = loaded_.topics[index];
  if (!loaded.shape.is_dds) return &opc_ua_->add_reader(loaded);
  DdsParticipant* const participant = participant_of(loaded.domain, problem);
  if (participant == nullptr) return nullptr;
  DdsTopic asked{topic, loaded.shape.type.name, plant::merged(loaded_.config.topics[index].qos, qos), loaded.shape.key};
  if (filter != nullptr) asked.passes = [filter](uadp::Octets payload) { return filter->passes(payload); };
  DdsReader* const reader = participant->add_reader(asked, problem);
  return reader == nullptr ? nullptr : dds_readers_.emplace_back(std::make_unique<DdsTopicReader>(*reader)).get();
}

bool ApplicationHost::add_application(const plant::Application& application, std::string& problem) {
  Watched& watched = *watched_.emplace_back(std::make_unique<Watched>());
  watched.name = application.name;
  watched.scheduler = application.scheduler;
  for (const Thread& thread : application.threads) {
    const std::string& topic = thread.publish ? *thread.publish : *thread.subscribe;
    const application::TopicShape& shape = loaded_.topics[loaded_.topic(topic)].shape;
    if (thread.publish) {
      TopicWriter* const writer =
          writer_of(topic, loaded_.writer_groups.at({application.name, thread.name}), thread.qos, problem);
      if (writer == nullptr) return false;
      watched
          .add(make_publishing(shape, *writer, thread.payload.value_or(Payload{}), watched.newest), thread.every,
               thread.offset, "publish", thread.name, topic)
          .tests = thread.tests;
    } else {
      const auto filter = loaded_.filters.find({application.name, thread.name});
      const bool is_filtered = filter != loaded_.filters.end();
      TopicReader* const reader = reader_of(topic, thread.qos, is_filtered ? &filter->second : nullptr, problem);
      if (reader == nullptr) return false;
      const bool is_copied =
          std::any_of(application.threads.begin(), application.threads.end(),
                      [&](const Thread& each) { return each.payload && each.payload->copy_of == topic; });
      Task& task =
          watched.add(make_subscribing(topic, shape, *reader, thread.buffer.value_or(1), is_copied, watched.newest),
                      thread.every, thread.offset, "subscribe", thread.name, topic);
      task.tests = thread.tests;
      task.gets_all = !is_filtered;
      if (thread.signal)
        task.statistics.signal = SignalStatistics{thread.signal->name, thread.signal->pulse.value_or(thread.every), {}};
    }
  }
  return true;
}

bool ApplicationHost::add_gateway(const plant::Gateway& given, std::string& problem) {
  std::vector<std::string> problems;
  auto mapping = application::mapping_between(loaded_.topics[loaded_.topic(given.from)].shape,
                                              loaded_.topics[loaded_.topic(given.to)].shape, problems);
  TAKT_CHECK(mapping.has_value(), "mappings have been checked");
  TopicReader* const reader = reader_of(given.from, std::nullopt, nullptr, problem);
  TopicWriter* const writer =
      reader == nullptr
          ? nullptr
          : writer_of(given.to, loaded_.writer_groups.at({given.name, sending_thread}), std::nullopt, problem);
  if (writer == nullptr) return false;
  Watched& watched = *watched_.emplace_back(std::make_unique<Watched>());
  watched.name = given.name;
  watched.scheduler = given.scheduler;
  watched.channel = std::make_unique<SharedChannel>(std::move(*mapping), buffer_of(given));
  watched.add(make_receiving(*reader, *watched.channel), given.receive_every, given.receive_offset, "receive",
              receiving_thread, given.from);
  watched.add(make_sending(*writer, *watched.channel), given.send_every, given.send_offset, "send", sending_thread,
              given.to);
  return true;
}

std::string ApplicationHost::path_of(const Watched& watched) const { return loaded_.config.node + "/" + watched.name; }

/// The random stream is that of the simulated thread: with its seed the same responses, one after the other.
application::ActivationPlan ApplicationHost::plan_of(const Watched& watched, const Task& task) const {
  const auto law = loaded_.responses.find({watched.name, task.statistics.name});
  return {task.every, law == loaded_.responses.end() ? at_once_ : law->second,
          sim::RandomStream(loaded_.config.seed, path_of(watched) + "/" + task.statistics.name, "response")};
}

void ApplicationHost::run_task(const Watched& watched, Task& task) {
  const DeadlineClock clock(loaded_.config.clock);
  Deadlines deadlines({ns_of(task.every), ns_of(task.offset)}, plan_of(watched, task), clock.now());
  ThreadStatistics& statistics = task.statistics;
  while (!is_over_.load(std::memory_order_relaxed)) {
    std::int64_t now = clock.now();
    if (now < deadlines.at()) {
      clock.wait_until(std::min(deadlines.at(), now + longest_sleep_ns));
      continue;
    }
    statistics.late.add(now - deadlines.at());
    if (!deadlines.awake(now)) continue;
    statistics.response.add(now - deadlines.due());
    const CallResult result = task.work->call(now);
    // A call that ends when the next activation is due already is that one's delay, not this one's failure.
    task.add(deadlines.due(), result.buffered);
    if (result.is_high) task.set_signal(*result.is_high, deadlines.due(), clock.now());
    ++statistics.calls;
    statistics.sent += result.sent;
    statistics.timed_out += result.timed_out;
    statistics.not_sent += result.not_sent;
    statistics.taken += result.taken;
    deadlines.next();
  }
  statistics.missed = deadlines.missed(clock.now());
}

void ApplicationHost::run_scheduler(Watched& watched) {
  const DeadlineClock clock(loaded_.config.clock);
  const auto law = loaded_.scheduler_responses.find(watched.name);
  const sim::Distribution& response = law == loaded_.scheduler_responses.end() ? at_once_ : law->second;
  std::vector<sim::RandomStream> chances(watched.tasks.size(),
                                         sim::RandomStream(loaded_.config.seed, path_of(watched), "scheduler"));
  for (const auto& task : watched.tasks) task->begin_tests(watched.scheduler, clock.now());
  while (!is_over_.load(std::memory_order_relaxed)) {
    std::optional<std::int64_t> next;
    const std::int64_t now = clock.now();
    for (std::size_t t = 0; t < watched.tasks.size(); ++t) {
      const auto at = watched.tasks[t]->next_look(response, chances[t]);
      if (!at) continue;
      if (*at <= now) watched.tasks[t]->look(now);
      next = next ? std::min(*next, *at) : *at;
    }
    if (!next) return;
    if (now < *next) clock.wait_until(std::min(*next, now + longest_sleep_ns));
  }
}

void ApplicationHost::run(bool (*stop_requested)(const void* context), const void* context) {
  const DeadlineClock clock(ClockName::monotonic);
  started_ = clock.now();
  ThreadGroup threads(is_over_);
  for (const auto& watched : watched_) {
    for (const auto& task : watched->tasks)
      threads.start([this, &of = *watched, &each = *task] { run_task(of, each); });
    threads.start([this, &each = *watched] { run_scheduler(each); });
  }
  while (!is_over_ && !stop_requested(context)) {
    const std::int64_t now = clock.now();
    const std::int64_t end =
        loaded_.config.duration ? started_ + ns_of(*loaded_.config.duration) : now + longest_sleep_ns;
    if (now >= end) break;
    clock.wait_until(std::min(end, now + longest_sleep_ns));
  }
  is_over_ = true;
  threads.join();
  // Nobody speaks any more: what had come and no activation has taken is not lost.
  for (const auto& watched : watched_)
    for (const auto& task : watched->tasks)
      if (task->statistics.role == "subscribe") task->statistics.taken += task->work->call(clock.now()).taken;
}

ApplicationsReport ApplicationHost::report() const {
  ApplicationsReport made{loaded_.config.node, statistics()};
  if (opc_ua_) made.sources = opc_ua_->sources();
  if (security_) made.security = security_->status();
  return made;
}

std::vector<ApplicationStatistics> ApplicationHost::statistics() const {
  std::vector<ApplicationStatistics> all;
  for (const auto& watched : watched_) {
    ApplicationStatistics& one = all.emplace_back();
    one.name = watched->name;
    one.is_gateway = watched->channel != nullptr;
    if (watched->channel) one.channel = watched->channel->channel.figures();
    for (const auto& task : watched->tasks) {
      ThreadStatistics& thread = one.threads.emplace_back(task->statistics);
      thread.lost = task->work->lost();
      if (!task->calls) continue;
      thread.window_ns = task->window_of(watched->scheduler);
      thread.call_windows = task->calls->figures();
      if (task->values) thread.value_windows = task->values->figures();
    }
  }
  return all;
}

}  // namespace takt::node
