// SPDX-License-Identifier: Apache-2.0
#include "interchange/csv/streams.hpp"

#include <algorithm>
#include <charconv>
#include <set>

#include "interchange/csv/records.hpp"
#include "json/quantity.hpp"
#include "json/suggest.hpp"

namespace takt::interchange {
namespace {

using csv::Cell;
using csv::Row;

class StreamsReader {
 public:
  StreamsReader(Imported& imported, json::Diagnostics& diagnostics) : imported_(imported), diagnostics_(diagnostics) {}

  void read(const csv::Table& table, std::vector<scenario::Stream>& streams) {
    order_.clear();
    separator_ = table.separator;
    const std::size_t errors = diagnostics_.errors();
    read_header(table.header);
    if (diagnostics_.errors() != errors) return;
    for (const Row& row : table.rows) read_row(row, streams);
  }

 private:
  struct Column {
    std::string_view name;
    bool is_required;
    void (*set)(StreamsReader& reader, const Cell& cell, scenario::Stream& stream);
  };

  static const std::vector<Column>& columns() {
    using scenario::Stream;
    static const std::vector<Column> all = {
        {"name", true, [](StreamsReader&, const Cell& cell, Stream& s) { s.name = cell.text; }},
        {"from", true, [](StreamsReader&, const Cell& cell, Stream& s) { s.from = cell.text; }},
        {"to", true,
         [](StreamsReader& r, const Cell& cell, Stream& s) { s.to.names = csv::names_in(cell, r.separator_); }},
        {"payload", true,
         [](StreamsReader& r, const Cell& cell, Stream& s) {
           s.payload = sim::Octets{static_cast<std::uint32_t>(r.number(cell, 1, 1500, "octets from 1 to 1500"))};
         }},
        {"every", true, [](StreamsReader& r, const Cell& cell, Stream& s) { s.every = r.duration(cell); }},
        {"offset", false,
         [](StreamsReader& r, const Cell& cell, Stream& s) {
           if (cell.text == "auto")
             s.offset.emplace().is_auto = true;
           else
             s.offset = json::OrAuto<sim::Duration>(r.duration(cell));
         }},
        {"jitter", false, [](StreamsReader& r, const Cell& cell, Stream& s) { s.jitter = r.duration(cell); }},
        {"pcp", false,
         [](StreamsReader& r, const Cell& cell, Stream& s) {
           s.pcp = static_cast<std::uint8_t>(r.number(cell, 0, 7, "a priority from 0 to 7"));
         }},
        {"vlan", false,
         [](StreamsReader& r, const Cell& cell, Stream& s) {
           s.vlan = static_cast<std::uint16_t>(r.number(cell, 0, 4094, "a VLAN from 0 to 4094"));
         }},
        {"encapsulation", false,
         [](StreamsReader& r, const Cell& cell, Stream& s) {
           if (cell.text == "ethernet")
             s.encapsulation = scenario::Encapsulation::ethernet;
           else if (cell.text != "udp")
             r.refuse(cell, "not an encapsulation", "udp or ethernet");
         }},
        {"latency", false,
         [](StreamsReader& r, const Cell& cell, Stream& s) { r.latencies.emplace_back(s.name, r.duration(cell)); }},
    };
    return all;
  }

  void refuse(const Cell& cell, std::string message, std::string expected, std::string suggestion = {}) {
    diagnostics_.error(cell.place, std::move(message),
                       {json::quote(cell.text), std::move(expected), std::move(suggestion)});
  }

  std::uint64_t number(const Cell& cell, std::uint64_t least, std::uint64_t most, const char* expected) {
    std::uint64_t value = 0;
    const std::string plain = csv::as_quantity(cell.text, "", separator_ != ',');
    std::string_view text = plain;
    if (text.ends_with("B")) text.remove_suffix(1);
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (!text.empty() && error == std::errc() && stop == text.data() + text.size() && value >= least && value <= most)
      return value;
    refuse(cell, "not a number that fits", expected);
    return least;
  }
  sim::Duration duration(const Cell& cell) {
    const auto parsed = json::parse_duration(csv::as_quantity(cell.text, "", separator_ != ','));
    if (parsed) return *parsed;
    refuse(cell, "not a duration: " + parsed.reason().message, "such as 500us", parsed.reason().suggestion);
    return sim::Duration::from_ps(1'000'000'000);
  }

  void read_header(const Row& row) {
    std::set<std::string_view> seen;
    for (const Cell& cell : row) {
      const auto column = std::ranges::find(columns(), cell.text, &Column::name);
      if (column == columns().end()) {
        std::vector<std::string_view> names;
        for (const Column& each : columns()) names.push_back(each.name);
        refuse(cell, "an unknown column",
               "name, from, to, payload, every, offset, jitter, pcp, vlan, encapsulation or latency",
               json::suggest(cell.text, names));
        continue;
      }
      if (!seen.insert(column->name).second) refuse(cell, "a column twice", "each once");
      order_.push_back(&*column);
    }
    for (const Column& column : columns())
      if (column.is_required && !seen.contains(column.name) && !diagnostics_.has_errors())
        diagnostics_.error(row.front().place, "a column that must be there is not",
                           {"no " + json::quote(column.name), "name, from, to, payload and every"});
  }

  void read_row(const Row& row, std::vector<scenario::Stream>& streams) {
    scenario::Stream stream;
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (!row[i].text.empty())
        order_[i]->set(*this, row[i], stream);
      else if (order_[i]->is_required)
        refuse(row[i], "an empty cell", "a value");
    }
    if (std::ranges::any_of(streams, [&](const scenario::Stream& each) { return each.name == stream.name; }))
      diagnostics_.error(row.front().place, "a stream twice",
                         {json::quote(stream.name) + " a second time", "a name of its own"});
    imported_.origins["/streams/" + std::to_string(streams.size())] = row.front().place;
    for (std::size_t i = 0; i < row.size(); ++i)
      imported_.origins["/streams/" + std::to_string(streams.size()) + "/" + std::string(order_[i]->name)] =
          row[i].place;
    streams.push_back(std::move(stream));
  }

