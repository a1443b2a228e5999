#include <algorithm>
#include <charconv>
#include <map>
#include <numeric>

#include "interchange/inet/gate_circles.hpp"
#include "interchange/inet/inet.hpp"
#include "interchange/inet/ini.hpp"
#include "interchange/inet/ned.hpp"
#include "json/quantity.hpp"

namespace takt::interchange {
namespace inet {
namespace {

using sim::Duration;

/// What INET's units are called in takt.
std::string takt_unit(std::string text) {
  std::erase(text, ' ');
  return text;
}

class InetReader {
 public:
  InetReader(const ImportRequest& request, Imported& imported, json::Diagnostics& diagnostics) : request_(request), imported_(imported), diagnostics_(diagnostics) {}

  void run() {
    std::vector<Network> networks;
    for (const InputFile& file : request_.files) {
      if (file.name.ends_with(".ned")) {
        for (Network& network : read_ned(file, diagnostics_)) networks.push_back(std::move(network));
      } else if (file.name.ends_with(".ini")) {
        ini_.read(file, request_.settings["config"], diagnostics_);
      } else {
        diagnostics_.error({file.name, 0, 0, ""}, "a file of unknown kind", {json::quote(file.name), "a name that ends with .ned or .ini"});
      }
    }
    if (diagnostics_.has_errors()) return;
    if (!choose(networks)) return;
    read_general();
    read_nodes();
    read_links();
    if (diagnostics_.has_errors()) return;
    read_redundancy();
    for (const Submodule& node : network_.submodules) read_node(node);
    // In the order of their ports, which is that of the file if takt wrote it.
    std::ranges::stable_sort(scenario_.streams, {}, [&](const scenario::Stream& stream) { return port_of_stream_[stream.name]; });
    add_redundant();
    refuse_the_rest();
    if (!diagnostics_.has_errors()) imported_.scenario = std::move(scenario_);
  }

 private:
  void error(const json::Place& place, std::string message, std::string found, std::string expected) { diagnostics_.error(place, std::move(message), {std::move(found), std::move(expected)}); }

  bool choose(std::vector<Network>& networks) {
    const IniLine* const name = ini_.find_global("network");
    std::string wanted = name == nullptr ? "" : name->value;
    if (wanted.starts_with('"') && wanted.size() > 1) wanted = wanted.substr(1, wanted.size() - 2);
    wanted = wanted.substr(wanted.rfind('.') + 1);
    const auto found = std::ranges::find_if(networks, [&](const Network& each) { return each.name == wanted || (name == nullptr && networks.size() == 1); });
    if (found == networks.end()) {
      error(name == nullptr ? json::Place{request_.files.front().name, 0, 0, ""} : name->place, "no network", name == nullptr ? "no \"network =\" and " + std::to_string(networks.size()) + " networks" : json::quote(wanted), "a network of the NED files");
      return false;
    }
    network_ = std::move(*found);
    scenario_.name = network_.name;
    return true;
  }

  // Values.
  const IniLine* line(const std::string& path) { return ini_.find(network_.name + "." + path); }
  std::optional<std::string> text(const std::string& path) {
    const IniLine* const found = line(path);
    if (found == nullptr) return std::nullopt;
    const auto value = parse_value(found->value);
    if (value && value->kind == json::Kind::string) return value->text;
    error(found->place, "not a text", found->value, "a text in quotes");
    return std::nullopt;
  }
  bool truth(const std::string& path, bool otherwise = false) {
    const IniLine* const found = line(path);
    if (found == nullptr) return otherwise;
    if (found->value != "true" && found->value != "false") error(found->place, "not a truth value", json::quote(found->value), "true or false");
    return found->value == "true";
  }
  std::optional<std::uint64_t> number(const std::string& path, std::uint64_t most) {
    const IniLine* const found = line(path);
    if (found == nullptr) return std::nullopt;
    std::uint64_t value = 0;
    const auto [stop, failed] = std::from_chars(found->value.data(), found->value.data() + found->value.size(), value);
    if (failed == std::errc() && stop == found->value.data() + found->value.size() && value <= most) return value;
    error(found->place, "not a number that fits", json::quote(found->value), "a whole number up to " + std::to_string(most));
    return std::nullopt;
  }
  std::optional<Duration> duration(const std::string& value, const json::Place& place) {
    const auto parsed = json::parse_duration(takt_unit(value));
    if (parsed) return *parsed;
    error(place, "not a time that is read", json::quote(value), "a number with a unit, such as 500us");
    return std::nullopt;
  }
  std::optional<Duration> duration(const std::string& path) {
    const IniLine* const found = line(path);
    return found == nullptr ? std::nullopt : duration(found->value, found->place);
  }
  std::optional<sim::DataRate> rate(const std::string& value, const json::Place& place) {
    const auto parsed = json::parse_data_rate(takt_unit(value));
    if (parsed) return *parsed;
    error(place, "not a rate that is read", json::quote(value), "a number with a unit, such as 100Mbps");
    return std::nullopt;
  }
  std::optional<json::Node> value(const std::string& path, json::Kind kind, const char* expected) {
    const IniLine* const found = line(path);
    if (found == nullptr) return std::nullopt;
    auto parsed = parse_value(found->value);
    if (parsed && parsed->kind == kind) return parsed;
    error(found->place, "not what is read", json::quote(found->value), expected);
    return std::nullopt;
  }

