// SPDX-License-Identifier: Apache-2.0
#include "analysis/dds_sources.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "analysis/dds_messages.hpp"
#include "analysis/thread_arrivals.hpp"
#include "application/topic_values.hpp"
#include "dds/participant/participant.hpp"
#include "scenario/applications/dds_port.hpp"
#include "scenario/resolved/resolved_dds.hpp"

namespace takt::analysis {
namespace {

using scenario::ResolvedApplication;
using scenario::ResolvedParticipant;
using scenario::ResolvedThread;
using namespace dds_messages;

/// Greetings of a reader that hears nothing: so many until they are a heartbeat period apart.
std::int64_t greetings_of(sim::Duration first, sim::Duration greatest) {
  std::int64_t count = 1;
  for (sim::Duration gap = first; gap < greatest; gap = 2 * gap) ++count;
  return count;
}

sim::Duration builtin_greeting(const dds::TimingProfile& timing) {
  return timing.initial_acknack_delay != dds::TimingProfile::off ? timing.initial_acknack_delay
                                                                 : timing.heartbeat_response_delay;
}

/// Profiles that answer at once, repeat themselves or send heartbeats with samples are not followed.
bool is_followed(const dds::TimingProfile& timing) {
  using dds::TimingProfile;
  return timing.piggyback_interval == TimingProfile::off && timing.nack_repeat == TimingProfile::off &&
         !timing.heartbeat_after_resend && !timing.greets_by_heartbeat && timing.heartbeat_period > sim::Duration() &&
         timing.heartbeat_response_delay > sim::Duration() && timing.nack_delay_when_final > sim::Duration() &&
         builtin_greeting(timing) > sim::Duration();
}

/// All participants of one domain.
class DomainTraffic {
 public:
  DomainTraffic(const scenario::Resolved& r, const BoundOptions& options, const HostTimes& hosts,
                std::vector<std::uint32_t> members, DdsTraffic& made)
      : r_(r), options_(options), hosts_(hosts), members_(std::move(members)), made_(made) {}

  void make() {
    if (const std::string why = doubt(); !why.empty()) {
      for (const std::uint32_t member : members_)
        for (const ResolvedParticipant::Route& route : participant(member).routes)
          made_.unknown.emplace(route.stream.value, why);
      return;
    }
    set_times();
    for (const std::uint32_t from : members_) add(from);
    flush();
    for (const scenario::ResolvedRedundancy& redundancy : r_.redundancies)
      if (is_ours(redundancy.stream)) made_.unknown.emplace(redundancy.stream.value, "whose copies are not followed");
  }

 private:
  const ResolvedParticipant& participant(std::uint32_t member) const { return r_.dds->participants[member]; }
  const ResolvedApplication& application(std::uint32_t member) const {
    return r_.applications[participant(member).application];
  }
  models::NodeIndex node(std::uint32_t member) const { return application(member).node; }
  ClockQuality clock(std::uint32_t member) const { return clock_quality(r_, node(member), options_); }
  bool is_ours(models::StreamIndex stream) const {
    return std::ranges::any_of(members_, [&](std::uint32_t member) {
      return std::ranges::find(participant(member).routes, stream, &ResolvedParticipant::Route::stream) !=
             participant(member).routes.end();
    });
  }

  /// Lives of a host: a participant that starts again is another one, and the others hold what is left of it until its
  /// lease is over.
  std::int64_t lives(std::uint32_t member) const {
    std::int64_t count = 1;
    for (const scenario::ResolvedAction& action : r_.script)
      if (const auto* const fault = std::get_if<scenario::ResolvedNode>(&action.what);
          fault != nullptr && fault->up && fault->node == node(member))
        ++count;
    return count;
  }

  /// Why nothing is known of the domain; empty: it is.
  std::string doubt() const {
    for (const std::uint32_t member : members_) {
      if (!participant(member).config.discovery) return "whose participants are matched by hand";
      const dds::DiscoveryKind kind = participant(member).config.discovery->kind;
      if (kind != dds::DiscoveryKind::simple && kind != dds::DiscoveryKind::static_)
        return "whose domain has a discovery server, which tells what it hears as it hears it";
      if (application(member).service)
        return "whose domain has a persistence service, which repeats what it hears as it hears it";
      if (!is_followed(participant(member).config.timing))
        return "whose timing profile, " + std::string(participant(member).config.timing.name) + ", is not followed";
    }
    if (!options_.dds_within)
      return options_.dds_late.empty() ? "whose heartbeats, acknowledgements and repairs of DDS are simulated"
                                       : "whose answers of DDS have no bound, since " + options_.dds_late;
    return {};
  }

