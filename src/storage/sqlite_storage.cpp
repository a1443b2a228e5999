#include "storage/sqlite_storage.hpp"

#include <sqlite3.h>

#include <stdexcept>

namespace takt::storage {

struct SqliteStorage::Database {
  ~Database() {
    for (sqlite3_stmt* const statement : {put, erase, from}) sqlite3_finalize(statement);
    sqlite3_close(connection);
  }
  bool prepare(const char* text, sqlite3_stmt*& statement) { return sqlite3_prepare_v2(connection, text, -1, &statement, nullptr) == SQLITE_OK; }
  /// Runs a statement that gives nothing back, and makes it ready for the next time.
  void run(sqlite3_stmt* statement) {
    const int code = sqlite3_step(statement);
    sqlite3_reset(statement);
    if (code != SQLITE_DONE) throw std::runtime_error(std::string("storage: ") + sqlite3_errmsg(connection));
  }

  sqlite3* connection = nullptr;
  sqlite3_stmt* put = nullptr;
  sqlite3_stmt* erase = nullptr;
  sqlite3_stmt* from = nullptr;
};

namespace {

void bind(sqlite3_stmt* statement, int parameter, std::string_view text) {
  sqlite3_bind_text(statement, parameter, text.data(), static_cast<int>(text.size()), SQLITE_STATIC);
}

}  // namespace

SqliteStorage::SqliteStorage(std::unique_ptr<Database> database) : database_(std::move(database)) {}
SqliteStorage::~SqliteStorage() = default;

std::unique_ptr<SqliteStorage> SqliteStorage::open(const std::string& path, std::string& problem) {
  auto database = std::make_unique<Database>();
  const auto fails = [&] {
    problem = path + ": " + sqlite3_errmsg(database->connection);
    return nullptr;
  };
  if (sqlite3_open(path.c_str(), &database->connection) != SQLITE_OK) return fails();
  const char* const setup =
      "PRAGMA locking_mode = EXCLUSIVE; PRAGMA journal_mode = WAL; PRAGMA synchronous = NORMAL;"
      "CREATE TABLE IF NOT EXISTS kept (name TEXT PRIMARY KEY, value BLOB NOT NULL) WITHOUT ROWID;"
      "BEGIN IMMEDIATE; COMMIT;";
  if (sqlite3_exec(database->connection, setup, nullptr, nullptr, nullptr) != SQLITE_OK) return fails();
  const bool ready = database->prepare("INSERT OR REPLACE INTO kept VALUES (?, ?)", database->put) && database->prepare("DELETE FROM kept WHERE name = ?", database->erase) &&
                     database->prepare("SELECT name, value FROM kept WHERE name >= ? ORDER BY name", database->from);
  if (!ready) return fails();
  problem.clear();
  return std::unique_ptr<SqliteStorage>(new SqliteStorage(std::move(database)));
}

void SqliteStorage::put(std::string_view name, dds::Octets value) {
  bind(database_->put, 1, name);
  sqlite3_bind_blob(database_->put, 2, value.empty() ? "" : static_cast<const void*>(value.data()), static_cast<int>(value.size()), SQLITE_STATIC);
  database_->run(database_->put);
}

void SqliteStorage::erase(std::string_view name) {
  bind(database_->erase, 1, name);
  database_->run(database_->erase);
}

void SqliteStorage::for_each(std::string_view prefix, const std::function<void(std::string_view name, dds::Octets value)>& visit) const {
  sqlite3_stmt* const from = database_->from;
  bind(from, 1, prefix);
  while (sqlite3_step(from) == SQLITE_ROW) {
    const std::string_view name(reinterpret_cast<const char*>(sqlite3_column_text(from, 0)), static_cast<std::size_t>(sqlite3_column_bytes(from, 0)));
    if (!name.starts_with(prefix)) break;
    const auto* const value = static_cast<const std::byte*>(sqlite3_column_blob(from, 1));
    visit(name, {value, value == nullptr ? 0 : static_cast<std::size_t>(sqlite3_column_bytes(from, 1))});
  }
  sqlite3_reset(from);
}

}  // namespace takt::storage
