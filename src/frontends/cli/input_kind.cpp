// SPDX-License-Identifier: Apache-2.0
#include "cli/input_kind.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

#include "json/document.hpp"

namespace takt::cli {
namespace {

struct InputFile {
  InputKind kind;
  std::string_view what;                ///< "a study"
  std::string_view command;             ///< that takes it
  std::array<std::string_view, 3> all;  ///< names that such a file has, or ""
};

/// The first whose names are all there. A result has "scenario" as studies may, a scenario has "network".
constexpr InputFile input_files[] = {
    {InputKind::result, "the result of a run", "takt compare", {"digest", "verdict", "requirements"}},
    {InputKind::study, "a study", "takt study", {"factors"}},
    {InputKind::study, "a study", "takt study", {"measures"}},
    {InputKind::server_network, "a network of servers", "takt bound", {"servers", "flows"}},
    {InputKind::scenario, "a scenario", "takt run, check, bound or verify", {"network"}},
    {InputKind::node, "the configuration of a node", "takt node", {"node", "program"}},
    {InputKind::node, "the configuration of a node", "takt node", {"node", "programs"}},
    {InputKind::node, "the configuration of a node", "takt node", {"node", "topics"}},
};

const InputFile* find_kind(const json::Node& root) {
  const auto found = std::find_if(std::begin(input_files), std::end(input_files), [&](const InputFile& kind) {
    return std::all_of(kind.all.begin(), kind.all.end(),
                       [&](std::string_view name) { return name.empty() || root.find(name) != nullptr; });
  });
  return found == std::end(input_files) ? nullptr : found;
}

}  // namespace

InputKind input_kind_of(const std::string& path) {
  json::Diagnostics ignored;
  const auto document = json::parse_file(path, ignored);
  if (!document || document->root().kind != json::Kind::object) return InputKind::unknown;
  const InputFile* const kind = find_kind(document->root());
  return kind == nullptr ? InputKind::unknown : kind->kind;
}

bool belongs_elsewhere(const std::string& path, InputKind wanted, json::Diagnostics& diagnostics) {
  const InputKind found = input_kind_of(path);
  if (found == InputKind::unknown || found == wanted) return false;
  const auto of = [](InputKind kind) {
    return std::find_if(std::begin(input_files), std::end(input_files),
                        [&](const InputFile& each) { return each.kind == kind; });
  };
  diagnostics.error({path, 1, 1, ""}, "a file for another command",
                    {std::string(of(found)->what) + ", which " + std::string(of(found)->command) + " takes",
                     std::string(of(wanted)->what), ""});
  return true;
}

}  // namespace takt::cli
