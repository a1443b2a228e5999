// SPDX-License-Identifier: Apache-2.0
#include "study/expression.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace takt::study {
namespace {

Operand value_of(const std::string& name) {
  if (name == "slaves") return 3.0;
  if (name == "hops") return 4.0;
  if (name == "cycle") return 0.0002;
  if (name == "topology") return std::string("ring");
  return {};
}

bool holds(const std::string& text) {
  std::string problem;
  const auto expression = Expression::parse(text, problem);
  EXPECT_TRUE(expression) << text << ": " << problem;
  return expression && expression->holds(value_of);
}

std::string problem_of(const std::string& text) {
  std::string problem;
  EXPECT_FALSE(Expression::parse(text, problem)) << text;
  return problem;
}

TEST(Expression, BindsAsArithmeticDoes) {
  EXPECT_TRUE(holds("1 + 2 * 3 == 7"));
  EXPECT_TRUE(holds("(1 + 2) * 3 == 9"));
  EXPECT_TRUE(holds("10 - 2 - 3 == 5")) << "from left to right";
  EXPECT_TRUE(holds("-2 + 3 == 1"));
  EXPECT_TRUE(holds("8 / 4 / 2 == 1"));
  EXPECT_TRUE(holds("1 < 2 && 2 < 1 || 3 == 3")) << "&& before ||";
  EXPECT_FALSE(holds("1 < 2 && (2 < 1 || 3 != 3)"));
  EXPECT_TRUE(holds("!(1 > 2)"));
}

TEST(Expression, KnowsNamesTextsAndQuantities) {
  EXPECT_TRUE(holds("slaves <= 4 * hops"));
  EXPECT_TRUE(holds("cycle == 200us"));
  EXPECT_TRUE(holds("cycle * 5 <= 1ms"));
  EXPECT_TRUE(holds("topology == 'ring'"));
  EXPECT_FALSE(holds("topology != 'ring'"));
  EXPECT_TRUE(holds("1e-3 == 1ms"));
}

TEST(Expression, NothingComparesWithNothing) {
  EXPECT_FALSE(holds("missing <= 5"));
  EXPECT_FALSE(holds("missing > 5"));
  EXPECT_FALSE(holds("missing == missing"));
  EXPECT_FALSE(holds("topology <= 5"));
}

// halt: at least 2 by a run, at most 5 by a bound; late: at least 2, without a bound.
PossibleOperand possible_value_of(const std::string& name) {
  if (name == "halt") return Between{2, 5};
  if (name == "late") return Between{2, std::numeric_limits<double>::infinity()};
  if (name == "lost") return Between{0, 0};
  if (name == "topology") return std::string("ring");
  return {};
}

Truth decided(const std::string& text) {
  std::string problem;
  const auto expression = Expression::parse(text, problem);
  EXPECT_TRUE(expression) << text << ": " << problem;
  return expression ? expression->decide(possible_value_of) : Truth::no;
}

TEST(Expression, DecidesWhereValuesAreKnownByTheirLimits) {
  EXPECT_EQ(decided("halt <= 5"), Truth::yes) << "the bound keeps it";
  EXPECT_EQ(decided("halt <= 4"), Truth::unknown) << "the bound exceeds it, the worst that was found does not";
  EXPECT_EQ(decided("halt < 2"), Truth::no) << "a run breaks it";
  EXPECT_EQ(decided("late <= 1000"), Truth::unknown);
  EXPECT_EQ(decided("late <= 1"), Truth::no);
  EXPECT_EQ(decided("late >= 2"), Truth::yes);
  // A condition that holds at neither end may hold between them.
  EXPECT_EQ(decided("halt >= 3 && halt <= 4"), Truth::unknown);
  EXPECT_EQ(decided("halt == 3"), Truth::unknown);
  EXPECT_EQ(decided("halt != 6"), Truth::yes);
  EXPECT_EQ(decided("!(halt > 5)"), Truth::yes);
  EXPECT_EQ(decided("halt <= 4 && lost == 1"), Truth::no);
  EXPECT_EQ(decided("halt <= 4 || lost == 0"), Truth::yes);
  EXPECT_EQ(decided("10 - halt >= 5"), Truth::yes);
  EXPECT_EQ(decided("-halt < -1"), Truth::yes);
  EXPECT_EQ(decided("halt * -2 >= -10"), Truth::yes);
  EXPECT_EQ(decided("12 / halt <= 6"), Truth::yes);
  EXPECT_EQ(decided("1 / (halt - 3) < 100"), Truth::unknown) << "a divisor that may be 0";
  EXPECT_EQ(decided("late * lost <= 1"), Truth::unknown) << "nothing times no limit";
}

// Where all is exact it says what holds() says.
TEST(Expression, DecidesExactValuesAsTheyHold) {
  const auto exactly = [](const std::string& name) -> PossibleOperand {
    const Operand operand = value_of(name);
    if (const double* const number = std::get_if<double>(&operand)) return Between{*number, *number};
    if (const std::string* const text = std::get_if<std::string>(&operand)) return *text;
    return {};
  };
  for (const char* const text : {"slaves <= 4 * hops", "slaves > hops", "slaves / 0 > 1", "(slaves - 3) / 0 > 1",
                                 "!((slaves - 3) / 0 > 1)", "missing <= 5", "!(missing <= 5)", "topology == 'ring'",
                                 "topology <= 5", "-topology < 1", "cycle * 5 == 1ms", "slaves && !hops"}) {
    std::string problem;
    const auto expression = Expression::parse(text, problem);
    ASSERT_TRUE(expression) << problem;
    EXPECT_EQ(expression->decide(exactly), expression->holds(value_of) ? Truth::yes : Truth::no) << text;
  }
}

TEST(Expression, TellsWhatIsWrong) {
  EXPECT_NE(problem_of("slaves <=").find("ends too early"), std::string::npos);
  EXPECT_NE(problem_of("slaves 3").find("expected an operator"), std::string::npos);
  EXPECT_NE(problem_of("(1 + 2").find("closing bracket"), std::string::npos);
  EXPECT_NE(problem_of("1 + 3zz").find("quantity"), std::string::npos);
  EXPECT_NE(problem_of("'a").find("closing quote"), std::string::npos);
  EXPECT_NE(problem_of(std::string(200, '(')).find("fewer brackets"), std::string::npos);
  EXPECT_NE(problem_of(std::string(5000, '1')).find("too long"), std::string::npos);
}

TEST(Expression, NamesAreListedOnce) {
  std::string problem;
  EXPECT_EQ(Expression::parse("b + a * b < reaction.start.max", problem)->names(),
            (std::vector<std::string>{"b", "a", "reaction.start.max"}));
}

}  // namespace
}  // namespace takt::study
