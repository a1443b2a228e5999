// The ghost observer of a group: sees every participant from outside and checks S1 to S5. No protocol code asks it.
//
//   S1 nobody is Running in a run before all were Ready in it
//   S2 the master is Running only after all slaves were Running in it
//   S3 process data counts only between two that are Running in the same run
//   S4 from Halted to Running only through INIT
//   S5 only the nine transitions (and INIT entered and left)
//
// "Were" is meant: somebody may have halted since, and nobody can know that at once.
//
// The run is the word's run in `robust`. `paper` has none, so there the observer judges each participant by its own
// *round*: it begins when the participant enters INIT, or becomes Ready by a reset or a finish. Then S1 reads: since
// the round of the one that goes to Running began, each participant has at some time been Ready (one that was Ready
// already and stays so counts); S2: since the master's round began, each slave has become Running; S3: the data was
// sent by one that was Running, after the receiver's round began. That is as much as the states alone can mean: it
// blames nobody who was merely overtaken by a halt, and it does not see that somebody who has missed a halt is Ready
// from before.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "handshake/participant.hpp"

namespace takt::handshake {

enum class Invariant : std::uint8_t { S1, S2, S3, S4, S5 };

enum class Finding : std::uint8_t {
  RunningBeforeAllReady,      ///< S1
  MasterBeforeSlaves,         ///< S2
  DataOfOneNotRunning,        ///< S3: the sender was not Running when it sent
  DataToOneNotRunning,        ///< S3
  DataOfAnotherRun,           ///< S3
  RunningWithoutInit,         ///< S4
  NoSuchTransition,           ///< S5: not in the table
  StateJumped,                ///< S5: the change does not begin where the last one ended
};

struct Violation {
  Invariant invariant = Invariant::S1;
  Finding finding = Finding::RunningBeforeAllReady;
  std::uint8_t participant = 0;  ///< who did it; for S3 the receiver
  constexpr bool operator==(const Violation&) const = default;
};

constexpr std::string_view name_of(Invariant invariant) {
  constexpr std::string_view names[]{"S1", "S2", "S3", "S4", "S5"};
  return names[static_cast<std::size_t>(invariant)];
}
constexpr std::string_view text_of(Finding finding) {
  constexpr std::string_view texts[]{"is Running in a run in which not all have been Ready",
                                     "is master and Running before all slaves have been Running",
                                     "was given process data of a sender that was not Running",
                                     "was given process data while it was not Running",
                                     "was given process data of another run",
                                     "is Running without INIT since it was Halted",
                                     "took a transition that does not exist",
                                     "took a transition that does not leave its state"};
  return texts[static_cast<std::size_t>(finding)];
}

/// A value: copied, compared and hashed with the participants it watches. Participant 0 is the master.
class GroupObserver {
 public:
  static constexpr std::size_t max_participants = 65;

  GroupObserver(Variant variant, std::size_t participants);

  /// All changes of one step and the word after it. Enough by itself, besides restarts and process data.
  void on_step(std::size_t participant, const Outputs& outputs, const Word& after);
  void on_transition(std::size_t participant, StateChange change, const Word& after);
  /// The word has changed without a transition: in `robust` one that is Ready may join a new run so.
  void on_word(std::size_t participant, const Word& after);
  /// It is new: Halted, and it knows nothing.
  void on_restart(std::size_t participant);

  /// The run (`paper`: the number of rounds begun so far by anybody) in which a participant that is Running sends now;
  /// 0 if it is not Running. Goes with each process-data message.
  std::uint32_t sending_run(std::size_t participant) const;
  /// An application has been given process data that was sent when the sender's sending_run was `sent_in`.
  void on_process_data(std::size_t from, std::size_t to, std::uint32_t sent_in);

  /// In the order of their discovery.
  std::span<const Violation> violations() const { return violations_; }

  bool operator==(const GroupObserver&) const = default;
  std::uint64_t hash() const;

 private:
  struct ParticipantSet {
    std::uint64_t slaves = 0;  ///< bit i for participant i + 1
    bool master = false;
    void insert(std::size_t participant);
    bool operator==(const ParticipantSet&) const = default;
  };
  /// What happened in a run; `paper`: since a participant's round began.
  struct Run {
    std::uint32_t id = 0;    ///< the run; `paper`: the participant
    ParticipantSet ready;    ///< who was Ready at any time in it
    ParticipantSet running;  ///< who was Running at any time in it
    bool operator==(const Run&) const = default;
  };
  struct Seen {
    PublishedState state = PublishedState::Halted;
    bool passed_init = false;  ///< since it was last Halted
    std::uint32_t run = 0;  ///< `paper`: the number of its round, counted over all participants
    bool operator==(const Seen&) const = default;
  };

  void check_is_transition(std::size_t participant, StateChange change);
  void begin_round(std::size_t participant);
  void became_ready(std::size_t participant);
  void became_running(std::size_t participant);
  Run& facts_for(std::size_t participant);
  std::uint64_t all_slaves() const;
  void report(Invariant invariant, Finding finding, std::size_t participant);

  Variant variant_;
  std::uint32_t rounds_ = 0;  ///< `paper` only
  std::vector<Seen> seen_;
  std::vector<Run> runs_;  ///< one for each run that anybody was Ready or Running in; `paper`: for each participant
  std::vector<Violation> violations_;
};

}  // namespace takt::handshake
