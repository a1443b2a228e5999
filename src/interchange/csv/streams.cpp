#include "interchange/csv/streams.hpp"

#include <algorithm>
#include <charconv>
#include <set>

#include "json/quantity.hpp"
#include "json/suggest.hpp"

namespace takt::interchange {
namespace {

struct Cell {
  std::string text;
  json::Place place;
};
using Row = std::vector<Cell>;

/// RFC 4180 with a comma between; blank lines and lines that begin with # are passed over.
std::vector<Row> rows_of(const InputFile& file, json::Diagnostics& diagnostics) {
  std::vector<Row> rows;
  const std::string_view text = file.text;
  std::uint32_t line = 1, column = 1;
  std::size_t at = 0;
  while (at < text.size()) {
    if (text[at] == '\n' || text[at] == '#' || text[at] == '\r') {   // an empty line or a comment
      while (at < text.size() && text[at] != '\n') ++at;
      ++at;
      ++line;
      continue;
    }
    Row row;
    column = 1;
    for (bool goes_on = true; goes_on;) {
      Cell cell{"", {file.name, line, column, ""}};
      if (at < text.size() && text[at] == '"') {
        ++at;
        ++column;
        while (at < text.size() && !(text[at] == '"' && (at + 1 >= text.size() || text[at + 1] != '"'))) {
          if (text[at] == '"') ++at;   // two stand for one
          if (text[at] == '\n') { ++line; column = 0; }
          cell.text += text[at++];
          ++column;
        }
        if (at >= text.size()) diagnostics.error(cell.place, "a cell that does not end", {"no closing quote", "a quote at its end"});
        else { ++at; ++column; }
      }
      while (at < text.size() && text[at] != ',' && text[at] != '\n') {
        if (text[at] != '\r') cell.text += text[at];
        ++at;
        ++column;
      }
      goes_on = at < text.size() && text[at] == ',';
      if (at < text.size()) ++at;
      ++column;
      row.push_back(std::move(cell));
    }
    ++line;
    rows.push_back(std::move(row));
  }
  return rows;
}

class StreamsReader {
 public:
  StreamsReader(json::Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  void read(const InputFile& file, std::vector<scenario::Stream>& streams) {
    const std::vector<Row> rows = rows_of(file, diagnostics_);
    if (rows.empty()) return diagnostics_.error({file.name, 1, 1, ""}, "no header", {"an empty file", "name,from,to,payload,every,..."});
    read_header(rows.front());
    if (diagnostics_.has_errors()) return;
    for (std::size_t i = 1; i < rows.size(); ++i) read_row(rows[i], streams);
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
        {"to", true, [](StreamsReader&, const Cell& cell, Stream& s) {
           std::string_view rest = cell.text;   // several with semicolons between
           while (!rest.empty()) {
             const std::size_t end = rest.find(';');
             s.to.names.emplace_back(rest.substr(0, end));
             rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
           }
         }},
        {"payload", true, [](StreamsReader& r, const Cell& cell, Stream& s) { s.payload = sim::Octets{static_cast<std::uint32_t>(r.number(cell, 1, 1500, "octets from 1 to 1500"))}; }},
        {"every", true, [](StreamsReader& r, const Cell& cell, Stream& s) { s.every = r.duration(cell); }},
        {"offset", false, [](StreamsReader& r, const Cell& cell, Stream& s) {
           if (cell.text == "auto") s.offset.emplace().is_auto = true;
           else s.offset = json::OrAuto<sim::Duration>(r.duration(cell));
         }},
        {"jitter", false, [](StreamsReader& r, const Cell& cell, Stream& s) { s.jitter = r.duration(cell); }},
        {"pcp", false, [](StreamsReader& r, const Cell& cell, Stream& s) { s.pcp = static_cast<std::uint8_t>(r.number(cell, 0, 7, "a priority from 0 to 7")); }},
        {"vlan", false, [](StreamsReader& r, const Cell& cell, Stream& s) { s.vlan = static_cast<std::uint16_t>(r.number(cell, 0, 4094, "a VLAN from 0 to 4094")); }},
        {"encapsulation", false, [](StreamsReader& r, const Cell& cell, Stream& s) {
           if (cell.text == "ethernet") s.encapsulation = scenario::Encapsulation::ethernet;
           else if (cell.text != "udp") r.refuse(cell, "not an encapsulation", "udp or ethernet");
         }},
        {"latency", false, [](StreamsReader& r, const Cell& cell, Stream& s) { r.latencies.emplace_back(s.name, r.duration(cell)); }},
    };
    return all;
  }

  void refuse(const Cell& cell, std::string message, std::string expected, std::string suggestion = {}) { diagnostics_.error(cell.place, std::move(message), {json::quote(cell.text), std::move(expected), std::move(suggestion)}); }

  std::uint64_t number(const Cell& cell, std::uint64_t least, std::uint64_t most, const char* expected) {
    std::uint64_t value = 0;
    std::string_view text = cell.text;
    if (text.ends_with("B")) text.remove_suffix(1);
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (!text.empty() && error == std::errc() && stop == text.data() + text.size() && value >= least && value <= most) return value;
    refuse(cell, "not a number that fits", expected);
    return least;
  }
  sim::Duration duration(const Cell& cell) {
    const auto parsed = json::parse_duration(cell.text);
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
        refuse(cell, "an unknown column", "name, from, to, payload, every, offset, jitter, pcp, vlan, encapsulation or latency", json::suggest(cell.text, names));
        continue;
      }
      if (!seen.insert(column->name).second) refuse(cell, "a column twice", "each once");
      order_.push_back(&*column);
    }
    for (const Column& column : columns())
      if (column.is_required && !seen.contains(column.name) && !diagnostics_.has_errors()) diagnostics_.error(row.front().place, "a column that must be there is not", {"no " + json::quote(column.name), "name, from, to, payload and every"});
  }

  void read_row(const Row& row, std::vector<scenario::Stream>& streams) {
    if (row.size() != order_.size()) return diagnostics_.error(row.front().place, "a row of another length than the header", {std::to_string(row.size()) + " cells", std::to_string(order_.size())});
    scenario::Stream stream;
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (!row[i].text.empty()) order_[i]->set(*this, row[i], stream);
      else if (order_[i]->is_required) refuse(row[i], "an empty cell", "a value");
    }
    if (std::ranges::any_of(streams, [&](const scenario::Stream& each) { return each.name == stream.name; })) diagnostics_.error(row.front().place, "a stream twice", {json::quote(stream.name) + " a second time", "a name of its own"});
    streams.push_back(std::move(stream));
  }

 public:
  std::vector<std::pair<std::string, sim::Duration>> latencies;   ///< required of streams

 private:
  json::Diagnostics& diagnostics_;
  std::vector<const Column*> order_;
};

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
  StreamsReader reader(diagnostics);
  for (const InputFile& file : request.files) reader.read(file, streams);
  if (diagnostics.has_errors()) return imported;
  // Without a network: the hosts that are named, at one switch.
  if (request.base == nullptr) {
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
    imported.remark(RemarkKind::lost, {request.files.front().name, 0, 0, ""}, "the network: a table of streams says none (--into), so all hosts are at one switch of 1 Gb/s");
  }
  scenario.streams = std::move(streams);
  for (const auto& [name, latency] : reader.latencies) {
    scenario::Requirement requirement;
    requirement.stream = name;
    requirement.latency.emplace().at_most = latency;
    scenario.require.push_back(std::move(requirement));
  }
  imported.scenario = std::move(scenario);
  return imported;
}

}  // namespace takt::interchange