  void set_times() {
    const dds::TimingProfile& timing = participant(members_.front()).config.timing;
    const dds::DiscoveryProfile& discovery = participant(members_.front()).config.discovery->profile;
    const sim::Duration greeting = std::min(timing.initial_acknack_delay, builtin_greeting(timing));
    greetings_ = greetings_of(greeting, timing.heartbeat_period_max);
    Ps error = 0;
    Ps answering = 0;
    const auto least = [&](Ps& all, sim::Duration local, std::uint32_t member) {
      all = std::min(all, std::max<Ps>(1, shortest(local.ps(), clock(member))));
    };
    for (const std::uint32_t member : members_) {
      least(period_, timing.heartbeat_period, member);
      least(lease_, discovery.lease_duration, member);
      least(greeting_, greeting, member);
      least(response_, std::min(timing.heartbeat_response_delay, timing.nack_delay_when_final), member);
      repair_ = std::min(repair_, shortest(timing.nack_response_delay.ps(), clock(member)));
      error = std::max(error, clock(member).error);
      answering =
          std::max(answering, longest(std::max(timing.heartbeat_response_delay, timing.nack_delay_when_final).ps() +
                                          timing.nack_response_delay.ps(),
                                      clock(member)));
    }
    // A greeting comes to a writer, its HEARTBEAT back, the ACKNACK to the writer again: three ways and two wake-ups.
    late_ = sum(5 * options_.dds_within->ps(), answering, 2 * error);
    own_ = 2 * error;
  }

  const ResolvedParticipant::Route* route(std::uint32_t from, const dds::Locator& to, std::int32_t priority) const {
    const auto& routes = participant(from).routes;
    const auto exact = std::ranges::find_if(
        routes, [&](const auto& each) { return each.to == to && each.transport_priority == priority; });
    if (exact != routes.end()) return &*exact;
    const auto any = std::ranges::find(routes, to, &ResolvedParticipant::Route::to);
    return any == routes.end() ? nullptr : &*any;
  }
  dds::Ports ports(std::uint32_t member) const {
    return dds::ports_of(participant(member).config.domain, participant(member).config.participant);
  }
  dds::Locator user(std::uint32_t member) const {
    return dds::Locator::udp_v4(participant(member).config.address, ports(member).unicast_user);
  }
  dds::Locator metatraffic(std::uint32_t member) const {
    return dds::Locator::udp_v4(
        participant(member).config.address,
        participant(member).config.metatraffic_port.value_or(ports(member).unicast_metatraffic));
  }

  void add(std::uint32_t from) {
    announce(from);
    for (const std::uint32_t to : members_) {
      if (node(to) == node(from)) continue;  // participants of one host do not hear each other
      discover(from, to);
      for (const ResolvedThread& thread : application(from).threads)
        if (thread.participant == from) thread.publishes ? write(from, thread, to) : read(from, thread, to);
    }
    for (const ResolvedThread& thread : application(from).threads)
      if (thread.participant == from && thread.publishes && participant(from).config.multicast_group)
        write_to_group(from, thread);
  }

  void add(const ResolvedParticipant::Route* route, Payload payload, const Rates& rates, std::uint32_t from,
           std::uint32_t to) {
    if (route != nullptr)
      rates_[{route->stream.value, std::min(payload, greatest_message)}].add(rates.times(lives(from) * lives(to)));
  }
  void add(const ResolvedParticipant::Route* route, Payload payload, FrameArrivals arrivals) {
    if (route != nullptr)
      made_.sources.push_back({route->stream, std::move(arrivals), sim::Octets{std::min(payload, greatest_message)}});
  }

