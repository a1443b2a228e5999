// SPDX-License-Identifier: Apache-2.0
// Where streams are numbered, split and made one again (802.1CB 10), as the tables of a device. In takt a relay
// recovers a stream once, as it comes in; the tables place a recovery at each port by which the stream leaves, where it
// sees the same frames.
#include <algorithm>
#include <map>
#include <set>

#include "interchange/yang/modules.hpp"
#include "interchange/yang/policing_export.hpp"

namespace takt::interchange::yang {
namespace {

class RedundancyWriter {
 public:
  RedundancyWriter(Data& root, const scenario::Resolved& resolved, const Device& device, Exported& exported)
      : root_(root), r_(resolved), device_(device), exported_(exported) {
    if (device.ingress != nullptr) handles_ = device.ingress->streams;
    for (const Data& child : root.children)
      if (child.schema->name == "stream-identity") {
        ++identities_;
        identified_.insert(child.value("handle").value_or(""));
      }
  }

  void write(const scenario::ResolvedRedundancy& redundancy) {
    redundancy_ = &redundancy;
    stream_ = &r_.plan.streams[redundancy.stream.value];
    const bool numbers = redundancy.number == device_.node, splits = redundancy.split == device_.node,
               merges = is_merge();
    if (redundancy.is_ladder()) {
      if (numbers || redundancy.relay_at(device_.node) != nullptr)
        lose("a ladder, which recovers and splits in one node");
      return;
    }
    if (!numbers && !splits && !merges) return;
    find_ports();
    if (numbers) {
      Data& entry = frer().add("sequence-generation");
      entry.set("index", std::to_string(++generations_));
      entry.add("stream").text = compound();
      entry.set("direction-out-facing", "true");
      identify_source();
      if (!splits) encode(compound(), after_);
    }
    if (splits) write_split();
    if (merges) write_merge();
  }

  void finish() {
    for (const auto& [port, coded] : coded_) {
      Data& entry = frer().add("sequence-identification");
      entry.set("port", port);
      entry.set("direction-out-facing", "true");
      for (const std::string& handle : coded.handles) entry.add("stream").text = handle;
      entry.set("active", coded.encodes ? "true" : "false");
      entry.make("encapsulation").make("r-tag");
    }
  }

 private:
  struct Coded {
    std::set<std::string> handles;
    bool encodes = false;
  };

  void lose(std::string what) {
    exported_.lose(device_.name, "redundancy (802.1CB) of stream " + stream_->name + ": " + std::move(what));
  }
  Data& frer() { return root_.make("frer"); }

  bool is_merge() const {
    if (redundancy_->merges_in_host)
      return std::ranges::any_of(stream_->listeners,
                                 [&](models::NodeIndex each) { return each.value == device_.node; });
    return redundancy_->merge == device_.node;
  }

  std::string port_to(std::uint32_t peer) const {
    const auto found = std::ranges::find(device_.ports, peer, &DevicePort::peer);
    return found == device_.ports.end() ? std::string() : found->interface;
  }

  /// By which ports the paths come and go, each member's and all together.
  void find_ports() {
    before_.clear();
    after_.clear();
    member_before_.assign(redundancy_->members.size(), {});
    member_after_.assign(redundancy_->members.size(), {});
    const auto& paths = r_.streams[redundancy_->stream.value].paths;
    for (std::size_t p = 0; p < paths.size(); ++p) {
      const std::size_t member = p % redundancy_->members.size();
      const auto at = std::ranges::find(paths[p], device_.node);
      if (at == paths[p].end()) continue;
      if (at != paths[p].begin()) {
        const std::string port = port_to(*std::prev(at));
        before_.insert(port);
        member_before_[member].insert(port);
      }
      if (std::next(at) != paths[p].end()) {
        const std::string port = port_to(*std::next(at));
        after_.insert(port);
        member_after_[member].insert(port);
      }
    }
  }

