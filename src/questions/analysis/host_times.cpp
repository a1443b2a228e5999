// SPDX-License-Identifier: Apache-2.0
#include "analysis/host_times.hpp"

#include <algorithm>
#include <utility>

#include "analysis/flow_graph.hpp"
#include "analysis/flow_sources.hpp"
#include "analysis/network_bound.hpp"
#include "analysis/response_times.hpp"
#include "models/ethernet/sizes.hpp"
#include "scenario/resolved/resolved_dds.hpp"

namespace takt::analysis {
namespace {

Ps width_of(const sim::Distribution& d) { return d.greatest().ps() - d.least().ps(); }
/// A length of a clock's time in true time, at least and at most.
Ps shortest_period(sim::Duration local, const ClockQuality& clock) {
  return std::max<Ps>(1, scaled_down(local.ps(), one_ppt, one_ppt + clock.fastest_ppt));
}
Ps in_true_time(Ps local, const ClockQuality& clock) { return scaled_up(local, one_ppt, one_ppt + clock.slowest_ppt); }

}  // namespace

bool overtakes_none(const scenario::ResolvedThread& thread, const ThreadTime& cpu, const ClockQuality& clock) {
  return sum(thread.response.greatest().ps(), scaled_up(cpu.worst, one_ppt + clock.rate_ppt, one_ppt), 2 * clock.error,
             1) < thread.every.ps();
}

namespace {

/// The jobs of one host, by thread.
class HostJobs {
 public:
  HostJobs(const scenario::Resolved& r, const FlowGraph& graph, const NetworkResult& network,
           const BoundOptions& options, const HostTimes& times, models::NodeIndex node)
      : r_(r),
        graph_(graph),
        network_(network),
        times_(times),
        node_(node),
        cpu_(*r.plan.nodes[node.value].cpu),
        clock_(clock_quality(r, node, options)),
        jobs_(cpu_.threads.size()) {}

  std::vector<std::vector<JobSource>> make() {
    for (std::uint32_t t = 0; t < cpu_.threads.size(); ++t)
      if (const auto& load = cpu_.threads[t].load)
        add_periodic(t, load->every, width_of(times_.wake_up(node_, t)), "its load");
    for (const scenario::ResolvedProgram& program : r_.programs)
      for (const scenario::ResolvedMember& member : program.members)
        if (member.node == node_ && member.cpu_thread) add_program(program, member);
    for (const scenario::ResolvedApplication& application : r_.applications)
      if (application.node == node_) add_application(application);
    for (const Flow& flow : graph_.flows) add_stack(flow);
    if (cpu_.gptp) add_gptp(*cpu_.gptp);
    return std::move(jobs_);
  }

 private:
  void add(std::uint32_t thread, FrameArrivals arrivals, std::string what, sim::Duration besides = {}) {
    jobs_[thread].push_back({std::move(arrivals),
                             std::max<Ps>(1, sum(cpu_.threads[thread].execution.greatest().ps(), besides.ps())),
                             std::move(what)});
  }
  void add_periodic(std::uint32_t thread, sim::Duration every, Ps jitter, std::string what) {
    add(thread, FrameArrivals({shortest_period(every, clock_), 1, 0, sum(jitter, 2 * clock_.error)}), std::move(what));
  }

  /// Each alarm is set for later than the turn that sets it by its whole time, so its expiries are that far apart but
  /// for the wake-up.
  void add_program(const scenario::ResolvedProgram& program, const scenario::ResolvedMember& member) {
    const std::uint32_t thread = *member.cpu_thread;
    if (program.has_roles()) return add(thread, {}, program.name + ", whose roles are settled while it runs,");
    if (!program.replies.empty()) return add(thread, {}, program.name + ", which replies,");
    const Ps wake_up = width_of(times_.wake_up(node_, thread));
    add_periodic(thread, program.description->cycle, wake_up, program.name);
    for (std::size_t peer = 1; peer < program.members.size(); ++peer)
      add_periodic(thread, program.receive_timeout, wake_up, program.name);
    const auto heard_before = jobs_[thread].size();
    for (const scenario::ResolvedMember& sender : program.members) {
      if (sender.node == node_) continue;
      add_heard(thread, sender.state, program.name, member.open);
      if (sender.roles) add_heard(thread, *sender.roles, program.name, member.open);
      for (const auto& data : sender.data)
        if (data) add_heard(thread, *data, program.name, member.open);
    }
    // An initialisation begins in a turn that hears something, or is called.
    if (program.description->initialisation >= program.description->cycle) {
      add_periodic(thread, program.description->initialisation, wake_up, program.name);
    } else {
      for (std::size_t i = heard_before, end = jobs_[thread].size(); i < end; ++i)
        add(thread, jobs_[thread][i].arrivals.delayed(wake_up), program.name);
      const auto calls = static_cast<std::int64_t>(r_.script.size()) + 1;
      add(thread, FrameArrivals({unbounded_ps, calls, 0, 0}), program.name);
    }
    if (member.seal > sim::Duration()) add_sealing(thread, program, member);
  }

