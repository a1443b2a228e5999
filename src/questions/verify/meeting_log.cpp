// SPDX-License-Identifier: Apache-2.0
#include "verify/meeting_log.hpp"

#include <algorithm>

namespace takt::verify {

using models::Occurrence;

MeetingLog::MeetingLog(const models::Network& network, std::size_t most)
    : network_(&network), directory_(network), most_(most), waiting_(directory_.ports().size()) {}

void MeetingLog::record(const sim::TraceRecord& record) {
  const auto kind = static_cast<Occurrence>(record.kind);
  if (kind != Occurrence::enqueued && kind != Occurrence::started) return;
  const std::uint32_t port = directory_.find(record.where);
  if (port == models::PortDirectory::none) return;
  const models::Frame& frame = network_->traffic().frame({static_cast<std::uint32_t>(record.what)});
  std::vector<std::uint32_t>& waiting = waiting_[port];
  if (kind == Occurrence::started) {
    const auto mine = std::ranges::find_if(waiting, [&](std::uint32_t each) {
      return visits[each].stream == frame.stream.value && visits[each].produced == frame.produced;
    });
    if (mine != waiting.end()) {
      visits[*mine].started = record.time;
      waiting.erase(mine);
      return;
    }
  }
  if (visits.size() >= most_) {
    is_complete = false;
    return;
  }
  const bool waits = kind == Occurrence::enqueued;
  if (waits) waiting.push_back(static_cast<std::uint32_t>(visits.size()));
  visits.push_back(
      {port, frame.stream.value, frame.produced, record.time, waits ? sim::TrueTime::never() : record.time});
}

}  // namespace takt::verify
