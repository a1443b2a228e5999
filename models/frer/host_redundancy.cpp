// SPDX-License-Identifier: Apache-2.0
#include "models/frer/host_redundancy.hpp"

#include <algorithm>

namespace takt::models {
namespace {

constexpr std::size_t few_streams = 4;  // to go through them is faster than to search

template <class Entries>
auto place_of(Entries& entries, StreamIndex stream) {
  return std::lower_bound(entries.begin(), entries.end(), stream,
                          [](const auto& entry, StreamIndex s) { return entry.stream < s; });
}

/// The entry of the stream, or null.
template <class Entries>
auto* entry_of(Entries& entries, StreamIndex stream) {
  if (entries.size() <= few_streams) [[likely]] {
    for (auto& entry : entries)
      if (entry.stream == stream) return &entry;
    return static_cast<decltype(entries.data())>(nullptr);
  }
  const auto at = place_of(entries, stream);
  return at != entries.end() && at->stream == stream ? &*at : nullptr;
}

}  // namespace

void TalkerRedundancy::add(StreamIndex stream, const StreamSplitConfig& config, sim::ComponentId where) {
  TAKT_CHECK(find(stream) == nullptr, "a stream is split once");
  streams_.insert(place_of(streams_, stream), {stream, StreamSplit(config, where)});
  outgoing_.resize(std::max(outgoing_.size(), std::max<std::size_t>(1, config.members.size())));
}

StreamSplit* TalkerRedundancy::find(StreamIndex stream) {
  Entry* const entry = entry_of(streams_, stream);
  return entry == nullptr ? nullptr : &entry->split;
}

std::span<const TalkerRedundancy::Outgoing> TalkerRedundancy::send(Traffic& traffic, FrameIndex frame) {
  StreamSplit* const split = find(traffic.frame(frame).stream);
  if (split == nullptr) return {};
  const std::span<const FrameIndex> frames = split->split(traffic, frame);
  for (std::size_t i = 0; i < frames.size(); ++i) outgoing_[i] = {frames[i], split->config().members[i].port};
  return {outgoing_.data(), frames.size()};
}

void ListenerRedundancy::add(StreamIndex stream, const StreamRecoveryConfig& config, sim::ComponentId where) {
  TAKT_CHECK(find(stream) == nullptr, "a stream is recovered once");
  streams_.insert(place_of(streams_, stream), {stream, StreamRecovery(config, where)});
}

StreamRecovery* ListenerRedundancy::find(StreamIndex stream) {
  Entry* const entry = entry_of(streams_, stream);
  return entry == nullptr ? nullptr : &entry->recovery;
}

std::optional<FrameIndex> ListenerRedundancy::receive(Traffic& traffic, FrameIndex index, std::uint16_t port,
                                                      sim::LocalTime now) {
  const Frame& frame = traffic.frame(index);
  StreamRecovery* const recovery = find(frame.stream);
  if (recovery == nullptr) return index;
  const std::size_t member = recovery->config().individual_recovery ? recovery->member_of(frame.destination, frame.vlan)
                                                                    : StreamRecovery::no_member;
  return recovery->receive(traffic, index, member, port, now);
}

}  // namespace takt::models
