// SPDX-License-Identifier: Apache-2.0
#include "scenario/applications/dds_node.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::scenario {
namespace {

/// Vendor, number of the participant in the scenario, incarnation.
dds::GuidPrefix prefix_of(std::uint32_t number, std::uint32_t incarnation) {
  dds::GuidPrefix prefix;
  prefix.octets[0] = static_cast<std::uint8_t>(dds::takt_vendor.value >> 8);
  prefix.octets[1] = static_cast<std::uint8_t>(dds::takt_vendor.value & 0xFF);
  for (std::size_t i = 0; i < 4; ++i) {
    prefix.octets[4 + i] = static_cast<std::uint8_t>(number >> (24 - 8 * i));
    prefix.octets[8 + i] = static_cast<std::uint8_t>(incarnation >> (24 - 8 * i));
  }
  return prefix;
}

bool take(std::vector<std::uint32_t>& list, std::uint32_t number) { return std::erase(list, number) > 0; }

}  // namespace

DdsNode::DdsNode(const ResolvedParticipant& participant, std::uint32_t number, std::vector<dds::DurableTopic> keeps)
    : settings_(&participant), number_(number), keeps_(std::move(keeps)) {
  for (const dds::DurableTopic& topic : keeps_) kept_.push_back({topic.topic, 0, 0, 0});
}
DdsNode::~DdsNode() = default;

void DdsNode::start(models::HostServices& host) {
  dds::ParticipantConfig config = settings_->config;
  config.prefix = prefix_of(number_ + 1, ++incarnation_);
  started_ = host.now();
  figures_.time_to_match.reset();
  participant_ = std::make_unique<dds::Participant>(config, host.now());
  if (!keeps_.empty()) start_service(host.now());
}

/// What it keeps of persistent topics outlives a crash of its host, as a file does.
void DdsNode::start_service(sim::LocalTime now) {
  service_ = std::make_unique<dds::PersistenceService>(*participant_, persistent_, prefix_of(number_ + 1, 0));
  for (std::size_t k = 0; k < keeps_.size(); ++k) {
    const std::vector<std::string> problems = service_->add(keeps_[k], now);
    TAKT_CHECK(problems.empty(), "a topic whose settings were checked");
    kept_[k].restored = service_->kept(keeps_[k].topic);
  }
}

void DdsNode::crash() {
  if (!participant_) return;
  add_up(figures_);
  kept_ = kept();
  service_.reset();
  participant_.reset();
  transient_ = {};
  writable_.clear();
  timed_out_.clear();
}

dds::Storage* DdsNode::storage(plant::Durability durability) {
  if (durability == plant::Durability::persistent) return &persistent_;
  return durability == plant::Durability::transient ? &transient_ : nullptr;
}

dds::Guid DdsNode::persistence_guid(std::uint32_t thread) const {
  return {prefix_of(number_ + 1, 0), dds::EntityId::user(thread + 1, dds::EntityKind::writer_no_key)};
}

void DdsNode::receive(models::HostServices& host, models::StreamIndex stream, uadp::Octets message) {
  const auto at = std::lower_bound(settings_->hears.begin(), settings_->hears.end(), stream,
                                   [](const auto& each, models::StreamIndex s) { return each.stream < s; });
  TAKT_CHECK(at != settings_->hears.end() && at->stream == stream, "a stream that this participant hears");
  participant_->receive(message, at->source, host.now());
}

void DdsNode::wake(models::HostServices& host) {
  if (participant_->next_wake() <= host.now()) participant_->wake(host.now());
}

std::vector<KeptFigures> DdsNode::kept() const {
  std::vector<KeptFigures> all = kept_;
  for (std::size_t k = 0; service_ && k < keeps_.size(); ++k) {
    all[k].received += service_->received(keeps_[k].topic);
    all[k].kept = service_->kept(keeps_[k].topic);
  }
  return all;
}

void DdsNode::settle(models::HostServices& host) {
  if (service_) service_->run(host.now());
  while (const auto datagram = participant_->next_datagram()) send(host, *datagram);
  while (const auto event = participant_->next_event()) hear(*event);
}

void DdsNode::send(models::HostServices& host, const dds::DatagramView& datagram) {
  for (const dds::Locator& to : datagram.destinations) {
    const auto found =
        std::find_if(settings_->routes.begin(), settings_->routes.end(), [&](const ResolvedParticipant::Route& route) {
          return route.to == to && route.transport_priority == datagram.transport_priority;
        });
    // What is no sample of a topic goes as the rest of the domain does.
    const auto route = found != settings_->routes.end()
                           ? found
                           : std::find_if(settings_->routes.begin(), settings_->routes.end(),
                                          [&](const ResolvedParticipant::Route& each) { return each.to == to; });
    if (route == settings_->routes.end())
      ++figures_.unroutable;
    else
      host.send(route->stream, datagram.octets);
  }
}

void DdsNode::hear(const dds::Event& event) {
  switch (event.kind) {
    case dds::EventKind::participant_discovered:
      ++figures_.participants_found;
      break;
    case dds::EventKind::participant_lost:
      ++figures_.participants_lost;
      break;
    case dds::EventKind::matched:
      ++figures_.matches;
      figures_.time_to_match = event.at - started_;
      break;
    case dds::EventKind::incompatible_qos:
    case dds::EventKind::inconsistent_topic:
      // Partitions keep apart what is meant to be apart (DDS 1.4, 2.2.3.13).
      if (event.kind == dds::EventKind::incompatible_qos && event.policy == dds::PolicyId::partition) break;
      if (std::find(figures_.incompatible.begin(), figures_.incompatible.end(), event.reason) ==
          figures_.incompatible.end())
        figures_.incompatible.push_back(event.reason);
      break;
    case dds::EventKind::deadline_missed:
      ++figures_.deadlines_missed;
      break;
    case dds::EventKind::liveliness_lost:
      ++figures_.liveliness_lost;
      break;
    case dds::EventKind::sample_rejected:
      ++figures_.samples_rejected;
      break;
    case dds::EventKind::writable:
      writable_.push_back(event.entity);
      break;
    case dds::EventKind::write_timed_out:
      ++figures_.writes_timed_out;
      timed_out_.push_back(event.entity);
      break;
    default:
      break;
  }
}

bool DdsNode::is_write_possible(dds::WriterHandle writer) { return take(writable_, writer.number); }
bool DdsNode::is_write_timed_out(dds::WriterHandle writer) { return take(timed_out_, writer.number); }

void DdsNode::add_up(ParticipantFigures& figures) const {
  const dds::Figures& counted = participant_->figures();
  figures.messages_sent += counted.messages_sent;
  figures.octets_sent += counted.octets_sent;
  figures.messages_received += counted.messages_received;
  figures.heartbeats_sent += counted.sent[dds::SubmessageKind::heartbeat];
  figures.acknacks_sent += counted.sent[dds::SubmessageKind::ack_nack];
  figures.resent += counted.resent;
  if (const dds::Discovery* const discovery = participant_->discovery()) {
    const dds::MessageCount sent = discovery->figures().sent();
    figures.discovery_messages += sent.messages;
    figures.discovery_octets += sent.octets;
  }
}

ParticipantFigures DdsNode::figures() const {
  ParticipantFigures figures = figures_;
  if (participant_) add_up(figures);
  return figures;
}

}  // namespace takt::scenario
