// SPDX-License-Identifier: Apache-2.0
#include "node/node_status.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "json/document.hpp"

namespace takt::node {
namespace {

std::string scalar(const json::Node* node) { return node == nullptr || node->text.empty() ? "-" : node->text; }
bool is_true(const json::Node* node) { return node != nullptr && node->boolean; }
std::string microseconds(const json::Node& distribution, std::string_view what) {
  const json::Node* const ns = distribution.find(what);
  return ns == nullptr ? "-" : fmt::format("{:.1f}", json::double_of(*ns) / 1000);
}

std::string line_of(std::string_view what, const json::Node* distribution) {
  if (distribution == nullptr) return {};
  return fmt::format("  {:<22} {:>10} {:>11} {:>11} {:>11} {:>11}\n", what, scalar(distribution->find("count")),
                     microseconds(*distribution, "min_ns"), microseconds(*distribution, "mean_ns"),
                     microseconds(*distribution, "p99_ns"), microseconds(*distribution, "max_ns"));
}

/// "plc: Running, master of cell (robust)"; "robotA: Running, left of cell (robust)"; "robotC: spare of cell (robust)".
std::string head_of(const std::string& name, const json::Node& root) {
  const std::string of = scalar(root.find("program")) + " (" + scalar(root.find("variant")) + ")";
  const json::Node* const bound_to = root.find("bound_to");
  if (bound_to == nullptr)
    return fmt::format("{}: {}, {} of {}\n", name, scalar(root.find("state")), scalar(root.find("role")), of);
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
      out += fmt::format("  role {} ({}): {}\n", scalar(role.find("name")), scalar(role.find("skill")),
                         node == nullptr || node->text.empty() ? "nobody" : node->text);
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
    out += fmt::format("  last intent: {} by {}, number {}\n", scalar(intent->find("kind")),
                       scalar(intent->find("origin")), scalar(intent->find("number")));
  const json::Node* const peers = root.find("peers");
  for (std::size_t p = 0; peers != nullptr && p < peers->items.size(); ++p) {
    const json::Node& peer = peers->items[p];
    const json::Node* const silent = peer.find("silent_ns");
    out += fmt::format("  peer {}: {}", scalar(peer.find("name")),
                       silent == nullptr ? "not heard yet" : scalar(peer.find("state")));
    out += silent == nullptr ? "\n" : fmt::format(", heard {:.3f} ms ago\n", json::double_of(*silent) / 1e6);
  }
  out += fmt::format("\n  {:<22} {:>10} {:>11} {:>11} {:>11} {:>11}\n", "microseconds", "count", "min", "mean", "p99",
                     "max");
  const json::Node& statistics = *root.find("statistics");
  out += line_of("late for the cycle", statistics.find("late"));
  out += line_of("CPU time of a cycle", statistics.find("cpu"));
  for (std::size_t p = 0; peers != nullptr && p < peers->items.size(); ++p) {
    out += line_of("answer of " + scalar(peers->items[p].find("name")), peers->items[p].find("answer"));
    out += line_of("round trip to " + scalar(peers->items[p].find("name")), peers->items[p].find("round_trip"));
  }
  out += fmt::format("  missed cycles: {} by the code, {} by the operating system\n",
                     scalar(statistics.find("missed_by_code")), scalar(statistics.find("missed_by_system")));
  out += fmt::format("  messages: {} taken, {} stale, {} foreign, {} not running; {} not sent\n",
                     scalar(statistics.find("taken")), scalar(statistics.find("stale")),
                     scalar(statistics.find("foreign")), scalar(statistics.find("not_running")),
                     scalar(statistics.find("send_failures")));
  return out;
}

/// "  keys of opc.tcp://sks:4840: 5 in hand, 6 is current, for 8.3 s; given 0.7 s ago by 10.0.0.1:4840"
/// "    asked 12 times, 1 of them for a message with another key, 2 without success; the last time: Connection
/// refused".
std::string lines_of_key_service(const json::Node& service) {
  const auto seconds = [&](const char* key) { return json::double_of(*service.find(key)) / 1e9; };
  std::string out = fmt::format("  keys of {}: ", scalar(service.find("service")));
  const bool has_keys = scalar(service.find("keys")) != "0";
  out += has_keys ? fmt::format("{} in hand, {} is current, for {:.1f} s", scalar(service.find("keys")),
                                scalar(service.find("token")), seconds("ends_in_ns"))
                  : "none in hand";
  if (const std::string by = scalar(service.find("answered_by")); by != "-")
    out += fmt::format("; given {:.1f} s ago by {}", seconds("silent_ns"), by);
  out += fmt::format("\n    asked {} times, {} of them for a message with another key, {} without success",
                     scalar(service.find("pulls")), scalar(service.find("wished")), scalar(service.find("failures")));
  if (const std::string problem = scalar(service.find("problem")); problem != "-") out += "; the last time: " + problem;
  return out + "\n";
}

/// "  server: 3 connections, 2 sessions, 1 subscription, 12 kB held; 40 refused, 3 certificates among them".
std::string lines_of_server(const json::Node& server) {
  std::string out = fmt::format(
      "  server: {}{} connections, {} sessions, {} subscriptions, {} octets held; {} refused, {} certificates among "
      "them\n",
      is_true(server.find("running")) ? "" : "begins anew; ", scalar(server.find("connections")),
      scalar(server.find("sessions")), scalar(server.find("subscriptions")), scalar(server.find("octets")),
      scalar(server.find("refused")), scalar(server.find("rejected")));
  if (const std::string restarts = scalar(server.find("restarts")); restarts != "0")
    out += fmt::format("    began anew {} times; the last time: {}\n", restarts, scalar(server.find("failure")));
  return out;
}

/// Who is refused: "  refused of 10.0.0.3:4840, publisher 3: 12 signature, 1 token".
std::string lines_of_sources(const json::Node& root) {
  std::string out;
  const json::Node* const sources = root.find("sources");
  for (std::size_t s = 0; sources != nullptr && s < sources->items.size(); ++s) {
    const json::Node& source = sources->items[s];
    const json::Node* const refused = source.find("refused");
    if (refused == nullptr || refused->items.empty()) continue;
    out += fmt::format("  refused of {}, publisher {}:", scalar(source.find("address")),
                       scalar(source.find("publisher_id")));
    for (const json::Node& each : refused->items)
      out += fmt::format("{} {} {}", &each == &refused->items.front() ? "" : ",", scalar(each.find("messages")),
                         scalar(each.find("verdict")));
    out += "\n";
  }
  if (const json::Node* const interface = root.find("interface");
      interface != nullptr && !is_true(interface->find("there")))
    out += fmt::format("  interface {} is not there\n", scalar(interface->find("name")));
  const json::Node* const twins = root.find("twins");
  for (std::size_t t = 0; twins != nullptr && t < twins->items.size(); ++t) {
    const json::Node& addresses = *twins->items[t].find("addresses");
    out += fmt::format("  two nodes of one name: publisher {} sends from {} and from {}\n",
                       scalar(twins->items[t].find("publisher_id")), scalar(&addresses.items[0]),
                       scalar(&addresses.items[1]));
  }
  if (const json::Node* const server = root.find("server"); server != nullptr) out += lines_of_server(*server);
  if (const json::Node* const security = root.find("security"); security != nullptr) {
    out += fmt::format("  security: group {}, key {}, life {}, {} messages without a key\n",
                       scalar(security->find("group")), scalar(security->find("token")), scalar(security->find("life")),
                       scalar(security->find("unsealed")));
    if (const std::string returns = scalar(security->find("clock_returns")); returns != "0" && returns != "-")
      out += fmt::format("    the clock was far ahead and came back {} times\n", returns);
    if (const json::Node* const service = security->find("key_service"); service != nullptr)
      out += lines_of_key_service(*service);
  }
  if (const std::string left_out = scalar(root.find("log_lines_left_out")); left_out != "-" && left_out != "0")
    out += fmt::format("  {} lines of the log left out\n", left_out);
  return out;
}

bool is_of_program(const json::Node& node) {
  return node.find("state") != nullptr && node.find("statistics") != nullptr;
}

}  // namespace

std::string sources_text(const std::string& json) {
  json::Diagnostics diagnostics;
  const auto document = json::parse(json, "statistics", diagnostics);
  return document ? lines_of_sources(document->root()) : std::string();
}

std::string status_text(const std::string& json) {
  json::Diagnostics diagnostics;
  const auto document = json::parse(json, "status", diagnostics);
  if (!document) return json + "\n";
  const json::Node& root = document->root();
  const std::string name = scalar(root.find("node"));
  if (is_of_program(root)) return text_of_program(name, root) + lines_of_sources(root);
  const json::Node* const programs = root.find("programs");
  if (programs == nullptr || !std::all_of(programs->items.begin(), programs->items.end(), is_of_program))
    return json + "\n";
  std::string out;
  for (const json::Node& program : programs->items) out += (out.empty() ? "" : "\n") + text_of_program(name, program);
  return out + lines_of_sources(root);
}

}  // namespace takt::node
