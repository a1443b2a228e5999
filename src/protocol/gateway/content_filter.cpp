// SPDX-License-Identifier: Apache-2.0
#include "gateway/content_filter.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <map>

#include "sim/check.hpp"

namespace takt::gateway {
namespace {

constexpr std::size_t before_fields = 4;
constexpr std::size_t deepest = 32;  // nesting: the answers of one sample fit on the stack of passes()
constexpr std::size_t most_steps = 1000;

bool is_word(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || (c >= '0' && c <= '9'); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string upper(std::string_view text) {
  std::string made(text);
  for (char& c : made)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return made;
}

bool is_signed(IdlKind kind) {
  return kind == IdlKind::int8 || kind == IdlKind::int16 || kind == IdlKind::int32 || kind == IdlKind::int64;
}

struct Field {
  IdlKind kind = IdlKind::float64;
  std::size_t at = 0;
  std::uint32_t count = 0;  ///< elements of an array; 0: none
};

}  // namespace

/// Recursive descent, a function for each of NOT, AND and OR.
class FilterParser {
 public:
  FilterParser(std::string_view text, const IdlStruct& type, FilterMistake& mistake) : text_(text), mistake_(mistake) {
    for (const IdlMember& member : type.members) {
      const std::size_t size = info(member.kind).octets;
      TAKT_CHECK(size != 0 && member.collection != IdlCollection::sequence,
                 "members of a struct that is filtered have places that do not change");
      octets_ = (octets_ + info(member.kind).alignment - 1) / info(member.kind).alignment * info(member.kind).alignment;
      const bool is_array = member.collection == IdlCollection::array;
      if (size <= 8) fields_.emplace(member.name, Field{member.kind, octets_, is_array ? member.length : 0});
      octets_ += size * (is_array ? member.length : 1);
    }
  }

  std::optional<ContentFilter> parse() {
    next();
    if (!disjunction(0)) return std::nullopt;
    if (!token_.empty()) {
      fail("AND, OR or the end");
      return std::nullopt;
    }
    ContentFilter made;
    made.expression_ = text_;
    made.steps_ = std::move(steps_);
    made.octets_ = octets_;
    return made;
  }

 private:
  using Code = ContentFilter::Code;
  using Operand = ContentFilter::Operand;

  bool fail(std::string expected) {
    mistake_ = {begin_, token_.empty() ? "the end" : std::string(token_), std::move(expected)};
    return false;
  }

  /// The next word, number or sign; empty at the end.
  void next() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r'))
      ++at_;
    begin_ = at_;
    if (at_ == text_.size()) {
      token_ = {};
      return;
    }
    const char c = text_[at_];
    const auto ahead = [&](std::size_t n) { return at_ + n < text_.size() ? text_[at_ + n] : '\0'; };
    if (is_digit(c) || ((c == '-' || c == '+' || c == '.') && (is_digit(ahead(1)) || ahead(1) == '.'))) {
      ++at_;
      while (at_ < text_.size() &&
             (is_word(text_[at_]) || text_[at_] == '.' ||
              ((text_[at_] == '-' || text_[at_] == '+') && (text_[at_ - 1] == 'e' || text_[at_ - 1] == 'E'))))
        ++at_;
    } else if (is_word(c)) {
      while (at_ < text_.size() && is_word(text_[at_])) ++at_;
    } else {
      const bool is_double = (c == '<' && (ahead(1) == '=' || ahead(1) == '>')) || (c == '>' && ahead(1) == '=');
      at_ += is_double ? 2 : 1;
    }
    token_ = text_.substr(begin_, at_ - begin_);
  }
  bool is(std::string_view word) const { return upper(token_) == word; }
  bool take(std::string_view word) {
    if (!is(word)) return false;
    next();
    return true;
  }

  bool push(const ContentFilter::Step& step) {
    if (steps_.size() == most_steps)
      return fail("at most " + std::to_string(most_steps) + " comparisons and words that join them");
    steps_.push_back(step);
    return true;
  }

