// SPDX-License-Identifier: Apache-2.0
// What the commands of a script are, as far as that follows from the script alone.
#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <set>
#include <utility>

#include "interchange/linux/script.hpp"
#include "interchange/linux/shell.hpp"
#include "interchange/linux/shell_arithmetic.hpp"
#include "json/node.hpp"

namespace takt::interchange::linux_tc {
namespace {

constexpr char unknown_mark = '\x01';  // stands in a text for what is not known
constexpr std::size_t most_commands = 100'000;
constexpr std::uint32_t deepest_call = 32;

bool is_known(std::string_view text) { return text.find(unknown_mark) == std::string_view::npos; }

std::string_view last_of_path(std::string_view path) {
  return path.substr(path.rfind('/') == std::string_view::npos ? 0 : path.rfind('/') + 1);
}

class ShellRunner {
 public:
  ShellRunner(const std::string& file, std::vector<Remark>& remarks, json::Diagnostics& diagnostics)
      : file_(file), remarks_(remarks), diagnostics_(diagnostics) {}

  std::vector<Command> run(const ShellNode& script) {
    evaluate(script);
    return std::move(commands_);
  }

 private:
  using Kind = ShellNode::Kind;
  enum class Outcome : std::uint8_t { yes, no, unknown };

  void refuse(const json::Place& place, const std::string& message, const std::string& found,
              const std::string& expected) {
    diagnostics_.error(place, message, {json::quote(found), expected});
  }
  void remark(RemarkKind kind, const json::Place& place, const std::string& text) {
    if (told_.insert(text).second) remarks_.push_back({kind, place, text});
  }

  // Words

