// SPDX-License-Identifier: Apache-2.0
// What was said in a run that is played again, for a stranger who replays it: with the very windows of a node's
// receiver, real keys' tokens and real counts. It shares no code with the search's Recording.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "explore/model/query.hpp"
#include "explore/model/wiring.hpp"
#include "handshake/word.hpp"
#include "security/key_ring.hpp"
#include "security/replay_window.hpp"

namespace takt::explore {

class Recorder {
 public:
  struct Said {
    handshake::Word word;
    std::uint16_t sequence = 0;
    std::uint32_t sent_in = 0;
    std::size_t said_in = 0;
    security::Freshness freshness{};  ///< of the first of all messages that say so
  };

  Recorder(const Query& query, const Wiring& wiring);

  /// Said on this channel; the place of what was said, which goes on if it is what was said last.
  std::size_t say(std::size_t channel, Said said);
  void change_key(std::size_t who);
  void restart(std::size_t who);

  const Said& said_at(std::size_t channel, std::size_t place) const { return said_[wiring_.sender(channel)][place]; }
  std::size_t place(std::size_t channel, std::size_t back) const {
    return said_[wiring_.sender(channel)].size() - 1 - back;
  }
  const Said& said(std::size_t channel, std::size_t back) const { return said_at(channel, place(channel, back)); }
  /// The sequence number that a stranger gives it: its own where it is signed, else one that makes it heard and nothing
  /// else unheard.
  std::uint16_t sequence(std::size_t channel, std::size_t back) const;

  /// The hearer of this channel opens one of the messages that say so. False if it refuses.
  bool take(std::size_t channel, std::size_t place);

 private:
  struct Signer {
    std::uint32_t token = 1;
    std::uint32_t count = 0;
    std::uint16_t life = 1;
  };
  struct Windows {
    std::vector<security::StoredWindow> stored;
    std::map<std::size_t, std::uint32_t> used;  ///< by place: how many of its messages were opened
  };

  Query query_;
  Wiring wiring_;
  std::vector<Signer> signers_;
  std::vector<std::vector<Said>> said_;  ///< by sender
  std::vector<std::size_t> standing_;    ///< by channel: place of what it said last
  std::vector<std::map<std::uint32_t, std::uint16_t>>
      last_;                      ///< by sender: the last sequence number of each incarnation
  std::vector<Windows> windows_;  ///< by channel
};

}  // namespace takt::explore
