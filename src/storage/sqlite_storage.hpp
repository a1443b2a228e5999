// SqliteStorage: dds::Storage in a file.
#pragma once

#include <memory>

#include "dds/persistence/storage.hpp"

namespace takt::storage {

/// One process at a time has a file open; a second one is told that it is locked.
class SqliteStorage final : public dds::Storage {
 public:
  /// Opens or makes the file. Without a storage, `problem` says why.
  static std::unique_ptr<SqliteStorage> open(const std::string& path, std::string& problem);
  ~SqliteStorage() override;

  /// Throws std::runtime_error if the file can no longer be written, for example because the disk is full.
  void put(std::string_view name, dds::Octets value) override;
  void erase(std::string_view name) override;
  void for_each(std::string_view prefix, const std::function<void(std::string_view name, dds::Octets value)>& visit) const override;

 private:
  struct Database;
  explicit SqliteStorage(std::unique_ptr<Database> database);
  std::unique_ptr<Database> database_;
};

}  // namespace takt::storage