  std::string compound() {
    const auto found = std::ranges::find(handles_, stream_->name);
    if (found != handles_.end()) return std::to_string(found - handles_.begin() + 1);
    handles_.push_back(stream_->name);
    return std::to_string(handles_.size());
  }
  /// Beyond those of streams.
  std::string member_handle(std::size_t member) {
    return std::to_string(1'000'000 + 64 * redundancy_->stream.value + member);
  }

  Data& new_identity(const std::string& handle, std::string_view side, const std::set<std::string>& ports,
                     std::string_view facing_where = "out-facing") {
    Data& identity = root_.add("stream-identity");
    identity.set("index", std::to_string(++identities_));
    identity.set("handle", handle);
    Data& facing = identity.make(facing_where);
    for (const std::string& port : ports) facing.add(side).text = port;
    return identity;
  }

  /// The stream itself, if nothing has identified it yet.
  void identify(const std::string& handle, std::string_view side, const std::set<std::string>& ports,
                std::string_view facing = "out-facing") {
    if (!identified_.insert(handle).second) return;
    Data& function = new_identity(handle, side, ports, facing).make("null-stream-identification");
    function.set("destination-mac", mac_text(mac_of(r_, stream_->destination), '-'));
    function.set("tagged", "all");
    function.set("vlan", std::to_string(stream_->vlan));
  }

  /// Where it comes to be numbered or split: by a port, or in a host from above, through the side of its port that
  /// faces inwards.
  void identify_source() {
    if (before_.empty())
      identify(compound(), "input-port", after_, "in-facing");
    else
      identify(compound(), "input-port", before_);
  }

  /// A member: on the wire (down) it has an address of its own, above that of the stream.
  void identify_member(std::size_t member, std::string_view side, const std::set<std::string>& ports) {
    Data& function = new_identity(member_handle(member), side, ports).make("dmac-vlan-stream-identification");
    const auto set = [&](Data& address, models::AddressIndex destination, models::VlanId vlan) {
      address.set("destination-mac", mac_text(mac_of(r_, destination), '-'));
      address.set("tagged", "all");
      address.set("vlan", std::to_string(vlan));
    };
    set(function.make("down"), redundancy_->members[member].destination, redundancy_->members[member].vlan);
    set(function.make("up"), stream_->destination, stream_->vlan);
  }

  void encode(const std::string& handle, const std::set<std::string>& ports) {
    for (const std::string& port : ports) {
      coded_[port].handles.insert(handle);
      coded_[port].encodes = true;
    }
  }

  void write_split() {
    const std::set<std::string>& places = redundancy_->splits_in_host ? after_ : before_;
    if (places.size() != 1) return lose("a split across several interfaces of a host: the tables place it at one");
    if (!split_at_.insert(*places.begin()).second)
      return lose("a second split at " + *places.begin() + ": the table has one for a port");
    identify_source();
    Data& split = frer().add("stream-split");
    split.set("port", *places.begin());
    split.set("direction-out-facing", "false");
    split.add("input-id").text = compound();
    for (std::size_t m = 0; m < redundancy_->members.size(); ++m) {
      split.add("output-id").text = member_handle(m);
      identify_member(m, "output-port", member_after_[m]);
      encode(member_handle(m), member_after_[m]);
    }
  }

