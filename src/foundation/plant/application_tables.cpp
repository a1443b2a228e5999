// SPDX-License-Identifier: Apache-2.0
// The words of applications. See json/fields.hpp.
#include "plant/application.hpp"
#include "plant/limits.hpp"

namespace takt::plant {
namespace {

using json::name;
using json::optional;
using json::required;

constexpr std::uint32_t largest_buffer = 65'536;

}  // namespace

const json::Enumeration& describe(json::Type<Protocol>) {
  static constexpr json::EnumName names[] = {
      name(Protocol::opc_ua, "opc-ua", "OPC UA PubSub: UADP over UDP multicast"),
      name(Protocol::dds, "dds", "DDS: RTPS over UDP"),
  };
  static constexpr json::Enumeration table = json::enumeration<Protocol>("a protocol", names);
  return table;
}

const json::Enumeration& describe(json::Type<Pattern>) {
  static constexpr json::EnumName names[] = {
      name(Pattern::counter, "counter",
           "the first field that is a number, keys apart, counts the publications, from 1 on"),
      name(Pattern::alternate, "alternate", "the first field that is a number, keys apart, is 1 and 0 by turns"),
  };
  static constexpr json::Enumeration table = json::enumeration<Pattern>("a pattern", names);
  return table;
}

const json::Object& describe(json::Type<Payload>) {
  static constexpr json::Field fields[] = {
      optional<&Payload::pattern>("pattern",
                                  "What the first field of each sample is that is a number and no key; all other "
                                  "values are zero, or as `values` says."),
      optional<&Payload::copy_of>(
          "copy_of",
          "A topic that the application subscribes to: its newest sample is published; nothing before the first one."),
      optional<&Payload::instance>("instance", "Of a topic with keys: what its key fields hold; 0 if absent."),
      optional<&Payload::instances>("instances",
                                    "Of a topic with keys: so many instances, from that one on, by turns; 1 if absent.",
                                    {.min = 1, .max = 1'000'000}),
      optional<&Payload::values>("values",
                                 "With a pattern: what single fields hold that are no numbers. String: the text; Guid: "
                                 "\"72962b91-fa75-4ae6-8d28-b404dc7daf63\"; DateTime: \"2024-01-17T02:26:40Z\"; "
                                 "ByteString: hexadecimal digits.",
                                 {.max_items = 256}),
  };
  static constexpr std::string_view contents[] = {"pattern", "copy_of"};
  static constexpr json::Group groups[] = {json::exactly_one_of(contents)};
  static constexpr json::Object table =
      json::object<Payload>("payload", "What a thread publishes.", fields, {.groups = groups, .shorthand = "pattern"});
  return table;
}

const json::Enumeration& describe(json::Type<Overflow>) {
  static constexpr json::EnumName names[] = {
      name(Overflow::overwrite_oldest, "overwrite-oldest", "the oldest sample makes room"),
      name(Overflow::drop_newest, "drop-newest", "what finds no room is dropped"),
      name(Overflow::keep_latest, "keep-latest", "only the newest sample is kept"),
  };
  static constexpr json::Enumeration table = json::enumeration<Overflow>("an overflow policy", names);
  return table;
}

const json::Enumeration& describe(json::Type<Publication>) {
  static constexpr json::EnumName names[] = {
      name(Publication::synchronous, "synchronous", "the writing thread sends"),
      name(Publication::asynchronous, "asynchronous",
           "a queue takes the sample; another thread sends it, under flow control"),
  };
  static constexpr json::Enumeration table = json::enumeration<Publication>("a publication mode", names);
  return table;
}

const json::Object& describe(json::Type<FlowControl>) {
  static constexpr json::Field fields[] = {
      required<&FlowControl::octets>("octets", "Octets that may be sent in a period.",
                                     {.min = 1, .max = 1'000'000'000}),
      required<&FlowControl::every>("every", "The period.", {.min = 1_us, .max = longest_step}),
  };
  static constexpr json::Object table =
      json::object<FlowControl>("flow_control", "What an asynchronous writer may send at once.", fields);
  return table;
}

const json::Object& describe(json::Type<Topic>) {
  static constexpr json::Field fields[] = {
      required<&Topic::name>("name", "Unique among topics.", {.min_length = 1, .max_length = 200}),
      required<&Topic::protocol>("protocol", "How its samples travel."),
      required<&Topic::fields>("fields", "The fields of a sample.", {.min_items = 1, .max_items = 256}),
      optional<&Topic::publisher_id>(
          "publisher_id", "Of OPC UA: PublisherId of whoever publishes it; the next one that is free if absent.",
          {.min = 1}),
      optional<&Topic::pcp>("pcp", "Priority in a VLAN tag; untagged, priority 0, if absent.", {.max = 7}),
      optional<&Topic::vlan>("vlan", "VLAN identifier in the tag; 0 is a priority tag.", {.max = 4094}),
      optional<&Topic::uadp>("uadp", "Of OPC UA: ids, content masks and encoding of its messages."),
      optional<&Topic::keys>("keys", "Of DDS: the fields that tell instances apart.",
                             {.max_items = 16, .unique = true}),
      optional<&Topic::type>(
          "type",
          "Of DDS: the name of the IDL struct, with its modules (\"Plant::Sample\"); the name of the topic if absent.",
          {.min_length = 1, .max_length = 255}),
      optional<&Topic::domain>("domain", "Of DDS: the DomainId; 0 if absent.", {.max = 232}),
      optional<&Topic::qos>("qos", "Of DDS: quality of service of all writers and readers of the topic."),
      optional<&Topic::publication>("publication", "Of DDS: who sends what is written; the writing thread if absent."),
      optional<&Topic::flow_control>("flow_control",
                                     "Of DDS, asynchronous publication: what may be sent at once; no limit if absent."),
  };
  static constexpr json::Object table =
      json::object<Topic>("topic", "Data that applications publish and subscribe to.", fields);
  return table;
}

const json::Object& describe(json::Type<Signal>) {
  static constexpr json::Field fields[] = {
      required<&Signal::name>("name", "Unique among signals.", {.min_length = 1, .max_length = 200}),
      optional<&Signal::pulse>(
          "pulse", "Nominal length of a pulse, half the nominal period; the interval of the thread if absent.",
          {.min = 1_us, .max = longest_step}),
  };
  static constexpr json::Object table =
      json::object<Signal>("signal", "A digital output: high while the first field of the last sample is not zero.",
                           fields, {.shorthand = "name"});
  return table;
}

const json::Object& describe(json::Type<Thread>) {
  static constexpr json::Field fields[] = {
      required<&Thread::name>("name", "Unique in the application.", {.min_length = 1, .max_length = 200}),
      optional<&Thread::publish>("publish", "The topic to which each call publishes.", {.min_length = 1}),
      optional<&Thread::subscribe>("subscribe", "The topic of which each call takes what has come since the last one.",
                                   {.min_length = 1}),
      required<&Thread::every>("every",
                               "Interval of its activations, which are absolute deadlines on the clock of the host.",
                               {.min = 10_us, .max = 3600_s}),
      optional<&Thread::offset>("offset", "Phase of the activations within the interval.", {.max = 3600_s}),
      optional<&Thread::response>("response",
                                  "From an activation to the call; not before the next activation: the call is missed. "
                                  "The wake-up latency of the host if absent."),
      optional<&Thread::tests>("tests", "Most tests of this thread; as many as the scheduler says if absent.",
                               {.min = 1, .max = 1'000'000'000}),
      optional<&Thread::payload>("payload", "What it publishes; a counter if absent."),
      optional<&Thread::buffer>(
          "buffer", "Samples that a call takes at most, the newest; older ones are overwritten. 1 if absent.",
          {.min = 1, .max = largest_buffer}),
      optional<&Thread::signal>("signal", "Drives a digital output."),
      optional<&Thread::round_trip>("round_trip",
                                    "A topic that the application publishes as a counter and whose values come back on "
                                    "this one, by `copy_of` elsewhere: how long that takes is measured.",
                                    {.min_length = 1}),
      optional<&Thread::qos>("qos", "Of DDS: other quality of service of this writer or reader than the topic's."),
      optional<&Thread::filter>("filter",
                                "Of DDS, of a subscription: only samples for which this expression over the fields of "
                                "the topic holds (\"level > 10 AND NOT axis = 2\", \"level[0] BETWEEN -1 AND 1\"; DDS "
                                "1.4, Annex B). The others come to the host and are left out there.",
                                {.min_length = 1, .max_length = 1000}),
  };
  static constexpr std::string_view roles[] = {"publish", "subscribe"};
  static constexpr json::Group groups[] = {json::exactly_one_of(roles)};
  static constexpr json::Object table =
      json::object<Thread>("thread", "A thread of an application: it publishes to a topic or subscribes to one.",
                           fields, {.groups = groups});
  return table;
}

const json::Object& describe(json::Type<Scheduler>) {
  static constexpr json::Field fields[] = {
      optional<&Scheduler::window>("window",
                                   "A test: what happened in a window of this length, or of the least multiple of a "
                                   "thread's interval that is not shorter; from the thread's offset on.",
                                   {.min = 10_us, .max = 3600_s}),
      optional<&Scheduler::after>("after", "No test begins before.", {.max = longest_step}),
      optional<&Scheduler::tests>("tests", "Most tests of each thread; no limit if absent.",
                                  {.min = 1, .max = 1'000'000'000}),
      optional<&Scheduler::response>("response", "How late it looks at the end of each window; not at all if absent."),
      optional<&Scheduler::tolerance>("tolerance", "A test at whose end it looks later than this is discarded.",
                                      {.max = 3600_s}),
  };
  static constexpr json::Object table = json::object<Scheduler>(
      "scheduler", "The thread that compares what the threads of its application have done with what was expected.",
      fields, {.shorthand = "window"});
  return table;
}

const json::Object& describe(json::Type<Application>) {
  static constexpr json::Field fields[] = {
      required<&Application::name>("name", "Unique among applications, gateways, streams and programs.",
                                   {.min_length = 1, .max_length = 200}),
      required<&Application::on>("on", "The host.", {.min_length = 1}),
      required<&Application::threads>("threads", "Its threads.", {.min_items = 1, .max_items = 64}),
      optional<&Application::scheduler>("scheduler", "How its threads are checked."),
  };
  static constexpr json::Object table =
      json::object<Application>("application", "An application of several threads on a host.", fields);
  return table;
}

const json::Object& describe(json::Type<Gateway>) {
  static constexpr json::Field fields[] = {
      required<&Gateway::name>("name", "Unique among applications, gateways, streams and programs.",
                               {.min_length = 1, .max_length = 200}),
      required<&Gateway::on>("on", "The host.", {.min_length = 1}),
      required<&Gateway::from>("from", "The topic that it subscribes to.", {.min_length = 1}),
      required<&Gateway::to>(
          "to", "The topic that it publishes to: its fields are found by their names, and their types must map.",
          {.min_length = 1}),
      required<&Gateway::receive_every>(
          "receive_every", "Interval of its thread \"receive\", which takes what has come into the buffer.",
          {.min = 10_us, .max = 3600_s}),
      optional<&Gateway::receive_offset>("receive_offset", "Phase of that thread.", {.max = 3600_s}),
      optional<&Gateway::receive_response>("receive_response",
                                           "Response of that thread; the wake-up latency of the host if absent."),
      required<&Gateway::send_every>("send_every",
                                     "Interval of its thread \"send\", which publishes one sample of the buffer.",
                                     {.min = 10_us, .max = 3600_s}),
      optional<&Gateway::send_offset>("send_offset", "Phase of that thread.", {.max = 3600_s}),
      optional<&Gateway::send_response>("send_response",
                                        "Response of that thread; the wake-up latency of the host if absent."),
      optional<&Gateway::buffer>("buffer", "Samples for which the shared buffer has room.",
                                 {.min = 1, .max = largest_buffer}),
      optional<&Gateway::overflow>("overflow", "What happens when it is full."),
      optional<&Gateway::stale_after>("stale_after",
                                      "Samples that have waited for longer are not published; never if absent.",
                                      {.min = 1_us, .max = longest_step}),
      optional<&Gateway::scheduler>("scheduler", "How its threads are checked."),
  };
  static constexpr json::Object table = json::object<Gateway>(
      "gateway", "From a topic of one protocol to a topic of the other, through a shared buffer.", fields);
  return table;
}

}  // namespace takt::plant