  void read_general() {
    const IniLine* const limit = ini_.find_global("sim-time-limit");
    scenario_.duration = Duration::from_ps(100'000'000'000);
    if (limit != nullptr) scenario_.duration = duration(limit->value, limit->place).value_or(scenario_.duration);
    else imported_.remark(RemarkKind::odd, network_.place, "no sim-time-limit: 100 ms");
    if (const IniLine* const seed = ini_.find_global("seed-set")) {
      std::uint64_t number = 0;
      const auto [stop, failed] = std::from_chars(seed->value.data(), seed->value.data() + seed->value.size(), number);
      if (failed == std::errc() && stop == seed->value.data() + seed->value.size() && number < 1u << 31) scenario_.seed = number;
      else imported_.remark(RemarkKind::ignored, seed->place, "seed-set, which is no number");
    }
  }

  void read_nodes() {
    for (const Submodule& node : network_.submodules) {
      if (node.type == "TsnDevice" || node.type == "StandardHost") scenario_.network.nodes.emplace_back(node.name, scenario::Node(scenario::HostNode{}));
      else if (node.type == "TsnSwitch" || node.type == "EthernetSwitch") scenario_.network.nodes.emplace_back(node.name, scenario::Node(scenario::SwitchNode{}));
      else error(node.place, "a type of node that is not read", json::quote(node.type), "TsnDevice, TsnSwitch, StandardHost or EthernetSwitch");
    }
  }

  std::optional<sim::DataRate> rate_of_end(const std::string& node, std::uint32_t eth) {
    const IniLine* const found = line(node + ".eth[" + std::to_string(eth) + "].bitrate");
    return found == nullptr ? std::nullopt : rate(found->value, found->place);
  }

  void read_links() {
    for (const Connection& each : network_.connections) {
      scenario::Link link;
      for (const std::string* const end : {&each.a, &each.b})
        if (std::ranges::none_of(network_.submodules, [&](const Submodule& node) { return node.name == *end; })) error(each.place, "an end that is no submodule", json::quote(*end), "a submodule of the network");
      link.ends = {each.a + ":" + std::to_string(each.a_eth), each.b + ":" + std::to_string(each.b_eth)};
      ports_[each.a][each.a_eth] = each.b;
      ports_[each.b][each.b_eth] = each.a;
      std::optional<sim::DataRate> chosen;
      const std::map<std::string, std::uint64_t> channels = {{"Eth10M", 10'000'000}, {"Eth100M", 100'000'000}, {"Eth1G", 1'000'000'000}, {"Eth10G", 10'000'000'000}, {"Eth40G", 40'000'000'000}, {"Eth100G", 100'000'000'000}};
      if (const auto channel = channels.find(each.channel); channel != channels.end()) chosen = sim::DataRate{channel->second};
      else if (each.channel != "EthernetLink" && !each.channel.empty()) error(each.place, "a channel that is not read", json::quote(each.channel), "EthernetLink, Eth100M, Eth1G and the like");
      if (each.datarate) chosen = rate(*each.datarate, each.place);
      for (const auto& [node, eth] : {std::pair(each.a, each.a_eth), std::pair(each.b, each.b_eth)}) {
        const auto own = rate_of_end(node, eth);
        if (own && chosen && !(*own == *chosen)) error(each.place, "two rates of one link", json::to_text(*own) + " at " + node + ", " + json::to_text(*chosen) + " elsewhere", "the same bitrate at both ends, and as datarate");
        if (own) chosen = own;
      }
      if (!chosen) { error(each.place, "a link without a rate", each.a + " to " + each.b, "datarate, or *.*.eth[*].bitrate in the ini file"); continue; }
      link.rate = *chosen;
      if (each.delay) link.delay = duration(*each.delay, each.place);
      else if (each.length) {
        const auto parsed = json::parse_length(takt_unit(*each.length));
        if (parsed) link.length = *parsed;
        else error(each.place, "not a length that is read", json::quote(*each.length), "a number with a unit, such as 10m");
      }
      scenario_.network.links.push_back(std::move(link));
    }
  }

  void read_node(const Submodule& node) {
    auto found = std::ranges::find(scenario_.network.nodes, node.name, [](const auto& each) -> const std::string& { return each.first; });
    const bool is_host = std::holds_alternative<scenario::HostNode>(found->second);
    const bool is_shaped = truth(node.name + ".hasEgressTrafficShaping");
    truth(node.name + ".hasStreamRedundancy");
    truth(node.name + ".hasIncomingStreams");
    if (is_host) read_apps(node);
    if (scenario::Relay* const relay = scenario::relay_of(found->second)) {
      const auto type = text(node.name + ".bridging.directionReverser.delayer.typename");
      const auto delay = duration(node.name + ".bridging.directionReverser.delayer.delay");
      if (type && *type == "PacketDelayer" && delay) relay->forwarding_delay = *delay;
      else if (type) error(line(node.name + ".bridging.directionReverser.delayer.typename")->place, "a delayer that is not read", json::quote(*type), "PacketDelayer with a delay");
    }
    for (const auto& [eth, peer] : ports_[node.name]) read_port(node, eth, peer, is_shaped, scenario::ports_of(found->second));
  }

  struct App {
    std::uint64_t port = 0;
    std::string to;
    std::uint32_t length = 0;
    Duration interval, offset;
    bool is_exponential = false;
    json::Place place;
  };

  void read_apps(const Submodule& node) {
    const std::uint64_t count = number(node.name + ".numApps", 4096).value_or(0);
    std::vector<App> apps;
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::string prefix = node.name + ".app[" + std::to_string(i) + "].";
      const IniLine* const type_line = line(prefix + "typename");
      const auto type = text(prefix + "typename");
      if (!type) { if (type_line == nullptr) error(node.place, "an application without a type", prefix + "typename", "UdpSourceApp or UdpSinkApp"); continue; }
      if (*type == "UdpSinkApp") { number(prefix + "io.localPort", 65535); continue; }
      if (*type != "UdpSourceApp") { error(type_line->place, "an application that is not read", json::quote(*type), "UdpSourceApp or UdpSinkApp"); continue; }
      App app;
      app.place = type_line->place;
      app.port = number(prefix + "io.destPort", 65535).value_or(0);
      app.to = text(prefix + "io.destAddress").value_or("");
      const IniLine* const length = line(prefix + "source.packetLength");
      if (length == nullptr) error(app.place, "an application without a length", prefix + "source.packetLength", "octets, such as 100B");
      else {
        const auto parsed = json::parse_octets(takt_unit(length->value));
        if (parsed) app.length = (*parsed).count;
        else error(length->place, "not a length that is read", json::quote(length->value), "octets, such as 100B");
      }
      const IniLine* const interval = line(prefix + "source.productionInterval");
      if (interval == nullptr) { error(app.place, "an application without an interval", prefix + "source.productionInterval", "a time"); continue; }
      std::string every = interval->value;
      if (every.starts_with("exponential(") && every.ends_with(")")) {
        app.is_exponential = true;
        every = every.substr(12, every.size() - 13);
      }
      app.interval = duration(every, interval->place).value_or(Duration::from_ps(1));
      if (const IniLine* const offset = line(prefix + "source.initialProductionOffset"); offset != nullptr && !offset->value.starts_with("-")) app.offset = duration(offset->value, offset->place).value_or(Duration());
      if (std::ranges::find(network_.submodules, app.to, &Submodule::name) == network_.submodules.end()) error(app.place, "a receiver that is not there", json::quote(app.to), "the name of a node");
      apps.push_back(std::move(app));
    }
    add_streams(node, apps);
  }

