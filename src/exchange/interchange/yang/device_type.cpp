// SPDX-License-Identifier: Apache-2.0
#include "interchange/yang/device_type.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "interchange/yang/limits.hpp"
#include "interchange/yang/mau_types.hpp"
#include "interchange/yang/modules.hpp"

namespace takt::interchange::yang {
namespace {

using sim::DataRate;
using sim::Duration;

constexpr std::int64_t ps_in_ns = 1000;

Duration nanoseconds(std::uint64_t count) { return Duration::from_ps(static_cast<std::int64_t>(count) * ps_in_ns); }

std::vector<const Data*> children_of(const Data& parent, std::string_view module, std::string_view name) {
  std::vector<const Data*> found;
  for (const Data& child : parent.children)
    if (child.schema->name == name && child.schema->module == module) found.push_back(&child);
  return found;
}

class TypeReader {
 public:
  TypeReader(Imported& imported, json::Diagnostics& diagnostics) : imported_(imported), diagnostics_(diagnostics) {}

  std::optional<scenario::Device> read(const std::vector<const Data*>& files, const std::string& name) {
    device_.name = name;
    for (const Data* const file : files) {
      device_.source += (device_.source.empty() ? "what it announces by YANG: " : ", ") + file->place.file;
      if (const Data* const interfaces = file->find(if_m, "interfaces"))
        for (const Data& interface : interfaces->children) read_interface(interface);
      if (const Data* const bridges = file->find(dot1q_m, "bridges"))
        for (const Data& bridge : bridges->children)
          for (const Data& component : bridge.children)
            if (component.schema->name == "component") read_component(component);
    }
    take_delays();
    take_pools();
    if (ports_ > 0) device_.ports = ports_;
    for (const auto& [rate, place] : rates_) device_.rates.push_back(rate);
    return says_any_ ? std::optional(std::move(device_)) : std::nullopt;
  }

 private:
  void remark(RemarkKind kind, const json::Place& place, std::string text) {
    imported_.remark(kind, place, std::move(text));
  }

  /// The medium of a MAU type, or nothing with a remark, once for a type.
  std::optional<scenario::Medium> medium_of(const Data& entry, std::string_view leaf) {
    const std::int64_t number = entry.signed_number(leaf).value_or(0);
    const auto medium = medium_of_mau(number);
    if (!medium && strange_.insert(number).second)
      remark(RemarkKind::lost, entry.place,
             "what is said of MAU type " + std::to_string(number) + ", which is no full-duplex medium that takt knows");
    return medium;
  }

  void read_interface(const Data& interface) {
    if (const Data* const ethernet = interface.find(eth_m, "ethernet")) read_media(*ethernet);
    const Data* const port = interface.find(dot1q_m, "bridge-port");
    if (port == nullptr) return;
    ++ports_;
    read_classes(*port);
    read_algorithms(*port);
    if (const Data* const gates = port->find(sched_bridge_m, "gate-parameter-table")) read_gates(*gates);
    for (const Data* const pool : children_of(*port, iec_bridge_m, "supported-resource-pools")) read_pool(*pool);
    for (const Data* const phy : children_of(*port, iec_bridge_m, "phy-latencies")) read_phy(*phy);
  }

  void read_media(const Data& ethernet) {
    for (const Data* const mau : children_of(ethernet, iec_eth_m, "supported-mau-types")) {
      says_any_ = true;
      const auto medium = medium_of(*mau, "mau-type");
      if (medium) rates_.emplace(scenario::rate_of(*medium), mau->place);
      if (mau->find("preemption-supported") != nullptr)
        device_.features.preemption =
            device_.features.preemption.value_or(false) || mau->is_true("preemption-supported");
    }
  }

