// SPDX-License-Identifier: Apache-2.0
#include "application/thread_filter.hpp"

#include "json/suggest.hpp"

namespace takt::application {

std::optional<gateway::ContentFilter> filter_of(const plant::Thread& thread, const TopicShape& topic,
                                                json::Diagnostics& diagnostics) {
  if (!thread.filter) return std::nullopt;
  const json::Place place = thread.where.at("filter");
  if (!topic.is_dds) {
    diagnostics.error(place, "does not belong to OPC UA", {"\"filter\"", "a topic with \"protocol\": \"dds\""});
    return std::nullopt;
  }
  gateway::FilterMistake mistake;
  std::optional<gateway::ContentFilter> filter = gateway::ContentFilter::parse(*thread.filter, topic.type, mistake);
  if (!filter)
    diagnostics.error(place, "not a filter expression",
                      {json::quote(mistake.found) + " at character " + std::to_string(mistake.at + 1) + " of " +
                           json::quote(*thread.filter),
                       mistake.expected});
  return filter;
}

}  // namespace takt::application
