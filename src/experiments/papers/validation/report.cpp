// SPDX-License-Identifier: Apache-2.0
#include "papers/validation/report.hpp"

#include <fmt/format.h>

#include <array>

#include "papers/folder.hpp"

namespace takt::papers::validation {
namespace {

constexpr const char* introduction = R"(# Published figures

Every published or measured figure that takt was compared with: what the source says, what takt says, and why they differ where they do. All of it comes out of one command,
which wrote this page:

```
takt paper validation --out out/validation      report, this page and the pictures; exit status 1 if a figure is missed
takt paper validation --short                   of large tables some rows only: seconds, and a test
```

The tables are data: `validation/*.json`, a file for each source. A further figure is one entry there: the scenario, where takt's figure is found (a figure of a run, a stream's
bound by analysis, the worst run that the search finds, a flow of a network of servers), what is published, and how it is judged.

- *published* is as the source has it, *takt* by the same conventions; where takt counts more or less than the source, the text above the table says what.
- *must be*: "equal" is to the last digit that is given; "within" allows a difference either way; "at most" and "at least" are one-sided.
- The pictures: `ratios.svg`, every figure as a multiple of the published one, and for each source whose figures come in rows one of what is published among what takt says.
- *met*; *calibrated*: the scenario was fitted to it, so it proves nothing; *differs*: takt says something else, for the reason given; *MISSED*: neither.

Two whole evaluations have pages of their own, [papers/programs.md](papers/programs.md) and [papers/coexistence.md](papers/coexistence.md).

)";

std::string cell(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2)) text.insert(at, "\\");
  return text;
}

std::string with_unit(const std::string& text, const std::string& unit) {
  return text + (unit.empty() || text.starts_with("none") ? "" : " " + unit);
}

std::string summary(const Validation& made) {
  std::string out =
      fmt::format("{:<34}{:>9}{:>6}{:>12}{:>9}{:>8}\n", "", "figures", "met", "calibrated", "differ", "missed");
  const auto line = [&](const std::string& name, std::optional<std::size_t> source) {
    std::array<std::size_t, 5> counts{};
    std::size_t all = 0;
    for (std::size_t v = 0; v < counts.size(); ++v) all += counts[v] = made.count(static_cast<Agreement>(v), source);
    return fmt::format("{:<34}{:>9}{:>6}{:>12}{:>9}{:>8}\n", name, all, counts[0] + counts[3], counts[1], counts[2],
                       counts[4]);
  };
  for (std::size_t s = 0; s < made.sources.size(); ++s) out += line(made.sources[s].name, s);
  return out + line("all", std::nullopt);
}

std::string verdict_text(const Validation& made) {
  const std::size_t differing = made.count(Agreement::differs);
  if (!made.holds()) return fmt::format("NOT REPRODUCED: {} missed", made.count(Agreement::missed));
  return differing == 0 ? "REPRODUCED" : fmt::format("REPRODUCED but for {} that differ", differing);
}

std::string lines_of(const Validation& made, Agreement verdict, const char* title) {
  std::string out;
  for (const Judged& each : made.figures)
    if (each.verdict == verdict)
      out += fmt::format("  {}: {}: published {}, takt {}; must be {}{}\n", made.sources[each.source].name, each.what,
                         with_unit(each.published, each.unit), with_unit(each.takt, each.unit), each.rule,
                         each.why.empty() ? "" : "\n      " + each.why);
  return out.empty() ? "" : std::string("\n") + title + "\n" + out;
}

json::Node real(const std::optional<double>& value) { return value ? json::Node::of_double(*value) : json::Node(); }

}  // namespace

std::string text_report(const Validation& made) {
  return fmt::format("Published figures{}\n\n", made.is_short ? " (short: of large tables some rows)" : "") +
         summary(made) + lines_of(made, Agreement::missed, "Missed") +
         lines_of(made, Agreement::differs, "Different, as the tables say") +
         lines_of(made, Agreement::met_after_all, "Met, though the tables say that they differ") +
         fmt::format("\n{}\n", verdict_text(made));
}

std::string json_report(const Validation& made) {
  using json::Node;
  Node node = Node::object();
  node.add("paper", Node::of_string("validation"));
  node.add("short", Node::of_bool(made.is_short));
  node.add("holds", Node::of_bool(made.holds()));
  Node figures = Node::array();
  for (const Judged& each : made.figures) {
    Node figure = Node::object();
    figure.add("source", Node::of_string(made.sources[each.source].name));
    figure.add("what", Node::of_string(each.what));
    figure.add("unit", Node::of_string(each.unit));
    figure.add("published", Node::of_string(each.published));
    figure.add("takt", Node::of_string(each.takt));
    figure.add("published_value", real(each.published_value));
    figure.add("takt_value", real(each.takt_value));
    figure.add("must_be", Node::of_string(each.rule));
    figure.add("verdict", Node::of_string(name_of(each.verdict)));
    figure.add("why", Node::of_string(each.why));
    figures.items.push_back(std::move(figure));
  }
  node.add("figures", std::move(figures));
  return json::pretty(node);
}

std::string markdown_report(const Validation& made) {
  std::string out = introduction;
  out += "<!-- not held here: tests/frontends/cli/paper_command_test.py holds the whole page -->\n```\n" + summary(made) + "\n" +
         verdict_text(made) + "\n```\n";
  for (std::size_t s = 0; s < made.sources.size(); ++s) {
    const SourceOfFigures& source = made.sources[s];
    out += fmt::format(
        "\n## {}\n\n{}\n\n{}{}| figure | published | takt | difference | must be | | why "
        "|\n|---|---|---|---|---|---|---|\n",
        source.name, source.reference, source.about, source.about.empty() ? "" : "\n\n");
    for (const Judged& each : made.figures)
      if (each.source == s)
        out += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", cell(each.what),
                           cell(with_unit(each.published, each.unit)), cell(with_unit(each.takt, each.unit)),
                           each.difference, each.rule, name_of(each.verdict), cell(each.why));
  }
  return out;
}

std::string write_folder(const std::string& folder, const Validation& made) {
  return papers::write_folder(
      folder, {text_report(made), json_report(made), made.pictures, {}, {{"validation.md", markdown_report(made)}}});
}

}  // namespace takt::papers::validation
