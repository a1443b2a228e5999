// SPDX-License-Identifier: Apache-2.0
// Any octets as a JSON input: neither crash nor hang, and what is accepted survives a round trip.
//
// The first line, if it begins with "--set ", is an override of the rest.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "json/fields.hpp"
#include "json/override.hpp"
#include "json/sample.hpp"
#include "sim/check.hpp"

namespace {

namespace json = takt::json;

// What is decoded. To fuzz another input, name its type and its check here and link its library.
using Input = takt::sample::Sample;
void check_meaning(const Input& input, json::Diagnostics& diagnostics) { takt::sample::check(input, diagnostics); }

void try_input(std::string_view text, std::string_view option) {
  json::Diagnostics diagnostics;
  auto document = json::parse(text, "fuzz.json", diagnostics);
  TAKT_CHECK(document.has_value() || diagnostics.has_errors(), "a text that is refused has a diagnostic");
  if (document && !option.empty()) json::apply(*document, option, diagnostics);

  Input input;
  if (document && json::decode(*document, input, diagnostics)) {
    const std::string resolved = json::encode(input);
    json::Diagnostics none;
    Input again;
    const auto copy = json::parse(resolved, "resolved.json", none);
    TAKT_CHECK(copy && json::decode(*copy, again, none), "a resolved copy has no mistakes");
    TAKT_CHECK(input == again && json::encode(again) == resolved, "a resolved copy means the same");
    check_meaning(input, diagnostics);
  }
  TAKT_CHECK(diagnostics.to_text().size() <= std::size_t{1} << 22, "what is told to the user is bounded");
  TAKT_CHECK(json::parse(json::pretty(diagnostics.to_json()), "diagnostics.json", diagnostics),
             "diagnostics are valid JSON");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  std::string_view option;
  constexpr std::string_view prefix = "--set ";
  if (text.starts_with(prefix)) {
    const std::size_t end = text.find('\n');
    option = text.substr(prefix.size(), end == std::string_view::npos ? end : end - prefix.size());
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  try_input(text, option);
  return 0;
}
