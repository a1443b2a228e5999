// SPDX-License-Identifier: Apache-2.0
// What writers and readers with a persistence GUID keep in a Storage, and find there again.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "dds/history/cache_change.hpp"
#include "dds/message/guid.hpp"
#include "dds/persistence/number_ranges.hpp"
#include "dds/persistence/storage.hpp"
#include "dds/rtps/epoch.hpp"

namespace takt::dds {

/// The changes of one writer, so that it goes on with its numbers and its history.
class KeptChanges {
 public:
  KeptChanges(Storage& storage, const Guid& writer, Epoch epoch);

  void put(const CacheChange& change);
  /// `is_last`: no change has a higher number; the number itself is remembered.
  void erase(SequenceNumber number, bool is_last);
  /// All changes, ascending. What is damaged is left out.
  std::vector<CacheChange> changes() const;
  /// The highest number that was given away.
  SequenceNumber last() const;

 private:
  Storage& storage_;
  std::string name_;
  Epoch epoch_;
};

/// The numbers that one reader has handed to its application, by writer.
class KeptNumbers {
 public:
  KeptNumbers(Storage& storage, const Guid& reader);

  void put(const Guid& writer, const NumberRanges& delivered);
  std::map<Guid, NumberRanges> all() const;

 private:
  Storage& storage_;
  std::string name_;
};

}  // namespace takt::dds
