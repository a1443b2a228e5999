// SPDX-License-Identifier: Apache-2.0
#include "interchange/inet/expression.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace takt::interchange::inet {
namespace {

constexpr sim::int128 scale = 1'000'000'000'000;
constexpr sim::int128 greatest = std::numeric_limits<std::int64_t>::max() * scale;
constexpr int deepest_expression = 32;

struct UnitName {
  std::string_view name;
  Unit unit;
  std::int64_t factor;    ///< in 10^-12 of the unit, or
  std::int64_t multiple;  ///< in the unit
};
constexpr UnitName unit_names[] = {{"ps", Unit::second, 1, 0},
                                   {"ns", Unit::second, 1'000, 0},
                                   {"us", Unit::second, 1'000'000, 0},
                                   {"ms", Unit::second, 1'000'000'000, 0},
                                   {"s", Unit::second, 0, 1},
                                   {"min", Unit::second, 0, 60},
                                   {"h", Unit::second, 0, 3600},
                                   {"bps", Unit::bit_per_second, 0, 1},
                                   {"kbps", Unit::bit_per_second, 0, 1'000},
                                   {"Mbps", Unit::bit_per_second, 0, 1'000'000},
                                   {"Gbps", Unit::bit_per_second, 0, 1'000'000'000},
                                   {"Tbps", Unit::bit_per_second, 0, 1'000'000'000'000},
                                   {"b", Unit::octet, 125'000'000'000, 0},
                                   {"B", Unit::octet, 0, 1},
                                   {"kB", Unit::octet, 0, 1'000},
                                   {"MB", Unit::octet, 0, 1'000'000},
                                   {"GB", Unit::octet, 0, 1'000'000'000},
                                   {"KiB", Unit::octet, 0, 1'024},
                                   {"MiB", Unit::octet, 0, 1'048'576},
                                   {"mm", Unit::metre, 1'000'000'000, 0},
                                   {"cm", Unit::metre, 10'000'000'000, 0},
                                   {"m", Unit::metre, 0, 1},
                                   {"km", Unit::metre, 0, 1'000}};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

class Evaluator {
 public:
  Evaluator(std::string_view text, const Lookup& lookup) : text_(text), lookup_(lookup) {}
  std::optional<Value> run() {
    auto value = choice();
    skip();
    return at_ == text_.size() ? value : std::nullopt;
  }

 private:
  using Result = std::optional<Value>;
  void skip() {
    while (at_ < text_.size() && std::string_view(" \t\r\n").find(text_[at_]) != std::string_view::npos) ++at_;
  }
  bool take(std::string_view sign) {
    skip();
    if (!text_.substr(at_).starts_with(sign)) return false;
    at_ += sign.size();
    return true;
  }
  static Result truth(bool is_so) {
    Value value;
    value.kind = Value::Kind::truth;
    value.truth = is_so;
    return value;
  }

  Result choice() {
    if (++depth_ > deepest_expression) return std::nullopt;
    Result condition = either();
    if (take("?")) {
      Result yes = choice();
      if (!take(":")) return std::nullopt;
      Result no = choice();
      if (!condition || condition->kind != Value::Kind::truth) return std::nullopt;
      condition = condition->truth ? yes : no;
    }
    --depth_;
    return condition;
  }
  Result either() {
    Result left = both();
    while (take("||")) {
      const Result right = both();
      left = left && right ? truth(left->truth || right->truth) : std::nullopt;
    }
    return left;
  }
  Result both() {
    Result left = comparison();
    while (take("&&")) {
      const Result right = comparison();
      left = left && right ? truth(left->truth && right->truth) : std::nullopt;
    }
    return left;
  }
  Result comparison() {
    Result left = sum();
    for (const std::string_view sign : {"==", "!=", "<=", ">=", "<", ">"}) {
      if (!take(sign)) continue;
      const Result right = sum();
      if (!left || !right || left->kind != right->kind || left->unit != right->unit) return std::nullopt;
      const int order = left->kind == Value::Kind::number ? (left->amount < right->amount   ? -1
                                                             : left->amount > right->amount ? 1
                                                                                            : 0)
                        : left->kind == Value::Kind::text
                            ? left->text.compare(right->text)
                            : static_cast<int>(left->truth) - static_cast<int>(right->truth);
      return truth(sign == "=="   ? order == 0
                   : sign == "!=" ? order != 0
                   : sign == "<=" ? order <= 0
                   : sign == ">=" ? order >= 0
                   : sign == "<"  ? order < 0
                                  : order > 0);
    }
    return left;
  }
  Result sum() {
    Result left = product();
    while (true) {
      skip();
      const char sign = at_ < text_.size() ? text_[at_] : '\0';
      if (sign != '+' && sign != '-') return left;
      ++at_;
      const Result right = product();
      if (!left || !right || left->kind != right->kind) {
        left.reset();
        continue;
      }
      if (left->kind == Value::Kind::text && sign == '+')
        left->text += right->text;
      else if (left->kind != Value::Kind::number || left->unit != right->unit)
        left.reset();
      else
        left->amount += sign == '+' ? right->amount : -right->amount;
    }
  }
  Result product() {
    Result left = atom();
    while (true) {
      skip();
      const char sign = at_ < text_.size() ? text_[at_] : '\0';
      if (sign != '*' && sign != '/' && sign != '%') return left;
      ++at_;
      const Result right = atom();
      left = left && right ? combined(*left, sign, *right) : std::nullopt;
    }
  }
  static Result combined(Value left, char sign, const Value& right) {
    if (left.kind != Value::Kind::number || right.kind != Value::Kind::number) return std::nullopt;
    if (sign == '*') {
      const bool left_is_plain = left.unit == Unit::none;
      if (!left_is_plain && right.unit != Unit::none) return std::nullopt;
      const sim::int128 plain = left_is_plain ? left.amount : right.amount,
                        other = left_is_plain ? right.amount : left.amount;
      if (plain % scale != 0 && other % scale != 0) return std::nullopt;
      const sim::int128 whole = plain % scale == 0 ? plain / scale : other / scale,
                        rest = plain % scale == 0 ? other : plain;
      if (rest != 0 && (whole > greatest / (rest < 0 ? -rest : rest) || -whole > greatest / (rest < 0 ? -rest : rest)))
        return std::nullopt;
      left.amount = whole * rest;
      left.unit = left_is_plain ? right.unit : left.unit;
      return left;
    }
    if (right.amount == 0) return std::nullopt;
    if (sign == '%') {
      if (left.unit != right.unit) return std::nullopt;
      left.amount %= right.amount;
      return left;
    }
    if (right.unit == left.unit) {
      if (left.amount % right.amount != 0) return std::nullopt;
      left.amount = left.amount / right.amount * scale;
      left.unit = Unit::none;
      return left;
    }
    if (right.unit != Unit::none || right.amount % scale != 0) return std::nullopt;
    left.amount /= right.amount / scale;
    return left;
  }

  Result atom() {
    skip();
    if (++depth_ > deepest_expression || at_ >= text_.size()) return std::nullopt;
    Result value = plain_atom();
    --depth_;
    return value;
  }
  Result plain_atom() {
    const char c = text_[at_];
    if (take("(")) {
      Result inner = choice();
      return take(")") ? inner : std::nullopt;
    }
    if (c == '-' || c == '!') {
      ++at_;
      Result inner = atom();
      if (!inner || inner->kind != (c == '-' ? Value::Kind::number : Value::Kind::truth)) return std::nullopt;
      if (c == '-')
        inner->amount = -inner->amount;
      else
        inner->truth = !inner->truth;
      return inner;
    }
    if (c == '"') return text();
    if (is_digit(c) || c == '.') return number();
    if (!is_letter(c)) return std::nullopt;
    std::string name;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]) || text_[at_] == '.'))
      name += text_[at_++];
    if (name == "true" || name == "false") return truth(name == "true");
    if (take("(")) return call(name);
    for (const std::string_view prefix : {"this.", "parent."})
      if (name.starts_with(prefix)) name.erase(0, prefix.size());
    return lookup_ ? lookup_(name) : std::nullopt;
  }
  /// Functions of one value, of which the value counts.
  Result call(const std::string& name) {
    Result first = choice();
    while (take(",")) choice();
    if (!take(")")) return std::nullopt;
    if (name == "default" || name == "firstAvailableOrEmpty" || name == "firstAvailable" || name == "int" ||
        name == "double" || name == "replaceUnit" || name == "convertUnit")
      return first;
    if (name == "dropUnit" && first) first->unit = Unit::none;
    return name == "dropUnit" ? first : std::nullopt;
  }
  Result text() {
    Value value;
    value.kind = Value::Kind::text;
    for (++at_; at_ < text_.size() && text_[at_] != '"'; ++at_) {
      if (text_[at_] == '\\' && at_ + 1 < text_.size()) ++at_;
      value.text += text_[at_];
    }
    if (at_ >= text_.size()) return std::nullopt;
    ++at_;
    return value;
  }
  /// Digits with a fraction of at most 12, and a unit that follows, perhaps behind a blank.
  Result number() {
    Value value;
    sim::int128 digits = 0, fraction = scale;
    bool is_behind = false;
    for (; at_ < text_.size() && (is_digit(text_[at_]) ||
                                  (text_[at_] == '.' && !is_behind && at_ + 1 < text_.size() && text_[at_ + 1] != '.'));
         ++at_) {
      if (text_[at_] == '.') {
        is_behind = true;
        continue;
      }
      if (digits > greatest / 10) return std::nullopt;
      digits = digits * 10 + (text_[at_] - '0');
      if (is_behind) {
        if (fraction == 1) return std::nullopt;
        fraction /= 10;
      }
    }
    const std::size_t behind = at_;
    skip();
    std::string name;
    while (at_ < text_.size() && is_letter(text_[at_])) name += text_[at_++];
    const auto found = std::ranges::find(unit_names, name, &UnitName::name);
    if (name.empty() || found == std::end(unit_names)) {
      if (!name.empty() && behind == at_ - name.size()) return std::nullopt;  // "5ppm" and the like
      at_ = behind;
      if (digits > greatest / fraction) return std::nullopt;
      value.amount = digits * fraction;
      return value;
    }
    value.unit = found->unit;
    const sim::int128 factor = found->multiple != 0 ? found->multiple * scale : sim::int128{found->factor};
    // digits / (scale / fraction) * factor
    if (digits != 0 && factor > greatest * 1000 / digits) return std::nullopt;
    const sim::int128 product = digits * factor, divisor = scale / fraction;
    if (product % divisor != 0) return std::nullopt;
    value.amount = product / divisor;
    return value;
  }

  std::string_view text_;
  const Lookup& lookup_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

std::optional<std::int64_t> Value::whole() const {
  if (kind != Kind::number || unit != Unit::none || amount % scale != 0) return std::nullopt;
  return static_cast<std::int64_t>(amount / scale);
}

std::optional<Value> evaluate(std::string_view text, const Lookup& lookup) { return Evaluator(text, lookup).run(); }

}  // namespace takt::interchange::inet
