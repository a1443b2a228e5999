// A participant as it would be if the slaves had other names.
#pragma once

#include "explore/question.hpp"
#include "explore/renaming.hpp"
#include "handshake/participant.hpp"

namespace takt::explore {

using Participant = handshake::Participant<most_slaves>;

/// Its index, the origin of its intent, and for the master the order of its peers change; nothing else does.
Participant renamed(const Participant& participant, const Renaming& renaming);

}  // namespace takt::explore
