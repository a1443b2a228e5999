// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <charconv>

#include "interchange/inet/reader.hpp"

namespace takt::interchange::inet {
void InetReader::read_apps(const Submodule& node) {
  const std::uint64_t count = number(node.name + ".numApps", 4096).value_or(0);
  std::vector<App> apps;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::string prefix = node.name + ".app[" + std::to_string(i) + "].";
    const IniLine* const type_line = line(prefix + "typename");
    const auto type = text(prefix + "typename");
    if (!type) {
      if (type_line == nullptr)
        error(node.place, "an application without a type", prefix + "typename", "UdpSourceApp or UdpSinkApp");
      continue;
    }
    if (*type == "UdpSinkApp") {
      number(prefix + "io.localPort", 65535);
      continue;
    }
    if (*type != "UdpSourceApp") {
      error(type_line->place, "an application that is not read", json::quote(*type), "UdpSourceApp or UdpSinkApp");
      continue;
    }
    App app;
    app.place = type_line->place;
    app.port = number(prefix + "io.destPort", 65535).value_or(0);
    app.to = text(prefix + "io.destAddress").value_or("");
    const IniLine* const length = line(prefix + "source.packetLength");
    if (length == nullptr)
      error(app.place, "an application without a length", prefix + "source.packetLength", "octets, such as 100B");
    else {
      app.length = octets(length->value, length->place).value_or(sim::Octets{1}).count;
    }
    const IniLine* const interval = line(prefix + "source.productionInterval");
    if (interval == nullptr) {
      error(app.place, "an application without an interval", prefix + "source.productionInterval", "a time");
      continue;
    }
    std::string every = interval->value;
    if (every.starts_with("exponential(") && every.ends_with(")")) {
      app.is_exponential = true;
      every = every.substr(12, every.size() - 13);
    }
    // Of other random intervals the mean.
    for (const std::string_view law : {"truncnormal(", "normal("})
      if (every.starts_with(law) && every.find(',') != std::string::npos) {
        imported_.remark(RemarkKind::lost, interval->place, "random intervals, " + every + ": their mean is taken");
        every = every.substr(law.size(), every.find(',') - law.size());
      }
    app.interval = duration(every, interval->place).value_or(Duration::from_ps(1));
    if (const IniLine* const offset = line(prefix + "source.initialProductionOffset");
        offset != nullptr && !offset->value.starts_with("-"))
      app.offset = duration(offset->value, offset->place).value_or(Duration());
    if (std::ranges::find(network_.submodules, app.to, &Submodule::name) == network_.submodules.end())
      error(app.place, "a receiver that is not there", json::quote(app.to), "the name of a node");
    apps.push_back(std::move(app));
  }
  add_streams(node, apps);
}

