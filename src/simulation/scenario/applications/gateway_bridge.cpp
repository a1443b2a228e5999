// SPDX-License-Identifier: Apache-2.0
#include "scenario/applications/gateway_bridge.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::scenario {
namespace {

// The values have the same order.
static_assert(static_cast<gateway::Overflow>(plant::Overflow::keep_latest) == gateway::Overflow::keep_latest);

gateway::TypeMapping sound_mapping(const application::TopicShape& from, const application::TopicShape& to) {
  std::vector<std::string> problems;
  auto mapping = application::mapping_between(from, to, problems);
  TAKT_CHECK(mapping.has_value(), "a mapping that was checked");
  return std::move(*mapping);
}

void add(gateway::ChannelFigures& sum, const gateway::ChannelFigures& more) {
  sum.buffer.received += more.buffer.received;
  sum.buffer.forwarded += more.buffer.forwarded;
  sum.buffer.overwritten += more.buffer.overwritten;
  sum.buffer.dropped += more.buffer.dropped;
  sum.buffer.stale += more.buffer.stale;
  if (more.age.count > 0) {
    sum.age.least = sum.age.count == 0 ? more.age.least : std::min(sum.age.least, more.age.least);
    sum.age.greatest = std::max(sum.age.greatest, more.age.greatest);
    sum.age.count += more.age.count;
    sum.age.sum_ps += more.age.sum_ps;
  }
  for (std::size_t e = 0; e < sum.mapping_errors.size(); ++e) sum.mapping_errors[e] += more.mapping_errors[e];
}

}  // namespace

GatewayBridge::GatewayBridge(const ResolvedGateway& settings, const application::TopicShape& from,
                             const application::TopicShape& to)
    : settings_(&settings), mapping_(sound_mapping(from, to)) {}

void GatewayBridge::start() {
  channel_.emplace(mapping_,
                   gateway::BufferSettings{settings_->capacity, static_cast<gateway::Overflow>(settings_->overflow),
                                           settings_->stale_after});
}

void GatewayBridge::crash() {
  if (channel_) add(before_, channel_->figures());
  channel_.reset();
}

std::optional<uadp::Octets> GatewayBridge::pull(sim::LocalTime now) {
  const auto value = channel_->pull(now);
  return value ? std::optional<uadp::Octets>(value->octets) : std::nullopt;
}

gateway::ChannelFigures GatewayBridge::figures() const {
  gateway::ChannelFigures figures = before_;
  if (channel_) add(figures, channel_->figures());
  return figures;
}

}  // namespace takt::scenario
