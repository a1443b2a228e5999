// SPDX-License-Identifier: Apache-2.0
#include "papers/coexistence/output_log.hpp"

#include "models/ethernet/traffic.hpp"

namespace takt::papers::coexistence {

OutputLog::OutputLog(const scenario::Resolved& resolved, std::string_view commands_of) {
  for (const scenario::ResolvedApplication& application : resolved.applications)
    for (const scenario::ResolvedThread& thread : application.threads)
      if (application.name == commands_of && thread.publishes) stream_ = thread.stream;
}

void OutputLog::record(const sim::TraceRecord& record) {
  const auto kind = static_cast<models::Occurrence>(record.kind);
  if (kind == models::Occurrence::output_changed && record.what == 0)
    edges_.push_back({record.time, record.detail != 0});
  if (kind == models::Occurrence::produced && stream_ && record.detail == stream_->value)
    commands_.push_back(record.time);
}

}  // namespace takt::papers::coexistence
