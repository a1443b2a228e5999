// SPDX-License-Identifier: Apache-2.0
#include "json/printable.hpp"

#include <gtest/gtest.h>

namespace takt::json::test::printable_test {
namespace {

TEST(Printable, ShowsWhatATerminalWouldActOn) {
  EXPECT_EQ(printable("a\x1b[8mb"), "a\\u001b[8mb");
  EXPECT_EQ(printable("cam\ntouch x #"), "cam\\u000atouch x #");
  EXPECT_EQ(printable("a\x7f\xc2\x9b"
                      "31m"),
            "a\\u007f\\u009b31m");  // DEL, and CSI as one character
  EXPECT_EQ(printable("pass\xe2\x80\xae"
                      "liaf"),
            "pass\\u202eliaf");             // from right to left
  EXPECT_EQ(printable("a\xff"), "a\\xff");  // no UTF-8
  EXPECT_EQ(printable("F\xc3\xb6rderband"), "F\xc3\xb6rderband");
}

TEST(Printable, APageKeepsItsLines) { EXPECT_EQ(printable_page("a\n\tb\r\x1b"), "a\n\tb\\u000d\\u001b"); }

TEST(Printable, FindsTheFirst) {
  EXPECT_EQ(find_control("abc"), std::string_view::npos);
  EXPECT_EQ(find_control("\xc3\xb6\n"), 2U);
  EXPECT_EQ(find_control("a\xff"), 1U);
}

TEST(CsvField, IsQuotedWhereItMustBe) {
  EXPECT_EQ(csv_field("a"), "a");
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("say \"x\"\n"), "\"say \"\"x\"\"\n\"");
}

TEST(FileName, IsOneNameInAFolder) {
  EXPECT_EQ(file_name("robot-arm.svg"), "robot-arm.svg");
  EXPECT_EQ(file_name("../../outside.svg"), "%2E.%2F..%2Foutside.svg");
  EXPECT_EQ(file_name("line 3/robot"), "line 3%2Frobot");
  EXPECT_NE(file_name("a%2Fb"), file_name("a/b"));
  EXPECT_EQ(file_name("-rf"), "%2Drf");
}

TEST(ShellWord, IsOneWord) {
  EXPECT_EQ(shell_word("swp0.100"), "swp0.100");
  EXPECT_EQ(shell_word("a b"), "'a b'");
  EXPECT_EQ(shell_word("it's $(x)"), "'it'\\''s $(x)'");
  EXPECT_EQ(shell_word(""), "''");
}

}  // namespace
}  // namespace takt::json::test::printable_test
