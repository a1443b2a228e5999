#include "node/real_node.hpp"

#include <poll.h>
#include <sched.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
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

}  // namespace

std::unique_ptr<RealNode> RealNode::make(const LoadedConfig& loaded, std::FILE* log, std::string& problem) {
  std::unique_ptr<Socket> socket = std::visit([&problem](const auto& transport) { return open_socket(transport, problem); }, loaded.config.transport);
  if (!socket) return nullptr;
  const auto incarnation = static_cast<std::uint32_t>(::time(nullptr));
  std::unique_ptr<RealNode> node(new RealNode(loaded, std::move(socket), log, incarnation));
  if (node->timer_.is_open()) return node;
  problem = std::string("a timer: ") + std::strerror(errno);
  return nullptr;
}

RealNode::RealNode(const LoadedConfig& loaded, std::unique_ptr<Socket> socket, std::FILE* log, std::uint32_t incarnation)
    : config_(loaded.config),
      socket_(std::move(socket)),
      clock_(loaded.config.clock, loaded.endpoint.cycle),
      log_(log),
      endpoint_(with_incarnation(loaded.endpoint, incarnation)),
      incarnation_(incarnation),
      alarms_(endpoint_.alarm_count(), sim::LocalTime::never()) {
  std::stable_sort(config_.script.begin(), config_.script.end(), [](const ScriptEntry& a, const ScriptEntry& b) { return a.at < b.at; });
}

void RealNode::run(bool (*stop_requested)(const void* context), const void* context) {
  started_ = now();
  log_.started(clock_.nanoseconds_at(started_), config_.node, incarnation_);
  endpoint_.start(*this);
  std::array<pollfd, 2> waiting{{{socket_->file_descriptor(), POLLIN, 0}, {timer_.file_descriptor(), POLLIN, 0}}};
  for (;;) {
    timer_.set(clock_, next_time());
    // A signal interrupts the wait; one that came just before it is seen a second later.
    ::poll(waiting.data(), waiting.size(), 1000);
    if (stop_requested(context)) break;
    if (config_.duration && now() - started_ >= *config_.duration) break;
    take_received();
    wake_due(now());
  }
  log_.ended(clock_.nanoseconds_at(now()), endpoint_, wakening_, socket_->send_failures());
}

sim::LocalTime RealNode::next_time() const {
  sim::LocalTime next = *std::min_element(alarms_.begin(), alarms_.end());
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
  for (; next_call_ < config_.script.size() && started_ + config_.script[next_call_].at <= now; ++next_call_) {
    const program::Method method = method_of(config_.script[next_call_].call);
    log_.called(clock_.nanoseconds_at(now), method, endpoint_.call(*this, method));
  }
  for (std::size_t alarm = 0; alarm < alarms_.size(); ++alarm) {
    if (alarms_[alarm] > now) continue;
    const std::int64_t late_ns = (now - alarms_[alarm]).ps() / 1000;
    ++wakening_.count;
    wakening_.sum_ns += late_ns;
    wakening_.greatest_ns = std::max(wakening_.greatest_ns, late_ns);
    alarms_[alarm] = sim::LocalTime::never();
    endpoint_.wake(*this, alarm);
  }
}

void RealNode::stepped(const handshake::Outputs& outputs, const handshake::Word&) {
  const std::int64_t time = clock_.nanoseconds_at(now());
  if (outputs.raised) log_.raised(time, outputs.raised_kind, outputs.alarm);
  for (const handshake::StateChange& change : outputs.changes()) log_.changed(time, change);
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
