// SPDX-License-Identifier: Apache-2.0
#include "node/config.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "json/suggest.hpp"
#include "node/private_file.hpp"
#include "node/program_check.hpp"
#include "node/server_check.hpp"
#include "plant/program_check.hpp"

namespace takt::node {
namespace {

constexpr std::uint32_t last_publisher_id = 0xFFFF;
constexpr std::size_t most_message_octets = 1472;  // what UDP over IPv4 leaves of an Ethernet frame

/// Checks what the fields of a file mean together.
class Checker {
 public:
  Checker(LoadedConfig& loaded, json::Diagnostics& diagnostics)
      : loaded_(loaded),
        config_(loaded.config),
        diagnostics_(diagnostics),
        all_(config_.program ? std::vector<Program>{*config_.program} : config_.programs) {}

  void run() {
    check_names();
    for (const Program& program : all_) add(program);
    check_publishers();
    plant::check_nesting(all_, true, diagnostics_);
    check_offers(config_, all_, diagnostics_);
    if (loaded_.programs.empty()) refuse_stranger();
    if (!diagnostics_.has_errors()) join();
    load_keys_of_node();
    for (Source& source : config_.sources) check(source);
    for (const ScriptEntry& entry : config_.script) check(entry);
    if (config_.server) check_server(loaded_, diagnostics_);
    std::stable_sort(loaded_.script.begin(), loaded_.script.end(),
                     [](const LoadedCall& a, const LoadedCall& b) { return a.at < b.at; });
    for (const LoadedProgram& each : loaded_.programs)
      if (config_.launch_lead && *config_.launch_lead >= each.program.cycle)
        diagnostics_.error(config_.where.at("launch_lead"), "a lead of more than the cycle",
                           {json::to_text(*config_.launch_lead), "less than " + json::to_text(each.program.cycle)});
  }

 private:
  struct Publishers {
    const Program* program = nullptr;
    std::uint32_t first = 0;
    std::uint32_t behind = 0;
  };

  void check_names() {
    std::set<std::string_view> seen;
    for (const Program& program : all_)
      if (!seen.insert(program.name).second)
        diagnostics_.error(program.where.at("name"), "duplicate name",
                           {json::quote(program.name), "a name of its own for each program"});
  }

  void add(const Program& program) {
    const std::size_t errors_before = diagnostics_.errors();
    const std::vector<std::string> nodes = plant::nodes_of(program);
    const std::uint32_t first = program.publisher_id.value_or(publishers_.empty() ? 1 : publishers_.back().behind);
    publishers_.push_back({&program, first,
                           first + static_cast<std::uint32_t>(1 + program.slaves.size() + program.roles.size() +
                                                              program.candidates.size())});
    node::check(program, diagnostics_);
    const auto self = std::find(nodes.begin(), nodes.end(), config_.node);
    if (self == nodes.end()) return;
    LoadedProgram loaded;
    loaded.program = program;
    const bool is_candidate = !program.roles.empty() && self != nodes.begin();
    loaded.endpoint =
        plant::endpoint_settings(program, static_cast<std::uint8_t>(is_candidate ? 1 : self - nodes.begin()));
    loaded.endpoint.priority = std::visit([](const auto& transport) { return transport.pcp; }, config_.transport);
    if (diagnostics_.errors() == errors_before) {
      wire::ProgramShape shape = plant::shape_of(program, static_cast<std::uint16_t>(first));
      loaded.roles = roles_at(config_, program, shape);
      loaded.endpoint.format = std::make_shared<const wire::ProgramFormat>(std::move(shape));
    }
    loaded_.programs.push_back(std::move(loaded));
  }

