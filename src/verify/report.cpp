#include "verify/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "scenario/json/node.hpp"
#include "scenario/json/quantity.hpp"

namespace takt::verify {
namespace {

using scenario::json::Node;
using sim::Duration;

/// Six digits are enough for people; the JSON has them all.
std::string figure(const std::optional<Duration>& time) {
  if (!time) return "-";
  const auto ps = static_cast<double>(time->ps());
  constexpr std::pair<double, const char*> units[] = {{1e12, "s"}, {1e9, "ms"}, {1e6, "us"}, {1e3, "ns"}};
  for (const auto& [unit, name] : units)
    if (ps >= unit) return fmt::format("{:.6g} {}", ps / unit, name);
  return fmt::format("{} ps", time->ps());
}

Node picoseconds(const std::optional<Duration>& time) { return time ? Node::of_integer(time->ps()) : Node(); }
Node number(std::uint64_t value) { return Node::of_integer(static_cast<std::int64_t>(value)); }

/// In which the sandwich is ordered: 8 columns would not fit, so each requirement has two lines.
std::string line_text(const Line& line, const std::string& file) {
  std::string out = fmt::format("  {:<9}  {}\n", name_of(line.verdict), line.requirement.text);
  if (line.requirement.limit)
    out += fmt::format("             simulated {} <= adversarial {} <= bound {}; limit {}{}\n", figure(line.simulated), figure(line.adversarial), figure(line.bound),
                       figure(line.requirement.limit), line.tightness() ? fmt::format("; tightness {:.0f} %", 100 * *line.tightness()) : "");
  if (!line.reason.empty() && line.verdict != Verdict::pass) out += fmt::format("             {}\n", line.reason);
  if (!file.empty()) out += fmt::format("             replay: takt run {}\n", file);
  return out;
}

}  // namespace

std::string text_report(const std::string& scenario, const Verification& verification, const std::vector<std::string>& files) {
  std::string out = fmt::format("{}: {} of {} requirements proved, {} runs{}\n\n", scenario,
                                std::count_if(verification.lines.begin(), verification.lines.end(), [](const Line& line) { return line.verdict == Verdict::pass; }),
                                verification.lines.size(), verification.runs, verification.partial ? ", interrupted" : "");
  for (std::size_t i = 0; i < verification.lines.size(); ++i) out += line_text(verification.lines[i], files[i]);
  if (!verification.freedoms.empty()) {
    out += fmt::format("\nFree, hence searched for the worst ({}):\n", verification.freedoms.size());
    constexpr std::size_t most = 12;
    for (std::size_t i = 0; i < std::min(most, verification.freedoms.size()); ++i)
      out += fmt::format("  {} within {}\n", verification.freedoms[i].name, figure(verification.freedoms[i].range));
    if (verification.freedoms.size() > most) out += fmt::format("  and {} more\n", verification.freedoms.size() - most);
  }
  std::vector<std::string> assumptions;
  std::set<std::string> seen;
  for (const Line& line : verification.lines)
    for (const std::string& assumption : line.assumptions)
      if (seen.insert(assumption).second) assumptions.push_back(assumption);
  if (!assumptions.empty()) out += "\nThe bounds rest on:\n";
  for (const std::string& assumption : assumptions) out += "  - " + assumption + "\n";
  return out + fmt::format("\n{}: {}\n", scenario, name_of(verification.verdict()));
}

std::string json_report(const std::string& scenario, const Verification& verification, const std::vector<std::string>& files) {
  Node root = Node::object();
  root.add("scenario", Node::of_string(scenario));
  root.add("verdict", Node::of_string(name_of(verification.verdict())));
  root.add("runs", number(verification.runs));
  root.add("partial", Node::of_bool(verification.partial));
  Node open = Node::array();
  for (const Freedom& freedom : verification.freedoms) {
    Node node = Node::object();
    node.add("what", Node::of_string(freedom.name));
    node.add("range_ps", Node::of_integer(freedom.range.ps()));
    open.items.push_back(std::move(node));
  }
  root.add("free", std::move(open));
  Node requirements = Node::array();
  for (std::size_t i = 0; i < verification.lines.size(); ++i) {
    const Line& line = verification.lines[i];
    Node node = Node::object();
    node.add("text", Node::of_string(line.requirement.text));
    node.add("simulated_ps", picoseconds(line.simulated));
    node.add("adversarial_ps", picoseconds(line.adversarial));
    node.add("bound_ps", picoseconds(line.bound));
    node.add("limit_ps", picoseconds(line.requirement.limit));
    node.add("verdict", Node::of_string(name_of(line.verdict)));
    node.add("tightness", line.tightness() ? Node::of_double(*line.tightness()) : Node());
    node.add("runs", number(line.runs));
    node.add("exhaustive", Node::of_bool(line.exhaustive));
    node.add("reason", line.reason.empty() ? Node() : Node::of_string(line.reason));
    Node assumptions = Node::array();
    for (const std::string& assumption : line.assumptions) assumptions.items.push_back(Node::of_string(assumption));
    node.add("assumptions", std::move(assumptions));
    node.add("file", files[i].empty() ? Node() : Node::of_string(files[i]));
    requirements.items.push_back(std::move(node));
  }
  root.add("requirements", std::move(requirements));
  return scenario::json::pretty(root);
}

}  // namespace takt::verify
