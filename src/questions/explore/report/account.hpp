// SPDX-License-Identifier: Apache-2.0
// What can be said of a run of which it is known who has heard what: since when, and because of what. For
// knowledge.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "explore/report/knowledge.hpp"

namespace takt::explore {

/// How a run ends: in a step that violates, in a state in which nothing changes any more, or in steps that repeat for
/// ever.
enum class Ending : std::uint8_t { violation, standstill, cycle };

/// "master takes slave 1 for Running, said in step 2, heard in step 3; it is Suspended since step 4".
std::string text_of(const Belief& belief);

/// Moments are numbered: 0 is the beginning, n is after step n.
class Account {
 public:
  explicit Account(const Chart& chart) : chart_(&chart) {}

  Ending ending(Property property) const;
  /// Who changes in a step, or takes it without changing: a column.
  std::size_t doer(std::size_t step) const;
  /// What is known at a moment. `cause`: whose knowledge decided the step.
  std::vector<Belief> beliefs(std::size_t moment, std::optional<std::size_t> cause) const;
  std::vector<std::string> why(Property property) const;

 private:
  using Steps = std::set<std::size_t>;

  const Moment& moment(std::size_t moment) const {
    return moment == 0 ? chart_->moment : chart_->steps[moment - 1].moment;
  }
  const std::string& state(std::size_t moment, std::size_t column) const {
    return moment == 0 ? chart_->states[column] : chart_->steps[moment - 1].states[column];
  }
  const Heard* heard(std::size_t moment, std::size_t who, std::size_t of) const;
  bool says_the_same(std::size_t moment, std::size_t other, std::size_t column) const;
  std::string says(std::size_t moment, std::size_t column) const;
  std::string word_text(const handshake::Word& word, std::size_t of) const;
  bool is_true(std::size_t moment, const Heard& heard) const;
  /// The moment since which a participant says what it says at this one.
  std::size_t since(std::size_t moment, std::size_t column) const;
  /// What the other one has said in between and the hearer has never heard.
  std::string missed(std::size_t moment, const Heard& heard) const;
  Belief belief(std::size_t moment, const Heard& heard) const;

  /// Sentences. What they refer to goes into `earlier`, if it is before the step that is told.
  std::string trigger(std::size_t step, Steps& earlier) const;
  std::string known(std::size_t moment, const Heard& heard, Steps& earlier) const;
  std::string truth(std::size_t moment, const Heard& heard, Steps& earlier) const;
  std::string change(std::size_t step, Steps& earlier) const;
  void describe_knowledge(std::size_t step, std::vector<std::string>& told, Steps& earlier) const;
  void describe_query(std::vector<std::string>& told) const;
  void describe_deadlock(std::vector<std::string>& told, Steps& earlier) const;
  void describe_cycle(std::vector<std::string>& told, Steps& earlier) const;
  /// Who changes its state in a step; whoever takes it if nobody does.
  std::vector<std::size_t> changing(std::size_t step) const;

  const Chart* chart_;
};

}  // namespace takt::explore
