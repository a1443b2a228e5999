// SPDX-License-Identifier: Apache-2.0
// Accounts that are kept from an instant on: each requirement is judged by what began when it says.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "sim/check.hpp"
#include "sim/time.hpp"

namespace takt::scenario {

/// One account for each instant. What begins at an instant or later goes into its account, so one sample may go into
/// several. `Time` is that of the clock by which the instants are told: TrueTime, or LocalTime of who sees nothing but
/// its host's clock.
template <class Account, class Time = sim::TrueTime>
class Accounts {
 public:
  explicit Accounts(std::span<const sim::Duration> instants) {
    for (const sim::Duration from : instants) accounts_.push_back({from, first_of(from), Account()});
  }

  /// Calls enter(account) for each account that counts what began then.
  template <class Enter>
  void add(Time began, Enter&& enter) {
    for (One& one : accounts_)
      if (began >= one.first) enter(one.account);
  }
  /// Calls visit(account, first) for every account; `first` is the least time that it counts.
  template <class Visit>
  void for_each(Visit&& visit) {
    for (One& one : accounts_) visit(one.account, one.first);
  }
  /// The account that begins at that instant. Precondition: there is one.
  const Account& from(sim::Duration instant) const {
    const auto found =
        std::find_if(accounts_.begin(), accounts_.end(), [&](const One& one) { return one.from == instant; });
    TAKT_CHECK(found != accounts_.end(), "figures are asked of instants from which accounts are kept");
    return found->account;
  }

 private:
  struct One {
    sim::Duration from;
    Time first;
    Account account;
  };
  /// An account from the start has everything, also what a clock that is slow at the start calls negative.
  static Time first_of(sim::Duration from) {
    return from == sim::Duration() ? Time::from_ps(std::numeric_limits<std::int64_t>::min()) : Time() + from;
  }

  std::vector<One> accounts_;
};

}  // namespace takt::scenario