  /// A job for each message that it sends.
  void add_sealing(std::uint32_t thread, const scenario::ResolvedProgram& program,
                   const scenario::ResolvedMember& member) {
    for (const Flow& flow : graph_.flows) {
      const bool is_own = flow.stream == member.state ||
                          std::ranges::find(member.data, std::optional(flow.stream)) != member.data.end();
      if (is_own) jobs_[thread].push_back({flow.sealing, member.seal.ps(), program.name});
    }
  }

  void add_application(const scenario::ResolvedApplication& application) {
    for (const scenario::ResolvedThread& thread : application.threads) {
      if (thread.cpu_thread) {
        // A call whose response is not over when the next one is due does not take place.
        const Ps latest = thread.every.ps() - 1;
        const Ps late =
            std::min(latest, thread.response.greatest().ps()) - std::min(latest, thread.response.least().ps());
        const ThreadTime& own = times_.of(node_, thread.cpu_thread);
        add_periodic(*thread.cpu_thread, thread.every,
                     sum(in_true_time(late, clock_), 1, overtakes_none(thread, own, clock_) ? 0 : own.worst),
                     application.name + "/" + thread.name);
      }
      if (!application.cpu_thread) continue;
      for (const scenario::ResolvedInput& input : thread.inputs)
        if (!input.stream.is_none()) add_heard(*application.cpu_thread, input.stream, application.name);
    }
    if (!application.cpu_thread) return;
    const bool is_dds = std::ranges::any_of(r_.dds->participants, [&](const scenario::ResolvedParticipant& each) {
      return &r_.applications[each.application] == &application;
    });
    if (is_dds) add(*application.cpu_thread, {}, application.name + ", whose participants of DDS are simulated,");
  }

  /// Messages of a stream, when the protocol stack has taken them in.
  void add_heard(std::uint32_t thread, models::StreamIndex stream, const std::string& what,
                 sim::Duration besides = {}) {
    for (const Flow& flow : graph_.flows)
      if (flow.stream == stream)
        for (const std::uint32_t last : last_hops(flow))
          add(thread, at_stack(last).delayed(times_.receive(node_).spread()), what, besides);
  }

  void add_stack(const Flow& flow) {
    if (flow.stream.is_none()) return;
    const std::string& name = r_.plan.streams[flow.stream.value].name;
    if (cpu_.transmit && r_.plan.streams[flow.stream.value].talker == node_) add(*cpu_.transmit, flow.at_stack, name);
    if (cpu_.receive)
      for (const std::uint32_t last : last_hops(flow)) add(*cpu_.receive, at_stack(last), name);
  }

  static Ps all_at_once(const std::vector<GptpMessages>& messages, Ps octet_time) {
    Ps all = 0;
    for (const GptpMessages& each : messages)
      all = sum(all, product(models::wire_length(each.frame).count * octet_time, each.arrivals.count(0)));
    return all;
  }
  /// The messages of its neighbours, which stand behind the flows of their ports.
  void add_gptp(std::uint32_t thread) {
    for (std::size_t p = 0; p < graph_.ports.size(); ++p) {
      if (graph_.ports[p].peer != node_) continue;
      const std::vector<GptpMessages> messages = gptp_messages(r_, graph_.ports[p].node);
      for (std::size_t m = 0; m < messages.size(); ++m) {
        // At a port that nothing else leaves all of them may be there at once.
        const std::size_t flow = graph_.ports[p].hops.size() + m;
        const Ps delay = flow < network_.ports[p].flows.size() ? network_.ports[p].flows[flow].delay
                                                               : all_at_once(messages, graph_.ports[p].octet_time);
        add(thread,
            graph_.ports[p].may_double || !is_bounded(delay) ? FrameArrivals() : messages[m].arrivals.delayed(delay),
            "gPTP");
      }
    }
  }

