// SPDX-License-Identifier: Apache-2.0
#include "explore/model/forgery.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::explore {
namespace {

using handshake::Intent;
using handshake::IntentKind;
using handshake::PublishedState;
using handshake::Variant;
using handshake::Word;

constexpr std::uint32_t stranger = 0x7777;  ///< no participant's incarnation

template <class Value>
void keep_each_once(std::vector<Value>& values) {
  std::vector<Value> once;
  for (const Value& value : values)
    if (std::find(once.begin(), once.end(), value) == once.end()) once.push_back(value);
  values = std::move(once);
}

/// Around the present number, at both ends of what is later and of what is earlier, opposite, and the last one.
std::vector<std::uint32_t> numbers_around(std::uint32_t number) {
  constexpr std::uint32_t quarter = 1U << 30;
  const std::uint32_t base = number == 0 ? 1 : number;
  std::vector<std::uint32_t> numbers{0,
                                     base - 1,
                                     base,
                                     base + 1,
                                     base + 2,
                                     base + quarter - 1,
                                     base + quarter,
                                     base + 2 * quarter,
                                     base + 3 * quarter,
                                     base + 3 * quarter + 1,
                                     0xFFFF'FFFFU};
  keep_each_once(numbers);
  return numbers;
}

class Forger {
 public:
  Forger(const Word& said, std::size_t slaves) : said_(said), slaves_(slaves) {
    const std::uint32_t lives =
        (said.intent.run | said.run) != 0 ? std::max(said.intent.run, said.run) >> 16 : 1;  // of the master
    masters_ = {lives, stranger};
    runs_ = {said.run, said.intent.run, handshake::run_of(lives, handshake::next_number(said.intent.number)),
             handshake::run_of(stranger, 1)};
    std::erase(runs_, 0U);
    keep_each_once(runs_);
  }

  std::vector<Letter> all() {
    for (const std::uint32_t number : numbers_around(said_.intent.number)) {
      for (const std::uint32_t master : masters_)
        add_intent({number, IntentKind::Start, 0, handshake::run_of(master, number)});
      for (std::size_t origin = 0; origin <= slaves_; ++origin) {
        const auto by = static_cast<std::uint8_t>(origin);
        add_intent({number, IntentKind::Halt, by, 0});
        for (const IntentKind kind : {IntentKind::Resume, IntentKind::Suspend, IntentKind::Finish, IntentKind::Reset})
          for (const std::uint32_t run : runs_) add_intent({number, kind, by, run});
      }
    }
    keep_each_once(letters_);
    TAKT_CHECK(letters_.size() <= most_forgeries, "what a stranger may say is bounded");
    return std::move(letters_);
  }

 private:
  void add_intent(const Intent& intent) {
    for (std::size_t state = 0; state < handshake::published_state_count; ++state) {
      add({said_.incarnation, handshake::published_state_at(state), intent, 0});
      for (const std::uint32_t run : runs_) add({said_.incarnation, handshake::published_state_at(state), intent, run});
      add({said_.incarnation, handshake::published_state_at(state), intent, intent.run});
    }
  }
  /// With another incarnation the sequence number says nothing: the true one's next word is a first one again.
  void add(Word word) {
    if (!handshake::is_valid(word, Variant::robust, slaves_)) return;
    letters_.push_back({word, false});
    letters_.push_back({word, true});
    word.incarnation = stranger;
    letters_.push_back({word, false});
  }

  Word said_;
  std::size_t slaves_;
  std::vector<std::uint32_t> masters_;
  std::vector<std::uint32_t> runs_;
  std::vector<Letter> letters_;
};

}  // namespace

std::vector<Letter> forgeries(const Word& said, std::size_t slaves) { return Forger(said, slaves).all(); }

}  // namespace takt::explore
