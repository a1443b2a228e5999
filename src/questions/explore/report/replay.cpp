// SPDX-License-Identifier: Apache-2.0
#include "explore/report/replay.hpp"

#include <algorithm>

#include "explore/model/members.hpp"
#include "explore/model/wiring.hpp"
#include "explore/report/recorder.hpp"
#include "sim/check.hpp"

namespace takt::explore {

using handshake::Input;
using handshake::Outputs;
using handshake::Word;

namespace {

struct Sent {
  Word word;
  std::uint16_t sequence = 0;
  std::uint32_t sent_in = 0;
  bool present = false;
  bool strays = false;  ///< `channels`: it is heard out of its turn
  std::size_t said_in = 0;
  bool forged = false;
  bool replayed = false;
  std::size_t recorded = 0;  ///< its place in the recorder
};

constexpr std::uint16_t far_ahead = 1000;

/// As on a node, with room for as many slaves as a group can have.
using Played = handshake::Participant<64>;

class Player {
 public:
  explicit Player(const Query& query)
      : query_(query),
        wiring_(query),
        observer_(query.variant, query.slaves + 1U),
        sequence_(query.slaves + 1U, 0),
        down_(query.slaves + 1U, false),
        register_(wiring_.size()),
        in_flight_(wiring_.size()),
        recorder_(query, wiring_) {
    for (std::size_t i = 0; i <= query.slaves; ++i) members_.push_back(Played(config(i, 1)));
    for (std::size_t c = 0; c < wiring_.size(); ++c) {
      Heard& heard = heard_.emplace_back();
      heard.who = wiring_.receiver(c);
      heard.of = wiring_.sender(c);
    }
  }

  /// Steps of the opening have number 0.
  ReplayStep play(Action action, std::size_t number) {
    number_ = number;
    ReplayStep done;
    done.moment = moment();
    done.action = action;
    const std::size_t before = observer_.violations().size();
    try {
      act(action, done);
    } catch (const sim::InvariantBroken& broken) {
      done.broken = broken.what();
    }
    if (done.broken.empty()) done.moment = moment();
    for (std::size_t i = 0; i < members_.size(); ++i) done.states.push_back(members_[i].state());
    done.down = down_;
    done.violations.assign(observer_.violations().begin() + static_cast<std::ptrdiff_t>(before),
                           observer_.violations().end());
    return done;
  }

  Moment moment() const {
    Moment made;
    for (std::size_t i = 0; i < members_.size(); ++i)
      made.says.push_back(down_[i] ? std::nullopt : std::optional(members_[i].word()));
    for (std::size_t c = 0; c < wiring_.size(); ++c) {
      const Heard& heard = heard_[c];
      if (down_[heard.who]) continue;
      TAKT_CHECK(is_remembered(members_[heard.who], wiring_.peer(c), heard),
                 "what was heard is what its hearer remembers");
      made.heard.push_back(heard);
    }
    return made;
  }

 private:
  handshake::Config config(std::size_t index, std::uint32_t incarnation) const {
    return {query_.variant,
            index == 0 ? handshake::Role::master : handshake::Role::slave,
            static_cast<std::uint8_t>(index),
            query_.slaves,
            incarnation,
            query_.subscription};
  }

