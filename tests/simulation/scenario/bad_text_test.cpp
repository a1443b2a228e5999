// SPDX-License-Identifier: Apache-2.0
// The text itself, and values of the wrong kind.
#include "bad_input.hpp"

namespace takt::scenario::test::bad_text_test {
namespace {

const BadCase text_cases[] = {
    {"EmptyFile", R"()", R"(1:1: error: the text is empty: found the end of the text, expected a JSON value)"},
    {"OnlyAComment", R"(// nothing
)",
     R"(2:1: error: the text is empty: found the end of the text, expected a JSON value)"},
    {"MissingComma", R"({"name": "t"
 "duration": "1ms"})",
     R"(2:2: error: a missing comma: found the string "duration", expected "," or "}")"},
    {"CutShort", R"({"name": "t",
 "network": {)",
     R"(2:14: error: the text ends too early: found the end of the text, expected a name in double quotes or "}")"},
    {"TextBehindIt", R"({} {})", R"(1:4: error: text after the JSON value: found "{", expected the end of the text)"},
    {"NotAnObject", R"([1, 2])", R"(1:1: error: wrong type: found an array of 2, expected an object)"},
    {"NothingThatMustBeThere", R"({})",
     R"(1:1: error: the field "name" is missing
1:1: error: the field "duration" is missing
1:1: error: the field "network" is missing)"},
    {"NotANumber", with_duration(R"(NaN)"), R"(2:13: error: not a JSON number: found NaN, expected a finite number)"},
    {"KeyTwice", scenario_with(R"("seed": 1, "seed": 2)"),
     R"(2:12: error at /seed: the name "seed" occurs twice: expected one value (the first is in line 2, column 1))"},
    {"UnknownKey", scenario_with(R"("sede": 1)"),
     R"(2:1: error at /sede: unknown field "sede" (did you mean "seed"?))"},
    {"ControlCharacterInAName",
     R"({"name": "pass\u001b[8m", "duration": "1ms", "network": {"nodes": {"a": {"kind": "switch"}}}})",
     R"(1:10: error at /name: a control character in a name: found the string "pass\u001b[8m", expected characters that are seen: names stand in scripts, tables and terminals)"},
    {"LineFeedInAName",
     scenario_with(
         R"("streams": [{"name": "cam\ntouch pwned #", "from": "a", "to": "b", "payload": "1B", "every": "1ms"}])"),
     R"(2:22: error at /streams/0/name: a control character in a name: found the string "cam\ntouch pwned #", expected characters that are seen: names stand in scripts, tables and terminals)"},
    {"ControlCharacterInANode",
     R"({"name": "t", "duration": "1ms", "network": {"nodes": {"a\u009b": {"kind": "switch"}}}})",
     R"(1:56: error at /network/nodes/a\u009b: a control character in a name: found "a\u009b", expected characters that are seen: names stand in scripts, tables and terminals)"},
    {"EscapeInADescription", scenario_with(R"("description": "two\nlines \u001b")"),
     R"(2:16: error at /description: a control character: found the string "two\nlines \u001b", expected a text of characters that are seen, line feeds and tabs)"},
    {"NumberForAText", scenario_with(R"("description": 5)"),
     R"(2:16: error at /description: wrong type: found the number 5, expected a string)"},
    {"TextForANumber", scenario_with(R"("seed": "five")"),
     R"(2:9: error at /seed: wrong type: found the string "five", expected an integer from 0 to 18446744073709551615)"},
    {"ArrayForAnObject", R"({"name": "t", "duration": "1ms", "network": []})",
     R"(1:45: error at /network: wrong type: found an empty array, expected an object)"},
    {"NegativeNumber", scenario_with(R"("seed": -1)"),
     R"(2:9: error at /seed: out of range: found the number -1, expected an integer from 0 to 18446744073709551615)"},
    {"OverflowingNumber", scenario_with(R"("seed": 18446744073709551616)"),
     R"(2:9: error at /seed: out of range: found the number 18446744073709551616, expected an integer from 0 to 18446744073709551615)"},
    {"NumberWithExponent", scenario_with(R"("seed": 1e3)"),
     R"(2:9: error at /seed: not an integer: found the number 1e3, expected an integer from 0 to 18446744073709551615)"},
    {"NumberForABoolean", scenario_with(R"("allow_overload": 1)"),
     R"(2:19: error at /allow_overload: wrong type: found the number 1, expected true or false)"},
    {"DurationWithoutUnit", with_duration(R"(10)"),
     R"(2:13: error at /duration: wrong type: found the number 10, expected a duration such as the string "200us")"},
    {"DurationOverflows", with_duration(R"("1000000000000000000000s")"),
     R"(2:13: error at /duration: too large: found "1000000000000000000000s", expected a duration of at most 9223372.036854775807s)"},
    {"DurationBeyondTheRange", with_duration(R"("2401h")"),
     R"(2:13: error at /duration: out of range: found "2401h", expected a duration from 1ns to 2400h)"},
    {"DurationTooFine", with_duration(R"("0.0001ns")"),
     R"(2:13: error at /duration: too fine: found "0.0001ns", expected a duration in whole multiples of 1ps)"},
    {"DurationNotANumber", with_duration(R"("NaNs")"),
     R"(2:13: error at /duration: not a number with a unit: found "NaNs", expected a duration such as "200us")"},
    {"DurationOfNothing", with_duration(R"("0s")"),
     R"(2:13: error at /duration: out of range: found "0s", expected a duration from 1ns to 2400h)"},
    {"DurationNegative", with_duration(R"("-1s")"),
     R"(2:13: error at /duration: negative: found "-1s", expected a duration that is not negative)"},
};

INSTANTIATE_TEST_SUITE_P(BadText, BadInput, testing::ValuesIn(text_cases), name_of_case);

}  // namespace
}  // namespace takt::scenario::test::bad_text_test
