// SPDX-License-Identifier: Apache-2.0
#include "study/sql.hpp"

#include <sqlite3.h>

namespace takt::study {

std::string problem_of(sqlite3* database) {
  if (sqlite3_errcode(database) == SQLITE_FULL)
    return "the disk is full; what was finished is kept. Make room and go on with --resume";
  return sqlite3_errmsg(database);
}

std::string execute(sqlite3* database, const std::string& statements) {
  return sqlite3_exec(database, statements.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK ? std::string()
                                                                                            : problem_of(database);
}

Statement::Statement(sqlite3* database, const std::string& text) : database_(database) {
  failed_ =
      sqlite3_prepare_v2(database_, text.c_str(), static_cast<int>(text.size()), &statement_, nullptr) != SQLITE_OK;
}
Statement::~Statement() { sqlite3_finalize(statement_); }

void Statement::bind(int parameter, std::int64_t value) { sqlite3_bind_int64(statement_, parameter + 1, value); }
void Statement::bind(int parameter, double value) { sqlite3_bind_double(statement_, parameter + 1, value); }
void Statement::bind(int parameter, std::string_view value) {
  sqlite3_bind_text(statement_, parameter + 1, value.data(), static_cast<int>(value.size()), SQLITE_TRANSIENT);
}
void Statement::bind_null(int parameter) { sqlite3_bind_null(statement_, parameter + 1); }

bool Statement::step() {
  if (statement_ == nullptr) return false;
  const int code = sqlite3_step(statement_);
  failed_ = code != SQLITE_ROW && code != SQLITE_DONE;
  return code == SQLITE_ROW;
}

void Statement::reset() { sqlite3_reset(statement_); }

std::int64_t Statement::integer(int column) const { return sqlite3_column_int64(statement_, column); }
std::optional<double> Statement::real(int column) const {
  if (sqlite3_column_type(statement_, column) == SQLITE_NULL) return std::nullopt;
  return sqlite3_column_double(statement_, column);
}
std::string Statement::text(int column) const {
  const unsigned char* const value = sqlite3_column_text(statement_, column);
  return value == nullptr ? std::string()
                          : std::string(reinterpret_cast<const char*>(value),
                                        static_cast<std::size_t>(sqlite3_column_bytes(statement_, column)));
}

}  // namespace takt::study
