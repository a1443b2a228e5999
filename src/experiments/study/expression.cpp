// SPDX-License-Identifier: Apache-2.0
#include "study/expression.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "json/node.hpp"
#include "sim/check.hpp"
#include "study/magnitude.hpp"

namespace takt::study {

struct Expression::Step {
  enum class Kind : std::uint8_t { constant, name, negate, invert, binary };
  Kind kind = Kind::constant;
  Operand constant;
  std::size_t name = 0;
  std::size_t operation = 0;  // index into operations
};

namespace {

constexpr std::size_t longest_text = 4000;
constexpr int deepest = 64;

double truth(bool value) { return value ? 1 : 0; }
bool is_true(const Operand& operand) {
  return std::holds_alternative<double>(operand) && std::get<double>(operand) != 0;
}

struct Operation {
  std::string_view sign;
  int level;  // binds tighter the higher it is
  Operand (*apply)(const Operand& a, const Operand& b);
};

template <class Function>
Operand arithmetic(const Operand& a, const Operand& b, Function function) {
  if (!std::holds_alternative<double>(a) || !std::holds_alternative<double>(b)) return {};
  return function(std::get<double>(a), std::get<double>(b));
}

/// Compares two operands of one kind; what cannot be compared does not hold.
template <class Function>
Operand comparison(const Operand& a, const Operand& b, Function function) {
  if (a.index() != b.index() || std::holds_alternative<std::monostate>(a)) return 0.0;
  return truth(function(a, b));
}

// Longer signs stand before their beginnings.
constexpr std::array<Operation, 12> operations = {{
    {"||", 0, [](const Operand& a, const Operand& b) -> Operand { return truth(is_true(a) || is_true(b)); }},
    {"&&", 1, [](const Operand& a, const Operand& b) -> Operand { return truth(is_true(a) && is_true(b)); }},
    {"<=", 2,
     [](const Operand& a, const Operand& b) {
       return comparison(a, b, [](const Operand& x, const Operand& y) { return x <= y; });
     }},
    {">=", 2,
     [](const Operand& a, const Operand& b) {
       return comparison(a, b, [](const Operand& x, const Operand& y) { return x >= y; });
     }},
    {"==", 2,
     [](const Operand& a, const Operand& b) {
       return comparison(a, b, [](const Operand& x, const Operand& y) { return x == y; });
     }},
    {"!=", 2,
     [](const Operand& a, const Operand& b) {
       return comparison(a, b, [](const Operand& x, const Operand& y) { return x != y; });
     }},
    {"<", 2,
     [](const Operand& a, const Operand& b) {
       return comparison(a, b, [](const Operand& x, const Operand& y) { return x < y; });
     }},
    {">", 2,
     [](const Operand& a, const Operand& b) {
       return comparison(a, b, [](const Operand& x, const Operand& y) { return x > y; });
     }},
    {"+", 3,
     [](const Operand& a, const Operand& b) { return arithmetic(a, b, [](double x, double y) { return x + y; }); }},
    {"-", 3,
     [](const Operand& a, const Operand& b) { return arithmetic(a, b, [](double x, double y) { return x - y; }); }},
    {"*", 4,
     [](const Operand& a, const Operand& b) { return arithmetic(a, b, [](double x, double y) { return x * y; }); }},
    {"/", 4,
     [](const Operand& a, const Operand& b) { return arithmetic(a, b, [](double x, double y) { return x / y; }); }},
}};
constexpr int levels = 5;

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

namespace {

constexpr Between anything{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

Between possible_truth(bool may_be_false, bool may_be_true) { return {truth(!may_be_false), truth(may_be_true)}; }
bool may_be_true(const PossibleOperand& operand) {
  const Between* const number = std::get_if<Between>(&operand);
  return number != nullptr && (number->least != 0 || number->greatest != 0);
}
bool may_be_false(const PossibleOperand& operand) {
  const Between* const number = std::get_if<Between>(&operand);
  return number == nullptr || (number->least <= 0 && number->greatest >= 0);
}

/// Without a limit where one less the other is no number.
Between known(const Between& a) { return a.least != a.least || a.greatest != a.greatest ? anything : a; }

Between product_of(const Between& a, const Between& b) {
  const std::array<double, 4> ends = {a.least * b.least, a.least * b.greatest, a.greatest * b.least,
                                      a.greatest * b.greatest};
  if (std::any_of(ends.begin(), ends.end(), [](double end) { return end != end; }))
    return anything;  // nothing times no limit
  const auto [least, greatest] = std::minmax_element(ends.begin(), ends.end());
  return {*least, *greatest};
}

/// What two numbers of which one is not known exactly come to.
Between combined(std::string_view sign, const Between& a, const Between& b) {
  if (sign == "+") return known({a.least + b.least, a.greatest + b.greatest});
  if (sign == "-") return known({a.least - b.greatest, a.greatest - b.least});
  if (sign == "*") return product_of(a, b);
  if (sign == "/") return b.least <= 0 && b.greatest >= 0 ? anything : product_of(a, {1 / b.greatest, 1 / b.least});
  if (sign == "<=") return possible_truth(a.greatest > b.least, a.least <= b.greatest);
  if (sign == "<") return possible_truth(a.greatest >= b.least, a.least < b.greatest);
  if (sign == ">=") return possible_truth(a.least < b.greatest, a.greatest >= b.least);
  if (sign == ">") return possible_truth(a.least <= b.greatest, a.greatest > b.least);
  const bool may_be_equal = a.least <= b.greatest && b.least <= a.greatest;
  return sign == "==" ? possible_truth(true, may_be_equal) : possible_truth(may_be_equal, true);
}

Operand exact(const PossibleOperand& operand) {
  if (const Between* const number = std::get_if<Between>(&operand)) return number->least;
  if (const std::string* const text = std::get_if<std::string>(&operand)) return *text;
  return {};
}
PossibleOperand possible(const Operand& operand) {
  if (const double* const number = std::get_if<double>(&operand)) return Between{*number, *number};
  if (const std::string* const text = std::get_if<std::string>(&operand)) return *text;
  return {};
}

PossibleOperand applied(const Operation& operation, const PossibleOperand& a, const PossibleOperand& b) {
  if (operation.sign == "||")
    return possible_truth(may_be_false(a) && may_be_false(b), may_be_true(a) || may_be_true(b));
  if (operation.sign == "&&")
    return possible_truth(may_be_false(a) || may_be_false(b), may_be_true(a) && may_be_true(b));
  const Between* const left = std::get_if<Between>(&a);
  const Between* const right = std::get_if<Between>(&b);
  const bool are_exact = (left == nullptr || left->is_exact()) && (right == nullptr || right->is_exact());
  if (are_exact || left == nullptr || right == nullptr) return possible(operation.apply(exact(a), exact(b)));
  return combined(operation.sign, *left, *right);
}

}  // namespace

/// Recursive descent over the levels of the operations.
class ExpressionParser {
 public:
  explicit ExpressionParser(std::string_view text) : text_(text) {}

