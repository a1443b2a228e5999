#include "output/application_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "output/text_report.hpp"

namespace takt::output {
namespace {

using results::CriterionResult;
using scenario::json::Node;

constexpr std::size_t most_rows = 64;

Node integer(std::uint64_t value) { return Node::of_integer(static_cast<sim::int128>(value)); }
Node picoseconds(sim::Duration value) { return Node::of_integer(value.ps()); }
Node percent_node(const std::optional<double>& percent) { return percent ? Node::of_double(*percent) : Node(); }

Node criterion_node(const CriterionResult& c) {
  Node node = Node::object();
  node.add("percent", percent_node(c.percent));
  node.add("tests", integer(c.tests));
  node.add("window_ps", picoseconds(c.window));
  node.add("expected", integer(c.expected));
  node.add("counted", integer(c.counted));
  node.add("beyond", integer(c.beyond));
  node.add("windows_below", integer(c.windows_below));
  node.add("windows_above", integer(c.windows_above));
  node.add("discarded", integer(c.discarded));
  return node;
}

Node summary_node(const std::optional<results::DurationSummary>& summary) {
  if (!summary) return {};
  Node node = Node::object();
  node.add("count", integer(summary->count));
  node.add("min", picoseconds(summary->min));
  node.add("mean", picoseconds(summary->mean));
  node.add("max", picoseconds(summary->max));
  node.add("deviation", picoseconds(summary->deviation));
  return node;
}

Node thread_node(const results::ThreadResult& t) {
  Node node = Node::object();
  node.add(t.publishes ? "publishes" : "subscribes", Node::of_string(t.topic));
  node.add("every_ps", picoseconds(t.every));
  node.add("activations", integer(t.activations));
  node.add("done", integer(t.done));
  node.add("missed", integer(t.missed));
  node.add("response_ps", summary_node(t.response));
  node.add("calls", criterion_node(t.calls));
  if (t.publishes) {
    node.add("published", integer(t.published));
    node.add("refused", integer(t.refused));
    node.add("timed_out", integer(t.timed_out));
  } else {
    node.add("arrived", integer(t.arrived));
    node.add("buffered", integer(t.buffered));
    node.add("overwritten", integer(t.overwritten));
    node.add("lost", integer(t.lost));
    if (t.values) node.add("values", criterion_node(*t.values));
  }
  return node;
}

Node participant_node(const results::ParticipantResult& p) {
  Node node = Node::object();
  node.add("domain", integer(p.domain));
  node.add("messages_sent", integer(p.messages_sent));
  node.add("octets_sent", integer(p.octets_sent));
  node.add("messages_received", integer(p.messages_received));
  node.add("heartbeats_sent", integer(p.heartbeats_sent));
  node.add("acknacks_sent", integer(p.acknacks_sent));
  node.add("resent", integer(p.resent));
  Node discovery = Node::object();
  discovery.add("messages", integer(p.discovery_messages));
  discovery.add("octets", integer(p.discovery_octets));
  discovery.add("participants_found", integer(p.participants_found));
  discovery.add("participants_lost", integer(p.participants_lost));
  discovery.add("matches", integer(p.matches));
  discovery.add("time_to_match_ps", p.time_to_match ? picoseconds(*p.time_to_match) : Node());
  node.add("discovery", std::move(discovery));
  node.add("deadlines_missed", integer(p.deadlines_missed));
  node.add("liveliness_lost", integer(p.liveliness_lost));
  node.add("samples_rejected", integer(p.samples_rejected));
  node.add("writes_timed_out", integer(p.writes_timed_out));
  Node reasons = Node::array();
  for (const std::string& reason : p.incompatible) reasons.items.push_back(Node::of_string(reason));
  node.add("incompatible", std::move(reasons));
  return node;
}

Node buffer_node(const results::BufferResult& b) {
  Node node = Node::object();
  node.add("received", integer(b.received));
  node.add("forwarded", integer(b.forwarded));
  node.add("overwritten", integer(b.overwritten));
  node.add("dropped", integer(b.dropped));
  node.add("stale", integer(b.stale));
  node.add("not_mapped", integer(b.not_mapped));
  Node age = Node::object();
  age.add("min", picoseconds(b.age_min));
  age.add("mean", picoseconds(b.age_mean));
  age.add("max", picoseconds(b.age_max));
  node.add("age_ps", std::move(age));
  return node;
}

Node kept_node(const std::vector<results::KeptResult>& topics) {
  Node all = Node::object();
  for (const results::KeptResult& each : topics) {
    Node node = Node::object();
    node.add("received", integer(each.received));
    node.add("restored", integer(each.restored));
    node.add("kept", integer(each.kept));
    all.add(each.topic, std::move(node));
  }
  return all;
}

std::string participant_row(const std::string& name, const results::ParticipantResult& p, std::size_t width) {
  std::string row = fmt::format("  {:<{}}  domain {}: {} messages, {} octets sent, {} heartbeats, {} acknacks, {} resent; discovery {} messages, {} octets, {} matches{}\n", name, width, p.domain,
                                p.messages_sent, p.octets_sent, p.heartbeats_sent, p.acknacks_sent, p.resent, p.discovery_messages, p.discovery_octets, p.matches,
                                p.time_to_match ? " within " + readable(*p.time_to_match) : "");
  for (const std::string& reason : p.incompatible) row += fmt::format("  {:<{}}  not matched: {}\n", "", width, reason);
  return row;
}

std::string percent_text(const std::optional<double>& percent) { return percent ? fmt::format("{:.2f} %", *percent) : std::string("-"); }

std::string row_of(const results::ApplicationResult& application, const results::ThreadResult& t, std::size_t width) {
  const std::string response = t.response ? fmt::format("{} / {} / {}", readable(t.response->min), readable(t.response->mean), readable(t.response->max)) : "-";
  std::string row = fmt::format("  {:<{}}  {:>9}  {:>10}  {:>9}  {:>9}  {:>10}", application.name + "/" + t.name, width, readable(t.every), t.activations, t.missed,
                                t.calls.tests, percent_text(t.calls.percent));
  row += fmt::format("  {:>10}  {}", t.values ? percent_text(t.values->percent) : "", response);
  for (const auto& [count, what] : {std::pair(t.refused, "refused"), std::pair(t.timed_out, "timed out"), std::pair(t.overwritten, "overwritten"), std::pair(t.values ? t.values->beyond : 0, "too late"), std::pair(t.lost, "lost"),
                                    std::pair(t.calls.discarded, "tests discarded")})
    if (count > 0) row += fmt::format(", {} {}", count, what);
  return row + "\n";
}

std::string signal_row(const results::SignalResult& s, std::size_t width) {
  if (!s.pulses) return fmt::format("  {:<{}}  no pulse\n", s.name, width);
  std::string row = fmt::format("  {:<{}}  {} pulses: min {}, mean {}, max {}, deviation {}, nominal {}; {:.2f} % of them irregular", s.name, width, s.pulses->count, readable(s.pulses->min),
                                readable(s.pulses->mean), readable(s.pulses->max), readable(s.pulses->deviation), readable(s.nominal), *s.irregular_percent());
  if (s.periods) row += fmt::format("; period min {}, mean {}, max {}", readable(s.periods->min), readable(s.periods->mean), readable(s.periods->max));
  return row + "\n";
}

}  // namespace

Node applications_node(const results::RunResult& result) {
  Node all = Node::object();
  for (const results::ApplicationResult& a : result.applications) {
    Node node = Node::object();
    node.add("node", Node::of_string(a.node));
    node.add("kind", Node::of_string(a.is_gateway ? "gateway" : a.is_service ? "persistence" : "application"));
    Node threads = Node::object();
    for (const results::ThreadResult& t : a.threads) threads.add(t.name, thread_node(t));
    node.add("threads", std::move(threads));
    if (a.buffer) node.add("buffer", buffer_node(*a.buffer));
    if (a.is_service) node.add("kept", kept_node(a.kept));
    if (!a.participants.empty()) {
      Node participants = Node::array();
      for (const results::ParticipantResult& p : a.participants) participants.items.push_back(participant_node(p));
      node.add("participants", std::move(participants));
    }
    all.add(a.name, std::move(node));
  }
  return all;
}

Node signals_node(const results::RunResult& result) {
  Node all = Node::object();
  for (const results::SignalResult& s : result.signals) {
    Node node = Node::object();
    node.add("nominal_ps", picoseconds(s.nominal));
    node.add("pulses_ps", summary_node(s.pulses));
    node.add("periods_ps", summary_node(s.periods));
    node.add("irregular_pulses", integer(s.irregular_pulses));
    node.add("irregular_periods", integer(s.irregular_periods));
    node.add("irregular_percent", percent_node(s.irregular_percent()));
    all.add(s.name, std::move(node));
  }
  return all;
}

std::string applications_part(const results::RunResult& result) {
  std::size_t width = 6;
  std::size_t rows = 0;
  for (const results::ApplicationResult& a : result.applications)
    for (const results::ThreadResult& t : a.threads) width = std::max(width, a.name.size() + 1 + t.name.size());
  std::string out;
  if (!result.applications.empty()) {
    out += "\nThreads of applications: calls that took place (criterion 1), values that were buffered (criterion 2)\n";
    out += fmt::format("  {:<{}}  {:>9}  {:>10}  {:>9}  {:>9}  {:>10}  {:>10}  {}\n", "thread", width, "every", "activated", "missed", "tests", "calls", "values", "response min / mean / max");
  }
  for (const results::ApplicationResult& a : result.applications)
    for (const results::ThreadResult& t : a.threads)
      if (++rows <= most_rows) out += row_of(a, t, width);
  if (rows > most_rows) out += fmt::format("  ... {} more\n", rows - most_rows);
  const auto any_participant = [](const results::ApplicationResult& a) { return !a.participants.empty(); };
  if (std::any_of(result.applications.begin(), result.applications.end(), any_participant)) out += "\nParticipants of DDS\n";
  rows = 0;
  for (const results::ApplicationResult& a : result.applications)
    for (const results::ParticipantResult& p : a.participants)
      if (++rows <= most_rows) out += participant_row(a.name, p, width);
  for (const results::ApplicationResult& a : result.applications)
    if (a.buffer)
      out += fmt::format("\nGateway {}: {} values received, {} forwarded, {} overwritten, {} dropped, {} stale, {} not mapped; age min {}, mean {}, max {}\n", a.name, a.buffer->received,
                         a.buffer->forwarded, a.buffer->overwritten, a.buffer->dropped, a.buffer->stale, a.buffer->not_mapped, readable(a.buffer->age_min), readable(a.buffer->age_mean),
                         readable(a.buffer->age_max));
  for (const results::ApplicationResult& a : result.applications)
    for (const results::KeptResult& each : a.kept)
      out += fmt::format("\nPersistence service {}: topic {}, {} samples received, {} restored at its last start, {} kept\n", a.name, each.topic, each.received, each.restored, each.kept);
  if (result.signals.empty()) return out;
  out += "\nDigital outputs\n";
  width = 0;
  for (const results::SignalResult& s : result.signals) width = std::max(width, s.name.size());
  for (const results::SignalResult& s : result.signals) out += signal_row(s, width);
  return out;
}

}  // namespace takt::output
