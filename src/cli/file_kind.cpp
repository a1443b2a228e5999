#include "cli/file_kind.hpp"

#include <algorithm>
#include <initializer_list>
#include <string_view>

#include "json/document.hpp"

namespace takt::cli {
namespace {

struct Kind {
  FileKind kind;
  std::string_view what;                        ///< "a study"
  std::string_view command;                     ///< that takes it
  std::initializer_list<std::string_view> all;  ///< names that such a file has
};

/// The first whose names are all there. A result has "scenario" as studies may, a scenario has "network".
constexpr Kind kinds[] = {
    {FileKind::result, "the result of a run", "takt compare", {"digest", "verdict", "requirements"}},
    {FileKind::study, "a study", "takt study", {"factors"}},
    {FileKind::study, "a study", "takt study", {"measures"}},
    {FileKind::server_network, "a network of servers", "takt bound", {"servers", "flows"}},
    {FileKind::scenario, "a scenario", "takt run, check, bound or verify", {"network"}},
    {FileKind::node, "the configuration of a node", "takt node", {"node", "program"}},
    {FileKind::node, "the configuration of a node", "takt node", {"node", "applications"}},
};

const Kind* find_kind(const json::Node& root) {
  const auto found = std::find_if(std::begin(kinds), std::end(kinds), [&](const Kind& kind) {
    return std::all_of(kind.all.begin(), kind.all.end(), [&](std::string_view name) { return root.find(name) != nullptr; });
  });
  return found == std::end(kinds) ? nullptr : found;
}

}  // namespace

FileKind kind_of_file(const std::string& path) {
  json::Diagnostics ignored;
  const auto document = json::parse_file(path, ignored);
  if (!document || document->root().kind != json::Kind::object) return FileKind::unknown;
  const Kind* const kind = find_kind(document->root());
  return kind == nullptr ? FileKind::unknown : kind->kind;
}

bool belongs_elsewhere(const std::string& path, FileKind wanted, json::Diagnostics& diagnostics) {
  const FileKind found = kind_of_file(path);
  if (found == FileKind::unknown || found == wanted) return false;
  const auto of = [](FileKind kind) { return std::find_if(std::begin(kinds), std::end(kinds), [&](const Kind& each) { return each.kind == kind; }); };
  diagnostics.error({path, 1, 1, ""}, "a file for another command", {std::string(of(found)->what) + ", which " + std::string(of(found)->command) + " takes", std::string(of(wanted)->what), ""});
  return true;
}

}  // namespace takt::cli
