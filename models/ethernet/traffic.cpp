// SPDX-License-Identifier: Apache-2.0
#include "models/ethernet/traffic.hpp"

#include <algorithm>

#include "models/ethernet/sizes.hpp"

namespace takt::models {

StreamIndex Traffic::add_stream(Stream stream) {
  const StreamIndex index{static_cast<std::uint32_t>(streams_.size())};
  // What does not change from frame to frame is part of the place, so that it costs nothing.
  stream.production = sim::Digest::key_of(static_cast<std::uint32_t>(Occurrence::produced),
                                          sim::Content(index.value, stream.source.value, stream.destination.value,
                                                       stream.vlan, stream.priority, stream.tagged)
                                              .value());
  streams_.push_back(std::move(stream));
  return index;
}

inline FrameIndex Traffic::make(StreamIndex index, Octets payload, sim::TrueTime now) {
  Stream& stream = streams_[index.value];
  const FrameIndex handle = frames_.allocate();
  Frame& frame = frames_[handle];
  frame.produced = now;
  frame.sequence = stream.sent++;
  frame.destination = stream.destination;
  frame.source = stream.source;
  frame.stream = index;
  frame.payload = PayloadIndex{};
  frame.references = 1;
  frame.length = static_cast<std::uint16_t>(frame_length(stream.headers + payload, stream.tagged).count);
  frame.msdu = static_cast<std::uint16_t>((stream.headers + payload).count);
  frame.vlan = stream.vlan;
  frame.priority = stream.priority;
  frame.queue_priority = stream.priority;
  frame.tagged = stream.tagged;
  frame.r_tagged = false;
  frame.bad_fcs = false;
  frame.drop_eligible = false;
  frame.link_local = stream.link_local;
  frame.on_route = true;
  frame.hop = 0;
  frame.marked = false;
  return handle;
}

inline PayloadIndex Traffic::keep(std::span<const std::byte> octets) {
  const PayloadIndex payload = payloads_.allocate();
  Payload& copy = payloads_[payload];
  TAKT_CHECK(octets.size() <= copy.octets.size(), "a payload fits into one frame");
  copy.references = 1;
  copy.length = static_cast<std::uint16_t>(octets.size());
  std::copy(octets.begin(), octets.end(), copy.octets.begin());
  return payload;
}

inline FrameIndex Traffic::make(StreamIndex index, std::span<const std::byte> octets, sim::TrueTime now) {
  const FrameIndex handle = make(index, Octets{static_cast<std::uint32_t>(octets.size())}, now);
  frames_[handle].payload = keep(octets);
  return handle;
}

FrameIndex Traffic::take_over(const Frame& frame, std::span<const std::byte> payload) {
  const FrameIndex handle = frames_.allocate();
  frames_[handle] = frame;
  frames_[handle].references = 1;
  if (!frame.payload.is_none()) frames_[handle].payload = keep(payload);
  return handle;
}

void Traffic::adopt(const Traffic& other) {
  TAKT_CHECK(streams_.size() == other.streams_.size(), "parts of a run have the same streams");
  for (std::size_t s = 0; s < streams_.size(); ++s) {
    Stream& stream = streams_[s];
    const Stream& more = other.streams_[s];
    stream.sent += more.sent;
    stream.delivered += more.delivered;
    stream.copies += more.copies;
    stream.latency.add(more.latency);
    for (std::size_t reason = 0; reason < stream.dropped.size(); ++reason)
      stream.dropped[reason] += more.dropped[reason];
  }
  book_.adopt(other.book_);
  adopted_.push_back(&other);
}

FrameIndex Traffic::produce(StreamIndex index, Octets payload, sim::TrueTime now) { return make(index, payload, now); }
FrameIndex Traffic::produce(StreamIndex index, std::span<const std::byte> octets, sim::TrueTime now) {
  return make(index, octets, now);
}

FrameIndex Traffic::produce(StreamIndex index, Octets payload, sim::Simulation& simulation) {
  const FrameIndex handle = make(index, payload, simulation.now());
  count_production(frames_[handle], simulation);
  return handle;
}

FrameIndex Traffic::produce(StreamIndex index, std::span<const std::byte> octets, sim::Simulation& simulation) {
  const FrameIndex handle = make(index, octets, simulation.now());
  count_production(frames_[handle], simulation);
  return handle;
}

FrameIndex Traffic::separate(FrameIndex index, sim::ComponentId where) {
  Frame& original = frames_[index];
  TAKT_CHECK(is_under_way(original), "a frame gets a record of its own while it is under way");
  const FrameIndex made = frames_.allocate();
  frames_[made] = original;
  frames_[made].references = 1;
  if (!original.payload.is_none()) ++payloads_[original.payload].references;
  --original.references;
  if (traced_run_ != nullptr && traced_run_->trace() != nullptr)
    traced_run_->trace()->record(
        {traced_run_->now(), static_cast<std::uint32_t>(Occurrence::separated), where, made.value, index.value});
  return made;
}

void Traffic::drop(FrameIndex index, DropReason reason, sim::ComponentId where, sim::Simulation& simulation) {
  const Frame& frame = frames_[index];
  ++streams_[frame.stream.value].dropped[static_cast<std::size_t>(reason)];
  if (!book_.is_empty()) [[unlikely]]
    book_.drop(frame, reason);
  simulation.digest().add(static_cast<std::uint32_t>(Occurrence::drop),
                          static_cast<std::uint64_t>(frame.stream.value) << 32 | where.index, simulation.now(),
                          record_of(frame) ^ sim::mix64(static_cast<std::uint64_t>(reason) + 1));
  if (sim::TraceSink* const trace = simulation.trace()) [[unlikely]]
    trace->record({simulation.now(), static_cast<std::uint32_t>(Occurrence::drop), where, index.value,
                   static_cast<std::uint64_t>(reason)});
  release(index);
}

}  // namespace takt::models