  bool disjunction(std::size_t depth) {
    if (!conjunction(depth)) return false;
    while (take("OR"))
      if (!conjunction(depth) || !push({Code::disjunction})) return false;
    return true;
  }
  bool conjunction(std::size_t depth) {
    if (!negation(depth)) return false;
    while (take("AND"))
      if (!negation(depth) || !push({Code::conjunction})) return false;
    return true;
  }
  bool negation(std::size_t depth) {
    if (depth == deepest) return fail("at most " + std::to_string(deepest) + " parentheses and NOTs in one another");
    if (take("NOT")) return negation(depth + 1) && push({Code::negation});
    if (!take("(")) return comparison();
    if (!disjunction(depth + 1)) return false;
    return take(")") || fail("AND, OR or )");
  }

  bool comparison() {
    const std::optional<Operand> left = operand("a field, a number, NOT or (");
    if (!left) return false;
    const bool is_negated = take("NOT");
    if (take("BETWEEN")) return range(*left, is_negated);
    if (is_negated) return fail("BETWEEN");
    static const std::map<std::string_view, Code> signs{{"=", Code::equal},   {"<>", Code::differs},
                                                        {"<", Code::less},    {"<=", Code::less_or_equal},
                                                        {">", Code::greater}, {">=", Code::greater_or_equal}};
    const auto sign = signs.find(token_);
    if (sign == signs.end()) return fail("=, <>, <, <=, >, >= or BETWEEN");
    next();
    const std::size_t before = begin_;
    const std::optional<Operand> right = operand("a field or a number");
    if (!right) return false;
    if (!left->is_field && !right->is_field) {
      mistake_ = {before, "two numbers", "a field on one side"};
      return false;
    }
    return push({sign->second, *left, *right});
  }

  bool range(const Operand& field, bool is_negated) {
    if (!field.is_field) return fail("a field before BETWEEN");
    const std::optional<Operand> from = operand("a number");
    if (!from) return false;
    if (!take("AND")) return fail("AND");
    const std::optional<Operand> to = operand("a number");
    if (!to) return false;
    if (from->is_field || to->is_field) return fail("numbers as the ends of a range");
    return push({Code::greater_or_equal, field, *from}) && push({Code::less_or_equal, field, *to}) &&
           push({Code::conjunction}) && (!is_negated || push({Code::negation}));
  }

  std::optional<Operand> operand(const char* expected) {
    Operand made;
    if (is("TRUE") || is("FALSE")) {
      made.is_integer = true;
      made.integer = is("TRUE") ? 1 : 0;
      next();
      return made;
    }
    if (!token_.empty() && (is_digit(token_[0]) || token_[0] == '-' || token_[0] == '+' || token_[0] == '.'))
      return number();
    const auto found = fields_.find(token_);
    if (found == fields_.end()) {
      std::string names;
      for (const auto& [name, field] : fields_) names += (names.empty() ? "" : ", ") + name;
      const bool is_name =
          !token_.empty() && is_word(token_[0]) && !is("NOT") && !is("AND") && !is("OR") && !is("BETWEEN");
      fail(is_name ? "one of the fields " + names : expected);
      return std::nullopt;
    }
    next();
    made.is_field = true;
    made.kind = found->second.kind;
    made.at = found->second.at;
    if (found->second.count == 0) return made;
    std::uint64_t index = 0;
    if (!take("[")) {
      fail("[ and an index, for " + found->first + " is an array");
      return std::nullopt;
    }
    const auto [end, error] = std::from_chars(token_.data(), token_.data() + token_.size(), index);
    if (token_.empty() || error != std::errc() || end != token_.data() + token_.size() ||
        index >= found->second.count) {
      fail("an index from 0 to " + std::to_string(found->second.count - 1));
      return std::nullopt;
    }
    next();
    if (!take("]")) {
      fail("]");
      return std::nullopt;
    }
    made.at += index * info(made.kind).octets;
    return made;
  }

  std::optional<Operand> number() {
    Operand made;
    std::string_view digits = token_;
    if (digits[0] == '+') digits.remove_prefix(1);
    const char* const end = digits.data() + digits.size();
    const auto [whole, error] = std::from_chars(digits.data(), end, made.integer);
    made.is_integer = error == std::errc() && whole == end;
    if (!made.is_integer) {
      const auto [part, problem] = std::from_chars(digits.data(), end, made.real);
      if (problem != std::errc() || part != end) {
        fail("a number");
        return std::nullopt;
      }
    }
    next();
    return made;
  }

