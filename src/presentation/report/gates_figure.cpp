// SPDX-License-Identifier: Apache-2.0
#include "report/gates_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>
#include <variant>

#include "models/ethernet/sizes.hpp"
#include "output/playback.hpp"
#include "output/text_report.hpp"

namespace takt::report {
namespace {

using models::Occurrence;

constexpr std::size_t most_sent = 20'000;
constexpr std::size_t most_discarded = 2'000;
constexpr std::int64_t periods_around = 12;  // on each side of the first frame that is discarded
constexpr sim::Duration usual_period = sim::Duration::from_ps(100'000'000);  // of a stream without one
constexpr std::size_t most_rows = 80;
constexpr std::size_t nothing = ~std::size_t{0};

const models::EgressPort& live(const scenario::Run& run, const output::PortDirectory::Port& port) {
  return run.network().ports(port.id.node)[port.id.port];
}

bool has_gates(const models::EgressPort& port) { return port.shaping() != nullptr && port.shaping()->has_gates(); }

}  // namespace

std::optional<sim::Duration> longest_gate_cycle(const scenario::Resolved& resolved) {
  std::optional<sim::Duration> longest;
  const auto consider = [&](const models::GateConfig& gates) {
    if (gates.admin_cycle_time > sim::Duration() && (!longest || gates.admin_cycle_time > *longest))
      longest = gates.admin_cycle_time;
  };
  for (const models::PortConfig& config : resolved.plan.port_configs)
    if (config.shaping.gates) consider(*config.shaping.gates);
  for (const scenario::ResolvedAction& action : resolved.script)
    if (const auto* const set = std::get_if<scenario::ResolvedGates>(&action.what)) consider(set->gates);
  return longest;
}

bool has_discarded(const results::RunResult& result) {
  using models::DropReason;
  for (const DropReason reason :
       {DropReason::queue_frames, DropReason::queue_octets, DropReason::queue_max_sdu, DropReason::stream_max_sdu,
        DropReason::stream_gate, DropReason::flow_meter, DropReason::residence_time})
    if (std::ranges::any_of(result.dropped,
                            [&](const auto& each) { return each.first == models::name_of(reason) && each.second > 0; }))
      return true;
  return false;
}

GateWatch::GateWatch(scenario::Run& run, std::optional<sim::Duration> longest, sim::TrueTime end)
    : run_(&run),
      longest_(longest),
      end_(end),
      directory_(run.network()),
      drops_(run.network(), directory_),
      states_(directory_.ports().size()),
      last_(directory_.ports().size(), nothing) {}

sim::TrueTime GateWatch::begin() const {
  return sim::TrueTime() + (longest_ ? std::max(sim::Duration(), middle().since_start() - *longest_) : sim::Duration());
}

void GateWatch::start() {
  is_started_ = true;
  if (!longest_) return;
  output::TapeWants wants;
  wants.gates = true;
  tape_ = std::make_unique<output::Tape>(run_->network(), 0, wants);
}

void GateWatch::choose_cycle() {
  std::optional<sim::Duration> longest;
  for (const output::PortDirectory::Port& at : directory_.ports()) {
    const models::EgressPort& port = live(*run_, at);
    if (!has_gates(port)) continue;
    const models::LocalClock& clock = port.clock();
    const sim::LocalTime now = clock.local_at(middle());
    models::GateSchedule schedule = std::as_const(*port.shaping()).gates();
    const models::GateControlList* const list = schedule.oper_control_list(now);
    if (list == nullptr || (longest && list->cycle_time() <= *longest)) continue;
    longest = list->cycle_time();
    const std::int64_t into_cycle =
        std::max<std::int64_t>(0, (now - schedule.oper_base_time(now)).ps()) % longest->ps();
    const sim::TrueTime from = std::clamp(clock.true_at(now - sim::Duration::from_ps(into_cycle)), begin(), middle());
    span_ = Span{from, from + *longest};
  }
  if (span_ && span_->until > end_) span_.reset();
}

void GateWatch::finish() {
  is_started_ = false;
  if (!span_ || !tape_) return;
  const std::unique_ptr<output::Tape> tape = std::move(tape_);
  output::Playback playback(*this);
  playback.add(*tape);
  playback.play(span_->until);
}

void GateWatch::record(const sim::TraceRecord& record) {
  const auto kind = static_cast<Occurrence>(record.kind);
  if (kind == Occurrence::gates_shown) {
    states_[directory_.find(record.where)].push_back({record.time, static_cast<models::GateStates>(record.what)});
    return;
  }
  drops_.record(record);
  if (!is_started_) return;
  if (tape_) tape_->record(record);
  if (span_ && record.time > span_->until) return;
  switch (kind) {
    case Occurrence::drop:
      note_drop(record);
      break;
    case Occurrence::started:
    case Occurrence::resumed:
    case Occurrence::cut:
      if (const std::uint32_t port = directory_.find(record.where);
          port != output::PortDirectory::none && is_watched(port))
        note_sent(record, port);
      break;
    default:
      break;
  }
}

bool GateWatch::is_watched(std::uint32_t port) const {
  return !longest_ || has_gates(live(*run_, directory_.ports()[port]));
}

/// What no picture can show any more.
void GateWatch::forget_before(sim::TrueTime time) {
  std::erase_if(sent_, [&](const Sent& each) { return each.until < time; });
  std::ranges::fill(last_, nothing);
  for (std::size_t i = 0; i < sent_.size(); ++i) last_[sent_[i].port] = i;
}

void GateWatch::note_sent(const sim::TraceRecord& record, std::uint32_t port) {
  if (static_cast<Occurrence>(record.kind) == Occurrence::cut) {
    if (last_[port] != nothing) sent_[last_[port]].until = std::max(record.time, sent_[last_[port]].from);
    return;
  }
  last_[port] = nothing;
  // As long as no frame has been discarded only the last ones count.
  if (sent_.size() == most_sent && !longest_ && !span_) forget_before(sent_[most_sent / 2].until);
  if (sent_.size() == most_sent) return;
  const auto detail = models::TransmissionDetail::unpack(record.detail);
  const sim::TrueTime until = record.time + directory_.ports()[port].octet_time *
                                                (std::int64_t{models::preamble_and_sfd.count} + detail.octets);
  const models::Frame& frame = run_->network().traffic().frame({static_cast<std::uint32_t>(record.what)});
  last_[port] = sent_.size();
  sent_.push_back({record.time, until, port, detail.octets, frame.sequence, frame.stream, detail.traffic_class});
}

/// A cross where the frame was seen last: behind its bar, or in the row of the queue that did not take it. A copy that
/// came twice is no loss.
void GateWatch::note_drop(const sim::TraceRecord& record) {
  if (static_cast<models::DropReason>(record.detail) == models::DropReason::duplicate) return;
  const output::DropPlaces::Place place = drops_.of(record);
  const std::uint32_t port = place.sender != output::DropPlaces::none ? place.sender : place.port;
  if (port == output::DropPlaces::none || discarded_.size() == most_discarded) return;
  const models::Frame& frame = run_->network().traffic().frame({static_cast<std::uint32_t>(record.what)});
  models::TrafficClass traffic_class =
      live(*run_, directory_.ports()[port]).config().traffic_class_of_priority[frame.queue_priority];
  if (place.sender != output::DropPlaces::none) {
    const auto sent = std::find_if(sent_.rbegin(), sent_.rend(), [&](const Sent& each) {
      return each.port == port && each.stream == frame.stream && each.sequence == frame.sequence;
    });
    if (sent != sent_.rend()) traffic_class = sent->traffic_class;
  }
  if (!longest_ && !span_) {
    sim::Duration period = usual_period;
    const std::string& name = run_->network().traffic().streams()[frame.stream.value].name;
    for (const scenario::Stream& described : run_->resolved().scenario.streams)
      if (described.name == name && described.every) period = *described.every;
    const sim::Duration around = std::min(period * periods_around, record.time.since_start());
    span_ = Span{record.time - around, std::min(end_, record.time + period * periods_around)};
  }
  discarded_.push_back(
      {record.time, port, traffic_class,
       fmt::format("{} #{} discarded at {}: {}", run_->network().traffic().streams()[frame.stream.value].name,
                   frame.sequence, run_->network().plan().nodes[directory_.ports()[place.port].id.node.value].name,
                   models::name_of(static_cast<models::DropReason>(record.detail)))});
}

double GateWatch::microseconds(sim::TrueTime time) const {
  return static_cast<double>((std::clamp(time, span_->from, span_->until) - span_->from).ps()) * 1e-6;
}

/// A row with the times in which the gate was open.
chart::GanttRow GateWatch::row_of(std::uint32_t port, models::TrafficClass traffic_class) const {
  const output::PortDirectory::Port& at = directory_.ports()[port];
  chart::GanttRow row;
  row.name = fmt::format("{}:{} to {}, class {}", run_->network().plan().nodes[at.id.node.value].name, at.id.port,
                         at.peer.is_none() ? std::string("nothing") : run_->network().plan().nodes[at.peer.value].name,
                         traffic_class);
  const std::vector<States>& states = states_[port];
  for (std::size_t i = 0; i < states.size(); ++i) {
    const sim::TrueTime until = i + 1 < states.size() ? states[i + 1].from : span_->until;
    if ((states[i].open >> traffic_class & 1) == 0 || until <= span_->from || states[i].from >= span_->until ||
        until <= states[i].from)
      continue;
    if (!row.stretches.empty() && row.stretches.back().to == microseconds(states[i].from))
      row.stretches.back().to = microseconds(until);
    else
      row.stretches.push_back({microseconds(states[i].from), microseconds(until)});
  }
  return row;
}

std::optional<chart::Gantt> GateWatch::figure() const {
  if (!span_) return std::nullopt;
  chart::Gantt drawn;
  drawn.title =
      longest_ ? fmt::format("Gates and frames from {} on, one cycle of {}",
                             output::readable(span_->from.since_start()), output::readable(span_->until - span_->from))
               : fmt::format("Frames around the first one that was discarded, from {} to {}",
                             output::readable(span_->from.since_start()), output::readable(span_->until.since_start()));
  drawn.unit = "us";
  drawn.to = microseconds(span_->until);
  // A row for each class of a port with gates in which a frame was sent or discarded; without gates, of a port by which
  // a frame came that was discarded.
  struct Row {
    std::vector<const Sent*> sent;
    std::vector<const Discarded*> discarded;
  };
  std::map<std::pair<std::uint32_t, models::TrafficClass>, Row> rows;
  std::vector<bool> is_shown(states_.size());
  for (std::size_t port = 0; port < states_.size(); ++port) is_shown[port] = !states_[port].empty();
  for (const Discarded& each : discarded_)
    if (!longest_ && span_->holds(each.at)) is_shown[each.port] = true;
  for (const Sent& each : sent_)
    if (is_shown[each.port] && each.until >= span_->from && each.from <= span_->until)
      rows[{each.port, each.traffic_class}].sent.push_back(&each);
  for (const Discarded& each : discarded_)
    if (is_shown[each.port] && span_->holds(each.at)) rows[{each.port, each.traffic_class}].discarded.push_back(&each);
  std::map<std::uint32_t, std::size_t> colours;
  const auto colour_of = [&](models::StreamIndex stream) {
    const auto [found, is_new] = colours.emplace(stream.value, colours.size());
    if (is_new) drawn.legend.push_back(run_->network().traffic().streams()[stream.value].name);
    return found->second;
  };
  for (const auto& [at, row] : rows) {
    if (drawn.rows.size() == most_rows) break;
    chart::GanttRow made = row_of(at.first, at.second);
    for (const Sent* each : row.sent)
      made.bars.push_back({microseconds(each->from), microseconds(each->until), colour_of(each->stream),
                           fmt::format("{} #{}, {} octets, sent at {:.3f} us of the cycle",
                                       run_->network().traffic().streams()[each->stream.value].name, each->sequence,
                                       each->octets, static_cast<double>((each->from - span_->from).ps()) * 1e-6)});
    for (const Discarded* each : row.discarded) made.crosses.push_back({microseconds(each->at), each->text});
    drawn.rows.push_back(std::move(made));
  }
  // Colours come round again after eight: names that would not tell streams apart are left out.
  constexpr std::size_t most_names = 8;
  if (drawn.legend.size() > most_names) drawn.legend.clear();
  return drawn;
}

}  // namespace takt::report
