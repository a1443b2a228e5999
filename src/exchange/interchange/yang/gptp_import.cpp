// SPDX-License-Identifier: Apache-2.0
// The data sets of a device to what takt has of gPTP.
#include <algorithm>
#include <map>
#include <set>

#include "interchange/yang/gptp.hpp"
#include "interchange/yang/modules.hpp"
#include "json/quantity.hpp"

namespace takt::interchange::yang {
namespace {

using sim::Duration;

class GptpReader {
 public:
  GptpReader(ImportedDevice& device, Imported& imported, json::Diagnostics& diagnostics)
      : device_(device), imported_(imported), diagnostics_(diagnostics) {}

  void read(const Data& ptp, const Data& instances) {
    std::set<std::uint64_t> domains;
    for (const Data& instance : instances.children) {
      const Data* const defaults = instance.find("default-ds");
      const std::uint64_t domain = defaults == nullptr ? 0 : defaults->number("domain-number").value_or(0);
      if (defaults != nullptr && defaults->value("instance-enable") == "false") {
        imported_.remark(RemarkKind::ignored, instance.place, "an instance of gPTP that is not enabled");
        continue;
      }
      if (domain > 127) {
        error(instance.place, "a domain that gPTP does not have", std::to_string(domain), "0 to 127");
        continue;
      }
      if (!domains.insert(domain).second) {
        error(instance.place, "two instances of one domain", "domain " + std::to_string(domain) + " a second time",
              "a domain-number of its own for each instance");
        continue;
      }
      const scenario::GptpNode node = read_instance(instance, defaults);
      instances_.emplace(instance.number("instance-index").value_or(0),
                         Instance{domain, instance.find("ptp-instance-sync-ds")});
      if (domain == 0) {
        device_.gptp = node;
      } else {
        scenario::GptpDomain& made = device_.gptp_domains.emplace_back();
        made.domain = static_cast<std::uint8_t>(domain);
        made.nodes.emplace_back(device_.name, node);
      }
    }
    if (domains.empty()) return;
    if (!device_.gptp)
      error(instances.place, "no domain 0", "domain " + std::to_string(*domains.begin()) + " and none with number 0",
            "an instance of domain 0, which takt always has");
    device_.gptp_by_data_sets = true;
    device_.gptp_of_all = all_.value_or(scenario::Gptp{});
    const Data* const services = ptp.find("common-services");
    if (const Data* const standby = services == nullptr ? nullptr : services->find("hot-standby-service"))
      read_standby(*standby, *device_.gptp_of_all);
    if (!device_.gptp_of_all->hot_standby)
      for (const auto& [index, instance] : instances_)
        if (instance.sync != nullptr)
          imported_.remark(RemarkKind::ignored, instance.sync->place,
                           "when an instance is synced, without a hot standby that asks it");
    if (has_clock_) device_.clock = clock_;
  }

 private:
  void error(const json::Place& place, std::string message, std::string found, std::string expected) {
    diagnostics_.error(place, std::move(message), {std::move(found), std::move(expected)});
  }

  struct Instance {
    std::uint64_t domain = 0;
    const Data* sync = nullptr;  ///< ptp-instance-sync-ds
  };

  /// IEEE 802.1ASdm. takt's primary is domain 0, its secondary the first of the others.
  void read_standby(const Data& service, scenario::Gptp& all) {
    for (const Data& system : service.children) {
      const Data* const set = system.find("hot-standby-system-ds");
      if (set == nullptr || !set->is_true("hot-standby-system-enable")) {
        imported_.remark(RemarkKind::ignored, system.place, "a hot standby that is not enabled");
        continue;
      }
      if (all.hot_standby)
        return error(system.place, "a second hot standby", "two that are enabled", "one, as takt has it");
      const Instance* const primary = instance_of(*set, "primary-ptp-instance-index");
      const Instance* const secondary = instance_of(*set, "secondary-ptp-instance-index");
      if (primary == nullptr || secondary == nullptr) return;
      if (primary->domain != 0)
        return error(set->place, "a primary that is not domain 0", "domain " + std::to_string(primary->domain),
                     "domain 0");
      if (device_.gptp_domains.empty() || secondary->domain != device_.gptp_domains.front().domain)
        return error(set->place, "a secondary that is not the first of the other domains",
                     "domain " + std::to_string(secondary->domain),
                     device_.gptp_domains.empty() ? "a second instance"
                                                  : "domain " + std::to_string(device_.gptp_domains.front().domain));
      if (set->is_true("hot-standby-system-split-functionality"))
        return error(set->find("hot-standby-system-split-functionality")->place, "a function that takt does not have",
                     "hot-standby-system-split-functionality true", "false");
      all.hot_standby = true;
      scenario::StandbyThresholds thresholds = synced_of(primary->sync);
      if (!(thresholds == synced_of(secondary->sync)))
        return error(secondary->sync == nullptr ? set->place : secondary->sync->place,
                     "two domains that are synced by different thresholds",
                     "those of instance " + set->value("secondary-ptp-instance-index").value_or(""),
                     "the same, as takt has them");
      read_redundant(*set, thresholds);
      if (!(thresholds == scenario::StandbyThresholds())) all.standby_thresholds = thresholds;
    }
  }