  /// Which stream the frames to a port are, and what tag they get.
  void add_streams(const Submodule& node, std::vector<App>& apps) {
    truth(node.name + ".hasOutgoingStreams");
    std::map<std::uint64_t, std::string> name_of_port;
    if (const auto mapping = value(node.name + ".bridging.streamIdentifier.identifier.mapping", json::Kind::array, "[{stream: \"s\", packetFilter: expr(udp.destPort == N)}, ..]"))
      for (const json::Node& entry : mapping->items) {
        const json::Node* const stream = entry.find("stream");
        const json::Node* const filter = entry.find("packetFilter");
        const auto port = filter == nullptr ? std::nullopt : port_of_filter(filter->text);
        if (stream == nullptr || !port) error(line(node.name + ".bridging.streamIdentifier.identifier.mapping")->place, "an identification that is not read", json::compact(entry), "{stream: \"s\", packetFilter: expr(udp.destPort == N)}");
        else name_of_port[*port] = stream->text;
      }
    struct Tag {
      std::uint8_t pcp = 0;
      std::uint16_t vlan = 0;
    };
    std::map<std::string, Tag> tags;
    if (const auto mapping = value(node.name + ".bridging.streamCoder.encoder.mapping", json::Kind::array, "[{stream: \"s\", pcp: N}, ..]"))
      for (const json::Node& entry : mapping->items) {
        const json::Node* const stream = entry.find("stream");
        const auto small = [&](const char* key, int most) { const json::Node* const found = entry.find(key); return found == nullptr ? 0 : std::clamp(std::atoi(found->text.c_str()), 0, most); };
        if (stream == nullptr) error(line(node.name + ".bridging.streamCoder.encoder.mapping")->place, "a tag that is not read", json::compact(entry), "{stream: \"s\", pcp: N}");
        else tags[stream->text] = {static_cast<std::uint8_t>(small("pcp", 7)), static_cast<std::uint16_t>(small("vlan", 4094))};
      }
    for (std::size_t i = 0; i < apps.size(); ++i) {
      // Several applications to one port, alike but for their offsets, are a burst.
      std::vector<const App*> burst = {&apps[i]};
      while (i + 1 < apps.size() && apps[i + 1].port == apps[i].port && apps[i + 1].to == apps[i].to && apps[i + 1].length == apps[i].length && apps[i + 1].interval == apps[i].interval && !apps[i].is_exponential) burst.push_back(&apps[++i]);
      const App& app = *burst.front();
      scenario::Stream stream;
      stream.where = {};
      const auto named = name_of_port.find(app.port);
      const auto redundant = redundant_.find(app.port);
      stream.name = redundant != redundant_.end() ? redundant->second.name : named != name_of_port.end() ? named->second : unique(node.name + "-" + app.to);
      stream.from = node.name;
      stream.to.names = {app.to};
      stream.payload = sim::Octets{app.length};
      stream.offset = json::OrAuto<Duration>(app.offset);
      if (burst.size() > 1) {
        scenario::Bursts& made = stream.burst.emplace();
        made.frames = static_cast<std::uint32_t>(burst.size());
        made.every = app.interval;
        made.spacing = burst[1]->offset - burst[0]->offset;
        for (std::size_t k = 1; k < burst.size(); ++k)
          if (burst[k]->offset - burst[k - 1]->offset != made.spacing) error(burst[k]->place, "applications to one port at uneven distances", json::to_text(burst[k]->offset), "equal distances, as a burst has");
      } else if (app.is_exponential) {
        stream.exponential = scenario::ExponentialGaps{app.interval};
        imported_.remark(RemarkKind::lost, app.place, "the sequence of random gaps, and that the first frame comes at the offset: in takt it comes a gap later");
      } else {
        stream.every = app.interval;
      }
      if (const auto tag = tags.find(stream.name); tag != tags.end()) {
        stream.pcp = tag->second.pcp;
        stream.vlan = tag->second.vlan;
      }
      if (redundant != redundant_.end()) {
        stream.pcp = redundant->second.pcp;
        stream.redundancy = redundant->second.redundancy;
      }
      port_of_stream_[stream.name] = app.port;
      scenario_.streams.push_back(std::move(stream));
    }
  }

