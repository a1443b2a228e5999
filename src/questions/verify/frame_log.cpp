// SPDX-License-Identifier: Apache-2.0
#include "verify/frame_log.hpp"

#include <algorithm>
#include <utility>

#include "models/ethernet/sizes.hpp"

namespace takt::verify {

using models::Occurrence;

FrameLog::FrameLog(const models::Network& network, std::optional<explain::Delivery> delivery,
                   std::vector<bool> messages)
    : network_(&network), delivery_(delivery), messages_(std::move(messages)) {
  const auto add = [&](const models::LinkPlan& link, const models::LinkPlan::End& end,
                       const models::LinkPlan::End& peer) {
    const std::uint32_t component = network.ports(end.node)[end.port].id().index;
    if (ports_.size() <= component) ports_.resize(component + std::size_t{1});
    ports_[component] = Port{end.node, end.port, peer.node, link.rate.octet_time()};
  };
  for (const models::LinkPlan& link : network.plan().links) {
    add(link, link.a, link.b);
    add(link, link.b, link.a);
  }
}

const FrameLog::Port* FrameLog::port_of(sim::ComponentId component) const {
  return component.index < ports_.size() && ports_[component.index] ? &*ports_[component.index] : nullptr;
}

void FrameLog::record(const sim::TraceRecord& record) {
  const auto kind = static_cast<Occurrence>(record.kind);
  if (kind != Occurrence::enqueued && kind != Occurrence::started && kind != Occurrence::resumed &&
      kind != Occurrence::received)
    return;
  const models::Frame& frame = network_->traffic().frame({static_cast<std::uint32_t>(record.what)});
  const bool is_followed =
      delivery_ && delivery_->frame.stream == frame.stream && delivery_->frame.sequence == frame.sequence;
  if (kind == Occurrence::received) {
    const Arrival arrival{frame.stream, models::NodeIndex{static_cast<std::uint32_t>(record.detail)}, frame.produced,
                          record.time};
    if (frame.stream.value < messages_.size() && messages_[frame.stream.value]) arrivals_.push_back(arrival);
    if (!is_followed || delivered_ || arrival.listener != delivery_->listener ||
        arrival.latency() != delivery_->latency)
      return;
    delivered_ = arrival;
    way_ = way_to(arrival);
    return;
  }
  if (!is_followed) return;
  if (const Port* const port = port_of(record.where)) note_passage(record, *port);
}

void FrameLog::note_passage(const sim::TraceRecord& record, const Port& port) {
  const auto kind = static_cast<Occurrence>(record.kind);
  const auto last = std::find_if(passages_.rbegin(), passages_.rend(), [&](const Passage& each) {
    return each.node == port.node && each.port == port.number;
  });
  Passage* passage = last == passages_.rend() ? nullptr : &*last;
  const bool is_new = passage == nullptr || kind == Occurrence::enqueued ||
                      (kind == Occurrence::started && passage->left != sim::TrueTime::never());
  if (is_new)
    passage = &passages_.emplace_back(Passage{port.node, port.number, port.peer, record.time, sim::TrueTime::never()});
  if (kind == Occurrence::enqueued) return;
  passage->left = record.time + port.octet_time * (models::preamble_and_sfd.count +
                                                   models::TransmissionDetail::unpack(record.detail).octets);
}

/// Backwards from the listener. Of several copies the one that left last before the next port had it.
std::vector<Passage> FrameLog::way_to(const Arrival& arrival) const {
  std::vector<Passage> way;
  const models::NodeIndex talker = network_->plan().streams[arrival.stream.value].talker;
  models::NodeIndex at = arrival.listener;
  sim::TrueTime before = arrival.at;
  while (at != talker) {
    const Passage* latest = nullptr;
    for (const Passage& each : passages_)
      if (each.peer == at && each.left <= before && (latest == nullptr || each.left > latest->left)) latest = &each;
    if (latest == nullptr) return {};
    way.insert(way.begin(), *latest);
    at = latest->node;
    before = latest->left - sim::Duration::from_ps(1);
  }
  return way;
}

}  // namespace takt::verify
