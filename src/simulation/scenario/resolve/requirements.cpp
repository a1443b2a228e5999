// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/requirements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "json/suggest.hpp"
#include "results/run_result.hpp"
#include "scenario/figures/known_figures.hpp"
#include "scenario/figures/requirement.hpp"
#include "scenario/resolve/clock_groups.hpp"
#include "scenario/resolve/known_names.hpp"

namespace takt::scenario {
namespace {

using results::RequirementKind;

/// "at most 5ms", "11.62us", "11.62us within 1ns"
std::string text_of(const DurationLimit& limit) {
  if (!limit.equal) return "at most " + json::to_text(limit.greatest());
  return json::to_text(*limit.equal) + (limit.within ? " within " + json::to_text(*limit.within) : "");
}

/// "/streams/*/latency_ps/max (mean)": the pointer and what else says which values are meant.
std::string name_of(const Requirement& requirement) {
  std::string more;
  const auto add = [&](const std::string& text) { more += (more.empty() ? "" : ", ") + text; };
  if (requirement.take) add(std::string(spelling(*requirement.take)));
  for (const auto& [key, value] : requirement.only)
    add(key + " = " + (value.node.kind == json::Kind::string ? value.node.text : json::compact(value.node)));
  return *requirement.figure + (more.empty() ? "" : " (" + more + ")");
}

class Requirements {
 public:
  Requirements(const Resolved& resolved, json::Diagnostics& diagnostics)
      : r_(resolved), diagnostics_(diagnostics), streams_(resolved, diagnostics) {}

  void translate(const Requirement& requirement);
  std::vector<RequiredFigure> take() { return std::move(made_); }

 private:
  struct Spelling;
  static const std::vector<Spelling>& spellings();
  void check_keys(const Spelling& spelling, const json::Node& said);

  json::Place at(std::string_view key) const { return asked_->where.at(key); }
  void error(std::string_view key, const char* what, json::Details details) {
    diagnostics_.error(at(key), what, std::move(details));
  }
  bool is_refused(std::string_view list) const { return diagnostics_.is_refused(r_.scenario.where.at(list)); }

  /// A limit on the figure at these steps of result.json.
  RequiredFigure& add(RequirementKind kind, const std::string& subject, std::vector<std::string> steps,
                      std::string text) {
    RequiredFigure& made = made_.emplace_back();
    made.entry = static_cast<std::size_t>(asked_ - r_.scenario.require.data());
    made.part = made_.size() > 1 && made_[made_.size() - 2].entry == made.entry ? made_[made_.size() - 2].part + 1 : 0;
    made.kind = made.taken_as = kind;
    made.subject = subject;
    made.figure.steps = std::move(steps);
    made.from = asked_->after.value_or(r_.scenario.warm_up);
    made.text = std::move(text);
    made.name = asked_->name.value_or("");
    return made;
  }
  void add_number(RequirementKind kind, const std::string& subject, std::vector<std::string> steps, Relation relation,
                  double limit, std::string text) {
    RequiredFigure& made = add(kind, subject, std::move(steps), std::move(text));
    made.limit.relation = relation;
    made.limit.value = made.limit.least = made.limit.greatest = limit;
  }
  RequiredFigure& add_time(RequirementKind kind, const std::string& subject, std::vector<std::string> steps,
                           Duration longest, std::string text) {
    RequiredFigure& made = add(kind, subject, std::move(steps), std::move(text));
    made.figure.is_time = true;
    made.longest = longest;
    return made;
  }

  /// Reports and --only call a requirement by its name, so each has its own.
  void check_name() {
    if (!asked_->name || diagnostics_.is_refused(at("name"))) return;
    if (!names_.insert(*asked_->name).second)
      error("name", "a name twice", {json::quote(*asked_->name), "a name that no other requirement has"});
  }