  std::string unique(const std::string& name) const {
    std::string chosen = name;
    for (int i = 2; std::ranges::any_of(scenario_.streams, [&](const scenario::Stream& each) { return each.name == chosen; }); ++i) chosen = name + "-" + std::to_string(i);
    return chosen;
  }

  /// expr(udp.destPort == 5000)
  static std::optional<std::uint64_t> port_of_filter(std::string filter) {
    std::erase(filter, ' ');
    constexpr std::string_view begin = "expr(udp.destPort==";
    if (!filter.starts_with(begin) || !filter.ends_with(")")) return std::nullopt;
    std::uint64_t port = 0;
    const char* const first = filter.data() + begin.size();
    const char* const last = filter.data() + filter.size() - 1;
    const auto [stop, failed] = std::from_chars(first, last, port);
    return failed == std::errc() && stop == last && port <= 65535 ? std::optional(port) : std::nullopt;
  }

  struct Redundant {
    std::string name;
    std::optional<std::uint8_t> pcp;
    scenario::Redundancy redundancy;
  };

  void read_redundancy() {
    const IniLine* const type = line("streamRedundancyConfigurator.typename");
    if (type == nullptr) return;
    if (text("streamRedundancyConfigurator.typename") != "StreamRedundancyConfigurator") return error(type->place, "a configurator that is not read", type->value, "StreamRedundancyConfigurator");
    const auto configuration = value("streamRedundancyConfigurator.configuration", json::Kind::array, "[{name: \"s\", packetFilter: expr(udp.destPort == N), trees: [[[..]], ..], ..}]");
    if (!configuration) return;
    const json::Place place = line("streamRedundancyConfigurator.configuration")->place;
    for (const json::Node& entry : configuration->items) {
      const json::Node* const name = entry.find("name");
      const json::Node* const filter = entry.find("packetFilter");
      const json::Node* const trees = entry.find("trees");
      const auto port = filter == nullptr ? std::nullopt : port_of_filter(filter->text);
      if (name == nullptr || !port || trees == nullptr || trees->kind != json::Kind::array || trees->items.empty()) {
        error(place, "a redundant stream that is not read", json::compact(entry).substr(0, 80), "name, packetFilter: expr(udp.destPort == N) and trees");
        continue;
      }
      Redundant made;
      made.name = name->text;
      if (const json::Node* const pcp = entry.find("pcp")) made.pcp = static_cast<std::uint8_t>(std::clamp(std::atoi(pcp->text.c_str()), 0, 7));
      std::vector<std::vector<std::string>> paths;
      for (const json::Node& tree : trees->items) {
        if (tree.kind != json::Kind::array || tree.items.size() != 1 || tree.items.front().kind != json::Kind::array || tree.items.front().items.size() < 3) {
          error(place, "a tree that is no path", json::compact(tree).substr(0, 80), "[[\"from\", \"node\", .., \"to\"]]");
          continue;
        }
        std::vector<std::string>& path = paths.emplace_back();
        for (const json::Node& node : tree.items.front().items) path.push_back(node.text);
      }
      if (paths.size() < 2) continue;
      // Split where they part, merge where they meet again.
      std::size_t common = 0;
      while (common + 1 < paths[0].size() && std::ranges::all_of(paths, [&](const auto& path) { return common + 1 < path.size() && path[common + 1] == paths[0][common + 1]; })) ++common;
      std::size_t tail = 0;
      while (tail + 1 < paths[0].size() && std::ranges::all_of(paths, [&](const auto& path) { return tail + 1 < path.size() && path[path.size() - 2 - tail] == paths[0][paths[0].size() - 2 - tail]; })) ++tail;
      scenario::Redundancy& redundancy = made.redundancy;
      redundancy.split = paths[0][common];
      redundancy.merge = paths[0][paths[0].size() - 1 - tail];
      redundancy.paths = std::move(paths);
      redundancy.history = 10;
      redundancy.keep_tag = true;
      imported_.remark(RemarkKind::lost, place, "stream " + made.name + ": INET numbers at the talker, so that the first cable has 6 octets more than in takt");
      redundant_[*port] = std::move(made);
    }
  }
  void add_redundant() {
    for (const auto& [port, redundant] : redundant_)
      if (std::ranges::none_of(scenario_.streams, [&redundant = redundant](const scenario::Stream& each) { return each.name == redundant.name; }))
        error(line("streamRedundancyConfigurator.configuration")->place, "a redundant stream that nobody sends", json::quote(redundant.name) + " to port " + std::to_string(port), "an application with that destPort");
  }