  /// What comes once per match (at most once in a lease), once per greeting and once per heartbeat period, of all
  /// writers and readers together.
  void flush() {
    for (const auto& [key, rates] : rates_) {
      const auto& [stream, payload] = key;
      const auto add = [&, stream = stream, payload = payload](FrameArrivals arrivals) {
        made_.sources.push_back({models::StreamIndex{stream}, std::move(arrivals), sim::Octets{payload}});
      };
      if (rates.periods > 0) add(FrameArrivals({period_, rates.periods, 0, late_}));
      if (rates.matches > 0) add(FrameArrivals({lease_, rates.matches, 0, late_}));
      if (rates.greetings == 0) continue;
      FrameArrivals greetings({lease_, rates.greetings * greetings_, 0, late_});
      greetings.add({greeting_, rates.greetings, 0, late_});
      add(greetings);
    }
  }

  // Of one writer and one reader. A reader greets, and its greetings go on in each period if it hears nothing; each may
  // be answered by a HEARTBEAT, each HEARTBEAT by an ACKNACK.
  bool greets(bool is_builtin) const {
    return is_builtin || participant(members_.front()).config.timing.initial_acknack_delay != dds::TimingProfile::off;
  }
  Rates heartbeats(bool is_builtin) const { return greets(is_builtin) ? Rates{1, 1, 2} : Rates{1, 0, 1}; }
  Rates acknowledgements(bool is_builtin) const { return greets(is_builtin) ? Rates{1, 2, 3} : Rates{1, 0, 1}; }

  /// What goes from a writer to a reliable reader beside new samples.
  void serve(const ResolvedParticipant::Route* to, const Offer& offer, bool sends_past, bool is_builtin,
             std::int64_t readers, std::uint32_t a, std::uint32_t b) {
    add(to, control_message, heartbeats(is_builtin).times(readers), a, b);
    const Rates asked = acknowledgements(is_builtin).times(readers);
    add(to, offer.message, asked.times(offer.samples_in_an_answer()), a, b);
    add(to, control_message, asked.times(offer.gaps_in_an_answer()), a, b);
    // A GAP tells where samples begin, others lie between those that are past.
    add(to, control_message, Rates{readers, 0, 0}, a, b);
    if (!sends_past) return;
    add(to, offer.message, Rates{readers * offer.samples * offer.fragments, 0, 0}, a, b);
    add(to, control_message, Rates{readers * (offer.samples + 1), 0, 0}, a, b);
  }

  // ---- Discovery

  Payload announcement(std::uint32_t member) const {
    return 512 + static_cast<Payload>(participant(member).config.name.size());
  }

  void announce(std::uint32_t from) {
    const dds::DiscoveryProfile& profile = participant(from).config.discovery->profile;
    const ResolvedParticipant::Route* const everybody =
        route(from, dds::Locator::udp_v4(dds::discovery_group, ports(from).multicast_metatraffic), 0);
    FrameArrivals first({unbounded_ps, lives(from) * profile.initial_announcements, 0, 0});
    first.add({std::max<Ps>(1, shortest(profile.initial_period.ps(), clock(from))), lives(from), 0, own_});
    add(everybody, announcement(from), first);
    add(everybody, announcement(from),
        FrameArrivals(
            {std::max<Ps>(1, shortest(profile.announcement_period.ps(), clock(from))), lives(from), 0, own_}));
  }

  /// Endpoints that a participant tells of, and how long that is.
  struct Endpoints {
    std::int64_t writers = 0;
    std::int64_t readers = 0;
    std::size_t longest_writer = 0;
    std::size_t longest_reader = 0;
    sim::Duration lease = sim::Duration::max();  ///< the shortest of automatic liveliness
  };
  Endpoints endpoints_of(std::uint32_t member) const {
    constexpr std::size_t persistence_guid = 20;  // names of endpoints that outlive them are given at the start
    dds::ParticipantConfig config = participant(member).config;
    config.discovery.reset();
    config.prefix.octets[11] = 1;
    dds::Participant made(config, {});
    std::array<std::byte, 16'384> buffer;
    Endpoints found;
    for (const ResolvedThread& thread : application(member).threads) {
      if (thread.participant != member) continue;
      if (thread.publishes) {
        const dds::WriterConfig writer = writer_config(r_.topics[thread.topic], thread);
        const auto handle = made.create_writer(writer, {}).handle;
        if (!handle) continue;
        ++found.writers;
        found.longest_writer =
            std::max(found.longest_writer, encode(buffer, made.data_of(*handle)).size() + persistence_guid);
        if (writer.qos.liveliness.kind == dds::LivelinessKind::automatic)
          found.lease = std::min(found.lease, writer.qos.liveliness.lease_duration);
      } else if (const auto handle = made.create_reader(reader_config(r_.topics[thread.topic], thread), {}).handle) {
        ++found.readers;
        found.longest_reader =
            std::max(found.longest_reader, encode(buffer, made.data_of(*handle)).size() + persistence_guid);
      }
    }
    return found;
  }

