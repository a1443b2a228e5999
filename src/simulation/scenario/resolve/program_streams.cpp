// SPDX-License-Identifier: Apache-2.0
#include "scenario/resolve/program_streams.hpp"

#include <algorithm>

#include "models/ethernet/sizes.hpp"
#include "plant/protocol.hpp"
#include "scenario/topology/named_path.hpp"
#include "uadp/builtin_type.hpp"
#include "wire/role_format.hpp"

namespace takt::scenario {
namespace {

class ProgramStreams {
 public:
  ProgramStreams(Resolved& resolved, StreamBuilder& builder, ResolvedProgram& program, json::Diagnostics& diagnostics)
      : r_(resolved),
        builder_(builder),
        program_(program),
        description_(*program.description),
        diagnostics_(diagnostics) {}

  bool lay() {
    if (!check_paths()) return false;
    if (description_.redundancy) {
      Redundancy redundancy;
      redundancy.where = description_.where;
      redundancy.count = description_.redundancy;
      program_.redundancy = std::make_shared<const Redundancy>(std::move(redundancy));
    }
    const Octets state{wire::state_octets(description_.variant)};
    const Octets table{wire::table_octets(description_.roles.size(), program_.candidates().size())};
    for (std::size_t m = 0; m < program_.members.size(); ++m) {
      ResolvedMember& member = program_.members[m];
      if (const EndStation* const host = end_station_of(r_.topology.nodes[member.node.value].description);
          description_.security && host != nullptr && host->cryptography) {
        member.seal = host->cryptography->seal;
        member.open = host->cryptography->open;
      }
      if (m != 0 && program_.has_roles())
        member.roles = add(m, "announce/" + name_of(member), Octets{wire::announcement_octets}, program_.announce_every,
                           description_.where);
      member.state = add(m, "state/" + name_of(member), state, description_.cycle, description_.where);
      if (m == 0 && program_.has_roles())
        member.roles = add(m, "bindings", table, program_.announce_every, description_.where);
      if (has_failed_) return false;
    }
    for (const ProcessData& data : description_.process_data) add(data);
    return !has_failed_;
  }

 private:
  /// Each is a way between two members.
  bool check_paths() {
    const std::size_t errors_before = diagnostics_.errors();
    if (description_.redundancy && !description_.paths.empty())
      diagnostics_.error(description_.where.at("paths"), "paths of redundant messages",
                         {"\"paths\" beside \"redundancy\"", "one of them: redundant messages take two trees"});
    for (std::size_t i = 0; i < description_.paths.size(); ++i) {
      const std::vector<std::string>& names = description_.paths[i];
      const json::Place here = description_.where.at("paths", i);
      const auto place_of = [&](std::size_t n) {
        json::Place place = here;
        place.pointer += json::pointer_step(n);
        return place;
      };
      const auto member = [&](std::size_t n) -> std::optional<std::uint32_t> {
        const auto node = r_.topology.find(names[n]);
        if (node &&
            std::ranges::any_of(program_.members, [&](const ResolvedMember& each) { return each.node.value == *node; }))
          return node;
        if (!node)
          report_unknown_node(r_.topology, names[n], place_of(n), "the node of a member of the program", diagnostics_);
        else
          diagnostics_.error(place_of(n), "not a member",
                             {json::quote(names[n]), "the node of a member of the program at each end of a path"});
        return std::nullopt;
      };
      if (names.size() < 2 || diagnostics_.is_refused(here)) continue;
      const auto from = member(0);
      const auto to = member(names.size() - 1);
      if (from && to) named_path(r_.topology, names, *from, *to, here, place_of, diagnostics_);
    }
    return diagnostics_.errors() == errors_before;
  }

  void add(const ProcessData& data) {
    ResolvedProcessData made;
    made.name = data.name;
    made.from = static_cast<std::uint8_t>(std::ranges::find(program_.participant_names, data.from) -
                                          program_.participant_names.begin());
    made.field_octets = plant::field_octets_of(data);
    for (const auto& [name, field] : data.fields) made.values += field.count;
    const bool is_of_role = program_.has_roles() && made.from != 0;
    for (std::size_t m = 0; m < program_.members.size(); ++m) {
      ResolvedMember& member = program_.members[m];
      member.data.emplace_back();
      const bool sends = is_of_role
                             ? std::ranges::find(member.skills, description_.roles[made.from - std::size_t{1}].skill) !=
                                   member.skills.end()
                             : m == made.from;
      if (sends)
        member.data.back() = add(m, data.name + (is_of_role ? "/" + name_of(member) : ""),
                                 Octets{wire::process_data_octets(made.field_octets)}, description_.cycle, data.where);
    }
    program_.process_data.push_back(std::move(made));
  }

  /// From the master to all others; from another to the master, or to all.
  models::StreamIndex add(std::size_t from, const std::string& what, Octets payload, Duration every,
                          const json::Source& where) {
    NewStream wanted;
    wanted.name = program_.name + "/" + what;
    wanted.where = where;
    wanted.from = program_.members[from].node.value;
    if (from != 0) wanted.to.push_back({program_.members[0].node.value, description_.where.at("master")});
    if (from == 0 || description_.subscription == Subscription::all_to_all)
      for (std::size_t m = 1; m < program_.members.size(); ++m)
        if (m != from)
          wanted.to.push_back({program_.members[m].node.value, program_.has_roles()
                                                                   ? description_.where.at("roles")
                                                                   : description_.where.at("slaves", m - 1)});
    wanted.priority = description_.pcp;
    wanted.vlan = description_.vlan;
    wanted.payload = payload + Octets{plant::octets_of_security(description_)};
    wanted.of_program = true;
    wanted.ether_type = wire::uadp_ether_type;
    wanted.redundancy = program_.redundancy.get();
    if (!description_.paths.empty()) wanted.ways = &description_.paths;
    const auto index = builder_.add(wanted);
    has_failed_ = has_failed_ || !index;
    if (!index) return {};
    StreamDemand& demand = r_.streams[index->value].demand;
    demand.frames_per_second = 1e12 / static_cast<double>(every.ps());
    demand.wire_bits_per_second =
        demand.frames_per_second * 8.0 *
        models::wire_length(models::frame_length(r_.plan.streams[index->value].headers + wanted.payload, true)).count;
    return *index;
  }

  const std::string& name_of(const ResolvedMember& member) const { return r_.topology.nodes[member.node.value].name; }

  Resolved& r_;
  StreamBuilder& builder_;
  ResolvedProgram& program_;
  const Program& description_;
  json::Diagnostics& diagnostics_;
  bool has_failed_ = false;
};

}  // namespace

bool lay_program_streams(Resolved& resolved, StreamBuilder& builder, ResolvedProgram& program,
                         json::Diagnostics& diagnostics) {
  return ProgramStreams(resolved, builder, program, diagnostics).lay();
}

}  // namespace takt::scenario
