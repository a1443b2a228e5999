// SPDX-License-Identifier: Apache-2.0
#include "json/diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "json/printable.hpp"

namespace takt::json {

namespace {

std::string_view name_of(Severity severity) { return severity == Severity::error ? "error" : "warning"; }

}  // namespace

std::string to_text(const Diagnostic& diagnostic) {
  const auto& [severity, place, message, details] = diagnostic;
  std::string text = place.file;
  if (place.line != 0) text += fmt::format(":{}:{}", place.line, place.column);
  text += text.empty() ? "" : ": ";
  text += name_of(severity);
  if (!place.pointer.empty()) text += " at " + place.pointer;
  text += ": " + message;
  if (!details.found.empty()) text += ": found " + details.found;
  if (!details.expected.empty()) text += (details.found.empty() ? ": expected " : ", expected ") + details.expected;
  if (!details.suggestion.empty()) text += " (did you mean " + quote(details.suggestion) + "?)";
  return printable(text);  // names of files, and what they say
}

Node to_json(const Diagnostic& diagnostic) {
  Node json = Node::object();
  json.add("severity", Node::of_string(name_of(diagnostic.severity)));
  json.add("file", Node::of_string(diagnostic.place.file));
  json.add("line", Node::of_integer(diagnostic.place.line));
  json.add("column", Node::of_integer(diagnostic.place.column));
  json.add("pointer", Node::of_string(diagnostic.place.pointer));
  json.add("message", Node::of_string(diagnostic.message));
  const auto add_if_present = [&json](std::string_view key, const std::string& text) {
    if (!text.empty()) json.add(key, Node::of_string(text));
  };
  add_if_present("found", diagnostic.details.found);
  add_if_present("expected", diagnostic.details.expected);
  add_if_present("suggestion", diagnostic.details.suggestion);
  return json;
}

namespace {
constexpr std::size_t most_pointers = 10'000;  // nobody reads what comes of the mistakes behind
}

void Diagnostics::error(Place place, std::string message, Details details) {
  if (!place.pointer.empty() && unreadable_.contains(place.pointer)) return consequence();
  // A value without a file was made in place of one that could not be read, which has been told.
  if (place.file.empty() && errors_ > 0) return consequence();
  ++errors_;
  note_refused(place.pointer);
  keep(Severity::error, std::move(place), std::move(message), std::move(details));
}

void Diagnostics::unreadable(Place place, std::string message, Details details) {
  ++errors_;
  note_refused(place.pointer);
  if (unreadable_.size() < most_pointers) unreadable_.insert(place.pointer);
  keep(Severity::error, std::move(place), std::move(message), std::move(details));
}

void Diagnostics::error_unless(bool is_consequence, Place place, std::string message, Details details) {
  if (is_consequence) return consequence();
  error(std::move(place), std::move(message), std::move(details));
}

void Diagnostics::warning(Place place, std::string message, Details details) {
  ++warnings_;
  keep(Severity::warning, std::move(place), std::move(message), std::move(details));
}

bool Diagnostics::is_refused(const Place& place) const {
  const auto found = refused_.lower_bound(place.pointer);
  if (found == refused_.end()) return false;
  if (*found == place.pointer) return true;
  // What is below begins with the pointer and a slash; other names that begin alike may stand between.
  const auto below = refused_.lower_bound(place.pointer + "/");
  return below != refused_.end() && below->starts_with(place.pointer + "/");
}

void Diagnostics::note_refused(std::string pointer) {
  if (refused_.size() < most_pointers) refused_.insert(std::move(pointer));
}

void Diagnostics::keep(Severity severity, Place place, std::string message, Details details) {
  if (full()) return;
  kept_.push_back({severity, std::move(place), std::move(message), std::move(details)});
}

std::vector<Diagnostic> Diagnostics::sorted() const {
  std::vector<std::string_view> files;  // in order of first report; there are few
  const auto rank = [&files](const Diagnostic& d) {
    return std::ranges::find(files, std::string_view(d.place.file)) - files.begin();
  };
  for (const Diagnostic& diagnostic : kept_)
    if (rank(diagnostic) == std::ssize(files)) files.push_back(diagnostic.place.file);

  std::vector<Diagnostic> result = kept_;
  std::ranges::stable_sort(result, [&rank](const Diagnostic& a, const Diagnostic& b) {
    return std::tuple(rank(a), a.place.line, a.place.column) < std::tuple(rank(b), b.place.line, b.place.column);
  });
  return result;
}

namespace {

/// Whether they say the same of different places of one file.
bool say_the_same(const Diagnostic& a, const Diagnostic& b) {
  return a.severity == b.severity && a.place.file == b.place.file && a.message == b.message &&
         a.details.found == b.details.found && a.details.expected == b.details.expected &&
         a.details.suggestion == b.details.suggestion;
}

/// "  the same at 5:9 (/links/1/rate), 6:9 (/links/2/rate) and 37 more places".
std::string others_text(const std::vector<const Diagnostic*>& others) {
  constexpr std::size_t most = 3;
  std::string text = "  the same at ";
  for (std::size_t i = 0; i < std::min(most, others.size()); ++i) {
    const Place& place = others[i]->place;
    if (i > 0) text += i + 1 == others.size() ? " and " : ", ";
    if (place.line != 0) text += fmt::format("{}:{}", place.line, place.column);
    if (!place.pointer.empty())
      text += place.line != 0 ? " (" + printable(place.pointer) + ")" : printable(place.pointer);
  }
  if (others.size() > most) text += fmt::format(" and {} more places", others.size() - most);
  return text + "\n";
}

}  // namespace

std::string Diagnostics::to_text() const {
  constexpr std::size_t fewest_to_group = 3;  // two take two lines, grouped or not
  std::string text;
  const std::vector<Diagnostic> all_kept = sorted();
  std::vector<bool> is_reported(all_kept.size(), false);
  for (std::size_t i = 0; i < all_kept.size(); ++i) {
    if (is_reported[i]) continue;
    text += json::to_text(all_kept[i]) + "\n";
    std::vector<const Diagnostic*> others;
    for (std::size_t j = i + 1; j < all_kept.size(); ++j)
      if (!is_reported[j] && say_the_same(all_kept[i], all_kept[j])) others.push_back(&all_kept[j]);
    if (others.size() + 1 < fewest_to_group) continue;
    for (const Diagnostic* other : others) is_reported[static_cast<std::size_t>(other - all_kept.data())] = true;
    text += others_text(others);
  }
  const std::size_t all = errors_ + warnings_;
  if (all > kept_.size()) text += fmt::format("... and {} more\n", all - kept_.size());
  return text;
}

Node Diagnostics::to_json() const {
  Node list = Node::array();
  for (const Diagnostic& diagnostic : sorted()) list.items.push_back(json::to_json(diagnostic));
  Node json = Node::object();
  json.add("errors", Node::of_integer(static_cast<std::int64_t>(errors_)));
  json.add("warnings", Node::of_integer(static_cast<std::int64_t>(warnings_)));
  json.add("diagnostics", std::move(list));
  return json;
}

}  // namespace takt::json
