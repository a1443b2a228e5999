// SPDX-License-Identifier: Apache-2.0
// Dependencies point one way (ARCHITECTURE.md, "The map"): who may include whom, heavy headers, and what the
// deterministic layers must not use.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <set>

#include "source_tree.hpp"

namespace takt::architecture::includes_test {
namespace {

using Prefixes = std::vector<std::string>;

/// What values without input and output use of the kernel.
const Prefixes base = {"sim/time.hpp", "sim/units.hpp", "sim/octets.hpp", "sim/check.hpp"};
/// Draws are values: a real node draws them, too.
const Prefixes chance = {"sim/random.hpp", "sim/distribution.hpp"};

/// A wing of the house. Its modules stand in order: each may include those before it, and the wings that are named.
struct Wing {
  std::string folder;
  std::vector<std::string> modules;
  std::vector<std::string> wings;
  Prefixes kernel;  ///< headers of sim/ and models/
};

const std::vector<Wing>& wings() {
  const auto with_chance = [] {
    Prefixes both = base;
    both.insert(both.end(), chance.begin(), chance.end());
    return both;
  };
  const Prefixes all = {"sim/", "models/"};
  static const std::vector<Wing> list = {
      {"protocol", {"uadp", "security", "program", "handshake", "pubsub", "wire", "dds", "gateway", "opcua"}, {}, base},
      {"foundation",
       {"json", "plant", "application", "schedule", "xml", "schedule_instances"},
       {"protocol"},
       with_chance()},
      {"simulation", {"results", "scenario", "evaluation", "explain"}, {"protocol", "foundation"}, all},
      {"questions",
       {"analysis", "explore", "profile", "schedule_check", "verify", "synthesis"},
       {"protocol", "foundation", "simulation"},
       all},
      {"presentation", {"chart", "output", "report"}, {"protocol", "foundation", "simulation", "questions"}, all},
      {"exchange", {"interchange"}, {"protocol", "foundation", "simulation", "questions"}, all},
      {"experiments",
       {"study", "papers", "property"},
       {"protocol", "foundation", "simulation", "questions", "presentation"},
       all},
      {"device", {"node", "emulate"}, {"protocol", "foundation"}, with_chance()},
      {"frontends",
       {"python", "studio", "cli"},
       {"protocol", "foundation", "simulation", "questions", "presentation", "exchange", "experiments", "device"},
       all}};
  return list;
}

/// Where the rule of the wing is not the whole of it.
struct Exception {
  std::string module;
  bool is_only;  ///< nothing else may be included; else this besides
  Prefixes may_include;
};

const std::vector<Exception>& exceptions() {
  static const std::vector<Exception> list = {
      {"json", true, base},
      {"schedule", true, {"sim/"}},
      {"results", true, {"sim/time.hpp", "sim/units.hpp", "sim/octets.hpp", "sim/check.hpp", "json/"}},
      {"chart", true, {}},
      {"emulate", false, {"scenario/", "results/", "evaluation/"}},
  };
  return list;
}

const Wing* wing_named(const std::string& folder) {
  const auto found =
      std::find_if(wings().begin(), wings().end(), [&](const Wing& each) { return each.folder == folder; });
  return found == wings().end() ? nullptr : &*found;
}

struct Layer {
  std::string folder;
  Prefixes may_include;
};

/// The modules of the wings, and the two folders of the simulator.
const std::vector<Layer>& layers() {
  static const std::vector<Layer> all = [] {
    std::vector<Layer> list = {{"sim/", {"sim/"}}, {"models/", {"sim/", "models/"}}};
    for (const Wing& wing : wings()) {
      Prefixes below = wing.kernel;
      for (const std::string& name : wing.wings)
        for (const std::string& module : wing_named(name)->modules) below.push_back(module + "/");
      for (const std::string& module : wing.modules) {
        below.push_back(module + "/");
        Layer layer{"src/" + wing.folder + "/" + module + "/", below};
        for (const Exception& each : exceptions()) {
          if (each.module != module) continue;
          if (each.is_only) layer.may_include = {module + "/"};
          layer.may_include.insert(layer.may_include.end(), each.may_include.begin(), each.may_include.end());
        }
        list.push_back(std::move(layer));
      }
      list.push_back({"src/" + wing.folder + "/", below});
    }
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

bool is_protocol(const SourceFile& file) { return is_below(file.path, "src/protocol/"); }

bool is_deterministic(const SourceFile& file) {
  return is_below(file.path, "sim/") || is_below(file.path, "models/") || is_protocol(file);
}

std::vector<SourceFile> product() {
  std::vector<SourceFile> files = files_below({"sim", "models", "src"});
  std::erase_if(files, [](const SourceFile& file) { return !file.is_cpp(); });
  return files;
}

/// The folders from which our headers are named.
const std::vector<std::string>& our_roots() {
  static const std::vector<std::string> roots = [] {
    std::vector<std::string> list = {"sim/", "models/"};
    for (const Wing& wing : wings())
      for (const std::string& module : wing.modules) list.push_back(module + "/");
    return list;
  }();
  return roots;
}

TEST(Includes, EveryFileBelongsToALayer) {
  for (const SourceFile& file : product())
    EXPECT_NE(layer_of(file.path), nullptr) << file.path << ": say in includes_test.cpp what this folder may include";
}

// The folders of src/ are the wings, and those of a wing its modules: the map of ARCHITECTURE.md is the listing.
TEST(Includes, FoldersAreWingsAndModules) {
  namespace fs = std::filesystem;
  const auto folders_of = [](const fs::path& folder) {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
      if (entry.is_directory()) names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
  };
  const fs::path source = fs::path(TAKT_SOURCE_DIR) / "src";
  std::vector<std::string> all;
  for (const Wing& wing : wings()) {
    all.push_back(wing.folder);
    std::vector<std::string> modules = wing.modules;
    std::sort(modules.begin(), modules.end());
    EXPECT_EQ(folders_of(source / wing.folder), modules) << wing.folder;
    EXPECT_TRUE(fs::is_directory(fs::path(TAKT_SOURCE_DIR) / "tests" / wing.folder)) << "tests mirror the wings";
  }
  std::sort(all.begin(), all.end());
  EXPECT_EQ(folders_of(source), all);
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

/// Folders of one module that include each other. The list may only become shorter.
const std::set<std::pair<std::string, std::string>>& known_knots() {
  static const std::set<std::pair<std::string, std::string>> list = {
      {"models/bridge", "models/host"},        {"models/ethernet", "models/fault"},
      {"models/ethernet", "models/host"},      {"dds/participant", "dds/persistence"},
      {"dds/persistence", "dds/rtps"},         {"opcua/address_space", "opcua/services"},
      {"explore/model", "explore/properties"}, {"explore/properties", "explore/search"},
      {"explore/report", "explore/search"},
  };
  return list;
}

// Folders inside a module depend on each other one way, as modules do. Files beside the folders may join them.
TEST(Includes, FoldersInsideModulesPointOneWay) {
  std::set<std::pair<std::string, std::string>> seen;
  const auto folder_of = [](const std::string& header) {
    const std::size_t module = header.find('/');
    const std::size_t folder = module == std::string::npos ? module : header.find('/', module + 1);
    return folder == std::string::npos ? std::string() : header.substr(0, folder);
  };
  for (const SourceFile& file : product()) {
    std::string name = file.path;
    if (name.starts_with("src/")) name = name.substr(name.find('/', 4) + 1);
    const std::string from = folder_of(name);
    for (const Include& include : includes_of(file)) {
      const std::string to = folder_of(include.target);
      const bool is_inside =
          !from.empty() && !to.empty() && from.substr(0, from.find('/')) == to.substr(0, to.find('/'));
      if (is_inside && from != to) seen.emplace(from, to);
    }
  }
  std::set<std::pair<std::string, std::string>> knots;
  for (const auto& [from, to] : seen)
    if (from < to && seen.contains({to, from})) knots.emplace(from, to);
  EXPECT_GT(seen.size(), 100u) << "the test no longer finds the includes";
  for (const auto& [a, b] : knots)
    EXPECT_TRUE(known_knots().contains({a, b})) << a << " and " << b << " include each other";
  for (const auto& [a, b] : known_knots())
    EXPECT_TRUE(knots.contains({a, b})) << a << " and " << b << ": take it off the list";
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
