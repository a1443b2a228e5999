// SPDX-License-Identifier: Apache-2.0
// The words of node files with applications, besides those of src/foundation/plant.
#include "node/applications/config.hpp"
#include "plant/limits.hpp"

namespace takt::node {
namespace {

using json::optional;
using json::required;
using plant::longest_step;
using namespace sim::literals;  // NOLINT: units in limits

}  // namespace

const json::Object& describe(json::Type<DdsTransport>) {
  static constexpr json::Field fields[] = {
      optional<&DdsTransport::interface>(
          "interface", "The network interface; as CYCLONEDDS_URI or the implementation says if absent.",
          {.min_length = 1, .max_length = 15}),
  };
  static constexpr json::Object table =
      json::object<DdsTransport>("dds", "How RTPS travels.", fields, {.shorthand = "interface"});
  return table;
}

const json::Object& describe(json::Type<ApplicationsConfig>) {
  static constexpr json::Field fields[] = {
      required<&ApplicationsConfig::node>("node", "The name of this node."),
      required<&ApplicationsConfig::topics>("topics", "Topics, the same at all nodes.",
                                            {.min_items = 1, .max_items = 1000}),
      optional<&ApplicationsConfig::applications>("applications", "Applications, as in a scenario.",
                                                  {.max_items = 256}),
      optional<&ApplicationsConfig::gateways>("gateways", "Gateways, as in a scenario.", {.max_items = 256}),
      optional<&ApplicationsConfig::transport>("transport",
                                               "How topics of OPC UA travel; needed if there are any here."),
      optional<&ApplicationsConfig::dds>("dds", "How topics of DDS travel."),
      optional<&ApplicationsConfig::clock>("clock", "The clock that the nodes share."),
      optional<&ApplicationsConfig::duration>("duration", "How long it runs; until a signal if absent.",
                                              {.min = 1_ms, .max = longest_step}),
      optional<&ApplicationsConfig::realtime>(
          "realtime", "Ask for SCHED_FIFO and locked memory; a warning where that is not permitted."),
      optional<&ApplicationsConfig::security>(
          "security",
          "All messages of topics of OPC UA are signed, or signed and encrypted, with these keys; neither if absent."),
      optional<&ApplicationsConfig::seed>(
          "seed", "The seed of drawn responses; with that of a scenario they are those of its run."),
      optional<&ApplicationsConfig::statistics>(
          "statistics", "Where the statistics go at the end, besides standard output.", {.min_length = 1}),
  };
  static constexpr json::Object table =
      json::object<ApplicationsConfig>("node", "Applications and gateways on this machine.", fields);
  return table;
}

}  // namespace takt::node
