// SPDX-License-Identifier: Apache-2.0
// The vocabulary of device files. See tables.cpp.
#include "models/ethernet/sizes.hpp"
#include "scenario/description/device.hpp"
#include "scenario/description/limits.hpp"

namespace takt::scenario {
namespace {

using json::optional;
using json::required;

constexpr DataRate least_rate{10'000'000};
constexpr DataRate most_rate{100'000'000'000};

}  // namespace

const json::Object& describe(json::Type<DeviceDelay>) {
  static constexpr json::Field fields[] = {
      optional<&DeviceDelay::from>("from", "Rate of the port of entry; any if absent.",
                                   {.min = least_rate, .max = most_rate}),
      optional<&DeviceDelay::to>("to", "Rate of the port of exit; any if absent.",
                                 {.min = least_rate, .max = most_rate}),
      optional<&DeviceDelay::from_medium>("from_medium", "Medium at the port of entry, instead of its rate."),
      optional<&DeviceDelay::to_medium>("to_medium", "Medium at the port of exit, instead of its rate."),
      optional<&DeviceDelay::traffic_class>("class", "The traffic class; all if absent.", {.max = 7}),
      required<&DeviceDelay::least>("least", "The least delay, independent of the length of the frame.", {.max = 1_s}),
      required<&DeviceDelay::greatest>("greatest", "The greatest.", {.max = 1_s}),
      optional<&DeviceDelay::least_per_octet>(
          "least_per_octet", "Besides, at least so much for each octet of the frame, its reception not counted.",
          {.max = 1_us}),
      optional<&DeviceDelay::greatest_per_octet>("greatest_per_octet", "Besides, at most so much for each octet.",
                                                 {.max = 1_us}),
  };
  static constexpr std::string_view from[] = {"from", "from_medium"};
  static constexpr std::string_view to[] = {"to", "to_medium"};
  static constexpr json::Group groups[] = {json::at_most_one_of(from), json::at_most_one_of(to)};
  static constexpr json::Object table =
      json::object<DeviceDelay>("device_delay",
                                "What a bridge takes from the last bit in to the egress queue, PHYs included. "
                                "Of several entries that hold the least and the greatest count.",
                                fields, {.groups = groups});
  return table;
}

const json::Object& describe(json::Type<DevicePhy>) {
  static constexpr json::Field fields[] = {
      optional<&DevicePhy::rate>("rate", "At ports of this rate; any if absent.",
                                 {.min = least_rate, .max = most_rate}),
      optional<&DevicePhy::medium>("medium", "At ports of this medium, instead of a rate."),
      optional<&DevicePhy::transmit>("transmit", "From the time stamp of a frame that leaves to the medium.",
                                     {.max = 1_ms}),
      optional<&DevicePhy::receive>("receive", "From the medium to the time stamp of a frame that comes.",
                                    {.max = 1_ms}),
      optional<&DevicePhy::variation>(
          "variation", "How far the least and the greatest lie apart: an error of time stamps.", {.max = 1_ms}),
  };
  static constexpr std::string_view either[] = {"rate", "medium"};
  static constexpr json::Group groups[] = {json::at_most_one_of(either)};
  static constexpr json::Object table =
      json::object<DevicePhy>("device_phy", "Latencies of a PHY. They act on time stamps; delays count them already.",
                              fields, {.groups = groups});
  return table;
}

const json::Object& describe(json::Type<DeviceTimeStamps>) {
  static constexpr json::Field fields[] = {
      optional<&DeviceTimeStamps::granularity>(
          "granularity", "The counter behind time stamps goes on in steps of this.", {.min = 1_ps, .max = 1_ms}),
      optional<&DeviceTimeStamps::error>("error", "Greatest random error of a time stamp, either way.", {.max = 1_ms}),
  };
  static constexpr json::Object table =
      json::object<DeviceTimeStamps>("device_time_stamps", "How exact time stamps are.", fields);
  return table;
}

const json::Object& describe(json::Type<DeviceResidence>) {
  static constexpr json::Field fields[] = {
      required<&DeviceResidence::least>("least", "The shortest.", {.max = 1_s}),
      required<&DeviceResidence::greatest>("greatest", "The longest.", {.max = 1_s}),
  };
  static constexpr json::Object table = json::object<DeviceResidence>(
      "device_residence", "Residence and turn-around time of gPTP messages, the queue of the port not counted.",
      fields);
  return table;
}

const json::Object& describe(json::Type<DeviceFeatures>) {
  static constexpr json::Field fields[] = {
      optional<&DeviceFeatures::gates>("gates", "Transmission gates (IEEE 802.1Q 8.6.8.4)."),
      optional<&DeviceFeatures::preemption>("preemption", "Frame preemption (IEEE 802.3 clause 99)."),
      optional<&DeviceFeatures::cut_through>("cut_through", "Frames begin to leave before they have wholly come."),
      optional<&DeviceFeatures::credit_based_shaper>("credit_based_shaper",
                                                     "Credit-based shapers (IEEE 802.1Q 8.6.8.2)."),
      optional<&DeviceFeatures::ats>("ats", "Asynchronous traffic shaping (IEEE 802.1Q 8.6.11)."),
      optional<&DeviceFeatures::ets>("ets", "Enhanced transmission selection (IEEE 802.1Q 8.6.8.3)."),
      optional<&DeviceFeatures::policing>("policing", "Stream filters, stream gates and meters (IEEE 802.1Q 8.6.5)."),
      optional<&DeviceFeatures::frer>("frer", "Splitting and merging of redundant streams (IEEE 802.1CB)."),
      optional<&DeviceFeatures::gptp>("gptp", "Synchronisation by IEEE 802.1AS."),
  };
  static constexpr json::Object table = json::object<DeviceFeatures>(
      "device_features", "What it has and has not. Of what is absent nothing is known, and nothing is refused.",
      fields);
  return table;
}

const json::Object& describe(json::Type<Device>) {
  static constexpr json::Field fields[] = {
      optional<&Device::schema>("$schema", "The schema, for editors."),
      required<&Device::name>("name", "What the type is called.", {.min_length = 1, .max_length = 256}),
      optional<&Device::vendor>("vendor", "Who makes it.", {.max_length = 256}),
      required<&Device::source>("source", "Where the figures come from: a data sheet, a paper, a measurement.",
                                {.min_length = 1, .max_length = 4096}),
      optional<&Device::description>("description", "What else is to be known.", {.max_length = 4096}),
      optional<&Device::delays>("delays", "Forwarding delays.", {.max_items = 4096}),
      optional<&Device::phys>("phys", "Latencies of PHYs.", {.max_items = 64}),
      optional<&Device::ports>("ports", "Most links of a node.", {.min = 1, .max = most_ports}),
      optional<&Device::rates>("rates", "Rates that its ports have; any if absent.",
                               {.max_items = 16, .unique = true, .items = {.min = least_rate, .max = most_rate}}),
      optional<&Device::traffic_classes>("traffic_classes", "As that of a node."),
      optional<&Device::queues>("queues", "As those of a node."),
      optional<&Device::mtu>("mtu", "As that of a node.", {.min = models::maximum_msdu, .max = models::largest_msdu}),
      optional<&Device::gate_limits>("gate_limits", "As those of a node."),
      optional<&Device::time_stamps>("time_stamps", "How exact its time stamps are, where clocks are free."),
      optional<&Device::gptp_residence>("gptp_residence", "How long gPTP messages stay in it."),
      optional<&Device::features>("features", "What it has and has not."),
  };
  static constexpr json::Object table = json::object<Device>("device", "A type of device, by its data sheet.", fields);
  return table;
}

}  // namespace takt::scenario