  void act(Action action, ReplayStep& done) {
    done.actor = action.who;
    switch (action.kind) {
      case ActionKind::send:
        publish(action.who, done);
        break;
      case ActionKind::receive:
        hear(action.who, on_channels() ? taken(action.who, next_in(action.who)) : register_[action.who], done);
        break;
      case ActionKind::deliver_late:
        if (on_channels()) {
          hear(action.who, taken(action.who, action.what), done);
          break;
        }
        hear(late_channel_, late_, done);
        late_ = {};
        break;
      case ActionKind::initialised:
        step(action.who, Input::initialised(members_[action.who].intent().run));
        break;
      case ActionKind::silence: {
        step(action.who, Input::peer_silent(action.what));
        const std::size_t channel = wiring_.channel(peer_participant(action.who, action.what), action.who);
        if (!down_[peer_participant(action.who, action.what)]) break;  // its words are taken for old ones
        register_[channel] = {};
        in_flight_[channel].clear();
        break;
      }
      case ActionKind::timeout:
        step(action.who, Input::peer_silent(action.what));
        break;
      case ActionKind::call:
        step(action.who, Input::command(program::methods[action.what].method));
        break;
      case ActionKind::finish:
        step(action.who, Input::finished());
        break;
      case ActionKind::lose:
        if (on_channels()) {
          describe_channel(action.who, taken(action.who, action.what).word, done);
          break;
        }
        describe_channel(action.who, register_[action.who].word, done);
        register_[action.who] = {};
        break;
      case ActionKind::duplicate:
        hold(action.who, done);
        break;
      case ActionKind::reorder:
        hold(action.who, done);
        if (on_channels()) break;
        publish(action.who, done);
        done.is_overtaking = true;
        break;
      case ActionKind::forge:
        forge(action, done);
        break;
      case ActionKind::replay:
        replay(action, done);
        break;
      case ActionKind::change_key:
        recorder_.change_key(action.who);
        break;
      case ActionKind::crash:
        down_[action.who] = true;
        break;
      case ActionKind::join:
      case ActionKind::leave:
        break;  // of candidates
      case ActionKind::restart: {
        down_[action.who] = false;
        members_[action.who] = Played(config(action.who, members_[action.who].config().incarnation + 1));
        sequence_[action.who] = 0;
        recorder_.restart(action.who);
        for (Heard& heard : heard_)
          if (heard.who == action.who) heard = {heard.who, heard.of, false, {}, 0, 0, false, false};
        observer_.on_restart(action.who);
        break;
      }
    }
  }

