#include "papers/message_log.hpp"

namespace takt::papers {

MessageLog::MessageLog(const scenario::Run& run, std::size_t program) {
  const scenario::ResolvedProgram& resolved = run.resolved().programs[program];
  for (std::size_t p = 0; p < resolved.members.size(); ++p) {
    participants_[resolved.members[p].node.value] = p;
    streams_[resolved.members[p].state.value] = {p, true};
  }
  for (std::size_t d = 0; d < resolved.process_data.size(); ++d) streams_[resolved.stream_of(d).value] = {resolved.process_data[d].from, false};
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
