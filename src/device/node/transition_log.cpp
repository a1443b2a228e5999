// SPDX-License-Identifier: Apache-2.0
#include "node/transition_log.hpp"

#include <fmt/format.h>

#include "json/diagnostics.hpp"

namespace takt::node {
namespace {

std::string_view name_of(handshake::Alarm alarm) {
  switch (alarm) {
    case handshake::Alarm::none:
      return "command";
    case handshake::Alarm::peer_silent:
      return "silent peer";
    case handshake::Alarm::peer_restarted:
      return "restarted peer";
    case handshake::Alarm::peer_left:
      return "peer left";
    case handshake::Alarm::mismatch:
      return "mismatch";
    case handshake::Alarm::other_group:
      return "nested group";
  }
  return "?";
}

}  // namespace

TransitionLog::TransitionLog(Log& log, std::string_view program)
    : log_(&log),
      program_(program.empty() ? std::string() : "\"program\": " + json::quote(program) + ", "),
      names_(program_) {}

void TransitionLog::started(std::int64_t time, std::string_view node, std::uint32_t incarnation) {
  log_->write(fmt::format("{{\"time_ns\": {}, \"event\": \"start\", \"node\": {}, \"incarnation\": {}}}\n", time,
                          json::quote(node), incarnation));
}

void TransitionLog::stepped(std::int64_t time, const handshake::Outputs& outputs, const handshake::Word& after) {
  const bool is_news = after.run != last_.run || after.intent.run != last_.intent.run;
  last_ = after;
  if (!is_news && !outputs.raised && outputs.change_count == 0) return;
  const std::string runs = fmt::format("\"run\": {}, \"intent_run\": {}", after.run, after.intent.run);
  if (outputs.raised)
    log_->write(fmt::format("{{\"time_ns\": {}, {}\"event\": \"intent\", \"kind\": \"{}\", \"cause\": \"{}\", {}}}\n",
                            time, names_, handshake::name_of(outputs.raised_kind), name_of(outputs.alarm), runs));
  for (const handshake::StateChange& change : outputs.changes())
    log_->write(fmt::format(
        "{{\"time_ns\": {}, {}\"event\": \"transition\", \"number\": {}, \"from\": \"{}\", \"to\": \"{}\", {}}}\n",
        time, names_, change.transition, handshake::name_of(change.from), handshake::name_of(change.to), runs));
  if (!outputs.raised && outputs.change_count == 0)
    log_->write(fmt::format("{{\"time_ns\": {}, {}\"event\": \"run\", {}}}\n", time, names_, runs));
}

void TransitionLog::called(std::int64_t time, program::Method method, program::StatusCode status) {
  log_->write(
      fmt::format("{{\"time_ns\": {}, {}\"event\": \"call\", \"method\": \"{}\", \"good\": {}, \"status\": \"{}\"}}\n",
                  time, names_, program::name_of(method), program::is_good(status), program::name_of(status)));
}

void TransitionLog::bound(std::int64_t time, std::string_view role, std::string_view node, std::uint32_t life) {
  log_->write(fmt::format("{{\"time_ns\": {}, {}\"event\": \"bound\", \"role\": {}, \"to\": {}, \"life\": {}}}\n", time,
                          program_, json::quote(role), node.empty() ? "null" : json::quote(node), life));
}

void TransitionLog::took_role(std::int64_t time, std::string_view role, std::uint32_t life) {
  names_ = program_ + "\"role\": " + json::quote(role) + ", ";
  last_ = {};
  log_->write(fmt::format("{{\"time_ns\": {}, {}\"event\": \"role taken\", \"life\": {}}}\n", time, names_, life));
}

void TransitionLog::dropped_role(std::int64_t time) {
  log_->write(fmt::format("{{\"time_ns\": {}, {}\"event\": \"role dropped\"}}\n", time, names_));
  names_ = program_;
}

void TransitionLog::membership(std::int64_t time, Membership what) {
  log_->write(fmt::format("{{\"time_ns\": {}, {}\"event\": \"{}\"}}\n", time, program_,
                          what == Membership::join ? "join" : "leave"));
}

void TransitionLog::refused(std::int64_t time, std::string_view address, std::optional<std::uint64_t> publisher_id,
                            std::string_view verdict) {
  log_->write(fmt::format(
      "{{\"time_ns\": {}, \"event\": \"refused\", \"address\": {}, \"publisher_id\": {}, \"verdict\": \"{}\"}}\n", time,
      json::quote(address), publisher_id ? std::to_string(*publisher_id) : "null", verdict));
}

void TransitionLog::noticed(std::int64_t time, std::string_view what) {
  log_->write(fmt::format("{{\"time_ns\": {}, \"event\": \"notice\", \"text\": {}}}\n", time, json::quote(what)));
}

void TransitionLog::twins(std::int64_t time, const SourceTable::Twins& twins) {
  log_->write(fmt::format(
      "{{\"time_ns\": {}, \"event\": \"two nodes of one name\", \"publisher_id\": {}, \"addresses\": [{}, {}]}}\n",
      time, twins.publisher_id, json::quote(to_text(twins.one)), json::quote(to_text(twins.other))));
}

void TransitionLog::ended(const NodeStatus& status) {
  log_->finish("{\"event\": \"end\", " + to_json(status).substr(1) + "\n");
}

}  // namespace takt::node
