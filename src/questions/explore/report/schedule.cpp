// SPDX-License-Identifier: Apache-2.0
#include "explore/report/schedule.hpp"

#include <algorithm>
#include <optional>

#include "explore/report/chart.hpp"

namespace takt::explore {
namespace {

// In microseconds. A message that is sent at k * period arrives at k * period + flight; an initialisation lasts so long
// that it ends between an arrival and the next publishing.
constexpr std::int64_t period = 1000;
constexpr std::int64_t flight = 200;
constexpr std::int64_t initialisation = 400;
constexpr std::int64_t first_call = 500;

std::string node_of(std::size_t participant) {
  return participant == 0 ? "master" : "slave" + std::to_string(participant);
}

/// Finds a time for each step. The run is walked once; only the order of what depends on each other counts.
class Scheduler {
 public:
  Scheduler(const Query& query, std::vector<ReplayStep> steps)
      : slaves_(query.slaves), wiring_(query), steps_(std::move(steps)) {
    heard_.resize(wiring_.size());
    since_.resize(slaves_ + 1, 0);
    initialising_.resize(slaves_ + 1, 0);
    state_.resize(slaves_ + 1, handshake::PublishedState::Halted);
  }

  void run() {
    for (std::size_t i = 0; i < steps_.size(); ++i) place(i);
  }

  struct Call {
    std::int64_t at;
    std::string method;
    std::size_t on;
  };
  struct Crash {
    std::int64_t at;
    std::size_t node;
    std::optional<std::int64_t> lasts;
  };
  const std::vector<Call>& calls() const { return calls_; }
  const std::vector<Crash>& crashes() const { return crashes_; }
  /// The periods in which a message gets through, by channel, rising.
  const std::vector<std::int64_t>& heard(std::size_t channel) const { return heard_[channel]; }
  const std::vector<std::string>& missing() const { return missing_; }
  std::int64_t end() const { return now_; }

 private:
  /// A time for one step.
  void place(std::size_t step) {
    const ReplayStep& done = steps_[step];
    switch (done.action.kind) {
      case ActionKind::send:
        if (is_crossing(step)) open_flight();
        break;
      case ActionKind::lose:
        break;
      case ActionKind::silence:
        break;  // comes by itself
      case ActionKind::receive:
        hear(step);
        break;
      case ActionKind::initialised:
        initialise(done);
        break;
      case ActionKind::call:
        if (hears_old_data(step)) open_flight();
        advance();
        calls_.push_back({now_, std::string(program::methods[done.action.what].name), done.action.who});
        changed(done);
        break;
      case ActionKind::crash:
        advance();
        crashes_.push_back({now_, done.action.who, std::nullopt});
        break;
      case ActionKind::restart:
        restart(done);
        break;
      default:
        missing_.push_back(sentence(done, wiring_));
        break;
    }
  }

  /// The sender changes before this word is heard, so it has to be in flight then.
  bool is_crossing(std::size_t step) const {
    const ReplayStep& sent = steps_[step];
    bool sender_moved = false;
    for (std::size_t i = step + 1; i < steps_.size(); ++i) {
      const ReplayStep& done = steps_[i];
      if (done.action.kind == ActionKind::send && done.action.who == sent.action.who) return false;
      if (done.action.kind == ActionKind::receive && done.action.who == sent.action.who) return sender_moved;
      sender_moved = sender_moved || done.states[sent.actor] != sent.states[sent.actor];
    }
    return false;
  }

  /// After this call and others there, data comes that was sent before them (S3).
  bool hears_old_data(std::size_t step) const {
    const std::size_t who = steps_[step].action.who;
    std::size_t i = step;
    while (i < steps_.size() && steps_[i].action.kind == ActionKind::call && steps_[i].action.who == who) ++i;
    if (i == steps_.size() || steps_[i].action.kind != ActionKind::receive) return false;
    const std::vector<handshake::Violation>& violations = steps_[i].violations;
    return std::any_of(violations.begin(), violations.end(),
                       [&](const handshake::Violation& each) { return each.invariant == handshake::Invariant::S3; });
  }

  void open_flight() {
    if (flight_ >= 0 && now_ >= flight_ * period && now_ < flight_ * period + flight / 2) return;
    flight_ = now_ / period + 1;
    now_ = flight_ * period;
  }