  void read_classes(const Data& port) {
    const Data* const tables = port.find(dot1q_m, "traffic-class");
    const Data* const table = tables == nullptr ? nullptr : tables->find("traffic-class-table");
    const auto count = table == nullptr ? std::nullopt : table->number("number-of-traffic-classes");
    if (!count) return;
    using scenario::TrafficClasses;
    const auto classes =
        *count == 8 ? TrafficClasses::standard
                    : static_cast<TrafficClasses>(static_cast<std::uint64_t>(TrafficClasses::one) + *count - 1);
    const auto expected = scenario::class_of_priorities(classes);
    for (std::size_t p = 0; p < 8; ++p)
      if (const auto said = table->number("priority" + std::to_string(p)); said && *said != expected[p]) {
        remark(RemarkKind::lost, table->place,
               "a map from priorities to " + std::to_string(*count) +
                   " classes that is not that of IEEE 802.1Q Table 8-5");
        break;
      }
    // Of ports with different numbers the least.
    if (!device_.traffic_classes || scenario::count_of(classes) < scenario::count_of(*device_.traffic_classes))
      device_.traffic_classes = classes;
    says_any_ = true;
  }

  void read_algorithms(const Data& port) {
    const auto lists = children_of(port, iec_bridge_m, "transmission-selection-algorithm");
    if (lists.empty()) return;
    says_any_ = true;
    const auto note = [](std::optional<bool>& feature, bool has) { feature = feature.value_or(false) || has; };
    bool credit = false, ats = false, ets = false;
    for (const Data* const list : lists)
      for (const Data* const entry : children_of(*list, iec_bridge_m, "algorithms")) {
        const std::string name = entry->value("algorithm").value_or("");
        credit = credit || name.ends_with(":credit-based-shaper");
        ats = ats || name.ends_with(":asynchronous-traffic-shaping");
        ets = ets || name.ends_with(":enhanced-transmission-selection");
      }
    note(device_.features.credit_based_shaper, credit);
    note(device_.features.ats, ats);
    note(device_.features.ets, ets);
  }

