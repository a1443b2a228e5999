// SPDX-License-Identifier: Apache-2.0
// Which samples a reader wants, as an expression over their fields (OMG DDS 1.4, 2.2.2.3.3 and Annex B: the filter
// class "DDSSQL").
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/idl_type.hpp"
#include "uadp/octets.hpp"

namespace takt::gateway {

/// Where an expression is wrong: `at` octets from its beginning `found` stands instead of `expected`.
struct FilterMistake {
  std::size_t at = 0;
  std::string found;
  std::string expected;
};

/// Comparisons of fields with numbers or fields (=, <>, <, <=, >, >=), BETWEEN and NOT BETWEEN, joined by NOT, AND and
/// OR, of which each binds less than the one before, and by parentheses. Words are written in any case. An element of
/// an array is `name[index]`, from 0 on; TRUE and FALSE are 1 and 0. Two integers are compared as integers, whatever
/// their signs, all else as floating-point numbers.
class ContentFilter {
 public:
  /// Precondition: the struct has numbers and arrays of numbers only. Not in it: LIKE, as there are no strings, and
  /// parameters (%0), whose values stand in the expression themselves.
  static std::optional<ContentFilter> parse(std::string_view expression, const IdlStruct& type, FilterMistake& mistake);

  /// Of a serialized payload with its encapsulation header, CDR of either byte order. What is none of the struct does
  /// not pass.
  bool passes(uadp::Octets payload) const;

  /// As it was written.
  const std::string& expression() const { return expression_; }
  bool operator==(const ContentFilter& other) const { return expression_ == other.expression_; }

 private:
  friend class FilterParser;

  /// A number, or a field behind the encapsulation header.
  struct Operand {
    bool is_field = false;
    IdlKind kind = IdlKind::float64;
    std::size_t at = 0;
    bool is_integer = false;  ///< of a number
    std::int64_t integer = 0;
    double real = 0;
  };
  enum class Code : std::uint8_t {
    equal,
    differs,
    less,
    less_or_equal,
    greater,
    greater_or_equal,
    negation,
    conjunction,
    disjunction
  };
  /// In postfix order: comparisons put their answer on a stack, the others take theirs from it.
  struct Step {
    Code code = Code::equal;
    Operand left = {};
    Operand right = {};
  };
  struct Value {
    bool is_integer = false;
    bool is_negative = false;
    std::uint64_t magnitude = 0;
    double real = 0;
  };

  static Value value_of(const Operand& operand, uadp::Octets body, bool is_little);
  static bool holds(const Step& comparison, uadp::Octets body, bool is_little);

  std::string expression_;
  std::vector<Step> steps_;
  std::size_t octets_ = 0;  ///< of the struct, behind the header
};

}  // namespace takt::gateway