  void hear(std::size_t step) {
    const ReplayStep& done = steps_[step];
    const std::size_t channel = done.channel;
    const std::size_t sender = wiring_.sender(channel);
    const bool changes = step == 0 || steps_[step - 1].states != done.states || !done.violations.empty() ||
                         done.word.state != last_heard(step);
    if (!changes) return;  // it hears what it knows
    std::int64_t sent = flight_ >= 0 && now_ <= flight_ * period + flight ? flight_ : -1;
    const bool in_flight = sent >= 0 && steps_[step].word.state == state_at(sender, sent * period);
    if (!in_flight) {
      sent = (now_ - 1) / period;  // the arrival may be of the last publishing, if the sender has said it then
      if (sent < 0 || sent * period + flight < now_ || since_[sender] >= sent * period || taken(channel, sent))
        sent = (now_ / period) + 1;
      if (done.word.state != state_[sender])
        missing_.push_back("a message that is under way while its sender goes on: " + sentence(done, wiring_));
    }
    now_ = sent * period + flight;
    heard_[channel].push_back(sent);
    changed(done);
  }

  void initialise(const ReplayStep& done) {
    const std::int64_t due = initialising_[done.action.who] + initialisation;
    if (due < now_) missing_.push_back("an initialisation that takes longer than others: " + sentence(done, wiring_));
    now_ = std::max(now_, due);
    changed(done);
  }

  void restart(const ReplayStep& done) {
    advance();
    if (!crashes_.empty() && crashes_.back().node == done.action.who && !crashes_.back().lasts) {
      crashes_.back().lasts = now_ - crashes_.back().at;
    } else {
      crashes_.push_back({now_, done.action.who, 10});
    }
    now_ += 10;
    changed(done);
  }

  void advance() { now_ = std::max(now_ + 10, first_call); }

  void changed(const ReplayStep& done) {
    for (std::size_t i = 0; i <= slaves_; ++i) {
      if (done.states[i] == state_[i]) continue;
      if (done.states[i] == handshake::PublishedState::HaltedInit) initialising_[i] = now_;
      before_.push_back({i, now_, state_[i]});
      state_[i] = done.states[i];
      since_[i] = now_;
    }
  }
  /// What a participant was just before a time.
  handshake::PublishedState state_at(std::size_t participant, std::int64_t at) const {
    for (const Change& each : before_)
      if (each.participant == participant && each.at >= at) return each.was;
    return state_[participant];
  }
  handshake::PublishedState last_heard(std::size_t step) const {
    for (std::size_t i = step; i-- > 0;)
      if (steps_[i].action.kind == ActionKind::receive && steps_[i].channel == steps_[step].channel)
        return steps_[i].word.state;
    return handshake::PublishedState::Halted;
  }
  bool taken(std::size_t channel, std::int64_t sent) const {
    return !heard_[channel].empty() && heard_[channel].back() >= sent;
  }

  struct Change {
    std::size_t participant;
    std::int64_t at;
    handshake::PublishedState was;
  };
  std::size_t slaves_;
  Wiring wiring_;
  std::vector<ReplayStep> steps_;
  std::int64_t now_ = 0;
  std::int64_t flight_ = -1;  ///< the period whose messages are pinned
  std::vector<std::vector<std::int64_t>> heard_;
  std::vector<std::int64_t> since_;
  std::vector<std::int64_t> initialising_;
  std::vector<handshake::PublishedState> state_;
  std::vector<Change> before_;
  std::vector<Call> calls_;
  std::vector<Crash> crashes_;
  std::vector<std::string> missing_;
};

std::string microseconds(std::int64_t value) { return "\"" + std::to_string(value) + "us\""; }

/// All periods but those in `heard`, as intervals of loss up to `end`.
void add_losses(std::vector<std::string>& faults, std::size_t from, std::size_t to,
                const std::vector<std::int64_t>& heard, std::int64_t end) {
  // A slave's link carries its own words towards the switch, and the master's words for it towards the slave.
  const std::string slave = node_of(from == 0 ? to : from);
  std::int64_t begin = 0;
  const auto lose = [&](std::int64_t until) {
    if (until <= begin) return;
    faults.push_back("{\"kind\": \"frame-errors\", \"link\": [\"" + slave + "\", \"switch\"], \"towards\": \"" +
                     (from == 0 ? slave : "switch") + "\", \"loss\": 1, \"at\": " + microseconds(begin) +
                     ", \"for\": " + microseconds(until - begin) + "}");
  };
  for (const std::int64_t period_heard : heard) {
    lose(period_heard * period - 1);
    begin = period_heard * period + period - 1;
  }
  lose(end);
}

std::string list(const std::vector<std::string>& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "\n    " : ",\n    ") + item;
  return items.empty() ? "[]" : "[" + text + "\n  ]";
}

}  // namespace

