// The words of node files with applications, besides those of src/vocabulary.
#include "node/applications/config.hpp"
#include "vocabulary/limits.hpp"

namespace takt::node {
namespace {

using json::optional;
using json::required;
using vocabulary::longest_step;
using namespace sim::literals;  // NOLINT: units in limits

constexpr std::uint32_t most_samples = 65'536;

}  // namespace

const json::Object& describe(json::Type<Topic>) {
  static constexpr json::Field fields[] = {
      required<&Topic::name>("name", "Unique among topics.", {.min_length = 1, .max_length = 200}),
      required<&Topic::protocol>("protocol", "How its samples travel."),
      required<&Topic::fields>("fields", "The fields of a sample, and the members of the IDL struct in their order.", {.min_items = 1, .max_items = 256}),
      optional<&Topic::publisher_id>("publisher_id", "Of OPC UA: PublisherId of whoever publishes it; 1 + its position among the topics if absent.", {.min = 1}),
      optional<&Topic::keys>("keys", "Of DDS: the fields that tell instances apart; together at most 16 octets.", {.max_items = 16, .unique = true}),
      optional<&Topic::type>("type", "Of DDS: the name of the IDL struct, with its modules (\"Plant::Sample\"); the name of the topic if absent.", {.min_length = 1, .max_length = 255}),
      optional<&Topic::domain>("domain", "Of DDS: the DomainId; 0 if absent.", {.max = 232}),
      optional<&Topic::qos>("qos", "Of DDS: quality of service of all writers and readers of the topic."),
  };
  static constexpr json::Object table = json::object<Topic>("topic", "Data that applications publish and subscribe to.", fields);
  return table;
}

const json::Object& describe(json::Type<Thread>) {
  static constexpr json::Field fields[] = {
      required<&Thread::name>("name", "Unique in the application.", {.min_length = 1, .max_length = 200}),
      optional<&Thread::publish>("publish", "The topic to which each call publishes."),
      optional<&Thread::subscribe>("subscribe", "The topic of which each call takes what has come since the last one."),
      required<&Thread::every>("every", "Interval of its activations, which are absolute deadlines on the clock.", {.min = 10_us, .max = 3600_s}),
      optional<&Thread::offset>("offset", "Phase of the activations within the interval.", {.max = 3600_s}),
      optional<&Thread::payload>("payload", "What it publishes; a counter if absent."),
      optional<&Thread::buffer>("buffer", "Samples that a call takes at most, the newest; older ones are overwritten. 1 if absent.", {.min = 1, .max = most_samples}),
      optional<&Thread::tests>("tests", "Most tests of this thread; as many as the scheduler says if absent.", {.min = 1, .max = 1'000'000'000}),
      optional<&Thread::qos>("qos", "Of DDS: other quality of service of this writer or reader than the topic's."),
  };
  static constexpr std::string_view roles[] = {"publish", "subscribe"};
  static constexpr json::Group groups[] = {json::exactly_one_of(roles)};
  static constexpr json::Object table = json::object<Thread>("thread", "A thread of an application: it publishes to a topic or subscribes to one.", fields, {.groups = groups});
  return table;
}

const json::Object& describe(json::Type<Scheduler>) {
  static constexpr json::Field fields[] = {
      optional<&Scheduler::window>("window", "A test: what happened in a window of this length, or of the least multiple of a thread's interval that is not shorter; from the thread's offset on.",
                                   {.min = 10_us, .max = 3600_s}),
      optional<&Scheduler::after>("after", "No test begins before.", {.max = longest_step}),
      optional<&Scheduler::tests>("tests", "Most tests of each thread; no limit if absent.", {.min = 1, .max = 1'000'000'000}),
      optional<&Scheduler::tolerance>("tolerance", "A test at whose end the scheduler itself wakes up later than this is discarded.", {.max = 3600_s}),
  };
  static constexpr json::Object table =
      json::object<Scheduler>("scheduler", "The thread that compares what the threads of its application have done with what was expected.", fields, {.shorthand = "window"});
  return table;
}

const json::Object& describe(json::Type<ApplicationOfNode>) {
  static constexpr json::Field fields[] = {
      required<&ApplicationOfNode::name>("name", "Unique among applications and gateways.", {.min_length = 1, .max_length = 200}),
      optional<&ApplicationOfNode::on>("on", "The node; this one if absent. Those on other nodes are passed over."),
      required<&ApplicationOfNode::threads>("threads", "Its threads.", {.min_items = 1, .max_items = 64}),
      optional<&ApplicationOfNode::scheduler>("scheduler", "How its threads are checked."),
  };
  static constexpr json::Object table = json::object<ApplicationOfNode>("application", "An application of several threads.", fields);
  return table;
}

const json::Object& describe(json::Type<GatewayOfNode>) {
  static constexpr json::Field fields[] = {
      required<&GatewayOfNode::name>("name", "Unique among applications and gateways.", {.min_length = 1, .max_length = 200}),
      optional<&GatewayOfNode::on>("on", "The node; this one if absent. Those on other nodes are passed over."),
      required<&GatewayOfNode::from>("from", "The topic that it subscribes to."),
      required<&GatewayOfNode::to>("to", "The topic that it publishes to: its fields are found by their names, and their types must map."),
      required<&GatewayOfNode::receive_every>("receive_every", "Interval of its thread \"receive\", which takes what has come into the buffer.", {.min = 10_us, .max = 3600_s}),
      optional<&GatewayOfNode::receive_offset>("receive_offset", "Phase of that thread.", {.max = 3600_s}),
      required<&GatewayOfNode::send_every>("send_every", "Interval of its thread \"send\", which publishes one sample of the buffer.", {.min = 10_us, .max = 3600_s}),
      optional<&GatewayOfNode::send_offset>("send_offset", "Phase of that thread.", {.max = 3600_s}),
      optional<&GatewayOfNode::buffer>("buffer", "Samples for which the shared buffer has room.", {.min = 1, .max = most_samples}),
      optional<&GatewayOfNode::overflow>("overflow", "What happens when it is full."),
      optional<&GatewayOfNode::stale_after>("stale_after", "Samples that have waited for longer are not published; never if absent.", {.min = 1_us, .max = longest_step}),
      optional<&GatewayOfNode::scheduler>("scheduler", "How its threads are checked."),
  };
  static constexpr json::Object table = json::object<GatewayOfNode>("gateway", "From a topic of one protocol to a topic of the other, through a shared buffer.", fields);
  return table;
}

const json::Object& describe(json::Type<DdsTransport>) {
  static constexpr json::Field fields[] = {
      optional<&DdsTransport::interface>("interface", "The network interface; as CYCLONEDDS_URI or the implementation says if absent.", {.min_length = 1, .max_length = 15}),
  };
  static constexpr json::Object table = json::object<DdsTransport>("dds", "How RTPS travels.", fields, {.shorthand = "interface"});
  return table;
}

const json::Object& describe(json::Type<ApplicationsConfig>) {
  static constexpr json::Field fields[] = {
      required<&ApplicationsConfig::node>("node", "The name of this node."),
      required<&ApplicationsConfig::topics>("topics", "Topics, the same at all nodes.", {.min_items = 1, .max_items = 1000}),
      optional<&ApplicationsConfig::applications>("applications", "Applications, as in a scenario.", {.max_items = 256}),
      optional<&ApplicationsConfig::gateways>("gateways", "Gateways, as in a scenario.", {.max_items = 256}),
      optional<&ApplicationsConfig::transport>("transport", "How topics of OPC UA travel; needed if there are any here."),
      optional<&ApplicationsConfig::dds>("dds", "How topics of DDS travel."),
      optional<&ApplicationsConfig::clock>("clock", "The clock that the nodes share."),
      optional<&ApplicationsConfig::duration>("duration", "How long it runs; until a signal if absent.", {.min = 1_ms, .max = longest_step}),
      optional<&ApplicationsConfig::realtime>("realtime", "Ask for SCHED_FIFO and locked memory; a warning where that is not permitted."),
      optional<&ApplicationsConfig::statistics>("statistics", "Where the statistics go at the end, besides standard output.", {.min_length = 1}),
  };
  static constexpr json::Object table = json::object<ApplicationsConfig>("node", "Applications and gateways on this machine.", fields);
  return table;
}

}  // namespace takt::node
