#include "node/node_status.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "json/document.hpp"
#include "sim/check.hpp"

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
  TAKT_CHECK(participant <= (status.program.roles.empty() ? status.program.slaves.size() : status.program.roles.size()), "an intent is one of the group's");
  if (participant == 0) return status.program.master;
  return status.program.roles.empty() ? status.program.slaves[participant - 1] : status.program.roles[participant - 1].name;
}

json::Node peers_of(const ProgramStatus& status, sim::LocalTime now) {
  json::Node all = json::Node::array();
  for (std::size_t p = 0; status.node.endpoint() != nullptr && p < status.peers.peers().size(); ++p) {
    const PeerStatistics& peer = status.peers.peers()[p];
    json::Node node = json::Node::object();
    node.add("name", text(participant_name(status, status.node.endpoint()->participant().participant_of(p))));
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
  const wire::ProgramEndpoint* const endpoint = status.node.endpoint();
  const wire::EndpointCounts counts = endpoint == nullptr ? wire::EndpointCounts() : endpoint->counts();
  json::Node node = json::Node::object();
  node.add("late", of(status.cycles.late));
  node.add("cpu", of(status.cycles.cpu));
  node.add("jitter_ns", number(status.cycles.late.greatest() - status.cycles.late.least()));
  node.add("missed_cycles", number(endpoint == nullptr ? 0 : endpoint->missed_cycles()));
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
bool is_true(const json::Node* node) { return node != nullptr && node->boolean; }
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

/// What the master knows: which node has which role, and who else is there.
void add_roles(json::Node& node, const ProgramStatus& status) {
  const handshake::Binder& binder = *status.node.binder();
  json::Node& roles = node.add("roles", json::Node::array());
  std::vector<std::optional<std::size_t>> role_of(status.program.candidates.size());
  for (std::size_t r = 0; r < binder.roles(); ++r) {
    const handshake::Binding& binding = binder.binding(r);
    json::Node& role = roles.items.emplace_back(json::Node::object());
    role.add("name", text(status.program.roles[r].name));
    role.add("skill", text(status.program.roles[r].skill));
    role.add("node", binding.bound() ? text(status.program.candidates[binding.candidate]) : json::Node());
    if (binding.bound()) role.add("life", number(binding.life));
    if (binding.bound()) role_of[binding.candidate] = r;
  }
  json::Node& candidates = node.add("candidates", json::Node::array());
  for (std::uint8_t c = 0; c < binder.candidates(); ++c) {
    json::Node& candidate = candidates.items.emplace_back(json::Node::object());
    candidate.add("name", text(status.program.candidates[c]));
    candidate.add("present", json::Node::of_bool(binder.present(c)));
    candidate.add("role", role_of[c] ? text(status.program.roles[*role_of[c]].name) : json::Node());
  }
  node.add("complete", json::Node::of_bool(binder.complete()));
}

void add_candidate(json::Node& node, const ProgramStatus& status) {
  const handshake::Candidate& candidate = *status.node.candidate();
  node.add("bound_to", candidate.role() ? text(status.program.roles[*candidate.role()].name) : json::Node());
  node.add("announces", json::Node::of_bool(candidate.announces()));
  node.add("leaving", json::Node::of_bool(candidate.announcement().leaving));
  node.add("life", number(candidate.announcement().life));
}

void add_program(json::Node& node, const ProgramStatus& status, const NodeStatus& of) {
  const wire::ProgramEndpoint* const endpoint = status.node.endpoint();
  const bool is_master = endpoint != nullptr && endpoint->participant().config().role == handshake::Role::master;
  const bool has_intents = status.program.variant == Variant::robust;
  node.add("program", text(status.program.name));
  node.add("variant", text(has_intents ? "robust" : "paper"));
  node.add("role", text(is_master ? "master" : status.node.candidate() == nullptr ? "slave" : "candidate"));
  if (status.node.binder() != nullptr) add_roles(node, status);
  if (status.node.candidate() != nullptr) add_candidate(node, status);
  node.add("state", text(handshake::name_of(status.node.state())));
  if (endpoint != nullptr) {
    const auto& participant = endpoint->participant();
    node.add("incarnation", number(participant.config().incarnation));
    if (has_intents) {
      json::Node& intent = node.add("intent", json::Node::object());
      intent.add("number", number(participant.intent().number));
      intent.add("kind", text(handshake::name_of(participant.intent().kind)));
      intent.add("origin", text(participant_name(status, participant.intent().origin)));
      node.add("run", number(participant.run()));
    }
  }
  node.add("peers", peers_of(status, of.now));
  node.add("statistics", statistics_of(status, of.send_failures));
}

/// "plc: Running, master of cell (robust)"; "robotA: Running, left of cell (robust)"; "robotC: spare of cell (robust)".
std::string head_of(const std::string& name, const json::Node& root) {
  const std::string of = scalar(root.find("program")) + " (" + scalar(root.find("variant")) + ")";
  const json::Node* const bound_to = root.find("bound_to");
  if (bound_to == nullptr) return fmt::format("{}: {}, {} of {}\n", name, scalar(root.find("state")), scalar(root.find("role")), of);
  const bool announces = is_true(root.find("announces"));
  const char* const leaving = is_true(root.find("leaving")) ? ", leaving" : "";
  if (bound_to->text.empty()) return fmt::format("{}: {} {}\n", name, announces ? "spare of" : "away from", of);
  return fmt::format("{}: {}, {} of {}{}\n", name, scalar(root.find("state")), bound_to->text, of, leaving);
}

std::string lines_of_roles(const json::Node& root) {
  std::string out;
  if (const json::Node* const roles = root.find("roles"))
    for (const json::Node& role : roles->items) {
      const json::Node* const node = role.find("node");
      out += fmt::format("  role {} ({}): {}\n", scalar(role.find("name")), scalar(role.find("skill")), node == nullptr || node->text.empty() ? "nobody" : node->text);
    }
  std::string spares;
  std::string away;
  if (const json::Node* const candidates = root.find("candidates"))
    for (const json::Node& each : candidates->items) {
      if (each.find("role") != nullptr && !each.find("role")->text.empty()) continue;
      std::string& list = is_true(each.find("present")) ? spares : away;
      list += (list.empty() ? "" : ", ") + scalar(each.find("name"));
    }
  if (!spares.empty()) out += fmt::format("  spare: {}\n", spares);
  if (!away.empty()) out += fmt::format("  away: {}\n", away);
  return out;
}

std::string text_of_program(const std::string& name, const json::Node& root) {
  std::string out = head_of(name, root) + lines_of_roles(root);
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
