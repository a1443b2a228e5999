// SPDX-License-Identifier: Apache-2.0
#include "output/timeline_recorder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "models/egress/preemption.hpp"
#include "models/ethernet/sizes.hpp"

namespace takt::output {
namespace {

/// A JSON string (RFC 8259, clause 7), quotes included.
std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += {'\\', c};
    else if (static_cast<unsigned char>(c) < 0x20)
      out += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    else
      out += c;
  }
  return out + '"';
}

/// The format counts microseconds, with a fraction: exact.
std::string microseconds(sim::Duration duration) {
  return fmt::format("{}.{:06}", duration.ps() / 1'000'000, duration.ps() % 1'000'000);
}

}  // namespace

TimelineRecorder::TimelineRecorder(const models::Network& network, std::string path, sim::TrueTime from,
                                   sim::TrueTime to)
    : network_(&network),
      view_(network),
      from_(from),
      to_(to),
      directory_(network),
      drops_(network, directory_),
      file_(std::move(path)) {
  file_.write("{\"displayTimeUnit\":\"ns\",\"traceEvents\":[\n");
  name_ports();
  slices_.resize(directory_.ports().size());
  for (const models::Stream& stream : network.traffic().streams()) stream_names_.push_back(quoted(stream.name));
  gate_tracks_.assign(directory_.ports().size(), no_track);
}

void TimelineRecorder::name_ports() {
  const std::vector<models::NodePlan>& nodes = network_->plan().nodes;
  for (std::uint32_t n = 0; n < nodes.size(); ++n) name_process(n + 1, nodes[n].name);
  for (const models::PortDirectory::Port& port : directory_.ports()) {
    const std::string_view peer = port.peer.is_none() ? std::string_view("nothing") : nodes[port.peer.value].name;
    name_thread(port.id.node.value + 1, port.id.port + 1u, fmt::format("port {} to {}", port.id.port, peer));
  }
}

void TimelineRecorder::name_process(std::uint32_t process, std::string_view name) {
  event(fmt::format(R"({{"ph":"M","name":"process_name","pid":{},"args":{{"name":{}}}}})", process, quoted(name)));
  event(fmt::format(R"({{"ph":"M","name":"process_sort_index","pid":{0},"args":{{"sort_index":{0}}}}})", process));
}

void TimelineRecorder::name_thread(std::uint32_t process, std::uint32_t thread, std::string_view name) {
  event(fmt::format(R"({{"ph":"M","name":"thread_name","pid":{},"tid":{},"args":{{"name":{}}}}})", process, thread,
                    quoted(name)));
}

void TimelineRecorder::event(std::string_view text) {
  file_.write(first_ ? "" : ",\n");
  file_.write(text);
  first_ = false;
}

TimelineRecorder::TrackId TimelineRecorder::add_state_track(std::string_view group, std::string_view name) {
  const auto found = std::find(groups_.begin(), groups_.end(), group);
  const auto number = static_cast<std::uint32_t>(found - groups_.begin());
  const std::uint32_t process = static_cast<std::uint32_t>(network_->plan().nodes.size()) + 1 + number;
  if (found == groups_.end()) {
    groups_.emplace_back(group);
    tracks_of_group_.push_back(0);
    name_process(process, group);
  }
  Track track;
  track.process = process;
  track.thread = ++tracks_of_group_[number];
  name_thread(process, track.thread, name);
  tracks_.push_back(std::move(track));
  return static_cast<TrackId>(tracks_.size() - 1);
}

void TimelineRecorder::change_state(TrackId id, sim::TrueTime time, std::string_view state) {
  Track& track = tracks_[id];
  TAKT_CHECK(time >= track.since, "the states of a track follow each other");
  const sim::TrueTime begin = std::max(track.since, from_);
  const sim::TrueTime end = std::min(time, to_);
  if (!track.state.empty() && (begin < end || (begin == end && track.since == time)))
    event(fmt::format(R"({{"ph":"X","pid":{},"tid":{},"ts":{},"dur":{},"name":{}}})", track.process, track.thread,
                      microseconds(begin.since_start()), microseconds(end - begin), quoted(track.state)));
  track.since = time;
  track.state = state;
}

void TimelineRecorder::mark(TrackId id, sim::TrueTime time, std::string_view text) {
  if (time < from_ || time > to_) return;
  event(fmt::format(R"({{"ph":"i","s":"t","pid":{},"tid":{},"ts":{},"name":{}}})", tracks_[id].process,
                    tracks_[id].thread, microseconds(time.since_start()), quoted(text)));
}