  /// The PublisherId says who sends, so no two participants have the same.
  void check_publishers() {
    for (auto each = publishers_.begin(); each != publishers_.end(); ++each) {
      if (each->behind - 1 > last_publisher_id)
        diagnostics_.error(
            each->program->where.place(), "more PublisherIds than there are",
            {"up to " + std::to_string(each->behind - 1), "at most " + std::to_string(last_publisher_id)});
      const auto other = std::find_if(publishers_.begin(), each, [&](const Publishers& before) {
        return before.first < each->behind && each->first < before.behind;
      });
      if (other != each)
        diagnostics_.error(each->program->where.at("publisher_id"), "PublisherIds of two programs",
                           {std::to_string(each->first) + " to " + std::to_string(each->behind - 1) + ", of which " +
                                json::quote(other->program->name) + " has some",
                            "ids of its own for each participant"});
    }
  }

  void refuse_stranger() {
    std::vector<std::string> nodes;
    for (const Program& program : all_)
      for (std::string& name : plant::nodes_of(program)) nodes.push_back(std::move(name));
    const bool has_roles =
        std::any_of(all_.begin(), all_.end(), [](const Program& program) { return !program.roles.empty(); });
    const std::vector<std::string_view> names(nodes.begin(), nodes.end());
    diagnostics_.error(
        config_.where.at("node"),
        all_.size() == 1 ? "not a participant of the program" : "not a participant of any program",
        {json::quote(config_.node), has_roles ? "the master, a slave or a candidate" : "the master or a slave",
         json::suggest(config_.node, names)});
  }

  /// Both sides of a nesting at this node wait for each other.
  void join() {
    for (LoadedProgram& inner : loaded_.programs) {
      if (!inner.program.within || inner.program.master != config_.node) continue;
      const auto outer = std::find_if(loaded_.programs.begin(), loaded_.programs.end(), [&](const LoadedProgram& each) {
        return each.program.name == *inner.program.within;
      });
      inner.outer = static_cast<std::size_t>(outer - loaded_.programs.begin());
      inner.endpoint.handshake.nested = outer->endpoint.handshake.nested = true;
    }
  }

  /// The node's Program of this name.
  std::optional<std::size_t> number_of(const std::string& name, const json::Place& place) {
    std::vector<std::string_view> names;
    for (const LoadedProgram& each : loaded_.programs) names.push_back(each.program.name);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    diagnostics_.error(
        place, "no program of this node",
        {json::quote(name), "one that " + json::quote(config_.node) + " is in", json::suggest(name, names)});
    return std::nullopt;
  }

  /// This node does, or does while it has the role.
  bool publishes(const Program& program, const ProcessData& data) const {
    if (program.roles.empty() || data.from == program.master) return data.from == config_.node;
    return config_.node != program.master &&
           std::any_of(program.roles.begin(), program.roles.end(),
                       [&](const Role& role) { return role.name == data.from && may_have(config_, role); });
  }

  /// What security adds fits into messages, too.
  void load_keys_of_node() {
    if (!config_.security) return;
    const MessageSecurity& security = *config_.security;
    LoadedSecurity found = load_security(security, diagnostics_);
    loaded_.keys = std::move(found.keys);
    loaded_.key_access = std::move(found.access);
    for (const char* const key : {"nonces", "sender"})
      if (security.where.has(key))
        diagnostics_.error(security.where.at(key), "not of programs",
                           {json::quote(key),
                            "a file with topics, or none: messages of programs have the nonces of takt, and the "
                            "PublisherId of their node"});
    for (const LoadedProgram& each : loaded_.programs) {
      if (!each.endpoint.format) continue;
      const std::size_t longest = each.endpoint.format->longest() + security::added_octets(security.mode);
      if (longest > most_message_octets)
        diagnostics_.error(each.program.where.at("process_data"), "more than one frame",
                           {std::to_string(longest) + " octets with all headers and a signature",
                            "at most " + std::to_string(most_message_octets)});
    }
  }