  void read_port(const Submodule& node, std::uint32_t eth, const std::string& peer, bool is_shaped, scenario::NodePorts& ports) {
    const std::string queue = node.name + ".eth[" + std::to_string(eth) + "].macLayer.queue.";
    if (const auto classes = number(queue + "numTrafficClasses", 8); classes && *classes != 8) error(line(queue + "numTrafficClasses")->place, "fewer classes", std::to_string(*classes), "8");
    scenario::Egress egress;
    egress.to = peer;
    read_map(queue, ports);
    read_gates(queue, egress);
    for (std::uint8_t q = 0; q < 8; ++q) {
      const std::string algorithm = queue + "transmissionSelectionAlgorithm[" + std::to_string(q) + "].";
      const IniLine* const type = line(algorithm + "typename");
      const IniLine* const slope = line(algorithm + "idleSlope");
      if (type != nullptr && type->value != "\"Ieee8021qCreditBasedShaper\"") error(type->place, "an algorithm that is not read", type->value, "Ieee8021qCreditBasedShaper");
      else if (type != nullptr && slope == nullptr) error(type->place, "a shaper without a slope", type->key, "idleSlope");
      else if (type != nullptr)
        if (const auto parsed = rate(slope->value, slope->place)) egress.shapers.push_back({{}, q, *parsed, scenario::SlopeOf::window});
      read_limits(queue, q, ports);
    }
    const bool says_something = egress.gates || !egress.shapers.empty();
    if (says_something && !is_shaped) error(node.place, "gates or shapers of a node without traffic shaping", json::quote(node.name), "*." + node.name + ".hasEgressTrafficShaping = true");
    if (says_something) ports.egress.push_back(std::move(egress));
  }

