// SPDX-License-Identifier: Apache-2.0
// Any octets as the files of every import: neither crash nor hang, and what is refused has a diagnostic. The first line
// says which format and under which name ("linux sw1.sh", "yang+ sw1.json" into a small ring with a stream that copies
// could take), the rest is the text; a line "==== a.ini" begins a further file.
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "interchange/format.hpp"
#include "json/document.hpp"
#include "json/fields.hpp"
#include "sim/check.hpp"

namespace {

namespace interchange = takt::interchange;

/// What is imported into: the ways of a redundant stream are there, what devices would say of it is not.
takt::scenario::Scenario base() {
  constexpr std::string_view text =
      R"({"name": "ring", "duration": "1ms", "network": {"generate": [{"topology": "ring", "switches": 3}]},
    "streams": [{"name": "control", "from": "h1", "to": "h3", "payload": "100B", "every": "250us"}, {"name": "bulk", "from": "h2", "to": "h1", "payload": "1400B", "every": "20us"}]})";
  takt::json::Diagnostics diagnostics;
  const auto document = takt::json::parse(text, "base.json", diagnostics);
  takt::scenario::Scenario scenario;
  TAKT_CHECK(document && takt::json::decode(*document, scenario, diagnostics), "the base is one");
  return scenario;
}

void try_import(const interchange::ImportFormat& format, const std::string& name, std::string_view text,
                bool has_base) {
  takt::json::Diagnostics diagnostics;
  std::string mistake;
  const auto settings = interchange::Settings::read({}, format.settings, mistake);
  TAKT_CHECK(settings.has_value(), "no setting is no mistake");
  std::vector<interchange::InputFile> files;
  std::string current = name;
  constexpr std::string_view mark = "\n==== ";
  while (true) {
    const std::size_t next = files.size() < 6 ? text.find(mark) : std::string_view::npos;
    files.push_back({current, current.substr(0, current.find('.')), std::string(text.substr(0, next))});
    if (next == std::string_view::npos) break;
    text.remove_prefix(next + mark.size());
    const std::size_t line = text.find('\n');
    current = std::string(text.substr(0, std::min<std::size_t>(line, 100)));
    text.remove_prefix(line == std::string_view::npos ? text.size() : line);
  }
  const takt::scenario::Scenario into = base();
  const interchange::Imported imported = format.read({files, has_base ? &into : nullptr, *settings}, diagnostics);
  const bool has_made = imported.scenario.has_value() || imported.device.has_value();
  TAKT_CHECK(has_made || diagnostics.has_errors(), "what is refused has a diagnostic");
  TAKT_CHECK(!(has_made && diagnostics.has_errors()), "nothing is made with a mistake");
  TAKT_CHECK(diagnostics.to_text().size() <= std::size_t{1} << 22, "what is told to the user is bounded");
  for (const interchange::Remark& remark : imported.remarks)
    TAKT_CHECK(!interchange::to_text(remark).empty(), "a remark says something");
  if (imported.scenario) TAKT_CHECK(!interchange::sparse_text(*imported.scenario).empty(), "a scenario has a text");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t line = text.find('\n');
  if (line == std::string_view::npos || line > 200) return 0;
  const std::string_view first = text.substr(0, line);
  const std::size_t blank = first.find(' ');
  if (blank == std::string_view::npos) return 0;
  std::string_view format_name = first.substr(0, blank);
  const bool has_base = format_name.ends_with('+');
  if (has_base) format_name.remove_suffix(1);
  const interchange::ImportFormat* const format = interchange::find_import_format(format_name);
  if (format != nullptr && (format->into_base || !has_base))
    try_import(*format, std::string(first.substr(blank + 1)), text.substr(line + 1), has_base);
  return 0;
}
