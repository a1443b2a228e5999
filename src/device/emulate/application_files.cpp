// SPDX-License-Identifier: Apache-2.0
#include "emulate/application_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "json/fields.hpp"
#include "json/reader.hpp"
#include "node/applications/config.hpp"
#include "plant/topic_check.hpp"

namespace takt::emulate {
namespace {

constexpr const char* group_address = "239.75.0.1";
constexpr std::uint32_t hosts_in_a_block = 250;

class Files {
 public:
  Files(const scenario::Resolved& resolved, const std::vector<bool>& is_bridge, std::set<std::string>& left_out,
        std::vector<std::string>& refusals)
      : resolved_(resolved), is_bridge_(is_bridge), left_out_(left_out), refusals_(refusals) {}

  std::vector<PlannedApplications> make() {
    if (resolved_.applications.empty()) return {};
    for (const scenario::ResolvedApplication& each : resolved_.applications)
      if (each.service)
        refusals_.push_back("persistence service " + each.name + " keeps data that Cyclone DDS does not keep");
    for (const scenario::ResolvedTopic& each : resolved_.topics) give_name(*each.description);
    for (const scenario::ResolvedTopic& each : resolved_.topics) add_topic(each);
    for (const plant::Application& each : resolved_.scenario.applications) add_application(each);
    for (const plant::Gateway& each : resolved_.scenario.gateways) add_gateway(each);
    std::set<std::uint32_t> hosts;
    for (const scenario::ResolvedApplication& each : resolved_.applications)
      if (!each.service) hosts.insert(each.node.value);
    std::vector<PlannedApplications> planned;
    for (const std::uint32_t host : hosts) planned.push_back(plan(host));
    return planned;
  }

 private:
  /// OMG DDS 1.4, annex B, has letters, digits and '_' in names.
  void give_name(const plant::Topic& topic) {
    std::string name = topic.name;
    if (topic.protocol == plant::Protocol::dds) {
      std::ranges::replace_if(
          name, [](char c) { return (c < '0' || c > '9') && (c < 'a' || c > 'z') && (c < 'A' || c > 'Z') && c != '/'; },
          '_');
      if (name.empty() || (name[0] >= '0' && name[0] <= '9')) name.insert(name.begin(), '_');
    }
    while (!taken_.insert(name).second) name += '_';
    names_[topic.name] = name;
  }
  const std::string& name_of(const std::string& topic) const { return names_.at(topic); }

  /// The PublisherId that the simulated topic has; one transport carries all of them.
  void add_topic(const scenario::ResolvedTopic& resolved) {
    plant::Topic topic = *resolved.description;
    topic.name = name_of(topic.name);
    if (topic.protocol == plant::Protocol::opc_ua) {
      if (plant::has_uint16_publisher(topic)) topic.publisher_id = resolved.publisher_id;
      has_opc_ua_ = true;
    }
    if (topic.pcp || topic.vlan != 0) left_out_.insert("priorities and VLANs of topics");
    topic.pcp.reset();
    topic.vlan = 0;
    if (topic.publication || topic.flow_control) left_out_.insert("how DDS writers hand over their samples");
    topic.publication.reset();
    topic.flow_control.reset();
    topics_.items.push_back(json::encode_value(topic));
  }

  void add_application(plant::Application application) {
    for (plant::Thread& thread : application.threads) {
      for (std::optional<std::string>* const topic : {&thread.publish, &thread.subscribe})
        if (*topic) *topic = name_of(**topic);
      if (thread.round_trip) left_out_.insert("round trips");
      thread.round_trip.reset();
      if (thread.payload && thread.payload->copy_of) thread.payload->copy_of = name_of(*thread.payload->copy_of);
    }
    applications_.items.push_back(json::encode_value(application));
  }

  void add_gateway(plant::Gateway gateway) {
    gateway.from = name_of(gateway.from);
    gateway.to = name_of(gateway.to);
    gateways_.items.push_back(json::encode_value(gateway));
  }

  /// Each has the whole list: WriterGroups are numbered over all publications of a topic.
  PlannedApplications plan(std::uint32_t host) {
    PlannedApplications planned;
    planned.host = host;
    planned.name = "a" + std::to_string(host);
    planned.interface = is_bridge_[host] ? "br0" : "eth0";
    planned.address = fmt::format("10.75.{}.{}/16", host / hosts_in_a_block, host % hosts_in_a_block + 1);
    json::Node file = json::Node::object();
    file.add("node", json::Node::of_string(resolved_.topology.nodes[host].name));
    file.add("topics", topics_);
    file.add("applications", applications_);
    file.add("gateways", gateways_);
    if (has_opc_ua_) {
      json::Node& transport = file.add("transport", json::Node::object());
      transport.add("kind", json::Node::of_string("udp"));
      transport.add("interface", json::Node::of_string(planned.interface));
      json::Node& destinations = transport.add("destinations", json::Node::array());
      destinations.items.push_back(json::Node::of_string(group_address));
    }
    file.add("dds", json::Node::of_string(planned.interface));
    file.add("seed", json::encode_value(resolved_.scenario.seed));
    file.add("duration", json::Node::of_string(json::to_text(resolved_.scenario.duration)));
    planned.config = json::pretty(file);
    check(planned);
    return planned;
  }

  /// As the node itself will read it.
  void check(const PlannedApplications& planned) {
    json::Diagnostics diagnostics;
    if (node::load_applications_text(planned.config, planned.name, diagnostics)) return;
    const std::string text = diagnostics.to_text();
    refusals_.push_back("the node on " + resolved_.topology.nodes[planned.host].name +
                        " cannot: " + text.substr(0, text.find('\n')));
  }

  const scenario::Resolved& resolved_;
  const std::vector<bool>& is_bridge_;
  std::set<std::string>& left_out_;
  std::vector<std::string>& refusals_;
  json::Node topics_ = json::Node::array();
  json::Node applications_ = json::Node::array();
  json::Node gateways_ = json::Node::array();
  std::map<std::string, std::string> names_;  // of topics, in the files
  std::set<std::string> taken_;
  bool has_opc_ua_ = false;
};

}  // namespace

std::vector<PlannedApplications> application_files_of(const scenario::Resolved& resolved,
                                                      const std::vector<bool>& is_bridge,
                                                      std::set<std::string>& left_out,
                                                      std::vector<std::string>& refusals) {
  return Files(resolved, is_bridge, left_out, refusals).make();
}

}  // namespace takt::emulate