  const Instance* instance_of(const Data& set, std::string_view leaf) {
    const auto index = set.number(leaf);
    const auto found = index ? instances_.find(*index) : instances_.end();
    if (found != instances_.end()) return &found->second;
    error(set.place, "an instance that is not there",
          std::string(leaf) + " " + (index ? std::to_string(*index) : "not said"),
          "the instance-index of one that is enabled");
    return nullptr;
  }

  scenario::StandbyThresholds synced_of(const Data* set) {
    scenario::StandbyThresholds thresholds;
    if (set == nullptr) return thresholds;
    if (const auto offset = set->signed_number("offset-from-time-transmitter-max")) {
      const auto duration = duration_of_time_interval(*offset);
      if (!duration || *duration < Duration())
        error(set->find("offset-from-time-transmitter-max")->place, "a threshold that takt does not have",
              std::to_string(*offset) + " (2^-16 ns)", "0 to an hour");
      else
        thresholds.offset_max = *duration;
    }
    const auto count = [&](std::string_view name, std::uint16_t& into) {
      const auto value = set->number(name);
      if (value && *value > 0xFFFF)
        error(set->find(name)->place, "a count that takt does not have", std::to_string(*value), "at most 65535");
      else if (value)
        into = static_cast<std::uint16_t>(*value);
    };
    count("rx-sync-count-time-receiver-p-thresh", thresholds.rx_sync_count);
    count("offset-max-exceeded-count-thresh", thresholds.offset_exceeded);
    count("offset-max-met-count-thresh", thresholds.offset_met);
    return thresholds;
  }

  void read_redundant(const Data& set, scenario::StandbyThresholds& thresholds) {
    if (const Data* const offset = set.find("primary-secondary-offset-thresh")) {
      const auto duration = duration_of_scaled_ns(offset->text);
      if (!duration || *duration < Duration())
        error(offset->place, "a threshold that takt does not have", json::quote(offset->text),
              "a ScaledNs from 0 to an hour, such as " + scaled_ns(Duration::from_ps(1'000'000)));
      else
        thresholds.primary_secondary_offset = *duration;
    }
    if (const auto exponent = set.signed_number("hot-standby-system-log-sync-time-thresh")) {
      const auto waiting = duration_of_log(*exponent);
      if (!waiting)
        error(set.find("hot-standby-system-log-sync-time-thresh")->place, "a waiting time that takt does not have",
              "2^" + std::to_string(*exponent) + " s", "-128, or 2^-12 s to 2^11 s");
      else
        thresholds.waiting_time = *waiting;
    }
  }

