// SPDX-License-Identifier: Apache-2.0
// A run as a message-sequence chart in text: one line of life for each participant, time runs downwards.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "explore/model/wiring.hpp"
#include "explore/report/replay.hpp"
#include "explore/search/search.hpp"

namespace takt::explore {

/// What a participant is said to be where it is down; it has no line of life then.
inline constexpr const char* down_state = "down";

/// One step of a chart: an arrow for what is heard, a mark for everything else.
struct ChartStep {
  std::string sentence;
  std::optional<std::pair<std::size_t, std::size_t>> arrow;  ///< from column to column
  std::vector<std::size_t> marked;                           ///< columns
  char mark = '*';
  std::vector<std::string> states;    ///< after it
  std::vector<std::string> findings;  ///< "violates ...", "breaks ..."
  std::vector<std::string> notes;     ///< more lines below it
  Action action;
  std::size_t actor = 0;  ///< column: who steps, or whose message it is
  Moment moment;          ///< after it
};

struct Chart {
  std::vector<std::string> names;  ///< of the columns
  std::size_t width = 13;          ///< of a column
  std::string beginning;
  std::vector<std::string> states;                ///< there
  std::vector<std::string> notes;                 ///< of the beginning
  Moment moment;                                  ///< there
  std::vector<std::vector<std::string>> origins;  ///< by column: the names that origins of intents have in its group
  std::vector<ChartStep> steps;
  std::size_t cycle = 0;  ///< of Trace
};

std::string drawn(const Chart& chart);

/// Filled up with blanks to a width; what is longer stays.
std::string padded(std::string text, std::size_t width);

/// Who takes part in an action, by name; what an action does not have is not looked at.
struct Happening {
  ActionKind kind = ActionKind::send;
  std::string who;
  std::string from;
  std::string to;
  std::string peer;
  std::string word;
  std::size_t method = 0;
  bool is_overtaking = false;  ///< `reorder`: the word overtakes; `forge`: its number is far ahead
  bool comes_up = false;       ///< `restart` of one that is down
};
std::string sentence(const Happening& happening);
/// `origin` is the name of its intent's origin.
std::string text_of(const handshake::Word& word, const std::string& origin);
constexpr char mark_of(ActionKind kind) {
  return kind == ActionKind::send ? 'o' : kind == ActionKind::crash ? 'X' : '*';
}

/// "master", "slave 1", ...
std::string participant_name(std::size_t participant);
/// What happens, in a sentence.
std::string sentence(const ReplayStep& done, const Wiring& wiring);
/// Of a single group.
Chart chart_of_group(const Query& query, const Replay& replayed);
std::string chart(const Query& query, const Replay& replayed);
/// These go through the run once more with its model (model_chart.hpp).
Chart chart_of_tree(const Query& query, const Beginning& beginning, const Trace& trace);
Chart chart_of_roles(const Query& query, const Beginning& beginning, const Trace& trace);
/// Of whatever the query is of.
Chart chart_of(const Query& query, const Beginning& beginning, const Trace& trace);
std::string chart(const Query& query, const Beginning& beginning, const Trace& trace);

}  // namespace takt::explore