  std::optional<Expression> parse(std::string& problem) {
    if (text_.size() > longest_text) return problem = "it is too long", std::nullopt;
    binary(0);
    skip_space();
    if (problem_.empty() && at_ < text_.size()) fail("an operator");
    problem = problem_;
    if (!problem_.empty()) return std::nullopt;
    expression_.text_ = std::string(text_);
    expression_.steps_ = std::make_shared<const std::vector<Expression::Step>>(std::move(steps_));
    return std::move(expression_);
  }

 private:
  using Step = Expression::Step;

  void binary(int level) {
    if (level == levels) return unary();
    binary(level + 1);
    for (;;) {
      if (!problem_.empty()) return;
      skip_space();
      const auto found = std::find_if(operations.begin(), operations.end(),
                                      [&](const Operation& o) { return text_.substr(at_).starts_with(o.sign); });
      if (found == operations.end() || found->level != level) return;
      at_ += found->sign.size();
      binary(level + 1);
      push({Step::Kind::binary, {}, 0, static_cast<std::size_t>(found - operations.begin())});
    }
  }

  void unary() {
    skip_space();
    if (++depth_ > deepest) return fail("fewer brackets");
    const char c = at_ < text_.size() ? text_[at_] : '\0';
    if (c == '-' || c == '!') {
      ++at_;
      unary();
      push({c == '-' ? Step::Kind::negate : Step::Kind::invert, {}, 0, 0});
    } else if (c == '(') {
      ++at_;
      binary(0);
      skip_space();
      if (problem_.empty() && (at_ >= text_.size() || text_[at_++] != ')')) fail("a closing bracket");
    } else if (c == '\'') {
      const std::size_t end = text_.find('\'', at_ + 1);
      if (end == std::string_view::npos) return fail("a closing quote");
      push({Step::Kind::constant, std::string(text_.substr(at_ + 1, end - at_ - 1)), 0, 0});
      at_ = end + 1;
    } else if (is_digit(c)) {
      quantity();
    } else if (is_letter(c)) {
      name();
    } else {
      fail("a number, a name or a text in single quotes");
    }
    --depth_;
  }

