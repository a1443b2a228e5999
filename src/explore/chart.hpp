// A run as a message-sequence chart in text: one line of life for each participant, time runs downwards.
#pragma once

#include <string>

#include "explore/question.hpp"
#include "explore/replay.hpp"
#include "explore/wiring.hpp"

namespace takt::explore {

/// "master", "slave 1", ...
std::string participant_name(std::size_t participant);
/// What happens, in a sentence.
std::string sentence(const Told& told, const Wiring& wiring);
std::string chart(const Question& question, const Story& story);

}  // namespace takt::explore
