// SPDX-License-Identifier: Apache-2.0
// Where the engine of a scenario listens, and what it must be given: kept for the engine that comes after a crash, so
// that pages that are open find it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace takt::studio {

struct Address {
  std::uint16_t port = 0;
  std::string token;
};

/// 128 random bits as hexadecimal digits.
std::string new_token();

/// A file for this user's eyes only, in $XDG_RUNTIME_DIR, as root in /run, otherwise in /tmp/takt-UID. One that others
/// own, can read or can write counts for nothing.
class AddressMemory {
 public:
  explicit AddressMemory(const std::string& scenario);
  std::optional<Address> last() const;
  void keep(const Address& address) const;
  /// The path of a page that leads to the address: a browser is given that, since command lines are everybody's to
  /// read. Nothing if it cannot be written.
  std::optional<std::string> door(const std::string& address) const;
  /// An engine that ends in good order leaves nothing; what another one has kept stays.
  void forget(const Address& own) const;

 private:
  bool write(const std::string& path, const std::string& content) const;

  std::string folder_;
  std::string path_;
};

}  // namespace takt::studio
