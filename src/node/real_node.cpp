#include "node/real_node.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sched.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <utility>

namespace takt::node {
namespace {

constexpr int most_messages_at_once = 256;  // a flood does not keep the alarms waiting

wire::EndpointSettings with_incarnation(wire::EndpointSettings settings, std::uint32_t incarnation) {
  settings.handshake.incarnation = incarnation;
  return settings;
}

/// Another number at each start: the time of day in units of 67 ms, which no restart takes less than. Never 0.
std::uint32_t incarnation_now() {
  timespec time = {};
  ::clock_gettime(CLOCK_REALTIME, &time);
  return static_cast<std::uint32_t>((static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec) >> 26) | 1U << 31;
}

/// CPU time of this thread.
std::int64_t cpu_ns() {
  timespec time = {};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

}  // namespace

std::unique_ptr<RealNode> RealNode::make(const LoadedConfig& loaded, std::FILE* log, Application* application, std::string& problem, std::string& warnings) {
  const Config& config = loaded.config;
  std::unique_ptr<Socket> socket = std::visit([&problem](const auto& transport) { return open_socket(transport, problem); }, config.transport);
  if (!socket) return nullptr;
  std::string refused_launch;
  if (config.launch_lead) refused_launch = socket->enable_launch_times(config.clock);
  const std::uint32_t incarnation = incarnation_now();
  std::unique_ptr<RealNode> node(new RealNode(loaded, std::move(socket), log, application, incarnation));
  if (!node->timer_.is_open()) {
    problem = std::string("a timer: ") + std::strerror(errno);
    return nullptr;
  }
  if (!config.control || !config.control->empty()) {
    node->control_ = ControlSocket::open(config.control.value_or(default_control_path(config.node)), problem);
    if (!node->control_ && config.control) return nullptr;
    if (!node->control_) warnings += "without takt ctl: " + std::exchange(problem, {}) + "\n";
  }
  if (config.launch_lead && refused_launch.empty()) node->lead_ = *config.launch_lead;
  if (!refused_launch.empty()) warnings += "without launch times: " + refused_launch + "\n";
  if (config.realtime)
    if (const std::string refused = ask_for_real_time(); !refused.empty()) warnings += "without real time: " + refused + "\n";
  return node;
}

RealNode::RealNode(const LoadedConfig& loaded, std::unique_ptr<Socket> socket, std::FILE* log, Application* application, std::uint32_t incarnation)
    : config_(loaded.config),
      socket_(std::move(socket)),
      application_(application),
      clock_(loaded.config.clock, loaded.endpoint.cycle),
      log_(log),
      endpoint_(with_incarnation(loaded.endpoint, incarnation)),
      incarnation_(incarnation),
      alarms_(endpoint_.alarm_count(), sim::LocalTime::never()),
      peers_(endpoint_.participant().peer_count()) {
  std::stable_sort(config_.script.begin(), config_.script.end(), [](const ScriptEntry& a, const ScriptEntry& b) { return a.at < b.at; });
}

void RealNode::run(bool (*stop_requested)(const void* context), const void* context) {
  started_ = now();
  cpu_at_last_cycle_ns_ = cpu_ns();
  log_.started(clock_.nanoseconds_at(started_), config_.node, incarnation_);
  endpoint_.start(*this);
  std::vector<pollfd> waiting;
  waiting.reserve(3 + ControlSocket::most_clients);
  for (;;) {
    timer_.set(clock_, next_time());
    waiting.assign({{socket_->file_descriptor(), POLLIN, 0}, {timer_.file_descriptor(), POLLIN, 0}});
    if (control_) control_->add_to(waiting);
    // A signal interrupts the wait; one that came just before it is seen a second later.
    ::poll(waiting.data(), waiting.size(), 1000);
    if (stop_requested(context)) break;
    if (config_.duration && now() - started_ >= *config_.duration) break;
    take_received();
    wake_due(now());
    const bool is_asked = std::any_of(waiting.begin() + 2, waiting.end(), [](const pollfd& each) { return each.revents != 0; });
    if (is_asked) take_requests();
  }
  log_.ended(status_now());
}

program::StatusCode RealNode::call(program::Method method) {
  const program::StatusCode status = endpoint_.call(*this, method);
  log_.called(clock_.nanoseconds_at(now()), method, status);
  return status;
}

NodeStatus RealNode::status_now() const {
  const sim::LocalTime time = now();
  return {config_, endpoint_, cycles_, peers_, socket_->send_failures(), time, clock_.nanoseconds_at(time)};
}

sim::LocalTime RealNode::due(std::size_t alarm) const {
  const bool leads = alarm == wire::ProgramEndpoint::cycle_alarm && alarms_[alarm] != sim::LocalTime::never();
  return leads ? alarms_[alarm] - lead_ : alarms_[alarm];
}

sim::LocalTime RealNode::next_time() const {
  sim::LocalTime next = sim::LocalTime::never();
  for (std::size_t alarm = 0; alarm < alarms_.size(); ++alarm) next = std::min(next, due(alarm));
  if (next_call_ < config_.script.size()) next = std::min(next, started_ + config_.script[next_call_].at);
  if (config_.duration) next = std::min(next, started_ + *config_.duration);
  return next;
}

void RealNode::take_received() {
  for (int i = 0; i < most_messages_at_once; ++i) {
    const uadp::Octets message = socket_->next();
    if (message.empty()) return;
    endpoint_.receive(*this, message);
  }
}

/// Calls what is due by `now`; what that sets anew waits for the next turn of the loop.
void RealNode::wake_due(sim::LocalTime now) {
  if (due(wire::ProgramEndpoint::cycle_alarm) <= now) wake_cycle(now);
  for (; next_call_ < config_.script.size() && started_ + config_.script[next_call_].at <= now; ++next_call_) call(method_of(config_.script[next_call_].call));
  for (std::size_t alarm = wire::ProgramEndpoint::cycle_alarm + 1; alarm < alarms_.size(); ++alarm) {
    if (alarms_[alarm] > now) continue;
    alarms_[alarm] = sim::LocalTime::never();
    endpoint_.wake(*this, alarm);
  }
}

void RealNode::wake_cycle(sim::LocalTime now) {
  constexpr std::size_t alarm = wire::ProgramEndpoint::cycle_alarm;
  cycles_.late.add((now - due(alarm)).ps() / 1000);
  const std::uint64_t missed_before = endpoint_.missed_cycles();
  if (lead_ > Duration()) socket_->set_launch_time(clock_.nanoseconds_at(alarms_[alarm]));
  alarms_[alarm] = sim::LocalTime::never();
  endpoint_.wake(*this, alarm);
  socket_->set_launch_time(0);
  const std::int64_t cpu = cpu_ns();
  const std::int64_t used_ns = cpu - std::exchange(cpu_at_last_cycle_ns_, cpu);
  cycles_.cpu.add(used_ns);
  const std::uint64_t missed = endpoint_.missed_cycles() - missed_before;
  const std::uint64_t by_code = std::min(missed, static_cast<std::uint64_t>(used_ns / (config_.program.cycle.ps() / 1000)));
  cycles_.missed_by_code += by_code;
  cycles_.missed_by_system += missed - by_code;
}

void RealNode::take_requests() {
  while (const auto request = control_->next()) control_->answer(answer_to(*request));
}

/// Requests are method names in lower case, and "status".
std::string RealNode::answer_to(std::string_view request) {
  if (request == "status") return status();
  for (const program::MethodInfo& each : program::methods) {
    std::string name(each.name);
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (name != request) continue;
    const program::StatusCode status = call(each.method);
    return fmt::format("{{\"method\": \"{}\", \"status\": \"{}\", \"code\": {}, \"state\": \"{}\"}}", each.name, program::name_of(status),
                       static_cast<std::uint32_t>(status), handshake::name_of(state()));
  }
  return R"({"error": "unknown request"})";
}

void RealNode::publish(uadp::Octets network_message, const pubsub::Destination& destination) {
  socket_->publish(network_message, destination);
  if (destination.writer_group_id == wire::state_writer_group) peers_.published(endpoint_.participant().word(), now());
}

void RealNode::process_data(const wire::ProcessDataMessage& message) {
  if (application_ != nullptr) application_->consume(message.data_set, clock_.nanoseconds_at(now()), message.fields);
}

void RealNode::fill(std::uint8_t data_set, std::span<std::byte> fields) {
  if (application_ != nullptr) application_->produce(data_set, clock_.nanoseconds_at(now()), fields);
}

void RealNode::stepped(const handshake::Outputs& outputs, const handshake::Word&) {
  const std::int64_t time = clock_.nanoseconds_at(now());
  if (outputs.raised) log_.raised(time, outputs.raised_kind, outputs.alarm);
  for (const handshake::StateChange& change : outputs.changes()) {
    log_.changed(time, change);
    if (application_ != nullptr) application_->changed(change);
  }
}

std::string ask_for_real_time() {
  std::string refused;
  sched_param parameters = {};
  parameters.sched_priority = 50;
  if (::sched_setscheduler(0, SCHED_FIFO, &parameters) != 0) refused = std::string("SCHED_FIFO: ") + std::strerror(errno);
  if (::mlockall(MCL_CURRENT | MCL_FUTURE) != 0) refused += (refused.empty() ? "" : "; ") + std::string("locked memory: ") + std::strerror(errno);
  return refused;
}

}  // namespace takt::node
