// SPDX-License-Identifier: Apache-2.0
#include "interchange/csv/records.hpp"

#include <algorithm>

#include "json/fields.hpp"

namespace takt::interchange::csv {
namespace {

bool has_column(const Table& table, std::string_view name) {
  return std::ranges::find(table.header, name, &Cell::text) != table.header.end();
}

bool is_json_number(std::string_view text) {
  const std::string_view digits = text.starts_with('-') ? text.substr(1) : text;
  return !digits.empty() && digits.find_first_not_of("0123456789.") == std::string_view::npos &&
         digits.front() != '.' && digits.back() != '.' && std::ranges::count(digits, '.') <= 1 &&
         (digits.size() == 1 || digits.front() != '0' || digits[1] == '.');
}

/// The member at a dotted key, made if it is not there.
json::Node& member_at(json::Node& object, std::string_view key) {
  json::Node* at = &object;
  while (true) {
    const std::size_t dot = key.find('.');
    const std::string part(key.substr(0, dot));
    json::Node* found = nullptr;
    for (json::Member& member : at->members)
      if (member.key == part) found = &member.value;
    if (found == nullptr) {
      at->add(part, json::Node::object());
      found = &at->members.back().value;
    }
    if (dot == std::string_view::npos) return *found;
    at = found;
    key.remove_prefix(dot + 1);
  }
}

/// A row as an object, and where each of its members stands.
struct Record {
  json::Node object = json::Node::object();
  std::map<std::string, json::Place, std::less<>> places;  ///< by pointer
  json::Place place;
};

/// What a bare number of a column counts.
std::string_view unit_of(std::string_view column) {
  if (column == "rate") return "Mbps";
  if (column == "length") return "m";
  return "";
}

Record record_of(const Table& table, const Row& row, std::span<const std::string_view> lists) {
  Record record;
  record.place = row.front().place;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const std::string& column = table.header[i].text;
    if (row[i].text.empty()) continue;
    json::Node value;
    if (std::ranges::find(lists, column) != lists.end()) {
      value = json::Node::array();
      for (const std::string& name : names_in(row[i], table.separator))
        value.items.push_back(json::Node::of_string(name));
    } else {
      const bool is_quantity = row[i].text.front() >= '0' && row[i].text.front() <= '9';
      const std::string text = is_quantity && column != "name" && column != "master"
                                   ? as_quantity(row[i].text, unit_of(column), table.separator != ',')
                                   : row[i].text;
      if (text == "true" || text == "yes" || text == "TRUE")
        value = json::Node::of_bool(true);
      else if (text == "false" || text == "no" || text == "FALSE")
        value = json::Node::of_bool(false);
      else if (is_json_number(text) && column != "name" && column != "master") {
        value.kind = json::Kind::number;
        value.text = text;
      } else
        value = json::Node::of_string(text);
    }
    std::string pointer = "/" + column;
    std::ranges::replace(pointer, '.', '/');
    record.places[pointer] = row[i].place;
    member_at(record.object, column) = std::move(value);
  }
  return record;
}

/// Reads the object by the tables of the scenario's vocabulary; what is wrong is told at its cell.
template <class T>
bool decode_record(const Record& record, T& value, json::Diagnostics& diagnostics) {
  json::Diagnostics own;
  const auto document = json::parse(json::pretty(record.object), record.place.file, own);
  if (document) json::decode(*document, value, own);
  for (const json::Diagnostic& each : own.kept()) {
    const auto found = record.places.find(each.place.pointer);
    json::Place place = found == record.places.end() ? record.place : found->second;
    diagnostics.error(place, each.message, each.details);
  }
  return !own.has_errors();
}

/// One end of a cable: "sw1", "sw1:3", or "sw1" with the port in another column.
std::string end_of(const std::string& node, const std::string& port) { return port.empty() ? node : node + ":" + port; }

std::string take_text(Record& record, std::string_view key) {
  std::string text;
  const json::Node* const found = record.object.find(key);
  if (found != nullptr) text = found->text;
  std::erase_if(record.object.members, [&](const json::Member& member) { return member.key == key; });
  return text;
}

}  // namespace

std::optional<TableKind> kind_of(const Table& table, json::Diagnostics& diagnostics) {
  if (table.header.empty()) return std::nullopt;
  if (has_column(table, "payload") || has_column(table, "every")) return TableKind::streams;
  if (has_column(table, "master")) return TableKind::programs;
  if (has_column(table, "kind")) return TableKind::devices;
  if (has_column(table, "from") && has_column(table, "to")) return TableKind::cables;
  diagnostics.error(table.header.front().place, "a table of unknown kind",
                    {json::quote(table.header.front().text),
                     "a header with payload and every (streams), from and to (cables), name and kind (devices), or "
                     "name, master, slaves and cycle (Programs)"});
  return std::nullopt;
}

void read_cables(const Table& table, scenario::Scenario& scenario, Imported& imported, json::Diagnostics& diagnostics) {
  for (const Row& row : table.rows) {
    Record record = record_of(table, row, {});
    const std::string from = take_text(record, "from"), to = take_text(record, "to");
    std::string from_port = take_text(record, "from_port"), to_port = take_text(record, "to_port");
    if (const std::string ports = take_text(record, "ports"); !ports.empty()) {  // "1-3"
      const std::size_t sign = ports.find_first_of("-:/ ");
      from_port = ports.substr(0, sign);
      to_port = sign == std::string::npos ? "" : ports.substr(sign + 1);
    }
    for (const char* const key : {"name", "comment", "remark", "cable"}) take_text(record, key);
    if (from.empty() || to.empty()) {
      diagnostics.error(record.place, "a cable without two ends",
                        {from.empty() ? "no from" : "no to", "the names of two devices"});
      continue;
    }
    json::Node ends = json::Node::array();
    for (const std::string& end : {end_of(from, from_port), end_of(to, to_port)})
      ends.items.push_back(json::Node::of_string(end));
    record.object.add("ends", std::move(ends));
    scenario::Link link;
    if (!decode_record(record, link, diagnostics)) continue;
    link.where = {};
    imported.origins["/network/links/" + std::to_string(scenario.network.links.size())] = record.place;
    scenario.network.links.push_back(std::move(link));
  }
}

void read_devices(const Table& table, scenario::Scenario& scenario, Imported& imported,
                  json::Diagnostics& diagnostics) {
  for (const Row& row : table.rows) {
    Record record = record_of(table, row, {});
    const std::string name = take_text(record, "name");
    for (const char* const key : {"comment", "remark"}) take_text(record, key);
    if (name.empty()) {
      diagnostics.error(record.place, "a device without a name", {"an empty cell", "a name"});
      continue;
    }
    scenario::Node node;
    if (!decode_record(record, node, diagnostics)) continue;
    if (std::ranges::any_of(scenario.network.nodes, [&](const auto& each) { return each.first == name; })) {
      diagnostics.error(record.place, "a device twice", {json::quote(name) + " a second time", "a name of its own"});
      continue;
    }
    imported.origins["/network/nodes/" + name] = record.place;
    scenario.network.nodes.emplace_back(name, std::move(node));
  }
}

void read_programs(const Table& table, scenario::Scenario& scenario, Imported& imported,
                   json::Diagnostics& diagnostics) {
  constexpr std::string_view lists[] = {"slaves"};
  for (const Row& row : table.rows) {
    const Record record = record_of(table, row, lists);
    plant::Program program;
    if (!decode_record(record, program, diagnostics)) continue;
    imported.origins["/programs/" + std::to_string(scenario.programs.size())] = record.place;
    scenario.programs.push_back(std::move(program));
  }
}

}  // namespace takt::interchange::csv
