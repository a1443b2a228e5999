// SPDX-License-Identifier: Apache-2.0
#include "report/message_log.hpp"

#include <algorithm>

namespace takt::report {

MessageLog::MessageLog(const scenario::Run& run, std::size_t program, std::vector<Span> spans)
    : traffic_(&run.network().traffic()), spans_(std::move(spans)) {
  const scenario::ResolvedProgram& resolved = run.resolved().programs[program];
  for (std::size_t p = 0; p < resolved.members.size(); ++p) {
    participants_[resolved.members[p].node.value] = p;
    streams_[resolved.members[p].state.value] = {p, true};
  }
  for (std::size_t d = 0; d < resolved.process_data.size(); ++d)
    streams_[resolved.stream_of(d).value] = {resolved.process_data[d].from, false};
}

void MessageLog::record(const sim::TraceRecord& record) {
  if (static_cast<models::Occurrence>(record.kind) != models::Occurrence::received) return;
  if (!spans_.empty() &&
      std::none_of(spans_.begin(), spans_.end(), [&](const Span& span) { return span.holds(record.time); }))
    return;
  const auto stream = streams_.find(record.detail >> 32);
  const auto to = participants_.find(static_cast<std::uint32_t>(record.detail));
  if (stream == streams_.end() || to == participants_.end()) return;
  const sim::TrueTime sent = traffic_->frame({static_cast<std::uint32_t>(record.what)}).produced;
  messages_.push_back({sent, record.time, stream->second.from, to->second, stream->second.is_state});
}

}  // namespace takt::report
