// SPDX-License-Identifier: Apache-2.0
#include "opcua/services/security_keys.hpp"

#include "opcua/address_space/standard_nodes.hpp"

namespace takt::opcua {

CallMethodRequest call_of(const SecurityKeysRequest& request) {
  CallMethodRequest call;
  call.object_id = NodeId(ids::publish_subscribe);
  call.method_id = NodeId(ids::get_security_keys);
  call.input_arguments = {Variant(request.group), Variant(request.starting_token), Variant(request.count)};
  return call;
}

std::optional<SecurityKeysRequest> keys_request_in(const CallMethodRequest& call, CallMethodResult& result) {
  constexpr std::size_t arguments = 3;
  result.status_code =
      call.input_arguments.size() < arguments ? StatusCode::BadArgumentsMissing : StatusCode::BadTooManyArguments;
  if (call.input_arguments.size() != arguments) return std::nullopt;
  const auto* const group = call.input_arguments[0].get<Text>();
  const auto* const starting_token = call.input_arguments[1].get<std::uint32_t>();
  const auto* const count = call.input_arguments[2].get<std::uint32_t>();
  if (group != nullptr && starting_token != nullptr && count != nullptr) {
    result.status_code = StatusCode::Good;
    return SecurityKeysRequest{*group, *starting_token, *count};
  }
  result.status_code = StatusCode::BadInvalidArgument;
  for (const bool is_sound : {group != nullptr, starting_token != nullptr, count != nullptr})
    result.input_argument_results.push_back(is_sound ? StatusCode::Good : StatusCode::BadTypeMismatch);
  return std::nullopt;
}

CallMethodResult result_of(const SecurityKeys& keys) {
  std::vector<Bytes> octets;
  for (const security::Secret& each : keys.keys)
    octets.emplace_back(std::vector<std::byte>(each.octets().begin(), each.octets().end()));
  CallMethodResult result;
  result.output_arguments = {Variant(keys.policy_uri), Variant(keys.first_token), Variant::array(octets),
                             Variant(keys.time_to_next_ms), Variant(keys.lifetime_ms)};
  for (Bytes& each : octets) security::wipe(each.value);
  return result;
}

std::optional<SecurityKeys> keys_in(const CallMethodResult& result) {
  const auto& outputs = result.output_arguments;
  if (outputs.size() != 5 || !outputs[2].is_array ||
      (outputs[2].type != BuiltInType::ByteString && !outputs[2].values.empty()))
    return std::nullopt;
  const auto* const policy_uri = outputs[0].get<Text>();
  const auto* const first_token = outputs[1].get<std::uint32_t>();
  const auto* const time_to_next = outputs[3].get<double>();
  const auto* const lifetime = outputs[4].get<double>();
  if (policy_uri == nullptr || first_token == nullptr || time_to_next == nullptr || lifetime == nullptr)
    return std::nullopt;
  SecurityKeys keys{*policy_uri, *first_token, {}, *time_to_next, *lifetime};
  for (const Scalar& each : outputs[2].values) keys.keys.emplace_back(security::Octets(std::get<Bytes>(each).value));
  return keys;
}

}  // namespace takt::opcua
