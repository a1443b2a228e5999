#include "scenario/figures/known_figures.hpp"

#include <algorithm>
#include <cstdint>

namespace takt::scenario {
namespace {

/// The alternatives of "{a,b}", or the step itself.
std::vector<std::string_view> names_of(std::string_view step) {
  if (!step.starts_with('{')) return {step};
  std::vector<std::string_view> names;
  step.remove_prefix(1);
  step.remove_suffix(1);
  for (std::size_t comma = 0; comma != std::string_view::npos;) {
    comma = step.find(',');
    names.push_back(step.substr(0, comma));
    if (comma != std::string_view::npos) step.remove_prefix(comma + 1);
  }
  return names;
}

bool is_index(std::string_view step) {
  return !step.empty() && std::all_of(step.begin(), step.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool matches(std::string_view pattern, std::string_view step) {
  if (step == "*" || pattern.starts_with('<')) return true;
  if (pattern == "[]") return is_index(step);
  const auto names = names_of(pattern);
  return std::find(names.begin(), names.end(), step) != names.end();
}

}  // namespace

// docs/results.md says what they mean; tests/scenario/figures_test.cpp holds them against the results of the shipped scenarios.
const std::vector<KnownFigure>& known_figures() {
  using enum FigureKind;
  static const std::vector<KnownFigure> all = {
      {number, "/{seed,simulated_ps,from_ps,events,partial}"},
      {text, "/{takt,scenario,digest}"},
      {verdict, "/verdict"},
      {verdict, "/requirements/[]/{text,verdict,measured_ps,limit_ps,least_measured_ps,least_limit_ps,from_ps,remark,figure,found,at_most,at_least,equal,within,unit}"},
      {number, "/streams/<stream>/{sent,delivered,lost,copies,in_flight,oldest_in_flight_ps,listeners}"},
      {counter, "/streams/<stream>/dropped/<reason>"},
      {number, "/streams/<stream>/latency_ps/{min,mean,p50,p99,max,stddev}"},
      {text, "/programs/<program>/variant"},
      {text, "/programs/<program>/{reactions,tree_reactions}/[]/{kind,initiator,cause}"},
      {number, "/programs/<program>/{reactions,tree_reactions}/[]/{began_ps,completed_ps,duration_ps,superseded}"},
      {number, "/programs/<program>/bindings/[]/at_ps"},
      {text, "/programs/<program>/bindings/[]/{role,node}"},
      {text, "/programs/<program>/states/<>"},
      {number, "/programs/<program>/violations/[]/at_ps"},
      {text, "/programs/<program>/violations/[]/{invariant,participant,text}"},
      {number, "/programs/<program>/timeline/[]/at_ps"},
      {text, "/programs/<program>/timeline/[]/{participant,state,call,fault}"},
      {number, "/programs/<program>/{changes,process_data_received}"},
      {text, "/programs/<program>/round_trips/<>/request"},
      {number, "/programs/<program>/round_trips/<>/count"},
      {number, "/programs/<program>/round_trips/<>/{time_ps,one_way_ps}/{min,mean,p50,p99,max,stddev}"},
      {number, "/programs/<program>/round_trips/<>/histogram_ps/[]/[]"},
      {text, "/applications/<application>/{node,kind}"},
      {text, "/applications/<application>/threads/<>/{publishes,subscribes}"},
      {number, "/applications/<application>/threads/<>/{every_ps,activations,done,missed,published,refused,timed_out,arrived,buffered,overwritten,lost}"},
      {number, "/applications/<application>/threads/<>/response_ps/{count,min,mean,max,deviation}"},
      {number, "/applications/<application>/threads/<>/{calls,values}/{percent,tests,window_ps,expected,counted,beyond,windows_below,windows_above,discarded}"},
      {number, "/applications/<application>/buffer/{received,forwarded,overwritten,dropped,stale,not_mapped}", true},
      {number, "/applications/<application>/kept/<>/{received,restored,kept}", true},
      {number, "/applications/<application>/buffer/age_ps/{min,mean,max}", true},
      {number, "/applications/<application>/participants/[]/{domain,messages_sent,octets_sent,messages_received,heartbeats_sent,acknacks_sent,resent}", true},
      {number, "/applications/<application>/participants/[]/discovery/{messages,octets,participants_found,participants_lost,matches,time_to_match_ps}", true},
      {number, "/applications/<application>/participants/[]/{deadlines_missed,liveliness_lost,samples_rejected,writes_timed_out}", true},
      {text, "/applications/<application>/participants/[]/incompatible/[]"},
      {number, "/signals/<signal>/{nominal_ps,irregular_pulses,irregular_periods,irregular_percent}"},
      {number, "/signals/<signal>/{pulses_ps,periods_ps}/{count,min,mean,max,deviation}"},
      {text, "/ports/[]/{node,peer}"},
      {number, "/ports/[]/{port,frames,dropped,queue_peak,utilisation,fragments_cut,frames_cut_through,bad_fcs_forwarded,transmission_overrun}", true},
      {counter, "/dropped/<reason>"},
      {text, "/clocks/[]/{node,grandmaster,state}"},
      {number, "/clocks/[]/{time_to_lock_ps,samples,rate_error_ppt}"},
      {number, "/clocks/[]/{steps,messages}", true},
      {number, "/clocks/[]/offset/{min_ps,mean_ps,rms_ps,max_ps,abs_max_ps}"},
      {number, "/clocks/[]/history/[]/at_ps"},
      {text, "/clocks/[]/history/[]/{grandmaster,state}"},
      {number, "/ingress/<node>/unidentified", true},
      {text, "/ingress/<node>/filters/[]/stream"},
      {number, "/ingress/<node>/filters/[]/{pcp,matching,passing,not_passing,passing_sdu,not_passing_sdu,red,blocked_due_to_oversize}", true},
      {number, "/ingress/<node>/gates/<>/{passed,closed,octets_exceeded,closed_due_to_invalid_rx,closed_due_to_octets_exceeded}", true},
      {number, "/ingress/<node>/meters/<>/{green,yellow,red,discarded,marks_all_red}", true},
      {number, "/ingress/<node>/ats/<>/{passed,discarded,longest_hold_ps}", true},
      {text, "/redundancy/splits/[]/{node,stream}"},
      {number, "/redundancy/splits/[]/{members,frames,copies}", true},
      {text, "/redundancy/recoveries/[]/{node,stream}"},
      {number, "/redundancy/recoveries/[]/{passed,discarded,out_of_order,rogue,lost,tagless,resets}", true},
      {number, "/redundancy/recoveries/[]/latent_errors/{paths,errors,resets,first_ps}", true},
      {number, "/redundancy/recoveries/[]/individual/[]/{member,port,passed,discarded,out_of_order,rogue,lost,tagless,resets}", true},
      {number, "/topology/{switches,links,diameter,bridges,disjoint_paths}"},
  };
  return all;
}

std::vector<std::string> steps_of(std::string_view pointer) {
  std::vector<std::string> steps;
  for (std::string_view rest = pointer; rest.starts_with('/');) {
    rest.remove_prefix(1);
    const std::size_t end = std::min(rest.find('/'), rest.size());
    std::string step;
    for (std::size_t i = 0; i < end; ++i) {
      const bool is_escape = rest[i] == '~' && i + 1 < end && (rest[i + 1] == '0' || rest[i + 1] == '1');
      step += !is_escape ? rest[i] : rest[++i] == '0' ? '~' : '/';
    }
    steps.push_back(std::move(step));
    rest.remove_prefix(end);
  }
  return steps;
}

std::string_view placeholder_of(std::string_view step) { return step.starts_with('<') ? step.substr(1, step.size() - 2) : std::string_view(); }

Lookup look_up(const std::vector<std::string>& steps) {
  struct Candidate {
    const KnownFigure* figure;
    std::vector<std::string> steps;
  };
  std::vector<Candidate> candidates;
  for (const KnownFigure& figure : known_figures()) candidates.push_back({&figure, steps_of(figure.pattern)});
  Lookup lookup;
  for (std::size_t i = 0; i <= steps.size(); ++i) {
    std::vector<Candidate> left;
    for (const Candidate& candidate : candidates)
      if (i == steps.size() ? candidate.steps.size() == i : candidate.steps.size() > i && matches(candidate.steps[i], steps[i])) left.push_back(candidate);
    if (left.empty()) {
      lookup.wrong_step = i;
      for (const Candidate& candidate : candidates) {
        if (candidate.steps.size() <= i) continue;
        for (const std::string_view name : names_of(candidate.steps[i])) {
          std::string text(name == "[]" ? "an index or *" : name);
          if (std::find(lookup.expected.begin(), lookup.expected.end(), text) == lookup.expected.end()) lookup.expected.push_back(std::move(text));
        }
      }
      return lookup;
    }
    candidates = std::move(left);
  }
  for (const Candidate& candidate : candidates) lookup.figures.push_back(candidate.figure);
  return lookup;
}

}  // namespace takt::scenario
