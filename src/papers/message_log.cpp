#include "papers/message_log.hpp"

namespace takt::papers {

MessageLog::MessageLog(const scenario::Run& run, std::size_t program) {
  const scenario::ResolvedProgram& resolved = run.resolved().programs[program];
  for (std::size_t p = 0; p < resolved.participants.size(); ++p) {
    participants_[resolved.participants[p].value] = p;
    streams_[resolved.state_streams[p].value] = {p, true};
  }
  for (const scenario::ResolvedProcessData& data : resolved.process_data) streams_[data.stream.value] = {data.from, false};
}

void MessageLog::record(const sim::TraceRecord& record) {
  const auto kind = static_cast<models::Occurrence>(record.kind);
  if (kind == models::Occurrence::produced && streams_.contains(record.detail)) under_way_[record.what] = record.time;
  if (kind != models::Occurrence::received) return;
  const auto stream = streams_.find(record.detail >> 32);
  const auto sent = under_way_.find(record.what);
  if (stream == streams_.end() || sent == under_way_.end()) return;
  const std::size_t to = participants_.at(static_cast<std::uint32_t>(record.detail));
  messages_.push_back({sent->second, record.time, stream->second.from, to, stream->second.is_state});
}

}  // namespace takt::papers
