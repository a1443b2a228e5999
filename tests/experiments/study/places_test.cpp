// SPDX-License-Identifier: Apache-2.0
// Whatever is wrong with a file, each diagnostic says where: scenarios and studies as shipped, changed in one to three
// places at random, thousands of times.
//
//   TAKT_PLACES=10000 takt_places_test     more than ctest does
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "scenario/resolve.hpp"
#include "sim/digest.hpp"
#include "study/plan.hpp"
#include "tests/support/case_count.hpp"

namespace takt::study {
namespace {

constexpr std::uintmax_t largest = 12'000;  // octets; larger ones say nothing new and take long
constexpr unsigned mutants_in_short = 2000;

/// Reproducible, and nothing else.
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : state_(seed) {}
  std::size_t below(std::size_t end) {
    return static_cast<std::size_t>((state_ = sim::mix64(state_ + 0x9E3779B97F4A7C15ULL)) % end);
  }

 private:
  std::uint64_t state_;
};

void collect(json::Node& node, std::vector<json::Node*>& nodes) {
  nodes.push_back(&node);
  for (json::Node& item : node.items) collect(item, nodes);
  for (json::Member& member : node.members) collect(member.value, nodes);
}

json::Node odd_value(Chance& chance) {
  static const char* const texts[] = {"",      "x",     "0",      "-1", "1e400", "10ms", "0ms",  "9999999h", "1B",
                                      "9000B", "1Gbps", "99Gbps", "/",  "a/b",   "auto", "best", "sw1",      "1us"};
  switch (chance.below(6)) {
    case 0:
      return json::Node::of_integer(static_cast<std::int64_t>(chance.below(70)) - 2);
    case 1:
      return json::Node::of_bool(chance.below(2) == 0);
    case 2:
      return json::Node::array();
    case 3:
      return json::Node::object();
    default:
      return json::Node::of_string(texts[chance.below(std::size(texts))]);
  }
}

void mutate(json::Node& root, Chance& chance) {
  std::vector<json::Node*> nodes;
  collect(root, nodes);
  json::Node& node = *nodes[chance.below(nodes.size())];
  switch (chance.below(7)) {
    case 0:
      node = odd_value(chance);
      break;
    case 1:  // something of elsewhere
      if (json::Node other = *nodes[chance.below(nodes.size())]; other.items.size() + other.members.size() < 50)
        node = std::move(other);
      break;
    case 2:
      if (!node.members.empty())
        node.members.erase(node.members.begin() + static_cast<std::ptrdiff_t>(chance.below(node.members.size())));
      break;
    case 3:
      if (!node.items.empty())
        node.items.erase(node.items.begin() + static_cast<std::ptrdiff_t>(chance.below(node.items.size())));
      break;
    case 4:
      if (!node.items.empty()) node.items.push_back(json::Node(node.items[chance.below(node.items.size())]));
      break;
    case 5:
      if (!node.members.empty()) node.members[chance.below(node.members.size())].key += "x";
      break;
    default:
      if (node.kind == json::Kind::string && !node.text.empty())
        node.text[chance.below(node.text.size())] = static_cast<char>('0' + chance.below(60));
      if (node.kind == json::Kind::number)
        node.text = std::to_string(chance.below(200));  // what size costs is not the question here
      break;
  }
}

std::vector<std::filesystem::path> shipped(bool studies) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry :
       std::filesystem::recursive_directory_iterator(std::filesystem::path(TAKT_SOURCE_DIR) / "scenarios"))
    if (entry.path().extension() == ".json" && entry.file_size() < largest &&
        entry.path().filename() != "takt.schema.json" &&
        (entry.path().parent_path().filename() == "studies") == studies)
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

unsigned mutants_wanted() {
  constexpr rlim_t most_memory = rlim_t{1} << 30;  // a mutant that asks for more fails the test, not the machine
  const rlimit limit{most_memory, most_memory};
  ::setrlimit(RLIMIT_AS, &limit);
  return static_cast<unsigned>(support::case_count("TAKT_PLACES", mutants_in_short));
}

/// Kinds of messages without a place, and an example of each.
struct Findings {
  std::map<std::string, std::string> placeless;
  std::size_t diagnostics = 0;
  void look_at(const json::Diagnostics& found, const std::string& what) {
    for (const json::Diagnostic& diagnostic : found.kept()) {
      ++diagnostics;
      if (diagnostic.place.file.empty() || diagnostic.place.line == 0 || diagnostic.place.column == 0)
        placeless.emplace(diagnostic.message, what + ": " + json::to_text(diagnostic));
    }
  }
  void expect_none() const {
    for (const auto& [message, example] : placeless) ADD_FAILURE() << example;
    EXPECT_GT(diagnostics, 200u) << "the mutants make mistakes";
  }
};

json::Document document_of(const std::filesystem::path& path) {
  json::Diagnostics diagnostics;
  auto document = json::parse_file(path.string(), diagnostics);
  EXPECT_TRUE(document) << diagnostics.to_text();
  return *document;
}

json::Node mutant_of(const std::filesystem::path& path, std::uint64_t number, Chance& chance) {
  json::Node root = document_of(path).root();
  for (std::size_t i = 0; i <= number % 3; ++i) mutate(root, chance);
  return root;
}

TEST(Places, OfAllDiagnosticsOfScenarios) {
  const auto files = shipped(false);
  ASSERT_GT(files.size(), 20u);
  Findings findings;
  for (unsigned i = 0; i < mutants_wanted(); ++i) {
    Chance chance(i);
    const std::filesystem::path& file = files[i % files.size()];
    json::Diagnostics diagnostics;
    scenario::load_text(json::pretty(mutant_of(file, i, chance)), (file.parent_path() / "mutant.json").string(), {},
                        diagnostics);
    findings.look_at(diagnostics, file.filename().string() + " mutant " + std::to_string(i));
  }
  findings.expect_none();
}

TEST(Places, OfAllDiagnosticsOfStudies) {
  const auto files = shipped(true);
  ASSERT_GT(files.size(), 3u);
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("takt-places-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  Findings findings;
  constexpr std::size_t most_variants_looked_at = 4;
  for (unsigned i = 0; i < mutants_wanted(); ++i) {
    Chance chance(i);
    const std::filesystem::path& file = files[i % files.size()];
    json::Node mutant = mutant_of(file, i, chance);
    if (json::Node* const base = mutant.find("base"); base != nullptr && base->kind == json::Kind::string)
      base->text = (file.parent_path() / base->text).string();
    const std::filesystem::path path = folder / "mutant.json";
    std::ofstream(path) << json::pretty(mutant);
    json::Diagnostics diagnostics;
    const auto plan = load_plan(path.string(), diagnostics);
    for (std::size_t v = 0; plan && v < std::min(plan->variants.size(), most_variants_looked_at); ++v)
      check_variant(*plan, plan->variants[v * plan->variants.size() / most_variants_looked_at], diagnostics);
    findings.look_at(diagnostics, file.filename().string() + " mutant " + std::to_string(i));
  }
  std::filesystem::remove_all(folder);
  findings.expect_none();
}

}  // namespace
}  // namespace takt::study