  void reaction() {
    if (r_.scenario.programs.empty())
      diagnostics_.error_unless(may_be_unread_program(r_.scenario, diagnostics_), at("reaction"),
                                "a reaction without a program", {"no programs", "\"programs\""});
    if (asked_->program) find_program(r_.scenario, *asked_->program, at("program"), diagnostics_);
    if (asked_->within && !asked_->within->time)
      error("within", "a time without a unit", {"a number", "a duration such as \"7ms\""});
    check_cause();
    check_misses();
    const std::string kind(spelling(*asked_->reaction));
    const std::string cause(asked_->cause ? spelling(*asked_->cause) : "");
    const std::string text = "reaction " + kind + (asked_->cause ? " because of a " + cause : "") +
                             (asked_->tree ? " of the tree" : "") + (asked_->program ? " of " + *asked_->program : "");
    const std::vector<std::string> steps = {"programs", asked_->program.value_or("*"),
                                            asked_->tree ? "tree_reactions" : "reactions", "*", "duration_ps"};
    const auto of_kind = [&](RequiredFigure& made) {
      made.figure.only = {{"kind", json::Node::of_string(kind)}, {"superseded", json::Node::of_bool(false)}};
      if (asked_->cause) made.figure.only.emplace_back("cause", json::Node::of_string(cause));
    };
    if (asked_->within)
      of_kind(add_time(RequirementKind::reaction, asked_->program.value_or(""), steps, *asked_->within,
                       text + " within " + json::to_text(Duration(*asked_->within))));
    add_misses(asked_->program.value_or(""), steps, text, of_kind);
  }

  /// Which keys of limits on misses go together.
  void check_misses() {
    const bool asks_late = asked_->late_in_a_row || (asked_->met && asked_->reaction);
    if (asks_late && !asked_->deadline)
      error(asked_->late_in_a_row ? "late_in_a_row" : "met", "nothing is late without a deadline",
            {"no \"deadline\"", "\"deadline\" beside it"});
    if (asked_->deadline && !asked_->late_in_a_row && !asked_->met)
      error("deadline", "does not belong to this requirement",
            {"\"deadline\" alone", "\"late_in_a_row\", or \"met\" with \"of\", beside it"});
    if (asked_->met.has_value() != asked_->of.has_value())
      error(asked_->met ? "met" : "of", "half of a limit",
            {asked_->met ? "\"met\" without \"of\"" : "\"of\" without \"met\"", "both"});
    else if (asked_->met && *asked_->met > *asked_->of)
      error("met", "more than there are",
            {std::to_string(*asked_->met) + " of " + std::to_string(*asked_->of), "at most as many as \"of\""});
  }

  /// Limits on how many are missed one after another. `finish` sets what else the figures have.
  template <class Finish>
  void add_misses(const std::string& subject, const std::vector<std::string>& steps, const std::string& text,
                  Finish&& finish) {
    const std::string within = asked_->deadline ? json::to_text(*asked_->deadline) : "";
    const auto add_one = [&](RequirementKind kind, Relation relation, std::uint64_t limit, std::string words) {
      add_number(kind, subject, steps, relation, static_cast<double>(limit), text + std::move(words));
      made_.back().deadline = kind == RequirementKind::lost_in_a_row ? std::nullopt : asked_->deadline;
      made_.back().of = kind == RequirementKind::met ? *asked_->of : 0;
      finish(made_.back());
    };
    if (asked_->lost_in_a_row)
      add_one(RequirementKind::lost_in_a_row, Relation::at_most, *asked_->lost_in_a_row,
              fmt::format(" loses at most {} in a row", *asked_->lost_in_a_row));
    if (asked_->late_in_a_row && asked_->deadline)
      add_one(RequirementKind::late_in_a_row, Relation::at_most, *asked_->late_in_a_row,
              fmt::format(" later than {} at most {} times in a row", within, *asked_->late_in_a_row));
    if (asked_->met && asked_->of && (asked_->deadline || asked_->stream))
      add_one(RequirementKind::met, Relation::at_least, *asked_->met,
              fmt::format(" {} at least {} times of any {}", asked_->deadline ? "within " + within : "comes",
                          *asked_->met, *asked_->of));
  }

