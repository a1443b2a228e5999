// SPDX-License-Identifier: Apache-2.0
#include "interchange/yang/redundancy_import.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "json/fields.hpp"

namespace takt::interchange::yang {
namespace {

/// What all tables together say of one stream.
struct Told {
  explicit Told(json::Place where) : place(std::move(where)) {}
  json::Place place;
  std::set<std::string> numbers, splits, merges, encodes;  ///< devices; `encodes`: where the stream itself gets its tag
  std::vector<std::uint16_t> vlans;                        ///< of the members, where it is split
  std::uint16_t vlan = 0;                                  ///< its own there
  std::optional<scenario::Redundancy> recovery;            ///< what its recoveries are set to
  bool individual = false;
};

/// Who a handle of a device is: a stream by its own address, or a member, which has one of its own on the wire.
struct Identity {
  std::string address;  ///< of the stream
  std::uint16_t vlan = 0, member_vlan = 0;
  bool is_member = false;
};

sim::Duration milliseconds(const Data& data, std::string_view name, sim::Duration fallback) {
  const auto said = data.number(name);
  return said ? sim::Duration::from_ps(static_cast<std::int64_t>(*said) * 1'000'000'000) : fallback;
}

class RedundancyReader {
 public:
  RedundancyReader(const Names& names, scenario::Scenario& scenario, Imported& imported, json::Diagnostics& diagnostics)
      : names_(names), scenario_(scenario), imported_(imported), diagnostics_(diagnostics) {}

  void read(const std::string& device, const Data& root) {
    const Data* const frer = root.find("frer");
    if (frer == nullptr) return;
    device_ = device;
    read_identities(root);
    for (const Data& entry : frer->children) {
      const std::string_view table = entry.schema->name;
      if (table == "sequence-generation")
        read_generation(entry);
      else if (table == "stream-split")
        read_split(entry);
      else if (table == "sequence-recovery")
        read_recovery(entry);
      else if (table == "sequence-identification")
        read_identification(entry);
    }
  }

  void finish() {
    for (auto& [name, told] : told_) give(name, told);
  }

 private:
  void error(const json::Place& place, std::string message, std::string found, std::string expected) {
    diagnostics_.error(place, std::move(message), {std::move(found), std::move(expected)});
  }

  static std::string address_of(const Data& data) {
    std::string address = data.value("destination-mac").value_or("");
    std::ranges::transform(address, address.begin(), [](char c) {
      return c == '-' ? ':' : c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return address;
  }
  static std::uint16_t vlan_of(const Data& data) { return static_cast<std::uint16_t>(data.number("vlan").value_or(0)); }

  void read_identities(const Data& root) {
    identities_.clear();
    for (const Data& entry : root.children) {
      if (entry.schema->name != "stream-identity") continue;
      const std::string handle = entry.value("handle").value_or("");
      if (const Data* const null = entry.find("null-stream-identification"))
        identities_.try_emplace(handle, Identity{address_of(*null), vlan_of(*null), 0, false});
      const Data* const member = entry.find("dmac-vlan-stream-identification");
      const Data* const down = member == nullptr ? nullptr : member->find("down");
      const Data* const up = member == nullptr ? nullptr : member->find("up");
      if (down != nullptr && up != nullptr)
        identities_.insert_or_assign(handle, Identity{address_of(*up), vlan_of(*up), vlan_of(*down), true});
    }
  }

  const Identity* identity(const std::string& handle, const json::Place& place) {
    const auto found = identities_.find(handle);
    if (found != identities_.end()) return &found->second;
    error(place, "a stream that nothing identifies", "handle " + handle,
          "a handle of a stream identity with a destination address");
    return nullptr;
  }

  /// The stream that an entry's handles belong to; null, and told, if they are not of one stream of the scenario.
  Told* stream_of(const Data& entry, std::string_view leaf) {
    std::optional<std::string> address;
    for (const Data& each : entry.children) {
      if (each.schema->name != leaf) continue;
      const Identity* const who = identity(each.text, each.place);
      if (who == nullptr) return nullptr;
      if (address && *address != who->address)
        return error(each.place, "members of two streams in one entry", who->address, *address), nullptr;
      address = who->address;
    }
    if (!address)
      return error(entry.place, "an entry without a stream", "no " + std::string(leaf), "handles of stream identities"),
             nullptr;
    const auto name = names_.stream(*address);
    if (!name)
      return error(entry.place, "an address of no stream", json::quote(*address),
                   "one of the table of names (" + std::string(names_file) + ")"),
             nullptr;
    if (std::ranges::find(scenario_.streams, *name, &scenario::Stream::name) == scenario_.streams.end())
      return error(entry.place, "redundancy of a stream that the base has not", json::quote(*name),
                   "--into SCENARIO, which has it"),
             nullptr;
    return &told_.try_emplace(*name, entry.place).first->second;
  }

  void read_generation(const Data& entry) {
    if (Told* const told = stream_of(entry, "stream")) told->numbers.insert(device_);
  }

  void read_split(const Data& entry) {
    Told* const told = stream_of(entry, "input-id");
    if (told == nullptr || stream_of(entry, "output-id") != told) return;
    told->splits.insert(device_);
    told->vlans.clear();
    for (const Data& each : entry.children) {
      if (each.schema->name == "input-id") told->vlan = identities_.at(each.text).vlan;
      if (each.schema->name != "output-id") continue;
      const Identity& member = identities_.at(each.text);
      if (!member.is_member)
        return error(each.place, "a copy without an address of its own", "handle " + each.text,
                     "a dmac-vlan-stream-identification, down and up");
      told->vlans.push_back(member.member_vlan);
    }
  }

  void read_recovery(const Data& entry) {
    Told* const told = stream_of(entry, "stream");
    if (told == nullptr) return;
    scenario::Redundancy said;
    const Data* const algorithm = entry.find("algorithm");
    said.algorithm = algorithm != nullptr && algorithm->find("match") != nullptr ? scenario::Recovery::match
                                                                                 : scenario::Recovery::vector;
    said.history = static_cast<std::uint32_t>(entry.number("history-length").value_or(said.history));
    said.reset_timeout = milliseconds(entry, "reset-timeout", said.reset_timeout);
    said.take_untagged = entry.is_true("take-no-sequence");
    const bool is_individual = entry.is_true("individual-recovery");
    const bool is_first_of_all = !is_individual && told->merges.empty();
    if (is_individual)
      told->individual = true;
    else
      told->merges.insert(device_);
    if (!is_individual && entry.is_true("latent-error-detection")) read_latent_errors(entry, said);
    if (told->recovery && is_individual)
      said.latent_errors = told->recovery->latent_errors;  // is said of the recovery of all copies
    if (told->recovery && is_first_of_all) told->recovery->latent_errors = said.latent_errors;
    if (told->recovery && !(*told->recovery == said))
      error(entry.place, "recoveries of one stream that differ", "another algorithm, history or time-out",
            "the same at all places: takt has them once");
    told->recovery = said;
  }

  void read_latent_errors(const Data& entry, scenario::Redundancy& said) {
    scenario::LatentErrors& errors = said.latent_errors.emplace();
    const Data* const parameters = entry.find("latent-error-detection-parameters");
    if (parameters == nullptr) return;
    const std::int64_t difference = parameters->signed_number("difference").value_or(0);
    if (difference < 0)
      error(parameters->place, "a difference of latent errors below nothing", std::to_string(difference), "at least 0");
    else
      errors.difference = static_cast<std::uint64_t>(difference);
    errors.period = milliseconds(*parameters, "period", errors.period);
    errors.reset_period = milliseconds(*parameters, "reset-period", errors.reset_period);
  }

  void read_identification(const Data& entry) {
    if (const Data* const how = entry.find("encapsulation"); how != nullptr && how->find("r-tag") == nullptr)
      return error(entry.place, "an encapsulation that takt does not have", "no r-tag", "\"r-tag\"");
    if (!entry.is_true("active")) return;
    for (const Data& each : entry.children) {
      if (each.schema->name != "stream") continue;
      const auto found = identities_.find(each.text);
      if (found == identities_.end() || found->second.is_member) continue;
      if (const auto name = names_.stream(found->second.address))
        told_.try_emplace(*name, entry.place).first->second.encodes.insert(device_);
    }
  }

  /// One of them, or nothing and an error where it must be one.
  const std::string* only(const std::set<std::string>& devices, const Told& told, const std::string& stream,
                          const char* what) {
    if (devices.size() == 1) return &*devices.begin();
    if (devices.empty())
      error(told.place, "redundancy that is " + std::string(what) + " nowhere: stream " + json::quote(stream),
            "no device that does", "the files of all devices that take part");
    else
      error(told.place, "redundancy that is " + std::string(what) + " at two places: stream " + json::quote(stream),
            *devices.begin() + " and " + *std::next(devices.begin()), "one: takt has ladders by their ways only");
    return nullptr;
  }

  void give(const std::string& name, const Told& told) {
    const auto found = std::ranges::find(scenario_.streams, name, &scenario::Stream::name);
    if (found == scenario_.streams.end()) return;
    scenario::Stream& stream = *found;
    const std::string* const split = only(told.splits, told, name, "split");
    if (told.merges.empty() || !told.recovery) only(told.merges, told, name, "recovered");
    if (split == nullptr || told.merges.empty() || !told.recovery) return;
    if (stream.redundancy && stream.redundancy->ladder)
      return error(told.place, "redundancy of two places for a stream whose base has a ladder", json::quote(name),
                   "a base without it");
    scenario::Redundancy made = *told.recovery;
    const auto members = static_cast<std::uint32_t>(told.vlans.size());
    if (stream.redundancy && stream.redundancy->paths)
      made.paths = stream.redundancy->paths;
    else
      made.count = members;
    if (made.paths && made.paths->size() != members)
      error(told.place, "another number of copies than the base has ways: stream " + json::quote(name),
            std::to_string(members), std::to_string(made.paths->size()));
    if (!made.paths)
      imported_.remark(RemarkKind::changed, told.place,
                       "the ways of the " + std::to_string(members) + " copies of stream " + name +
                           ", which the tables do not say: takt chooses them");
    if (std::ranges::any_of(told.vlans, [&](std::uint16_t each) { return each != told.vlan; })) made.vlans = told.vlans;
    made.split = *split;
    if (!told.numbers.empty())
      if (const std::string* const number = only(told.numbers, told, name, "numbered");
          number != nullptr && *number != *split)
        made.number = *number;
    const bool by_all =
        told.merges.size() > 1 && told.merges == std::set<std::string>(stream.to.names.begin(), stream.to.names.end());
    if (!by_all)
      if (const std::string* const merge = only(told.merges, told, name, "recovered")) made.merge = *merge;
    made.individual = told.individual;
    made.keep_tag =
        std::ranges::any_of(told.encodes, [&](const std::string& each) { return told.merges.contains(each); });
    stream.redundancy = std::move(made);
  }

  const Names& names_;
  scenario::Scenario& scenario_;
  Imported& imported_;
  json::Diagnostics& diagnostics_;
  std::string device_;
  std::map<std::string, Identity> identities_;  // of the device, by handle
  std::map<std::string, Told> told_;            // by stream
};

}  // namespace

void read_redundancy(const DeviceData& devices, const Names& names, scenario::Scenario& scenario, Imported& imported,
                     json::Diagnostics& diagnostics) {
  RedundancyReader reader(names, scenario, imported, diagnostics);
  for (const auto& [device, data] : devices) reader.read(device, *data);
  if (!diagnostics.has_errors()) reader.finish();
}

}  // namespace takt::interchange::yang
