// SPDX-License-Identifier: Apache-2.0
#include "explore/model/roles_model.hpp"
#include "explore/report/model_chart.hpp"

namespace takt::explore {
namespace {

std::string name(std::size_t station) { return station == 0 ? "master" : "candidate " + std::to_string(station); }
std::string role_name(std::size_t role) { return "role " + std::to_string(role + 1); }

struct RolesWords {
  static constexpr std::size_t width = 20;
  explicit RolesWords(const Query& query) : model(query), channels(model.channels()) {}
  RolesModel model;
  std::size_t channels;

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (std::size_t s = 0; s < model.seats(); ++s) names.push_back(name_at(s));
    return names;
  }
  /// Of a nested group the outer one has the plain names, as in the chart of a tree.
  std::string name_at(std::size_t seat) const {
    if (!model.is_outer(seat)) return (model.query().nested() && seat == 0 ? "inner " : "") + name(seat);
    const std::size_t participant = seat - model.stations();
    return participant == 0 ? "master" : "slave " + std::to_string(participant);
  }
  std::vector<std::string> states(const State& state) const {
    std::vector<std::string> states{
        model.is_down(state, 0) ? down_state : std::string(handshake::name_of(model.state_of(state, 0)))};
    for (std::size_t c = 0; c < model.query().candidates; ++c) {
      const Stations::Node& node = model.node(state, c);
      if (node.down)
        states.emplace_back(down_state);
      else if (node.member)
        states.push_back(std::string(handshake::name_of(node.member->state())) + ", " +
                         role_name(node.member->config().index - 1U));
      else
        states.emplace_back(node.candidate.announces() ? "joins" : "away");
    }
    for (std::size_t seat = model.stations(); seat < model.seats(); ++seat)
      states.push_back(model.is_down(state, model.station_of(seat))
                           ? down_state
                           : std::string(handshake::name_of(model.participant_at(state, seat)->state())));
    return states;
  }
  std::vector<std::vector<std::string>> origins() const {
    std::vector<std::string> inner{name_at(0)};
    for (std::size_t role = 0; role < model.roles(); ++role) inner.push_back(role_name(role));
    std::vector<std::string> outer;
    for (std::size_t seat = model.stations(); seat < model.seats(); ++seat) outer.push_back(name_at(seat));
    std::vector<std::vector<std::string>> origins;
    for (std::size_t seat = 0; seat < model.seats(); ++seat) origins.push_back(model.is_outer(seat) ? outer : inner);
    return origins;
  }
  /// Words of participants; what is known of announcements and bindings is not told.
  std::vector<std::pair<std::size_t, std::size_t>> pairs() const {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t c = 0; c < channels; ++c)
      if (is_of_words(c)) pairs.emplace_back(model.receiver_of(c), model.sender_of(c));
    return pairs;
  }
  bool is_of_words(std::size_t channel) const {
    return model.is_outer_channel(channel) || RolesModel::kind_of(channel) == RolesModel::Channel::word_up ||
           RolesModel::kind_of(channel) == RolesModel::Channel::word_down;
  }
  const Participant* participant(const State& state, std::size_t column) const {
    return model.is_down(state, model.station_of(column)) ? nullptr : model.participant_at(state, column);
  }
  std::optional<std::size_t> peer(const State& state, std::size_t who, std::size_t of) const {
    if (participant(state, who) == nullptr) return std::nullopt;
    if (model.is_outer(who)) return who == model.outer_seat(0) ? of - model.outer_seat(1) : 0;
    if (who != 0) return 0;
    for (std::size_t role = 0; role < model.roles(); ++role)
      if (const handshake::Binding& binding = model.binder(state).binding(role);
          binding.bound() && binding.candidate + 1U == of)
        return role;
    return std::nullopt;
  }
  std::size_t speaker(std::size_t channel) const { return model.sender_of(channel); }
  /// The master takes words of the life to which it has bound the role, for those of whoever has it.
  Hearing heard(const State& state, std::size_t channel) const {
    Hearing hearing{model.receiver_of(channel), model.sender_of(channel), std::nullopt};
    if (!is_of_words(channel)) return hearing;
    const Notice& notice = model.notice_in(state, channel);
    hearing.letter = Letter{notice.word, false};
    if (model.is_outer_channel(channel) || hearing.who != 0) return hearing;
    const handshake::Binding& binding = model.binder(state).binding(notice.role);
    if (!binding.bound() || handshake::incarnation_of(binding.candidate, binding.life) != notice.word.incarnation)
      hearing.letter.reset();
    else
      hearing.of = binding.candidate + 1U;
    return hearing;
  }
  std::string text(const Notice& notice, std::size_t candidate) const {
    if (notice.kind == Notice::Kind::announcement)
      return "life " + std::to_string(notice.announcement.life) + (notice.announcement.leaving ? ", leaving" : "");
    if (notice.kind == Notice::Kind::word)
      return text_of(notice.word,
                     notice.word.intent.origin == 0 ? name_at(0) : role_name(notice.word.intent.origin - 1U));
    std::string text = "bound";
    for (std::size_t role = 0; role < notice.bindings.size(); ++role)
      if (notice.bindings[role].bound())
        text += ", " + role_name(role) + ": " + name(notice.bindings[role].candidate + 1U) + " life " +
                std::to_string(notice.bindings[role].life);
    return text + (notice.used_lives[candidate] == 0
                       ? ""
                       : "; life " + std::to_string(notice.used_lives[candidate]) + " is used");
  }
  ChartStep step(const State& state, Action action) {
    const ActionKind kind = action.kind;
    Happening it;
    it.kind = kind;
    it.method = action.what;
    ChartStep made;
    if (kind == ActionKind::send || kind == ActionKind::receive || kind == ActionKind::lose) {
      const std::size_t from = model.sender_of(action.who);
      const std::size_t to = model.receiver_of(action.who);
      it.from = name_at(from);
      it.to = name_at(to);
      const Notice& notice =
          kind == ActionKind::send ? model.notice_for(state, action.who) : model.notice_in(state, action.who);
      it.word = model.is_outer_channel(action.who)
                    ? text_of(notice.word, name_at(model.outer_seat(notice.word.intent.origin)))
                    : text(notice, RolesModel::candidate_of(action.who));
      if (kind == ActionKind::receive)
        made.arrow = {from, to};
      else
        made.marked = {from};
    } else {
      const std::size_t station =
          kind == ActionKind::join || kind == ActionKind::leave ? action.who + std::size_t{1} : action.who;
      it.who = name_at(station);
      it.comes_up = model.is_down(state, model.station_of(station));
      it.peer =
          model.is_outer(station)
              ? name_at(model.outer_seat(station == model.leader() ? action.what + std::size_t{1} : std::size_t{0}))
          : station != 0                ? name(0)
          : action.what < model.roles() ? role_name(action.what)
                                        : name(action.what - model.roles() + 1) + " as one that announces itself";
      made.marked = {station};
    }
    made.sentence = sentence(it);
    return made;
  }
};

}  // namespace

Chart chart_of_roles(const Query& query, const Beginning& beginning, const Trace& trace) {
  return chart_with<RolesWords>(query, beginning, trace);
}

}  // namespace takt::explore
