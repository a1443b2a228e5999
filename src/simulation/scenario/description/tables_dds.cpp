// SPDX-License-Identifier: Apache-2.0
// The vocabulary of DDS in scenario files. See scenario/description/tables.cpp.
#include "plant/limits.hpp"
#include "scenario/description/applications.hpp"
#include "scenario/description/dds.hpp"

namespace takt::scenario {

using json::name;
using json::optional;
using json::required;
using plant::longest_step;
using namespace sim::literals;

const json::Enumeration& describe(json::Type<Discovery>) {
  static constexpr json::EnumName names[] = {
      name(Discovery::simple, "simple",
           "participants announce themselves to all (SPDP), then their endpoints to each other (SEDP)"),
      name(Discovery::static_, "static",
           "participants announce themselves; their endpoints are known to all from the beginning"),
      name(Discovery::server, "server", "participants and endpoints are made known by one of them"),
  };
  static constexpr json::Enumeration table = json::enumeration<Discovery>("a way of discovery", names);
  return table;
}

const json::Object& describe(json::Type<Domain>) {
  static constexpr json::Field fields[] = {
      required<&Domain::id>("id", "DomainId.", {.max = 232}),
      optional<&Domain::discovery>("discovery", "How participants find each other."),
      optional<&Domain::server>("server", "The application that is the discovery server."),
      optional<&Domain::announce_every>("announce_every", "Interval of the announcements of participants.",
                                        {.min = 1_ms, .max = longest_step}),
      optional<&Domain::lease_duration>("lease_duration", "A participant that is silent for so long is gone.",
                                        {.min = 1_ms, .max = longest_step}),
      optional<&Domain::multicast>(
          "multicast",
          "New samples go once to the group 239.255.0.1, which all participants with readers have joined, instead of "
          "once to each reader's participant. Repairs and past samples for one of several readers stay unicast."),
  };
  static constexpr json::Object table = json::object<Domain>("domain", "A domain of DDS.", fields);
  return table;
}

const json::Object& describe(json::Type<Persistence>) {
  static constexpr json::Field fields[] = {
      required<&Persistence::name>("name", "Unique among applications, gateways, streams and programs.",
                                   {.min_length = 1, .max_length = 200}),
      required<&Persistence::on>("on", "The host; it has no other part in these topics.", {.min_length = 1}),
      required<&Persistence::topics>("topics", "Topics of DDS whose durability is transient or persistent.",
                                     {.min_items = 1, .max_items = 1000, .unique = true, .items = {.min_length = 1}}),
  };
  static constexpr json::Object table = json::object<Persistence>(
      "persistence",
      "A persistence service of DDS: keeps the last samples of topics for readers that come when the writers are gone.",
      fields);
  return table;
}

}  // namespace takt::scenario
