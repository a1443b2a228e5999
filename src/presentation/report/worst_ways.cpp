// SPDX-License-Identifier: Apache-2.0
#include "report/worst_ways.hpp"

#include <algorithm>
#include <map>

#include "sim/check.hpp"

namespace takt::report {

WorstWays::WorstWays(const models::Network& network, const results::RunResult& result) : network_(&network) {
  const auto& streams = network.traffic().streams();
  std::map<std::string_view, std::uint32_t> index_of;
  for (std::uint32_t s = 0; s < streams.size(); ++s) index_of.emplace(streams[s].name, s);
  for (const results::StreamResult& stream : result.streams) {
    const auto found = index_of.find(stream.name);
    if (stream.latency && found != index_of.end()) sought_.push_back({{found->second}, stream.latency->max});
  }
  std::ranges::stable_sort(sought_, std::ranges::greater(), &Sought::latency);
  if (sought_.size() > most_streams) {
    left_out_ = sought_.size() - most_streams;
    sought_.resize(most_streams);
  }
  missing_ = sought_.size();
  of_stream_.assign(streams.size(), sought_.size());
  for (std::size_t i = 0; i < sought_.size(); ++i) of_stream_[sought_[i].stream.value] = i;
}

WorstWays::Sought* WorstWays::find(models::StreamIndex stream) {
  const std::size_t place = of_stream_[stream.value];
  return place < sought_.size() ? &sought_[place] : nullptr;
}

bool WorstWays::wants(models::StreamIndex stream) const {
  return stream.value < of_stream_.size() && of_stream_[stream.value] < sought_.size();
}

bool WorstWays::wants_delivery(const models::Frame& frame, models::NodeIndex, sim::TrueTime now) {
  const Sought* const sought = find(frame.stream);
  return sought != nullptr && !sought->found && now - frame.produced == sought->latency;
}

void WorstWays::ended(const explain::Way& way) {
  if (way.end != explain::Way::End::delivered) return;
  Sought* const sought = find(way.frame.stream);
  if (sought == nullptr || sought->found || way.latency() != sought->latency) return;
  sought->found = explain::explained(*network_, way);
  --missing_;
}

std::vector<const explain::ExplainedFrame*> WorstWays::frames() const {
  std::vector<const explain::ExplainedFrame*> all;
  for (const Sought& each : sought_)
    if (each.found) all.push_back(&*each.found);
  return all;
}

}  // namespace takt::report