  /// Built-in samples of so many octets, `count` of them in the history.
  static Offer offer_of(std::int64_t count, std::size_t octets) {
    const Offer made = offer_of(octets, greatest_message);
    return {count, made.fragments, made.message};
  }

  void discover(std::uint32_t from, std::uint32_t to) {
    const ResolvedParticipant::Route* const there = route(from, metatraffic(to), 0);
    if (there == nullptr) return;
    add(there, announcement(from), Rates{1, 0, 0}, from, to);  // the answer to one that is new
    const Endpoints own = endpoints_of(from);
    const bool is_simple = participant(from).config.discovery->kind == dds::DiscoveryKind::simple;
    constexpr std::size_t liveliness_octets = 64;
    const auto pair = [&](std::int64_t samples, std::size_t octets) {
      serve(there, offer_of(samples, octets), true, true, 1, from, to);
      add(there, control_message, acknowledgements(true), from, to);
    };
    if (is_simple) pair(own.writers, own.longest_writer);
    if (is_simple) pair(own.readers, own.longest_reader);
    pair(2, liveliness_octets);
    if (own.lease == sim::Duration::max()) return;
    const sim::Duration every = own.lease / 100 * participant(from).config.timing.liveliness_percent;
    const std::int64_t together = lives(from) * lives(to);
    add(there, beside_sample + liveliness_octets,
        FrameArrivals({std::max<Ps>(1, shortest(every.ps(), clock(from))), together, 0, own_}));
  }

  // ---- Samples

  static Offer offer_of(std::size_t octets, Payload max_message) {
    const std::size_t most_whole = (max_message - beside_sample) & ~3U;
    const std::size_t fragment = (max_message - beside_fragment) & ~3U;
    const auto rounded = static_cast<Payload>((octets + 3) / 4 * 4);
    if (octets <= most_whole) return {-1, 1, std::min(beside_sample + rounded + heartbeat, max_message)};
    return {-1, static_cast<std::int64_t>((octets + fragment - 1) / fragment), max_message};
  }

  /// What a writer's history holds at most; below 0: without a limit.
  std::int64_t samples_of(const ResolvedThread& thread, const dds::HistorySettings& history) const {
    std::int64_t instances = 1;
    if (r_.topics[thread.topic].shape.key.has_key()) {
      const bool is_known = !thread.copies && thread.payload.pattern;
      instances = is_known ? static_cast<std::int64_t>(thread.payload.instances.value_or(1))
                           : std::int64_t{history.max_instances};
    }
    if (history.per_instance() == dds::HistorySettings::no_limit)
      return history.max_samples == dds::HistorySettings::no_limit ? -1 : std::int64_t{history.max_samples};
    if (instances == dds::HistorySettings::no_limit)
      return history.max_samples == dds::HistorySettings::no_limit ? -1 : std::int64_t{history.max_samples};
    return std::min<std::int64_t>(history.max_samples, instances * history.per_instance());
  }

  static bool has_limits(const dds::HistorySettings& history) {
    return history.max_samples != dds::HistorySettings::no_limit ||
           history.max_instances != dds::HistorySettings::no_limit ||
           (history.keep_all && history.per_instance() != dds::HistorySettings::no_limit);
  }
  dds::DataReaderQos qos_of_reader(const ResolvedThread& thread) const {
    return reader_config(r_.topics[thread.topic], thread).qos;
  }
  static dds::HistorySettings history_of(const auto& qos) {
    return dds::HistorySettings::from(qos.history, qos.resource_limits);
  }
  /// A reader that may have no room for a sample asks for it again whenever one is taken.
  bool may_refuse(const ResolvedThread& reader) const { return has_limits(history_of(qos_of_reader(reader))); }

