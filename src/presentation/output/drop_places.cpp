// SPDX-License-Identifier: Apache-2.0
#include "output/drop_places.hpp"

#include <algorithm>
#include <ranges>

namespace takt::output {

using models::Occurrence;

DropPlaces::DropPlaces(const models::Network& network, const models::PortDirectory& directory)
    : directory_(&directory), node_of_component_(network.nodes_of_components()) {}

std::vector<DropPlaces::Arrival>& DropPlaces::arrivals_of(std::uint64_t frame) {
  if (frame >= arrivals_.size()) arrivals_.resize(frame + 1);
  return arrivals_[frame];
}

void DropPlaces::record(const sim::TraceRecord& record) {
  // Messages of gPTP, which end at the next node, have no record on a tape.
  if (record.what >= none) return;
  switch (static_cast<Occurrence>(record.kind)) {
    case Occurrence::produced:
      arrivals_of(record.what).clear();
      break;
    case Occurrence::separated: {
      // A record that began before the recording has none.
      const std::vector<Arrival> before =
          record.detail < arrivals_.size() ? arrivals_[record.detail] : std::vector<Arrival>();
      arrivals_of(record.what) = before;
      break;
    }
    case Occurrence::arrived:
      arrivals_of(record.what).push_back({node_of(record.where), models::ArrivalDetail::unpack(record.detail)});
      break;
    default:
      break;
  }
}

DropPlaces::Place DropPlaces::of(const sim::TraceRecord& drop) const {
  if (const std::uint32_t port = directory_->find(drop.where); port != none) return {port, none};
  const models::NodeIndex node = node_of(drop.where);
  if (node.is_none()) return {};
  if (drop.what < arrivals_.size())
    for (const Arrival& arrival : std::views::reverse(arrivals_[drop.what]))
      if (arrival.node == node)
        return {directory_->find(models::PortId{node, arrival.how.port}), directory_->find(arrival.how.sender)};
  return {directory_->find(models::PortId{node, 0}), none};
}

}  // namespace takt::output
