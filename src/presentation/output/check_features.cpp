// SPDX-License-Identifier: Apache-2.0
#include "output/check_features.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "output/text_report.hpp"

namespace takt::output {
namespace {

using scenario::Resolved;

/// Parts of a line with separators.
class Line {
 public:
  void add(const std::string& part) { text_ += (text_.empty() ? "" : "; ") + part; }
  void count(std::size_t n, std::string_view one, std::string_view several) {
    if (n > 0) add(fmt::format("{} {}", n, n == 1 ? one : several));
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

class Page {
 public:
  explicit Page(std::string_view title) : title_(title) {}
  void add(std::string who, const std::string& what) {
    if (!what.empty()) rows_.emplace_back(std::move(who), what);
  }
  std::string text(std::size_t most_rows) const {
    if (rows_.empty()) return {};
    const std::size_t shown = std::min(rows_.size(), most_rows);
    std::size_t width = 0;
    for (std::size_t i = 0; i < shown; ++i) width = std::max(width, rows_[i].first.size());
    std::string out = fmt::format("\n{}\n", title_);
    for (std::size_t i = 0; i < shown; ++i)
      out += fmt::format("  {:<{}}  {}\n", rows_[i].first, width, rows_[i].second);
    if (rows_.size() > shown) out += fmt::format("  ... {} more\n", rows_.size() - shown);
    return out;
  }

 private:
  std::string_view title_;
  std::vector<std::pair<std::string, std::string>> rows_;
};

std::string classes(models::ClassSet set) {
  std::string text;
  for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
    if (models::contains(set, q)) text += fmt::format(" {}", q);
  return text;
}

std::string gates_text(const models::GateConfig& gates) {
  std::string text = fmt::format("gates: {} entr{}, cycle {}", gates.admin_control_list.size(),
                                 gates.admin_control_list.size() == 1 ? "y" : "ies", readable(gates.admin_cycle_time));
  if (gates.admin_base_time != sim::LocalTime()) text += ", base time " + readable(gates.admin_base_time.since_start());
  if (gates.is_running) text += ", running";
  return text;
}

std::string preemption_text(const models::PreemptionConfig& preemption) {
  std::string text = "preemptable:" + classes(preemption.preemptable);
  if (preemption.add_frag_size.value() > 0) text += fmt::format(", addFragSize {}", preemption.add_frag_size.value());
  if (preemption.hold_advance) text += ", hold advance " + readable(*preemption.hold_advance);
  return text;
}

std::string shares_text(const models::ShapingConfig& shaping) {
  std::string text = "ETS:";
  for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
    if (const auto* const share = std::get_if<models::EnhancedTransmissionSelection>(&shaping.selection[q]))
      text += fmt::format(" {} ({} %)", q, share->bandwidth);
  return text;
}

/// In a class that sends by eligibility times, a host without ATS schedulers has launch times.
std::string port_text(const models::PortConfig& config, bool has_launch_times) {
  Line line;
  if (config.shaping.gates) line.add(gates_text(*config.shaping.gates));
  for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
    if (const models::CreditBased* const shaper = config.shaping.shaper_of(q))
      line.add(fmt::format("shaper of class {}: {}{}", q, json::to_text(shaper->idle_slope),
                           shaper->of_whole_cycle ? "" : " while open"));
  if (config.shaping.shared() != 0) line.add(shares_text(config.shaping));
  if (const models::ClassSet timed = config.shaping.timed(); timed != 0)
    line.add((has_launch_times ? "launch times:" : "ATS:") + classes(timed));
  for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
    if (config.shaping.queue_max_sdu[q].count > 0)
      line.add(fmt::format("SDU of class {}: at most {} B", q, config.shaping.queue_max_sdu[q].count));
  if (config.preemption) line.add(preemption_text(*config.preemption));
  if (config.cut_through != 0) line.add("cut through:" + classes(config.cut_through));
  if (config.untagged) line.add("untagged");
  return line.text();
}

std::string ports_page(const Resolved& r, std::size_t most_rows) {
  Page page("Ports beyond strict priority (numbers are traffic classes)");
  const auto is_shaped = [&](models::NodeIndex node) {
    return std::ranges::any_of(r.plan.talker_ats, [&](const models::TalkerAtsPlan& shaped) {
      return r.plan.streams[shaped.stream.value].talker == node;
    });
  };
  const auto add = [&](const models::LinkPlan::End& end, const models::LinkPlan::End& peer) {
    const models::NodePlan& node = r.plan.nodes[end.node.value];
    page.add(fmt::format("{}:{} to {}", node.name, end.port, r.plan.nodes[peer.node.value].name),
             port_text(r.plan.port_configs[end.port_config.value_or(node.port_config)],
                       !node.forwards() && !is_shaped(end.node)));
  };
  for (const models::LinkPlan& link : r.plan.links) {
    add(link.a, link.b);
    add(link.b, link.a);
  }
  return page.text(most_rows);
}

/// What a file leaves to takt.
std::string offsets_page(const Resolved& r, std::size_t most_rows) {
  Page page("Offsets that were chosen (\"auto\")");
  for (const scenario::ResolvedOffset& each : r.chosen_offsets)
    page.add(each.name, fmt::format("{} of each {}", readable(each.offset), readable(each.period)));
  return page.text(most_rows);
}

/// The windows of automatic gates.
std::string windows_page(const Resolved& r, std::size_t most_rows) {
  if (!r.gates) return {};
  Page page("Windows of scheduled streams, margins included");
  const scenario::GateProblem& problem = r.gates->problem;
  for (std::size_t s = 0; s < problem.streams.size(); ++s) {
    const scenario::ScheduledStream& stream = problem.streams[s];
    for (std::size_t h = 0; h < stream.hops.size(); ++h) {
      const scenario::StreamWindow& window = r.gates->schedule.windows[s][h];
      const sim::Duration whole = stream.period * (window.open / stream.period);
      page.add(stream.name,
               fmt::format("{}: {} to {} of each {}", problem.ports[stream.hops[h].port].name,
                           readable(window.open - whole), readable(window.close - whole), readable(stream.period)));
    }
  }
  return page.text(most_rows);
}

std::string cqf_text(const scenario::Cqf& cqf) {
  std::string text = fmt::format("CQF: {} buffers of {}, classes", cqf.classes.size(), readable(cqf.cycle));
  for (const std::uint8_t q : cqf.classes) text += fmt::format(" {}", q);
  return text;
}

std::string ingress_page(const Resolved& r, std::size_t most_rows) {
  Page page("Ingress of switches");
  for (std::size_t n = 0; n < r.plan.nodes.size(); ++n) {
    if (!r.plan.nodes[n].ingress) continue;
    const models::IngressConfig& config = r.plan.ingress_configs[*r.plan.nodes[n].ingress];
    Line line;
    const scenario::Relay* const relay = scenario::relay_of(r.topology.nodes[n].description);
    if (relay != nullptr && relay->ingress && relay->ingress->cqf) line.add(cqf_text(*relay->ingress->cqf));
    line.count(config.stream_filters.size(), "stream filter", "stream filters");
    line.count(config.stream_gates.size(), "stream gate", "stream gates");
    line.count(config.flow_meters.size(), "flow meter", "flow meters");
    line.count(config.ats_schedulers.size(), "ATS scheduler", "ATS schedulers");
    line.count(config.recoveries.size(), "stream merged", "streams merged");
    line.count(config.splits.size(), "stream split", "streams split");
    page.add(r.plan.nodes[n].name, line.text());
  }
  return page.text(most_rows);
}

std::string redundancy_page(const Resolved& r, std::size_t most_rows) {
  Page page("Redundant streams");
  for (const scenario::ResolvedRedundancy& redundancy : r.redundancies) {
    const scenario::Redundancy& description = *redundancy.description;
    const std::string& name = r.plan.streams[redundancy.stream.value].name;
    const bool has_trees = redundancy.merge == scenario::ResolvedRedundancy::nobody;
    std::string what = fmt::format("{} members, split at {}, merged at {}, {} recovery", redundancy.members.size(),
                                   r.topology.nodes[redundancy.split].name,
                                   has_trees ? "each receiver" : r.topology.nodes[redundancy.merge].name,
                                   scenario::spelling(description.algorithm));
    if (description.algorithm == scenario::Recovery::vector) what += fmt::format(" of {} numbers", description.history);
    if (description.individual) what += ", individual recovery";
    if (description.latent_errors)
      what += ", latent errors tested every " + readable(description.latent_errors->period);
    page.add(name, what);
  }
  return page.text(most_rows);
}

/// When something goes wrong, and for how long.
template <class F>
std::string when(const F& fault) {
  return fmt::format("at {}{}", readable(fault.at), fault.lasts ? " for " + readable(*fault.lasts) : std::string());
}

std::string link_text(const std::vector<std::string>& ends) { return ends.at(0) + " - " + ends.at(1); }

struct FaultText {
  std::string operator()(const scenario::LinkDown& fault) const {
    return fmt::format("{} is down {}", link_text(fault.link), when(fault));
  }
  std::string operator()(const scenario::Crash& fault) const {
    return fmt::format("{} crashes {}", fault.node, when(fault));
  }
  std::string operator()(const scenario::Babble& fault) const {
    return fmt::format("the talker of {} babbles {}{}", fault.stream, when(fault),
                       fault.every ? ", a frame every " + readable(*fault.every) : std::string());
  }
  std::string operator()(const scenario::StuckGate& fault) const {
    return fmt::format("the gate of class {} of {}{} is stuck {} {}", fault.traffic_class, fault.node,
                       fault.to ? " to " + *fault.to : std::string(), scenario::spelling(fault.state), when(fault));
  }
  std::string operator()(const scenario::FrameErrors& fault) const {
    std::string text = link_text(fault.link) + (fault.towards ? " towards " + *fault.towards : std::string()) + ":";
    const auto add = [&](const std::optional<double>& share, std::string_view what) {
      if (share) text += fmt::format(" {} {},", what, *share);
    };
    add(fault.loss, "loss");
    if (fault.burst_loss) text += " loss in bursts,";
    add(fault.corruption, "corruption");
    add(fault.bit_error_rate, "bit errors");
    add(fault.duplication, "duplication");
    return text + " " + when(fault);
  }
  std::string operator()(const scenario::ClockFault& fault) const {
    const std::string what = fault.step ? "jumps by " + json::to_text(*fault.step)
                                        : "goes on with an offset of " + json::to_text(*fault.offset);
    return fmt::format("the clock of {} {} at {}", fault.node, what, readable(fault.at));
  }
};

std::string faults_page(const Resolved& r, std::size_t most_rows) {
  Page page("Faults");
  constexpr std::string_view kinds[] = {"link-down", "frame-errors", "crash", "babble", "stuck-gate", "clock"};
  static_assert(std::size(kinds) == std::variant_size_v<scenario::Fault>);
  for (const scenario::Fault& fault : r.scenario.faults)
    page.add(std::string(kinds[fault.index()]), std::visit(FaultText{}, fault));
  if (r.scenario.rerouting) {
    const auto changes = std::count_if(r.script.begin(), r.script.end(), [](const scenario::ResolvedAction& action) {
      return std::holds_alternative<scenario::ResolvedRoutes>(action.what);
    });
    page.add("rerouting", fmt::format("{} after a change of links; other paths {} time{}",
                                      readable(r.scenario.rerouting->delay), changes, changes == 1 ? "" : "s"));
  }
  return page.text(most_rows);
}

}  // namespace

std::string feature_pages(const Resolved& r, std::size_t most_rows) {
  return ports_page(r, most_rows) + offsets_page(r, most_rows) + windows_page(r, most_rows) +
         ingress_page(r, most_rows) + redundancy_page(r, most_rows) + faults_page(r, most_rows);
}

}  // namespace takt::output
