// From runs to the pictures of the paper.
#pragma once

#include <span>
#include <string>

#include "papers/message_log.hpp"
#include "papers/programs.hpp"

namespace takt::papers {

/// Fig. 1: the state machine, from the table that the code runs on.
std::string state_machine_chart();

/// A part of a run as a message-sequence chart.
struct Excerpt {
  std::string title;
  sim::TrueTime from;             ///< the call
  sim::TrueTime to;
  std::string call;               ///< "Start at master"
  std::size_t caller = 0;
  char side = 0;                  ///< 'a' or 'b' behind the numbers of Fig. 4 to 6; 0: numbered as in Fig. 3, process data too
};

std::string sequence_of(const scenario::Run& run, const MessageLog& log, const Excerpt& excerpt);

/// Simulated maxima (solid) and bounds (dashed) of each reaction over the rows of a table.
std::string reactions_chart(const BeyondTable& table);

}  // namespace takt::papers