  std::string value_of(const std::string& name) const {
    if (!name.empty() && name.find_first_not_of("0123456789") == std::string::npos) {
      std::size_t number = 0;
      std::from_chars(name.data(), name.data() + name.size(), number);
      if (has_arguments_ && number > 0) return number <= arguments_.size() ? arguments_[number - 1] : "";
      return std::string(1, unknown_mark);
    }
    const auto found = variables_.find(name);
    return found == variables_.end() ? std::string(1, unknown_mark) : found->second;
  }
  std::string expanded(const std::string& inside) const {
    std::size_t end = 0;
    while (end < inside.size() && (std::isalnum(static_cast<unsigned char>(inside[end])) != 0 || inside[end] == '_'))
      ++end;
    const std::string name = inside.substr(0, end), rest = inside.substr(end);
    const std::string value = value_of(name);
    if (rest.empty()) return value;
    const bool is_set = variables_.contains(name) || (has_arguments_ && !value.empty());
    for (const std::string_view sign : {":-", "-", ":=", "="})
      if (rest.starts_with(sign))
        return is_set && is_known(value) && !value.empty() ? value
               : rest.find('$') == std::string::npos       ? rest.substr(sign.size())
                                                           : std::string(1, unknown_mark);
    if (is_known(value) &&
        (rest.starts_with('%') || rest.starts_with('#'))) {  // a fixed end or beginning is taken away
      const std::string cut = rest.substr(rest.find_first_not_of(rest[0]));
      if (cut.find_first_of("*?[$") == std::string::npos) {
        if (rest[0] == '%' && value.ends_with(cut)) return value.substr(0, value.size() - cut.size());
        if (rest[0] == '#' && value.starts_with(cut)) return value.substr(cut.size());
        return value;
      }
    }
    return std::string(1, unknown_mark);
  }
  /// What `seq` and `echo` of known words print; anything else is not known.
  std::string output_of(const std::string& text) {
    json::Diagnostics none;
    const ShellNode node = parse_shell(text, file_, none);
    if (none.has_errors() || node.parts.size() != 1 || node.parts[0].kind != Kind::simple)
      return std::string(1, unknown_mark);
    Command command;
    for (const ShellWord& word : node.parts[0].words)
      for (std::string& each : fields(word)) command.push_back({std::move(each), word.place});
    if (command.empty()) return "";
    std::string out;
    if (command[0].text == "echo") {
      for (std::size_t i = 1; i < command.size(); ++i) out += (i == 1 ? "" : " ") + command[i].text;
      return out;
    }
    std::array<std::int64_t, 3> bounds{1, 1, 1};
    if (command[0].text != "seq" || command.size() < 2 || command.size() > 4) return std::string(1, unknown_mark);
    for (std::size_t i = 1; i < command.size(); ++i) {
      const std::string& word = command[i].text;
      const std::size_t into = command.size() == 2 ? 2 : command.size() == 3 ? (i == 1 ? 0 : 2) : i - 1;
      const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), bounds[into]);
      if (error != std::errc() || stop != word.data() + word.size()) return std::string(1, unknown_mark);
    }
    std::size_t count = 0;
    if (bounds[1] != 0)
      for (std::int64_t n = bounds[0]; (bounds[1] > 0 ? n <= bounds[2] : n >= bounds[2]) && ++count < 10'000;
           n += bounds[1])
        out += (out.empty() ? "" : " ") + std::to_string(n);
    return out;
  }
  std::string text_of(const ShellPiece& piece) {
    switch (piece.kind) {
      case ShellPiece::Kind::text:
        return piece.text;
      case ShellPiece::Kind::variable: {
        if (piece.text == "@" || piece.text == "*") {
          std::string all;
          for (const std::string& each : arguments_) all += (all.empty() ? "" : " ") + each;
          return has_arguments_ ? all : std::string(1, unknown_mark);
        }
        if (piece.text == "#" && has_arguments_) return std::to_string(arguments_.size());
        return expanded(piece.text);
      }
      case ShellPiece::Kind::arithmetic: {
        const auto value = shell_arithmetic(piece.text, [&](const std::string& name) { return value_of(name); });
        return value ? std::to_string(*value) : std::string(1, unknown_mark);
      }
      case ShellPiece::Kind::command:
        return output_of(piece.text);
    }
    return {};
  }
  /// One text, as where a value is assigned.
  std::string joined(const ShellWord& word) {
    std::string text;
    for (const ShellPiece& piece : word.pieces) text += text_of(piece);
    return text;
  }
  /// The words that a word becomes: what is worked out outside of quotes is split, braces are written out.
  std::vector<std::string> fields(const ShellWord& word) {
    std::vector<std::string> all;
    std::string current;
    bool is_open = false;
    for (const ShellPiece& piece : word.pieces) {
      if (piece.kind == ShellPiece::Kind::variable && piece.text == "@" && piece.is_quoted && has_arguments_ &&
          word.pieces.size() <= 2) {
        for (const std::string& each : arguments_) all.push_back(each);
        continue;
      }
      const std::string text = text_of(piece);
      if (piece.is_quoted || piece.kind == ShellPiece::Kind::text) {
        current += text;
        is_open = is_open || piece.is_quoted || !text.empty();
        continue;
      }
      for (const char c : text) {
        if (c != ' ' && c != '\t' && c != '\n') {
          current += c;
          is_open = true;
        } else if (is_open) {
          all.push_back(std::move(current));
          current.clear();
          is_open = false;
        }
      }
    }
    if (is_open && !(current.empty() && !all.empty())) all.push_back(std::move(current));
    const bool has_quotes = std::ranges::any_of(word.pieces, [](const ShellPiece& piece) { return piece.is_quoted; });
    if (has_quotes || word.source.find('{') == std::string::npos) return all;
    std::vector<std::string> written;
    for (const std::string& each : all) add_braces(each, written);
    return written;
  }
  static void add_braces(const std::string& text, std::vector<std::string>& into) {
    const std::size_t open = text.find('{');
    const std::size_t close = open == std::string::npos ? open : text.find('}', open);
    if (close == std::string::npos || into.size() > 1000) return into.push_back(text);
    const std::string before = text.substr(0, open), inside = text.substr(open + 1, close - open - 1),
                      after = text.substr(close + 1);
    std::vector<std::string> items;
    if (const std::size_t dots = inside.find(".."); dots != std::string::npos) {
      std::int64_t first = 0, last = 0;
      const auto a = std::from_chars(inside.data(), inside.data() + dots, first);
      const auto b = std::from_chars(inside.data() + dots + 2, inside.data() + inside.size(), last);
      if (a.ec == std::errc() && b.ec == std::errc() && last - first < 1000 && first - last < 1000)
        for (std::int64_t n = first; first <= last ? n <= last : n >= last; n += first <= last ? 1 : -1)
          items.push_back(std::to_string(n));
    } else if (inside.find(',') != std::string::npos) {
      std::size_t from = 0;
      for (std::size_t comma = inside.find(',');; comma = inside.find(',', from)) {
        items.push_back(inside.substr(from, comma == std::string::npos ? comma : comma - from));
        if (comma == std::string::npos) break;
        from = comma + 1;
      }
    }
    if (items.empty()) return into.push_back(text);
    for (const std::string& item : items) add_braces(before + item + after, into);
  }

