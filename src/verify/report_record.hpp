// What `takt verify --format json` holds.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenario/json/type.hpp"
#include "verify/report.hpp"

namespace takt::verify {

struct ReportedFreedom {
  std::string what;
  std::optional<sim::Duration> range;
};

struct ReportedLine {
  const Line* line = nullptr;
  std::optional<std::string> file;
};

struct ReportedAssumption {
  std::string name;
  analysis::AssessedAssumption assessed;
};

struct ReportedContradiction {
  std::string text;
  Witnesses witnesses;
};

struct Report {
  std::string scenario;
  std::string verdict;
  std::uint64_t runs = 0;
  bool partial = false;
  std::vector<ReportedFreedom> free;
  std::vector<ReportedLine> requirements;
  std::vector<ReportedAssumption> assumptions;
  std::optional<ReportedContradiction> contradiction;
};

const scenario::json::Record& describe(scenario::json::Type<ReportedFreedom>);
const scenario::json::Record& describe(scenario::json::Type<SlackPart>);
const scenario::json::Record& describe(scenario::json::Type<ReportedLine>);
const scenario::json::Record& describe(scenario::json::Type<ReportedAssumption>);
const scenario::json::Record& describe(scenario::json::Type<ReportedContradiction>);
const scenario::json::Record& describe(scenario::json::Type<Report>);

}  // namespace takt::verify
