#include "output/vcd_recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "models/ethernet/sizes.hpp"

namespace takt::output {
namespace {

/// Names in a VCD hold no white space; other characters than these confuse viewers.
std::string identifier(std::string_view name) {
  std::string out(name);
  for (char& c : out) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    if (!plain) c = '_';
  }
  return out.empty() ? "_" : out;
}

/// Numbers in base 94, the printable characters as digits.
std::string code_of(std::size_t number) {
  std::string code;
  do code += static_cast<char>('!' + number % 94);
  while ((number /= 94) > 0);
  return code;
}

}  // namespace

VcdRecorder::VcdRecorder(const models::Network& network, std::string path)
    : network_(&network), directory_(network), file_(std::move(path)) {
  const std::vector<models::NodePlan>& nodes = network.plan().nodes;
  for (const PortDirectory::Port& port : directory_.ports()) {
    const std::string_view peer = port.peer.is_none() ? std::string_view("nothing") : nodes[port.peer.value].name;
    const std::string scope = fmt::format("{}\nport{}_to_{}", identifier(nodes[port.id.node.value].name), port.id.port, identifier(peer));
    add_signal(scope, "busy", 1, 0);
    add_signal(scope, "queued_frames", 32, 0);
    add_signal(scope, "gates", models::traffic_class_count, 0xFF);
  }
}

VcdRecorder::SignalId VcdRecorder::add_signal(std::string_view scope, std::string_view name, unsigned bits, std::uint64_t initial) {
  TAKT_CHECK(!declared_, "signals are added before anything is recorded");
  TAKT_CHECK(bits >= 1 && bits <= 64, "a signal has 1 to 64 bits");
  signals_.push_back({std::string(scope), identifier(name), code_of(signals_.size()), bits, initial});
  return static_cast<SignalId>(signals_.size() - 1);
}

VcdRecorder::SignalId VcdRecorder::gates_of(sim::ComponentId port) const {
  const std::uint32_t position = directory_.find(port);
  TAKT_CHECK(position != PortDirectory::none, "gates belong to a port of the network");
  return position * signals_of_a_port + gates;
}

void VcdRecorder::set(SignalId signal, sim::TrueTime time, std::uint64_t value) {
  advance_to(time);
  change(signal, time, value);
}

void VcdRecorder::record(const sim::TraceRecord& record) {
  const std::uint32_t position = directory_.find(record.where);
  if (position == PortDirectory::none) return;
  advance_to(record.time);
  const PortDirectory::Port& port = directory_.ports()[position];
  const SignalId first = position * signals_of_a_port;

  const models::PortQueues& queues = network_->ports(port.id.node)[port.id.port].queues();
  std::uint64_t waiting = 0;
  for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q) waiting += queues.frames(q);
  change(first + queued_frames, record.time, waiting);

  if (record.kind != static_cast<std::uint32_t>(models::Occurrence::started)) return;
  change(first + busy, record.time, 1);
  const auto octets = static_cast<std::int64_t>(models::preamble_and_sfd.count + record.detail);
  falls_.push({record.time + port.octet_time * octets, first + busy});
}

std::string VcdRecorder::close(sim::TrueTime end) {
  advance_to(end);
  if (end > time_) file_.write(fmt::format("#{}\n", end.ps()));
  return file_.close();
}

/// The header, with scopes in the order of their first signal, and the values at time zero.
void VcdRecorder::declare() {
  declared_ = true;
  file_.write("$version takt $end\n$timescale 1 ps $end\n");
  // Signals of one scope stand together; a scope is opened once for each run of its signals.
  std::vector<const Signal*> order;
  for (const Signal& signal : signals_) order.push_back(&signal);
  std::stable_sort(order.begin(), order.end(), [](const Signal* a, const Signal* b) { return a->scope < b->scope; });
  const auto parts_of = [](const std::string& scope) {
    std::vector<std::string> parts;
    for (std::size_t at = 0; at <= scope.size();) {
      const std::size_t end = std::min(scope.find('\n', at), scope.size());
      parts.push_back(identifier(std::string_view(scope).substr(at, end - at)));
      at = end + 1;
    }
    return parts;
  };
  std::vector<std::string> open;
  const auto enter = [&](const std::vector<std::string>& scope) {
    const auto common = static_cast<std::size_t>(std::mismatch(open.begin(), open.end(), scope.begin(), scope.end()).first - open.begin());
    for (; open.size() > common; open.pop_back()) file_.write("$upscope $end\n");
    for (std::size_t i = common; i < scope.size(); ++i) {
      file_.write("$scope module " + scope[i] + " $end\n");
      open.push_back(scope[i]);
    }
  };
  for (const Signal* const signal : order) {
    enter(parts_of(signal->scope));
    const std::string range = signal->bits > 1 ? fmt::format(" [{}:0]", signal->bits - 1) : "";
    file_.write(fmt::format("$var wire {} {} {}{} $end\n", signal->bits, signal->code, signal->name, range));
  }
  enter({});
  file_.write("$enddefinitions $end\n#0\n$dumpvars\n");
  for (const Signal& signal : signals_) write_value(signal);
  file_.write("$end\n");
}

/// Writes the falls up to and including that time.
void VcdRecorder::advance_to(sim::TrueTime time) {
  if (!declared_) declare();
  TAKT_CHECK(time >= time_, "a wave form is recorded in the order of time");
  while (!falls_.empty() && falls_.top().time <= time) {
    const Fall fall = falls_.top();
    falls_.pop();
    change(fall.signal, fall.time, 0);
  }
}

void VcdRecorder::change(SignalId id, sim::TrueTime time, std::uint64_t value) {
  Signal& signal = signals_[id];
  if (signal.value == value) return;
  if (time > time_) file_.write(fmt::format("#{}\n", time.ps()));
  time_ = time;
  signal.value = value;
  write_value(signal);
}

void VcdRecorder::write_value(const Signal& signal) {
  file_.write(signal.bits == 1 ? fmt::format("{}{}\n", signal.value & 1, signal.code)
                               : fmt::format("b{:b} {}\n", signal.value, signal.code));
}

}  // namespace takt::output
