// Asks the handshake that it is linked with a list of short questions until one of them finds something wrong.
//
//   explore_probe    prints "killed PROPERTY QUESTION" or "survived", and returns 0
#include <cstdio>
#include <vector>

#include "explore/report/report.hpp"
#include "explore/search/search.hpp"

namespace takt::explore {
namespace {

struct Case {
  std::uint8_t slaves;
  std::uint32_t commands;
  std::uint32_t faults;  ///< of every class
  Network network = Network::registers;
  handshake::Subscription subscription = handshake::Subscription::Star;
  std::uint8_t inner_slaves = 0;
  bool forges = false;   ///< the only fault is a forged word
  std::uint8_t candidates = 0;
  std::uint8_t first_offers = 0xFF;  ///< the roles that the first of them can have
};

/// From short to long; together a few seconds for a handshake that is right.
const std::vector<Case>& cases() {
  static const std::vector<Case> all{{1, 3, 0},
                                     {2, 2, 0},
                                     {1, 2, 1},
                                     {2, 1, 1},
                                     {2, 1, 0, Network::registers, handshake::Subscription::AllToAll},
                                     {1, 1, 1, Network::channels},
                                     {1, 2, 0, Network::registers, handshake::Subscription::Star, 1},
                                     {1, 1, 1, Network::registers, handshake::Subscription::Star, 1},
                                     {1, 1, 1, Network::registers, handshake::Subscription::Star, 0, true},
                                     {1, 1, 0, Network::registers, handshake::Subscription::Star, 0, false, 2},
                                     {2, 1, 0, Network::registers, handshake::Subscription::Star, 0, false, 2, 2},
                                     {1, 1, 1, Network::registers, handshake::Subscription::Star, 0, false, 1}};
  return all;
}

Question question_of(const Case& each) {
  Question question;
  question.slaves = each.slaves;
  question.commands = each.commands;
  question.fault_budget = each.faults;
  question.network = each.network;
  question.subscription = each.subscription;
  question.inner_slaves = each.inner_slaves;
  question.candidates = each.candidates;
  question.offers[0] = each.first_offers;
  question.states = 20'000'000;
  if (each.faults == 0) return question;
  if (each.forges) question.faults.insert(Fault::forge);
  for (std::size_t f = 0; f < fault_count; ++f) {
    const auto fault = static_cast<Fault>(f);
    if (each.forges || fault == Fault::forge) continue;
    if ((!question.is_tree() && !question.has_roles()) || (fault != Fault::duplicate && fault != Fault::reorder)) question.faults.insert(fault);
  }
  return question;
}

int probe() {
  for (const Case& each : cases()) {
    const Question question = question_of(each);
    std::printf("%s\n", question_line(question).c_str());
    std::fflush(stdout);  // a mutant may break a CHECK
    const Answer answer = explore(question, [](const Progress&) { return true; });
    for (std::size_t p = 0; p < property_count; ++p) {
      if (answer.verdicts[p] != Verdict::violated && answer.verdicts[p] != Verdict::unreached) continue;
      // The page with the chart first, for the last two lines are what the caller looks for.
      if (question.is_tree()) std::printf("%s\n%s\n", text_report(question, answer, 0.0).c_str(), question_line(question).c_str());
      std::printf("killed %.*s\n", static_cast<int>(property_names[p].size()), property_names[p].data());
      return 0;
    }
  }
  std::puts("survived");
  return 0;
}

}  // namespace
}  // namespace takt::explore

int main() { return takt::explore::probe(); }