  std::string_view text_;
  FilterMistake& mistake_;
  std::map<std::string, Field, std::less<>> fields_;
  std::size_t octets_ = 0;
  std::size_t at_ = 0;
  std::size_t begin_ = 0;
  std::string_view token_;
  std::vector<ContentFilter::Step> steps_;
};

std::optional<ContentFilter> ContentFilter::parse(std::string_view expression, const IdlStruct& type,
                                                  FilterMistake& mistake) {
  return FilterParser(expression, type, mistake).parse();
}

ContentFilter::Value ContentFilter::value_of(const Operand& operand, uadp::Octets body, bool is_little) {
  const auto of_integer = [](std::int64_t integer) {
    const bool is_negative = integer < 0;
    return Value{true, is_negative,
                 is_negative ? 0 - static_cast<std::uint64_t>(integer) : static_cast<std::uint64_t>(integer),
                 static_cast<double>(integer)};
  };
  if (!operand.is_field) return operand.is_integer ? of_integer(operand.integer) : Value{false, false, 0, operand.real};
  const std::size_t size = info(operand.kind).octets;
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < size; ++i)
    bits = bits << 8 | std::to_integer<std::uint64_t>(body[operand.at + (is_little ? size - 1 - i : i)]);
  if (operand.kind == IdlKind::float64) return {false, false, 0, std::bit_cast<double>(bits)};
  if (operand.kind == IdlKind::float32)
    return {false, false, 0, std::bit_cast<float>(static_cast<std::uint32_t>(bits))};
  if (!is_signed(operand.kind)) return {true, false, bits, static_cast<double>(bits)};
  const std::size_t unused = 64 - 8 * size;
  return of_integer(static_cast<std::int64_t>(bits << unused) >> unused);
}

bool ContentFilter::holds(const Step& comparison, uadp::Octets body, bool is_little) {
  const Value left = value_of(comparison.left, body, is_little), right = value_of(comparison.right, body, is_little);
  bool is_less = left.real<right.real, is_equal = left.real == right.real, is_greater = left.real> right.real;
  if (left.is_integer && right.is_integer) {
    is_equal = left.magnitude == right.magnitude && left.is_negative == right.is_negative;
    is_less = left.is_negative != right.is_negative ? left.is_negative
              : left.is_negative                    ? left.magnitude > right.magnitude
                                                    : left.magnitude < right.magnitude;
    is_greater = !is_less && !is_equal;
  }
  switch (comparison.code) {
    case Code::equal:
      return is_equal;
    case Code::differs:
      return !is_equal;
    case Code::less:
      return is_less;
    case Code::less_or_equal:
      return is_less || is_equal;
    case Code::greater:
      return is_greater;
    case Code::greater_or_equal:
      return is_greater || is_equal;
    default:
      break;
  }
  TAKT_CHECK(false, "a comparison");
  return false;
}

bool ContentFilter::passes(uadp::Octets payload) const {
  if (payload.size() < before_fields + octets_ || payload[0] != std::byte{0} || payload[1] > std::byte{1}) return false;
  const bool is_little = payload[1] == std::byte{1};
  const uadp::Octets body = payload.subspan(before_fields);
  // An AND or OR waits for its second answer at each depth: no more answers are open at once.
  std::array<bool, 3 * deepest + 3> answers{};
  std::size_t count = 0;
  for (const Step& step : steps_) {
    switch (step.code) {
      case Code::negation:
        answers[count - 1] = !answers[count - 1];
        break;
      case Code::conjunction:
        --count;
        answers[count - 1] = answers[count - 1] && answers[count];
        break;
      case Code::disjunction:
        --count;
        answers[count - 1] = answers[count - 1] || answers[count];
        break;
      default:
        answers[count++] = holds(step, body, is_little);
    }
  }
  return answers[0];
}

}  // namespace takt::gateway
