#include "results/application_json.hpp"

namespace takt::results {
namespace {

using scenario::json::Node;

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

Node summary_node(const std::optional<DurationSummary>& summary) {
  if (!summary) return {};
  Node node = Node::object();
  node.add("count", integer(summary->count));
  node.add("min", picoseconds(summary->min));
  node.add("mean", picoseconds(summary->mean));
  node.add("max", picoseconds(summary->max));
  node.add("deviation", picoseconds(summary->deviation));
  return node;
}

Node thread_node(const ThreadResult& t) {
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

Node participant_node(const ParticipantResult& p) {
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

Node buffer_node(const BufferResult& b) {
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

Node kept_node(const std::vector<KeptResult>& topics) {
  Node all = Node::object();
  for (const KeptResult& each : topics) {
    Node node = Node::object();
    node.add("received", integer(each.received));
    node.add("restored", integer(each.restored));
    node.add("kept", integer(each.kept));
    all.add(each.topic, std::move(node));
  }
  return all;
}

}  // namespace

Node applications_node(const RunResult& result) {
  Node all = Node::object();
  for (const ApplicationResult& a : result.applications) {
    Node node = Node::object();
    node.add("node", Node::of_string(a.node));
    node.add("kind", Node::of_string(a.is_gateway ? "gateway" : a.is_service ? "persistence" : "application"));
    Node threads = Node::object();
    for (const ThreadResult& t : a.threads) threads.add(t.name, thread_node(t));
    node.add("threads", std::move(threads));
    if (a.buffer) node.add("buffer", buffer_node(*a.buffer));
    if (a.is_service) node.add("kept", kept_node(a.kept));
    if (!a.participants.empty()) {
      Node participants = Node::array();
      for (const ParticipantResult& p : a.participants) participants.items.push_back(participant_node(p));
      node.add("participants", std::move(participants));
    }
    all.add(a.name, std::move(node));
  }
  return all;
}

Node signals_node(const RunResult& result) {
  Node all = Node::object();
  for (const SignalResult& s : result.signals) {
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

}  // namespace takt::results