  /// A cause that cannot be: a limit that nothing can ever fail is no requirement.
  void check_cause() {
    using handshake::Cause;
    if (!asked_->cause || *asked_->cause == Cause::command || *asked_->reaction == Reaction::halt ||
        diagnostics_.is_refused(at("reaction")))
      return;
    const auto goes_on = [&](const Program& program) {
      return program.on_replacement == OnReplacement::restart ||
             diagnostics_.is_refused(program.where.at("on_replacement"));
    };
    const bool may_go_on = *asked_->reaction == Reaction::start &&
                           (std::ranges::any_of(r_.scenario.programs, goes_on) ||
                            !are_all_named(r_.scenario.programs, r_.scenario.where.at("programs"), diagnostics_));
    if (!may_go_on && *asked_->cause != Cause::nested)
      error("cause", "a reaction that has no such cause",
            {json::quote(spelling(*asked_->reaction)) + " because of a " + json::quote(spelling(*asked_->cause)),
             "\"halt\", or \"start\" of a program with \"on_replacement\": \"restart\""});
  }

  void stream() {
    const std::string& name = *asked_->stream;
    if (!streams_.may_be(name))
      error("stream", "unknown stream",
            {json::quote(name), "the name of a stream", json::suggest(name, streams_.all())});
    for (const auto& [limit, kind, key] : {std::tuple(&asked_->latency, RequirementKind::latency, "latency"),
                                           std::tuple(&asked_->jitter, RequirementKind::jitter, "jitter")}) {
      if (!*limit) continue;
      if ((*limit)->within && !(*limit)->equal)
        diagnostics_.error((*limit)->where.at("within"), "does not belong to this limit",
                           {"\"within\" without \"equal\"", "\"within\" beside \"equal\""});
      add_time(kind, name, {"streams", name, "latency_ps", key}, (*limit)->greatest(),
               "stream " + name + " " + key + " " + text_of(**limit))
          .shortest = (*limit)->least();
    }
    if (asked_->dropped)
      add_number(RequirementKind::dropped, name, {"streams", name, "lost"}, Relation::at_most,
                 static_cast<double>(*asked_->dropped),
                 fmt::format("stream {} drops at most {}", name, *asked_->dropped));
    check_misses();
    add_misses(name, {"streams", name, "misses"}, "stream " + name, [](RequiredFigure&) {});
    if (asked_->delivered)
      add_number(RequirementKind::delivered, name, {"streams", name, "delivered"}, Relation::at_least,
                 static_cast<double>(*asked_->delivered),
                 fmt::format("stream {} delivers at least {}", name, *asked_->delivered));
  }

  void sync() {
    if (!r_.scenario.clocks.gptp)
      diagnostics_.error_unless(is_refused("clocks"), at("sync"), "synchronisation without gPTP",
                                {"no \"gptp\" in \"clocks\"", "\"gptp\""});
    if (asked_->node && !r_.topology.find(*asked_->node))
      report_unknown_node(r_.topology, *asked_->node, at("node"), "the name of a node", diagnostics_);
    RequiredFigure& made = add_time(RequirementKind::sync, asked_->node.value_or(""),
                                    {"clocks", asked_->node.value_or("*"), "offset", "abs_max_ps"}, *asked_->sync, "");
    made.text =
        fmt::format("clock{} within {} of the grandmaster after {}", asked_->node ? " of " + *asked_->node : "s",
                    json::to_text(*asked_->sync), json::to_text(made.from));
    if (asked_->given && asked_->node)
      error("given", "a promise of one clock",
            {"\"given\" beside \"node\"", "a promise of all nodes with gPTP: without \"node\""});
    give(made);
  }

  void clocks() {
    const Names& clocks = *asked_->clocks;
    const bool are_all = clocks.names.size() == 1 && clocks.names.front() == "*";
    if (asked_->within && !asked_->within->time)
      error("within", "a time without a unit", {"a number", "a duration such as \"1us\""});
    std::set<std::string> seen;
    for (std::size_t i = 0; i < clocks.names.size() && !are_all; ++i) {
      const json::Place place = clocks.names.size() == 1 ? at("clocks") : asked_->where.at("clocks", i);
      if (!r_.topology.find(clocks.names[i]))
        report_unknown_node(r_.topology, clocks.names[i], place, "the name of a node", diagnostics_);
      else if (!seen.insert(clocks.names[i]).second)
        diagnostics_.error(place, "a node twice", {json::quote(clocks.names[i]), "each node once"});
    }
    if (!are_all && clocks.names.size() == 1)
      error("clocks", "a difference of one clock", {json::quote(clocks.names.front()), "two nodes or more, or \"*\""});
    if (!asked_->within) return;
    const std::string name = clock_group_name(clocks);
    give(add_time(RequirementKind::clocks, name, {"clock_differences", name, "greatest_ps"}, *asked_->within,
                  fmt::format("{} within {} of each other", are_all ? "all clocks" : "clocks of " + name,
                              json::to_text(Duration(*asked_->within)))));
    if (asked_->given && !r_.scenario.clocks.gptp)
      diagnostics_.error_unless(is_refused("clocks"), at("given"), "a promise of clocks that nothing holds together",
                                {"no \"gptp\" in \"clocks\"", "\"gptp\""});
  }

