// SPDX-License-Identifier: Apache-2.0
// SQLite in few words. Internal to the .cpp files that know it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace takt::study {

/// Runs statements that give nothing back. The problem, or "".
std::string execute(sqlite3* database, const std::string& statements);
/// What SQLite says of its last mistake; says what to do if the disk is full.
std::string problem_of(sqlite3* database);

/// A prepared statement. Parameters and columns count from 0.
class Statement {
 public:
  Statement(sqlite3* database, const std::string& text);
  ~Statement();
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  bool is_sound() const { return statement_ != nullptr; }
  void bind(int parameter, std::int64_t value);
  void bind(int parameter, double value);
  void bind(int parameter, std::string_view value);
  void bind_null(int parameter);
  /// The next row; false at the end, or after a mistake.
  bool step();
  bool failed() const { return failed_; }
  /// Back to the beginning, for other parameters.
  void reset();

  std::int64_t integer(int column) const;
  std::optional<double> real(int column) const;
  std::string text(int column) const;

 private:
  sqlite3* database_;
  sqlite3_stmt* statement_ = nullptr;
  bool failed_ = false;
};

}  // namespace takt::study
