#include "study/expression.hpp"

#include <gtest/gtest.h>

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
  EXPECT_EQ(Expression::parse("b + a * b < reaction.start.max", problem)->names(), (std::vector<std::string>{"b", "a", "reaction.start.max"}));
}

}  // namespace
}  // namespace takt::study
