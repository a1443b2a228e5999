// SPDX-License-Identifier: Apache-2.0
// Dependencies point one way (ARCHITECTURE.md, "The map"): who may include whom, heavy headers, and what the
// deterministic layers must not use.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "source_tree.hpp"

namespace takt::architecture::includes_test {
namespace {

using Prefixes = std::vector<std::string>;

/// Headers of the repository, as they are written in an #include: from the root, or from src/.
const Prefixes kernel = {"sim/"};
const Prefixes base = {"sim/time.hpp", "sim/units.hpp", "sim/octets.hpp", "sim/check.hpp"};
/// Draws are values; what draws them here draws them on a real node, too.
const Prefixes chance = {"sim/random.hpp", "sim/distribution.hpp"};
const Prefixes models = {"models/"};
const Prefixes protocol = {"security/",  "wire/", "uadp/",    "pubsub/", "program/",
                           "handshake/", "dds/",  "gateway/", "opcua/"};
const Prefixes scenario = {"scenario/"};
const Prefixes json = {"json/"};
const Prefixes questions = {"analysis/", "explore/", "schedule_check/", "synthesis/", "verify/"};
const Prefixes results = {"results/"};
const Prefixes evaluation = {"evaluation/"};
const Prefixes explain = {"explain/"};
const Prefixes output = {"output/"};
const Prefixes chart = {"chart/"};
const Prefixes study = {"study/"};
const Prefixes cli = {"cli/"};
const Prefixes node = {"node/"};
const Prefixes emulate = {"emulate/"};
const Prefixes plant = {"plant/"};
const Prefixes application = {"application/"};
const Prefixes papers = {"papers/"};
const Prefixes interchange = {"interchange/"};
const Prefixes report = {"report/"};
const Prefixes studio = {"studio/"};
const Prefixes schedule = {"schedule/"};
const Prefixes interchange_schedules = {"schedule_instances/"};

Prefixes all_of(std::initializer_list<Prefixes> parts) {
  Prefixes sum;
  for (const Prefixes& part : parts) sum.insert(sum.end(), part.begin(), part.end());
  return sum;
}

struct Layer {
  std::string folder;
  Prefixes may_include;
};

/// The first folder that fits a file is its layer.
const std::vector<Layer>& layers() {
  static const std::vector<Layer> all = [] {
    std::vector<Layer> list = {{"sim/", kernel}, {"models/", all_of({kernel, models})}};
    for (const std::string& folder : protocol) list.push_back({"src/" + folder, all_of({base, protocol})});
    list.push_back({"src/foundation/plant/", all_of({base, protocol, plant, json})});
    list.push_back({"src/foundation/application/", all_of({base, chance, json, protocol, plant, application})});
    list.push_back({"src/device/node/", all_of({base, chance, protocol, plant, application, node, json})});
    list.push_back({"src/foundation/json/", all_of({base, json})});
    list.push_back({"src/simulation/results/", all_of({base, json, results})});
    list.push_back({"src/foundation/schedule/", all_of({base, chance, schedule})});
    list.push_back(
        {"src/foundation/schedule_instances/", all_of({base, json, schedule, interchange_schedules, {"interchange/xml/"}})});
    const Prefixes below = all_of({schedule, kernel, models, protocol, plant, application, json, results, scenario});
    list.push_back({"src/simulation/scenario/", below});
    list.push_back({"src/simulation/explain/", all_of({below, explain})});
    // Beside the questions, but its points are results as result.json has them, and its report is drawn.
    list.push_back(
        {"src/experiments/study/", all_of({below, questions, evaluation, explain, output, chart, interchange_schedules, study})});
    // A proof is put into words in one place, for instances and for scenarios.
    list.push_back(
        {"src/questions/synthesis/", all_of({below, questions, evaluation, explain, {"schedule_instances/proof.hpp"}})});
    for (const std::string& folder : questions)
      list.push_back({"src/" + folder, all_of({below, questions, evaluation, explain})});
    list.push_back({"src/simulation/evaluation/", all_of({below, evaluation})});
    list.push_back({"src/presentation/output/", all_of({below, questions, evaluation, explain, output})});
    list.push_back({"src/presentation/chart/", chart});
    list.push_back({"src/presentation/report/", all_of({below, questions, evaluation, explain, output, chart, report})});
    list.push_back({"src/experiments/papers/", all_of({below, questions, evaluation, chart, report, papers})});
    list.push_back({"src/experiments/property/", all_of({below, questions, evaluation, output, {"property/"}})});
    list.push_back({"src/exchange/interchange/", all_of({below, chart, interchange, {"schedule_check/"}})});
    list.push_back({"src/device/emulate/", all_of({below, node, emulate})});
    list.push_back({"src/frontends/python/", all_of({below,
                                           questions,
                                           study,
                                           evaluation,
                                           explain,
                                           output,
                                           chart,
                                           report,
                                           interchange_schedules,
                                           {"python/"}})});
    list.push_back(
        {"src/frontends/studio/", all_of({below, questions, study, evaluation, explain, output, chart, report, studio})});
    list.push_back({"src/frontends/cli/", all_of({below, questions, study, evaluation, explain, output, node, emulate, report,
                                        studio, papers, interchange, cli})});
    list.push_back({"src/frontends/main.cpp", all_of({below, questions, study, evaluation, explain, output, node, emulate, report,
                                            studio, papers, interchange, cli})});
    return list;
  }();
  return all;
}

const Layer* layer_of(const std::string& path) {
  const auto found =
      std::find_if(layers().begin(), layers().end(), [&](const Layer& layer) { return is_below(path, layer.folder); });
  return found == layers().end() ? nullptr : &*found;
}

bool starts_with_any(const std::string& text, const Prefixes& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](const std::string& prefix) { return text.starts_with(prefix); });
}