  /// What a data sheet promises of clocks.
  void give(RequiredFigure& made) const {
    made.given = asked_->given;
    if (asked_->given) made.text += " (given)";
  }

  void application() {
    const std::string& name = *asked_->application;
    const auto found = std::ranges::find(r_.applications, name, &ResolvedApplication::name);
    if (found == r_.applications.end()) {
      const Scenario& scenario = r_.scenario;
      const bool is_unclear = !are_all_named(scenario.applications, scenario.where.at("applications"), diagnostics_) ||
                              !are_all_named(scenario.gateways, scenario.where.at("gateways"), diagnostics_) ||
                              !are_all_named(scenario.persistence, scenario.where.at("persistence"), diagnostics_);
      diagnostics_.error_unless(
          is_unclear, at("application"), "unknown application",
          {json::quote(name), "the name of an application or gateway", json::suggest(name, names_of(r_.applications))});
      return;
    }
    const bool may_be_more = diagnostics_.is_refused(found->where.at("threads"));
    bool is_known = false;
    bool is_judged = false;
    for (const ResolvedThread& thread : found->threads) {
      if (asked_->thread && thread.name != *asked_->thread) continue;
      is_known = true;
      const auto least = [&](RequirementKind kind, const char* what, const char* steps, double limit) {
        add_number(kind, name + "/" + thread.name, {"applications", name, "threads", thread.name, steps, "percent"},
                   Relation::at_least, limit,
                   fmt::format("thread {}/{} {} at least {:g} %", name, thread.name, what, limit));
        is_judged = true;
      };
      if (asked_->success) least(RequirementKind::success, "done in", "calls", *asked_->success);
      if (asked_->buffered && thread.filter)
        error("buffered", "how many values pass is not known",
              {json::quote(thread.name) + " has a \"filter\"", "a thread that gets all"});
      else if (asked_->buffered && !thread.publishes)
        least(RequirementKind::buffered, "values buffered,", "values", *asked_->buffered);
      else if (asked_->buffered && asked_->thread)
        error("buffered", "nothing is buffered", {json::quote(thread.name) + " publishes", "a thread that subscribes"});
    }
    if (asked_->thread && !is_known)
      diagnostics_.error_unless(may_be_more, at("thread"), "unknown thread",
                                {json::quote(*asked_->thread), "a thread of " + json::quote(name),
                                 json::suggest(*asked_->thread, names_of(found->threads))});
    else if (asked_->buffered && !asked_->thread && std::ranges::all_of(found->threads, &ResolvedThread::publishes))
      diagnostics_.error_unless(
          may_be_more, at("buffered"), "nothing is buffered",
          {"no thread of " + json::quote(name) + " subscribes", "an application that subscribes"});
  }

  void signal() {
    const std::string& name = *asked_->signal;
    if (std::ranges::find(r_.signals, name, &ResolvedSignal::name) == r_.signals.end())
      diagnostics_.error_unless(is_refused("applications"), at("signal"), "unknown signal",
                                {json::quote(name), "the name of a signal", json::suggest(name, names_of(r_.signals))});
    if (asked_->irregular)
      add_number(RequirementKind::irregular, name, {"signals", name, "irregular_percent"}, Relation::at_most,
                 *asked_->irregular,
                 fmt::format("signal {}: at most {:g} % of its pulses irregular", name, *asked_->irregular));
  }

