// SPDX-License-Identifier: Apache-2.0
#include "dds/qos/policies.hpp"

namespace takt::dds {
namespace {

using Problems = std::vector<std::string>;

std::string text(std::int64_t number) { return std::to_string(number); }

void check_limit(Problems& problems, const std::string& name, std::int32_t limit) {
  if (limit != unlimited && limit < 1)
    problems.push_back(name + ": " + text(limit) + " is neither positive nor unlimited (-1)");
}

/// `where` is empty, or "durability_service.".
void check_history(Problems& problems, const std::string& where, const History& history, const ResourceLimits& limits) {
  const std::string policy = where + "history";
  const std::string of_limits = where + "resource_limits.";
  const bool keeps_last = history.kind == HistoryKind::keep_last;
  if (keeps_last && history.depth < 1)
    problems.push_back(policy + ".depth: " + text(history.depth) + " is not positive");
  check_limit(problems, of_limits + "max_samples", limits.max_samples);
  check_limit(problems, of_limits + "max_instances", limits.max_instances);
  check_limit(problems, of_limits + "max_samples_per_instance", limits.max_samples_per_instance);
  const std::int32_t of_instance = limits.max_samples_per_instance;
  if (keeps_last && of_instance > 0 && history.depth > of_instance)
    problems.push_back(policy + ".depth: " + text(history.depth) + " is above " + of_limits +
                       "max_samples_per_instance " + text(of_instance));
  // With no limit of an instance the depth has to stay below the limit of all.
  if (keeps_last && of_instance == unlimited && limits.max_samples > 0 && history.depth > limits.max_samples)
    problems.push_back(policy + ".depth: " + text(history.depth) + " is above " + of_limits + "max_samples " +
                       text(limits.max_samples));
  if (of_instance > 0 && limits.max_samples > 0 && of_instance > limits.max_samples)
    problems.push_back(of_limits + "max_samples_per_instance: " + text(of_instance) + " is above max_samples " +
                       text(limits.max_samples));
}

void check_duration(Problems& problems, const std::string& name, sim::Duration duration, bool may_be_zero) {
  if (duration < sim::Duration() || (!may_be_zero && duration == sim::Duration()))
    problems.push_back(name + ": " + text(duration.ps()) + " ps is " + (may_be_zero ? "negative" : "not positive"));
}

/// What topics, writers and readers have in common.
template <class Qos>
Problems common_problems(const Qos& qos) {
  Problems problems;
  check_history(problems, "", qos.history, qos.resource_limits);
  check_duration(problems, "reliability.max_blocking_time", qos.reliability.max_blocking_time, true);
  check_duration(problems, "deadline.period", qos.deadline.period, false);
  check_duration(problems, "latency_budget.duration", qos.latency_budget.duration, true);
  check_duration(problems, "liveliness.lease_duration", qos.liveliness.lease_duration, false);
  return problems;
}

template <class Qos>
void check_offered(Problems& problems, const Qos& qos) {
  check_duration(problems, "lifespan.duration", qos.lifespan.duration, false);
  check_duration(problems, "durability_service.service_cleanup_delay", qos.durability_service.service_cleanup_delay,
                 true);
  check_history(problems, "durability_service.", qos.durability_service.history,
                qos.durability_service.resource_limits);
}

}  // namespace

Problems problems_of(const TopicQos& qos) {
  Problems problems = common_problems(qos);
  check_offered(problems, qos);
  return problems;
}

Problems problems_of(const DataWriterQos& qos) {
  Problems problems = common_problems(qos);
  check_offered(problems, qos);
  return problems;
}

Problems problems_of(const DataReaderQos& qos) {
  Problems problems = common_problems(qos);
  check_duration(problems, "time_based_filter.minimum_separation", qos.time_based_filter.minimum_separation, true);
  if (qos.deadline.period < qos.time_based_filter.minimum_separation)
    problems.push_back("deadline.period: " + text(qos.deadline.period.ps()) +
                       " ps is below time_based_filter.minimum_separation " +
                       text(qos.time_based_filter.minimum_separation.ps()) + " ps");
  return problems;
}

}  // namespace takt::dds
