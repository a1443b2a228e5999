// SPDX-License-Identifier: Apache-2.0
// Who has heard what of whom at one moment of a run: taken from the participants themselves, together with the steps in
// which it was said and heard.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "explore/model/members.hpp"
#include "handshake/word.hpp"

namespace takt::explore {

/// The word that one participant has heard last of another one, and taken. Participants are columns of a chart; steps
/// count from 1, 0 is before the first one.
struct Heard {
  std::size_t who = 0;
  std::size_t of = 0;
  bool ever = false;  ///< false: nothing yet, or it remembers nothing of it any more
  handshake::Word word;
  std::size_t said_in = 0;  ///< step in which it was put into the register or channel
  std::size_t heard_in = 0;
  bool forged = false;    ///< a stranger has said it
  bool replayed = false;  ///< a stranger has handed it over; the other one had said it
  bool operator==(const Heard&) const = default;
};

/// After a step.
struct Moment {
  std::vector<std::optional<handshake::Word>>
      says;                  ///< by column: what it would publish now; nothing where it is down or has no role
  std::vector<Heard> heard;  ///< of all who are up, in the same order at all times
};

/// Whether that is what the participant remembers of this peer.
template <std::size_t MaxPeers>
bool is_remembered(const handshake::Participant<MaxPeers>& participant, std::size_t peer, const Heard& heard) {
  const typename handshake::Participant<MaxPeers>::Known known = participant.known_of(peer);
  if (participant.config().variant == handshake::Variant::paper) return known.state == heard.word.state;
  return known.heard == heard.ever && (!heard.ever || (known.state == heard.word.state && known.run == heard.word.run &&
                                                       known.incarnation == heard.word.incarnation));
}

}  // namespace takt::explore
