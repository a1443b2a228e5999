#include "cli/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iterator>

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
constexpr Word verdicts[] = {{"pass", green}, {"proved", green}, {"FAIL", red}, {"fail", red}, {"refuted", red}, {"contradiction", red}, {"violated", red},
                             {"open", yellow}, {"undecided", yellow}};
constexpr Word severities[] = {{"error", red}, {"warning", yellow}};

bool wants_colour(int file) {
  const char* const refused = std::getenv("NO_COLOR");
  const char* const terminal = std::getenv("TERM");
  return ::isatty(file) == 1 && (refused == nullptr || *refused == '\0') && (terminal == nullptr || std::string_view(terminal) != "dumb");
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
  return std::string(line.substr(0, at)).append(word.colour).append(word.text).append(plain).append(line.substr(at + word.text.size()));
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

}  // namespace

std::size_t page_width() {
  if (::isatty(STDOUT_FILENO) != 1) return 0;
  constexpr std::size_t least = 80;
  winsize size{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) return least;
  return std::max<std::size_t>(least, size.ws_col);
}

std::string with_colour(std::string_view page) { return by_line(page, with_verdict); }

void print(const std::string& page) { std::fputs((wants_colour(STDOUT_FILENO) ? with_colour(page) : page).c_str(), stdout); }

void tell_files(const std::string& summary, const std::string& report) {
  std::fflush(stdout);
  std::fputs(summary.c_str(), stderr);
  if (!report.empty()) std::fprintf(stderr, "Written: %s, for a browser\n", report.c_str());
}

void tell(const json::Diagnostics& diagnostics) {
  const std::string text = diagnostics.to_text();
  std::fputs((wants_colour(STDERR_FILENO) ? by_line(text, [](std::string_view line, bool) { return with_severity(line); }) : text).c_str(), stderr);
}

}  // namespace takt::cli
