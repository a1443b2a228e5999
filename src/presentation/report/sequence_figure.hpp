// SPDX-License-Identifier: Apache-2.0
// A part of a run as a message-sequence chart.
#pragma once

#include <cstddef>
#include <string>

#include "chart/sequence_chart.hpp"
#include "report/message_log.hpp"
#include "scenario/run/run.hpp"

namespace takt::report {

/// How changes and messages are numbered.
enum class Numbers : std::uint8_t {
  none,
  start,   ///< as Fig. 3 of the paper, with the first process data
  side_a,  ///< as Fig. 4 (a) to 6 (a)
  side_b,
};

struct Excerpt {
  std::string title;
  std::size_t program = 0;
  sim::TrueTime from;  ///< the call
  sim::TrueTime to;
  std::string call;  ///< "Start": stands with the first change
  Numbers numbers = Numbers::none;
};

/// Each change of state, and the message by which each other participant hears of it first. `log` is of that program.
chart::SequenceChart sequence_of(const scenario::Run& run, const MessageLog& log, const Excerpt& excerpt);

}  // namespace takt::report
