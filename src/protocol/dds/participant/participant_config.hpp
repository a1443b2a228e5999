// SPDX-License-Identifier: Apache-2.0
// What a participant, a writer and a reader are made of.
#pragma once

#include <compare>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "dds/discovery/settings.hpp"
#include "dds/history/instance_key.hpp"
#include "dds/message/locator.hpp"
#include "dds/persistence/storage.hpp"
#include "dds/qos/policies.hpp"
#include "dds/rtps/epoch.hpp"
#include "dds/rtps/flow_controller.hpp"
#include "dds/rtps/timing_profile.hpp"
#include "dds/rtps/writer_proxy.hpp"

namespace takt::dds {

/// Names an entity of its participant, from 1 on in the order of creation; never used again.
struct WriterHandle {
  std::uint32_t number = 0;
  auto operator<=>(const WriterHandle&) const = default;
};
struct ReaderHandle {
  std::uint32_t number = 0;
  auto operator<=>(const ReaderHandle&) const = default;
};

/// An entity that was made, or why it was not.
template <class Handle>
struct Created {
  std::optional<Handle> handle;
  std::vector<std::string> problems;  ///< each as "policy or setting: what and why"
  explicit operator bool() const { return handle.has_value(); }
};

struct ParticipantConfig {
  std::uint32_t domain = 0;
  std::uint32_t participant = 0;       ///< its number on its host, for the ports
  GuidPrefix prefix;                   ///< one in the world; a restarted participant takes another one
  std::uint32_t address = 0x7F000001;  ///< IPv4 of its host, 10.0.0.1 being 0x0A000001
  std::optional<std::uint32_t>
      multicast_group;  ///< where its readers listen for data, besides their own address; nothing: unicast only
  bool multicast_to_one = false;  ///< writers use the group where a single reader listens to it, too; otherwise that
                                  ///< one has its samples by unicast
  std::size_t max_message =
      1472;  ///< octets of an RTPS message, 256 to 65507; 1472 is what UDP over IPv4 leaves of an Ethernet frame
  TimingProfile timing = timing::fast_dds;
  Epoch epoch;
  ReceiveLimits receive_limits;
  std::vector<FlowControllerSettings> flow_controllers;
  std::optional<DiscoverySettings> discovery;  ///< nothing: entities are matched by hand only
  std::optional<std::uint16_t>
      metatraffic_port;  ///< instead of the one that follows from domain and participant, for example of a server
  std::string name;      ///< entity name; static discovery finds participants by it
};

struct WriterConfig {
  std::string topic;
  std::string type;
  bool has_key = false;
  DataWriterQos qos;
  bool asynchronous = false;    ///< write() puts into the history only; wake() sends
  std::string flow_controller;  ///< of an asynchronous writer; "": one of its own without limits
  FlowShare flow_share;
  Guid persistence_guid;  ///< the name that survives restarts; unknown: none
  bool brings_others =
      false;  ///< of a persistence service: changes of other writers, for readers that request TRANSIENT or above
  Storage* storage =
      nullptr;  ///< keeps numbers and history of a writer with a persistence GUID; outlives the participant
};

struct ReaderConfig {
  std::string topic;
  std::string type;
  bool has_key = false;
  DataReaderQos qos;
  std::function<InstanceKey(PayloadKind, Octets)>
      key_of;  ///< finds the instance where the other side sends no key hash
  Guid persistence_guid;
  Storage* storage = nullptr;          ///< keeps which samples were taken, so that a restarted reader gets none twice
  bool commits_by_hand = false;        ///< with a storage: a sample is kept as taken by commit(), not by take()
  std::string content_filter;          ///< what others are told of `passes`; empty without
  std::function<bool(Octets)> passes;  ///< a serialized payload: whether the sample is of the content-filtered topic
                                       ///< that is read (DDS 1.4, 2.2.2.3.3); nothing: all are
};

}  // namespace takt::dds
