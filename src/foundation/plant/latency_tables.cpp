// SPDX-License-Identifier: Apache-2.0
// The words of latencies. See json/fields.hpp.
#include "plant/latency.hpp"
#include "plant/limits.hpp"

namespace takt::plant {

using json::optional;
using json::required;

const json::Object& describe(json::Type<Latency::Uniform>) {
  static constexpr json::Field fields[] = {
      required<&Latency::Uniform::from>("from", "The least value.", {.max = longest_step}),
      required<&Latency::Uniform::to>("to", "The greatest value.", {.max = longest_step}),
  };
  static constexpr json::Object table =
      json::object<Latency::Uniform>("uniform", "All values of an interval are equally likely.", fields);
  return table;
}

const json::Object& describe(json::Type<Latency::Normal>) {
  static constexpr json::Field fields[] = {
      required<&Latency::Normal::mean>("mean", "The mean.", {.max = longest_step}),
      required<&Latency::Normal::deviation>("deviation", "The standard deviation.", {.max = longest_step}),
  };
  static constexpr json::Object table =
      json::object<Latency::Normal>("normal", "A normal distribution, cut at min and max.", fields);
  return table;
}

const json::Object& describe(json::Type<Latency::Exponential>) {
  static constexpr json::Field fields[] = {
      required<&Latency::Exponential::mean>("mean", "The mean.", {.max = longest_step}),
  };
  static constexpr json::Object table =
      json::object<Latency::Exponential>("exponential", "An exponential distribution.", fields);
  return table;
}

const json::Object& describe(json::Type<Latency::Weibull>) {
  static constexpr json::Field fields[] = {
      required<&Latency::Weibull::scale>("scale", "The value that 63.2 % of all values stay below.",
                                         {.max = longest_step}),
      required<&Latency::Weibull::shape>("shape", "The exponent: below 1 a long tail, above 1 a hump.",
                                         {.min = 0.05, .max = 1000.0}),
  };
  static constexpr json::Object table =
      json::object<Latency::Weibull>("weibull", "A Weibull distribution: P(X > x) = exp(-(x/scale)^shape).", fields);
  return table;
}

const json::Object& describe(json::Type<Latency::LogNormal>) {
  static constexpr json::Field fields[] = {
      required<&Latency::LogNormal::median>("median", "Half of all values are below it.", {.max = longest_step}),
      required<&Latency::LogNormal::sigma>("sigma", "The standard deviation of the logarithm.",
                                           {.min = 0.0, .max = 20.0}),
  };
  static constexpr json::Object table =
      json::object<Latency::LogNormal>("log_normal", "A log-normal distribution.", fields);
  return table;
}

const json::Object& describe(json::Type<Latency::Point>) {
  static constexpr json::Field fields[] = {
      required<&Latency::Point::value>("value", "A value that occurs.", {.max = longest_step}),
      optional<&Latency::Point::weight>("weight", "How often it occurs, relative to the others."),
  };
  static constexpr json::Object table =
      json::object<Latency::Point>("table_point", "One row of an empirical table.", fields);
  return table;
}

const json::Object& describe(json::Type<Latency>) {
  static constexpr json::Field fields[] = {
      optional<&Latency::fixed>("fixed", "Always the same.", {.max = longest_step}),
      optional<&Latency::uniform>("uniform", "Uniform over an interval."),
      optional<&Latency::normal>("normal", "Normal distribution."),
      optional<&Latency::exponential>("exponential", "Exponential distribution."),
      optional<&Latency::weibull>("weibull", "Weibull distribution."),
      optional<&Latency::log_normal>("log_normal", "Log-normal distribution."),
      optional<&Latency::table>("table", "Measured values with their frequencies.",
                                {.min_items = 1, .max_items = most_names}),
      optional<&Latency::min>("min", "Smaller values are raised to this one.", {.max = longest_step}),
      optional<&Latency::max>("max", "Greater values are cut to this one.", {.max = longest_step}),
      optional<&Latency::tail>("tail", "Rare values instead of those."),
  };
  static constexpr std::string_view kinds[] = {"fixed",   "uniform",    "normal", "exponential",
                                               "weibull", "log_normal", "table"};
  static constexpr json::Group groups[] = {json::exactly_one_of(kinds)};
  static constexpr json::Object table =
      json::object<Latency>("latency", "A delay: a duration, or a distribution of durations.", fields,
                            {.groups = groups, .shorthand = "fixed"});
  return table;
}

const json::Object& describe(json::Type<LatencyTail>) {
  static constexpr json::Field fields[] = {
      required<&LatencyTail::from>("from", "The least rare value.", {.max = longest_step}),
      required<&LatencyTail::to>("to", "The greatest rare value.", {.max = longest_step}),
      optional<&LatencyTail::per_million>("per_million", "How many of a million values are rare ones.",
                                          {.min = 0.001, .max = 1e6}),
  };
  static constexpr json::Object table =
      json::object<LatencyTail>("latency_tail", "Rare values, all of an interval equally likely.", fields);
  return table;
}

}  // namespace takt::plant