void InetReader::add_streams(const Submodule& node, std::vector<App>& apps) {
  truth(node.name + ".hasOutgoingStreams");
  std::map<std::uint64_t, std::string> name_of_port;
  if (const auto mapping = value(node.name + ".bridging.streamIdentifier.identifier.mapping", json::Kind::array,
                                 "[{stream: \"s\", packetFilter: expr(udp.destPort == N)}, ..]"))
    for (const json::Node& entry : mapping->items) {
      const json::Node* const stream = entry.find("stream");
      const json::Node* const filter = entry.find("packetFilter");
      const auto port = filter == nullptr ? std::nullopt : port_of_filter(filter->text);
      if (stream == nullptr || !port)
        error(line(node.name + ".bridging.streamIdentifier.identifier.mapping")->place,
              "an identification that is not read", json::compact(entry),
              "{stream: \"s\", packetFilter: expr(udp.destPort == N)}");
      else
        name_of_port[*port] = stream->text;
    }
  struct Tag {
    std::uint8_t pcp = 0;
    std::uint16_t vlan = 0;
  };
  std::map<std::string, Tag> tags;
  if (const auto mapping = value(node.name + ".bridging.streamCoder.encoder.mapping", json::Kind::array,
                                 "[{stream: \"s\", pcp: N}, ..]"))
    for (const json::Node& entry : mapping->items) {
      const json::Node* const stream = entry.find("stream");
      const auto small = [&](const char* key, int most) {
        const json::Node* const found = entry.find(key);
        return found == nullptr ? 0 : std::clamp(std::atoi(found->text.c_str()), 0, most);
      };
      if (stream == nullptr)
        error(line(node.name + ".bridging.streamCoder.encoder.mapping")->place, "a tag that is not read",
              json::compact(entry), "{stream: \"s\", pcp: N}");
      else
        tags[stream->text] = {static_cast<std::uint8_t>(small("pcp", 7)),
                              static_cast<std::uint16_t>(small("vlan", 4094))};
    }
  for (std::size_t i = 0; i < apps.size(); ++i) {
    // Several applications to one port, alike but for their offsets, are a burst.
    std::vector<const App*> burst = {&apps[i]};
    while (i + 1 < apps.size() && apps[i + 1].port == apps[i].port && apps[i + 1].to == apps[i].to &&
           apps[i + 1].length == apps[i].length && apps[i + 1].interval == apps[i].interval && !apps[i].is_exponential)
      burst.push_back(&apps[++i]);
    const App& app = *burst.front();
    scenario::Stream stream;
    stream.where = {};
    const auto named = name_of_port.find(app.port);
    const auto redundant = redundant_.find(app.port);
    const std::string identity = redundant != redundant_.end() ? redundant->second.name
                                 : named != name_of_port.end() ? named->second
                                                               : node.name + "-" + app.to;
    stream.name = unique(identity);  // INET's streams of one name may have several talkers
    identity_of_stream_[stream.name] = identity;
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
        if (burst[k]->offset - burst[k - 1]->offset != made.spacing)
          error(burst[k]->place, "applications to one port at uneven distances", json::to_text(burst[k]->offset),
                "equal distances, as a burst has");
    } else if (app.is_exponential) {
      stream.exponential = scenario::ExponentialGaps{app.interval};
      imported_.remark(
          RemarkKind::lost, app.place,
          "the sequence of random gaps, and that the first frame comes at the offset: in takt it comes a gap later");
    } else {
      stream.every = app.interval;
    }
    if (const auto tag = tags.find(identity); tag != tags.end()) {
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

std::string InetReader::unique(const std::string& name) const {
  std::string chosen = name;
  for (int i = 2;
       std::ranges::any_of(scenario_.streams, [&](const scenario::Stream& each) { return each.name == chosen; }); ++i)
    chosen = name + "-" + std::to_string(i);
  return chosen;
}

std::optional<std::uint64_t> InetReader::port_of_filter(std::string filter) {
  std::erase(filter, ' ');
  if (filter.starts_with("expr(has(udp)&&")) filter.replace(0, 15, "expr(");
  constexpr std::string_view begin = "expr(udp.destPort==";
  if (!filter.starts_with(begin) || !filter.ends_with(")")) return std::nullopt;
  std::uint64_t port = 0;
  const char* const first = filter.data() + begin.size();
  const char* const last = filter.data() + filter.size() - 1;
  const auto [stop, failed] = std::from_chars(first, last, port);
  return failed == std::errc() && stop == last && port <= 65535 ? std::optional(port) : std::nullopt;
}

void InetReader::read_redundancy() {
  const IniLine* const type = line("streamRedundancyConfigurator.typename");
  if (type == nullptr) return;
  if (text("streamRedundancyConfigurator.typename") != "StreamRedundancyConfigurator")
    return error(type->place, "a configurator that is not read", type->value, "StreamRedundancyConfigurator");
  const auto configuration = value("streamRedundancyConfigurator.configuration", json::Kind::array,
                                   "[{name: \"s\", packetFilter: expr(udp.destPort == N), trees: [[[..]], ..], ..}]");
  if (!configuration) return;
  const json::Place place = line("streamRedundancyConfigurator.configuration")->place;
  for (const json::Node& entry : configuration->items) {
    const json::Node* const name = entry.find("name");
    const json::Node* const filter = entry.find("packetFilter");
    const json::Node* const trees = entry.find("trees");
    const auto port = filter == nullptr ? std::nullopt : port_of_filter(filter->text);
    if (name == nullptr || !port || trees == nullptr || trees->kind != json::Kind::array || trees->items.empty()) {
      error(place, "a redundant stream that is not read", json::compact(entry).substr(0, 80),
            "name, packetFilter: expr(udp.destPort == N) and trees");
      continue;
    }
    Redundant made;
    made.name = name->text;
    if (const json::Node* const pcp = entry.find("pcp"))
      made.pcp = static_cast<std::uint8_t>(std::clamp(std::atoi(pcp->text.c_str()), 0, 7));
    std::vector<std::vector<std::string>> paths;
    for (const json::Node& tree : trees->items) {
      if (tree.kind != json::Kind::array || tree.items.size() != 1 || tree.items.front().kind != json::Kind::array ||
          tree.items.front().items.size() < 3) {
        error(place, "a tree that is no path", json::compact(tree).substr(0, 80), "[[\"from\", \"node\", .., \"to\"]]");
        continue;
      }
      std::vector<std::string>& path = paths.emplace_back();
      for (const json::Node& node : tree.items.front().items) path.push_back(node.text);
    }
    if (paths.size() < 2) continue;
    // Split where they part, merge where they meet again.
    std::size_t common = 0;
    while (common + 1 < paths[0].size() && std::ranges::all_of(paths, [&](const auto& path) {
             return common + 1 < path.size() && path[common + 1] == paths[0][common + 1];
           }))
      ++common;
    std::size_t tail = 0;
    while (tail + 1 < paths[0].size() && std::ranges::all_of(paths, [&](const auto& path) {
             return tail + 1 < path.size() && path[path.size() - 2 - tail] == paths[0][paths[0].size() - 2 - tail];
           }))
      ++tail;
    scenario::Redundancy& redundancy = made.redundancy;
    redundancy.split = paths[0][common];
    redundancy.merge = paths[0][paths[0].size() - 1 - tail];
    redundancy.paths = std::move(paths);
    redundancy.history = 10;
    redundancy.keep_tag = true;
    imported_.remark(
        RemarkKind::lost, place,
        "stream " + made.name + ": INET numbers at the talker, so that the first cable has 6 octets more than in takt");
    redundant_[*port] = std::move(made);
  }
}

void InetReader::add_redundant() {
  for (const auto& [port, redundant] : redundant_)
    if (std::ranges::none_of(scenario_.streams, [&redundant = redundant](const scenario::Stream& each) {
          return each.name == redundant.name;
        }))
      error(line("streamRedundancyConfigurator.configuration")->place, "a redundant stream that nobody sends",
            json::quote(redundant.name) + " to port " + std::to_string(port), "an application with that destPort");
}

}  // namespace takt::interchange::inet
