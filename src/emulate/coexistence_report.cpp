#include <fmt/format.h>

#include "emulate/coexistence.hpp"
#include "json/document.hpp"

namespace takt::emulate {
namespace {

std::string cell(const std::optional<double>& percent) { return percent ? fmt::format("{:.1f} %", *percent) : "-"; }

std::string table(const char* title, const std::vector<MeasuredThread>& rows) {
  std::string out = fmt::format("{}\n  {:<30}", title, "");
  for (const int interval : coexistence_intervals) out += fmt::format(" {:>9}", fmt::format("{} ms", interval));
  out += "   tests (discarded)      late p99, us\n";
  const auto line = [&](const MeasuredThread& row, const char* what, const std::array<std::optional<double>, 4>& percents, bool is_first) {
    out += fmt::format("  {:<30}", fmt::format("{} {}, {}", row.protocol, row.node, what));
    for (const auto& percent : percents) out += fmt::format(" {:>9}", cell(percent));
    if (is_first) {
      std::uint64_t tests = 0;
      std::uint64_t discarded = 0;
      for (std::size_t c = 0; c < 4; ++c) tests += row.tests[c], discarded += row.discarded[c];
      out += fmt::format("   {:<22}", fmt::format("{} ({})", tests, discarded));
      out += fmt::format(" {:.0f} / {:.0f} / {:.0f} / {:.0f}", row.late_p99_us[0], row.late_p99_us[1], row.late_p99_us[2], row.late_p99_us[3]);
    }
    out += "\n";
  };
  for (const MeasuredThread& row : rows) line(row, row.operation.c_str(), row.success, true);
  out += "  criterion 2, samples buffered\n";
  for (const MeasuredThread& row : rows)
    if (row.operation == "subscribe") line(row, "buffered", row.buffered, false);
  return out;
}

json::Node percents(const std::array<std::optional<double>, 4>& values) {
  json::Node node = json::Node::array();
  for (const auto& value : values) node.items.push_back(value ? json::Node::of_double(*value) : json::Node());
  return node;
}

template <class Integer>
json::Node number(Integer value) {
  return json::Node::of_integer(static_cast<sim::int128>(value));
}

json::Node rows_of(const std::vector<MeasuredThread>& rows) {
  json::Node all = json::Node::array();
  for (const MeasuredThread& row : rows) {
    json::Node node = json::Node::object();
    node.add("protocol", json::Node::of_string(row.protocol));
    node.add("node", json::Node::of_string(row.node));
    node.add("operation", json::Node::of_string(row.operation));
    node.add("success_percent", percents(row.success));
    if (row.operation == "subscribe") node.add("buffered_percent", percents(row.buffered));
    json::Node& tests = node.add("tests", json::Node::array());
    for (const std::uint64_t each : row.tests) tests.items.push_back(number(each));
    json::Node& discarded = node.add("discarded", json::Node::array());
    for (const std::uint64_t each : row.discarded) discarded.items.push_back(number(each));
    json::Node& late = node.add("late_p99_us", json::Node::array());
    for (const double each : row.late_p99_us) late.items.push_back(json::Node::of_double(each));
    all.items.push_back(std::move(node));
  }
  return all;
}

}  // namespace

std::string to_text(const MeasuredCoexistence& measured) {
  std::string out = "Measured on " + measured.machine + "\n\n";
  out += table("Case study 1, criterion 1: calls that took place in windows of 10 ms", measured.mirror);
  out += "\n" + table("Case study 2, OPC UA to DDS through the gateway", measured.gateway);
  out += "  shared buffer\n";
  for (std::size_t c = 0; c < measured.buffers.size(); ++c)
    if (const auto& buffer = measured.buffers[c])
      out += fmt::format("    {:>2} ms: {} received, {} forwarded, {} overwritten, mean age {:.0f} us\n", coexistence_intervals[c], buffer->received, buffer->forwarded, buffer->overwritten,
                         buffer->mean_age_us);
  return out;
}

std::string to_json(const MeasuredCoexistence& measured) {
  json::Node root = json::Node::object();
  root.add("machine", json::Node::of_string(measured.machine));
  json::Node& intervals = root.add("intervals_ms", json::Node::array());
  for (const int each : coexistence_intervals) intervals.items.push_back(number(each));
  root.add("mirror", rows_of(measured.mirror));
  root.add("gateway", rows_of(measured.gateway));
  json::Node& buffers = root.add("buffers", json::Node::array());
  for (const auto& buffer : measured.buffers) {
    json::Node node = json::Node();
    if (buffer) {
      node = json::Node::object();
      node.add("received", number(buffer->received));
      node.add("forwarded", number(buffer->forwarded));
      node.add("overwritten", number(buffer->overwritten));
      node.add("mean_age_us", json::Node::of_double(buffer->mean_age_us));
    }
    buffers.items.push_back(std::move(node));
  }
  return json::pretty(root);
}

}  // namespace takt::emulate