  void figure() {
    const auto figure = read_figure(
        {asked_->where, "figure", *asked_->figure, asked_->only, asked_->take, asked_->unit.value_or(""), false},
        diagnostics_);
    if (asked_->within && !asked_->equal)
      error("within", "does not belong to this requirement",
            {"\"within\" without \"equal\"", "\"within\" beside \"equal\""});
    const auto limit = figure ? read(*figure) : std::nullopt;
    if (!limit) return;
    RequiredFigure& made = add(RequirementKind::figure, "", {}, "");
    made.figure = *figure;
    made.limit = *limit;
    made.figure_name = name_of(*asked_);
    made.text = fmt::format("figure {} {} {}", made.figure_name, scenario::text_of(limit->relation), limit->text);
    made.has_unit = asked_->unit.has_value();
    const bool is_greatest = limit->is_upper() && figure->take == Take::max;
    if (const std::optional<std::string> stream = latency_of(*figure)) {
      made.subject = *stream;
      if (is_greatest && figure->steps.back() == "max") made.taken_as = RequirementKind::latency;
    } else if (const std::optional<AskedReaction> reaction = reaction_of(*figure)) {
      made.subject = reaction->program.value_or("");
      if (is_greatest) made.taken_as = RequirementKind::reaction;
    }
    if (figure->is_time && limit->is_upper())
      made.longest = Duration::from_ps(std::llround(limit->value * figure->divisor));
    check_names(made);
  }

  /// The limit of a figure.
  std::optional<FigureLimit> read(const Figure& figure) {
    const std::tuple<const std::optional<json::Any>*, const char*, Relation> limits[] = {
        {&asked_->at_most, "at_most", Relation::at_most},
        {&asked_->equal, "equal", Relation::equal},
        {&asked_->at_least, "at_least", Relation::at_least}};
    const auto said = std::ranges::find_if(limits, [](const auto& each) { return std::get<0>(each)->has_value(); });
    if (said == std::end(limits)) return std::nullopt;
    const auto& [bound, key, relation] = *said;
    const bool needs_unit = figure.is_time && !asked_->unit;
    if (needs_unit && (*bound)->node.kind == json::Kind::number) {
      error(key, "a time without a unit",
            {json::excerpt((*bound)->node), "a duration such as \"7ms\", or \"unit\" beside it"});
      return std::nullopt;
    }
    auto limit = read_limit(figure, relation, (*bound)->node, at(key), diagnostics_);
    if (!limit || relation != Relation::equal || !asked_->within) return limit;
    if (needs_unit && !asked_->within->time) {
      error("within", "a time without a unit", {"a number", "a duration such as \"7ms\", or \"unit\" beside it"});
      return std::nullopt;
    }
    return read_tolerance(figure, *asked_->within, *limit, at("within"), diagnostics_) ? limit : std::nullopt;
  }

  void check_names(const RequiredFigure& required) {
    const Lookup lookup = look_up(required.figure.steps);
    if (required.from > Duration() &&
        std::ranges::any_of(lookup.figures, [](const KnownFigure* figure) { return figure->is_of_whole_run; }))
      error("figure", "counts from the start of the run only",
            {json::quote(*asked_->figure) + " from " + json::to_text(required.from) + " on" +
                 (asked_->after ? "" : ", the scenario's \"warm_up\""),
             "\"after\": \"0s\" in this requirement"});
    if (const auto unknown = unknown_name(required.figure, r_))
      diagnostics_.error_unless(may_be_refused(*unknown), at("figure"), "unknown " + unknown->kind,
                                {json::quote(unknown->name), "the name of a " + unknown->kind, unknown->suggestion});
  }

  /// Whether the name may be that of something that was refused.
  bool may_be_refused(const UnknownName& unknown) const {
    if (!diagnostics_.has_errors()) return false;
    if (unknown.kind == "stream") return streams_.may_be(unknown.name);
    if (unknown.kind == "node") return !r_.topology.has_all_nodes;
    if (unknown.kind == "program")
      return may_be_unread_program(r_.scenario, diagnostics_) ||
             std::ranges::find(r_.scenario.programs, unknown.name, &Program::name) != r_.scenario.programs.end();
    return (unknown.kind == "application" || unknown.kind == "signal") &&
           (is_refused("applications") || is_refused("gateways") || is_refused("persistence"));
  }

