// SPDX-License-Identifier: Apache-2.0
#include "chart/page.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "chart/svg.hpp"

namespace takt::chart {
namespace {

constexpr std::string_view style =
    ":root{color-scheme:light dark;--ink:#222;--paper:#fff;--faint:#666;--line:#ddd;--head:#f6f6f6}"
    "body{font:14px/1.45 system-ui,sans-serif;color:var(--ink);background:var(--paper);max-width:1180px;margin:24px "
    "auto;padding:0 16px}"
    "h1{font-size:22px}h2{font-size:17px;margin-top:32px;border-bottom:1px solid "
    "var(--line)}h3{font-size:14px;margin:18px 0 4px}"
    ".table{overflow-x:auto}table{border-collapse:collapse;margin:8px 0}td,th{padding:3px 10px;border-bottom:1px solid "
    "var(--line);text-align:left;vertical-align:top;"
    "font-variant-numeric:tabular-nums}th{font-weight:600;background:var(--head)}td.n{text-align:right;white-space:"
    "nowrap}"
    ".charts{display:flex;flex-wrap:wrap;gap:14px;align-items:flex-start}.charts>svg{max-width:100%;height:auto}.wide{"
    "overflow-x:auto}"
    ".pass{color:#00734f}.fail{color:#c0392b}.undecided{color:#9a6700}.note{color:var(--faint)}pre{white-space:pre-"
    "wrap;margin:0;font-size:12px}"
    ".verdict{font-size:17px;font-weight:600;padding:10px 14px;border-left:5px solid "
    "currentColor;background:var(--head)}"
    "details>summary{cursor:pointer;font-weight:600;margin:10px 0}"
    ".stack{display:flex;gap:3px;margin:4px 0}.stack .group{flex:1 1 "
    "0;min-width:0}.parts{display:flex;height:22px;outline:1px solid var(--line)}"
    ".part{min-width:1px;forced-color-adjust:none;print-color-adjust:exact;-webkit-print-color-adjust:exact;background-"
    "color:var(--k)}.parts .part{flex:1 1 0;box-shadow:inset -1px 0 var(--paper)}"
    ".stack "
    ".name{font-size:12px;color:var(--faint);overflow:hidden;text-overflow:ellipsis;white-space:nowrap}.way{margin:0}"
    ".legend{display:flex;flex-wrap:wrap;gap:4px 18px;list-style:none;margin:8px 0;padding:0}.legend "
    ".part{display:inline-block;width:16px;height:12px;margin-right:6px}"
    ".k0{--k:#6f7f8a}.k1{--k:#c3ccd2}.k2{--k:#999933}.k3{--k:#0072b2}.k4{--k:#d55e00}.k5{--k:#e69f00}.k6{--k:#009e73}."
    "k7{--k:#cc79a7}.k8{--k:#7d3f98}"
    ".k5,.k7,.k8{background-image:repeating-linear-gradient(45deg,transparent 0 4px,var(--paper) 4px 5px)}"
    "@media (max-width:480px){td,th{padding:3px 5px}}"
    "svg .stretch{fill:#009e73;opacity:.22}svg .failed{stroke:#c0392b;stroke-width:2.5}svg text.pass{fill:#00734f}svg "
    "text.fail{fill:#c0392b;font-weight:600}svg text.undecided{fill:#9a6700}\n";

/// What the style sheet of charts has for white paper.
constexpr std::string_view dark =
    "@media screen and "
    "(prefers-color-scheme:dark){:root{--ink:#ddd;--paper:#15191c;--faint:#9aa5ad;--line:#3a4248;--head:#20262a}"
    ".pass{color:#4cc38a}.fail{color:#ff7b6b}.undecided{color:#e3b341}svg text{fill:#ccc}svg .axis{stroke:#8a949b}svg "
    ".grid{stroke:#2c3439}svg .limit{stroke:#ff7b6b}"
    "svg text.pass{fill:#4cc38a}svg text.fail{fill:#ff7b6b}svg text.undecided{fill:#e3b341}svg "
    ".box{fill:#20303c;stroke:#58a6d6}svg .paper{fill:#15191c}svg .arrow{stroke:#ccc}svg .arrowhead{fill:#ccc}svg "
    ".note{fill:#aab4bb;stroke:#15191c}svg [stroke=\"#000000\"]{stroke:#ddd}svg [fill=\"#000000\"]{fill:#ddd}"
    ".k0{--k:#93a3ae}.k1{--k:#4a565e}.k2{--k:#c3c36b}.k3{--k:#3b94d0}.k4{--k:#ff8a3d}.k6{--k:#2dbb91}.k8{--k:#b583cf}}"
    "\n";

/// On paper nothing scrolls and nothing is folded: tables and charts are as wide as the page, wide charts stand across
/// on pages of their own, and heads of tables are repeated.
constexpr std::string_view paper =
    "@page{size:A4;margin:12mm}@page across{size:A4 landscape;margin:12mm}"
    "@media "
    "print{body{max-width:none;margin:0;padding:0;font-size:9.5pt}h2,h3,summary,.note{break-after:avoid}svg,tr,.stack,."
    "verdict{break-inside:avoid}"
    ".table,.wide{overflow:visible}table{width:100%;font-size:8pt}td,th{padding:2px "
    "5px;overflow-wrap:anywhere}thead{display:table-header-group}"
    ".charts{display:block}.charts>svg,.wide>svg{display:block;width:auto;height:auto;max-width:100%;max-height:255mm;"
    "margin:0 0 8px}.wide:not(.tall){page:across}.wide:not(.tall)>svg{max-height:180mm}"
    "details .charts>svg{display:inline-block;max-width:49%}"
    ".stack "
    ".name{white-space:normal;overflow-wrap:anywhere;font-size:7pt}details{display:block}details::details-content{"
    "content-visibility:visible;display:block}"
    ".verdict,th,svg .stretch{print-color-adjust:exact;-webkit-print-color-adjust:exact}}\n";

}  // namespace

std::string page_head(std::string_view title) {
  const std::string safe = escaped(title);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\">"
      "<link rel=\"icon\" href=\"data:,\"><title>{}</title><style>{}{}{}{}</style></head><body>\n<h1>{}</h1>\n",
      safe, style, style_sheet(), dark, paper, safe);
}

