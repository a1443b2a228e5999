// SPDX-License-Identifier: Apache-2.0
// A message-sequence chart: a line of life for each participant, time runs downwards, one row for each instant.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace takt::chart {

/// Times are numbers of any unit; equal ones share a row.
struct SequenceStep {
  std::int64_t time = 0;
  std::size_t participant = 0;
  std::string text;  ///< beside a box on the line of life
};

struct SequenceMessage {
  std::int64_t sent = 0;
  std::int64_t received = 0;
  std::size_t from = 0;
  std::size_t to = 0;
  std::string text;  ///< above the arrow
};

struct SequenceChart {
  std::string title;
  std::vector<std::string> participants;
  std::vector<std::string> states;  ///< of each at the top
  std::vector<SequenceStep> steps;
  std::vector<SequenceMessage> messages;  ///< dashed arrows
  /// How a row's time is written at the margin.
  std::function<std::string(std::int64_t)> label;
};

std::string sequence_chart(const SequenceChart& chart);
/// The same as an element of a page.
std::string sequence_chart_element(const SequenceChart& chart);

}  // namespace takt::chart
