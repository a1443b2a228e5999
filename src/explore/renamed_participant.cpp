#include "explore/renamed_participant.hpp"

namespace takt::explore {
namespace {

// Names of slaves stand in private members, and no protocol code has a reason to exchange them. An explicit instantiation
// may name private members ([temp.spec.general]/6), so the explorer reaches the five that it must without a word in handshake/.
template <class Tag, auto Member>
struct Grant {
  friend constexpr auto granted(Tag) { return Member; }
};

struct ConfigTag {
  friend constexpr auto granted(ConfigTag);
};
struct IntentTag {
  friend constexpr auto granted(IntentTag);
};
struct ReadyTag {
  friend constexpr auto granted(ReadyTag);
};
struct RunningTag {
  friend constexpr auto granted(RunningTag);
};
struct PeersTag {
  friend constexpr auto granted(PeersTag);
};

template struct Grant<ConfigTag, &Participant::config_>;
template struct Grant<IntentTag, &Participant::intent_>;
template struct Grant<ReadyTag, &Participant::ready_>;
template struct Grant<RunningTag, &Participant::running_>;
template struct Grant<PeersTag, &Participant::peers_>;

}  // namespace

Participant renamed(const Participant& participant, const Renaming& renaming) {
  Participant result = participant;
  const std::size_t slaves = participant.config().slaves;
  (result.*granted(ConfigTag{})).index = renaming.to[participant.config().index];
  (result.*granted(IntentTag{})).origin = renaming.to[participant.intent().origin];
  if (participant.config().role != handshake::Role::Master) return result;
  handshake::PeerSet ready = 0;
  handshake::PeerSet running = 0;
  for (std::size_t peer = 0; peer < slaves; ++peer) {
    const std::size_t other = static_cast<std::size_t>(renaming.to[peer + 1]) - 1;
    ready |= ((participant.*granted(ReadyTag{})) >> peer & 1U) << other;
    running |= ((participant.*granted(RunningTag{})) >> peer & 1U) << other;
    (result.*granted(PeersTag{}))[other] = (participant.*granted(PeersTag{}))[peer];
  }
  result.*granted(ReadyTag{}) = ready;
  result.*granted(RunningTag{}) = running;
  return result;
}

}  // namespace takt::explore
