// SPDX-License-Identifier: Apache-2.0
// Conditions between factors or measures: "slaves <= 4 * hops && topology != 'ring'", "start <= 1ms".
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace takt::study {

/// A number (quantities in their base unit: "1ms" is 0.001), a text, or nothing (a measure that a run does not have).
using Operand = std::variant<std::monostate, double, std::string>;

/// A number of which only its limits are known; both are the number itself where it is known.
struct Between {
  double least = 0;
  double greatest = 0;
  bool is_exact() const { return !(least < greatest); }  // nor is what is no number any other
};
using PossibleOperand = std::variant<std::monostate, Between, std::string>;

enum class Truth : std::uint8_t { no, unknown, yes };

/// Numbers, quantities, names and 'texts' with + - * / ( ) < <= > >= == != ! && ||. Truth is 1 or 0.
class Expression {
 public:
  /// Reads one; `problem` says what is wrong if there is none.
  static std::optional<Expression> parse(std::string_view text, std::string& problem);

  /// The names in it, in the order of their first occurrence.
  const std::vector<std::string>& names() const { return names_; }
  const std::string& text() const { return text_; }

  /// Whether it holds. A comparison with nothing, or of a number with a text, does not hold.
  bool holds(const std::function<Operand(const std::string&)>& value_of) const;
  /// Whether it holds for all values that are possible, for none, or perhaps for some. Where all are exact, as holds()
  /// says.
  Truth decide(const std::function<PossibleOperand(const std::string&)>& value_of) const;

 private:
  friend class ExpressionParser;
  struct Step;  // of a stack machine: the expression in postfix order
  std::string text_;
  std::vector<std::string> names_;
  std::shared_ptr<const std::vector<Step>> steps_;
};

}  // namespace takt::study
