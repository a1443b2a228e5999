// SPDX-License-Identifier: Apache-2.0
// Read, Write and Call (OPC 10000-4, 5.10 and 5.11).
#include <algorithm>

#include "opcua/server/numeric_range.hpp"
#include "opcua/server/services.hpp"

namespace takt::opcua {

/// Observers see; a plant is moved by those who are more, and over channels that nobody else can write on, unless the
/// settings say otherwise.
bool Services::may_call(const Session& session, program::Method method) const {
  if (session.role != Role::operator_ && session.role != Role::engineer) return false;
  const bool is_enough = session.security.is_encrypted() || settings_.calls_without_encryption;
  return is_enough || (method == program::Method::Halt && settings_.halt_without_encryption);
}

DataValue Services::value_for(const Session* session, const Node& node, AttributeId attribute, Now now) const {
  DataValue value = attribute_of(node, attribute, {now.utc});
  if (attribute != AttributeId::UserExecutable || !is_good(value.result())) return value;
  bool may = session != nullptr && may_have_keys(*session) &&
             (node.id == NodeId(ids::get_security_keys) || node.id == NodeId(ids::get_security_keys_of_type));
  for (const auto& program : programs_)
    if (const auto method = program->method(node.id); method && session != nullptr) may = may_call(*session, *method);
  value.value = Variant(node.executable && may);
  return value;
}

DataValue Services::read_one(const Session& session, const ReadValueId& what, TimestampsToReturn times, Now now) const {
  const auto refused = [](StatusCode status) {
    DataValue none;
    none.status = status;
    return none;
  };
  const Node* const node = space_.find(what.node_id);
  if (node == nullptr) return refused(StatusCode::BadNodeIdUnknown);
  const auto attribute = static_cast<AttributeId>(what.attribute_id);
  const bool is_value = attribute == AttributeId::Value;
  const bool is_binary = what.data_encoding.name.empty() ||
                         (what.data_encoding.name_space == 0 && what.data_encoding.name == "Default Binary");
  if (!is_binary)
    return refused(is_value ? StatusCode::BadDataEncodingUnsupported : StatusCode::BadDataEncodingInvalid);
  DataValue value = value_for(&session, *node, attribute, now);
  if (is_bad(value.result())) return value;
  if (!what.index_range.empty() && value.value)
    if (const StatusCode status = cut(*value.value, what.index_range); !is_good(status)) return refused(status);
  return with_times(std::move(value), times, now.utc, is_value);
}

Answer<ReadResponse> Services::read(const Request& request, const ReadRequest& body) {
  if (body.nodes_to_read.empty()) return StatusCode::BadNothingToDo;
  if (body.nodes_to_read.size() > settings_.limits.operations) return StatusCode::BadTooManyOperations;
  if (!(body.max_age >= 0)) return StatusCode::BadMaxAgeInvalid;
  if (static_cast<std::uint32_t>(body.timestamps_to_return) > 3) return StatusCode::BadTimestampsToReturnInvalid;
  ReadResponse response;
  spend(10 * body.nodes_to_read.size());
  for (const ReadValueId& each : body.nodes_to_read)
    response.results.push_back(read_one(*request.session, each, body.timestamps_to_return, request.now));
  return response;
}

/// Nothing here is written by clients: a Program is moved by its methods.
Answer<WriteResponse> Services::write(const Request& request, const WriteRequest& body) {
  if (body.nodes_to_write.empty()) return StatusCode::BadNothingToDo;
  if (body.nodes_to_write.size() > settings_.limits.operations) return StatusCode::BadTooManyOperations;
  WriteResponse response;
  for (const WriteValue& each : body.nodes_to_write) {
    const Node* const node = space_.find(each.node_id);
    const auto attribute = static_cast<AttributeId>(each.attribute_id);
    if (node == nullptr)
      response.results.push_back(StatusCode::BadNodeIdUnknown);
    else if (attribute_of(*node, attribute, {request.now.utc}).result() == StatusCode::BadAttributeIdInvalid)
      response.results.push_back(StatusCode::BadAttributeIdInvalid);
    else
      response.results.push_back(attribute == AttributeId::Value ? StatusCode::BadNotWritable
                                                                 : StatusCode::BadWriteNotSupported);
  }
  return response;
}

ProgramNodes* Services::program_with(const NodeId& id, std::size_t& index) {
  for (index = 0; index < programs_.size(); ++index)
    if (programs_[index]->id() == id) return programs_[index].get();
  return nullptr;
}

/// The checks that need no Program; whether the method is allowed in the present state only the participant knows,
/// which says so when it gets there.
StatusCode Services::begin_method(const Request& request, const CallMethodRequest& wanted, std::uint64_t call,
                                  std::size_t index) {
  if (space_.find(wanted.object_id) == nullptr) return StatusCode::BadNodeIdUnknown;
  std::size_t number = 0;
  ProgramNodes* const program = program_with(wanted.object_id, number);
  const auto method = program != nullptr ? program->method(wanted.method_id) : std::nullopt;
  if (!method) return StatusCode::BadMethodInvalid;
  CallRecord record{*method,         request.session->id, request.session->user, request.header.audit_entry_id,
                    request.now.utc, StatusCode::Good};
  // It has not come to the Program, whose diagnostic is of those that have; that somebody has tried is an event.
  const auto refuse = [&](StatusCode status) {
    record.status = status;
    tell(program->refused(record));
    return status;
  };
  if (!may_call(*request.session, *method)) return refuse(StatusCode::BadUserAccessDenied);
  if (!wanted.input_arguments.empty()) return refuse(StatusCode::BadTooManyArguments);
  const std::uint64_t serial = ++last_serial_;
  if (!host_.call(serial, number, *method)) return refuse(StatusCode::BadResourceUnavailable);
  program->calling(record);
  methods_[serial] = {call, index, number, record};
  return StatusCode::Good;
}

void Services::call(const Request& request, const CallRequest& body) {
  const auto refused = [&](StatusCode why) {
    fault(request.connection, request.id, request.header.request_handle, why, request.now);
  };
  if (body.methods_to_call.empty()) return refused(StatusCode::BadNothingToDo);
  if (body.methods_to_call.size() > settings_.limits.operations) return refused(StatusCode::BadTooManyOperations);
  now_ = request.now;
  const std::uint64_t number = ++last_serial_;
  PendingCall& call = calls_[number];
  call.connection = request.connection;
  call.request_id = request.id;
  call.handle = request.header.request_handle;
  call.until = request.now.local + settings_.limits.call_within;
  call.response.results.resize(body.methods_to_call.size());
  for (std::size_t i = 0; i < body.methods_to_call.size(); ++i) {
    if (keys_ != nullptr && body.methods_to_call[i].object_id == NodeId(ids::publish_subscribe)) {
      call.response.results[i] = get_security_keys(request, body.methods_to_call[i]);
      continue;
    }
    const StatusCode status = begin_method(request, body.methods_to_call[i], number, i);
    call.response.results[i].status_code =
        is_good(status) ? StatusCode::BadTimeout : status;  // until the Program has answered
    call.missing += is_good(status) ? 1U : 0U;
  }
  if (call.missing == 0) finish(number, request.now);
}

}  // namespace takt::opcua
