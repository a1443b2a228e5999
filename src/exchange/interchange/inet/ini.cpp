// SPDX-License-Identifier: Apache-2.0
#include "interchange/inet/ini.hpp"

#include <algorithm>
#include <charconv>
#include <map>

namespace takt::interchange::inet {
namespace {

std::string trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r\n";
  const std::size_t first = text.find_first_not_of(blank);
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(blank) - first + 1));
}

/// Where a comment begins outside of quotes.
std::string_view without_comment(std::string_view line) {
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && (i == 0 || line[i - 1] != '\\')) quoted = !quoted;
    if (line[i] == '#' && !quoted) return line.substr(0, i);
  }
  return line;
}

class ValueParser {
 public:
  explicit ValueParser(std::string_view text) : text_(text) {}
  std::optional<json::Node> run() {
    auto value = parse(0);
    skip();
    return value && at_ == text_.size() ? value : std::nullopt;
  }

 private:
  void skip() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos) ++at_;
  }
  bool take(char c) {
    skip();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  std::optional<json::Node> parse(int depth) {
    skip();
    if (depth > 16 || at_ >= text_.size()) return std::nullopt;
    if (take('[')) {
      json::Node list = json::Node::array();
      if (take(']')) return list;
      do {
        auto item = parse(depth + 1);
        if (!item) return std::nullopt;
        list.items.push_back(std::move(*item));
      } while (take(','));
      return take(']') ? std::optional(std::move(list)) : std::nullopt;
    }
    if (take('{')) {
      json::Node object = json::Node::object();
      if (take('}')) return object;
      do {
        skip();
        const std::string key = at_ < text_.size() && text_[at_] == '"' ? quoted().value_or("") : word();
        if (key.empty() || !take(':') || object.find(key) != nullptr) return std::nullopt;
        auto value = parse(depth + 1);
        if (!value) return std::nullopt;
        object.add(key, std::move(*value));
      } while (take(','));
      return take('}') ? std::optional(std::move(object)) : std::nullopt;
    }
    if (text_[at_] == '"') {
      const auto text = quoted();
      return text ? std::optional(json::Node::of_string(*text)) : std::nullopt;
    }
    // Words, numbers with units, expressions: up to what ends them, with whole brackets.
    std::string raw;
    int brackets = 0;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (brackets == 0 && (c == ',' || c == ']' || c == '}')) break;
      if (c == '(') ++brackets;
      if (c == ')') --brackets;
      raw += c;
      ++at_;
    }
    raw = trimmed(raw);
    return raw.empty() ? std::nullopt : std::optional(json::Node::of_literal(raw));
  }

  /// From one quote to the next.
  std::optional<std::string> quoted() {
    std::string text;
    for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_) {
      if (text_[at_] == '\\' && at_ + 1 < text_.size()) ++at_;
      text += text_[at_];
    }
    if (at_ >= text_.size()) return std::nullopt;
    ++at_;
    return text;
  }

  std::string word() {
    std::string text;
    while (at_ < text_.size() &&
           std::string_view("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_").find(text_[at_]) !=
               std::string_view::npos)
      text += text_[at_++];
    return text;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

/// "1..3" around a number.
bool is_in_range(std::string_view range, std::string_view number) {
  const auto read = [](std::string_view text, std::uint64_t otherwise) -> std::optional<std::uint64_t> {
    if (text.empty()) return otherwise;
    std::uint64_t value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && stop == text.data() + text.size() ? std::optional(value) : std::nullopt;
  };
  const std::size_t dots = range.find("..");
  const auto value = number.empty() ? std::nullopt : read(number, 0);
  const auto least = read(range.substr(0, dots), 0), most = read(range.substr(dots + 2), ~std::uint64_t{0});
  return value && least && most && *value >= *least && *value <= *most;
}

/// The time is bounded by a table: pattern and path are at most some hundred characters.
class Matcher {
 public:
  Matcher(std::string_view pattern, std::string_view path)
      : pattern_(pattern), path_(path), known_((pattern.size() + 1) * (path.size() + 1), 0) {}
  bool run(std::size_t p, std::size_t t) {
    char& known = known_[p * (path_.size() + 1) + t];
    if (known != 0) return known == 1;
    const bool result = step(p, t);
    known = result ? 1 : 2;
    return result;
  }

 private:
  bool step(std::size_t p, std::size_t t) {
    if (p == pattern_.size()) return t == path_.size();
    if (pattern_.substr(p).starts_with("**")) return run(p + 2, t) || (t < path_.size() && run(p, t + 1));
    if (pattern_[p] == '*') return run(p + 1, t) || (t < path_.size() && path_[t] != '.' && run(p, t + 1));
    if (pattern_[p] == '[' || pattern_[p] == '{') {
      const char close = pattern_[p] == '[' ? ']' : '}';
      const std::size_t end = pattern_.find(close, p);
      const std::string_view inner =
          end == std::string_view::npos ? std::string_view() : pattern_.substr(p + 1, end - p - 1);
      if (inner.find("..") != std::string_view::npos) {
        std::size_t from = t;
        if (close == ']') {
          if (t >= path_.size() || path_[t] != '[') return false;
          from = t + 1;
        }
        std::size_t stop = from;
        while (stop < path_.size() && path_[stop] >= '0' && path_[stop] <= '9') ++stop;
        if (!is_in_range(inner, path_.substr(from, stop - from))) return false;
        if (close == ']') return stop < path_.size() && path_[stop] == ']' && run(end + 1, stop + 1);
        return run(end + 1, stop);
      }
      if (close == '}' && inner.size() == 3 && inner[1] == '-')
        return t < path_.size() && path_[t] >= inner[0] && path_[t] <= inner[2] && run(end + 1, t + 1);
    }
    if (t >= path_.size()) return false;
    if (pattern_[p] == '?') return path_[t] != '.' && run(p + 1, t + 1);
    return pattern_[p] == path_[t] && run(p + 1, t + 1);
  }

  std::string_view pattern_, path_;
  std::vector<char> known_;
};

}  // namespace