  /// Samples that a call of such a reader takes: what its history holds, and of each writer what waits behind that.
  /// Each is a reason to send an ACKNACK. Below 0: any number.
  std::int64_t most_taken(const ResolvedThread& reader) const {
    const dds::HistorySettings own = history_of(qos_of_reader(reader));
    std::int64_t taken = own.max_samples;
    if (own.max_samples == dds::HistorySettings::no_limit) {
      if (own.max_instances == dds::HistorySettings::no_limit || own.per_instance() == dds::HistorySettings::no_limit)
        return -1;
      taken = std::int64_t{own.max_instances} * own.per_instance();
    }
    for (const std::uint32_t member : members_)
      for (const ResolvedThread& writer : application(member).threads) {
        if (writer.participant != member || !writer.publishes || writer.topic != reader.topic) continue;
        // What a writer keeps until it is acknowledged is all that can wait.
        const dds::HistorySettings history = history_of(writer_config(r_.topics[writer.topic], writer).qos);
        const std::int64_t kept = history.keep_all ? samples_of(writer, history) : -1;
        const auto most = static_cast<std::int64_t>(dds::ReceiveLimits{}.max_pending);
        taken += lives(member) * (kept < 0 ? most : std::min(kept, most));
      }
    return taken;
  }
  /// Its ACKNACKs to one writer for that, `each` times. Unlimited if that is not known.
  FrameArrivals taking(std::uint32_t member, const ResolvedThread& reader, std::int64_t each, Ps late) const {
    const std::int64_t taken = most_taken(reader);
    if (taken < 0) return {};
    ArrivalPattern calls = calls_of(reader, hosts_.of(node(member), reader.cpu_thread), clock(member));
    calls.frames = taken * each;
    calls.jitter = sum(calls.jitter, late);
    return FrameArrivals(calls);
  }

  template <class Visit>
  void for_each_reader(std::uint32_t member, std::uint32_t topic, Visit visit) const {
    for (const ResolvedThread& thread : application(member).threads)
      if (thread.participant == member && !thread.publishes && thread.topic == topic) visit(thread);
  }

  /// What a writer sends whenever there is something new, whoever it is for.
  struct Writing {
    dds::WriterConfig config;
    dds::HistorySettings history;
    Offer offer;
    ArrivalPattern writes;
    bool fills =
        false;  ///< with the sample that fills the history goes a HEARTBEAT, for which a message may have no room
    bool is_reliable = false;
    bool is_controlled = false;  ///< a flow controller has a say
    Ps waking = 0;               ///< from a timer's expiry to what an asynchronous writer does then
    std::size_t octets = 0;      ///< of a sample
  };
  Writing writing_of(std::uint32_t from, const ResolvedThread& thread) const {
    const scenario::ResolvedTopic& topic = r_.topics[thread.topic];
    Writing made;
    made.config = writer_config(topic, thread);
    made.is_reliable = made.config.qos.reliability.kind == dds::ReliabilityKind::reliable;
    made.history = history_of(made.config.qos);
    const auto& flow = topic.description->flow_control;
    made.is_controlled = made.config.asynchronous && flow && flow->octets != 0;
    made.octets = application::Publication(topic.shape, {}).next().size();
    made.offer =
        offer_of(made.octets, made.is_controlled ? std::min(greatest_message, flow->octets) : greatest_message);
    made.offer.samples = samples_of(thread, made.history);
    made.fills = made.is_reliable && made.history.keep_all && has_limits(made.history);
    // What blocks is written later.
    made.writes = calls_of(thread, hosts_.of(node(from), thread.cpu_thread), clock(from));
    const Ps within = options_.dds_within->ps();
    made.waking = hosts_.wake_up(node(from), application(from).cpu_thread).greatest() == sim::Duration() ? 0 : within;
    if (made.is_reliable && has_limits(made.history))
      made.writes.jitter =
          sum(made.writes.jitter, longest(made.config.qos.reliability.max_blocking_time.ps(), clock(from)), within);
    if (made.config.asynchronous) made.writes.jitter = sum(made.writes.jitter, made.waking);
    return made;
  }
  static ArrivalPattern times(ArrivalPattern pattern, std::int64_t n) {
    pattern.frames *= n;
    return pattern;
  }
  /// New samples on one stream, `copies` of each; `lives` of the writer.
  void add_samples(const ResolvedParticipant::Route* there, const ResolvedThread& thread, const Writing& writing,
                   std::int64_t copies, std::int64_t lives, std::uint32_t from) {
    if (!writing.is_controlled)
      return add(there, writing.offer.message,
                 FrameArrivals(times(writing.writes, copies * (writing.offer.fragments + (writing.fills ? 1 : 0)))));
    // Periods of the controller have whole messages only, of all writers of the topic together.
    const plant::FlowControl& flow = *r_.topics[thread.topic].description->flow_control;
    const Ps every = std::max<Ps>(1, shortest(flow.every.ps(), clock(from)));
    const Payload least = writing.offer.fragments > 1 ? least_sample_message
                                                      : least_sample_message + static_cast<Payload>(writing.octets);
    const std::int64_t sent = std::max<std::int64_t>(1, flow.octets / least) * (writing.fills ? 2 : 1);
    add(there, writing.offer.message, FrameArrivals({every, sent * lives, 0, sum(every, writing.waking, own_)}));
    add(there, control_message, FrameArrivals({every, sent * copies, 0, sum(every, writing.waking, own_)}));
  }

