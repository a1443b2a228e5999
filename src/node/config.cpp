#include "node/config.hpp"

#include <algorithm>
#include <set>

#include "scenario/json/suggest.hpp"

namespace takt::node {
namespace {

constexpr std::uint32_t most_octets = 1472;  // what UDP over IPv4 leaves of an Ethernet frame

/// Checks what the fields of a file mean together.
class Checker {
 public:
  Checker(const Config& config, json::Diagnostics& diagnostics) : config_(config), diagnostics_(diagnostics) {}

  wire::EndpointSettings run() {
    const Program& program = config_.program;
    participants_.push_back(program.master);
    participants_.insert(participants_.end(), program.slaves.begin(), program.slaves.end());
    check_participants();
    check_times();
    check_sources();
    wire::EndpointSettings settings;
    settings.handshake.variant = variant_of(program.variant);
    settings.handshake.index = index_of(config_.node, config_.where.at("node"));
    settings.handshake.role = settings.handshake.index == 0 ? handshake::Role::Master : handshake::Role::Slave;
    settings.handshake.slaves = static_cast<std::uint8_t>(program.slaves.size());
    settings.handshake.subscription = subscription_of(program.subscription);
    settings.cycle = program.cycle;
    settings.offset = program.offset;
    settings.receive_timeout = program.receive_timeout.value_or(program.cycle * 10);
    settings.initialisation = program.initialisation;
    settings.publish_on_change = program.publish == Publish::on_change;
    settings.priority = std::visit([](const auto& transport) { return transport.pcp; }, config_.transport);
    wire::ProgramShape shape = shape_of(settings.handshake.variant);
    if (!diagnostics_.has_errors()) settings.format = std::make_shared<const wire::ProgramFormat>(std::move(shape));
    return settings;
  }

 private:
  void check_participants() {
    std::set<std::string_view> seen = {config_.program.master};
    for (std::size_t i = 0; i < config_.program.slaves.size(); ++i)
      if (!seen.insert(config_.program.slaves[i]).second)
        diagnostics_.error(config_.program.where.at("slaves", i), "a participant twice", {json::quote(config_.program.slaves[i]), "a name of its own for each"});
  }

  void check_times() {
    const Program& program = config_.program;
    if (program.offset > Duration() && program.offset >= program.cycle)
      diagnostics_.error(program.where.at("offset"), "an offset beyond the cycle", {json::to_text(program.offset), "less than " + json::to_text(program.cycle)});
    if (program.receive_timeout && *program.receive_timeout <= program.cycle)
      diagnostics_.error(program.where.at("receive_timeout"), "a time-out within one cycle",
                         {json::to_text(*program.receive_timeout), "more than the cycle of " + json::to_text(program.cycle)});
  }

  void check_sources() {
    for (const Source& source : config_.sources) {
      const auto& all = config_.program.process_data;
      const auto found = std::find_if(all.begin(), all.end(), [&](const ProcessData& data) { return data.name == source.data_set; });
      if (found == all.end() || found->from != config_.node) {
        std::vector<std::string_view> names;
        for (const ProcessData& data : all)
          if (data.from == config_.node) names.push_back(data.name);
        diagnostics_.error(source.where.at("data_set"), "not published here", {json::quote(source.data_set), "a data set from " + json::quote(config_.node), json::suggest(source.data_set, names)});
      } else if (source.field && std::none_of(found->fields.begin(), found->fields.end(), [&](const auto& field) { return field.first == *source.field; })) {
        std::vector<std::string_view> names;
        for (const auto& field : found->fields) names.push_back(field.first);
        diagnostics_.error(source.where.at("field"), "no such field", {json::quote(*source.field), "a field of " + json::quote(source.data_set), json::suggest(*source.field, names)});
      }
    }
    if (config_.launch_lead && *config_.launch_lead >= config_.program.cycle)
      diagnostics_.error(config_.where.at("launch_lead"), "a lead of more than the cycle", {json::to_text(*config_.launch_lead), "less than " + json::to_text(config_.program.cycle)});
  }

  std::uint8_t index_of(const std::string& name, const json::Place& place) {
    const auto found = std::find(participants_.begin(), participants_.end(), name);
    if (found != participants_.end()) return static_cast<std::uint8_t>(found - participants_.begin());
    const std::vector<std::string_view> names(participants_.begin(), participants_.end());
    diagnostics_.error(place, "not a participant of the program", {json::quote(name), "the master or a slave", json::suggest(name, names)});
    return 0;
  }

  wire::ProgramShape shape_of(handshake::Variant variant) {
    const Program& program = config_.program;
    wire::ProgramShape shape;
    shape.name = program.name;
    shape.variant = variant;
    shape.participants = participants_;
    shape.first_publisher_id = program.publisher_id;
    std::set<std::string_view> names = {"state"};
    for (const ProcessData& data : program.process_data) {
      wire::DataSetShape data_set = data_set_shape_of(data, index_of(data.from, data.where.at("from")));
      if (!names.insert(data.name).second)
        diagnostics_.error(data.where.at("name"), "duplicate name", {json::quote(data.name), "a name of its own for each data set (\"state\" is taken)"});
      const std::uint32_t octets = wire::process_data_octets(wire::octets_of(data_set));
      if (octets > most_octets)
        diagnostics_.error(data.where.at("fields"), "more than one frame", {std::to_string(octets) + " octets", "at most " + std::to_string(most_octets)});
      shape.data_sets.push_back(std::move(data_set));
    }
    return shape;
  }

  const Config& config_;
  json::Diagnostics& diagnostics_;
  std::vector<std::string> participants_;
};

}  // namespace

std::unique_ptr<LoadedConfig> load_config(const std::string& path, json::Diagnostics& diagnostics) {
  const auto document = json::parse_file(path, diagnostics);
  if (!document) return nullptr;
  auto loaded = std::make_unique<LoadedConfig>();
  json::decode(*document, loaded->config, diagnostics);
  if (diagnostics.has_errors()) return nullptr;
  loaded->endpoint = Checker(loaded->config, diagnostics).run();
  if (diagnostics.has_errors()) return nullptr;
  return loaded;
}

}  // namespace takt::node
