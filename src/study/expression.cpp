#include "study/expression.hpp"

#include <algorithm>
#include <array>

#include "json/node.hpp"
#include "sim/check.hpp"
#include "study/magnitude.hpp"

namespace takt::study {

struct Expression::Step {
  enum class Kind : std::uint8_t { constant, name, negate, invert, binary };
  Kind kind = Kind::constant;
  Operand constant;
  std::size_t name = 0;
  std::size_t operation = 0;   // index into operations
};

namespace {

constexpr std::size_t longest_text = 4000;
constexpr int deepest = 64;

double truth(bool value) { return value ? 1 : 0; }
bool is_true(const Operand& operand) { return std::holds_alternative<double>(operand) && std::get<double>(operand) != 0; }

struct Operation {
  std::string_view sign;
  int level;   // binds tighter the higher it is
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
    {"<=", 2, [](const Operand& a, const Operand& b) { return comparison(a, b, [](const Operand& x, const Operand& y) { return x <= y; }); }},
    {">=", 2, [](const Operand& a, const Operand& b) { return comparison(a, b, [](const Operand& x, const Operand& y) { return x >= y; }); }},
    {"==", 2, [](const Operand& a, const Operand& b) { return comparison(a, b, [](const Operand& x, const Operand& y) { return x == y; }); }},
    {"!=", 2, [](const Operand& a, const Operand& b) { return comparison(a, b, [](const Operand& x, const Operand& y) { return x != y; }); }},
    {"<", 2, [](const Operand& a, const Operand& b) { return comparison(a, b, [](const Operand& x, const Operand& y) { return x < y; }); }},
    {">", 2, [](const Operand& a, const Operand& b) { return comparison(a, b, [](const Operand& x, const Operand& y) { return x > y; }); }},
    {"+", 3, [](const Operand& a, const Operand& b) { return arithmetic(a, b, [](double x, double y) { return x + y; }); }},
    {"-", 3, [](const Operand& a, const Operand& b) { return arithmetic(a, b, [](double x, double y) { return x - y; }); }},
    {"*", 4, [](const Operand& a, const Operand& b) { return arithmetic(a, b, [](double x, double y) { return x * y; }); }},
    {"/", 4, [](const Operand& a, const Operand& b) { return arithmetic(a, b, [](double x, double y) { return x / y; }); }},
}};
constexpr int levels = 5;

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

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
      const auto found = std::find_if(operations.begin(), operations.end(), [&](const Operation& o) { return text_.substr(at_).starts_with(o.sign); });
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
      const bool is_exponent = (c == '-' || c == '+') && (text_[end - 1] == 'e' || text_[end - 1] == 'E') && is_digit(text_[at_]);
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

std::optional<Expression> Expression::parse(std::string_view text, std::string& problem) { return ExpressionParser(text).parse(problem); }

bool Expression::holds(const std::function<Operand(const std::string&)>& value_of) const {
  std::vector<Operand> stack;
  const auto top = [&]() -> Operand& { return stack.back(); };
  for (const Step& step : *steps_) {
    switch (step.kind) {
      case Step::Kind::constant: stack.push_back(step.constant); break;
      case Step::Kind::name: stack.push_back(value_of(names_[step.name])); break;
      case Step::Kind::negate: top() = std::holds_alternative<double>(top()) ? Operand(-std::get<double>(top())) : Operand(); break;
      case Step::Kind::invert: top() = truth(!is_true(top())); break;
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

}  // namespace takt::study
