// SPDX-License-Identifier: Apache-2.0
#include "emulate/coexistence_files.hpp"

#include <fmt/format.h>

#include "json/node.hpp"

namespace takt::emulate {
namespace {

std::string quote(const std::string& text) { return json::compact(json::Node::of_string(text)); }

/// Before that nothing is tested: processes start and find each other.
constexpr const char* settling = "3s";

struct Timing {
  int interval_ms = 0;
  int windows = 0;
};

std::string thread(const char* role, const char* topic, const Timing& timing, bool half_behind,
                   const std::string& payload = "") {
  return fmt::format(R"({{"name": "{0}", "{0}": "{1}", "every": "{2}ms", "offset": "{3}us"{4}}})", role, topic,
                     timing.interval_ms, half_behind ? timing.interval_ms * 500 : 0,
                     payload.empty() ? "" : ", \"payload\": " + payload);
}

std::string scheduler(const Timing& timing) {
  return fmt::format(R"("scheduler": {{"window": "10ms", "after": "{}", "tests": {}}})", settling, timing.windows);
}

std::string application(const std::string& node, const std::vector<std::string>& threads, const Timing& timing) {
  return fmt::format(R"({{"name": "{0}", "on": "{0}", "threads": [{1}], {2}}})", node, fmt::join(threads, ", "),
                     scheduler(timing));
}

std::string topic(const char* name, bool is_dds, int domain, const char* fields) {
  return fmt::format(R"({{"name": "{}", "protocol": "{}"{}, "fields": {}}})", name, is_dds ? "dds" : "opc-ua",
                     is_dds ? fmt::format(", \"domain\": {}", domain) : "", fields);
}

constexpr const char* process_fields = R"({"values": {"type": "Double", "count": 4}})";
constexpr const char* command_fields = R"({"level": "UInt32"})";

std::vector<std::string> topics_of(CaseStudy study, int domain) {
  if (study == CaseStudy::mirror)
    return {topic("dds_process", true, domain, process_fields), topic("dds_report", true, domain, process_fields),
            topic("ua-process", false, domain, process_fields), topic("ua-report", false, domain, process_fields)};
  return {topic("ua-process", false, domain, process_fields), topic("ua-command", false, domain, command_fields),
          topic("dds_command", true, domain, command_fields), topic("dds_report", true, domain, command_fields)};
}

std::vector<std::string> applications_of(CaseStudy study, const Timing& timing) {
  if (study == CaseStudy::mirror)
    return {application("dds-update", {thread("publish", "dds_process", timing, false)}, timing),
            application("dds-control",
                        {thread("subscribe", "dds_process", timing, true),
                         thread("publish", "dds_report", timing, true, R"({"copy_of": "dds_process"})")},
                        timing),
            application("dds-diagnose", {thread("subscribe", "dds_report", timing, false)}, timing),
            application("ua-update", {thread("publish", "ua-process", timing, false)}, timing),
            application("ua-control",
                        {thread("subscribe", "ua-process", timing, true),
                         thread("publish", "ua-report", timing, true, R"({"copy_of": "ua-process"})")},
                        timing),
            application("ua-diagnose", {thread("subscribe", "ua-report", timing, false)}, timing)};
  return {application("ua-update", {thread("publish", "ua-process", timing, false)}, timing),
          application("ua-control",
                      {thread("subscribe", "ua-process", timing, true),
                       thread("publish", "ua-command", timing, true, R"("alternate")")},
                      timing),
          application("dds-control",
                      {thread("subscribe", "dds_command", timing, false),
                       thread("publish", "dds_report", timing, false, R"({"copy_of": "dds_command"})")},
                      timing),
          application("dds-diagnose", {thread("subscribe", "dds_report", timing, true)}, timing)};
}

std::vector<std::string> gateways_of(CaseStudy study, const Timing& timing) {
  if (study == CaseStudy::mirror) return {};
  return {fmt::format(
      R"({{"name": "gateway", "on": "gateway", "from": "ua-command", "to": "dds_command", "receive_every": "{0}ms", "send_every": "{0}ms", "send_offset": "{1}us", "buffer": 4, {2}}})",
      timing.interval_ms, timing.interval_ms * 500, scheduler(timing))};
}

}  // namespace

const std::vector<std::string>& nodes_of(CaseStudy study) {
  static const std::vector<std::string> mirror = {"dds-update", "dds-control", "dds-diagnose",
                                                  "ua-update",  "ua-control",  "ua-diagnose"};
  static const std::vector<std::string> gateway = {"ua-update", "ua-control", "gateway", "dds-control", "dds-diagnose"};
  return study == CaseStudy::mirror ? mirror : gateway;
}

std::string node_file(CaseStudy study, const std::string& node, int interval_ms, int windows,
                      const CoexistenceNetwork& network, const std::string& statistics) {
  const Timing timing = {interval_ms, windows};
  return fmt::format(
      R"({{
  "node": {},
  "topics": [
    {}
  ],
  "applications": [
    {}
  ],
  "gateways": [{}],
  "transport": {{"kind": "udp", "interface": {}, "port": {}, "destinations": ["239.75.0.1"]}},
  "dds": {},
  "statistics": {}
}}
)",
      quote(node), fmt::join(topics_of(study, network.domain), ",\n    "),
      fmt::join(applications_of(study, timing), ",\n    "), fmt::join(gateways_of(study, timing), ",\n    "),
      quote(network.interface), network.port, quote(network.interface), quote(statistics));
}

}  // namespace takt::emulate
