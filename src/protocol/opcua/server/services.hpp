// SPDX-License-Identifier: Apache-2.0
// All services of the server: sessions, address space, subscriptions, calls. It knows no connections and no octets of
// messages; `server.hpp` does.
#pragma once

#include <memory>
#include <set>

#include "opcua/address_space/program_nodes.hpp"
#include "opcua/server/outside.hpp"
#include "opcua/server/subscription.hpp"

namespace takt::opcua {

class Services {
 public:
  /// All but the descriptions outlive it. `keys` is null unless it is a key service, too.
  Services(const ServerSettings& settings, const Identity& identity, security::RandomOctets& random, ProgramHost& host,
           ServerLog& log, Responder& responder, const std::vector<ProgramDescription>& programs, KeyService* keys,
           Now now);

  // Discovery and sessions (session_services.cpp).
  Answer<FindServersResponse> find_servers(const Request& request, const FindServersRequest& body);
  Answer<GetEndpointsResponse> get_endpoints(const Request& request, const GetEndpointsRequest& body);
  Answer<CreateSessionResponse> create_session(const Request& request, const CreateSessionRequest& body);
  Answer<ActivateSessionResponse> activate_session(const Request& request, const ActivateSessionRequest& body);
  Answer<CloseSessionResponse> close_session(const Request& request, const CloseSessionRequest& body);
  Answer<CancelResponse> cancel(const Request& request, const CancelRequest& body);
  /// The session that the request names and may use. Null, and why.
  Session* session_for(const Request& request, StatusCode& why, bool must_be_active);

  // Browsing (view_services.cpp).
  Answer<BrowseResponse> browse(const Request& request, const BrowseRequest& body);
  Answer<BrowseNextResponse> browse_next(const Request& request, const BrowseNextRequest& body);
  Answer<TranslateBrowsePathsToNodeIdsResponse> translate(const Request& request,
                                                          const TranslateBrowsePathsToNodeIdsRequest& body);
  Answer<RegisterNodesResponse> register_nodes(const Request& request, const RegisterNodesRequest& body);
  Answer<UnregisterNodesResponse> unregister_nodes(const Request& request, const UnregisterNodesRequest& body);

  // Attributes and methods (attribute_services.cpp).
  Answer<ReadResponse> read(const Request& request, const ReadRequest& body);
  Answer<WriteResponse> write(const Request& request, const WriteRequest& body);
  /// Answered when the Programs have.
  void call(const Request& request, const CallRequest& body);

  // Monitored items (item_services.cpp).
  Answer<CreateMonitoredItemsResponse> create_items(const Request& request, const CreateMonitoredItemsRequest& body);
  Answer<ModifyMonitoredItemsResponse> modify_items(const Request& request, const ModifyMonitoredItemsRequest& body);
  Answer<SetMonitoringModeResponse> set_monitoring_mode(const Request& request, const SetMonitoringModeRequest& body);
  Answer<DeleteMonitoredItemsResponse> delete_items(const Request& request, const DeleteMonitoredItemsRequest& body);

  // Subscriptions (subscription_services.cpp).
  Answer<CreateSubscriptionResponse> create_subscription(const Request& request, const CreateSubscriptionRequest& body);
  Answer<ModifySubscriptionResponse> modify_subscription(const Request& request, const ModifySubscriptionRequest& body);
  Answer<SetPublishingModeResponse> set_publishing_mode(const Request& request, const SetPublishingModeRequest& body);
  Answer<DeleteSubscriptionsResponse> delete_subscriptions(const Request& request,
                                                           const DeleteSubscriptionsRequest& body);
  Answer<TransferSubscriptionsResponse> transfer(const Request& request, const TransferSubscriptionsRequest& body);
  Answer<RepublishResponse> republish(const Request& request, const RepublishRequest& body);
  /// Answered when there is something to publish.
  void publish(const Request& request, const PublishRequest& body);

