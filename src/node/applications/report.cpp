#include <fmt/format.h>

#include "json/document.hpp"
#include "node/applications/host.hpp"

namespace takt::node {
namespace {

json::Node text(std::string_view value) { return json::Node::of_string(value); }
template <class Integer>
json::Node number(Integer value) {
  return json::Node::of_integer(static_cast<sim::int128>(value));
}

json::Node of(const Distribution& distribution) {
  json::Node node = json::Node::object();
  node.add("count", number(distribution.count()));
  node.add("min_ns", number(distribution.least()));
  node.add("mean_ns", number(distribution.mean()));
  node.add("p99_ns", number(distribution.percentile(99)));
  node.add("max_ns", number(distribution.greatest()));
  return node;
}

json::Node of(const plant::CriterionFigures& figures) {
  json::Node node = json::Node::object();
  node.add("tests", number(figures.tests));
  node.add("expected", number(figures.expected));
  node.add("counted", number(figures.counted));
  node.add("beyond", number(figures.beyond));
  node.add("windows_below", number(figures.windows_below));
  node.add("discarded", number(figures.discarded));
  if (const auto percent = figures.percent()) node.add("percent", json::Node::of_double(*percent));
  return node;
}

json::Node of(const ThreadStatistics& thread) {
  json::Node node = json::Node::object();
  node.add("name", text(thread.name));
  node.add("role", text(thread.role));
  node.add("topic", text(thread.topic));
  node.add("every_ns", number(thread.every_ns));
  node.add("window_ns", number(thread.window_ns));
  node.add("calls", number(thread.calls));
  node.add("missed", number(thread.missed));
  node.add("sent", number(thread.sent));
  node.add("timed_out", number(thread.timed_out));
  node.add("not_sent", number(thread.not_sent));
  node.add("taken", number(thread.taken));
  node.add("lost", number(thread.lost));
  node.add("late", of(thread.late));
  node.add("criterion_1", of(thread.call_windows));
  if (thread.value_windows.tests + thread.value_windows.discarded > 0) node.add("criterion_2", of(thread.value_windows));
  return node;
}

json::Node of(const gateway::ChannelFigures& figures) {
  json::Node node = json::Node::object();
  node.add("received", number(figures.received()));
  node.add("forwarded", number(figures.buffer.forwarded));
  node.add("overwritten", number(figures.buffer.overwritten));
  node.add("dropped", number(figures.buffer.dropped));
  node.add("stale", number(figures.buffer.stale));
  node.add("mapping_errors", number(figures.mapping_error_total()));
  json::Node& age = node.add("age", json::Node::object());
  age.add("min_ns", number(figures.age.least.ps() / 1000));
  age.add("mean_ns", number(figures.age.mean().ps() / 1000));
  age.add("max_ns", number(figures.age.greatest.ps() / 1000));
  return node;
}

std::string percent_of(const plant::CriterionFigures& figures) {
  const auto percent = figures.percent();
  return percent ? fmt::format("{:.1f} %", *percent) : "-";
}

}  // namespace

std::string to_json(const std::string& node, const std::vector<ApplicationStatistics>& statistics) {
  json::Node root = json::Node::object();
  root.add("node", text(node));
  json::Node applications = json::Node::array();
  json::Node gateways = json::Node::array();
  for (const ApplicationStatistics& each : statistics) {
    json::Node one = json::Node::object();
    one.add("name", text(each.name));
    json::Node& threads = one.add("threads", json::Node::array());
    for (const ThreadStatistics& thread : each.threads) threads.items.push_back(of(thread));
    if (each.channel) one.add("buffer", of(*each.channel));
    (each.is_gateway ? gateways : applications).items.push_back(std::move(one));
  }
  root.add("applications", std::move(applications));
  root.add("gateways", std::move(gateways));
  return json::compact(root);
}

std::string to_text(const std::vector<ApplicationStatistics>& statistics) {
  std::string out = fmt::format("  {:<30} {:>9} {:>9} {:>8} {:>8} {:>10} {:>10} {:>12} {:>12}\n", "thread", "every us", "calls", "missed", "taken", "calls", "buffered", "late p99 us", "max us");
  for (const ApplicationStatistics& each : statistics) {
    for (const ThreadStatistics& thread : each.threads)
      out += fmt::format("  {:<30} {:>9} {:>9} {:>8} {:>8} {:>10} {:>10} {:>12.1f} {:>12.1f}\n", each.name + "/" + thread.name, thread.every_ns / 1000, thread.calls, thread.missed, thread.taken,
                         percent_of(thread.call_windows), percent_of(thread.value_windows), static_cast<double>(thread.late.percentile(99)) / 1000,
                         static_cast<double>(thread.late.greatest()) / 1000);
    for (const ThreadStatistics& thread : each.threads)
      if (thread.timed_out + thread.not_sent > 0) out += fmt::format("  {}/{}: {} timed out, {} not sent\n", each.name, thread.name, thread.timed_out, thread.not_sent);
    if (!each.channel) continue;
    const gateway::ChannelFigures& figures = *each.channel;
    out += fmt::format("  {} buffer: {} received, {} forwarded, {} overwritten, {} dropped, {} stale, {} not mapped; age mean {:.1f} us, max {:.1f} us\n", each.name, figures.received(),
                       figures.buffer.forwarded, figures.buffer.overwritten, figures.buffer.dropped, figures.buffer.stale, figures.mapping_error_total(),
                       static_cast<double>(figures.age.mean().ps()) / 1e6, static_cast<double>(figures.age.greatest.ps()) / 1e6);
  }
  return out;
}

}  // namespace takt::node