  /// To all who have joined the group: new samples, once; a HEARTBEAT in each period; past samples, if one reader is
  /// the first.
  void write_to_group(std::uint32_t from, const ResolvedThread& thread) {
    const ResolvedParticipant::Route* const group =
        route(from, dds::Locator::udp_v4(*participant(from).config.multicast_group, ports(from).multicast_user),
              thread.transport_priority);
    if (group == nullptr) return;
    std::int64_t readers = 0;
    for (const std::uint32_t to : members_)
      if (node(to) != node(from))
        for_each_reader(to, thread.topic, [&](const ResolvedThread&) { readers += lives(to); });
    if (readers == 0) return;
    const Writing writing = writing_of(from, thread);
    add_samples(group, thread, writing, lives(from), lives(from), from);
    if (!writing.is_reliable) return;
    rates_[{group->stream.value, control_message}].add({0, 0, lives(from)});
    if (writing.config.qos.durability.kind == dds::DurabilityKind::volatile_) return;
    if (writing.offer.samples < 0)
      return unknown(group, "whose writer of " + r_.topics[thread.topic].description->name +
                                " keeps any number of samples for readers that come later");
    rates_[{group->stream.value, std::min(writing.offer.message, greatest_message)}].add(
        Rates{lives(from) * readers, 0, 0}.times(writing.offer.samples * writing.offer.fragments +
                                                 (writing.fills ? 1 : 0)));
  }

  void write(std::uint32_t from, const ResolvedThread& thread, std::uint32_t to) {
    const scenario::ResolvedTopic& topic = r_.topics[thread.topic];
    const Writing writing = writing_of(from, thread);
    const auto& [config, history, offer, writes, fills, is_reliable, is_controlled, waking, octets] = writing;
    std::int64_t readers = 0;
    std::int64_t reliable = 0;
    std::vector<const ResolvedThread*> refusing;
    for_each_reader(to, thread.topic, [&](const ResolvedThread& reader) {
      ++readers;
      if (!writing.is_reliable || qos_of_reader(reader).reliability.kind != dds::ReliabilityKind::reliable) return;
      ++reliable;
      if (may_refuse(reader)) refusing.push_back(&reader);
    });
    const ResolvedParticipant::Route* const there = route(from, user(to), thread.transport_priority);
    if (readers == 0 || there == nullptr) return;

    // Each write, one message for each reader at most; none where samples go to a group, but from an asynchronous
    // writer to a reader that is behind the others.
    const std::int64_t copies = readers * lives(from) * lives(to);
    if (!participant(from).config.multicast_group || config.asynchronous)
      add_samples(there, thread, writing, copies, lives(from), from);
    // What an asynchronous writer has not sent yet may be replaced; a GAP says so.
    if (config.asynchronous) add(there, control_message, FrameArrivals(times(writes, copies)));
    if (reliable == 0) return;

    const bool sends_past = config.qos.durability.kind != dds::DurabilityKind::volatile_;
    if (sends_past && offer.samples < 0)
      return unknown(there, "whose writer of " + topic.description->name +
                                " keeps any number of samples for readers that come later");
    serve(there, offer, sends_past, false, reliable, from, to);
    for (const ResolvedThread* const reader : refusing)
      for (const auto& [message, count] : {std::pair(offer.message, offer.samples_in_an_answer()),
                                           std::pair(control_message, offer.gaps_in_an_answer())}) {
        FrameArrivals again = taking(to, *reader, count * lives(from) * lives(to), late_);
        if (!again.is_limited())
          return unknown(there, "which a reader of " + topic.description->name +
                                    " may refuse for its resource limits and ask for again and again");
        // What is asked for meanwhile goes together.
        if (!config.asynchronous && offer.samples >= 0 && repair_ > 0)
          again.add({repair_, count * lives(from) * lives(to), 0, 0});
        add(there, message, std::move(again));
      }
    if (!fills) return;
    // Each sample may fill it. Readers answer one response time after the other.
    const std::int64_t answered = reliable * lives(from) * lives(to);
    add(there, offer.message, FrameArrivals({response_, answered * offer.samples_in_an_answer(), 0, late_}));
    add(there, control_message, FrameArrivals({response_, answered * offer.gaps_in_an_answer(), 0, late_}));
  }

