// SPDX-License-Identifier: Apache-2.0
// What a bridge announces of itself, as a type of device and in the node of a scenario.
#include "scenario/description/device.hpp"

#include <gtest/gtest.h>

#include "files.hpp"

namespace takt::interchange::test::device_test {
namespace {

using scenario::Device;
using scenario::Medium;
using sim::Duration;

InputFile data_sheet() {
  return input(std::filesystem::path(TAKT_SOURCE_DIR) / "tests/findings/import/bridge-data-sheet.json");
}

Device device_of(const Reading& reading) {
  if (!reading.imported.device) throw std::runtime_error("no device:\n" + reading.remarks());
  json::Diagnostics diagnostics;
  const auto document = json::parse(*reading.imported.device, "device.json", diagnostics);
  Device device;
  if (!document || !json::decode(*document, device, diagnostics)) throw std::runtime_error(diagnostics.to_text());
  return device;
}

/// A bridge with one port; both are members.
InputFile bridge(const std::string& port, const std::string& component, const std::string& ethernet = "{}") {
  InputFile file;
  file.name = "swp.json";
  file.device = "swp";
  file.text = R"({"ietf-interfaces:interfaces": {"interface": [{"name": "swp1", "type": "iana-if-type:ethernetCsmacd",
    "ieee802-ethernet-interface:ethernet": )" +
              ethernet + R"(, "ieee802-dot1q-bridge:bridge-port": {)" + port +
              R"(}}]}, "ieee802-dot1q-bridge:bridges": {"bridge": [{"name": "br", "address": "02-00-00-00-00-01",
    "bridge-type": "customer-vlan-bridge", "component": [{"name": "c", "type": "c-vlan-component")" +
              (component.empty() ? "" : ", ") + component + "}]}]}}";
  return file;
}

TEST(DeviceImport, ADataSheetIsAType) {
  const Device device = device_of(read("device", {data_sheet()}));
  EXPECT_EQ(device.name, "bridge-data-sheet");
  ASSERT_EQ(device.delays.size(), 1u);
  EXPECT_EQ(device.delays[0].from_medium, Medium::base_t_1000);
  EXPECT_EQ(device.delays[0].to_medium, Medium::base_t_1000);
  EXPECT_FALSE(device.delays[0].traffic_class);  // all that it says are of one interval
  EXPECT_EQ(device.delays[0].least, Duration::from_ps(920'000));
  EXPECT_EQ(device.delays[0].greatest, Duration::from_ps(1'080'000));
  ASSERT_EQ(device.phys.size(), 1u);
  EXPECT_EQ(device.phys[0].transmit, Duration::from_ps(320'000));
  EXPECT_EQ(device.phys[0].variation, Duration::from_ps(8'000));
  EXPECT_EQ(device.ports, 1u);
}

TEST(DeviceImport, ItsDelaysAreThoseOfTheNode) {
  const Reading reading = read("yang", {data_sheet()});
  ASSERT_TRUE(reading.imported.scenario) << reading.remarks();
  const auto& node = std::get<scenario::SwitchNode>(reading.imported.scenario->network.nodes.front().second);
  EXPECT_EQ(node.forwarding_delay, Duration::from_ps(920'000));
  ASSERT_TRUE(node.forwarding_jitter && node.forwarding_jitter->uniform);
  EXPECT_EQ(node.forwarding_jitter->uniform->to, Duration::from_ps(160'000));
}

TEST(DeviceImport, ClassesOctetsAndFeatures) {
  const Device device = device_of(read(
      "device",
      {bridge(
          R"("iecieee60802-bridge:transmission-selection-algorithm": [{"traffic-class": 6, "algorithms":
                 [{"algorithm": "ieee802-dot1q-types:credit-based-shaper"}]}],
               "iecieee60802-bridge:supported-resource-pools": [{"resource-pool-name": "p", "covered-time-interval":
                 {"numerator": 1, "denominator": 1000}, "resource-pool-traffic-classes": [{"traffic-class": 7}]}],
               "traffic-class": {"traffic-class-table": {"number-of-traffic-classes": 4}},
               "ieee802-dot1q-sched-bridge:gate-parameter-table": {"supported-list-max": 16, "tick-granularity": 80,
                 "iecieee60802-sched-bridge:min-gating-times": [{"speed": 1000, "min-interval-time": 500}]})",
          R"("iecieee60802-bridge:frer-supported": false, "iecieee60802-bridge:max-ptp-instances": 2,
               "iecieee60802-bridge:independent-delays": [
                 {"in-port-mau-type": 30, "out-port-mau-type": 16, "traffic-class": 0, "independent-delay-min": 100, "independent-delay-max": 300},
                 {"in-port-mau-type": 30, "out-port-mau-type": 16, "traffic-class": 7, "independent-delay-min": 100, "independent-delay-max": 200}],
               "iecieee60802-bridge:dependent-delays": [{"in-port-line-speed": 1000, "dependent-delay-min": 8000, "dependent-delay-max": 8010}])",
          R"({"iecieee60802-ethernet-interface:supported-mau-types": [{"mau-type": 16, "preemption-supported": false},
               {"mau-type": 30, "preemption-supported": true}]})")}));
  ASSERT_EQ(device.delays.size(), 2u);  // they differ by class
  EXPECT_EQ(device.delays[1].traffic_class, 7);
  EXPECT_EQ(device.delays[1].greatest, Duration::from_ps(200'000));
  // 8000 ps of the 8010 are the reception of an octet at 1 Gb/s.
  EXPECT_EQ(device.delays[1].least_per_octet, Duration());
  EXPECT_EQ(device.delays[1].greatest_per_octet, Duration::from_ps(10));
  EXPECT_EQ(device.rates, (std::vector<sim::DataRate>{{100'000'000}, {1'000'000'000}}));
  EXPECT_EQ(device.features.credit_based_shaper, true);
  EXPECT_EQ(device.features.ats, false);
  EXPECT_EQ(device.features.preemption, true);
  EXPECT_EQ(device.features.frer, false);
  EXPECT_EQ(device.features.gptp, true);
  EXPECT_EQ(device.features.gates, true);
  EXPECT_EQ(device.traffic_classes, scenario::TrafficClasses::four);
  ASSERT_TRUE(device.gate_limits && device.queues);
  EXPECT_EQ(device.gate_limits->entries, 16u);
  EXPECT_EQ(device.gate_limits->granularity, Duration::from_ps(8'000));
  EXPECT_EQ(device.gate_limits->least_interval, Duration::from_ps(500'000));
  ASSERT_EQ(device.queues->classes.size(), 1u);
  EXPECT_EQ(device.queues->classes[0].octets, sim::Octets{125'000});  // 1 ms at 1 Gb/s
}

TEST(DeviceImport, XmlSaysTheSame) {
  InputFile xml;
  xml.name = "swp.xml";
  xml.device = "swp";
  xml.text =
      R"(<bridges xmlns="urn:ieee:std:802.1Q:yang:ieee802-dot1q-bridge"><bridge><name>br</name><address>02-00-00-00-00-01</address><bridge-type>customer-vlan-bridge</bridge-type><component><name>c</name><type>c-vlan-component</type>
<independent-delays xmlns="urn:ieee:std:60802:yang:iecieee60802-bridge"><in-port-mau-type>30</in-port-mau-type><out-port-mau-type>30</out-port-mau-type><traffic-class>6</traffic-class><independent-delay-min>920</independent-delay-min><independent-delay-max>1080</independent-delay-max></independent-delays>
</component></bridge></bridges>)";
  const Device device = device_of(read("device", {xml}));
  ASSERT_EQ(device.delays.size(), 1u);
  EXPECT_EQ(device.delays[0].greatest, Duration::from_ps(1'080'000));
}

TEST(DeviceImport, WhatHasNoPlaceIsRemarked) {
  const Reading reading = read(
      "device",
      {bridge(R"("iecieee60802-bridge:supported-resource-pools": [{"resource-pool-name": "p", "covered-time-interval":
                 {"numerator": 1, "denominator": 1000}, "resource-pool-traffic-classes": [{"traffic-class": 6}, {"traffic-class": 7}]}])",
              R"("iecieee60802-bridge:independent-delays": [{"in-port-mau-type": 29, "out-port-mau-type": 30,
                 "traffic-class": 0, "independent-delay-min": 1, "independent-delay-max": 2}],
               "iecieee60802-bridge:dependent-delays": [{"in-port-line-speed": 1000, "dependent-delay-min": 0, "dependent-delay-max": 8000}])")});
  const std::string remarks = reading.remarks();
  for (const char* const part : {"the pool \"p\", which 2 classes share", "MAU type 29", "the device cuts through",
                                 "delays for each octet without independent ones"})
    EXPECT_NE(remarks.find(part), std::string::npos) << part << "\n" << remarks;
}

TEST(DeviceImport, MistakesAreTheFile) {
  const auto refused = [](const std::string& component) {
    return read("device", {bridge("", component)}).diagnostics.to_text();
  };
  EXPECT_NE(refused("").find("a bridge that announces nothing"), std::string::npos);
  EXPECT_NE(refused(R"("iecieee60802-bridge:independent-delays": [{"in-port-mau-type": 30, "out-port-mau-type": 30,
    "traffic-class": 0, "independent-delay-min": 9, "independent-delay-max": 2}])")
                .find("a delay whose least is more"),
            std::string::npos);
  EXPECT_NE(refused(R"("iecieee60802-bridge:independent-delays": [{"in-port-mau-type": 30, "out-port-mau-type": 30,
    "traffic-class": 0, "independent-delay-min": 9}])")
                .find("half of a delay"),
            std::string::npos);
  EXPECT_NE(refused(R"("iecieee60802-bridge:frer-supporter": true)").find("not in the module"), std::string::npos);
}

}  // namespace
}  // namespace takt::interchange::test::device_test
