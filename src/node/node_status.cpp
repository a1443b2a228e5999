#include "node/node_status.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenario/json/document.hpp"

namespace takt::node {
namespace {

json::Node text(std::string_view value) { return json::Node::of_string(value); }
template <class Integer>
json::Node number(Integer value) {
  return json::Node::of_integer(static_cast<sim::int128>(value));
}

json::Node of(const Distribution& distribution) {
  json::Node node = json::Node::object();
  node.add("count", number(distribution.count()));
  node.add("min_ns", number(distribution.least()));
  node.add("mean_ns", number(distribution.mean()));
  node.add("p99_ns", number(distribution.percentile(99)));
  node.add("max_ns", number(distribution.greatest()));
  return node;
}

const std::string& participant_name(const ProgramStatus& status, std::size_t participant) {
  return participant == 0 ? status.program.master : status.program.slaves[participant - 1];
}

json::Node peers_of(const ProgramStatus& status, sim::LocalTime now) {
  json::Node all = json::Node::array();
  for (std::size_t p = 0; p < status.peers.peers().size(); ++p) {
    const PeerStatistics& peer = status.peers.peers()[p];
    json::Node node = json::Node::object();
    node.add("name", text(participant_name(status, status.endpoint.participant().participant_of(p))));
    node.add("state", peer.state ? text(handshake::name_of(*peer.state)) : json::Node());
    if (peer.state) node.add("silent_ns", number((now - peer.last_heard).ps() / 1000));
    node.add("incarnation", number(peer.incarnation));
    node.add("answer", of(peer.answer));
    node.add("round_trip", of(peer.round_trip));
    all.items.push_back(std::move(node));
  }
  return all;
}

json::Node statistics_of(const ProgramStatus& status, std::uint64_t send_failures) {
  const wire::EndpointCounts& counts = status.endpoint.counts();
  json::Node node = json::Node::object();
  node.add("late", of(status.cycles.late));
  node.add("cpu", of(status.cycles.cpu));
  node.add("jitter_ns", number(status.cycles.late.greatest() - status.cycles.late.least()));
  node.add("missed_cycles", number(status.endpoint.missed_cycles()));
  node.add("missed_by_code", number(status.cycles.missed_by_code));
  node.add("missed_by_system", number(status.cycles.missed_by_system));
  node.add("taken", number(counts.taken));
  node.add("foreign", number(counts.foreign));
  node.add("unsubscribed", number(counts.unsubscribed));
  node.add("stale", number(counts.stale));
  node.add("not_running", number(counts.not_running));
  node.add("send_failures", number(send_failures));
  return node;
}

std::string scalar(const json::Node* node) { return node == nullptr || node->text.empty() ? "-" : node->text; }
std::string microseconds(const json::Node& distribution, std::string_view what) {
  const json::Node* const ns = distribution.find(what);
  return ns == nullptr ? "-" : fmt::format("{:.1f}", json::double_of(*ns) / 1000);
}

std::string line_of(std::string_view what, const json::Node* distribution) {
  if (distribution == nullptr) return {};
  return fmt::format("  {:<22} {:>10} {:>11} {:>11} {:>11} {:>11}\n", what, scalar(distribution->find("count")), microseconds(*distribution, "min_ns"),
                     microseconds(*distribution, "mean_ns"), microseconds(*distribution, "p99_ns"), microseconds(*distribution, "max_ns"));
}

}  // namespace

namespace {

void add_program(json::Node& node, const ProgramStatus& status, const NodeStatus& of) {
  const auto& participant = status.endpoint.participant();
  const bool has_intents = participant.config().variant == handshake::Variant::Robust;
  node.add("program", text(status.program.name));
  node.add("variant", text(has_intents ? "robust" : "paper"));
  node.add("role", text(participant.config().role == handshake::Role::Master ? "master" : "slave"));
  node.add("state", text(handshake::name_of(participant.state())));
  node.add("incarnation", number(participant.config().incarnation));
  if (has_intents) {
    json::Node& intent = node.add("intent", json::Node::object());
    intent.add("number", number(participant.intent().number));
    intent.add("kind", text(handshake::name_of(participant.intent().kind)));
    intent.add("origin", text(participant_name(status, participant.intent().origin)));
    node.add("run", number(participant.run()));
  }
  node.add("peers", peers_of(status, of.now));
  node.add("statistics", statistics_of(status, of.send_failures));
}

std::string text_of_program(const std::string& name, const json::Node& root) {
  std::string out = fmt::format("{}: {}, {} of {} ({})\n", name, scalar(root.find("state")), scalar(root.find("role")), scalar(root.find("program")),
                                scalar(root.find("variant")));
  if (const json::Node* const intent = root.find("intent"); intent != nullptr && scalar(intent->find("number")) != "0")
    out += fmt::format("  last intent: {} by {}, number {}\n", scalar(intent->find("kind")), scalar(intent->find("origin")), scalar(intent->find("number")));
  const json::Node* const peers = root.find("peers");
  for (std::size_t p = 0; peers != nullptr && p < peers->items.size(); ++p) {
    const json::Node& peer = peers->items[p];
    const json::Node* const silent = peer.find("silent_ns");
    out += fmt::format("  peer {}: {}", scalar(peer.find("name")), silent == nullptr ? "not heard yet" : scalar(peer.find("state")));
    out += silent == nullptr ? "\n" : fmt::format(", heard {:.3f} ms ago\n", json::double_of(*silent) / 1e6);
  }
  out += fmt::format("\n  {:<22} {:>10} {:>11} {:>11} {:>11} {:>11}\n", "microseconds", "count", "min", "mean", "p99", "max");
  const json::Node& statistics = *root.find("statistics");
  out += line_of("late for the cycle", statistics.find("late"));
  out += line_of("CPU time of a cycle", statistics.find("cpu"));
  for (std::size_t p = 0; peers != nullptr && p < peers->items.size(); ++p) {
    out += line_of("answer of " + scalar(peers->items[p].find("name")), peers->items[p].find("answer"));
    out += line_of("round trip to " + scalar(peers->items[p].find("name")), peers->items[p].find("round_trip"));
  }
  out += fmt::format("  missed cycles: {} by the code, {} by the operating system\n", scalar(statistics.find("missed_by_code")), scalar(statistics.find("missed_by_system")));
  out += fmt::format("  messages: {} taken, {} stale, {} foreign, {} not running; {} not sent\n", scalar(statistics.find("taken")), scalar(statistics.find("stale")),
                     scalar(statistics.find("foreign")), scalar(statistics.find("not_running")), scalar(statistics.find("send_failures")));
  return out;
}

bool is_of_program(const json::Node& node) { return node.find("state") != nullptr && node.find("statistics") != nullptr; }

}  // namespace

std::string to_json(const NodeStatus& status) {
  json::Node node = json::Node::object();
  node.add("time_ns", number(status.time_ns));
  node.add("node", text(status.node));
  if (status.programs.size() == 1) {
    add_program(node, status.programs.front(), status);
    return json::compact(node);
  }
  json::Node& programs = node.add("programs", json::Node::array());
  for (const ProgramStatus& each : status.programs) add_program(programs.items.emplace_back(json::Node::object()), each, status);
  return json::compact(node);
}

std::string status_text(const std::string& json) {
  json::Diagnostics diagnostics;
  const auto document = json::parse(json, "status", diagnostics);
  if (!document) return json + "\n";
  const json::Node& root = document->root();
  const std::string name = scalar(root.find("node"));
  if (is_of_program(root)) return text_of_program(name, root);
  const json::Node* const programs = root.find("programs");
  if (programs == nullptr || !std::all_of(programs->items.begin(), programs->items.end(), is_of_program)) return json + "\n";
  std::string out;
  for (const json::Node& program : programs->items) out += (out.empty() ? "" : "\n") + text_of_program(name, program);
  return out;
}

}  // namespace takt::node