  // What happens otherwise (services.cpp).
  void news(const ProgramNews& news);
  void answered(std::uint64_t serial, StatusCode status, Now now);
  void disconnected(ConnectionId connection);
  /// Those that it holds for, with their subscriptions.
  void end_sessions(const std::function<bool(const Session&)>& is_over, Now now);
  /// What is due, and events to whom they are for, up to the budget of a turn; the rest is due at once.
  void advance(Now now);
  sim::LocalTime next_time() const;
  /// Steps of work since the start, each about 50 ns: what a request or an event costs is known behind it.
  std::uint64_t steps() const { return steps_; }
  void spend(std::uint64_t steps) { steps_ += steps; }
  std::size_t sessions() const { return sessions_.size(); }
  std::size_t subscriptions() const { return subscriptions_.size(); }
  /// That sessions hold of what they may.
  std::size_t octets() const { return all_octets_->held(); }
  /// Somebody has signed in on it.
  bool has_session(ConnectionId connection) const;
  /// Of the session that has signed in on it; null if none has.
  const Session* session_on(ConnectionId connection) const;
  /// A call of one who may call: it comes before everything else.
  bool is_urgent(ConnectionId connection, const CallRequest& call) const;
  const AddressSpace& space() const { return space_; }

  /// Writes a response with its header, or a fault.
  template <Structure Response>
  void respond(ConnectionId connection, std::uint32_t request_id, std::uint32_t handle, Response response, Now now) {
    response.response_header.timestamp = now.utc;
    response.response_header.request_handle = handle;
    Encoder encoder;
    encode_message(encoder, response);
    responder_.respond(connection, request_id, encoder.octets());
  }
  void fault(ConnectionId connection, std::uint32_t request_id, std::uint32_t handle, StatusCode result, Now now) {
    ServiceFault made;
    made.response_header.service_result = result;
    respond(connection, request_id, handle, std::move(made), now);
  }

 private:
  struct PendingCall {
    ConnectionId connection = 0;
    std::uint32_t request_id = 0;
    std::uint32_t handle = 0;
    std::size_t missing = 0;
    sim::LocalTime until;
    CallResponse response;
  };
  /// One method of a pending call.
  struct PendingMethod {
    std::uint64_t call = 0;
    std::size_t result = 0;
    std::size_t program = 0;
    CallRecord record;
  };
  struct SignIns {
    std::size_t failed = 0;
    sim::LocalTime refused_until;
  };

  // services.cpp
  void add_server_nodes(Now now);
  void set_standard(std::uint32_t id, Variant value);
  std::vector<std::byte> random_octets(std::size_t count);
  void tell(const Event& event);
  void distribute_events();
  void distribute(const std::shared_ptr<const EventRecord>& record, Subscription& subscription, MonitoredItem& item);
  void expire_due(Now now);
  using Accounts = std::map<std::string, std::weak_ptr<OctetAccount>>;
  std::shared_ptr<OctetAccount> account_in(Accounts& accounts, const std::string& holder,
                                           const std::shared_ptr<OctetAccount>& above) const;
  std::shared_ptr<OctetAccount> holder_account(const std::string& holder) {
    return account_in(holders_, holder, all_octets_);
  }
  /// Who moves plants has room whatever the others take.
  std::shared_ptr<OctetAccount> buffers_of(const Session& session) {
    return account_in(buffers_, session.holder(), session.rank() == 2 ? nullptr : all_buffers_);
  }
  void finish(std::uint64_t call, Now now);

  // session_services.cpp
  ApplicationDescription application(const Request& request) const;
  List<EndpointDescription> endpoints(const Request& request) const;
  bool is_offered(const ChannelSecurity& security) const;
  std::vector<Place> places(bool active, Now now, std::vector<NodeId>& tokens) const;
  bool make_room_to_sign_in(const std::string& host, Now now);
  bool make_room(const Session& newcomer, Now now);
  StatusCode sign_in(const Request& request, Session& session, const ExtensionObject& token);
  StatusCode check_password(const Request& request, const Session& session, const UserNameIdentityToken& token,
                            Text& user, Role& role);
  void note_sign_in(const Request& request, bool is_good);
  void end(const NodeId& token, bool deletes_subscriptions, StatusCode why, Now now);