  // Commands

  /// Whether something is set by it that takt reads; functions are looked into.
  bool is_setting(const ShellNode& node, std::uint32_t depth = 0) const {
    if (depth > deepest_call) return true;
    if (node.kind != Kind::simple)
      return std::ranges::any_of(node.parts, [&](const ShellNode& part) {
        return node.kind != Kind::function && is_setting(part, depth + 1);
      });
    bool is_read = false, is_link = false, is_ip = false, is_ethtool = false, found = false;
    for (const ShellWord& word : node.words) {
      const std::string_view name = last_of_path(word.plain());
      if (const auto function = functions_.find(std::string(name));
          function != functions_.end() && is_setting(*function->second, depth + 1))
        return true;
      found = found || name == "tc" || name == "bridge" ||
              (!word.pieces.empty() && word.pieces[0].kind == ShellPiece::Kind::variable && &word == &node.words[0]);
      is_ip = is_ip || name == "ip";
      is_ethtool = is_ethtool || name == "ethtool";
      is_read = is_read || name == "show" || name == "list" || name == "ls";
      is_link = is_link || name == "type" || name == "master" || name == "--set-mm" || name == "speed";
    }
    return (found && !is_read) || ((is_ip || is_ethtool) && is_link);
  }

  Outcome evaluate(const ShellNode& node) {
    if (stopped_ || commands_.size() > most_commands) return Outcome::unknown;
    switch (node.kind) {
      case Kind::simple:
        return run_simple(node);
      case Kind::sequence: {
        Outcome last = Outcome::yes;
        for (const ShellNode& part : node.parts) last = evaluate(part);
        return last;
      }
      case Kind::negation: {
        const Outcome inner = evaluate(node.parts[0]);
        return inner == Outcome::yes ? Outcome::no : inner == Outcome::no ? Outcome::yes : inner;
      }
      case Kind::and_then:
        return run_and(node);
      case Kind::or_else:
        return run_or(node);
      case Kind::pipe:
        for (std::size_t i = 1; i < node.parts.size(); ++i)
          if (is_setting(node.parts[i]))
            refuse(node.parts[i].place, "what only a run can say", source_of(node.parts[i]),
                   "commands that are not made by others: the text behind \"|\" written out");
        evaluate(node.parts[0]);
        return Outcome::unknown;
      case Kind::branch:
        return run_branch(node);
      case Kind::each:
        return run_each(node);
      case Kind::loop:
        if (is_setting(node))
          refuse(node.place, "how often only a run can say", source_of(node), "a loop over a list: for NAME in ...");
        return Outcome::unknown;
      case Kind::choice:
        return run_choice(node);
      case Kind::function:
        functions_[node.name] = &node.parts[0];
        return Outcome::yes;
    }
    return Outcome::unknown;
  }

  static std::string source_of(const ShellNode& node) {
    const ShellNode* at = &node;
    while (at->words.empty() && !at->parts.empty()) at = &at->parts.front();
    std::string text;
    for (const ShellWord& word : at->words) text += (text.empty() ? "" : " ") + word.source;
    return text;
  }