bool matches(std::string_view pattern, std::string_view path) {
  if (pattern.size() > 300 || path.size() > 300) return false;
  return Matcher(pattern, path).run(0, 0);
}

std::optional<json::Node> parse_value(std::string_view text) { return ValueParser(text).run(); }

namespace {

/// "1,2,4", "1..5 step 2": the values.
std::vector<std::string> iterated(std::string_view text) {
  std::vector<std::string> values;
  const auto read_number = [](const std::string& word) -> std::optional<std::int64_t> {
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && !word.empty() && stop == word.data() + word.size() ? std::optional(value)
                                                                                      : std::nullopt;
  };
  std::string item;
  int depth = 0;
  bool is_quoted = false;
  const auto end_item = [&] {
    const std::string one = trimmed(item);
    item.clear();
    const std::size_t dots = one.find("..");
    const std::size_t step_at = one.find(" step ");
    const auto first = dots == std::string::npos ? std::nullopt : read_number(trimmed(one.substr(0, dots)));
    const auto last =
        dots == std::string::npos
            ? std::nullopt
            : read_number(trimmed(one.substr(dots + 2, step_at == std::string::npos ? step_at : step_at - dots - 2)));
    const auto step =
        step_at == std::string::npos ? std::optional<std::int64_t>(1) : read_number(trimmed(one.substr(step_at + 6)));
    if (!first || !last || !step || *step <= 0) return values.push_back(one);
    for (std::int64_t n = *first; n <= *last && values.size() < 10'000; n += *step) values.push_back(std::to_string(n));
  };
  for (const char c : text) {
    if (c == '"') is_quoted = !is_quoted;
    if (c == '(' || c == '[' || c == '{') ++depth;
    if (c == ')' || c == ']' || c == '}') --depth;
    if (c == ',' && depth == 0 && !is_quoted)
      end_item();
    else
      item += c;
  }
  end_item();
  return values;
}

/// The iterations of all lines, with the values of one run in their place.
class Iterations {
 public:
  Iterations(std::uint64_t run, const std::string& section) : run_(run) {
    chosen_["configname"] = section;
    chosen_["runnumber"] = std::to_string(run);
    chosen_["repetition"] = "0";
  }

  void find(const std::vector<IniLine>& lines) {
    for (const IniLine& line : lines)
      for_each(line.value, [&](const std::string& inside) {
        const std::size_t equals = inside.find('=');
        const bool is_named = equals != std::string::npos && inside.find_first_of("<>!\"") > equals;
        const std::string name = is_named ? trimmed(inside.substr(0, equals)) : inside;
        std::string values = is_named ? inside.substr(equals + 1) : inside;
        if (!is_named && inside.find(',') == std::string::npos && inside.find("..") == std::string::npos) return;
        if (chosen_.contains(name) ||
            std::ranges::any_of(all_, [&](const Iteration& each) { return each.name == name; }))
          return;
        Iteration made{name, {}, ""};
        if (const std::size_t mark = values.rfind('!'); mark != std::string::npos) {
          made.beside = trimmed(values.substr(mark + 1));
          values.resize(mark);
        }
        made.values = iterated(values);
        all_.push_back(std::move(made));
      });
    choose();
  }
  std::uint64_t runs() const { return runs_; }
  bool any() const { return !all_.empty(); }

  std::string replaced(const std::string& value) const {
    std::string out;
    std::size_t at = 0;
    while (true) {
      const std::size_t open = value.find("${", at);
      const std::size_t close = open == std::string::npos ? open : end_of(value, open);
      if (close == std::string::npos) return out + value.substr(at);
      const std::string inside = value.substr(open + 2, close - open - 2);
      const std::size_t equals = inside.find('=');
      const bool is_named = equals != std::string::npos && inside.find_first_of("<>!\"") > equals;
      const auto found = chosen_.find(is_named ? trimmed(inside.substr(0, equals)) : trimmed(inside));
      out += value.substr(at, open - at) + (found == chosen_.end() ? "${" + inside + "}" : found->second);
      at = close + 1;
    }
  }

 private:
  struct Iteration {
    std::string name;
    std::vector<std::string> values;
    std::string beside;  ///< another, whose place it takes
  };
  static std::size_t end_of(const std::string& value, std::size_t open) {
    int depth = 0;
    for (std::size_t i = open + 1; i < value.size(); ++i) {
      if (value[i] == '{') ++depth;
      if (value[i] == '}' && --depth == 0) return i;
    }
    return std::string::npos;
  }
  template <class Use>
  static void for_each(const std::string& value, Use use) {
    for (std::size_t open = value.find("${"); open != std::string::npos; open = value.find("${", open + 2))
      if (const std::size_t close = end_of(value, open); close != std::string::npos)
        use(value.substr(open + 2, close - open - 2));
  }
  /// The first varies slowest.
  void choose() {
    std::map<std::string, std::size_t> places;
    std::uint64_t rest = run_;
    runs_ = 1;
    for (auto each = all_.rbegin(); each != all_.rend(); ++each) {
      if (!each->beside.empty() || runs_ > 1'000'000) continue;
      const std::uint64_t count = std::max<std::uint64_t>(each->values.size(), 1);
      places[each->name] = static_cast<std::size_t>(rest % count);
      rest /= count;
      runs_ *= count;
    }
    for (const Iteration& each : all_) {
      const std::size_t place = each.beside.empty() ? places[each.name] : places[each.beside];
      chosen_[each.name] = each.values.empty() ? "" : each.values[std::min(place, each.values.size() - 1)];
    }
    for (auto& [name, value] : chosen_) value = replaced(value);
  }

  std::uint64_t run_;
  std::uint64_t runs_ = 1;
  std::vector<Iteration> all_;
  std::map<std::string, std::string> chosen_;
};

}  // namespace

void Ini::read(const InputFile& file, const std::string& section, std::uint64_t run, std::vector<Remark>& remarks,
               json::Diagnostics& diagnostics) {
  struct Section {
    std::vector<IniLine> lines;
    std::string extends;
  };
  std::map<std::string, Section> sections;
  std::string current = "General";
  IniLine* last = nullptr;
  std::string_view rest = file.text;
  bool goes_on = false;
  for (std::uint32_t number = 1; !rest.empty(); ++number) {
    const std::size_t end = rest.find('\n');
    std::string line(without_comment(rest.substr(0, end)));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    const bool is_indented = !line.empty() && (line[0] == ' ' || line[0] == '\t');
    std::string content = trimmed(line);
    const bool continues = content.ends_with('\\');
    if (continues) content = trimmed(std::string_view(content).substr(0, content.size() - 1));
    const json::Place place{file.name, number,
                            static_cast<std::uint32_t>(line.find_first_not_of(" \t") == std::string::npos
                                                           ? 1
                                                           : line.find_first_not_of(" \t") + 1),
                            ""};
    if (content.empty()) {
      goes_on = goes_on && continues;
      continue;
    }
    if ((is_indented || goes_on) && last != nullptr) {
      last->value += " " + content;
      goes_on = continues;
      continue;
    }
    goes_on = continues;
    last = nullptr;
    if (content.front() == '[') {
      if (content.back() != ']') {
        diagnostics.error(place, "a section that does not end", {json::quote(content), "[General] or [Config NAME]"});
        continue;
      }
      current = trimmed(std::string_view(content).substr(1, content.size() - 2));
      if (current.starts_with("Config ")) current = trimmed(std::string_view(current).substr(7));
      sections[current];
      continue;
    }
    if (content.starts_with("include ")) {
      diagnostics.error(place, "a further file", {json::quote(content), "one file without include"});
      continue;
    }
    const std::size_t equals = content.find('=');
    if (equals == std::string::npos) {
      diagnostics.error(place, "not a setting", {json::quote(content), "KEY = VALUE"});
      continue;
    }
    IniLine made{trimmed(std::string_view(content).substr(0, equals)),
                 trimmed(std::string_view(content).substr(equals + 1)), place, false};
    if (made.key == "extends") {
      sections[current].extends = made.value;
      continue;
    }
    sections[current].lines.push_back(std::move(made));
    last = &sections[current].lines.back();
  }
  if (!sections.contains(section) && section != "General") {
    diagnostics.error({file.name, 0, 0, ""}, "no such section",
                      {json::quote(section), "the name of a section, as -o config=NAME"});
    return;
  }
  // The section, what it extends, and General last.
  std::set<std::string> seen;
  std::vector<std::string> order = {section};
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (!seen.insert(order[i]).second) continue;
    const Section& part = sections[order[i]];
    for (const IniLine& line : part.lines) lines_.push_back(line);
    std::string_view bases = part.extends;
    while (!bases.empty()) {
      const std::size_t comma = bases.find(',');
      order.push_back(trimmed(bases.substr(0, comma)));
      bases.remove_prefix(comma == std::string_view::npos ? bases.size() : comma + 1);
    }
    if (i + 1 == order.size() && !seen.contains("General")) order.emplace_back("General");
  }
  Iterations iterations(run, section);
  iterations.find(lines_);
  if (iterations.any() && run >= iterations.runs())
    diagnostics.error({file.name, 0, 0, ""}, "no such run",
                      {"run " + std::to_string(run), "0 to " + std::to_string(iterations.runs() - 1)});
  if (iterations.any() && iterations.runs() > 1)
    remarks.push_back({RemarkKind::odd,
                       {file.name, 0, 0, ""},
                       "one of " + std::to_string(iterations.runs()) + " runs of its iterations: number " +
                           std::to_string(run) + " (-o run=N)"});
  for (IniLine& line : lines_) {
    line.value = iterations.replaced(line.value);
    if (line.value.find("${") != std::string::npos)
      diagnostics.error(line.place, "a variable without a value",
                        {json::quote(line.value), "an iteration of that name"});
  }
}

const IniLine* Ini::find(const std::string& path) {
  const IniLine* first = nullptr;
  for (IniLine& line : lines_) {
    if (!matches(line.key, path)) continue;
    line.is_used = true;  // also what an earlier line hides: it is understood
    if (first == nullptr) first = &line;
  }
  return first;
}

const IniLine* Ini::find_global(const std::string& key) {
  for (IniLine& line : lines_)
    if (line.key == key) {
      line.is_used = true;
      return &line;
    }
  return nullptr;
}

}  // namespace takt::interchange::inet
