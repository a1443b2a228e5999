// SPDX-License-Identifier: Apache-2.0
// The keys of a SecurityGroup over time: which one is used to send, and which ones are taken around a change.
//
// Times are nanoseconds of a clock that all nodes of the group share well enough: they need not agree better than one
// lifetime of a key.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "security/group_key.hpp"

namespace takt::security {

/// SecurityTokenIds are never 0; the one behind the last is 1.
constexpr std::uint32_t next_token(std::uint32_t token) { return token == 0xFFFF'FFFF ? 1 : token + 1; }
/// Later in the order of serial numbers.
constexpr bool is_later_token(std::uint32_t token, std::uint32_t than) {
  return static_cast<std::int32_t>(token - than) > 0;
}

/// When which key is the current one.
struct KeySchedule {
  std::uint32_t first_token = 1;
  std::int64_t first_ns = 0;     ///< when its time begins
  std::int64_t lifetime_ns = 0;  ///< of each key; 0: the first one lasts for ever
  bool operator==(const KeySchedule&) const = default;

  /// How many changes there have been; 0 before the first key, too.
  std::uint64_t changes_until(std::int64_t now_ns) const;
  std::uint32_t token_after(std::uint64_t changes) const;
  /// How many changes lead to this token from the first one; great for those that lie before it.
  std::uint64_t place_of(std::uint32_t token) const;
};

/// Gives the octets of keys.
class KeySource {
 public:
  virtual ~KeySource() = default;
  /// Nothing if there is none for this token.
  virtual std::optional<Secret> key(std::uint32_t token) const = 0;
  virtual std::unique_ptr<KeySource> clone() const = 0;
};

/// Keys that were written down or given by a key service, one behind the other from a first token on.
class ListedKeys final : public KeySource {
 public:
  ListedKeys(std::uint32_t first_token, std::vector<Secret> keys) : first_token_(first_token), keys_(std::move(keys)) {}
  std::optional<Secret> key(std::uint32_t token) const override;
  std::unique_ptr<KeySource> clone() const override { return std::make_unique<ListedKeys>(*this); }

 private:
  std::uint32_t first_token_;
  std::vector<Secret> keys_;
};

/// Keys without end from one secret that all nodes have. With T(0) empty and T(i) = HMAC-SHA256(secret, T(i - 1) |
/// "takt SecurityGroup" | group | token | policy | i), token as 4 octets little-endian, policy (0, 1) and i (1, 2, 3)
/// as one octet, a key is the first octets of T(1) | T(2) | T(3): HKDF-Expand (RFC 5869, 2.3).
class DerivedKeys final : public KeySource {
 public:
  DerivedKeys(MessagePolicy policy, std::string group, Secret secret)
      : policy_(policy), group_(std::move(group)), secret_(std::move(secret)) {}
  std::optional<Secret> key(std::uint32_t token) const override;
  std::unique_ptr<KeySource> clone() const override { return std::make_unique<DerivedKeys>(*this); }

 private:
  MessagePolicy policy_;
  std::string group_;
  Secret secret_;
};

class KeyRing {
 public:
  KeyRing(MessagePolicy policy, const KeySchedule& schedule, std::unique_ptr<KeySource> source);

  struct Current {
    std::uint32_t token = 0;
    GroupKey* key = nullptr;  ///< lasts until the next call
  };
  /// The key to send with. Without a newer one the last goes on for two lifetimes (OPC 10000-14, 8.2); then there is
  /// none. The token never goes back, even if the clock does.
  std::optional<Current> current(std::int64_t now_ns);
  /// The clock was so far ahead, and has come back, that nobody of the group has the keys that are used here.
  bool was_ahead(std::int64_t now_ns) const { return schedule_.changes_until(now_ns) + 1 < changes_; }
  /// Goes on with the keys of now, whose nonces may have been used: with another life only.
  void come_back(std::int64_t now_ns) {
    changes_ = schedule_.changes_until(now_ns);
    used_ = 0;
  }
  /// A key to take messages with: the current one, the one before or the one behind it; null for all others.
  GroupKey* find(std::uint32_t token, std::int64_t now_ns);
  /// Of a token that `find` has no key for: whether it is a later one than the current one, so that others have keys
  /// that are missing here. True before the first keys, too.
  bool is_missing(std::uint32_t token, std::int64_t now_ns) const;

  /// Keys have come from a key service, with its schedule. A token that was used is not gone back behind: what lies
  /// before it is none to send with.
  void replace(const KeySchedule& schedule, std::unique_ptr<KeySource> source);

  const KeySchedule& schedule() const { return schedule_; }
  MessagePolicy policy() const { return policy_; }

 private:
  GroupKey* made(std::uint32_t token);

  MessagePolicy policy_;
  KeySchedule schedule_;
  std::unique_ptr<KeySource> source_;
  std::uint64_t changes_ = 0;  ///< the most that were seen
  std::uint32_t used_ = 0;     ///< token that was sent with last; 0: none
  struct Slot {
    std::uint32_t token = 0;
    std::unique_ptr<GroupKey> key;
  };
  std::array<Slot, 4> slots_;  ///< one more than are taken at a time
  std::size_t next_slot_ = 0;
};

}  // namespace takt::security