  Outcome run_and(const ShellNode& node) {
    const Outcome left = evaluate(node.parts[0]);
    if (left == Outcome::no) return left;
    if (left == Outcome::unknown && !is_setting(node.parts[0]) && is_setting(node.parts[1])) {
      refuse(node.parts[0].place, "a condition that only a run can decide", source_of(node.parts[0]),
             "commands that are always given");
      return left;
    }
    return evaluate(node.parts[1]);
  }
  /// What comes after a command that fails: a command that sets something does not; of one that only looks it is not
  /// known.
  Outcome run_or(const ShellNode& node) {
    const Outcome left = evaluate(node.parts[0]);
    if (left == Outcome::yes) return left;
    const bool left_sets = is_setting(node.parts[0]);
    if (left == Outcome::no || (!left_sets && is_setting(node.parts[1]))) return evaluate(node.parts[1]);
    if (left_sets && is_setting(node.parts[1]))
      remark(RemarkKind::odd, node.parts[1].place,
             "the second of two commands of which only one is given (||): the first is taken");
    return Outcome::unknown;
  }

  Outcome run_branch(const ShellNode& node) {
    for (std::size_t i = 0; i + 1 < node.parts.size(); i += 2) {
      const Outcome condition = evaluate(node.parts[i]);
      if (condition == Outcome::yes) return evaluate(node.parts[i + 1]);
      if (condition == Outcome::no) continue;
      const bool sets = std::ranges::any_of(node.parts, [&](const ShellNode& part) { return is_setting(part); });
      if (sets)
        refuse(node.place, "a condition that only a run can decide", source_of(node.parts[i]),
               "commands that are always given");
      return Outcome::unknown;
    }
    return node.parts.size() % 2 == 1 ? evaluate(node.parts.back()) : Outcome::yes;
  }

  Outcome run_each(const ShellNode& node) {
    std::vector<std::string> values;
    for (const ShellWord& word : node.words)
      for (std::string& each : fields(word)) values.push_back(std::move(each));
    if (!std::ranges::all_of(values, [](const std::string& value) {
          return is_known(value) && value.find_first_of("*?[") == std::string::npos;
        })) {
      if (is_setting(node.parts[0]))
        refuse(node.place, "a list that only a run can say", source_of(node), "a list of words");
      return Outcome::unknown;
    }
    for (const std::string& value : values) {
      variables_[node.name] = value;
      evaluate(node.parts[0]);
    }
    return Outcome::yes;
  }

  Outcome run_choice(const ShellNode& node) {
    const std::string subject = node.words.empty() ? std::string(1, unknown_mark) : joined(node.words[0]);
    if (is_known(subject)) {
      for (std::size_t i = 0; i < node.parts.size(); ++i)
        for (const ShellWord& pattern : node.patterns[i])
          if (const std::string text = joined(pattern); text == subject || text == "*") return evaluate(node.parts[i]);
      return Outcome::yes;
    }
    if (std::ranges::any_of(node.parts, [&](const ShellNode& part) { return is_setting(part); }))
      refuse(node.place, "a condition that only a run can decide", source_of(node), "commands that are always given");
    return Outcome::unknown;
  }

  Outcome test(const Command& command) {
    std::vector<std::string> words;
    for (std::size_t i = 1; i < command.size(); ++i) words.push_back(command[i].text);
    if (!words.empty() && (words.back() == "]" || words.back() == "]]")) words.pop_back();
    if (!std::ranges::all_of(words, [](const std::string& word) { return is_known(word); })) return Outcome::unknown;
    const auto answer = [](bool is_so) { return is_so ? Outcome::yes : Outcome::no; };
    if (words.size() == 2 && words[0] == "-n") return answer(!words[1].empty());
    if (words.size() == 2 && words[0] == "-z") return answer(words[1].empty());
    if (words.size() != 3) return Outcome::unknown;
    if (words[1] == "=" || words[1] == "==") return answer(words[0] == words[2]);
    if (words[1] == "!=") return answer(words[0] != words[2]);
    std::int64_t a = 0, b = 0;
    const auto is_number = [](const std::string& text, std::int64_t& value) {
      const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      return error == std::errc() && stop == text.data() + text.size();
    };
    if (!is_number(words[0], a) || !is_number(words[2], b)) return Outcome::unknown;
    if (words[1] == "-eq") return answer(a == b);
    if (words[1] == "-ne") return answer(a != b);
    if (words[1] == "-lt") return answer(a < b);
    if (words[1] == "-le") return answer(a <= b);
    if (words[1] == "-gt") return answer(a > b);
    if (words[1] == "-ge") return answer(a >= b);
    return Outcome::unknown;
  }

