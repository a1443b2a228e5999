// SPDX-License-Identifier: Apache-2.0
#include "cli/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iterator>

#include "json/printable.hpp"

namespace takt::cli {
namespace {

constexpr std::string_view green = "\033[32m";
constexpr std::string_view red = "\033[1;31m";
constexpr std::string_view yellow = "\033[33m";
constexpr std::string_view plain = "\033[0m";

struct Word {
  std::string_view text;
  std::string_view colour;
};

// What run, verify, explore, study and emulate conclude.
constexpr Word verdicts[] = {{"pass", green},   {"proved", green}, {"FAIL", red},
                             {"fail", red},     {"refuted", red},  {"contradiction", red},
                             {"violated", red}, {"open", yellow},  {"undecided", yellow}};
constexpr Word severities[] = {{"error", red}, {"warning", yellow}};

bool wants_colour(int file) {
  const char* const refused = std::getenv("NO_COLOR");
  const char* const terminal = std::getenv("TERM");
  return ::isatty(file) == 1 && (refused == nullptr || *refused == '\0') &&
         (terminal == nullptr || std::string_view(terminal) != "dumb");
}

/// The word that the text begins with, if it ends there.
template <std::size_t n>
const Word* word_at(std::string_view text, const Word (&words)[n]) {
  const auto found = std::find_if(std::begin(words), std::end(words), [&](const Word& word) {
    if (!text.starts_with(word.text)) return false;
    const char next = text.size() > word.text.size() ? text[word.text.size()] : '\n';
    return next == ' ' || next == ',' || next == ':' || next == '\n';
  });
  return found == std::end(words) ? nullptr : found;
}

std::string painted(std::string_view line, std::size_t at, const Word& word) {
  return std::string(line.substr(0, at))
      .append(word.colour)
      .append(word.text)
      .append(plain)
      .append(line.substr(at + word.text.size()));
}

/// "  pass  reaction ...", or "robot-arm: pass, digest ..." on the last line.
std::string with_verdict(std::string_view line, bool is_last) {
  const std::size_t first = line.find_first_not_of(' ');
  if (line.starts_with("  ") && first <= 4)
    if (const Word* const word = word_at(line.substr(first), verdicts)) return painted(line, first, *word);
  const std::size_t colon = line.rfind(": ");
  if (is_last && colon != std::string_view::npos)
    if (const Word* const word = word_at(line.substr(colon + 2), verdicts)) return painted(line, colon + 2, *word);
  return std::string(line);
}

/// "s.json:3:4: error at /x: ...".
std::string with_severity(std::string_view line) {
  for (std::size_t at = line.find(": "); at != std::string_view::npos; at = line.find(": ", at + 2))
    if (const Word* const word = word_at(line.substr(at + 2), severities)) return painted(line, at + 2, *word);
  return std::string(line);
}

template <class Paint>
std::string by_line(std::string_view page, Paint paint) {
  std::string out;
  while (!page.empty()) {
    const std::size_t end = std::min(page.find('\n'), page.size() - 1) + 1;
    out += paint(page.substr(0, end), end == page.size());
    page.remove_prefix(end);
  }
  return out;
}

/// Columns that a text takes: continuation octets of UTF-8 take none.
std::size_t columns_of(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

/// With its newline, if it has one.
std::string folded_line(std::string_view line, std::size_t width) {
  const std::string_view end = line.ends_with('\n') ? "\n" : "";
  line.remove_suffix(end.size());
  std::string out, rest;
  const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
  // A part begins behind two spaces; far to the right there is no room below it.
  std::size_t hang = indent + 2;
  for (std::size_t gap = line.find("  ", indent); gap != std::string_view::npos; gap = line.find("  ", gap)) {
    gap = line.find_first_not_of(' ', gap);
    if (gap == std::string_view::npos || gap > width / 2) break;
    hang = gap;
  }
  while (columns_of(line) > width) {
    std::size_t limit = 0;  // octets that fit
    for (std::size_t columns = 0; limit < line.size(); ++limit)
      if ((static_cast<unsigned char>(line[limit]) & 0xC0) != 0x80 && ++columns > width) break;
    const std::size_t least = out.empty() ? indent : hang;
    std::size_t at = line.rfind(' ', limit);
    if (at == std::string_view::npos || at <= least) {
      // A word that is longer than the line, such as a list of choices.
      const std::size_t comma = line.rfind(',', limit - 1);
      if (comma != std::string_view::npos && comma > least) {
        out.append(line.substr(0, comma + 1)).append("\n");
        rest = std::string(hang, ' ').append(line.substr(comma + 1));
        line = rest;
        continue;
      }
      at = line.find(' ', std::max(limit, least));
    }
    if (at == std::string_view::npos) break;
    const std::size_t last = line.find_last_not_of(' ', at), next = line.find_first_not_of(' ', at);
    if (last == std::string_view::npos || next == std::string_view::npos || last < least) break;
    out.append(line.substr(0, last + 1)).append("\n");
    rest = std::string(hang, ' ').append(line.substr(next));
    line = rest;
  }
  return out.append(line).append(end);
}

}  // namespace

std::size_t page_width() {
  if (::isatty(STDOUT_FILENO) != 1) return 0;
  constexpr std::size_t least = 80;
  winsize size{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) return least;
  return std::max<std::size_t>(least, size.ws_col);
}

std::string with_colour(std::string_view page) { return by_line(page, with_verdict); }

std::string folded(std::string_view page, std::size_t width) {
  return width == 0 ? std::string(page)
                    : by_line(page, [width](std::string_view line, bool) { return folded_line(line, width); });
}

void print(const std::string& page) {
  // JSON is for programs, wherever it goes.
  const bool is_json = page.starts_with('{') || page.starts_with('[');
  const std::string shown = json::printable_page(page);  // names of others are not written to act on a terminal
  const std::string fitting = is_json ? shown : folded(shown, page_width());
  std::fputs((wants_colour(STDOUT_FILENO) ? with_colour(fitting) : fitting).c_str(), stdout);
}

void print_files(const std::string& summary, const std::string& report) {
  std::fflush(stdout);
  std::fputs(summary.c_str(), stderr);
  if (!report.empty()) std::fprintf(stderr, "Written: %s, for a browser\n", report.c_str());
}

void tell(const json::Diagnostics& diagnostics) {
  const std::string text = diagnostics.to_text();
  std::fputs(
      (wants_colour(STDERR_FILENO) ? by_line(text, [](std::string_view line, bool) { return with_severity(line); })
                                   : text)
          .c_str(),
      stderr);
}

}  // namespace takt::cli