bool is_protocol(const SourceFile& file) {
  return file.path.starts_with("src/") && starts_with_any(file.path.substr(4), protocol);
}
bool is_deterministic(const SourceFile& file) {
  return is_below(file.path, "sim/") || is_below(file.path, "models/") || is_protocol(file);
}

std::vector<SourceFile> product() {
  std::vector<SourceFile> files = files_below({"sim", "models", "src"});
  std::erase_if(files, [](const SourceFile& file) { return !file.is_cpp(); });
  return files;
}

const std::vector<std::string>& our_roots() {
  static const std::vector<std::string> roots = all_of({kernel,      models,
                                                        protocol,    json,
                                                        scenario,    questions,
                                                        results,     evaluation,
                                                        explain,     output,
                                                        cli,         node,
                                                        emulate,     plant,
                                                        application, chart,
                                                        report,      studio,
                                                        papers,      study,
                                                        schedule,    interchange_schedules,
                                                        interchange, {"property/", "python/"}});
  return roots;
}

TEST(Includes, EveryFileBelongsToALayer) {
  for (const SourceFile& file : product())
    EXPECT_NE(layer_of(file.path), nullptr) << file.path << ": say in includes_test.cpp what this folder may include";
}

TEST(Includes, PointOneWay) {
  std::size_t seen = 0;
  for (const SourceFile& file : product()) {
    const Layer* const layer = layer_of(file.path);
    if (layer == nullptr) continue;
    for (const Include& include : includes_of(file)) {
      if (!starts_with_any(include.target, our_roots())) continue;
      ++seen;
      EXPECT_TRUE(starts_with_any(include.target, layer->may_include))
          << file.path << ":" << include.line << ": " << layer->folder << " must not include " << include.target;
    }
  }
  EXPECT_GT(seen, 200u) << "the test no longer finds the includes";
}