  /// Of ports with different limits the narrowest.
  void read_gates(const Data& gates) {
    const PortLimits limits = limits_of(gates);
    if (!limits.says_something()) return;
    says_any_ = true;
    if (limits.entries) device_.features.gates = device_.features.gates.value_or(false) || *limits.entries > 1;
    if (limits.entries && *limits.entries < 2) return;
    if (!device_.gate_limits) device_.gate_limits.emplace();
    scenario::GateLimits& all = *device_.gate_limits;
    if (limits.entries)
      all.entries =
          static_cast<std::uint32_t>(std::clamp<std::uint64_t>(*limits.entries, 2, all.entries.value_or(65'536)));
    if (limits.tick_tenths_of_ns && *limits.tick_tenths_of_ns >= 10)
      all.granularity = std::max(all.granularity.value_or(Duration()),
                                 Duration::from_ps(static_cast<std::int64_t>(*limits.tick_tenths_of_ns) * 100));
    for (const auto& [speed, shortest] : limits.shortest)
      if (shortest.interval_ns && *shortest.interval_ns > 0)
        all.least_interval = std::max(all.least_interval.value_or(Duration()), nanoseconds(*shortest.interval_ns));
  }

  void read_phy(const Data& phy) {
    says_any_ = true;
    const auto medium = medium_of(phy, "mau-type");
    if (!medium) return;
    scenario::DevicePhy made;
    made.medium = medium;
    made.transmit = made.receive = nanoseconds(phy.number("latency").value_or(0));
    made.variation = nanoseconds(phy.number("latency-variation").value_or(0));
    const auto same = std::ranges::find(device_.phys, made.medium, &scenario::DevicePhy::medium);
    if (same == device_.phys.end()) {
      device_.phys.push_back(made);
    } else if (!(*same == made)) {
      remark(RemarkKind::changed, phy.place,
             "other latencies than at another port with this medium: the greatest are taken for all");
      same->transmit = same->receive = std::max(same->transmit, made.transmit);
      same->variation = std::max(same->variation, made.variation);
    }
  }

  void read_pool(const Data& pool) {
    says_any_ = true;
    pools_.push_back(&pool);
  }

  void read_component(const Data& component) {
    if (component.find("frer-supported") != nullptr) {
      says_any_ = true;
      device_.features.frer = component.is_true("frer-supported");
    }
    if (const auto instances = component.number("max-ptp-instances")) {
      says_any_ = true;
      device_.features.gptp = *instances > 0;
    }
    for (const std::string_view name : {"independent-delays", "independent-delays-cascaded"})
      for (const Data* const delay : children_of(component, iec_bridge_m, name)) read_independent(*delay);
    for (const std::string_view name : {"dependent-delays", "dependent-delays-cascaded"})
      for (const Data* const delay : children_of(component, iec_bridge_m, name)) read_dependent(*delay);
    if (!children_of(component, iec_bridge_m, "independent-delays-cascaded").empty())
      remark(RemarkKind::changed, component.place,
             "delays between single ports: the least and the greatest of a pair of media count for all");
  }

  struct Interval {
    std::uint64_t least;
    std::uint64_t greatest;
    bool operator==(const Interval&) const = default;
    void take(const Interval& other) {
      least = std::min(least, other.least);
      greatest = std::max(greatest, other.greatest);
    }
  };
  using MediaPair = std::pair<scenario::Medium, scenario::Medium>;

  std::optional<Interval> interval_of(const Data& delay, const char* kind) {
    const std::string leaf = std::string(kind) + "-delay-";
    const auto least = delay.number(leaf + "min");
    const auto greatest = delay.number(leaf + "max");
    if (!least || !greatest) {
      diagnostics_.error(delay.place, "half of a delay", {"no " + leaf + (least ? "max" : "min"), "both"});
      return std::nullopt;
    }
    if (*least > *greatest) {
      diagnostics_.error(delay.place, "a delay whose least is more than its greatest",
                         {std::to_string(*least) + " to " + std::to_string(*greatest), "at least and at most"});
      return std::nullopt;
    }
    return Interval{*least, *greatest};
  }

  void read_independent(const Data& delay) {
    says_any_ = true;
    const auto in = medium_of(delay, "in-port-mau-type");
    const auto out = medium_of(delay, "out-port-mau-type");
    const auto interval = interval_of(delay, "independent");
    if (!in || !out || !interval) return;
    if (interval->greatest > 1'000'000'000) {
      diagnostics_.error(delay.place, "a delay that takt does not have",
                         {std::to_string(interval->greatest) + " ns", "at most 1 s"});
      return;
    }
    auto& classes = delays_[{*in, *out}];
    const auto traffic_class = static_cast<std::uint8_t>(delay.number("traffic-class").value_or(0));
    const auto [found, is_new] = classes.try_emplace(traffic_class, *interval);
    if (!is_new) found->second.take(*interval);
  }

  void read_dependent(const Data& delay) {
    says_any_ = true;
    const auto interval = interval_of(delay, "dependent");
    if (!interval) return;
    const std::uint64_t speed = delay.number("in-port-line-speed").value_or(0);
    const DataRate rate{speed * 1'000'000};
    if (speed == 0 || speed > 100'000) {
      diagnostics_.error(delay.place, "not a line speed", {std::to_string(speed) + " Mb/s", "10 to 100000"});
      return;
    }
    // IEEE 802.1Q 12.32.1.2 counts ps for each octet, the reception of a frame that is stored among them.
    const auto octet = static_cast<std::uint64_t>(rate.octet_time().ps());
    const auto beyond = [octet](std::uint64_t ps) { return ps > octet ? ps - octet : 0; };
    if (interval->least < octet) {
      device_.features.cut_through = true;
      remark(RemarkKind::changed, delay.place,
             "a delay for each octet below the " + std::to_string(octet) +
                 " ps of its reception: the device cuts through, which \"cut_through\" of \"egress\" says for a node");
    }
    const Interval more{beyond(interval->least), beyond(interval->greatest)};
    const auto [found, is_new] = per_octet_.try_emplace(rate, more);
    if (!is_new) found->second.take(more);
    if (more.greatest > 1'000'000)
      diagnostics_.error(delay.place, "a delay that takt does not have",
                         {std::to_string(more.greatest) + " ps for each octet", "at most 1 us"});
  }

  /// An entry for a pair of media, or one for each class where these differ.
  void take_delays() {
    for (const auto& [media, classes] : delays_) {
      const auto [in, out] = media;
      const Interval& first = classes.begin()->second;
      const bool are_alike = std::ranges::all_of(classes, [&](const auto& each) { return each.second == first; });
      for (const auto& [traffic_class, interval] : classes) {
        scenario::DeviceDelay made;
        made.from_medium = in;
        made.to_medium = out;
        if (!are_alike) made.traffic_class = traffic_class;
        made.least = nanoseconds(interval.least);
        made.greatest = nanoseconds(interval.greatest);
        if (const auto more = per_octet_.find(scenario::rate_of(in)); more != per_octet_.end()) {
          made.least_per_octet = Duration::from_ps(static_cast<std::int64_t>(more->second.least));
          made.greatest_per_octet = Duration::from_ps(static_cast<std::int64_t>(more->second.greatest));
        }
        device_.delays.push_back(made);
        if (are_alike) break;
      }
    }
    if (delays_.empty() && !per_octet_.empty())
      remark(RemarkKind::lost, {device_.name, 0, 0, ""}, "delays for each octet without independent ones");
  }

  /// What a pool covers at the fastest link is the room of its queue. One that several classes share is lost: no run
  /// has a queue of several classes.
  void take_pools() {
    std::map<std::uint8_t, std::uint64_t> room;
    for (const Data* const pool : pools_) {
      const auto classes = children_of(*pool, iec_bridge_m, "resource-pool-traffic-classes");
      const std::string name = json::quote(pool->value("resource-pool-name").value_or(""));
      const Data* const covered = pool->find("covered-time-interval");
      const auto time = covered == nullptr ? std::nullopt : seconds_of(*covered);
      if (classes.size() != 1) {
        remark(RemarkKind::lost, pool->place,
               "the pool " + name + ", which " + std::to_string(classes.size()) +
                   " classes share: queues of takt have room of their own");
        continue;
      }
      if (!time || *time <= Duration() || rates_.empty()) {
        remark(RemarkKind::lost, pool->place,
               "the pool " + name + ", whose size in octets follows from no time and rate");
        continue;
      }
      const Duration octet = rates_.rbegin()->first.octet_time();
      const auto octets = static_cast<std::uint64_t>(*time / octet);
      const auto traffic_class = static_cast<std::uint8_t>(classes.front()->number("traffic-class").value_or(0));
      const auto [found, is_new] = room.try_emplace(traffic_class, octets);
      if (!is_new) found->second = std::min(found->second, octets);
    }
    if (room.empty()) return;
    device_.queues.emplace();
    for (const auto& [traffic_class, octets] : room) {
      scenario::Queues::PerClass queue;
      queue.traffic_class = traffic_class;
      queue.octets = sim::Octets{static_cast<std::uint32_t>(std::clamp<std::uint64_t>(octets, 64, 0xFFFF'FFFF))};
      device_.queues->classes.push_back(queue);
    }
  }

  Imported& imported_;
  json::Diagnostics& diagnostics_;
  scenario::Device device_;
  std::uint32_t ports_ = 0;
  std::map<DataRate, json::Place> rates_;
  std::map<MediaPair, std::map<std::uint8_t, Interval>> delays_;  // ns, by class
  std::map<DataRate, Interval> per_octet_;                        // ps beyond reception
  std::vector<const Data*> pools_;
  std::set<std::int64_t> strange_;  // MAU types
  bool says_any_ = false;
};

/// Takes out what is as in a value without content.
void drop_defaults(json::Node& object, const json::Node& usual, std::initializer_list<std::string_view> keep = {}) {
  std::erase_if(object.members, [&](const json::Member& member) {
    const json::Node* const value = usual.find(member.key);
    return std::ranges::find(keep, member.key) == keep.end() && value != nullptr && json::equal(*value, member.value);
  });
}

}  // namespace

std::optional<scenario::Device> device_type_of(const std::vector<const Data*>& files, const std::string& name,
                                               Imported& imported, json::Diagnostics& diagnostics) {
  return TypeReader(imported, diagnostics).read(files, name);
}

std::string device_text(const scenario::Device& device) {
  json::Node node = json::encode_value(device);
  drop_defaults(node, json::encode_value(scenario::Device{}), {"name", "source"});
  if (json::Node* const delays = node.find("delays"))
    for (json::Node& each : delays->items)
      drop_defaults(each, json::encode_value(scenario::DeviceDelay{}), {"least", "greatest"});
  if (json::Node* const phys = node.find("phys"))
    for (json::Node& each : phys->items) drop_defaults(each, json::encode_value(scenario::DevicePhy{}));
  if (json::Node* const queues = node.find("queues")) drop_defaults(*queues, json::encode_value(scenario::Queues{}));
  return json::pretty(node);
}

}  // namespace takt::interchange::yang