  /// NAME=value at the beginning of a word.
  static std::optional<std::string> assigned_name(const ShellWord& word) {
    if (word.pieces.empty() || word.pieces[0].kind != ShellPiece::Kind::text || word.pieces[0].is_quoted)
      return std::nullopt;
    const std::string& text = word.pieces[0].text;
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0 || (text[0] >= '0' && text[0] <= '9')) return std::nullopt;
    for (std::size_t i = 0; i < equals; ++i)
      if (std::isalnum(static_cast<unsigned char>(text[i])) == 0 && text[i] != '_') return std::nullopt;
    return text.substr(0, equals);
  }
  bool assign(const ShellWord& word) {
    const auto name = assigned_name(word);
    if (!name) return false;
    variables_[*name] = joined(word).substr(name->size() + 1);
    return true;
  }

  Outcome run_simple(const ShellNode& node) {
    if (node.name == "array") {
      std::string all;
      for (std::size_t i = 1; i < node.words.size(); ++i) all += (i == 1 ? "" : " ") + joined(node.words[i]);
      const std::string& source = node.words[0].source;
      variables_[source.substr(0, source.size() - 1)] = all;
      return Outcome::yes;
    }
    std::size_t first = 0;
    while (first < node.words.size() && assigned_name(node.words[first])) ++first;
    if (first == node.words.size()) {
      for (const ShellWord& word : node.words) assign(word);
      return node.words.empty() ? Outcome::unknown : Outcome::yes;
    }
    const std::string_view builtin = node.words[first].plain();
    if (builtin == "export" || builtin == "local" || builtin == "readonly" || builtin == "declare" ||
        builtin == "typeset") {
      for (std::size_t i = first + 1; i < node.words.size(); ++i) assign(node.words[i]);
      return Outcome::yes;
    }
    Command command;
    for (std::size_t i = first; i < node.words.size(); ++i)
      for (std::string& text : fields(node.words[i])) {
        Word word{std::move(text), node.words[i].place};
        if (!is_known(word.text)) word.unknown = node.words[i].source;
        command.push_back(std::move(word));
      }
    strip(command);
    if (command.empty()) return Outcome::unknown;
    return give(std::move(command), node);
  }

  /// What stands before a command and changes nothing of what it sets.
  static void strip(Command& command) {
    while (!command.empty()) {
      const std::string name(last_of_path(command[0].text));
      std::size_t count = 0;
      if (name == "ip" && command.size() > 4 && command[1].text == "netns" && command[2].text == "exec")
        count = 4;
      else if (name == "sudo" || name == "env" || name == "exec" || name == "command" || name == "time" ||
               name == "nice" || name == "nohup" || name == "chrt" || name == "eval" || name == "run" ||
               name == "doas") {
        count = 1;
        while (count < command.size() && (command[count].text.starts_with('-') ||
                                          (name == "env" && command[count].text.find('=') != std::string::npos))) {
          const bool has_value = command[count].text == "-u" || command[count].text == "-g" ||
                                 command[count].text == "-n" || command[count].text == "-f";
          count += has_value && !(name == "sudo" && command[count].text == "-n") ? 2 : 1;
        }
      }
      if (count == 0) return;
      command.erase(command.begin(), command.begin() + static_cast<std::ptrdiff_t>(std::min(count, command.size())));
    }
  }

  Outcome give(Command command, const ShellNode& node) {
    const std::string name(last_of_path(command[0].text));
    if (const auto function = functions_.find(name); function != functions_.end())
      return call(*function->second, command);
    if (name == "[" || name == "[[" || name == "test") return test(command);
    if (name == "true" || name == ":") return Outcome::yes;
    if (name == "false") return Outcome::no;
    if (name == "exit") {
      stopped_ = true;
      return Outcome::yes;
    }
    if (name == "shift") {
      if (!arguments_.empty()) arguments_.erase(arguments_.begin());
      return Outcome::yes;
    }
    if (name == "." || name == "source") {
      remark(RemarkKind::lost, node.place,
             "what stands in another file (" + source_of(node) + "): give that file, too");
      return Outcome::unknown;
    }
    const auto batch = std::ranges::find_if(
        command, [](const Word& word) { return word.text == "-batch" || word.text == "-b" || word.text == "-ba"; });
    if ((name == "tc" || name == "ip" || name == "bridge") && batch != command.end()) {
      if (node.document.empty())
        remark(RemarkKind::lost, node.place,
               "the commands of a batch (" + source_of(node) + "): give that file, too, as FILE.batch");
      for (Command& each : batch_of(node.document, name, node.document_line)) commands_.push_back(std::move(each));
      return Outcome::unknown;
    }
    command[0].text = name;
    commands_.push_back(std::move(command));
    return Outcome::unknown;
  }

  Outcome call(const ShellNode& body, const Command& command) {
    if (++depth_ > deepest_call) {
      refuse(command[0].place, "calls within calls, too deep", command[0].text,
             "at most " + std::to_string(deepest_call));
      stopped_ = true;
      return Outcome::unknown;
    }
    std::vector<std::string> arguments;
    for (std::size_t i = 1; i < command.size(); ++i) arguments.push_back(command[i].text);
    std::swap(arguments_, arguments);
    const bool had = std::exchange(has_arguments_, true);
    const Outcome outcome = evaluate(body);
    arguments_ = std::move(arguments);
    has_arguments_ = had;
    --depth_;
    return outcome;
  }

  std::vector<Command> batch_of(const std::string& text, const std::string& program, std::uint32_t line) {
    json::Diagnostics none;
    std::vector<Command> commands;
    const ShellNode node = parse_shell(std::string(line > 1 ? line - 1 : 0, '\n') + text, file_, none);
    ShellRunner inner(file_, remarks_, diagnostics_);
    inner.variables_ = variables_;
    for (Command& command : inner.run(node)) {
      if (command[0].text != program) command.insert(command.begin(), Word{program, command[0].place, {}});
      commands.push_back(std::move(command));
    }
    return commands;
  }

  const std::string& file_;
  std::vector<Remark>& remarks_;
  json::Diagnostics& diagnostics_;
  std::vector<Command> commands_;
  std::map<std::string, std::string> variables_;
  std::map<std::string, const ShellNode*> functions_;
  std::vector<std::string> arguments_;
  bool has_arguments_ = false, stopped_ = false;
  std::uint32_t depth_ = 0;
  std::set<std::string> told_;
};

