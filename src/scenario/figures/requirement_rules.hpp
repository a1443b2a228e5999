// What requirements mean together, for all who judge them: runs, bounds, the search for the worst case.
#pragma once

#include <optional>
#include <string>

#include "scenario/description/description.hpp"

namespace takt::scenario {

/// The instant from which the requirement counts: its own "after", else the scenario's "warm_up".
Duration counts_from(const Scenario& scenario, const Requirement& requirement);

/// Whether another requirement says how many frames of the stream may be lost: "dropped" or "delivered", or a limit on a figure of its losses
/// (or of those of all streams). If none does, a lost frame breaks a latency or jitter requirement of the stream: it never arrives.
/// `from`: only those that count from then or earlier, so that no loss after it is left unjudged; any if absent.
bool requires_losses_separately(const Scenario& scenario, const std::string& stream, std::optional<Duration> from = {});

/// "at most 5ms", "11.62us", "11.62us within 1ns"
std::string text_of(const DurationLimit& limit);

}  // namespace takt::scenario