  void check(Source& source) {
    if (source.program && !number_of(*source.program, source.where.at("program"))) return;
    std::vector<std::string_view> names;
    std::vector<std::pair<const Program*, const ProcessData*>> found;
    for (const LoadedProgram& each : loaded_.programs)
      for (const ProcessData& data : each.program.process_data) {
        if (!publishes(each.program, data) || (source.program && *source.program != each.program.name)) continue;
        names.push_back(data.name);
        if (data.name == source.data_set) found.emplace_back(&each.program, &data);
      }
    if (found.empty()) {
      diagnostics_.error(source.where.at("data_set"), "not published here",
                         {json::quote(source.data_set), "a data set from " + json::quote(config_.node),
                          json::suggest(source.data_set, names)});
    } else if (found.size() > 1) {
      diagnostics_.error(source.where.at("data_set"), "a data set of several programs",
                         {json::quote(source.data_set) + " of " + json::quote(found[0].first->name) + " and " +
                              json::quote(found[1].first->name),
                          "\"program\" beside it"});
    } else {
      source.program = found[0].first->name;
      check_field(source, *found[0].second);
    }
  }

  void check_field(const Source& source, const ProcessData& data) {
    if (!source.field || std::any_of(data.fields.begin(), data.fields.end(),
                                     [&](const auto& field) { return field.first == *source.field; }))
      return;
    std::vector<std::string_view> names;
    for (const auto& field : data.fields) names.push_back(field.first);
    diagnostics_.error(source.where.at("field"), "no such field",
                       {json::quote(*source.field), "a field of " + json::quote(source.data_set),
                        json::suggest(*source.field, names)});
  }

  void check(const ScriptEntry& entry) {
    if (loaded_.programs.empty()) return;
    if (entry.membership) {
      check_membership(entry);
      return;
    }
    const auto program =
        entry.program ? number_of(*entry.program, entry.where.at("program")) : outermost(loaded_.programs);
    if (!program && !entry.program)
      diagnostics_.error(entry.where.place(), "a call without a program",
                         {"several programs of this node that are not nested", "\"program\""});
    if (!program) return;
    if (*entry.call == Method::Start && loaded_.programs[*program].outer)
      diagnostics_.error(
          entry.where.at("program"), "Start of a nested program",
          {json::quote(loaded_.programs[*program].program.name), "the outermost program, which starts it"});
    loaded_.script.push_back({entry.at, *program, *entry.call});
  }

  void check_membership(const ScriptEntry& entry) {
    const auto named = entry.program ? number_of(*entry.program, entry.where.at("program")) : std::nullopt;
    if (entry.program && !named) return;
    const auto offered = offered_in(loaded_.programs);
    if (offered && (!named || named == offered))
      loaded_.script.push_back({entry.at, *offered, *entry.membership});
    else if (!diagnostics_.has_errors())
      diagnostics_.error(entry.where.at("plug"), "not a candidate of the program",
                         {json::quote(config_.node), "a node that offers a skill a role needs"});
  }

  LoadedConfig& loaded_;
  Config& config_;
  json::Diagnostics& diagnostics_;
  std::vector<Program> all_;
  std::vector<Publishers> publishers_;
};

}  // namespace

std::optional<std::size_t> outermost(const std::vector<LoadedProgram>& programs) {
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < programs.size(); ++i) {
    if (programs[i].outer) continue;
    if (found) return std::nullopt;
    found = i;
  }
  return found;
}

std::optional<std::size_t> offered_in(const std::vector<LoadedProgram>& programs) {
  const auto found = std::find_if(programs.begin(), programs.end(),
                                  [](const LoadedProgram& each) { return each.roles && each.roles->offer; });
  return found == programs.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - programs.begin()));
}

std::unique_ptr<LoadedConfig> load_config(const std::string& path, json::Diagnostics& diagnostics) {
  const auto document = json::parse_file(path, diagnostics);
  if (!document) return nullptr;
  auto loaded = std::make_unique<LoadedConfig>();
  json::decode(*document, loaded->config, diagnostics);
  if (diagnostics.has_errors()) return nullptr;
  Checker(*loaded, diagnostics).run();
  if (diagnostics.has_errors()) return nullptr;
  return loaded;
}

}  // namespace takt::node
