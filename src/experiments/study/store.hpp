// SPDX-License-Identifier: Apache-2.0
// The SQLite file in which a study's points are kept. docs/studies.md describes its tables.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "results/behaviour.hpp"
#include "study/plan.hpp"
#include "study/point.hpp"

struct sqlite3;

namespace takt::study {

/// Of the tables. A store with another one is refused.
constexpr int store_version = 1;

/// What a store says of itself.
struct StoreHeader {
  results::Maker maker;  ///< the takt that made it
  std::string name;      ///< of the study
  std::string digest;    ///< of the configuration, 16 hex digits
  std::uint64_t variants = 0;
  std::uint64_t replications = 0;
  std::string configuration = {};  ///< study and scenario, as JSON
  std::uint64_t points() const { return variants * replications; }
};

class Store {
 public:
  /// Makes a store for a plan; the file must not be there. Null and `problem` if that fails; then there is no file.
  static std::unique_ptr<Store> create(const std::string& path, const Plan& plan, std::string& problem);
  /// Opens one that is there.
  static std::unique_ptr<Store> open(const std::string& path, std::string& problem);
  ~Store();
  Store(const Store&) = delete;
  Store& operator=(const Store&) = delete;

  const StoreHeader& header() const { return header_; }

  /// Adds a point in a transaction of its own; when it returns "", a killed process no longer loses it. Else the
  /// problem.
  std::string add(const Plan& plan, std::uint64_t point, const Outcome& outcome);
  /// By point, whether it is there. The problem, or "".
  std::string finished(std::vector<bool>& points) const;
  /// A digest over points and their results in the order of points: equal for equal results, however they were come by.
  std::string results_digest(std::uint64_t& digest, std::uint64_t& count) const;
  /// Ends the log beside the file, so that the file alone is the whole store. A disk that is full does not matter: the
  /// log stays.
  void tidy();

  sqlite3* handle() const { return database_; }

 private:
  Store() = default;
  std::string read_header();

  sqlite3* database_ = nullptr;
  void* insert_ = nullptr;  // the prepared statement of add()
  StoreHeader header_;
};

/// Why points of a plan cannot be added to a store: it is of another study, or another takt would have other results
/// for the same points. Else empty.
std::string why_not_resumed(const StoreHeader& header, const Plan& plan, const std::string& path);

/// Joins stores of one study into a new one. Stores of different studies, versions or results are refused. The problem,
/// or "".
std::string merge_stores(const std::string& path, const std::vector<std::string>& parts);

}  // namespace takt::study
