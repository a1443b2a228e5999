// SPDX-License-Identifier: Apache-2.0
#include "interchange/yang/policing_import.hpp"

#include <algorithm>
#include <set>

#include "interchange/gate_times.hpp"
#include "interchange/yang/limits.hpp"
#include "interchange/yang/modules.hpp"
#include "json/quantity.hpp"

namespace takt::interchange::yang {
namespace {

using sim::Duration;

class PolicingReader {
 public:
  PolicingReader(const Names& names, Imported& imported, json::Diagnostics& diagnostics)
      : names_(names), imported_(imported), diagnostics_(diagnostics) {}

  void read_identities(const Data& root, bool has_base) {
    const std::set<std::string> redundant = redundant_handles(root, has_base);
    const std::set<std::string> filtered = filtered_handles(root);
    for (const Data& entry : root.children) {
      if (entry.schema->name != "stream-identity") continue;
      const std::string handle = entry.value("handle").value_or("");
      if (!redundant.contains(handle) || filtered.contains(handle)) read_identity(entry);
    }
  }

  void read_component(const Data& component) {
    if (const Data* const streams = component.find("streams"))
      for (const Data& entry : streams->children) read_identity_2017(entry);
    if (const Data* const meters = component.find("flow-meters")) {
      std::size_t count = 0;
      for (const Data& entry : meters->children)
        if (entry.schema->type == Type::list) {
          read_meter(entry);
          ++count;
        }
      if (const auto most = meters->number("max-flow-meter-instances"); most && count > *most)
        error(meters->place, "more meters than the device has", std::to_string(count),
              "at most max-flow-meter-instances, " + std::to_string(*most));
    }
    for (const Data& child : component.children) {
      if (child.schema->name != "stream-gates") continue;
      const PortLimits limits = limits_of(child);
      for (const Data& entry : child.children)
        if (entry.schema->type == Type::list) read_gate(entry, limits);
    }
    for (const Data& child : component.children) {
      if (child.schema->name != "stream-filters") continue;
      std::vector<const Data*> filters;
      for (const Data& entry : child.children)
        if (entry.schema->type == Type::list) filters.push_back(&entry);
      std::ranges::stable_sort(filters, {},
                               [](const Data* each) { return each->number("stream-filter-instance-id").value_or(0); });
      for (const Data* const filter : filters) read_filter(*filter);
    }
  }

  scenario::Ingress ingress;
  bool has_something = false;

 private:
  void error(const json::Place& place, std::string message, std::string found, std::string expected) {
    diagnostics_.error(place, std::move(message), {std::move(found), std::move(expected)});
  }

  /// The handles that redundancy uses. takt has redundancy with its streams: a device's means nothing without them.
  std::set<std::string> redundant_handles(const Data& root, bool has_base) {
    std::set<std::string> handles;
    const Data* const frer = root.find("frer");
    if (frer == nullptr) return handles;
    if (!has_base)
      error(frer->place, "redundancy (802.1CB) of a device without its streams", "no network",
            "--into SCENARIO, whose streams are redundant");
    for (const Data& table : frer->children)
      for (const Data& leaf : table.children)
        if (leaf.schema->name == "stream" || leaf.schema->name == "input-id" || leaf.schema->name == "output-id")
          handles.insert(leaf.text);
    return handles;
  }

  /// The handles of stream filters, wherever they stand.
  static std::set<std::string> filtered_handles(const Data& data) {
    std::set<std::string> handles;
    if (const auto handle =
            data.schema->name == "stream-filter-instance-table" ? data.value("stream-handle") : std::nullopt)
      handles.insert(*handle);
    for (const Data& child : data.children) handles.merge(filtered_handles(child));
    return handles;
  }

  static scenario::TaggedFrames tagged_of(const std::optional<std::string>& text) {
    return text == "tagged"     ? scenario::TaggedFrames::tagged
           : text == "priority" ? scenario::TaggedFrames::priority
                                : scenario::TaggedFrames::all;
  }
  static std::string with_colons(std::string address) {
    std::ranges::transform(address, address.begin(), [](unsigned char c) {
      return c == '-' ? ':' : static_cast<char>(c >= 'A' && c <= 'F' ? c - 'A' + 'a' : c);
    });
    return address;
  }

