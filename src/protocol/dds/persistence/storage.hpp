// SPDX-License-Identifier: Apache-2.0
// Storage: where what must survive a restart is kept, by name.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "dds/message/octets.hpp"

namespace takt::dds {

/// Names are text. When put() or erase() returns, the change survives the end of this process, whatever ends it.
class Storage {
 public:
  virtual ~Storage() = default;
  /// Replaces what the name had.
  virtual void put(std::string_view name, Octets value) = 0;
  virtual void erase(std::string_view name) = 0;
  /// All names that begin with `prefix`, ascending. `visit` changes nothing here.
  virtual void for_each(std::string_view prefix,
                        const std::function<void(std::string_view name, Octets value)>& visit) const = 0;
};

/// Survives whoever uses it, not the process: for simulated restarts and tests.
class MemoryStorage final : public Storage {
 public:
  void put(std::string_view name, Octets value) override { values_[std::string(name)] = {value.begin(), value.end()}; }
  void erase(std::string_view name) override {
    if (const auto at = values_.find(name); at != values_.end()) values_.erase(at);
  }
  void for_each(std::string_view prefix,
                const std::function<void(std::string_view name, Octets value)>& visit) const override {
    for (auto at = values_.lower_bound(prefix); at != values_.end() && at->first.starts_with(prefix); ++at)
      visit(at->first, at->second);
  }
  std::size_t size() const { return values_.size(); }

 private:
  std::map<std::string, std::vector<std::byte>, std::less<>> values_;
};

}  // namespace takt::dds
