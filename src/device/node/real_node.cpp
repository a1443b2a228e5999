// SPDX-License-Identifier: Apache-2.0
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

#include "json/diagnostics.hpp"

namespace takt::node {
namespace {

constexpr Duration look_every = Duration::from_ps(1'000'000'000'000);
constexpr std::size_t most_twins_told = 64;
constexpr int most_messages_at_once = 256;  // a flood does not keep the alarms waiting

/// Another number at each start: the time of day in units of 67 ms, which no restart takes less than. Never 0.
std::uint32_t incarnation_now() {
  timespec time = {};
  ::clock_gettime(CLOCK_REALTIME, &time);
  return static_cast<std::uint32_t>((static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec) >> 26) |
         1U << 31;
}

}  // namespace

std::unique_ptr<RealNode> RealNode::make(const LoadedConfig& loaded, Log& log,
                                         const std::vector<Application*>& applications, std::string& problem,
                                         std::string& warnings, HandOver* hand_over, KeyMailbox* keys) {
  const Config& config = loaded.config;
  std::unique_ptr<FollowingSocket> socket = FollowingSocket::open(config.transport, problem);
  if (!socket) return nullptr;
  std::string refused_launch;
  if (config.launch_lead) refused_launch = socket->enable_launch_times(config.clock);
  std::unique_ptr<RealNode> node(new RealNode(loaded, std::move(socket), log));
  node->hand_over_ = hand_over;
  if (!node->timer_.is_open()) {
    problem = std::string("a timer: ") + std::strerror(errno);
    return nullptr;
  }
  if (!config.control || !config.control->empty()) {
    node->control_ = ControlSocket::open(config.control.value_or(default_control_path(config.node)), problem);
    if (!node->control_ && config.control) return nullptr;
    if (!node->control_) warnings += "without takt ctl: " + std::exchange(problem, {}) + "\n";
  }
  if (loaded.key_access && keys == nullptr) {
    problem = "keys of a key service: whoever hosts this node does not pull them";
    return nullptr;
  }
  if (config.security) {
    node->security_ = NodeSecurity::make(loaded, keys, problem);
    if (!node->security_) return nullptr;
  }
  node->host(loaded, log, applications,
             config.launch_lead && refused_launch.empty() ? *config.launch_lead : Duration());
  if (!refused_launch.empty()) warnings += "without launch times: " + refused_launch + "\n";
  if (config.realtime)
    if (const std::string refused = ask_for_real_time(); !refused.empty())
      warnings += "without real time: " + refused + "\n";
  return node;
}

RealNode::RealNode(const LoadedConfig& loaded, std::unique_ptr<FollowingSocket> socket, Log& log)
    : config_(loaded.config),
      script_(loaded.script),
      outermost_(outermost(loaded.programs)),
      socket_(std::move(socket)),
      clock_(loaded.config.clock, loaded.programs.front().endpoint.cycle),
      out_(log),
      log_(log),
      incarnation_(incarnation_now()) {}

void RealNode::host(const LoadedConfig& loaded, Log& log, const std::vector<Application*>& applications,
                    Duration lead) {
  const bool are_several = loaded.programs.size() > 1;
  for (std::size_t i = 0; i < loaded.programs.size(); ++i)
    programs_.push_back(std::make_unique<HostedProgram>(
        loaded.programs[i],
        HostedProgram::Node{config_, *socket_, clock_, incarnation_, lead, security_.get(), hand_over_}, i,
        TransitionLog(log, are_several ? loaded.programs[i].program.name : std::string()),
        i < applications.size() ? applications[i] : nullptr));
  for (std::size_t i = 0; i < programs_.size(); ++i)
    if (const auto outer = loaded.programs[i].outer)
      nestings_.push_back(HostedProgram::nest(*programs_[*outer], *programs_[i]));
}

void RealNode::run(bool (*stop_requested)(const void* context), const void* context) {
  started_ = clock_.now();
  log_.started(clock_.nanoseconds_at(started_), config_.node, incarnation_);
  for (const auto& program : programs_) program->start();
  std::vector<pollfd> waiting;
  waiting.reserve(4 + ControlSocket::most_clients);
  for (;;) {
    timer_.set(clock_, next_time());
    waiting.assign({{socket_->file_descriptor(), POLLIN, 0},
                    {timer_.file_descriptor(), POLLIN, 0},
                    {hand_over_ != nullptr ? hand_over_->calls_descriptor() : -1, POLLIN, 0}});
    if (control_) control_->add_to(waiting);
    // A signal interrupts the wait; one that came just before it is seen a second later.
    ::poll(waiting.data(), waiting.size(), 1000);
    if (stop_requested(context)) break;
    if (config_.duration && clock_.now() - started_ >= *config_.duration) break;
    read_received();
    wake_due(clock_.now());
    if (waiting[2].revents != 0) read_calls();
    const bool is_asked =
        std::any_of(waiting.begin() + 3, waiting.end(), [](const pollfd& each) { return each.revents != 0; });
    if (is_asked) read_requests();
    if (clock_.now() - looked_around_ >= look_every) look_around();
    if (!out_.is_idle()) out_.flush();
    if (hand_over_ != nullptr) hand_over_->flush();
  }
  log_.ended(status_now());
}

NodeStatus RealNode::status_now(std::optional<std::size_t> only) const {
  const sim::LocalTime time = clock_.now();
  NodeStatus status{config_.node,
                    {},
                    clock_.nanoseconds_at(time),
                    sources_.all(),
                    out_.lines_left_out(),
                    security_ ? std::optional(security_->status()) : std::nullopt};
  status.server = server_;
  status.twins = sources_.twins(status.time_ns);
  if (!socket_->interface().empty())
    status.interface = InterfaceStatus{socket_->interface(), socket_->is_there(), socket_->bound_again()};
  for (std::size_t i = 0; i < programs_.size(); ++i)
    if (!only || *only == i) status.programs.push_back(programs_[i]->status(time, socket_->send_failures()));
  return status;
}

sim::LocalTime RealNode::next_time() const {
  sim::LocalTime next = sim::LocalTime::never();
  for (const auto& program : programs_) next = std::min(next, program->next_time());
  if (next_call_ < script_.size()) next = std::min(next, started_ + script_[next_call_].at);
  if (config_.duration) next = std::min(next, started_ + *config_.duration);
  return next;
}

void RealNode::read_received() {
  for (int i = 0; i < most_messages_at_once; ++i) {
    const auto arrival = socket_->take();
    if (!arrival) return;
    const wire::Verdict verdict = arrival->verdict == wire::Verdict::taken ? take(arrival->message) : arrival->verdict;
    const std::int64_t now_ns = clock_.nanoseconds_at(clock_.now());
    if (sources_.count(*arrival, verdict, now_ns))
      log_.refused(now_ns, to_text(arrival->from), publisher_id_of(arrival->message), wire::name_of(verdict));
  }
}

/// A message that no Program knows counts as foreign at the first.
wire::Verdict RealNode::take(uadp::Octets message) {
  if (security_) {
    const NodeSecurity::Opened opened = security_->open(message);
    if (opened.verdict != wire::Verdict::taken) return opened.verdict;
    message = opened.clear;
  }
  const auto found = programs_.size() == 1 ? programs_.begin()
                                           : std::find_if(programs_.begin(), programs_.end(),
                                                          [&](const auto& program) { return program->knows(message); });
  return (found == programs_.end() ? programs_.front() : *found)->receive(message);
}

void RealNode::wake_due(sim::LocalTime now) {
  for (const auto& program : programs_) program->wake_cycle(now);
  for (; next_call_ < script_.size() && started_ + script_[next_call_].at <= now; ++next_call_)
    act(script_[next_call_]);
  for (const auto& program : programs_) program->wake_others(now);
}

void RealNode::act(const LoadedCall& call) {
  HostedProgram& hosted = *programs_[call.program];
  if (const auto* const method = std::get_if<program::Method>(&call.what))
    hosted.call(*method);
  else
    hosted.change(std::get<Membership>(call.what));
}

/// Clients of the server call like anybody else.
void RealNode::read_calls() {
  hand_over_->clear_calls_wake();
  while (const auto call = hand_over_->next_call()) {
    const program::StatusCode status = call->program < programs_.size() ? programs_[call->program]->call(call->method)
                                                                        : program::StatusCode::BadNodeIdUnknown;
    hand_over_->report({.news = {}, .answered = call->serial, .status = status});
  }
}

void RealNode::look_around() {
  looked_around_ = clock_.now();
  const std::int64_t now_ns = clock_.nanoseconds_at(looked_around_);
  if (const std::string change = socket_->look(); !change.empty()) log_.noticed(now_ns, change);
  for (const SourceTable::Twins& each : sources_.twins(now_ns)) {
    if (told_twins_.size() >= most_twins_told ||
        std::find(told_twins_.begin(), told_twins_.end(), each) != told_twins_.end())
      continue;
    told_twins_.push_back(each);
    log_.twins(now_ns, each);
  }
}

void RealNode::read_requests() {
  if (hand_over_ != nullptr)
    if (const auto said = hand_over_->state()) server_ = *said;
  for (std::size_t i = 0; i < ControlSocket::most_clients; ++i) {
    const auto request = control_->next();
    if (!request) return;
    control_->answer(answer_to(*request));
  }
}

/// Requests are method names in lower case, "join", "leave" or "status"; behind a space there may be the name of a
/// Program.
std::string RealNode::answer_to(std::string_view request) {
  const std::string_view word = request.substr(0, request.find(' '));
  const std::string_view of = word.size() < request.size() ? request.substr(word.size() + 1) : std::string_view();
  if (word == "status" && of.empty()) return status();
  if (word == "join" || word == "leave")
    return answer_to_membership(word == "join" ? Membership::join : Membership::leave, of);
  std::string problem;
  const auto program = program_for(of, problem);
  if (!program) return fmt::format("{{\"error\": {}}}", json::quote(problem));
  HostedProgram& hosted = *programs_[*program];
  if (word == "status") return to_json(status_now(program));
  for (const program::MethodInfo& each : program::methods) {
    std::string name(each.name);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (name == word) return answer_of(hosted, each.name, hosted.call(each.method));
  }
  return R"({"error": "unknown request"})";
}

/// Without a name: in the only Program to which the node offers its skills.
std::string RealNode::answer_to_membership(Membership what, std::string_view of) {
  std::string problem;
  auto found =
      std::find_if(programs_.begin(), programs_.end(), [](const auto& program) { return program->is_candidate(); });
  if (!of.empty()) {
    const auto program = program_for(of, problem);
    if (!program) return fmt::format("{{\"error\": {}}}", json::quote(problem));
    if (!programs_[*program]->is_candidate()) found = programs_.end();
  }
  if (found == programs_.end())
    return fmt::format("{{\"error\": {}}}", json::quote(config_.node + " is not a candidate for roles" +
                                                        (of.empty() ? "" : " of " + std::string(of))));
  return answer_of(**found, what == Membership::join ? "Join" : "Leave", (*found)->change(what));
}

std::string RealNode::answer_of(const HostedProgram& hosted, std::string_view method,
                                program::StatusCode status) const {
  const std::string named =
      programs_.size() > 1 ? fmt::format("\"program\": {}, ", json::quote(hosted.name())) : std::string();
  return fmt::format("{{{}\"method\": \"{}\", \"status\": \"{}\", \"code\": {}, \"state\": \"{}\"}}", named, method,
                     program::name_of(status), static_cast<std::uint32_t>(status), handshake::name_of(hosted.state()));
}

std::optional<std::size_t> RealNode::program_for(std::string_view name, std::string& problem) const {
  if (name.empty() && outermost_) return outermost_;
  std::string names;
  for (std::size_t i = 0; i < programs_.size(); ++i) {
    if (programs_[i]->name() == name) return i;
    names += (i == 0 ? "" : ", ") + programs_[i]->name();
  }
  problem = name.empty() ? config_.node + " is in several programs, and none is nested in another; name one of " + names
                         : config_.node + " is not in program " + std::string(name) + ", but in " + names;
  return std::nullopt;
}

std::string ask_for_real_time() {
  std::string refused;
  sched_param parameters = {};
  parameters.sched_priority = 50;
  if (::sched_setscheduler(0, SCHED_FIFO, &parameters) != 0)
    refused = std::string("SCHED_FIFO: ") + std::strerror(errno);
  if (::mlockall(MCL_CURRENT | MCL_FUTURE) != 0)
    refused += (refused.empty() ? "" : "; ") + std::string("locked memory: ") + std::strerror(errno);
  return refused;
}

}  // namespace takt::node