  std::uint32_t whole_ms(sim::Duration duration, const char* what) {
    const std::int64_t ms = duration.ps() / 1'000'000'000;
    if (duration.ps() % 1'000'000'000 != 0 || ms > 0xFFFF'FFFF)
      lose(std::string(what) + " that is no whole number of ms in 32 bits");
    return static_cast<std::uint32_t>(std::min<std::int64_t>(ms, 0xFFFF'FFFF));
  }

  void write_merge() {
    const std::set<std::string>& places = redundancy_->merges_in_host ? before_ : after_;
    if (redundancy_->merges_in_host && places.size() != 1)
      return lose("a recovery across several interfaces of a host: the tables place one at each port");
    if (is_filtered()) lose("stream filters behind its recovery: the file identifies its members only");
    for (std::size_t m = 0; m < redundancy_->members.size(); ++m) {
      identify_member(m, "input-port", member_before_[m]);
      for (const std::string& port : member_before_[m]) coded_[port].handles.insert(member_handle(m));
    }
    write_recovery(places, false);
    if (redundancy_->description->individual)
      for (std::size_t m = 0; m < redundancy_->members.size(); ++m) write_recovery(member_before_[m], true, m);
    if (!redundancy_->description->keep_tag || redundancy_->merges_in_host) return;
    identify(compound(), "output-port", after_);
    encode(compound(), after_);
  }

  bool is_filtered() {
    const std::string handle = compound();
    return device_.ingress != nullptr &&
           std::ranges::any_of(device_.ingress->stream_filters, [&](const models::StreamFilterConfig& each) {
             return each.stream_handle && std::to_string(each.stream_handle->value + 1) == handle;
           });
  }

  void write_recovery(const std::set<std::string>& places, bool is_individual, std::size_t only = 0) {
    const scenario::Redundancy& said = *redundancy_->description;
    Data& entry = frer().add("sequence-recovery");
    entry.set("index", std::to_string(++recoveries_));
    for (std::size_t m = 0; m < redundancy_->members.size(); ++m)
      if (!is_individual || m == only) entry.add("stream").text = member_handle(m);
    for (const std::string& port : places) entry.add("port").text = port;
    entry.set("direction-out-facing", "true");
    entry.make("algorithm").make(said.algorithm == scenario::Recovery::vector ? "vector" : "match");
    entry.set("history-length", std::to_string(said.history));
    entry.set("reset-timeout", std::to_string(whole_ms(said.reset_timeout, "a reset timeout")));
    entry.set("take-no-sequence", said.take_untagged ? "true" : "false");
    entry.set("individual-recovery", is_individual ? "true" : "false");
    if (is_individual || !said.latent_errors) return;
    entry.set("latent-error-detection", "true");
    Data& latent = entry.make("latent-error-detection-parameters");
    if (said.latent_errors->difference > 0x7FFF'FFFF) lose("a difference of latent errors of more than 31 bits");
    latent.set("difference", std::to_string(std::min<std::uint64_t>(said.latent_errors->difference, 0x7FFF'FFFF)));
    latent.set("period", std::to_string(whole_ms(said.latent_errors->period, "a period of latent errors")));
    latent.set("paths", std::to_string(redundancy_->members.size()));
    latent.set("reset-period",
               std::to_string(whole_ms(said.latent_errors->reset_period, "a reset period of latent errors")));
  }

  Data& root_;
  const scenario::Resolved& r_;
  const Device& device_;
  Exported& exported_;
  std::vector<std::string> handles_;  // of streams; the number of one is its place, from 1
  std::set<std::string> identified_, split_at_;
  std::size_t identities_ = 0, generations_ = 0, recoveries_ = 0;
  std::map<std::string, Coded> coded_;  // by interface
  const scenario::ResolvedRedundancy* redundancy_ = nullptr;
  const models::StreamPlan* stream_ = nullptr;
  std::set<std::string> before_, after_;
  std::vector<std::set<std::string>> member_before_, member_after_;
};

}  // namespace

void write_redundancy(Data& root, const scenario::Resolved& resolved, const Device& device, Dialect dialect,
                      Exported& exported) {
  if (dialect == Dialect::of_2018) {
    const auto participates = [&](const scenario::ResolvedRedundancy& each) {
      const auto& listeners = resolved.plan.streams[each.stream.value].listeners;
      return each.number == device.node || each.split == device.node || each.merge == device.node ||
             each.relay_at(device.node) != nullptr ||
             (each.merges_in_host && std::ranges::any_of(listeners, [&](models::NodeIndex listener) {
                return listener.value == device.node;
              }));
    };
    if (std::ranges::any_of(resolved.redundancies, participates))
      exported.lose(device.name, "redundancy (802.1CB): there is no module of 2018 for it");
    return;
  }
  RedundancyWriter writer(root, resolved, device, exported);
  for (const scenario::ResolvedRedundancy& redundancy : resolved.redundancies) writer.write(redundancy);
  writer.finish();
}

}  // namespace takt::interchange::yang
