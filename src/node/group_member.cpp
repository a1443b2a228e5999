#include "node/group_member.hpp"

#include <utility>

namespace takt::node {
namespace {

constexpr std::uint32_t most_lives = 0xFF'FFFF;  // of 24 bits, without 0

}  // namespace

auto GroupMember::make(const Config& config, const LoadedProgram& loaded, wire::EndpointSettings endpoint) -> Part {
  if (!loaded.roles) return Part(std::in_place_type<wire::ProgramEndpoint>, std::move(endpoint));
  const std::uint32_t life = endpoint.handshake.incarnation % most_lives + 1;
  wire::PlugSettings settings = wire::plug_settings(std::move(endpoint), loaded.roles->format, loaded.roles->announce_cycle);
  if (!loaded.roles->candidate) return Part(std::in_place_type<wire::PlugMaster>, std::move(settings), loaded.program.on_replacement == OnReplacement::restart);
  return Part(std::in_place_type<wire::CandidateEndpoint>, std::move(settings), *loaded.roles->candidate, life, loaded.roles->skills, !config.absent);
}

GroupMember::GroupMember(const Config& config, const LoadedProgram& loaded, wire::EndpointSettings endpoint)
    : part_(make(config, loaded, std::move(endpoint))), peer_count_(this->endpoint() == nullptr ? 1 : this->endpoint()->participant().peer_count()) {}

void GroupMember::start(wire::PlugHost& host) {
  std::visit([&](auto& part) { part.start(host); }, part_);
}
program::StatusCode GroupMember::call(wire::PlugHost& host, program::Method method) {
  return std::visit([&](auto& part) { return part.call(host, method); }, part_);
}
void GroupMember::finished(wire::PlugHost& host) {
  std::visit([&](auto& part) { part.finished(host); }, part_);
}
void GroupMember::receive(wire::PlugHost& host, uadp::Octets network_message) {
  std::visit([&](auto& part) { part.receive(host, network_message); }, part_);
}
void GroupMember::wake(wire::PlugHost& host, std::size_t alarm) {
  std::visit([&](auto& part) { part.wake(host, alarm); }, part_);
}
std::size_t GroupMember::alarm_count() const {
  return std::visit([](const auto& part) { return part.alarm_count(); }, part_);
}

const wire::ProgramEndpoint* GroupMember::endpoint() const {
  if (const auto* const each = master()) return &each->endpoint();
  if (const auto* const each = candidate()) return each->endpoint();
  return std::get_if<wire::ProgramEndpoint>(&part_);
}

handshake::PublishedState GroupMember::state() const { return endpoint() == nullptr ? handshake::PublishedState::Halted : endpoint()->participant().state(); }

}  // namespace takt::node