 public:
  std::vector<std::pair<std::string, sim::Duration>> latencies;  ///< required of streams

 private:
  Imported& imported_;
  json::Diagnostics& diagnostics_;
  std::vector<const Column*> order_;
  char separator_ = ',';
};

/// Devices that only cables name: what has more than one cable is a switch.
void add_ends_of_cables(scenario::Scenario& scenario, Imported& imported) {
  std::map<std::string, std::size_t> cables;
  std::vector<std::string> names;
  for (const scenario::Link& link : scenario.network.links)
    for (const std::string& end : link.ends) {
      const std::string name = end.substr(0, end.rfind(':'));
      if (cables[name]++ == 0) names.push_back(name);
    }
  std::size_t made = 0;
  for (const std::string& name : names) {
    if (std::ranges::any_of(scenario.network.nodes, [&](const auto& each) { return each.first == name; })) continue;
    scenario.network.nodes.emplace_back(
        name, cables[name] > 1 ? scenario::Node(scenario::SwitchNode{}) : scenario::Node(scenario::HostNode{}));
    ++made;
  }
  if (made == 0 || !scenario.network.generate.empty()) return;
  const json::Place place =
      imported.origins.empty() ? json::Place{} : json::Place{imported.origins.begin()->second.file, 0, 0, ""};
  imported.remark(
      RemarkKind::changed, place,
      std::to_string(made) +
          " devices of which no table says the kind: those with more than one cable are switches, the others hosts");
}

}  // namespace

Imported import_csv(const ImportRequest& request, json::Diagnostics& diagnostics) {
  Imported imported;
  scenario::Scenario scenario;
  if (request.base != nullptr) {
    scenario = *request.base;
  } else {
    scenario.name = request.files.empty() ? "streams" : request.files.front().device;
    scenario.duration = sim::Duration::from_ps(100'000'000'000);
  }
  std::vector<scenario::Stream> streams = scenario.streams;
  StreamsReader reader(imported, diagnostics);
  bool has_network = request.base != nullptr;
  for (const InputFile& file : request.files) {
    const csv::Table table = csv::read_table(file, diagnostics);
    const auto kind = csv::kind_of(table, diagnostics);
    if (!kind) continue;
    has_network = has_network || *kind == csv::TableKind::cables || *kind == csv::TableKind::devices;
    switch (*kind) {
      case csv::TableKind::streams:
        reader.read(table, streams);
        break;
      case csv::TableKind::cables:
        csv::read_cables(table, scenario, imported, diagnostics);
        break;
      case csv::TableKind::devices:
        csv::read_devices(table, scenario, imported, diagnostics);
        break;
      case csv::TableKind::programs:
        csv::read_programs(table, scenario, imported, diagnostics);
        break;
    }
  }
  if (diagnostics.has_errors()) return imported;
  if (has_network) add_ends_of_cables(scenario, imported);
  // Without a network: the hosts that are named, at one switch.
  if (!has_network) {
    std::set<std::string> hosts;
    for (const scenario::Stream& stream : streams) {
      hosts.insert(stream.from);
      hosts.insert(stream.to.names.begin(), stream.to.names.end());
    }
    std::string hub = "sw";
    while (hosts.contains(hub)) hub += "0";
    for (const std::string& host : hosts) {
      scenario.network.nodes.emplace_back(host, scenario::Node(scenario::HostNode{}));
      scenario::Link link;
      link.ends = {host, hub};
      scenario.network.links.push_back(link);
    }
    scenario.network.nodes.emplace_back(hub, scenario::Node(scenario::SwitchNode{}));
    imported.remark(RemarkKind::lost, {request.files.front().name, 0, 0, ""},
                    "the network: a table of streams says none (--into), so all hosts are at one switch of 1 Gb/s");
  }
  scenario.streams = std::move(streams);
  for (const auto& [name, latency] : reader.latencies) {
    scenario::Requirement requirement;
    requirement.stream = name;
    requirement.latency.emplace().at_most = latency;
    imported.origins["/require/" + std::to_string(scenario.require.size())] =
        imported
            .origins["/streams/" + std::to_string(std::ranges::find(scenario.streams, name, &scenario::Stream::name) -
                                                  scenario.streams.begin())];
    scenario.require.push_back(std::move(requirement));
  }
  imported.scenario = std::move(scenario);
  return imported;
}

}  // namespace takt::interchange
