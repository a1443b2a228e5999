#include "node/transition_log.hpp"

#include <fmt/format.h>

#include "scenario/json/diagnostics.hpp"

namespace takt::node {
namespace {

std::string_view name_of(handshake::Alarm alarm) {
  switch (alarm) {
    case handshake::Alarm::None: return "command";
    case handshake::Alarm::PeerSilent: return "silent peer";
    case handshake::Alarm::PeerRestarted: return "restarted peer";
    case handshake::Alarm::PeerLeft: return "peer left";
    case handshake::Alarm::Mismatch: return "mismatch";
    case handshake::Alarm::OtherGroup: return "nested group";
  }
  return "?";
}

/// A line is written whole and at once, so that a killed node leaves no half of one.
void write(std::FILE* file, const std::string& line) {
  std::fputs(line.c_str(), file);
  std::fflush(file);
}

}  // namespace

void TransitionLog::started(std::int64_t time, std::string_view node, std::uint32_t incarnation) {
  write(file_, fmt::format("{{\"time_ns\": {}, \"event\": \"start\", \"node\": {}, \"incarnation\": {}}}\n", time,
                           scenario::json::quote(node), incarnation));
}

void TransitionLog::changed(std::int64_t time, const handshake::StateChange& change) {
  write(file_, fmt::format("{{\"time_ns\": {}, \"event\": \"transition\", \"number\": {}, \"from\": \"{}\", \"to\": \"{}\"}}\n", time, change.transition,
                           handshake::name_of(change.from), handshake::name_of(change.to)));
}

void TransitionLog::raised(std::int64_t time, handshake::IntentKind kind, handshake::Alarm alarm) {
  write(file_, fmt::format("{{\"time_ns\": {}, \"event\": \"intent\", \"kind\": \"{}\", \"cause\": \"{}\"}}\n", time, handshake::name_of(kind), name_of(alarm)));
}

void TransitionLog::called(std::int64_t time, program::Method method, program::StatusCode status) {
  write(file_, fmt::format("{{\"time_ns\": {}, \"event\": \"call\", \"method\": \"{}\", \"good\": {}, \"status\": \"{}\"}}\n", time, program::name_of(method),
                           program::is_good(status), program::name_of(status)));
}

void TransitionLog::ended(const NodeStatus& status) { write(file_, "{\"event\": \"end\", " + to_json(status).substr(1) + "\n"); }

}  // namespace takt::node