  template <class Rows>
  static std::vector<std::string_view> names_of(const Rows& rows) {
    std::vector<std::string_view> names;
    for (const auto& row : rows) names.push_back(row.name);
    return names;
  }

  const Resolved& r_;
  std::vector<RequiredFigure> made_;
  json::Diagnostics& diagnostics_;
  StreamNames streams_;
  const Requirement* asked_ = nullptr;
  std::set<std::string> names_;
};

/// How scenario files say what is required: by the key that says what it is about, one of those that limit a figure of
/// that, and what else may stand beside them.
struct Requirements::Spelling {
  std::string_view subject;
  std::vector<std::string_view> limits;
  std::vector<std::string_view> more;
  void (Requirements::*translate)();
  bool has(std::string_view key) const { return std::ranges::count(limits, key) + std::ranges::count(more, key) > 0; }
};

const std::vector<Requirements::Spelling>& Requirements::spellings() {
  static const std::vector<Spelling> all = {
      {"reaction",
       {"within", "late_in_a_row", "met"},
       {"program", "cause", "tree", "deadline", "of"},
       &Requirements::reaction},
      {"stream",
       {"latency", "jitter", "dropped", "delivered", "lost_in_a_row", "late_in_a_row", "met"},
       {"deadline", "of"},
       &Requirements::stream},
      {"sync", {}, {"node", "given"}, &Requirements::sync},
      {"clocks", {"within"}, {"given"}, &Requirements::clocks},
      {"application", {"success", "buffered"}, {"thread"}, &Requirements::application},
      {"signal", {"irregular"}, {}, &Requirements::signal},
      {"figure", {"at_most", "at_least", "equal"}, {"only", "take", "unit", "within"}, &Requirements::figure},
  };
  return all;
}

void Requirements::check_keys(const Spelling& spelling, const json::Node& said) {
  for (const json::Member& member : said.members) {
    const bool is_default = (member.value.kind == json::Kind::boolean && !member.value.boolean) ||
                            (member.value.kind == json::Kind::object && member.value.members.empty());
    const auto owner = std::ranges::find_if(spellings(), [&](const Spelling& each) { return each.has(member.key); });
    if (!is_default && owner != spellings().end() && !spelling.has(member.key))
      error(member.key, "does not belong to this requirement",
            {json::quote(member.key), "a requirement with " + json::quote(owner->subject)});
  }
  if (!spelling.limits.empty() &&
      std::ranges::none_of(spelling.limits, [&](std::string_view key) { return said.find(key) != nullptr; }))
    diagnostics_.error(asked_->where.place(), "missing key",
                       {json::quote(spelling.subject) + " without a limit", json::list_text(spelling.limits)});
}

void Requirements::translate(const Requirement& requirement) {
  asked_ = &requirement;
  const json::Node said = json::encode_by(describe(json::Type<Requirement>{}), &requirement);
  const auto spelling =
      std::ranges::find_if(spellings(), [&](const Spelling& each) { return said.find(each.subject) != nullptr; });
  if (spelling == spellings().end()) return;
  check_keys(*spelling, said);
  check_name();
  const std::size_t before = made_.size();
  (this->*spelling->translate)();
  for (std::size_t i = before; i < made_.size(); ++i)
    if (made_[i].from > Duration() && made_[i].kind != RequirementKind::sync)
      made_[i].text += " after " + json::to_text(made_[i].from);
}

}  // namespace

const Program* find_program(const Scenario& scenario, const std::string& name, const json::Place& place,
                            json::Diagnostics& diagnostics) {
  std::vector<std::string_view> names;
  for (const Program& program : scenario.programs) {
    if (program.name == name) return &program;
    names.push_back(program.name);
  }
  diagnostics.error_unless(may_be_unread_program(scenario, diagnostics), place, "unknown program",
                           {json::quote(name), "the name of a program", json::suggest(name, names)});
  return nullptr;
}

std::vector<RequiredFigure> requirements_of(const Resolved& resolved, json::Diagnostics& diagnostics) {
  Requirements requirements(resolved, diagnostics);
  for (const Requirement& requirement : resolved.scenario.require)
    if (requirement.where.is_known() || !diagnostics.has_errors()) requirements.translate(requirement);
  return requirements.take();
}

}  // namespace takt::scenario
