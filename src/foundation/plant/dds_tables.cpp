// SPDX-License-Identifier: Apache-2.0
// The words of quality of service of DDS. See json/fields.hpp.
#include "plant/dds.hpp"
#include "plant/limits.hpp"

namespace takt::plant {
namespace {

using json::name;
using json::optional;
using namespace sim::literals;

constexpr std::uint32_t most_samples = 1'000'000;

}  // namespace

const json::Enumeration& describe(json::Type<Reliability>) {
  static constexpr json::EnumName names[] = {
      name(Reliability::best_effort, "best-effort", "what is lost is lost"),
      name(Reliability::reliable, "reliable", "what is lost is sent again"),
  };
  static constexpr json::Enumeration table = json::enumeration<Reliability>("a reliability", names);
  return table;
}

const json::Enumeration& describe(json::Type<Durability>) {
  static constexpr json::EnumName names[] = {
      name(Durability::volatile_, "volatile", "readers get what is written once they are matched"),
      name(Durability::transient_local, "transient-local", "the writer keeps its history for readers that come late"),
      name(Durability::transient, "transient", "it outlives the writer"),
      name(Durability::persistent, "persistent", "it outlives a crash of the host"),
  };
  static constexpr json::Enumeration table = json::enumeration<Durability>("a durability", names);
  return table;
}

const json::Enumeration& describe(json::Type<History>) {
  static constexpr json::EnumName names[] = {
      name(History::keep_last, "keep-last", "the newest samples, as many as depth says"),
      name(History::keep_all, "keep-all", "all samples, within the resource limits"),
  };
  static constexpr json::Enumeration table = json::enumeration<History>("a history", names);
  return table;
}

const json::Enumeration& describe(json::Type<Liveliness>) {
  static constexpr json::EnumName names[] = {
      name(Liveliness::automatic, "automatic", "the participant asserts it"),
      name(Liveliness::manual_by_participant, "manual-by-participant",
           "writing anything on the participant asserts it"),
      name(Liveliness::manual_by_topic, "manual-by-topic", "writing on the topic asserts it"),
  };
  static constexpr json::Enumeration table = json::enumeration<Liveliness>("a liveliness", names);
  return table;
}

const json::Enumeration& describe(json::Type<Ownership>) {
  static constexpr json::EnumName names[] = {
      name(Ownership::shared, "shared", "readers take from all writers"),
      name(Ownership::exclusive, "exclusive", "readers take from the strongest living writer"),
  };
  static constexpr json::Enumeration table = json::enumeration<Ownership>("an ownership", names);
  return table;
}

const json::Enumeration& describe(json::Type<DestinationOrder>) {
  static constexpr json::EnumName names[] = {
      name(DestinationOrder::by_reception, "by-reception", "as samples come"),
      name(DestinationOrder::by_source, "by-source", "as their writers stamped them"),
  };
  static constexpr json::Enumeration table = json::enumeration<DestinationOrder>("a destination order", names);
  return table;
}

const json::Object& describe(json::Type<ResourceLimits>) {
  static constexpr json::Field fields[] = {
      optional<&ResourceLimits::max_samples>("max_samples", "Samples in all; no limit if absent.",
                                             {.min = 1, .max = most_samples}),
      optional<&ResourceLimits::max_instances>("max_instances", "Instances; no limit if absent.",
                                               {.min = 1, .max = most_samples}),
      optional<&ResourceLimits::max_samples_per_instance>(
          "max_samples_per_instance", "Samples of an instance; no limit if absent.", {.min = 1, .max = most_samples}),
  };
  static constexpr json::Object table =
      json::object<ResourceLimits>("resource_limits", "What a writer or reader may keep.", fields);
  return table;
}

const json::Object& describe(json::Type<DurabilityService>) {
  static constexpr json::Field fields[] = {
      optional<&DurabilityService::cleanup_delay>(
          "cleanup_delay", "How long an instance that was disposed is still kept; 0 if absent.", {.max = longest_step}),
      optional<&DurabilityService::history>("history", "Which samples are kept; keep-last if absent."),
      optional<&DurabilityService::depth>("depth", "Samples of an instance that keep-last keeps; 1 if absent.",
                                          {.min = 1, .max = most_samples}),
      optional<&DurabilityService::resource_limits>("resource_limits", "What is kept at most."),
  };
  static constexpr json::Object table = json::object<DurabilityService>(
      "durability_service", "What a persistence service keeps of a transient or persistent topic.", fields);
  return table;
}

const json::Object& describe(json::Type<Qos>) {
  static constexpr json::Field fields[] = {
      optional<&Qos::reliability>("reliability", "Whether lost samples are sent again; best-effort if absent."),
      optional<&Qos::max_blocking_time>("max_blocking_time", "How long a write may wait for room; 100ms if absent.",
                                        {.max = longest_step}),
      optional<&Qos::durability>("durability", "What readers get that come late; volatile if absent."),
      optional<&Qos::history>("history", "Which samples are kept; keep-last if absent."),
      optional<&Qos::depth>("depth", "Samples that keep-last keeps; 1 if absent.", {.min = 1, .max = most_samples}),
      optional<&Qos::deadline>("deadline", "Longest time between two samples; none if absent.",
                               {.min = 1_us, .max = longest_step}),
      optional<&Qos::latency_budget>("latency_budget", "Delay that is acceptable; 0 if absent.", {.max = longest_step}),
      optional<&Qos::liveliness>("liveliness", "Who says that a writer lives; automatic if absent."),
      optional<&Qos::lease_duration>("lease_duration", "Without word for so long a writer is dead; never if absent.",
                                     {.min = 1_us, .max = longest_step}),
      optional<&Qos::ownership>("ownership", "Whether several writers may write; shared if absent."),
      optional<&Qos::ownership_strength>("ownership_strength", "Of a writer with exclusive ownership; 0 if absent."),
      optional<&Qos::lifespan>("lifespan", "Samples that are older expire; none if absent.",
                               {.min = 1_us, .max = longest_step}),
      optional<&Qos::time_based_filter>("time_based_filter", "Readers take at most one sample in so long; 0 if absent.",
                                        {.max = longest_step}),
      optional<&Qos::destination_order>("destination_order", "Order of samples; by-reception if absent."),
      optional<&Qos::resource_limits>("resource_limits", "What is kept at most."),
      optional<&Qos::durability_service>("durability_service",
                                         "What a persistence service keeps, of transient and persistent durability."),
      optional<&Qos::partition>("partition",
                                "Writers and readers find each other if they have a name in common; * ? and [...] "
                                "stand for any that fits; the name \"\" if absent.",
                                {.min_items = 1, .max_items = 64, .unique = true, .items = {.max_length = 255}}),
  };
  static constexpr json::Object table =
      json::object<Qos>("qos", "Quality of service, with the names of OMG DDS 1.4.", fields);
  return table;
}

}  // namespace takt::plant
