#include "report/gates_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "models/ethernet/sizes.hpp"
#include "output/text_report.hpp"

namespace takt::report {
namespace {

constexpr std::size_t most_sent = 20'000;
constexpr std::size_t most_rows = 80;
constexpr std::size_t most_changes = 2'000;   // of a port's gates
constexpr std::size_t nothing = ~std::size_t{0};

const models::EgressPort& live(const scenario::Run& run, const output::PortDirectory::Port& port) { return run.network().ports(port.id.node)[port.id.port]; }

bool has_gates(const models::EgressPort& port) { return port.shaping() != nullptr && port.shaping()->has_gates(); }

}  // namespace

std::optional<Span> gate_cycle(const scenario::Resolved& resolved, sim::Duration simulated) {
  const models::GateConfig* longest = nullptr;
  for (const models::PortConfig& config : resolved.plan.port_configs)
    if (config.shaping.gates && (longest == nullptr || config.shaping.gates->admin_cycle_time > longest->admin_cycle_time)) longest = &*config.shaping.gates;
  if (longest == nullptr || longest->admin_cycle_time <= sim::Duration()) return std::nullopt;
  const std::int64_t cycle = longest->admin_cycle_time.ps();
  const std::int64_t base = longest->admin_base_time.since_start().ps();
  const std::int64_t cycles = std::max<std::int64_t>(0, (simulated.ps() / 2 - base) / cycle);
  const sim::TrueTime from = sim::TrueTime() + sim::Duration::from_ps(std::max<std::int64_t>(0, base + cycles * cycle));
  const sim::TrueTime until = from + longest->admin_cycle_time;
  if (until > sim::TrueTime() + simulated) return std::nullopt;
  return Span{from, until};
}

GateWatch::GateWatch(const scenario::Run& run, Span span)
    : run_(&run), span_(span), directory_(run.network()), open_(directory_.ports().size()), last_(directory_.ports().size(), nothing) {}

void GateWatch::look_at_gates() {
  for (std::size_t p = 0; p < open_.size(); ++p) {
    const models::EgressPort& port = live(*run_, directory_.ports()[p]);
    if (!has_gates(port)) continue;
    const models::LocalClock& clock = port.clock();
    models::GateSchedule schedule = std::as_const(*port.shaping()).gates();
    sim::TrueTime at = span_.from;
    for (std::size_t changes = 0; at < span_.until && changes < most_changes; ++changes) {
      const sim::LocalTime now = clock.local_at(at);
      const sim::LocalTime next = schedule.next_change(now);
      const sim::TrueTime until = next == sim::LocalTime::never() ? span_.until : std::clamp(clock.true_at(next), at, span_.until);
      const models::GateStates states = port.shaping()->with_forced(schedule.gate_states(now));
      for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q)
        if ((states >> q & 1) != 0 && until > at) open_[p].push_back({at, until, q});
      if (until <= at) break;
      at = until;
    }
  }
}

void GateWatch::record(const sim::TraceRecord& record) {
  if (record.time > span_.until) return;
  const auto kind = static_cast<models::Occurrence>(record.kind);
  const bool begins = kind == models::Occurrence::started || kind == models::Occurrence::resumed;
  if (!begins && kind != models::Occurrence::cut) return;
  const std::uint32_t port = directory_.find(record.where);
  if (port == output::PortDirectory::none) return;
  if (!begins) {
    if (last_[port] != nothing) sent_[last_[port]].until = std::max(record.time, sent_[last_[port]].from);
    return;
  }
  const auto detail = models::TransmissionDetail::unpack(record.detail);
  const sim::TrueTime until = record.time + directory_.ports()[port].octet_time * (std::int64_t{models::preamble_and_sfd.count} + detail.octets);
  if (until < span_.from || sent_.size() == most_sent) return;
  const models::Frame& frame = run_->network().traffic().frame({static_cast<std::uint32_t>(record.what)});
  last_[port] = sent_.size();
  sent_.push_back({record.time, until, port, detail.octets, frame.sequence, frame.stream, detail.traffic_class});
}

chart::Gantt GateWatch::figure() const {
  chart::Gantt drawn;
  const auto microseconds = [&](sim::TrueTime time) { return static_cast<double>((std::clamp(time, span_.from, span_.until) - span_.from).ps()) * 1e-6; };
  drawn.title = fmt::format("Gates and frames from {} on, one cycle of {}", output::readable(span_.from.since_start()), output::readable(span_.until - span_.from));
  drawn.unit = "us";
  drawn.to = microseconds(span_.until);
  // A row for each class of a port that sends, or whose gate is not always open.
  std::map<std::pair<std::uint32_t, models::TrafficClass>, std::vector<const Sent*>> frames;
  for (const Sent& each : sent_)
    if (!open_[each.port].empty()) frames[{each.port, each.traffic_class}].push_back(&each);
  std::map<std::uint32_t, std::size_t> colours;
  const auto colour_of = [&](models::StreamIndex stream) {
    const auto [found, is_new] = colours.emplace(stream.value, colours.size());
    if (is_new) drawn.legend.push_back(run_->network().traffic().streams()[stream.value].name);
    return found->second;
  };
  for (const auto& [row, sent] : frames) {
    if (drawn.rows.size() == most_rows) break;
    const output::PortDirectory::Port& port = directory_.ports()[row.first];
    chart::GanttRow made;
    made.name = fmt::format("{}:{} to {}, class {}", run_->network().plan().nodes[port.id.node.value].name, port.id.port,
                            port.peer.is_none() ? std::string("nothing") : run_->network().plan().nodes[port.peer.value].name, row.second);
    for (const Open& open : open_[row.first])
      if (open.traffic_class == row.second) {
        if (!made.stretches.empty() && made.stretches.back().to == microseconds(open.from)) made.stretches.back().to = microseconds(open.until);
        else made.stretches.push_back({microseconds(open.from), microseconds(open.until)});
      }
    for (const Sent* each : sent)
      made.bars.push_back({microseconds(each->from), microseconds(each->until), colour_of(each->stream),
                           fmt::format("{} #{}, {} octets, sent at {:.3f} us of the cycle", run_->network().traffic().streams()[each->stream.value].name, each->sequence, each->octets,
                                       static_cast<double>((each->from - span_.from).ps()) * 1e-6)});
    drawn.rows.push_back(std::move(made));
  }
  // Colours come round again after eight: names that would not tell streams apart are left out.
  constexpr std::size_t most_names = 8;
  if (drawn.legend.size() > most_names) drawn.legend.clear();
  return drawn;
}

}  // namespace takt::report
