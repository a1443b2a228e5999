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

  void reaction() {
    if (r_.scenario.programs.empty())
      diagnostics_.error_unless(may_be_unread_program(r_.scenario, diagnostics_), at("reaction"),
                                "a reaction without a program", {"no programs", "\"programs\""});
    if (asked_->program) find_program(r_.scenario, *asked_->program, at("program"), diagnostics_);
    if (asked_->within && !asked_->within->time)
      error("within", "a time without a unit", {"a number", "a duration such as \"7ms\""});
    check_cause();
    if (!asked_->within) return;
    const std::string kind(spelling(*asked_->reaction));
    const std::string cause(asked_->cause ? spelling(*asked_->cause) : "");
    RequiredFigure& made = add_time(
        RequirementKind::reaction, asked_->program.value_or(""),
        {"programs", asked_->program.value_or("*"), asked_->tree ? "tree_reactions" : "reactions", "*", "duration_ps"},
        *asked_->within,
        "reaction " + kind + (asked_->cause ? " because of a " + cause : "") + (asked_->tree ? " of the tree" : "") +
            (asked_->program ? " of " + *asked_->program : "") + " within " + json::to_text(Duration(*asked_->within)));
    made.figure.only = {{"kind", json::Node::of_string(kind)}, {"superseded", json::Node::of_bool(false)}};
    if (asked_->cause) made.figure.only.emplace_back("cause", json::Node::of_string(cause));
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
    add_time(RequirementKind::clocks, name, {"clock_differences", name, "greatest_ps"}, *asked_->within,
             fmt::format("{} within {} of each other", are_all ? "all clocks" : "clocks of " + name,
                         json::to_text(Duration(*asked_->within))));
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
    made.name = name_of(*asked_);
    made.text = fmt::format("figure {} {} {}", made.name, scenario::text_of(limit->relation), limit->text);
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
      {"reaction", {"within"}, {"program", "cause", "tree"}, &Requirements::reaction},
      {"stream", {"latency", "jitter", "dropped", "delivered"}, {}, &Requirements::stream},
      {"sync", {}, {"node"}, &Requirements::sync},
      {"clocks", {"within"}, {}, &Requirements::clocks},
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
  (this->*spelling->translate)();
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