  scenario::GptpNode read_instance(const Data& instance, const Data* defaults) {
    scenario::GptpNode node;
    bool by_roles = false;
    if (defaults != nullptr) {
      if (const auto priority = defaults->number("priority1")) node.priority1 = static_cast<std::uint8_t>(*priority);
      node.priority2 = static_cast<std::uint8_t>(defaults->number("priority2").value_or(248));
      if (const Data* const quality = defaults->find("clock-quality")) {
        if (const auto name = quality->value("clock-class"))
          node.clock_class = number_of_identity("clock-class", *name).value_or(248);
        if (const auto name = quality->value("clock-accuracy"))
          node.clock_accuracy = number_of_identity("clock-accuracy", *name).value_or(0xFE);
      }
      if (defaults->is_true("time-receiver-only"))
        error(defaults->find("time-receiver-only")->place, "a way to be no grandmaster that gPTP does not have",
              "time-receiver-only true", "priority1 255");
      if (const auto type = defaults->value("instance-type"); type && *type != "oc" && *type != "bc")
        error(defaults->find("instance-type")->place, "a clock that gPTP does not have", json::quote(*type),
              "oc or bc");
      by_roles = defaults->is_true("external-port-config-enable");
    }
    if (const Data* const properties = instance.find("time-properties-ds")) node.time = time_of(*properties);
    const Data* const tracking = instance.find("drift-tracking-ds");
    const bool tracks = tracking != nullptr && tracking->is_true("drift-tracking-tlv-support");
    if (by_roles) node.roles.emplace();
    const Data* const ports = instance.find("ports");
    for (const Data& port : ports == nullptr ? std::vector<Data>() : ports->children) read_port(port, tracks, node);
    return node;
  }

  scenario::AnnouncedTime time_of(const Data& properties) {
    scenario::AnnouncedTime time;
    time.utc_offset = static_cast<std::int16_t>(properties.signed_number("current-utc-offset").value_or(37));
    time.utc_offset_valid = properties.is_true("current-utc-offset-valid");
    if (properties.is_true("leap59") && properties.is_true("leap61"))
      error(properties.place, "two leap seconds at once", "leap59 and leap61", "one of them");
    time.leap = properties.is_true("leap59")   ? scenario::LeapSecond::leap59
                : properties.is_true("leap61") ? scenario::LeapSecond::leap61
                                               : scenario::LeapSecond::none;
    time.time_traceable = properties.is_true("time-traceable");
    time.frequency_traceable = properties.is_true("frequency-traceable");
    if (const auto name = properties.value("time-source"))
      time.source = number_of_identity("time-source", *name).value_or(0xA0);
    if (properties.value("ptp-timescale") == "false")
      imported_.remark(RemarkKind::lost, properties.find("ptp-timescale")->place,
                       "an arbitrary timescale: takt announces that of PTP");
    return time;
  }

  void read_port(const Data& port, bool tracks, scenario::GptpNode& node) {
    const std::string interface = port.value("underlying-interface").value_or("");
    if (std::ranges::none_of(device_.ports, [&](const ImportedPort& each) { return each.interface == interface; }))
      error(port.place, "a port of no interface",
            interface.empty() ? "no underlying-interface" : json::quote(interface),
            "the name of an interface in the same file");
    if (node.roles) {
      const Data* const external = port.find("external-port-config-port-ds");
      const std::string state =
          external == nullptr ? "time-transmitter" : external->value("desired-state").value_or("time-transmitter");
      scenario::GptpPortRole role;
      role.to = interface;
      if (state == "time-receiver")
        role.role = scenario::GptpRole::time_receiver;
      else if (state == "passive")
        role.role = scenario::GptpRole::passive;
      else if (state == "disabled")
        role.role = scenario::GptpRole::disabled;
      else if (state != "time-transmitter")
        error(external->place, "a role that is set and no role", json::quote(state),
              "time-transmitter, time-receiver, passive or disabled");
      node.roles->push_back(std::move(role));
    }
    if (const Data* const correction = port.find("timestamp-correction-port-ds")) read_corrections(*correction);
    const Data* const set = port.find("port-ds");
    scenario::Gptp said = set == nullptr ? scenario::Gptp{} : set_of(*set, interface, node);
    said.drift_tracking = tracks;
    if (all_ && !(*all_ == said))
      error(port.place, "gPTP that is set differently at two ports",
            json::quote(interface) + " with other intervals, timeouts or thresholds",
            "the same for all ports and domains, as takt has it");
    all_ = said;
  }