  // view_services.cpp
  BrowseResult browse(Session& session, const BrowseDescription& what, std::size_t most);
  void cut_references(Session& session, BrowseResult& result, std::size_t most);
  ReferenceDescription describe(const Reference& reference, std::uint32_t mask) const;
  BrowsePathResult translate(const BrowsePath& path);
  /// Of the references of a node, so many that one request looks at; false: no more.
  bool may_look_at(std::size_t references);

  // attribute_services.cpp
  bool may_call(const Session& session, program::Method method) const;
  DataValue value_for(const Session* session, const Node& node, AttributeId attribute, Now now) const;
  DataValue read_one(const Session& session, const ReadValueId& what, TimestampsToReturn times, Now now) const;
  StatusCode begin_method(const Request& request, const CallMethodRequest& method, std::uint64_t call,
                          std::size_t index);
  ProgramNodes* program_with(const NodeId& id, std::size_t& index);

  // key_services.cpp
  bool may_have_keys(const Session& session) const;
  CallMethodResult get_security_keys(const Request& request, const CallMethodRequest& wanted);

  // item_services.cpp
  MonitoredItemCreateResult create_item(const Request& request, Subscription& subscription,
                                        const MonitoredItemCreateRequest& wanted, TimestampsToReturn times);
  StatusCode set_parameters(MonitoredItem& item, const Node& node, const MonitoringParameters& wanted,
                            double least_sampling, std::uint32_t& queue, double& sampling,
                            ExtensionObject& filter_result);
  void watch(const Subscription& subscription, const MonitoredItem& item, bool begins);
  void put_current(Subscription& subscription, MonitoredItem& item, Now now);
  void changed(const Node& node, AttributeId attribute);

  // subscription_services.cpp
  Subscription* subscription_of(const Request& request, std::uint32_t id);
  void revise(Subscription& subscription, double interval, std::uint32_t lifetime, std::uint32_t keep_alive) const;
  void remove(std::uint32_t subscription);
  /// Without a session from now on.
  void orphan(Subscription& subscription, Now now);
  bool make_room(const Session& session, std::size_t most, Now now);
  bool has_subscriptions(const NodeId& session) const;
  void answer_publishes(Session& session, Now now);
  void refuse_publishes(Session& session, StatusCode why, Now now);
  void expire(Subscription& subscription, Now now);

  const ServerSettings& settings_;
  const Identity& identity_;
  security::RandomOctets& random_;
  ProgramHost& host_;
  KeyService* keys_;
  ServerLog& log_;
  Responder& responder_;
  AddressSpace space_;
  std::vector<std::unique_ptr<ProgramNodes>> programs_;
  std::map<NodeId, Session> sessions_;  ///< by token
  std::map<std::uint32_t, Subscription> subscriptions_;
  std::map<std::pair<NodeId, AttributeId>, std::vector<std::pair<std::uint32_t, std::uint32_t>>>
      watchers_;  ///< subscriptions and their items
  std::map<std::uint64_t, PendingCall> calls_;
  std::map<std::uint64_t, PendingMethod> methods_;
  std::map<std::string, SignIns> sign_ins_;  ///< by source; bounded
  std::uint64_t last_serial_ = 0;
  std::uint32_t last_session_ = 0;
  std::uint32_t last_subscription_ = 0;
  std::uint32_t last_item_ = 0;
  std::uint64_t events_ = 0;
  std::shared_ptr<OctetAccount> all_octets_;
  std::shared_ptr<OctetAccount> all_buffers_;
  Accounts holders_;
  Accounts buffers_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> event_items_;  ///< subscriptions and their items of events
  std::deque<std::shared_ptr<const EventRecord>> waiting_events_;
  std::pair<std::uint32_t, std::uint32_t> told_{};  ///< the last item that has been told of the first of them
  bool has_lost_events_ = false;                    ///< behind those that wait
  std::uint64_t steps_ = 0;
  std::size_t looked_at_ = 0;       ///< references, by this request
  std::vector<std::byte> process_;  ///< first half of all EventIds
  Now now_;                         ///< of what is happening
};

}  // namespace takt::opcua
