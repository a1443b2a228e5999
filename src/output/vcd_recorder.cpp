#include "output/vcd_recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "models/egress/preemption.hpp"
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
  for (const models::PortDirectory::Port& port : directory_.ports()) {
    const std::string_view peer = port.peer.is_none() ? std::string_view("nothing") : nodes[port.peer.value].name;
    const std::string scope = fmt::format("{}\nport{}_to_{}", identifier(nodes[port.id.node.value].name), port.id.port, identifier(peer));
    add_signal(scope, "busy", 1, 0);
    add_signal(scope, "queued_frames", 32, 0);
    add_signal(scope, "gates", models::traffic_class_count, 0xFF);
  }
  begun_.resize(directory_.ports().size());
  free_at_.resize(directory_.ports().size());
  gates_.resize(directory_.ports().size());
  for (std::uint32_t position = 0; position < gates_.size(); ++position) {
    look_at_gates(position, sim::TrueTime());
    signals_[position * signals_of_a_port + gates].value = states(position, sim::TrueTime());
  }
}

/// The gates of the port are others from now on.
void VcdRecorder::look_at_gates(std::uint32_t position, sim::TrueTime now) {
  const models::PortDirectory::Port& port = directory_.ports()[position];
  const models::EgressPort& live = network_->ports(port.id.node)[port.id.port];
  if (live.shaping() == nullptr || !live.shaping()->has_gates()) return;
  gates_[position].schedule = std::as_const(*live.shaping()).gates();
  gates_[position].next = now;
  follow_gates(position);
}

/// Notes when they next change.
void VcdRecorder::follow_gates(std::uint32_t position) {
  const models::PortDirectory::Port& port = directory_.ports()[position];
  const models::LocalClock& clock = network_->ports(port.id.node)[port.id.port].clock();
  Gates& followed = gates_[position];
  const sim::LocalTime change = followed.schedule.next_change(clock.local_at(followed.next));
  followed.next = change == sim::LocalTime::never() ? sim::TrueTime::never() : clock.true_at(change);
  if (followed.next != sim::TrueTime::never()) gate_changes_.push({followed.next, position});
}

std::uint64_t VcdRecorder::states(std::uint32_t position, sim::TrueTime at) {
  const models::PortDirectory::Port& port = directory_.ports()[position];
  const models::EgressPort& live = network_->ports(port.id.node)[port.id.port];
  if (live.shaping() == nullptr || !live.shaping()->has_gates()) return 0xFF;
  return live.shaping()->with_forced(gates_[position].schedule.gate_states(live.clock().local_at(at)));
}

VcdRecorder::SignalId VcdRecorder::add_signal(std::string_view scope, std::string_view name, unsigned bits, std::uint64_t initial) {
  TAKT_CHECK(!declared_, "signals are added before anything is recorded");
  TAKT_CHECK(bits >= 1 && bits <= 64, "a signal has 1 to 64 bits");
  signals_.push_back({std::string(scope), identifier(name), code_of(signals_.size()), bits, initial});
  return static_cast<SignalId>(signals_.size() - 1);
}

void VcdRecorder::set(SignalId signal, sim::TrueTime time, std::uint64_t value) {
  advance_to(time);
  change(signal, time, value);
}

void VcdRecorder::record(const sim::TraceRecord& record) {
  if (record.kind == static_cast<std::uint32_t>(models::Occurrence::output_changed)) {
    if (record.what < outputs_.size()) set(outputs_[record.what], record.time, record.detail);
    return;
  }
  const std::uint32_t position = directory_.find(record.where);
  if (position == models::PortDirectory::none) return;
  advance_to(record.time);
  const models::PortDirectory::Port& port = directory_.ports()[position];
  const SignalId first = position * signals_of_a_port;

  const models::PortQueues& queues = network_->ports(port.id.node)[port.id.port].queues();
  std::uint64_t waiting = 0;
  for (models::TrafficClass q = 0; q < models::traffic_class_count; ++q) waiting += queues.frames(q);
  change(first + queued_frames, record.time, waiting);

  const auto octets = std::int64_t{models::TransmissionDetail::unpack(record.detail).octets};
  switch (static_cast<models::Occurrence>(record.kind)) {
    case models::Occurrence::started:
    case models::Occurrence::resumed:
      begun_[position] = record.time;
      change(first + busy, record.time, 1);
      free_at_[position] = record.time + port.octet_time * (models::preamble_and_sfd.count + octets);
      falls_.push({free_at_[position], first + busy});
      break;
    case models::Occurrence::cut:
      free_at_[position] = begun_[position] + port.octet_time * (models::preamble_and_sfd.count + octets + models::mcrc.count);
      falls_.push({free_at_[position], first + busy});
      break;
    case models::Occurrence::gates_changed:
      look_at_gates(position, record.time);
      change(first + gates, record.time, states(position, record.time));
      break;
    default: break;
  }
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
  for (;;) {
    const sim::TrueTime fall = falls_.empty() ? sim::TrueTime::never() : falls_.top().time;
    const sim::TrueTime gate = gate_changes_.empty() ? sim::TrueTime::never() : gate_changes_.top().time;
    if (std::min(fall, gate) > time) return;
    if (fall <= gate) {
      const Fall next = falls_.top();
      falls_.pop();
      if (free_at_[next.signal / signals_of_a_port] == next.time) change(next.signal, next.time, 0);  // else it was cut
    } else {
      const Fall next = gate_changes_.top();
      gate_changes_.pop();
      if (gates_[next.signal].next != next.time) continue;  // of a list that was replaced
      change(next.signal * signals_of_a_port + gates, next.time, states(next.signal, next.time));
      follow_gates(next.signal);
    }
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