  scenario::Gptp set_of(const Data& set, const std::string& interface, const scenario::GptpNode& node) {
    scenario::Gptp said;
    read_interval(set, "log-sync-interval", "initial-log-sync-interval", said.log_sync_interval);
    read_interval(set, "log-announce-interval", "initial-log-announce-interval", said.log_announce_interval);
    read_interval(set, "log-min-pdelay-req-interval", "initial-log-pdelay-req-interval", said.log_pdelay_interval);
    const bool is_capable = set.value("gptp-capable-state-machines-enabled") != "false";
    if (std::int8_t capable = 0;
        is_capable && read_interval(set, "initial-log-gptp-cap-interval", "initial-log-gptp-cap-interval", capable))
      said.log_gptp_capable_interval = capable;
    read_timeout(set, "sync-receipt-timeout", said.sync_receipt_timeout);
    read_timeout(set, "announce-receipt-timeout", said.announce_receipt_timeout);
    said.one_step = set.is_true("initial-one-step-tx-oper");
    if (const auto threshold = set.signed_number("mean-link-delay-thresh")) {
      const auto duration = duration_of_time_interval(*threshold);
      if (!duration || *duration < Duration() || *duration > Duration::from_ps(1'000'000'000'000))
        error(set.find("mean-link-delay-thresh")->place, "a threshold that takt does not have",
              std::to_string(*threshold) + " (2^-16 ns)", "0 to 1 s");
      else
        said.link_delay_threshold = *duration;
    }
    if (const auto mechanism = set.value("delay-mechanism");
        mechanism && *mechanism != "p2p" && *mechanism != "common-p2p")
      error(set.find("delay-mechanism")->place, "a way to measure delays that gPTP does not have on Ethernet",
            json::quote(*mechanism), "p2p or common-p2p");
    if (set.value("port-enable") == "false" && !node.roles)
      error(set.find("port-enable")->place, "a single port without gPTP", json::quote(interface),
            "port-enable true, or a desired-state of disabled");
    return said;
  }

  /// What management sets, or what the port begins with; true if one of them is said.
  bool read_interval(const Data& set, std::string_view managed, std::string_view initial, std::int8_t& interval) {
    const Data* const leaf = set.find(managed) != nullptr ? set.find(managed) : set.find(initial);
    if (leaf == nullptr) return false;
    const std::int64_t value = set.signed_number(leaf->schema->name).value_or(0);
    if (value < -7 || value > 4) {
      error(leaf->place, "an interval that takt does not have", "2^" + std::to_string(value) + " s", "2^-7 s to 2^4 s");
      return false;
    }
    if (const Data* const other = set.find(initial); other != nullptr && set.signed_number(initial) != value)
      imported_.remark(RemarkKind::lost, other->place,
                       std::string(initial) + " " + other->text + " beside " + std::string(managed) + " " + leaf->text +
                           ", which counts from the start");
    interval = static_cast<std::int8_t>(value);
    return true;
  }

  void read_timeout(const Data& set, std::string_view name, std::uint8_t& timeout) {
    const auto value = set.number(name);
    if (!value) return;
    if (*value < 2)
      return error(set.find(name)->place, "a timeout that takt does not have", std::to_string(*value) + " intervals",
                   "2 to 255");
    timeout = static_cast<std::uint8_t>(*value);
  }

  void read_corrections(const Data& set) {
    const auto read = [&](std::string_view name, std::optional<Duration>& into) {
      const auto interval = set.signed_number(name);
      if (!interval) return;
      const auto duration = duration_of_time_interval(*interval);
      if (!duration)
        return error(set.find(name)->place, "a latency beyond all reason", std::to_string(*interval) + " (2^-16 ns)",
                     "at most an hour");
      if (into && *into != *duration)
        imported_.remark(RemarkKind::lost, set.find(name)->place,
                         std::string(name) + " of one port alone: takt has it of the node");
      into = duration;
      has_clock_ = true;
    };
    read("egress-latency", clock_.tx_correction);
    read("ingress-latency", clock_.rx_correction);
  }

  ImportedDevice& device_;
  Imported& imported_;
  json::Diagnostics& diagnostics_;
  std::map<std::uint64_t, Instance> instances_;  // those that are enabled, by index
  std::optional<scenario::Gptp> all_;
  scenario::Clock clock_;
  bool has_clock_ = false;
};

}  // namespace

void read_gptp(const Data& root, ImportedDevice& device, Imported& imported, json::Diagnostics& diagnostics) {
  const Data* const ptp = root.find("ptp");
  const Data* const instances = ptp == nullptr ? nullptr : ptp->find("instances");
  if (instances == nullptr) return;
  if (device.gptp)
    return diagnostics.error(device.place, "gPTP of one device in two files",
                             {json::quote(device.name), "all of it in one file"});
  GptpReader(device, imported, diagnostics).read(*ptp, *instances);
}

}  // namespace takt::interchange::yang
