// SPDX-License-Identifier: Apache-2.0
// What `takt verify --format json` holds.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "json/type.hpp"
#include "verify/report.hpp"

namespace takt::verify {

struct ReportedVariable {
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
  std::vector<ReportedVariable> free;
  std::vector<ReportedLine> requirements;
  std::vector<ReportedAssumption> assumptions;
  std::optional<ReportedContradiction> contradiction;
};

const json::Record& describe(json::Type<ReportedVariable>);
const json::Record& describe(json::Type<SlackPart>);
const json::Record& describe(json::Type<WeightyPart>);
const json::Record& describe(json::Type<Remedy>);
const json::Record& describe(json::Type<ReportedLine>);
const json::Record& describe(json::Type<ReportedAssumption>);
const json::Record& describe(json::Type<ReportedContradiction>);
const json::Record& describe(json::Type<Report>);

}  // namespace takt::verify