std::string page_end() { return "</body></html>\n"; }

std::string section(std::string_view title, std::string_view note) {
  std::string text = "<h2>" + escaped(title) + "</h2>\n";
  if (!note.empty()) text += "<p class=\"note\">" + escaped(note) + "</p>\n";
  return text;
}

std::string charts(const std::vector<std::string>& elements) {
  if (elements.empty()) return {};
  std::string text = "<div class=\"charts\">\n";
  for (const std::string& element : elements) text += element;
  return text + "</div>\n";
}

std::string wide_chart(const std::string& element) {
  double width = 0, height = 0;
  const std::size_t size = element.find("viewBox=");
  const bool is_tall = size != std::string::npos &&
                       std::sscanf(element.c_str() + size, "viewBox=\"0 0 %lf %lf\"", &width, &height) == 2 &&
                       height > width;
  return std::string("<div class=\"wide") + (is_tall ? " tall" : "") + "\">" + element + "</div>\n";
}

void Table::row(const std::vector<Cell>& cells) {
  if (++rows_ > most_rows_) return;
  body_ += "<tr>";
  for (const Cell& cell : cells) {
    std::string looks(cell.is_number ? "n" : "");
    if (!cell.look.empty()) looks += (looks.empty() ? "" : " ") + std::string(cell.look);
    body_ += (looks.empty() ? std::string("<td>") : "<td class=\"" + looks + "\">") + escaped(cell.text) + "</td>";
  }
  body_ += "</tr>\n";
}

std::string Table::take() {
  if (rows_ == 0) return {};
  std::string text = "<div class=\"table\"><table>";
  if (!heads_.empty()) {
    text += "<thead><tr>";
    for (const std::string& head : heads_) text += "<th>" + escaped(head) + "</th>";
    text += "</tr></thead>\n";
  }
  text += "<tbody>" + std::move(body_);
  if (rows_ > most_rows_)
    text +=
        fmt::format("<tr><td class=\"note\" colspan=\"{}\">and {} more</td></tr>\n", heads_.size(), rows_ - most_rows_);
  return text + "</tbody></table></div>\n";
}

}  // namespace takt::chart
