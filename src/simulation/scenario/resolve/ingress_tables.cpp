// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/ingress_tables.hpp"

#include <charconv>
#include <vector>

#include "json/suggest.hpp"
#include "scenario/resolve/control_list.hpp"
#include "scenario/resolve/known_names.hpp"

namespace takt::scenario {
namespace {

models::Tagged tagged_of(TaggedFrames tagged) {
  switch (tagged) {
    case TaggedFrames::tagged:
      return models::Tagged::tagged;
    case TaggedFrames::priority:
      return models::Tagged::priority;
    case TaggedFrames::all:
      break;
  }
  return models::Tagged::all;
}

/// "02-00-5E-00-00-01", also with colons.
std::optional<models::MacAddress> mac_address(std::string_view text) {
  if (text.size() != 17) return std::nullopt;
  models::MacAddress address;
  for (std::size_t i = 0; i < 6; ++i) {
    const char* const digits = text.data() + 3 * i;
    std::uint8_t octet = 0;
    const auto [stop, error] = std::from_chars(digits, digits + 2, octet, 16);
    if (error != std::errc() || stop != digits + 2) return std::nullopt;
    if (i < 5 && digits[2] != '-' && digits[2] != ':') return std::nullopt;
    address.value = address.value << 8 | octet;
  }
  return address;
}

std::optional<models::AddressIndex> address_of_host(const Resolved& r, const std::string& name,
                                                    const json::Place& place, json::Diagnostics& diagnostics) {
  const auto node = r.topology.find(name);
  if (node && r.topology.nodes[*node].is_end_station()) return models::AddressIndex{*node};
  if (!node)
    report_unknown_node(r.topology, name, place, "the name of a host", diagnostics);
  else
    diagnostics.error_unless(r.topology.nodes[*node].is_of_unknown_kind, place, "not a host",
                             {json::quote(name), "the name of a host"});
  return std::nullopt;
}

std::optional<models::AddressIndex> address_of_stream(const Resolved& r, const NullIdentity& identity,
                                                      json::Diagnostics& diagnostics) {
  const models::StreamIndex stream = find_stream(r, *identity.stream);
  if (!stream.is_none()) return r.plan.streams[stream.value].destination;
  std::vector<std::string_view> names;
  for (const models::StreamPlan& plan : r.plan.streams) names.push_back(plan.name);
  diagnostics.error_unless(
      StreamNames(r, diagnostics).may_be(*identity.stream), identity.where.at("stream"), "unknown stream",
      {json::quote(*identity.stream), "the name of a stream", json::suggest(*identity.stream, names)});
  return std::nullopt;
}

std::optional<models::StreamIdentityEntry> identity_by_mask(const MaskIdentity& mask, json::Diagnostics& diagnostics) {
  models::MaskAndMatchIdentification function;
  bool fine = true;
  const auto read = [&](models::MacAddress& address, const std::string& text, std::string_view key) {
    const auto value = mac_address(text);
    if (!value)
      diagnostics.error(mask.where.at(key), "not a MAC address",
                        {json::quote(text), "six octets such as \"02-00-5E-00-00-01\""});
    fine = fine && value;
    address = value.value_or(models::MacAddress{});
  };
  read(function.destination_match, mask.destination, "destination");
  read(function.destination_mask, mask.destination_mask, "destination_mask");
  read(function.source_match, mask.source, "source");
  read(function.source_mask, mask.source_mask, "source_mask");
  if (!fine) return std::nullopt;
  return models::StreamIdentityEntry{{}, std::move(function)};
}

}  // namespace

models::StreamIndex find_stream(const Resolved& r, std::string_view name) {
  for (std::uint32_t i = 0; i < r.plan.streams.size(); ++i)
    if (r.plan.streams[i].name == name) return models::StreamIndex{i};
  return {};
}

models::StreamGateConfig stream_gate_of(const StreamGateEntryList& gate, json::Diagnostics& diagnostics) {
  models::StreamGateConfig config;
  config.name = gate.name;
  config.admin_gate_open = gate.open;
  config.admin_ipv = gate.ipv;
  const std::optional<Duration> sum = length_of_list(gate, diagnostics);
  if (!sum) return config;
  for (const StreamGateStep& step : gate.entries) {
    if (step.octets && !step.open)
      diagnostics.error(step.where.at("octets"), "octets of a closed gate",
                        {json::to_text(*step.octets) + " with \"open\": false", "octets of an open entry"});
    config.admin_control_list.push_back(
        {step.open, step.ipv, step.interval, step.octets ? std::optional(step.octets->count) : std::nullopt});
  }
  if (gate.entries.empty() && gate.cycle)
    diagnostics.error(gate.where.at("cycle"), "a cycle without entries", {"\"cycle\" alone", "\"entries\" too"});
  config.admin_cycle_time = gate.cycle.value_or(*sum);
  if (!gate.entries.empty() && config.admin_cycle_time < *sum)
    diagnostics.warning(
        gate.where.at("cycle"), "the end of the gate list is cut off",
        {"entries of " + json::to_text(*sum) + " in a cycle of " + json::to_text(config.admin_cycle_time),
         "entries that fit into the cycle"});
  config.admin_cycle_time_extension = gate.extension;
  config.admin_base_time = sim::LocalTime() + gate.base_time;
  config.is_running = gate.running;
  check_running(gate, diagnostics);
  config.closed_due_to_invalid_rx_enable = gate.block_invalid_rx;
  config.closed_due_to_octets_exceeded_enable = gate.block_octets_exceeded;
  // Entries or a cycle of no length were refused by the table.
  if (config.admin_cycle_time <= Duration()) config.admin_control_list.clear();
  return config;
}

models::NamedFlowMeterConfig meter_of(const Resolved& r, const Meter& meter, DataRate fastest,
                                      json::Diagnostics& diagnostics) {
  for (const auto& [rate, key] : {std::pair(meter.cir, "cir"), std::pair(meter.eir, "eir")})
    if (rate > fastest)
      diagnostics.error_unless(
          !r.topology.has_all_links, meter.where.at(key), "a meter faster than every link",
          {json::to_text(rate), "at most " + json::to_text(fastest) + ", the fastest link of the switch"});
  models::FlowMeterConfig config;
  config.committed_information_rate = meter.cir;
  config.committed_burst_size = meter.cbs;
  config.excess_information_rate = meter.eir;
  config.excess_burst_size = meter.ebs;
  config.coupling_flag = meter.coupling;
  config.color_mode = meter.color_aware ? models::ColorMode::color_aware : models::ColorMode::color_blind;
  config.drop_on_yellow = meter.drop_on_yellow;
  config.mark_all_frames_red_enable = meter.block_red;
  return {meter.name, config};
}

std::optional<models::StreamIdentityEntry> identity_of(const Resolved& r, const IdentifiedStream& stream,
                                                       json::Diagnostics& diagnostics) {
  if (stream.null) {
    const NullIdentity& null = *stream.null;
    std::optional<models::AddressIndex> address;
    if (null.destination) address = address_of_host(r, *null.destination, null.where.at("destination"), diagnostics);
    if (null.stream) address = address_of_stream(r, null, diagnostics);
    if (!address) return std::nullopt;
    return models::StreamIdentityEntry{{}, models::AddressIdentification{*address, tagged_of(null.tagged), null.vlan}};
  }
  if (stream.source) {
    const auto address = address_of_host(r, stream.source->source, stream.source->where.at("source"), diagnostics);
    if (!address) return std::nullopt;
    const models::MacAddress source = models::mac_address_of(*address, static_cast<std::uint32_t>(r.plan.nodes.size()));
    return models::StreamIdentityEntry{
        {}, models::SourceMacAndVlanIdentification{source, tagged_of(stream.source->tagged), stream.source->vlan}};
  }
  if (stream.mask) return identity_by_mask(*stream.mask, diagnostics);
  return std::nullopt;  // the table has reported it
}

}  // namespace takt::scenario