  /// The last hops to this host, each of which may bring every frame.
  std::vector<std::uint32_t> last_hops(const Flow& flow) const {
    const std::vector<models::NodeIndex>& listeners = r_.plan.streams[flow.stream.value].listeners;
    for (std::size_t l = 0; l < flow.last.size(); ++l)
      if (listeners[l] == node_) return flow.last[l];
    return {};
  }
  /// Frames when their last bits come to the node, and when the operating system hands them to the stack.
  FrameArrivals at_node(std::uint32_t hop) const {
    const HopResult& result = network_.hops[hop];
    if (graph_.ports[graph_.hops[hop].port].may_double || !is_bounded(result.delay)) return {};
    return network_.arrivals[hop].delayed(result.delay - result.least_delay);
  }
  FrameArrivals at_stack(std::uint32_t hop) const {
    return at_node(hop).delayed(width_of(r_.plan.os_latencies[r_.plan.nodes[node_.value].os_latency].receive) +
                                waits_in_order);
  }

  const scenario::Resolved& r_;
  const FlowGraph& graph_;
  const NetworkResult& network_;
  const HostTimes& times_;
  models::NodeIndex node_;
  const models::CpuPlan& cpu_;
  ClockQuality clock_;
  std::vector<std::vector<JobSource>> jobs_;
};

}  // namespace

HostTimes::HostTimes(const scenario::Resolved& resolved) : r_(&resolved), nodes_(resolved.plan.nodes.size()) {
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    if (!resolved.plan.nodes[n].cpu) continue;
    has_processors_ = true;
    for (const models::CpuThreadPlan& thread : resolved.plan.nodes[n].cpu->threads) {
      const Ps least = std::max<Ps>(1, thread.execution.least().ps());
      nodes_[n].push_back({least, std::max(least, thread.execution.greatest().ps())});
    }
  }
  for (const scenario::ResolvedProgram& program : resolved.programs)
    for (const scenario::ResolvedMember& member : program.members)
      if (member.cpu_thread && member.seal > sim::Duration()) {
        ThreadTime& time = nodes_[member.node.value][*member.cpu_thread];
        time.least = std::min(time.least, member.seal.ps());
      }
}

const sim::Distribution& HostTimes::wake_up(models::NodeIndex node, const std::optional<std::uint32_t>& thread) const {
  const models::NodePlan& plan = r_->plan.nodes[node.value];
  if (thread && plan.cpu->threads[*thread].wake_up) return *plan.cpu->threads[*thread].wake_up;
  return r_->plan.os_latencies[plan.os_latency].wake_up;
}

bool HostTimes::refine(const FlowGraph& graph, const NetworkResult& network, const BoundOptions& options) {
  moving_.clear();
  std::vector<std::vector<ThreadTime>> next = nodes_;
  for (std::uint32_t n = 0; n < nodes_.size(); ++n) {
    if (!r_->plan.nodes[n].cpu) continue;
    const std::vector<ThreadTime> found = response_times(
        *r_->plan.nodes[n].cpu, HostJobs(*r_, graph, network, options, *this, models::NodeIndex{n}).make());
    for (std::size_t t = 0; t < found.size(); ++t) {
      if (found[t].worst <= next[n][t].worst || !is_bounded(next[n][t].worst)) continue;
      next[n][t].worst = found[t].worst;
      next[n][t].reason = found[t].reason;
      moving_.emplace_back(n, t);
    }
  }
  nodes_ = std::move(next);
  return !moving_.empty();
}

void HostTimes::give_up() {
  for (const auto& [n, t] : moving_)
    nodes_[n][t] = {nodes_[n][t].least, unbounded_ps, "what it waits for does not come to rest"};
}

}  // namespace takt::analysis