ScenarioText scenario_of(const Query& query, const Replay& replayed, Property property, const std::string& name) {
  std::vector<ReplayStep> steps = replayed.opening_steps;
  steps.insert(steps.end(), replayed.steps.begin(), replayed.steps.end());
  const Wiring wiring(query);
  Scheduler scheduler(query, std::move(steps));
  scheduler.run();
  const std::int64_t until = (scheduler.end() / period + 1) * period - 1;
  const std::int64_t duration =
      until + 1 + (property == Property::L1 || property == Property::F1 ? 250 * period : 2 * period);

  std::string nodes =
      "\n      \"switch\": {\"kind\": \"switch\", \"forwarding_delay\": \"" + std::to_string(flight / 2) + "us\"}";
  std::string links;
  std::string slaves;
  std::vector<std::string> data;
  for (std::size_t i = 0; i <= query.slaves; ++i) {
    nodes += ",\n      \"" + node_of(i) + "\": {\"kind\": \"host\"}";
    links += (i == 0 ? "\n      " : ",\n      ") + std::string("{\"ends\": [\"") + node_of(i) +
             "\", \"switch\"], \"rate\": \"1Gbps\"}";
    if (i != 0) slaves += (i == 1 ? "\"" : ", \"") + node_of(i) + "\"";
    data.push_back("{\"name\": \"of_" + node_of(i) + "\", \"from\": \"" + node_of(i) +
                   "\", \"fields\": {\"value\": \"Double\"}}");
  }
  std::vector<std::string> script;
  std::string asked;
  for (const Scheduler::Call& call : scheduler.calls()) {
    script.push_back("{\"at\": " + microseconds(call.at) + ", \"program\": \"group\", \"call\": \"" + call.method +
                     "\", \"on\": \"" + node_of(call.on) + "\"}");
    asked = call.method;
  }
  std::vector<std::string> faults;
  for (std::size_t c = 0; c < 2U * query.slaves; ++c)
    add_losses(faults, wiring.sender(c), wiring.receiver(c), scheduler.heard(c), until);
  for (const Scheduler::Crash& crash : scheduler.crashes())
    faults.push_back("{\"kind\": \"crash\", \"node\": \"" + node_of(crash.node) + "\", \"at\": " +
                     microseconds(crash.at) + (crash.lasts ? ", \"for\": " + microseconds(*crash.lasts) : "") + "}");
  std::vector<std::string> require;
  if (!must_always_hold(property) || property <= Property::S5) asked.clear();
  std::transform(asked.begin(), asked.end(), asked.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (!asked.empty()) require.push_back("{\"reaction\": \"" + asked + "\", \"within\": \"20ms\"}");

  ScenarioText text;
  text.missing = scheduler.missing();
  if (query.subscription == handshake::Subscription::all_to_all)
    text.missing.push_back("which of the other slaves hears a slave's message");
  std::string head = "// Found by takt explore: " + std::string(name_of(property)) + ", " +
                     std::string(property_texts[index_of(property)]) + ", is violated.\n//\n";
  const std::string drawn = chart(query, replayed);
  for (std::size_t begin = 0; begin < drawn.size();) {
    const std::size_t end = drawn.find('\n', begin);
    head += "// " + drawn.substr(begin, end - begin) + "\n";
    begin = end + 1;
  }
  text.json =
      head + "{\n  \"$schema\": \"../takt.schema.json\",\n  \"name\": \"" + name +
      "\",\n  \"duration\": " + microseconds(duration) + ",\n  \"network\": {\n    \"nodes\": {" + nodes +
      "\n    },\n    \"links\": [" + links + "\n    ]\n  },\n  \"programs\": [\n    {\n" +
      "      \"name\": \"group\",\n      \"variant\": \"" +
      (query.variant == handshake::Variant::paper ? "paper" : "robust") + "\"," +
      (query.subscription == handshake::Subscription::all_to_all ? "\n      \"subscription\": \"all-to-all\"," : "") +
      "\n      \"master\": \"master\",\n      \"slaves\": [" + slaves + "],\n      \"cycle\": " + microseconds(period) +
      ",\n      \"receive_timeout\": \"100ms\",\n      \"initialisation\": " + microseconds(initialisation) +
      ",\n      \"process_data\": " + list(data) + "\n    }\n  ],\n  \"script\": " + list(script) +
      ",\n  \"faults\": " + list(faults) + ",\n  \"require\": " + list(require) + "\n}\n";
  return text;
}

}  // namespace takt::explore
