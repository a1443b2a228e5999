// SPDX-License-Identifier: Apache-2.0
// The secured messages of a node: one channel for all of its Programs that are secured, with the keys of its file, its
// memory and the time of day.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "node/config.hpp"
#include "node/key_file.hpp"
#include "node/key_mailbox.hpp"
#include "node/security_memory.hpp"
#include "security/secure_channel.hpp"
#include "wire/verdict.hpp"

namespace takt::node {

/// What `takt ctl status` says of it. Nothing of a key.
struct SecurityStatus {
  std::string group;
  std::uint32_t token = 0;  ///< that it sends with; 0: none yet
  std::uint64_t unsealed = 0;
  std::uint32_t life = 0;
  std::uint64_t clock_returns = 0;  ///< how often the clock was ahead by more than a key, and came back
  std::optional<KeyServiceStatus> key_service = {};  ///< nothing: keys are of a file
};
const json::Record& describe(json::Type<SecurityStatus>);

class NodeSecurity {
 public:
  /// Null, and `problem` says why, if there is no memory to be had.
  /// Keys of a key service come by `mailbox`, which outlives it.
  static std::unique_ptr<NodeSecurity> make(const LoadedConfig& loaded, KeyMailbox* mailbox, std::string& problem);

  /// Empty if it cannot be sent now; counted.
  uadp::Octets seal(uadp::Octets clear) {
    install_keys();
    return channel_.seal(clear, look_at_clock());
  }
  struct Opened {
    wire::Verdict verdict = wire::Verdict::taken;
    uadp::Octets clear;
  };
  Opened open(uadp::Octets message);
  SecurityStatus status();

 private:
  NodeSecurity(std::string group, security::KeyRing keys, const security::ChannelSettings& settings,
               std::unique_ptr<SecurityMemory> memory, int clock, KeyMailbox* mailbox);
  void install_keys();
  std::int64_t now_ns() const;
  /// Now. A clock that was far ahead and has come back is followed; without that nobody would hear this node, nor it
  /// them.
  std::int64_t look_at_clock();

  std::string group_;
  std::unique_ptr<SecurityMemory> memory_;
  int clock_;
  KeyMailbox* mailbox_;  ///< null: keys are of a file
  security::SecureChannel channel_;
  std::uint64_t clock_returns_ = 0;
  KeyServiceState key_service_;  ///< as it was told last
};

}  // namespace takt::node
