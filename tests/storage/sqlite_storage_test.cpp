#include "storage/sqlite_storage.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <filesystem>

#include "dds/persistence/kept_records.hpp"

namespace takt::storage {
namespace {

namespace fs = std::filesystem;

struct Folder {
  Folder() { path = fs::temp_directory_path() / ("takt-storage-" + std::to_string(getpid())); fs::remove_all(path); fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  std::string file() const { return (path / "kept.sqlite").string(); }
  fs::path path;
};

dds::Octets octets(std::string_view text) { return std::as_bytes(std::span(text)); }
std::vector<std::pair<std::string, std::string>> all(const dds::Storage& storage, std::string_view prefix) {
  std::vector<std::pair<std::string, std::string>> found;
  storage.for_each(prefix, [&](std::string_view name, dds::Octets value) { found.emplace_back(name, std::string(reinterpret_cast<const char*>(value.data()), value.size())); });
  return found;
}

TEST(SqliteStorage, DoesWhatTheOneInMemoryDoes) {
  const Folder folder;
  std::string problem;
  const std::unique_ptr<SqliteStorage> file = SqliteStorage::open(folder.file(), problem);
  ASSERT_NE(file, nullptr) << problem;
  dds::MemoryStorage memory;
  for (dds::Storage* const storage : std::initializer_list<dds::Storage*>{file.get(), &memory}) {
    for (const char* const name : {"b/2", "a/1", "b/10", "b", "c"}) storage->put(name, octets(name));
    storage->put("b/2", octets("other"));
    storage->put("b/empty", {});
    storage->erase("b/10");
    storage->erase("none");
    EXPECT_EQ(all(*storage, "b/"), (std::vector<std::pair<std::string, std::string>>{{"b/2", "other"}, {"b/empty", ""}}));
    EXPECT_EQ(all(*storage, "").size(), 5u);
  }
}

TEST(SqliteStorage, WhatCannotBeOpenedIsToldWhy) {
  std::string problem;
  EXPECT_EQ(SqliteStorage::open("/nowhere/kept.sqlite", problem), nullptr);
  EXPECT_TRUE(problem.starts_with("/nowhere/kept.sqlite: ")) << problem;
  const Folder folder;
  const auto first = SqliteStorage::open(folder.file(), problem);
  EXPECT_EQ(SqliteStorage::open(folder.file(), problem), nullptr);
  EXPECT_NE(problem.find("locked"), std::string::npos) << problem;
}

// A writer keeps changes and is killed while it does so, again and again. What it has told of is there, and the numbers go on.
TEST(SqliteStorage, SurvivesKill9) {
  const Folder folder;
  const dds::Guid name{{{7}}, dds::EntityId::user(1, dds::EntityKind::writer_no_key)};
  std::int64_t told = 0;
  for (int round = 0; round < 5; ++round) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      close(ends[0]);
      std::string problem;
      const auto storage = SqliteStorage::open(folder.file(), problem);
      if (!storage) _exit(1);
      dds::KeptChanges kept(*storage, name, {});
      dds::CacheChange change;
      change.payload.resize(100);
      // Killed between two calls, the former one left more than was wanted.
      for (const dds::CacheChange& left : kept.changes())
        if (left.number.value <= kept.last().value - 10) kept.erase(left.number, false);
      for (std::int64_t number = kept.last().value + 1;; ++number) {
        change.number = {number};
        kept.put(change);
        if (number > 10) kept.erase({number - 10}, false);
        if (write(ends[1], &number, sizeof number) != sizeof number) _exit(1);
      }
    }
    close(ends[1]);
    std::int64_t number = 0;
    for (int i = 0; i < 40 + 13 * round; ++i) {
      ASSERT_EQ(read(ends[0], &number, sizeof number), static_cast<ssize_t>(sizeof number));
      EXPECT_GT(number, told);
      told = number;
    }
    kill(child, SIGKILL);
    while (read(ends[0], &number, sizeof number) == static_cast<ssize_t>(sizeof number)) told = number;
    waitpid(child, nullptr, 0);
    close(ends[0]);
    std::string problem;
    const auto storage = SqliteStorage::open(folder.file(), problem);
    ASSERT_NE(storage, nullptr) << problem;
    const dds::KeptChanges kept(*storage, name, {});
    EXPECT_GE(kept.last().value, told);
    EXPECT_LE(kept.last().value, told + 1);
    const std::vector<dds::CacheChange> changes = kept.changes();
    ASSERT_GE(changes.size(), 10u);
    EXPECT_LE(changes.size(), 11u);
    for (std::size_t i = 0; i < changes.size(); ++i) EXPECT_EQ(changes[changes.size() - 1 - i].number.value, kept.last().value - static_cast<std::int64_t>(i));
  }
}

}  // namespace
}  // namespace takt::storage