void TimelineRecorder::add_way(const explain::Way& way) {
  const std::string& stream = stream_names_[way.frame.stream.value];
  ++ways_;
  bool has_begun = false;
  for (std::size_t i = 0; i < way.hops.size(); ++i) {
    const explain::Hop& hop = way.hops[i];
    const std::uint32_t process = hop.port.node.value + 1;
    const std::uint32_t thread = hop.port.port + 1u;
    if (!hop.is_reported)
      for (const explain::Part& part : hop.parts) {
        if (!explain::is_waiting(part.cause) || part.cause == explain::Cause::preemption ||
            part.cause == explain::Cause::processor)
          continue;
        std::string who;
        if (part.who)
          who =
              fmt::format(R"(,"for":{},"for_sequence":{})", stream_names_[part.who->stream.value], part.who->sequence);
        if (part.amount != explain::Part::no_amount)
          who += fmt::format(R"(,"{}":{})", part.cause == explain::Cause::credit ? "missing_bits" : "gate_entry",
                             part.amount);
        const std::string place =
            fmt::format(R"("cat":"waiting","id":{},"pid":{},"tid":{})", ++waits_, process, thread);
        event(fmt::format(R"({{"ph":"b",{},"ts":{},"name":{},"args":{{"stream":{},"sequence":{}{}}}}})", place,
                          microseconds(part.begin.since_start()), quoted(explain::words_of(part.cause)), stream,
                          way.frame.sequence, who));
        event(fmt::format(R"({{"ph":"e",{},"ts":{},"name":{}}})", place,
                          microseconds((part.begin + part.length).since_start()),
                          quoted(explain::words_of(part.cause))));
      }
    if (hop.started == sim::TrueTime::never()) continue;
    // An arrow begins at the first hop, or where this copy leaves the way of others.
    const bool is_last = i + 1 == way.hops.size() || way.hops[i + 1].started == sim::TrueTime::never();
    if (is_last && !has_begun) continue;
    if (!is_last && way.hops[i + 1].is_reported) continue;
    event(fmt::format(R"({{"ph":"{}","cat":"way","id":{},"pid":{},"tid":{},"ts":{},"name":{}{}}})",
                      !has_begun ? "s"
                      : is_last  ? "f"
                                 : "t",
                      ways_, process, thread, microseconds(hop.started.since_start()), stream,
                      is_last ? R"(,"bp":"e")" : ""));
    has_begun = true;
  }
}

/// The classes whose gates are open, as the state of a track beside the port.
void TimelineRecorder::show_gates(std::uint32_t position, sim::TrueTime time, std::uint64_t states) {
  const models::PortDirectory::Port& port = directory_.ports()[position];
  if (gate_tracks_[position] == no_track) {
    constexpr std::uint32_t behind_ports = 0x1'0000;
    Track track;
    track.process = port.id.node.value + 1;
    track.thread = port.id.port + behind_ports;
    track.since = time;
    name_thread(track.process, track.thread, fmt::format("port {}: open gates", port.id.port));
    gate_tracks_[position] = static_cast<TrackId>(tracks_.size());
    tracks_.push_back(std::move(track));
  }
  std::string open;
  for (int q = models::traffic_class_count - 1; q >= 0; --q)
    if ((states >> q & 1) != 0) open += fmt::format("{}{}", open.empty() ? "" : " ", q);
  const std::string text = open.empty() ? "none" : open;
  if (text != tracks_[gate_tracks_[position]].state) change_state(gate_tracks_[position], time, text);
}

void TimelineRecorder::record(const sim::TraceRecord& record) {
  const auto kind = static_cast<models::Occurrence>(record.kind);
  if (kind == models::Occurrence::gates_shown) {
    show_gates(directory_.find(record.where), record.time, record.what);
    return;
  }
  drops_.record(record);
  if (kind == models::Occurrence::drop) {
    mark_drop(record);
    return;
  }
  const bool begins = kind == models::Occurrence::started || kind == models::Occurrence::resumed;
  if (!begins && kind != models::Occurrence::cut) return;
  const std::uint32_t position = directory_.find(record.where);
  if (position == models::PortDirectory::none) return;
  Slice& slice = slices_[position];
  const auto octets = models::TransmissionDetail::unpack(record.detail).octets;
  if (kind == models::Occurrence::cut) {
    slice.octets = octets;
    slice.is_cut = true;
    return;
  }
  const models::Frame& frame = view_.frame({static_cast<std::uint32_t>(record.what)});
  write_slice(position);
  slice = {record.time, octets, frame.sequence, frame.stream, frame.priority, true, kind == models::Occurrence::resumed,
           false};
}

void TimelineRecorder::mark_drop(const sim::TraceRecord& record) {
  const std::uint32_t position = drops_.of(record).port;
  if (position == models::PortDirectory::none) return;
  const models::PortId port = directory_.ports()[position].id;
  const models::Frame& frame = view_.frame({static_cast<std::uint32_t>(record.what)});
  event(fmt::format(
      R"({{"ph":"i","s":"t","pid":{},"tid":{},"ts":{},"name":"drop","args":{{"stream":{},"sequence":{},"reason":"{}"}}}})",
      port.node.value + 1, port.port + 1u, microseconds(record.time.since_start()), stream_names_[frame.stream.value],
      frame.sequence, models::name_of(static_cast<models::DropReason>(record.detail))));
}

/// What a port sends is written when it is known how it ended.
void TimelineRecorder::write_slice(std::uint32_t position) {
  Slice& slice = slices_[position];
  if (!slice.is_open) return;
  slice.is_open = false;
  const models::PortDirectory::Port& port = directory_.ports()[position];
  const std::uint32_t mcrc = slice.is_cut ? models::mcrc.count : 0;
  const auto wire = std::int64_t{models::preamble_and_sfd.count} + slice.octets + mcrc;
  const char* const part = slice.is_continued ? (slice.is_cut ? R"(,"fragment":"middle")" : R"(,"fragment":"last")")
                                              : (slice.is_cut ? R"(,"fragment":"first")" : "");
  event(fmt::format(
      R"({{"ph":"X","pid":{},"tid":{},"ts":{},"dur":{},"name":{},"args":{{"sequence":{},"octets":{},"priority":{}{}}}}})",
      port.id.node.value + 1, port.id.port + 1u, microseconds(slice.start.since_start()),
      microseconds(port.octet_time * wire), stream_names_[slice.stream.value], slice.sequence, slice.octets + mcrc,
      slice.priority, part));
}

std::string TimelineRecorder::close(sim::TrueTime end) {
  for (std::uint32_t position = 0; position < slices_.size(); ++position) write_slice(position);
  for (TrackId track = 0; track < tracks_.size(); ++track) change_state(track, std::max(end, tracks_[track].since), "");
  file_.write("\n]}\n");
  return file_.close();
}

}  // namespace takt::output