// Without a path nobody knows whose header it is.
TEST(Includes, OurHeadersAreNamedFromTheRootOrFromSrc) {
  const std::regex quoted(R"(^#include "([^"]+)\")");
  for (const SourceFile& file : product()) {
    for (std::size_t i = 0; i < file.lines.size(); ++i) {
      std::smatch match;
      if (!std::regex_search(file.lines[i], match, quoted)) continue;
      EXPECT_TRUE(starts_with_any(match[1], our_roots())) << file.path << ":" << i + 1 << ": " << match[1];
    }
  }
}

// Cryptography is behind one interface.
TEST(Includes, OpenSslIsSeenBySecurityOnly) {
  for (const SourceFile& file : product())
    for (const Include& include : includes_of(file))
      EXPECT_TRUE(!include.target.starts_with("openssl/") ||
                  (is_below(file.path, "src/protocol/security/") && !file.is_header()))
          << file.path << ":" << include.line << ": " << include.target;
}

TEST(Includes, HeavyHeadersStayInCppFiles) {
  const Prefixes heavy = {"nlohmann/", "boost/", "Eigen/", "sqlite3", "expat", "CLI/", "valijson/", "fmt/"};
  for (const SourceFile& file : product()) {
    if (!file.is_header()) continue;
    for (const Include& include : includes_of(file))
      EXPECT_FALSE(starts_with_any(include.target, heavy))
          << file.path << ":" << include.line << ": " << include.target;
  }
}

struct Forbidden {
  const char* pattern;
  const char* why;
};

void expect_free_of(const SourceFile& file, const std::vector<Forbidden>& forbidden) {
  for (const Forbidden& one : forbidden) {
    // There parts of a run on several threads meet, and the tests show that nobody can tell.
    if (std::string_view(one.why) == "threads" && is_below(file.path, "models/parts/")) continue;
    const std::regex pattern(one.pattern);
    for (std::size_t i = 0; i < file.code.size(); ++i)
      EXPECT_FALSE(std::regex_search(file.code[i], pattern))
          << file.path << ":" << i + 1 << ": " << one.why << "\n  " << file.lines[i];
  }
}

// The same scenario and seed give the same run on every machine.
TEST(Determinism, NothingBelowReadsTheWorld) {
  const std::vector<Forbidden> forbidden = {
      {R"(<chrono>|std::chrono|clock_gettime|gettimeofday|\btime\s*\(\s*(nullptr|NULL|0)\s*\))", "a wall clock"},
      {R"(\bgetenv\b|\bsetlocale\b|std::locale)", "the environment"},
      {R"(<random>|std::mt19937|std::\w+_distribution\b|random_device|\bs?rand\s*\()", "chance that is not takt's own"},
      {R"(unordered_(map|set|multimap|multiset))", "a container without an order"},
      {R"(std::hash\b|uintptr_t)", "the value of a pointer"},
      {R"(std::(this_)?j?thread|std::mutex|std::atomic)", "threads"},
      {R"(\bstatic\s+(?!constexpr|const\b|inline|_)[A-Za-z_:<>0-9]+\s+\w+\s*(=|;|\{))",
       "state that outlives a simulation"},
  };
  for (const SourceFile& file : product())
    if (is_deterministic(file)) expect_free_of(file, forbidden);
}

// Events are decided without libm: its results differ between machines.
TEST(Determinism, NoLibmBelow) {
  const std::vector<Forbidden> forbidden = {
      {R"(std::(exp|log|log1p|expm1|pow|sin|cos|tan|atan2?|cbrt|erfc?|tgamma|lgamma)\s*\()", "libm"}};
  for (const SourceFile& file : product())
    if (is_deterministic(file)) expect_free_of(file, forbidden);
}

// Protocol code is sans-IO: it runs on a real node as it stands.
TEST(Protocol, HasNoInputOrOutput) {
  const std::regex io(R"(<(iostream|fstream|cstdio|filesystem|sys/.*|netinet/.*|arpa/.*|unistd\.h|thread|mutex)>)");
  for (const SourceFile& file : product()) {
    if (!is_protocol(file)) continue;
    for (std::size_t i = 0; i < file.lines.size(); ++i)
      EXPECT_FALSE(std::regex_search(file.lines[i], io)) << file.path << ":" << i + 1;
  }
}

}  // namespace
}  // namespace takt::architecture::includes_test