  /// ACKNACKs of a reader to all writers of its topic at the other participant.
  void read(std::uint32_t from, const ResolvedThread& thread, std::uint32_t to) {
    if (qos_of_reader(thread).reliability.kind != dds::ReliabilityKind::reliable) return;
    const ResolvedParticipant::Route* const there = route(from, user(to), 0);
    if (there == nullptr) return;
    for (const ResolvedThread& writer : application(to).threads) {
      if (writer.participant != to || !writer.publishes || writer.topic != thread.topic) continue;
      const dds::WriterConfig config = writer_config(r_.topics[writer.topic], writer);
      if (config.qos.reliability.kind != dds::ReliabilityKind::reliable) continue;
      const bool is_whole = application::Publication(r_.topics[thread.topic].shape, {}).next().size() + beside_sample <=
                                greatest_message &&
                            !config.asynchronous;
      const Payload message = is_whole ? control_message : greatest_message;
      add(there, message, acknowledgements(false), from, to);
      if (may_refuse(thread)) {
        FrameArrivals again = taking(from, thread, lives(from) * lives(to), 0);
        if (!again.is_limited())
          return unknown(there, "which acknowledges samples of " + r_.topics[thread.topic].description->name +
                                    " whenever one is taken that left no room");
        add(there, message, std::move(again));
      }
      const dds::HistorySettings history = history_of(config.qos);
      if (history.keep_all && has_limits(history))
        add(there, message, FrameArrivals({response_, lives(from) * lives(to), 0, late_}));
    }
  }

  void unknown(const ResolvedParticipant::Route* route, std::string why) {
    made_.unknown.emplace(route->stream.value, std::move(why));
  }

  const scenario::Resolved& r_;
  const BoundOptions& options_;
  const HostTimes& hosts_;
  std::vector<std::uint32_t> members_;
  DdsTraffic& made_;
  std::map<std::pair<std::uint32_t, Payload>, Rates> rates_;  // by stream and message
  std::int64_t greetings_ = 0;
  // In true time, at least:
  Ps period_ = unbounded_ps;  // of heartbeats
  Ps lease_ = unbounded_ps;
  Ps greeting_ = unbounded_ps;
  Ps response_ = unbounded_ps;  // between answers of a reader
  Ps repair_ = unbounded_ps;    // between answers of a writer
  Ps late_ = 0;                 // what answers, at most
  Ps own_ = 0;
};

}  // namespace

DdsTraffic dds_traffic(const scenario::Resolved& resolved, const BoundOptions& options, const HostTimes& hosts) {
  DdsTraffic made;
  if (!resolved.dds) return made;
  std::map<std::uint32_t, std::vector<std::uint32_t>> domains;
  for (std::uint32_t p = 0; p < resolved.dds->participants.size(); ++p)
    domains[resolved.dds->participants[p].config.domain].push_back(p);
  for (auto& [domain, members] : domains) DomainTraffic(resolved, options, hosts, std::move(members), made).make();
  std::erase_if(made.sources, [&](const DdsSource& source) { return made.unknown.contains(source.stream.value); });
  return made;
}

}  // namespace takt::analysis
