#include "explore/roles_chart.hpp"

#include "explore/retelling.hpp"
#include "explore/roles_model.hpp"

namespace takt::explore {
namespace {

std::string name(std::size_t station) { return station == 0 ? "master" : "candidate " + std::to_string(station); }
std::string role_name(std::size_t role) { return "role " + std::to_string(role + 1); }

class Teller {
 public:
  explicit Teller(const Question& question) : model_(question) {}

  Chart tell(const Beginning& beginning, const Trace& trace) {
    Chart chart;
    for (std::size_t s = 0; s < model_.stations(); ++s) chart.names.push_back(name(s));
    chart.width = 20;
    return retold(model_, std::move(chart), beginning, trace, [this](const State& state) { return states(state); }, [this](const State& state, Action action) { return told(state, action); });
  }

 private:
  std::vector<std::string> states(const State& state) const {
    std::vector<std::string> states{model_.is_down(state, 0) ? down_state : std::string(handshake::name_of(model_.state_of(state, 0)))};
    for (std::size_t c = 0; c < model_.question().candidates; ++c) {
      const Stations::Node& node = model_.node(state, c);
      if (node.down) states.emplace_back(down_state);
      else if (node.member) states.push_back(std::string(handshake::name_of(node.member->state())) + ", " + role_name(node.member->config().index - 1U));
      else states.emplace_back(node.candidate.announces() ? "joins" : "away");
    }
    return states;
  }
  static std::string text(const Notice& notice, std::size_t candidate) {
    if (notice.kind == Notice::Kind::announcement)
      return "life " + std::to_string(notice.announcement.life) + (notice.announcement.leaving ? ", leaving" : "");
    if (notice.kind == Notice::Kind::word)
      return text_of(notice.word, notice.word.intent.origin == 0 ? "master" : role_name(notice.word.intent.origin - 1U));
    std::string text = "bound";
    for (std::size_t role = 0; role < notice.bindings.size(); ++role)
      if (notice.bindings[role].bound())
        text += ", " + role_name(role) + ": " + name(notice.bindings[role].candidate + 1U) + " life " + std::to_string(notice.bindings[role].life);
    return text + (notice.used_lives[candidate] == 0 ? "" : "; life " + std::to_string(notice.used_lives[candidate]) + " is used");
  }
  ChartStep told(const State& state, Action action) {
    const ActionKind kind = action.kind;
    Happening it;
    it.kind = kind;
    it.method = action.what;
    ChartStep step;
    if (kind == ActionKind::send || kind == ActionKind::receive || kind == ActionKind::lose) {
      const std::size_t candidate = RolesModel::candidate_of(action.who);
      const std::size_t from = RolesModel::is_up(action.who) ? candidate + 1 : 0;
      const std::size_t to = RolesModel::is_up(action.who) ? 0 : candidate + 1;
      it.from = name(from);
      it.to = name(to);
      it.word = text(kind == ActionKind::send ? model_.notice_for(state, action.who) : model_.notice_in(state, action.who), candidate);
      if (kind == ActionKind::receive) step.arrow = {from, to};
      else step.marked = {from};
    } else {
      const std::size_t station = kind == ActionKind::join || kind == ActionKind::leave ? action.who + std::size_t{1} : action.who;
      it.who = name(station);
      it.comes_up = model_.is_down(state, station);
      it.peer = station != 0 ? name(0) : action.what < model_.roles() ? role_name(action.what) : name(action.what - model_.roles() + 1) + " as one that announces itself";
      step.marked = {station};
    }
    step.sentence = sentence(it);
    return step;
  }

  RolesModel model_;
};

}  // namespace

Chart chart_of_roles(const Question& question, const Beginning& beginning, const Trace& trace) { return Teller(question).tell(beginning, trace); }

}  // namespace takt::explore
