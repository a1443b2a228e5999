// SPDX-License-Identifier: Apache-2.0
// What a store holds, in memory, column by column: what reports and comparisons read.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "study/plan.hpp"
#include "study/point.hpp"
#include "study/store.hpp"

namespace takt::study {

struct ContentFactor {
  std::string name;
  std::string unit;
  bool is_logarithmic = false;
  std::vector<std::string> texts;  ///< of the levels
  std::vector<double> numbers;     ///< NaN where a level is none
  bool is_numeric() const;         ///< every level is a number
};

struct ContentMeasure {
  std::string name;
  std::string unit;
  bool lower_is_better = true;  ///< unless a limit says "at_least"
  std::vector<double> values;   ///< by row; NaN: missing
  bool is_limited = false;      ///< a limit says which is better
  Basis basis = Basis::run;     ///< whose figures they are
};

/// A point without a result.
struct Trouble {
  std::uint64_t point = 0;
  Status status = Status::failed;
  std::string error;
};

struct Content {
  StoreHeader header;
  std::vector<ContentFactor> factors;
  std::vector<ContentMeasure> measures;
  std::vector<PlannedLimit> limits;
  std::vector<Variant> variants;
  // One row a point, by point number.
  std::vector<std::uint32_t> variant;
  std::vector<std::uint32_t> replication;
  std::vector<bool> passes;
  std::vector<Status> status;
  std::vector<std::string> verdict;
  std::vector<Trouble> troubles;
  double cpu_seconds = 0;
  double budget = Verifying{}.budget;  ///< of the search for worst runs, in millions of events a point
  bool is_of_schedules = false;

  std::size_t rows() const { return variant.size(); }
  /// The point's number.
  std::uint64_t point_of(std::size_t row) const { return variant[row] * header.replications + replication[row]; }
  const std::string& level_text(std::uint32_t v, std::size_t factor) const {
    return factors[factor].texts[variants[v][factor]];
  }
  std::string name_of(std::uint32_t v) const;
};

/// Reads a whole store; null and `problem` if that fails.
std::unique_ptr<Content> read_store(const std::string& path, std::string& problem);

}  // namespace takt::study
