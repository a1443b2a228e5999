// The vocabulary of DDS in scenario files. See scenario/description/tables.cpp.
#include "scenario/applications/description_dds.hpp"
#include "vocabulary/limits.hpp"

namespace takt::scenario {

using json::name;
using json::optional;
using json::required;
using vocabulary::longest_step;
using namespace sim::literals;

const json::Enumeration& describe(json::Type<Publication>) {
  static constexpr json::EnumName names[] = {
      name(Publication::synchronous, "synchronous", "the writing thread sends"),
      name(Publication::asynchronous, "asynchronous", "a queue takes the sample; another thread sends it, under flow control"),
  };
  static constexpr json::Enumeration table = json::enumeration<Publication>("a publication mode", names);
  return table;
}

const json::Object& describe(json::Type<FlowControl>) {
  static constexpr json::Field fields[] = {
      required<&FlowControl::octets>("octets", "Octets that may be sent in a period.", {.min = 1, .max = 1'000'000'000}),
      required<&FlowControl::every>("every", "The period.", {.min = 1_us, .max = longest_step}),
  };
  static constexpr json::Object table = json::object<FlowControl>("flow_control", "What an asynchronous writer may send at once.", fields);
  return table;
}

const json::Enumeration& describe(json::Type<Discovery>) {
  static constexpr json::EnumName names[] = {
      name(Discovery::simple, "simple", "participants announce themselves to all (SPDP), then their endpoints to each other (SEDP)"),
      name(Discovery::static_, "static", "participants announce themselves; their endpoints are known to all from the beginning"),
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
      optional<&Domain::announce_every>("announce_every", "Interval of the announcements of participants.", {.min = 1_ms, .max = longest_step}),
      optional<&Domain::lease_duration>("lease_duration", "A participant that is silent for so long is gone.", {.min = 1_ms, .max = longest_step}),
  };
  static constexpr json::Object table = json::object<Domain>("domain", "A domain of DDS.", fields);
  return table;
}

}  // namespace takt::scenario