  void add_null(std::uint64_t handle, const std::string& address, std::uint64_t vlan, scenario::TaggedFrames tagged,
                const json::Place& place) {
    const std::string usual = names_.stream(with_colons(address)).value_or(std::to_string(handle));
    const bool is_taken = std::ranges::any_of(
        ingress.streams, [&](const scenario::IdentifiedStream& each) { return each.name == usual; });
    const std::string name = is_taken && !handles_.contains(handle) ? usual + "-" + std::to_string(handle)
                             : handles_.contains(handle)            ? handles_[handle]
                                                                    : usual;
    handles_[handle] = name;
    ingress.streams.push_back(
        identity_of(name, with_colons(address), static_cast<std::uint16_t>(vlan), tagged, names_, place, imported_));
    has_something = true;
  }
  void add_source(std::uint64_t handle, const std::string& address, std::uint64_t vlan, scenario::TaggedFrames tagged,
                  const json::Place& place) {
    const auto node = names_.node(with_colons(address));
    if (!node)
      return error(place, "an address of no node", json::quote(address),
                   "one of the table of names (" + std::string(names_file) + ")");
    scenario::IdentifiedStream stream;
    stream.name = handles_.contains(handle) ? handles_[handle] : std::to_string(handle);
    handles_[handle] = stream.name;
    stream.source = scenario::SourceIdentity{{}, *node, static_cast<std::uint16_t>(vlan), tagged};
    ingress.streams.push_back(std::move(stream));
    has_something = true;
  }

  void read_identity(const Data& entry) {
    const std::uint64_t handle = entry.number("handle").value_or(0);
    if (const Data* const null = entry.find("null-stream-identification"))
      add_null(handle, null->value("destination-mac").value_or("00-00-00-00-00-00"), null->number("vlan").value_or(0),
               tagged_of(null->value("tagged")), entry.place);
    else if (const Data* const source = entry.find("smac-vlan-stream-identification"))
      add_source(handle, source->value("source-mac").value_or(""), source->number("vlan").value_or(0),
                 tagged_of(source->value("tagged")), entry.place);
    else
      error(entry.place, "an identification that takt does not have", "handle " + std::to_string(handle),
            "null or source MAC and VLAN");
  }

  void read_identity_2017(const Data& entry) {
    if (!entry.is_true("stream-id-enabled"))
      return imported_.remark(RemarkKind::ignored, entry.place, "a stream identity that is not enabled");
    const std::uint64_t handle = entry.number("stream-handle").value_or(0);
    const Data* const parameters = entry.find("parameters");
    const Data* const null = parameters == nullptr ? nullptr : parameters->find("null-stream-identification-params");
    const Data* const source =
        parameters == nullptr ? nullptr : parameters->find("source-mac-and-vlan-identification-params");
    if (null != nullptr)
      add_null(handle, null->value("dest-address").value_or("00-00-00-00-00-00"), null->number("vlan-id").value_or(0),
               tagged_of(null->value("vlan-tagged")), entry.place);
    else if (source != nullptr)
      add_source(handle, source->value("source-address").value_or(""), source->number("vlan-id").value_or(0),
                 tagged_of(source->value("vlan-tagged")), entry.place);
    else
      error(entry.place, "an identification that takt does not have", "handle " + std::to_string(handle),
            "null or source MAC and VLAN");
  }

  void read_meter(const Data& entry) {
    scenario::Meter meter;
    meter.name = entry.value("flow-meter-instance-id").value_or("");
    meter.cir = sim::DataRate{entry.number("committed-information-rate").value_or(0)};
    meter.cbs = sim::Octets{static_cast<std::uint32_t>(entry.number("committed-burst-size").value_or(0))};
    meter.eir = sim::DataRate{entry.number("excess-information-rate").value_or(0)};
    meter.ebs = sim::Octets{static_cast<std::uint32_t>(entry.number("excess-burst-size").value_or(0))};
    meter.coupling = entry.value("coupling-flag") == "one";
    meter.color_aware = entry.value("color-mode") == "color-aware";
    meter.drop_on_yellow = entry.is_true("drop-on-yellow");
    meter.block_red = entry.is_true("mark-all-frames-red-enable");
    ingress.meters.push_back(std::move(meter));
    has_something = true;
  }

  static std::optional<std::uint8_t> ipv_of(const std::optional<std::string>& word) {
    const auto digit = word ? word_digit(*word) : std::nullopt;
    return digit ? std::optional(static_cast<std::uint8_t>(*digit)) : std::nullopt;
  }

  void read_gate(const Data& entry, const PortLimits& limits) {
    scenario::StreamGateEntryList gate;
    gate.name = entry.value("stream-gate-instance-id").value_or("");
    gate.open = entry.value("admin-gate-states") != "closed";
    gate.ipv = ipv_of(entry.value("admin-ipv"));
    gate.block_invalid_rx = entry.is_true("gate-closed-due-to-invalid-rx-enable");
    gate.block_octets_exceeded = entry.is_true("gate-closed-due-octets-exceeded-enable");
    if (entry.is_true("gate-enable"))
      read_gate_list(entry, limits, gate);
    else
      gate.open = true;  // a gate that is not enabled lets all pass
    gate_ids_.push_back(gate.name);
    gate_numbers_[gate.name] = ingress.gates.size();
    ingress.gates.push_back(std::move(gate));
    has_something = true;
  }

