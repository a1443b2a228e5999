// SPDX-License-Identifier: Apache-2.0
#include "study/store.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "sim/digest.hpp"
#include "study/sql.hpp"

namespace takt::study {
namespace {

// Columns f0, f1 ... and m0, m1 ... are one for each factor and measure; the view gives them their names.
std::string tables_of(std::size_t factors, std::size_t measures) {
  std::string levels;
  for (std::size_t i = 0; i < factors; ++i) levels += fmt::format(", f{} INTEGER NOT NULL", i);
  std::string values;
  for (std::size_t i = 0; i < measures; ++i) values += fmt::format(", m{} REAL", i);
  return "CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;"
         "CREATE TABLE factor(id INTEGER PRIMARY KEY, name TEXT NOT NULL, unit TEXT NOT NULL, logarithmic INTEGER NOT "
         "NULL);"
         "CREATE TABLE level(factor INTEGER, id INTEGER, text TEXT NOT NULL, number REAL, PRIMARY KEY(factor, id)) "
         "WITHOUT ROWID;"
         "CREATE TABLE measure(id INTEGER PRIMARY KEY, name TEXT NOT NULL, unit TEXT NOT NULL);"
         "CREATE TABLE basis(measure INTEGER PRIMARY KEY, name TEXT NOT NULL);"
         "CREATE TABLE limits(id INTEGER PRIMARY KEY, measure INTEGER NOT NULL, is_upper INTEGER NOT NULL, value REAL "
         "NOT NULL, text TEXT NOT NULL);"
         "CREATE TABLE variant(id INTEGER PRIMARY KEY" +
         levels +
         ");"
         "CREATE TABLE point(id INTEGER PRIMARY KEY, variant INTEGER NOT NULL, replication INTEGER NOT NULL, seed TEXT "
         "NOT NULL, status TEXT NOT NULL,"
         " pass INTEGER NOT NULL, verdict TEXT NOT NULL, digest TEXT NOT NULL, events INTEGER NOT NULL, cpu_us INTEGER "
         "NOT NULL, error TEXT NOT NULL" +
         values + ");";
}

/// Names as columns: points with the levels' texts and the measures.
std::string view_of(const Plan& plan) {
  std::string columns = "p.id AS point, p.replication, p.seed, p.status, p.pass, p.verdict, p.digest, p.error";
  std::string joins;
  for (std::size_t i = 0; i < plan.factors.size(); ++i) {
    columns += fmt::format(", coalesce(l{0}.number, l{0}.text) AS \"{1}\"", i, plan.factors[i].name);
    joins += fmt::format(" JOIN level l{0} ON l{0}.factor = {0} AND l{0}.id = v.f{0}", i);
  }
  for (std::size_t i = 0; i < plan.measures.size(); ++i)
    columns += fmt::format(", p.m{} AS \"{}\"", i, plan.measures[i].name);
  return "CREATE VIEW result AS SELECT " + columns + " FROM point p JOIN variant v ON v.id = p.variant" + joins + ";";
}

/// One row; keeps the first problem, after which nothing more is put.
void run(sqlite3* database, Statement& insert, std::string& problem) {
  if (!problem.empty()) return;
  insert.step();
  if (insert.failed()) problem = problem_of(database);
  insert.reset();
}

void put_meta(sqlite3* database, std::string_view key, const std::string& value, std::string& problem) {
  Statement insert(database, "INSERT INTO meta VALUES(?, ?)");
  insert.bind(0, key);
  insert.bind(1, std::string_view(value));
  run(database, insert, problem);
}

void put_factors(sqlite3* database, const Plan& plan, std::string& problem) {
  Statement insert(database, "INSERT INTO factor VALUES(?, ?, ?, ?)");
  Statement insert_level(database, "INSERT INTO level VALUES(?, ?, ?, ?)");
  for (std::size_t f = 0; f < plan.factors.size(); ++f) {
    const PlannedFactor& factor = plan.factors[f];
    insert.bind(0, static_cast<std::int64_t>(f));
    insert.bind(1, std::string_view(factor.name));
    insert.bind(2, std::string_view(factor.unit));
    insert.bind(3, std::int64_t{factor.is_logarithmic});
    run(database, insert, problem);
    for (std::size_t i = 0; i < factor.levels.size(); ++i) {
      insert_level.bind(0, static_cast<std::int64_t>(f));
      insert_level.bind(1, static_cast<std::int64_t>(i));
      insert_level.bind(2, std::string_view(factor.levels[i].text));
      if (factor.levels[i].number)
        insert_level.bind(3, *factor.levels[i].number);
      else
        insert_level.bind_null(3);
      run(database, insert_level, problem);
    }
  }
}

void put_measures(sqlite3* database, const Plan& plan, std::string& problem) {
  Statement insert(database, "INSERT INTO measure VALUES(?, ?, ?)");
  for (std::size_t i = 0; i < plan.measures.size(); ++i) {
    insert.bind(0, static_cast<std::int64_t>(i));
    insert.bind(1, std::string_view(plan.measures[i].name));
    insert.bind(2, std::string_view(plan.measures[i].unit));
    run(database, insert, problem);
  }
  Statement insert_basis(database, "INSERT INTO basis VALUES(?, ?)");
  for (std::size_t i = 0; i < plan.measures.size(); ++i) {
    insert_basis.bind(0, static_cast<std::int64_t>(i));
    insert_basis.bind(1, name_of(plan.measures[i].basis));
    run(database, insert_basis, problem);
  }
  Statement insert_limit(database, "INSERT INTO limits VALUES(?, ?, ?, ?, ?)");
  for (std::size_t i = 0; i < plan.limits.size(); ++i) {
    insert_limit.bind(0, static_cast<std::int64_t>(i));
    insert_limit.bind(1, static_cast<std::int64_t>(plan.limits[i].measure));
    insert_limit.bind(2, std::int64_t{plan.limits[i].is_upper()});
    insert_limit.bind(3, plan.limits[i].value);
    insert_limit.bind(4, std::string_view(plan.limits[i].text));
    run(database, insert_limit, problem);
  }
}

void put_variants(sqlite3* database, const Plan& plan, std::string& problem) {
  std::string holes = "?";
  for (std::size_t f = 0; f < plan.factors.size(); ++f) holes += ", ?";
  Statement insert(database, "INSERT INTO variant VALUES(" + holes + ")");
  for (std::size_t v = 0; v < plan.variants.size(); ++v) {
    insert.bind(0, static_cast<std::int64_t>(v));
    for (std::size_t f = 0; f < plan.factors.size(); ++f)
      insert.bind(static_cast<int>(f) + 1, std::int64_t{plan.variants[v][f]});
    run(database, insert, problem);
  }
}

sqlite3* open_database(const std::string& path, int flags, std::string& problem) {
  sqlite3* database = nullptr;
  if (sqlite3_open_v2(path.c_str(), &database, flags, nullptr) != SQLITE_OK) {
    problem = database == nullptr ? "no memory" : sqlite3_errmsg(database);
    sqlite3_close(database);
    return nullptr;
  }
  sqlite3_extended_result_codes(database, 0);
  sqlite3_busy_timeout(database, 10'000);
  return database;
}

// In WAL mode NORMAL waits for the disk at checkpoints only: a killed process loses nothing, a power cut perhaps the
// last points, and neither damages the file.
constexpr const char* modes = "PRAGMA journal_mode=WAL; PRAGMA synchronous=NORMAL;";

void remove_files(const std::string& path) {
  for (const char* const suffix : {"", "-wal", "-shm", "-journal"}) std::remove((path + suffix).c_str());
}

/// If it cannot be made, whoever opens the file says so.
void make_folder_of(const std::string& path) {
  std::error_code untold;
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder, untold);
}

std::uint64_t hash_of(std::uint64_t hash, std::string_view text) {
  for (const char c : text) hash = sim::mix64(hash ^ static_cast<unsigned char>(c)) + 0x9E3779B97F4A7C15ULL;
  return sim::mix64(hash + text.size());
}

}  // namespace

std::unique_ptr<Store> Store::create(const std::string& path, const Plan& plan, std::string& problem) {
  if (std::filesystem::exists(path)) {
    problem = path + " is there already: go on with it by --resume, or name another one by --out";
    return nullptr;
  }
  make_folder_of(path);
  // Under another name until it is one: who is killed before leaves nothing that is neither a store nor absent.
  const std::string unfinished = path + ".new";
  remove_files(unfinished);
  std::unique_ptr<Store> store(new Store);
  store->database_ = open_database(unfinished, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, problem);
  if (store->database_ == nullptr) return problem = path + ": " + problem, nullptr;
  sqlite3* const database = store->database_;
  if (problem.empty())
    problem = execute(database, "BEGIN;" + tables_of(plan.factors.size(), plan.measures.size()) + view_of(plan));
  if (problem.empty()) {
    put_meta(database, "schema", std::to_string(store_version), problem);
    put_meta(database, "takt", results::this_takt().version, problem);
    put_meta(database, "behaviour", std::to_string(results::behaviour()), problem);
    put_meta(database, "study", plan.study.name, problem);
    put_meta(database, "digest", fmt::format("{:016x}", plan.digest), problem);
    put_meta(database, "configuration", plan.text, problem);
    put_meta(database, "variants", std::to_string(plan.variants.size()), problem);
    put_meta(database, "replications", std::to_string(plan.study.replications.count), problem);
    put_factors(database, plan, problem);
    put_measures(database, plan, problem);
    put_variants(database, plan, problem);
    if (problem.empty()) problem = execute(database, "COMMIT");
  }
  store.reset();
  if (problem.empty() && std::rename(unfinished.c_str(), path.c_str()) != 0) problem = std::strerror(errno);
  if (problem.empty()) {
    store = open(path, problem);
    if (!store) return nullptr;
    problem = execute(store->database_, modes);
    if (problem.empty()) return store;
    store.reset();
    remove_files(path);
  }
  problem = path + ": " + problem;
  remove_files(unfinished);
  return nullptr;
}

std::unique_ptr<Store> Store::open(const std::string& path, std::string& problem) {
  if (!std::filesystem::exists(path)) return problem = path + ": there is no such file", nullptr;
  std::unique_ptr<Store> store(new Store);
  store->database_ = open_database(path, SQLITE_OPEN_READWRITE, problem);
  if (store->database_ == nullptr) return problem = path + ": " + problem, nullptr;
  problem = execute(store->database_, "PRAGMA synchronous=NORMAL;");
  if (problem.empty()) problem = store->read_header();
  if (problem.empty()) return store;
  problem = path + ": " + problem;
  return nullptr;
}

Store::~Store() {
  delete static_cast<Statement*>(insert_);
  sqlite3_close(database_);
}

std::string Store::read_header() {
  Statement select(database_, "SELECT key, value FROM meta");
  if (!select.is_sound()) return "it is no store of a study";
  std::string version;
  while (select.step()) {
    const std::string key = select.text(0);
    const std::string value = select.text(1);
    if (key == "schema") version = value;
    if (key == "takt") header_.maker.version = value;
    if (key == "behaviour")
      header_.maker.behaviour = static_cast<std::uint32_t>(std::strtoul(value.c_str(), nullptr, 10));
    if (key == "study") header_.name = value;
    if (key == "digest") header_.digest = value;
    if (key == "configuration") header_.configuration = value;
    if (key == "variants") header_.variants = std::strtoull(value.c_str(), nullptr, 10);
    if (key == "replications") header_.replications = std::strtoull(value.c_str(), nullptr, 10);
  }
  if (version != std::to_string(store_version))
    return "its tables have version " + version + ", this takt knows version " + std::to_string(store_version);
  return {};
}

std::string Store::add(const Plan& plan, std::uint64_t point, const Outcome& outcome) {
  if (insert_ == nullptr) {
    std::string holes = "?";
    for (std::size_t i = 0; i < 10 + plan.measures.size(); ++i) holes += ", ?";
    insert_ = new Statement(database_, "INSERT OR IGNORE INTO point VALUES(" + holes + ")");
  }
  Statement& insert = *static_cast<Statement*>(insert_);
  if (!insert.is_sound()) return problem_of(database_);
  insert.bind(0, static_cast<std::int64_t>(point));
  insert.bind(1, static_cast<std::int64_t>(plan.variant_of(point)));
  insert.bind(2, std::int64_t{plan.replication_of(point)});
  insert.bind(3, std::string_view(std::to_string(plan.seed_of(point))));
  insert.bind(4, name_of(outcome.status));
  insert.bind(5, std::int64_t{outcome.passes});
  insert.bind(6, std::string_view(outcome.verdict));
  insert.bind(
      7, std::string_view(outcome.status == Status::done ? fmt::format("{:016x}", outcome.digest) : std::string()));
  insert.bind(8, static_cast<std::int64_t>(outcome.events));
  insert.bind(9, static_cast<std::int64_t>(outcome.cpu_us));
  insert.bind(10, std::string_view(outcome.error));
  for (std::size_t i = 0; i < plan.measures.size(); ++i) {
    const int column = 11 + static_cast<int>(i);
    if (i < outcome.values.size() && outcome.values[i])
      insert.bind(column, *outcome.values[i]);
    else
      insert.bind_null(column);
  }
  insert.step();  // a transaction of its own
  const std::string problem = insert.failed() ? problem_of(database_) : std::string();
  insert.reset();
  return problem;
}

std::string Store::finished(std::vector<bool>& points) const {
  points.assign(header_.points(), false);
  Statement select(database_, "SELECT id FROM point");
  while (select.step())
    if (const auto id = static_cast<std::uint64_t>(select.integer(0)); id < points.size()) points[id] = true;
  return select.failed() ? problem_of(database_) : std::string();
}

std::string Store::results_digest(std::uint64_t& digest, std::uint64_t& count) const {
  digest = 0;
  count = 0;
  Statement select(database_, "SELECT * FROM point ORDER BY id");
  std::size_t columns = 11;
  Statement measures(database_, "SELECT count(*) FROM measure");
  if (measures.step()) columns += static_cast<std::size_t>(measures.integer(0));
  while (select.step()) {
    ++count;
    for (std::size_t i = 0; i < columns; ++i) {
      if (i == 9) continue;  // CPU time
      if (i < 11) {
        digest = hash_of(digest, select.text(static_cast<int>(i)));
        continue;
      }
      const auto value = select.real(static_cast<int>(i));
      std::uint64_t bits = 1;
      if (value) std::memcpy(&bits, &*value, sizeof bits);
      digest = sim::mix64(digest ^ bits);
    }
  }
  return select.failed() ? problem_of(database_) : std::string();
}

void Store::tidy() { execute(database_, "PRAGMA wal_checkpoint(TRUNCATE);"); }

namespace {

/// Joins one part into the open store. The problem, or "".
std::string join(sqlite3* database, const std::string& part) {
  Statement attach(database, "ATTACH ? AS part");
  attach.bind(0, std::string_view(part));
  attach.step();
  if (attach.failed()) return problem_of(database);
  std::string problem;
  {
    Statement conflict(database,
                       "SELECT a.id FROM main.point a JOIN part.point b ON a.id = b.id WHERE a.digest <> b.digest OR "
                       "a.status <> b.status LIMIT 1");
    if (conflict.step())
      problem = "point " + std::to_string(conflict.integer(0)) + " has another result than in the parts before";
    if (conflict.failed()) problem = problem_of(database);
  }
  if (problem.empty()) problem = execute(database, "INSERT OR IGNORE INTO main.point SELECT * FROM part.point");
  const std::string detached = execute(database, "DETACH part");
  return problem.empty() ? detached : problem;
}

}  // namespace

std::string why_not_resumed(const StoreHeader& header, const Plan& plan, const std::string& path) {
  const std::string digest = fmt::format("{:016x}", plan.digest);
  if (header.digest != digest)
    return fmt::format("{} is of another study or an older state of this one (\"{}\" {}, now {})", path, header.name,
                       header.digest, digest);
  const std::string difference = results::difference_to(header.maker, path);
  return difference.empty()
             ? difference
             : difference + ". Go on with a takt of that number, or run the study anew into another store";
}

std::string merge_stores(const std::string& path, const std::vector<std::string>& parts) {
  if (std::filesystem::exists(path)) return path + " is there already";
  std::optional<StoreHeader> first;
  for (const std::string& part : parts) {
    std::string problem;
    const auto store = Store::open(part, problem);
    if (!store) return problem;
    const StoreHeader& header = store->header();
    if (!first) first = header;
    if (header.digest != first->digest)
      return fmt::format("{} is of another study than {} (\"{}\" {}, \"{}\" {})", part, parts.front(), header.name,
                         header.digest, first->name, first->digest);
    if (header.maker.behaviour != first->maker.behaviour)
      return fmt::format(
          "{} was made by {}, {} by {}: their points cannot be compared. Run one of them anew, with the takt of the "
          "other",
          part, results::name_of(header.maker), parts.front(), results::name_of(first->maker));
    store->tidy();
  }
  make_folder_of(path);
  // Whole or not at all: under another name until it is complete.
  const std::string unfinished = path + ".tmp";
  remove_files(unfinished);
  std::error_code error;
  std::filesystem::copy_file(parts.front(), unfinished, error);
  std::string problem = error ? unfinished + ": " + error.message() : std::string();
  if (problem.empty()) {
    const auto store = Store::open(unfinished, problem);
    for (std::size_t i = 1; store && problem.empty() && i < parts.size(); ++i) {
      problem = join(store->handle(), parts[i]);
      if (!problem.empty()) problem = parts[i] + ": " + problem;
    }
    if (store) store->tidy();
  }
  if (problem.empty()) {
    std::filesystem::rename(unfinished, path, error);
    if (error) problem = path + ": " + error.message();
  }
  if (!problem.empty() || error) remove_files(unfinished);
  std::remove((unfinished + "-wal").c_str());
  std::remove((unfinished + "-shm").c_str());
  return problem;
}

}  // namespace takt::study
