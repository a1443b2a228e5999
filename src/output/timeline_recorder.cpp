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

TimelineRecorder::TimelineRecorder(const models::Network& network, std::string path)
    : network_(&network), directory_(network), file_(std::move(path)) {
  file_.write("{\"displayTimeUnit\":\"ns\",\"traceEvents\":[\n");
  name_ports();
  slices_.resize(directory_.ports().size());
  for (const models::Stream& stream : network.traffic().streams()) stream_names_.push_back(quoted(stream.name));
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
  event(fmt::format(R"({{"ph":"M","name":"thread_name","pid":{},"tid":{},"args":{{"name":{}}}}})", process, thread, quoted(name)));
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
  if (!track.state.empty())
    event(fmt::format(R"({{"ph":"X","pid":{},"tid":{},"ts":{},"dur":{},"name":{}}})", track.process, track.thread,
                      microseconds(track.since.since_start()), microseconds(time - track.since), quoted(track.state)));
  track.since = time;
  track.state = state;
}

void TimelineRecorder::record(const sim::TraceRecord& record) {
  const auto kind = static_cast<models::Occurrence>(record.kind);
  const bool begins = kind == models::Occurrence::started || kind == models::Occurrence::resumed;
  if (!begins && kind != models::Occurrence::cut && kind != models::Occurrence::drop) return;
  const std::uint32_t position = directory_.find(record.where);
  if (position == models::PortDirectory::none) return;
  const models::PortDirectory::Port& port = directory_.ports()[position];
  Slice& slice = slices_[position];
  const auto octets = models::TransmissionDetail::unpack(record.detail).octets;
  if (kind == models::Occurrence::cut) {
    slice.octets = octets;
    slice.is_cut = true;
    return;
  }
  const models::Frame& frame = network_->traffic().frame({static_cast<std::uint32_t>(record.what)});
  const std::string& stream = stream_names_[frame.stream.value];
  if (begins) {
    write_slice(position);
    slice = {record.time, octets, frame.sequence, frame.stream, frame.priority, true, kind == models::Occurrence::resumed, false};
    return;
  }
  event(fmt::format(R"({{"ph":"i","s":"t","pid":{},"tid":{},"ts":{},"name":"drop","args":{{"stream":{},"sequence":{},"reason":"{}"}}}})",
                    port.id.node.value + 1, port.id.port + 1u, microseconds(record.time.since_start()), stream, frame.sequence,
                    models::name_of(static_cast<models::DropReason>(record.detail))));
}

/// What a port sends is written when it is known how it ended.
void TimelineRecorder::write_slice(std::uint32_t position) {
  Slice& slice = slices_[position];
  if (!slice.is_open) return;
  slice.is_open = false;
  const models::PortDirectory::Port& port = directory_.ports()[position];
  const std::uint32_t mcrc = slice.is_cut ? models::mcrc.count : 0;
  const auto wire = std::int64_t{models::preamble_and_sfd.count} + slice.octets + mcrc;
  const char* const part = slice.is_continued ? (slice.is_cut ? R"(,"fragment":"middle")" : R"(,"fragment":"last")") : (slice.is_cut ? R"(,"fragment":"first")" : "");
  event(fmt::format(R"({{"ph":"X","pid":{},"tid":{},"ts":{},"dur":{},"name":{},"args":{{"sequence":{},"octets":{},"priority":{}{}}}}})",
                    port.id.node.value + 1, port.id.port + 1u, microseconds(slice.start.since_start()), microseconds(port.octet_time * wire),
                    stream_names_[slice.stream.value], slice.sequence, slice.octets + mcrc, slice.priority, part));
}

std::string TimelineRecorder::close(sim::TrueTime end) {
  for (std::uint32_t position = 0; position < slices_.size(); ++position) write_slice(position);
  for (TrackId track = 0; track < tracks_.size(); ++track) change_state(track, std::max(end, tracks_[track].since), "");
  file_.write("\n]}\n");
  return file_.close();
}

}  // namespace takt::output