  void read_map(const std::string& queue, scenario::NodePorts& ports) {
    const auto mapping = value(queue + "classifier.mapping", json::Kind::array, "a row for each priority");
    if (!mapping) return;
    std::string column;
    for (const json::Node& row : mapping->items) column += row.kind == json::Kind::array && row.items.size() == 8 ? row.items[7].text : "?";
    if (column == "01234567") ports.traffic_classes = scenario::TrafficClasses::identity;
    else if (column != "10234567") error(line(queue + "classifier.mapping")->place, "a map from priorities to classes that takt does not have", json::quote(column), "10234567 or 01234567 in the column of eight classes");
  }

  void read_limits(const std::string& queue, std::uint8_t q, scenario::NodePorts& ports) {
    const std::string prefix = queue + "queue[" + std::to_string(q) + "].";
    const auto frames = number(prefix + "packetCapacity", 0xFFFF'FFFE);
    const IniLine* const octets = line(prefix + "dataCapacity");
    if (!frames && octets == nullptr) return;
    scenario::Queues::PerClass limit;
    limit.traffic_class = q;
    if (frames) limit.frames = static_cast<std::uint32_t>(*frames);
    if (octets != nullptr) {
      const auto parsed = json::parse_octets(takt_unit(octets->value));
      if (parsed) limit.octets = *parsed;
      else error(octets->place, "not a length that is read", json::quote(octets->value), "octets, such as 100B");
    }
    const auto other = std::ranges::find(ports.queues.classes, q, &scenario::Queues::PerClass::traffic_class);
    if (other == ports.queues.classes.end()) ports.queues.classes.push_back(limit);
    else if (!(*other == limit)) error(octets != nullptr ? octets->place : line(prefix + "packetCapacity")->place, "limits that differ from port to port", "class " + std::to_string(q), "the same for all ports of a node, as takt has it");
  }

  /// One list for a port of eight: the least common cycle, and an entry at each change; the lists are in force from 0 on.
  void read_gates(const std::string& queue, scenario::Egress& egress) {
    std::array<ClassGate, 8> gates;
    std::int64_t cycle = 1;
    bool any = false;
    for (std::size_t q = 0; q < 8; ++q) {
      const std::string gate = queue + "transmissionGate[" + std::to_string(q) + "].";
      const IniLine* const durations = line(gate + "durations");
      ClassGate& made = gates[q];
      made.initially = truth(gate + "initiallyOpen", true);
      if (const auto offset = duration(gate + "offset")) made.offset = offset->ps();
      if (!truth(gate + "enableImplicitGuardBand", true)) error(line(gate + "enableImplicitGuardBand")->place, "gates that do not look at lengths", "false", "true, as takt's gates");
      any = any || !made.initially;
      const auto list = value(gate + "durations", json::Kind::array, "a list of times");
      if (!list) continue;
      for (const json::Node& item : list->items) {
        const auto length = duration(item.text, durations->place);
        made.durations.push_back(length ? length->ps() : 1);
        made.sum += made.durations.back();
        if (made.durations.back() <= 0 || made.sum > 3'600'000'000'000'000) { error(durations->place, "not a duration of a gate", json::quote(item.text), "more than 0, in all at most an hour"); return; }
      }
      if (made.durations.size() % 2 != 0) { error(durations->place, "an odd number of durations", std::to_string(made.durations.size()), "an even number, so that the cycle ends as it began"); return; }
      if (made.sum > 0) {
        any = true;
        cycle = cycle == 1 ? made.sum : std::lcm(cycle, made.sum);
        if (cycle > 3'600'000'000'000'000) { error(durations->place, "cycles without a common one of at most an hour", std::to_string(made.sum) + " ps", "cycles that go into each other"); return; }
      }
    }
    if (!any || diagnostics_.has_errors()) return;
    scenario::Gates made = one_list(gates, cycle == 1 ? 1'000'000'000 : cycle);
    if (made.entries.size() > 1024) { error(line(queue + "transmissionGate[0].durations") != nullptr ? line(queue + "transmissionGate[0].durations")->place : network_.place, "a gate list that takt does not have", std::to_string(made.entries.size()) + " entries", "at most 1024"); return; }
    if (made.entries.size() == 1 && made.entries.front().open.size() == 8) return;
    egress.gates = std::move(made);
  }

  void refuse_the_rest() {
    constexpr std::string_view of_no_account[] = {"record", "isualiz", "display", "description", "result-dir", "cmdenv", "qtenv", "vector", "scalar", "statistic", "debug", "eventlog", "print"};
    for (const IniLine& each : ini_.lines()) {
      if (each.is_used) continue;
      if (std::ranges::any_of(of_no_account, [&](std::string_view word) { return each.key.find(word) != std::string::npos; })) imported_.remark(RemarkKind::ignored, each.place, each.key);
      else error(each.place, "a setting that is not understood, or matches nothing", json::quote(each.key), "what docs/interchange.md lists");
    }
  }

  const ImportRequest& request_;
  Imported& imported_;
  json::Diagnostics& diagnostics_;
  Ini ini_;
  Network network_;
  scenario::Scenario scenario_;
  std::map<std::string, std::map<std::uint32_t, std::string>> ports_;   // by node: its interfaces and the neighbours at them
  std::map<std::string, std::uint64_t> port_of_stream_;
  std::map<std::uint64_t, Redundant> redundant_;                        // by UDP port
};

constexpr SettingInfo inet_import_table[] = {{"config", "the name of a section", "General", "of the ini file: that section and what it extends"}};

}  // namespace
}  // namespace inet

const std::span<const SettingInfo> inet_import_settings = inet::inet_import_table;

Imported import_inet(const ImportRequest& request, json::Diagnostics& diagnostics) {
  Imported imported;
  inet::InetReader(request, imported, diagnostics).run();
  return imported;
}

}  // namespace takt::interchange