  void read_gate_list(const Data& entry, const PortLimits& limits, scenario::StreamGateEntryList& gate) {
    std::vector<const Data*> lines;
    for (const Data& child : entry.children) {
      if (child.schema->name != "admin-control-list") continue;
      if (child.schema->type == Type::list)
        lines.push_back(&child);
      else
        for (const Data& line : child.children) lines.push_back(&line);
    }
    if (lines.empty()) return;
    std::ranges::stable_sort(lines, {}, [](const Data* line) { return line->number("index").value_or(0); });
    if (limits.entries && lines.size() > *limits.entries)
      error(entry.place, "a gate list that is longer than the device takes", std::to_string(lines.size()) + " entries",
            "at most supported-list-max, " + std::to_string(*limits.entries));
    Duration sum;
    for (const Data* const line : lines) {
      const Data* const parameters = line->find("parameters");
      const Data& from = parameters == nullptr ? *line : *parameters;
      const auto interval = from.number("time-interval-value");
      if (!interval || *interval == 0) {
        error(line->place, "an entry without an interval", interval ? "0 ns" : "no time-interval-value",
              "ns, at least 1");
        continue;
      }
      if (limits.longest_interval_ns && *interval > *limits.longest_interval_ns)
        error(line->place, "an interval that is longer than the device takes", std::to_string(*interval) + " ns",
              "at most supported-interval-max, " + std::to_string(*limits.longest_interval_ns));
      scenario::StreamGateStep step;
      step.open = from.value("gate-state-value") == "open";
      step.ipv = ipv_of(from.value("ipv-spec") ? from.value("ipv-spec") : from.value("ipv-value"));
      step.interval = Duration::from_ps(static_cast<std::int64_t>(*interval) * 1000);
      if (const auto octets = from.number("interval-octet-max"))
        step.octets = sim::Octets{static_cast<std::uint32_t>(*octets)};
      sum += step.interval;
      gate.entries.push_back(step);
    }
    const Data* const cycle = entry.find("admin-cycle-time");
    if (cycle != nullptr && cycle->number("numerator").value_or(0) != 0) {
      const auto length = seconds_of(*cycle);
      if (!length || length->ps() % 1000 != 0 || *length > Duration::from_ps(3'600'000'000'000'000))
        return error(cycle->place, "a cycle that takt does not have",
                     cycle->value("numerator").value_or("") + "/" + cycle->value("denominator").value_or("") + " s",
                     "a whole number of ns, at most an hour");
      gate.cycle = length;
      if (*length < sum)
        imported_.remark(
            RemarkKind::odd, cycle->place,
            "entries of " + json::to_text(sum) + " in a cycle of " + json::to_text(*length) + ": the end is cut off");
    }
    gate.extension =
        Duration::from_ps(static_cast<std::int64_t>(entry.number("admin-cycle-time-extension").value_or(0)) * 1000);
    if (const Data* const base = entry.find("admin-base-time")) {
      const std::uint64_t fraction = base->number("nanoseconds").value_or(0),
                          seconds = base->number("seconds").value_or(0);
      if (fraction >= 1'000'000'000 || seconds > 1'000'000'000'000ULL)
        return error(base->place, "not a base time",
                     std::to_string(seconds) + " s + " + std::to_string(fraction) + " ns",
                     "less than 10^9 ns, and seconds below 10^12");
      const FoldedTime folded =
          fold_base_time(static_cast<sim::int128>(seconds) * 1'000'000'000 + static_cast<sim::int128>(fraction),
                         gate.cycle.value_or(sum));
      if (folded.is_folded)
        imported_.remark(RemarkKind::changed, base->place,
                         "a base time of a running clock, folded into the cycle: " + json::to_text(folded.base));
      gate.base_time = folded.base;
    }
  }

  /// A gate that never closes and changes nothing is what takt has without a gate.
  bool is_nothing(const std::string& gate) const {
    const auto found = std::ranges::find(ingress.gates, gate, &scenario::StreamGateEntryList::name);
    return found != ingress.gates.end() && found->open && !found->ipv && found->entries.empty();
  }

  void read_filter(const Data& entry) {
    scenario::StreamFilterEntry filter;
    if (const auto handle = entry.number("stream-handle")) {
      if (handles_.contains(*handle))
        filter.stream = handles_[*handle];
      else
        error(entry.place, "a stream that nothing identifies", "handle " + std::to_string(*handle),
              "a handle of a stream identity");
    }
    const auto priority = entry.value("priority-spec");
    filter.pcp = ipv_of(priority);
    std::uint64_t largest = entry.number("max-sdu-size").value_or(0);
    bool blocks = entry.is_true("stream-blocked-due-to-oversize-frame-enabled");
    auto meter = entry.number("flow-meter-ref");
    for (const Data& child : entry.children) {
      if (child.schema->name != "filter-specification-list") continue;  // 2018
      largest = child.number("maximum-sdu-size").value_or(largest);
      blocks = blocks || child.is_true("stream-blocked-due-to-oversize-frame-enabled");
      if (const auto found = child.number("flow-meter-ref")) meter = found;
    }
    if (largest > 1500)
      imported_.remark(RemarkKind::ignored, entry.place,
                       "a largest SDU of " + std::to_string(largest) + " octets: takt's frames have at most 1500");
    else if (largest != 0)
      filter.max_sdu = sim::Octets{static_cast<std::uint32_t>(largest)};
    filter.block_oversize = blocks;
    const std::string gate = entry.value("stream-gate-ref").value_or("");
    if (std::ranges::find(gate_ids_, gate) == gate_ids_.end())
      error(entry.place, "a stream gate that is not there", "stream-gate-ref " + gate,
            "the id of a stream gate in the same file");
    else if (!is_nothing(gate))
      filter.gate = gate;
    if (meter) {
      const std::string name = std::to_string(*meter);
      const bool is_enabled = entry.find("flow-meter-enable") == nullptr || entry.is_true("flow-meter-enable");
      if (std::ranges::find(ingress.meters, name, &scenario::Meter::name) == ingress.meters.end())
        error(entry.place, "a meter that is not there", "flow-meter-ref " + name,
              "the id of a flow meter in the same file");
      else if (is_enabled)
        filter.meter = name;
    }
    read_scheduler(entry, filter);
    ingress.filters.push_back(std::move(filter));
    has_something = true;
  }

  void read_scheduler(const Data& entry, scenario::StreamFilterEntry& filter) {
    if (const Data* const groups = entry.find("scheduler-groups"))
      for (const Data& group : groups->children) {
        scenario::AtsGroupEntry made;
        made.name = group.value("scheduler-group-instance-id").value_or("");
        const std::uint64_t longest = group.number("max-residence-time").value_or(0);
        if (longest != 0xFFFF'FFFF)
          made.max_residence_time = Duration::from_ps(static_cast<std::int64_t>(longest) * 1000);
        if (std::ranges::find(ingress.ats_groups, made.name, &scenario::AtsGroupEntry::name) ==
            ingress.ats_groups.end())
          ingress.ats_groups.push_back(std::move(made));
      }
    if (const Data* const schedulers = entry.find("schedulers"))
      for (const Data& scheduler : schedulers->children) {
        scenario::AtsEntry made;
        made.name = scheduler.value("scheduler-instance-id").value_or("");
        made.rate = sim::DataRate{scheduler.number("committed-information-rate").value_or(0)};
        const std::uint64_t bits = scheduler.number("committed-burst-size").value_or(0);
        if (bits % 8 != 0)
          error(scheduler.place, "a burst that is no whole number of octets", std::to_string(bits) + " bits",
                "a multiple of 8 bits");
        made.burst = sim::Octets{static_cast<std::uint32_t>(bits / 8)};
        made.group = scheduler.value("scheduler-group-ref");
        if (std::ranges::find(ingress.ats, made.name, &scenario::AtsEntry::name) == ingress.ats.end())
          ingress.ats.push_back(std::move(made));
      }
    const Data* const use = entry.find("scheduler");
    if (use == nullptr || !use->is_true("scheduler-enable")) return;
    const std::string name = use->value("scheduler-ref").value_or("");
    if (std::ranges::find(ingress.ats, name, &scenario::AtsEntry::name) == ingress.ats.end())
      error(use->place, "a scheduler that is not there", "scheduler-ref " + json::quote(name), "the id of a scheduler");
    else
      filter.ats = name;
  }

  const Names& names_;
  Imported& imported_;
  json::Diagnostics& diagnostics_;
  std::map<std::uint64_t, std::string> handles_;
  std::vector<std::string> gate_ids_;
  std::map<std::string, std::size_t> gate_numbers_;
};

}  // namespace

void read_policing(const Data& root, const Names& names, bool has_base, ImportedDevice& device, Imported& imported,
                   json::Diagnostics& diagnostics) {
  PolicingReader reader(names, imported, diagnostics);
  reader.read_identities(root, has_base);
  if (const Data* const bridges = root.find("bridges"))
    for (const Data& bridge : bridges->children)
      for (const Data& component : bridge.children)
        if (component.schema->name == "component") reader.read_component(component);
  if (!reader.has_something) return;
  // A gate that is open for ever is what takt has without one.
  std::erase_if(reader.ingress.gates, [](const scenario::StreamGateEntryList& gate) {
    return gate.open && !gate.ipv && gate.entries.empty();
  });
  if (device.ingress)
    diagnostics.error(device.place, "policing of one device in two files",
                      {json::quote(device.name), "all of it in one file"});
  device.ingress = std::move(reader.ingress);
}

}  // namespace takt::interchange::yang
