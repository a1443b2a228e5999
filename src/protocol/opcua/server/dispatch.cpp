// SPDX-License-Identifier: Apache-2.0
// Which service a request is for, as one table (OPC 10000-6, 5.2.9; OPC 10000-4, 5).
#include <algorithm>

#include "opcua/server/server.hpp"

namespace takt::opcua {

/// A request that is answered at once.
template <Structure Body, Structure Response, auto Function>
void Server::serve_now(Request& request, Decoder& decoder) {
  Body body;
  body.request_header = request.header;
  decode(decoder, body);
  if (decoder.failed())
    return services_.fault(request.connection, request.id, request.header.request_handle, decoder.status(),
                           request.now);
  const auto answer = (services_.*Function)(request, body);
  if (const auto* const why = std::get_if<StatusCode>(&answer))
    services_.fault(request.connection, request.id, request.header.request_handle, *why, request.now);
  else
    services_.respond(request.connection, request.id, request.header.request_handle, std::get<Response>(answer),
                      request.now);
}

/// One that is answered when there is an answer.
template <Structure Body, auto Function>
void Server::serve_later(Request& request, Decoder& decoder) {
  Body body;
  decode(decoder, body);
  if (decoder.failed())
    return services_.fault(request.connection, request.id, request.header.request_handle, decoder.status(),
                           request.now);
  (services_.*Function)(request, body);
}

namespace {

using Browses = Answer<BrowseResponse> (Services::*)(const Request&, const BrowseRequest&);
using Translates = Answer<TranslateBrowsePathsToNodeIdsResponse> (Services::*)(
    const Request&, const TranslateBrowsePathsToNodeIdsRequest&);

}  // namespace

const Server::ServiceEntry Server::services_table[] = {
    {FindServersRequest::encoding_id,
     &Server::serve_now<FindServersRequest, FindServersResponse, &Services::find_servers>, false, false},
    {GetEndpointsRequest::encoding_id,
     &Server::serve_now<GetEndpointsRequest, GetEndpointsResponse, &Services::get_endpoints>, false, false},
    {CreateSessionRequest::encoding_id,
     &Server::serve_now<CreateSessionRequest, CreateSessionResponse, &Services::create_session>, false, false},
    {ActivateSessionRequest::encoding_id,
     &Server::serve_now<ActivateSessionRequest, ActivateSessionResponse, &Services::activate_session>, true, false},
    {CloseSessionRequest::encoding_id,
     &Server::serve_now<CloseSessionRequest, CloseSessionResponse, &Services::close_session>, true, true},
    {CancelRequest::encoding_id, &Server::serve_now<CancelRequest, CancelResponse, &Services::cancel>, true, true},
    {BrowseRequest::encoding_id,
     &Server::serve_now<BrowseRequest, BrowseResponse, static_cast<Browses>(&Services::browse)>, true, true},
    {BrowseNextRequest::encoding_id, &Server::serve_now<BrowseNextRequest, BrowseNextResponse, &Services::browse_next>,
     true, true},
    {TranslateBrowsePathsToNodeIdsRequest::encoding_id,
     &Server::serve_now<TranslateBrowsePathsToNodeIdsRequest, TranslateBrowsePathsToNodeIdsResponse,
                        static_cast<Translates>(&Services::translate)>,
     true, true},
    {RegisterNodesRequest::encoding_id,
     &Server::serve_now<RegisterNodesRequest, RegisterNodesResponse, &Services::register_nodes>, true, true},
    {UnregisterNodesRequest::encoding_id,
     &Server::serve_now<UnregisterNodesRequest, UnregisterNodesResponse, &Services::unregister_nodes>, true, true},
    {ReadRequest::encoding_id, &Server::serve_now<ReadRequest, ReadResponse, &Services::read>, true, true},
    {WriteRequest::encoding_id, &Server::serve_now<WriteRequest, WriteResponse, &Services::write>, true, true},
    {CallRequest::encoding_id, &Server::serve_later<CallRequest, &Services::call>, true, true},
    {CreateMonitoredItemsRequest::encoding_id,
     &Server::serve_now<CreateMonitoredItemsRequest, CreateMonitoredItemsResponse, &Services::create_items>, true,
     true},
    {ModifyMonitoredItemsRequest::encoding_id,
     &Server::serve_now<ModifyMonitoredItemsRequest, ModifyMonitoredItemsResponse, &Services::modify_items>, true,
     true},
    {SetMonitoringModeRequest::encoding_id,
     &Server::serve_now<SetMonitoringModeRequest, SetMonitoringModeResponse, &Services::set_monitoring_mode>, true,
     true},
    {DeleteMonitoredItemsRequest::encoding_id,
     &Server::serve_now<DeleteMonitoredItemsRequest, DeleteMonitoredItemsResponse, &Services::delete_items>, true,
     true},
    {CreateSubscriptionRequest::encoding_id,
     &Server::serve_now<CreateSubscriptionRequest, CreateSubscriptionResponse, &Services::create_subscription>, true,
     true},
    {ModifySubscriptionRequest::encoding_id,
     &Server::serve_now<ModifySubscriptionRequest, ModifySubscriptionResponse, &Services::modify_subscription>, true,
     true},
    {SetPublishingModeRequest::encoding_id,
     &Server::serve_now<SetPublishingModeRequest, SetPublishingModeResponse, &Services::set_publishing_mode>, true,
     true},
    {DeleteSubscriptionsRequest::encoding_id,
     &Server::serve_now<DeleteSubscriptionsRequest, DeleteSubscriptionsResponse, &Services::delete_subscriptions>, true,
     true},
    {TransferSubscriptionsRequest::encoding_id,
     &Server::serve_now<TransferSubscriptionsRequest, TransferSubscriptionsResponse, &Services::transfer>, true, true},
    {RepublishRequest::encoding_id, &Server::serve_now<RepublishRequest, RepublishResponse, &Services::republish>, true,
     true},
    {PublishRequest::encoding_id, &Server::serve_later<PublishRequest, &Services::publish>, true, true},
};

const Server::ServiceEntry* Server::service_with(const NodeId& type) {
  const auto found = std::find_if(std::begin(services_table), std::end(services_table),
                                  [&](const ServiceEntry& each) { return type == NodeId(each.encoding_id); });
  return found == std::end(services_table) ? nullptr : found;
}

void Server::dispatch(Connection& connection, std::uint32_t request_id, Octets message, Now now) {
  Request request;
  request.connection = connection.id;
  request.source = connection.source;
  request.url = connection.url;
  request.security = connection.channel->security();
  request.certificate = connection.channel->client_certificate();
  request.id = request_id;
  request.now = now;
  // All requests begin with their type and their header.
  Decoder decoder(message);
  NodeId type;
  decode(decoder, type);
  const std::size_t body_at = decoder.position();
  decode(decoder, request.header);
  const auto refused = [&](StatusCode why) {
    services_.fault(connection.id, request_id, request.header.request_handle, why, now);
  };
  if (decoder.failed()) return refused(decoder.status());
  const ServiceEntry* const entry = service_with(type);
  if (entry == nullptr) return refused(StatusCode::BadServiceUnsupported);
  if (entry->needs_session) {
    StatusCode why = StatusCode::Good;
    request.session = services_.session_for(request, why, entry->needs_activation);
    if (request.session == nullptr) return refused(why);
  }
  Decoder body(message.subspan(body_at));
  (this->*entry->service)(request, body);
}

}  // namespace takt::opcua