  Outputs step(std::size_t who, const Input& input) {
    const Outputs outputs = members_[who].step(input);
    observer_.on_step(who, outputs, members_[who].word());
    return outputs;
  }
  bool on_channels() const { return query_.network == Network::channels; }
  /// The first message that does not stray.
  std::size_t next_in(std::size_t channel) const {
    const std::vector<Sent>& sent = in_flight_[channel];
    return static_cast<std::size_t>(
        std::find_if(sent.begin(), sent.end(), [](const Sent& each) { return !each.strays; }) - sent.begin());
  }
  Sent taken(std::size_t channel, std::size_t position) {
    TAKT_CHECK(position < in_flight_[channel].size(), "only what is in flight arrives");
    const Sent sent = in_flight_[channel][position];
    in_flight_[channel].erase(in_flight_[channel].begin() + static_cast<std::ptrdiff_t>(position));
    return sent;
  }
  void describe_channel(std::size_t channel, const Word& word, ReplayStep& done) const {
    done.channel = channel;
    done.actor = wiring_.sender(channel);
    done.word = word;
    done.has_word = true;
  }
  void publish(std::size_t channel, ReplayStep& done) {
    const std::size_t sender = wiring_.sender(channel);
    register_[channel] = {members_[sender].word(),
                          ++sequence_[sender],
                          observer_.sending_run(sender),
                          true,
                          false,
                          number_,
                          false,
                          false,
                          0};
    if (query_.has_recordings())
      register_[channel].recorded =
          recorder_.say(channel, {register_[channel].word, sequence_[sender], register_[channel].sent_in, number_});
    if (on_channels()) in_flight_[channel].push_back(register_[channel]);
    describe_channel(channel, register_[channel].word, done);
  }
  /// One packet to all who hear that participant. A number that it has used or will use, or one far ahead.
  void forge(Action action, ReplayStep& done) {
    const Played now = down_[action.who] ? Played(config(action.who, members_[action.who].config().incarnation))
                                         : members_[action.who];
    const Letter letter = forgeries(now.word(), query_.slaves)[action.what];
    const auto sequence = static_cast<std::uint16_t>(sequence_[action.who] + (letter.ahead ? far_ahead : 0));
    for (std::size_t c = 0; c < wiring_.size(); ++c) {
      if (wiring_.sender(c) != action.who) continue;
      const Sent sent{letter.word, sequence, 0, true, false, number_, true, false, 0};
      if (on_channels() && in_flight_[c].size() < query_.capacity) in_flight_[c].push_back(sent);
      register_[c] = sent;
    }
    done.word = letter.word;
    done.has_word = true;
    done.is_overtaking = letter.ahead;
  }
  /// What stands in the register stays there.
  void replay(Action action, ReplayStep& done) {
    const Recorder::Said& said = recorder_.said(action.who, action.what);
    hear(action.who,
         {said.word, recorder_.sequence(action.who, action.what), said.sent_in, true, false, said.said_in, false, true,
          recorder_.place(action.who, action.what)},
         done);
  }
  void hold(std::size_t channel, ReplayStep& done) {
    if (on_channels()) {
      const std::size_t next = next_in(channel);
      Sent sent = in_flight_[channel][next];
      sent.strays = true;
      describe_channel(channel, sent.word, done);
      if (done.action.kind == ActionKind::reorder)
        in_flight_[channel][next] = sent;
      else
        in_flight_[channel].insert(in_flight_[channel].begin() + static_cast<std::ptrdiff_t>(next), sent);
      return;
    }
    late_ = register_[channel];
    late_channel_ = channel;
    describe_channel(channel, late_.word, done);
  }
  void hear(std::size_t channel, Sent message, ReplayStep& done) {
    TAKT_CHECK(message.present, "only what was published is heard");
    const std::size_t from = wiring_.sender(channel);
    const std::size_t to = wiring_.receiver(channel);
    describe_channel(channel, message.word, done);
    done.actor = to;
    if (down_[to]) return;
    const std::size_t peer = wiring_.peer(channel);
    if (query_.has_recordings()) {
      if (!message.replayed)
        message.sequence = recorder_.said_at(channel, message.recorded).sequence;  // it goes on to say so
      TAKT_CHECK(recorder_.take(channel, message.recorded), "a receiver takes what the search says that it takes");
    }
    const Outputs outputs = step(to, Input::received(peer, message.word, message.sequence));
    if (!outputs.ignored)
      heard_[channel] = {to, from, true, message.word, message.said_in, number_, message.forged, message.replayed};
    if (message.sent_in != 0 && !outputs.ignored && members_[to].process_data_counts(peer))
      observer_.on_process_data(from, to, message.sent_in);
  }

  Query query_;
  Wiring wiring_;
  handshake::Observer observer_;
  std::vector<Played> members_;
  std::vector<std::uint16_t> sequence_;
  std::vector<bool> down_;
  std::vector<Sent> register_;
  std::vector<std::vector<Sent>> in_flight_;
  Sent late_;
  std::size_t late_channel_ = 0;
  std::vector<Heard> heard_;  ///< by channel
  std::size_t number_ = 0;    ///< of the step
  Recorder recorder_;         ///< with the fault `replay`
};

constexpr handshake::Invariant invariant_of(Property property) {
  return static_cast<handshake::Invariant>(index_of(property));
}

}  // namespace

Replay replay(const Query& query, const Beginning& beginning, const Trace& trace) {
  Replay replayed;
  replayed.beginning = beginning.name;
  replayed.cycle = trace.cycle;
  Player player(query);
  for (const Action action : beginning.actions) replayed.opening_steps.push_back(player.play(action, 0));
  replayed.moment = player.moment();
  for (const Action action : trace.actions) {
    replayed.steps.push_back(player.play(action, replayed.steps.size() + 1));
    if (!replayed.steps.back().broken.empty()) break;
  }
  return replayed;
}

bool observed(const Replay& replayed, Property property) {
  if (property > Property::S5) return false;
  return std::any_of(replayed.steps.begin(), replayed.steps.end(), [&](const ReplayStep& done) {
    return std::any_of(done.violations.begin(), done.violations.end(),
                       [&](const handshake::Violation& each) { return each.invariant == invariant_of(property); });
  });
}

}  // namespace takt::explore