/// The commands of a trace (sh -x), each behind its plus signs; what else was printed is left out, and all stay in
/// their lines.
std::string without_trace(std::string_view text) {
  std::string commands;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    const std::size_t plus = line.find_first_not_of('+');
    const bool is_command = plus != 0 && plus != std::string_view::npos && line[plus] == ' ';
    std::string_view first = is_command ? line.substr(plus + 1) : std::string_view();
    first = first.substr(0, first.find(' '));
    const bool is_plain =
        first != "for" && first != "case" && first != "[[" && first != "((" && first != "while" && first != "if";
    if (is_command && is_plain) commands += std::string(plus, ' ') + std::string(line.substr(plus));
    commands += '\n';
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return commands;
}

}  // namespace

std::vector<Command> commands_of(std::string_view text, const std::string& file, std::vector<Remark>& remarks,
                                 json::Diagnostics& diagnostics) {
  const bool is_trace = text.starts_with("+ ") || text.find("\n+ ") != std::string_view::npos;
  const std::string commands = is_trace ? without_trace(text) : std::string(text);
  const std::size_t errors = diagnostics.errors();
  const ShellNode script = parse_shell(commands, file, diagnostics);
  return diagnostics.errors() != errors ? std::vector<Command>() : ShellRunner(file, remarks, diagnostics).run(script);
}

}  // namespace takt::interchange::linux_tc