  void quantity() {
    std::size_t end = at_;
    while (end < text_.size()) {
      const char c = text_[end];
      const bool is_exponent =
          (c == '-' || c == '+') && (text_[end - 1] == 'e' || text_[end - 1] == 'E') && is_digit(text_[at_]);
      const bool is_slash_of_unit = text_.substr(end).starts_with("/s") && is_letter(text_[end - 1]);
      if (!is_digit(c) && !is_letter(c) && c != '.' && c != '%' && !is_exponent && !is_slash_of_unit) break;
      ++end;
    }
    const auto magnitude = magnitude_of(text_.substr(at_, end - at_));
    if (!magnitude) return fail("a number or a quantity such as 200us");
    push({Step::Kind::constant, magnitude->number, 0, 0});
    at_ = end;
  }

  void name() {
    std::size_t end = at_;
    while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]) || text_[end] == '.')) ++end;
    std::string word(text_.substr(at_, end - at_));
    auto& names = expression_.names_;
    auto found = std::find(names.begin(), names.end(), word);
    if (found == names.end()) found = names.insert(names.end(), std::move(word));
    push({Step::Kind::name, {}, static_cast<std::size_t>(found - names.begin()), 0});
    at_ = end;
  }

  void push(Step step) {
    if (problem_.empty()) steps_.push_back(std::move(step));
  }
  void skip_space() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }
  void fail(std::string_view expected) {
    if (!problem_.empty()) return;
    problem_ = at_ < text_.size() ? "found " + json::quote(text_.substr(at_)) : std::string("it ends too early");
    problem_ += ", expected " + std::string(expected);
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int depth_ = 0;
  std::string problem_;
  std::vector<Step> steps_;
  Expression expression_;
};

std::optional<Expression> Expression::parse(std::string_view text, std::string& problem) {
  return ExpressionParser(text).parse(problem);
}

bool Expression::holds(const std::function<Operand(const std::string&)>& value_of) const {
  std::vector<Operand> stack;
  const auto top = [&]() -> Operand& { return stack.back(); };
  for (const Step& step : *steps_) {
    switch (step.kind) {
      case Step::Kind::constant:
        stack.push_back(step.constant);
        break;
      case Step::Kind::name:
        stack.push_back(value_of(names_[step.name]));
        break;
      case Step::Kind::negate:
        top() = std::holds_alternative<double>(top()) ? Operand(-std::get<double>(top())) : Operand();
        break;
      case Step::Kind::invert:
        top() = truth(!is_true(top()));
        break;
      case Step::Kind::binary: {
        const Operand right = std::move(top());
        stack.pop_back();
        top() = operations[step.operation].apply(top(), right);
        break;
      }
    }
  }
  TAKT_CHECK(stack.size() == 1, "an expression leaves one value");
  return is_true(top());
}

Truth Expression::decide(const std::function<PossibleOperand(const std::string&)>& value_of) const {
  std::vector<PossibleOperand> stack;
  const auto top = [&]() -> PossibleOperand& { return stack.back(); };
  for (const Step& step : *steps_) {
    switch (step.kind) {
      case Step::Kind::constant:
        stack.push_back(possible(step.constant));
        break;
      case Step::Kind::name:
        stack.push_back(value_of(names_[step.name]));
        break;
      case Step::Kind::negate: {
        const Between* const number = std::get_if<Between>(&top());
        top() = number != nullptr ? PossibleOperand(Between{-number->greatest, -number->least}) : PossibleOperand();
        break;
      }
      case Step::Kind::invert:
        top() = possible_truth(may_be_true(top()), may_be_false(top()));
        break;
      case Step::Kind::binary: {
        const PossibleOperand right = std::move(top());
        stack.pop_back();
        top() = applied(operations[step.operation], top(), right);
        break;
      }
    }
  }
  TAKT_CHECK(stack.size() == 1, "an expression leaves one value");
  return !may_be_false(top()) ? Truth::yes : may_be_true(top()) ? Truth::unknown : Truth::no;
}

}  // namespace takt::study
