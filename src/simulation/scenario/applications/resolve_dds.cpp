// SPDX-License-Identifier: Apache-2.0
#include "scenario/applications/resolve_dds.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "application/topic_values.hpp"
#include "dds/participant/participant.hpp"
#include "json/suggest.hpp"
#include "models/ethernet/sizes.hpp"
#include "scenario/applications/dds_port.hpp"
#include "scenario/applications/qos_places.hpp"

namespace takt::scenario {
namespace {

constexpr std::size_t most_participants = 64;           // of a domain: each pair has streams
constexpr std::uint32_t sample_headers = 20 + 12 + 24;  // RTPS header, INFO_TS, DATA

/// Priority and VLAN of topics.
using Class = std::pair<std::optional<std::uint8_t>, std::uint16_t>;

class DdsResolver {
 public:
  DdsResolver(Resolved& resolved, StreamBuilder& builder, json::Diagnostics& diagnostics)
      : r_(resolved), builder_(builder), diagnostics_(diagnostics) {}

  void run() {
    r_.dds = std::make_shared<ResolvedDds>();
    for (std::uint32_t a = 0; a < r_.applications.size(); ++a) add_participants(a);
    for (const auto& [domain, members] : domains_) {
      const std::size_t errors_before = diagnostics_.errors();
      set_classes(domain, members);
      set_multicast(domain, members);
      probe(members);
      if (diagnostics_.errors() != errors_before) continue;
      set_discovery(domain, members);
      warn_of_mismatches(members);
      warn_of_lonely_partitions(members);
      lay_streams(domain, members);
    }
    for (ResolvedParticipant& each : r_.dds->participants)
      std::sort(each.hears.begin(), each.hears.end(), [](const auto& a, const auto& b) { return a.stream < b.stream; });
  }

 private:
  using Members = std::vector<std::uint32_t>;  // participants
  /// What a participant says of its endpoints, and where its file says it.
  struct Known {
    dds::StaticParticipant endpoints;
    std::vector<QosSources> writers;  // by publication
    std::vector<QosSources> readers;  // by subscription
    void add(const dds::PublicationData& data, const QosSources& sources) {
      endpoints.publications.push_back(data);
      writers.push_back(sources);
    }
    void add(const dds::SubscriptionData& data, const QosSources& sources) {
      endpoints.subscriptions.push_back(data);
      readers.push_back(sources);
    }
  };
  ResolvedParticipant& participant(std::uint32_t number) { return r_.dds->participants[number]; }
  ResolvedApplication& application_of(std::uint32_t number) { return r_.applications[participant(number).application]; }
  std::uint32_t host_of(std::uint32_t number) { return application_of(number).node.value; }
  const Topic& topic_of(const ResolvedThread& thread) const { return *r_.topics[thread.topic].description; }
  const Topic& topic_of(const ResolvedService::Kept& kept) const { return *r_.topics[kept.topic].description; }
  const Domain* description_of(std::uint16_t domain) const {
    const auto found = std::find_if(r_.scenario.domains.begin(), r_.scenario.domains.end(),
                                    [&](const Domain& each) { return each.id == domain; });
    return found == r_.scenario.domains.end() ? nullptr : &*found;
  }
  /// Its threads in that participant.
  std::vector<std::uint32_t> threads_of(std::uint32_t number) {
    std::vector<std::uint32_t> threads;
    const ResolvedApplication& application = application_of(number);
    for (std::uint32_t t = 0; t < application.threads.size(); ++t)
      if (application.threads[t].participant == number) threads.push_back(t);
    return threads;
  }

  /// The topics that a persistence service keeps as that participant.
  std::vector<ResolvedService::Kept*> kept_by(std::uint32_t number) {
    std::vector<ResolvedService::Kept*> all;
    if (auto& service = application_of(number).service)
      for (ResolvedService::Kept& kept : service->topics)
        if (kept.participant == number) all.push_back(&kept);
    return all;
  }

  void add_participants(std::uint32_t a) {
    std::map<std::uint16_t, std::uint32_t> of_domain;
    for (ResolvedThread& thread : r_.applications[a].threads)
      if (topic_of(thread).protocol == Protocol::dds)
        thread.participant = participant_for(a, topic_of(thread), of_domain);
    if (auto& service = r_.applications[a].service)
      for (ResolvedService::Kept& kept : service->topics)
        kept.participant = participant_for(a, topic_of(kept), of_domain);
  }

  std::uint32_t participant_for(std::uint32_t a, const Topic& topic,
                                std::map<std::uint16_t, std::uint32_t>& of_domain) {
    const std::uint16_t domain = topic.domain.value_or(0);
    const auto [found, is_new] = of_domain.try_emplace(domain, static_cast<std::uint32_t>(r_.dds->participants.size()));
    if (!is_new) return found->second;
    ResolvedParticipant made;
    made.application = a;
    made.config.domain = domain;
    made.config.address = 10U << 24 | (r_.applications[a].node.value + 1);
    made.config.name = r_.applications[a].name;
    for (const std::uint32_t other : domains_[domain])
      if (host_of(other) == r_.applications[a].node.value) ++made.config.participant;
    r_.dds->participants.push_back(std::move(made));
    domains_[domain].push_back(found->second);
    if (domains_[domain].size() == most_participants + 1)
      diagnostics_.error(r_.applications[a].where.place(), "too many participants in a domain",
                         {std::to_string(most_participants + 1), "at most " + std::to_string(most_participants)});
    if (std::string problem = dds::port_problem(domain, r_.dds->participants.back().config.participant);
        !problem.empty())
      diagnostics_.error(topic.where.at("domain"), "a domain without ports",
                         {problem, "a lower DomainId, or fewer participants on a host"});
    return found->second;
  }

  /// Samples of topics go with the topic's priority and VLAN. All else goes with them, too, if they are the same for
  /// the whole domain.
  void set_classes(std::uint16_t domain, const Members& members) {
    std::set<Class> classes;
    for (const std::uint32_t member : members)
      for (const std::uint32_t t : threads_of(member))
        classes.insert(class_of(topic_of(application_of(member).threads[t])));
    for (const std::uint32_t member : members)
      for (const ResolvedService::Kept* const kept : kept_by(member)) classes.insert(class_of(topic_of(*kept)));
    classes_[domain] = {classes.begin(), classes.end()};
    for (const std::uint32_t member : members) {
      for (const std::uint32_t t : threads_of(member)) {
        ResolvedThread& thread = application_of(member).threads[t];
        const Topic& topic = topic_of(thread);
        thread.transport_priority = transport_priority_of(domain, topic);
        if (topic.flow_control && thread.publishes)
          participant(member).config.flow_controllers.push_back(
              {topic.name, dds::FlowScheduler::fifo, topic.flow_control->octets, topic.flow_control->every});
      }
      for (ResolvedService::Kept* const kept : kept_by(member))
        kept->transport_priority = transport_priority_of(domain, topic_of(*kept));
    }
  }
  std::int32_t transport_priority_of(std::uint16_t domain, const Topic& topic) {
    const std::vector<Class>& all = classes_[domain];
    const auto at = std::find(all.begin(), all.end(), class_of(topic)) - all.begin();
    return all.size() > 1 ? static_cast<std::int32_t>(at) + 1 : 0;
  }
  bool is_multicast(std::uint16_t domain) const {
    const Domain* const description = description_of(domain);
    return description != nullptr && description->multicast;
  }
  void set_multicast(std::uint16_t domain, const Members& members) {
    if (!is_multicast(domain)) return;
    for (const std::uint32_t member : members) {
      participant(member).config.multicast_group = dds::discovery_group;
      participant(member).config.multicast_to_one = true;
    }
  }
  static Class class_of(const Topic& topic) { return {topic.pcp, topic.vlan}; }

  /// Makes all endpoints once, without a network: what contradicts itself is told, and what each has to say of itself
  /// is kept.
  void probe(const Members& members) {
    for (const std::uint32_t member : members) {
      dds::ParticipantConfig config = participant(member).config;
      config.prefix.octets[11] = static_cast<std::uint8_t>(member + 1);
      const ResolvedApplication& application = application_of(member);
      if (const auto problems = dds::problems_of(config); !problems.empty()) {
        for (const std::string& problem : problems)
          diagnostics_.error(application.where.place(), "settings of a participant that cannot be", {problem});
        continue;
      }
      dds::Participant made(config, {});
      Known& known = known_[member];
      known.endpoints.name = application.name;
      for (const std::uint32_t t : threads_of(member)) probe(application.threads[t], made, known);
      dds::MemoryStorage storage;
      dds::PersistenceService service(made, storage, config.prefix);
      for (const ResolvedService::Kept* const kept : kept_by(member)) probe(*kept, made, service, known);
    }
  }

  void probe(const ResolvedService::Kept& kept, dds::Participant& made, dds::PersistenceService& service,
             Known& known) {
    const auto& of_topic = topic_of(kept).qos;
    const QosSources sources{nullptr, of_topic ? &*of_topic : nullptr, kept.where};
    const dds::DurableTopic topic = durable_topic(r_.topics[kept.topic], kept);
    const std::vector<std::string> problems = service.add(topic, {});
    report(problems, sources);
    if (!problems.empty()) return;
    known.add(made.data_of(*service.writer_of(topic.topic)), sources);
    known.add(made.data_of(*service.reader_of(topic.topic)), sources);
  }

  void probe(const ResolvedThread& thread, dds::Participant& made, Known& known) {
    const QosSources sources = sources_of(thread);
    if (thread.publishes) {
      const auto writer = made.create_writer(writer_config(r_.topics[thread.topic], thread), {});
      report(writer.problems, sources);
      if (writer) known.add(made.data_of(*writer.handle), sources);
    } else {
      const auto reader = made.create_reader(reader_config(r_.topics[thread.topic], thread), {});
      report(reader.problems, sources);
      if (reader) known.add(made.data_of(*reader.handle), sources);
    }
  }

  QosSources sources_of(const ResolvedThread& thread) const {
    const auto& of_topic = topic_of(thread).qos;
    return {thread.own_qos, of_topic ? &*of_topic : nullptr, thread.where.place()};
  }

  /// What a topic says wrong concerns each of its threads, and is said once.
  void report(const std::vector<std::string>& problems, const QosSources& sources) {
    for (const std::string& problem : problems) {
      json::Place place = place_of_problem(sources, problem);
      if (reported_.insert({place.pointer, problem}).second)
        diagnostics_.error(std::move(place), "quality of service that cannot be",
                           {problem, "policies that fit each other"});
    }
  }

  void set_discovery(std::uint16_t domain, const Members& members) {
    const Domain* const description = description_of(domain);
    const Discovery kind = description != nullptr ? description->discovery : Discovery::simple;
    dds::DiscoverySettings settings;
    if (description != nullptr && description->announce_every)
      settings.profile.announcement_period = *description->announce_every;
    if (description != nullptr && description->lease_duration)
      settings.profile.lease_duration = *description->lease_duration;
    if (settings.profile.lease_duration <= settings.profile.announcement_period)
      diagnostics_.error(description->where.at(description->lease_duration ? "lease_duration" : "announce_every"),
                         "a lease that ends between two announcements",
                         {json::to_text(settings.profile.lease_duration),
                          "more than " + json::to_text(settings.profile.announcement_period)});
    if (kind == Discovery::server) {
      set_server(*description, members, settings);
      return;
    }
    for (const std::uint32_t member : members) {
      participant(member).config.discovery = settings;
      if (kind == Discovery::simple) continue;
      participant(member).config.discovery->kind = dds::DiscoveryKind::static_;
      for (const std::uint32_t other : members)
        if (other != member) participant(member).config.discovery->participants.push_back(known_[other].endpoints);
    }
  }

  void set_server(const Domain& domain, const Members& members, const dds::DiscoverySettings& settings) {
    const auto server = std::find_if(members.begin(), members.end(), [&](std::uint32_t member) {
      return application_of(member).name == domain.server;
    });
    if (server == members.end()) {
      std::vector<std::string_view> names;
      for (const std::uint32_t member : members) names.push_back(application_of(member).name);
      diagnostics_.error(domain.where.at("server"), "a server that is not in the domain",
                         {json::quote(domain.server.value_or("")), "an application with a topic of the domain",
                          json::suggest(domain.server.value_or(""), names)});
      return;
    }
    server_ = *server;
    const dds::Locator address = dds::Locator::udp_v4(participant(*server).config.address, dds::discovery_server_port);
    for (const std::uint32_t member : members) {
      dds::ParticipantConfig& config = participant(member).config;
      config.discovery = settings;
      config.discovery->kind = member == *server ? dds::DiscoveryKind::server : dds::DiscoveryKind::client;
      if (member == *server)
        config.metatraffic_port = static_cast<std::uint16_t>(dds::discovery_server_port);
      else
        config.discovery->servers = {address};
    }
  }

  void warn_of_mismatches(const Members& members) {
    for (const std::uint32_t from : members)
      for (const std::uint32_t to : members)
        if (from != to) warn_of_mismatches(known_[from], known_[to]);
  }
  /// Those that are no accident: different partitions keep apart what is meant to be apart, and a service has nothing
  /// to say to readers that do not ask for it.
  static std::vector<dds::Mismatch> mismatches_of(const dds::PublicationData& writer,
                                                  const dds::SubscriptionData& reader) {
    if (!dds::have_common_partition(writer.qos.partition, reader.qos.partition)) return {};
    return dds::match(writer, reader).mismatches;
  }

  /// A partition in which a writer meets no reader, or a reader no writer, of the topic.
  void warn_of_lonely_partitions(const Members& members) {
    for (const std::uint32_t member : members) {
      const auto lonely = [&](const auto& data, const auto& others_of) {
        if (data.qos.partition.names.empty()) return false;
        bool has_others = false;
        for (const std::uint32_t other : members)
          for (const auto& remote : others_of(known_[other].endpoints)) {
            if (other == member || remote.endpoint.topic_name != data.endpoint.topic_name) continue;
            has_others = true;
            if (dds::have_common_partition(data.qos.partition, remote.qos.partition)) return false;
          }
        return has_others;
      };
      const auto warn = [&](const QosSources& sources, const std::string& topic, std::string_view whom) {
        diagnostics_.warning(place_of_policy(sources, "partition"), "a partition without " + std::string(whom),
                             {json::quote(topic), "a name in common with a " + std::string(whom).substr(2)});
      };
      const Known& known = known_[member];
      for (std::size_t w = 0; w < known.writers.size(); ++w)
        if (lonely(
                known.endpoints.publications[w],
                [](const dds::StaticParticipant& p) -> const auto& { return p.subscriptions; }))
          warn(known.writers[w], known.endpoints.publications[w].endpoint.topic_name, "a reader");
      for (std::size_t r = 0; r < known.readers.size(); ++r)
        if (lonely(
                known.endpoints.subscriptions[r],
                [](const dds::StaticParticipant& p) -> const auto& { return p.publications; }))
          warn(known.readers[r], known.endpoints.subscriptions[r].endpoint.topic_name, "a writer");
    }
  }

  void warn_of_mismatches(const Known& from, const Known& to) {
    for (std::size_t w = 0; w < from.writers.size(); ++w) {
      const dds::PublicationData& writer = from.endpoints.publications[w];
      const std::string who =
          json::quote(writer.endpoint.topic_name) + " from " + from.endpoints.name + " to " + to.endpoints.name + ": ";
      for (std::size_t r = 0; r < to.readers.size(); ++r)
        for (const dds::Mismatch& mismatch : mismatches_of(writer, to.endpoints.subscriptions[r]))
          diagnostics_.warning(place_of_mismatch(to.readers[r], from.writers[w], mismatch),
                               "quality of service that does not match",
                               {who + std::string(dds::name_of(mismatch.policy)) + ": " + mismatch.reason});
    }
  }

  dds::Ports ports(std::uint32_t member) {
    return dds::ports_of(participant(member).config.domain, participant(member).config.participant);
  }
  std::uint16_t metatraffic_port(std::uint32_t member) {
    return participant(member).config.metatraffic_port.value_or(ports(member).unicast_metatraffic);
  }

  void lay_streams(std::uint16_t domain, const Members& members) {
    const Domain* const description = description_of(domain);
    const bool by_server = description != nullptr && description->discovery == Discovery::server;
    const std::string prefix = "rtps-" + std::to_string(domain) + "/";
    const Class base = classes_[domain].size() == 1 ? classes_[domain].front() : Class{};
    for (const std::uint32_t from : members) {
      const std::string name = prefix + application_of(from).name;
      if (!by_server) {
        Members others;
        for (const std::uint32_t to : members)
          if (host_of(to) != host_of(from)) others.push_back(to);
        const dds::Locator everybody = dds::Locator::udp_v4(dds::discovery_group, ports(from).multicast_metatraffic);
        add(name + "/discovery", from, others, everybody, metatraffic_port(from), base, 0, {});
      }
      if (is_multicast(domain)) lay_group_streams(name, domain, base, from, members);
      for (const std::uint32_t to : members) {
        if (host_of(to) == host_of(from)) continue;
        const std::string pair = name + "/" + application_of(to).name;
        if (!by_server || from == server_ || to == server_)
          add(pair + "/discovery", from, {to},
              dds::Locator::udp_v4(participant(to).config.address, metatraffic_port(to)), metatraffic_port(from), base,
              0, {});
        lay_user_streams(pair, domain, base, from, to);
      }
    }
  }

  /// A writer or reader of a participant.
  struct Use {
    std::uint32_t topic = 0;
    bool publishes = false;
    double per_second = 0;  // samples that it writes
  };
  std::vector<Use> uses_of(std::uint32_t number) {
    std::vector<Use> uses;
    for (const std::uint32_t t : threads_of(number)) {
      const ResolvedThread& thread = application_of(number).threads[t];
      uses.push_back({thread.topic, thread.publishes, rate_of(thread)});
    }
    for (const ResolvedService::Kept* const kept : kept_by(number)) {
      // What it hears it writes, at once, to the readers that ask for it.
      double heard = 0;
      for (const ResolvedApplication& application : r_.applications)
        for (const ResolvedThread& thread : application.threads)
          if (thread.topic == kept->topic && thread.publishes) heard += rate_of(thread);
      uses.push_back({kept->topic, false, 0});
      uses.push_back({kept->topic, true, heard});
    }
    return uses;
  }
  static double rate_of(const ResolvedThread& thread) {
    return thread.publishes ? 1e12 / static_cast<double>(thread.every.ps()) : 0;
  }

  /// What a participant writes to that topic.
  void add_demand(const Use& writer, StreamDemand& demand) {
    const Topic& topic = *r_.topics[writer.topic].description;
    const auto payload =
        static_cast<std::uint32_t>(application::Publication(r_.topics[writer.topic].shape, {}).next().size());
    const Octets message{std::min<std::uint32_t>(sample_headers + payload, 1472)};
    demand.frames_per_second += writer.per_second;
    demand.wire_bits_per_second +=
        writer.per_second * 8.0 *
        models::wire_length(models::frame_length(models::ipv4_and_udp_headers + message, topic.pcp.has_value())).count;
  }

  /// Of samples one way, of acknowledgements the other. New samples that go to a group are none of their demand.
  void lay_user_streams(const std::string& pair, std::uint16_t domain, const Class& base, std::uint32_t from,
                        std::uint32_t to) {
    const dds::Locator user = dds::Locator::udp_v4(participant(to).config.address, ports(to).unicast_user);
    std::map<Class, StreamDemand> samples;
    bool answers = false;
    for (const Use& one : uses_of(from)) {
      for (const Use& other : uses_of(to)) {
        if (one.topic != other.topic || one.publishes == other.publishes) continue;
        if (!one.publishes) {
          answers = true;
          continue;
        }
        StreamDemand& demand = samples[class_of(*r_.topics[one.topic].description)];
        if (!is_multicast(domain)) add_demand(one, demand);
      }
    }
    if (samples.empty() && !answers) return;
    const auto of_base = samples.find(base);
    add(pair, from, {to}, user, ports(from).unicast_user, base, 0,
        of_base != samples.end() ? of_base->second : StreamDemand{});
    add_of_classes(pair, domain, from, {to}, user, samples);
  }

  /// New samples for all who have joined the group: the participants with readers, whatever they read.
  void lay_group_streams(const std::string& name, std::uint16_t domain, const Class& base, std::uint32_t from,
                         const Members& members) {
    Members others;
    std::set<std::uint32_t> read;
    for (const std::uint32_t to : members) {
      if (host_of(to) == host_of(from)) continue;
      bool reads = false;
      for (const Use& use : uses_of(to)) {
        if (use.publishes) continue;
        reads = true;
        read.insert(use.topic);
      }
      if (reads) others.push_back(to);
    }
    std::map<Class, StreamDemand> samples;
    for (const Use& use : uses_of(from))
      if (use.publishes && read.contains(use.topic))
        add_demand(use, samples[class_of(*r_.topics[use.topic].description)]);
    if (samples.empty()) return;
    const dds::Locator group = dds::Locator::udp_v4(dds::discovery_group, ports(from).multicast_user);
    if (classes_[domain].size() == 1)
      add(name + "/samples", from, others, group, ports(from).unicast_user, base, 0, samples.begin()->second);
    add_of_classes(name + "/samples", domain, from, others, group, samples);
  }

  /// Where topics of a domain differ in priority or VLAN, each of these has a stream of its own.
  void add_of_classes(const std::string& name, std::uint16_t domain, std::uint32_t from, const Members& to,
                      const dds::Locator& locator, const std::map<Class, StreamDemand>& samples) {
    const std::vector<Class>& classes = classes_[domain];
    for (std::size_t c = 0; classes.size() > 1 && c < classes.size(); ++c) {
      const auto found = samples.find(classes[c]);
      if (found == samples.end()) continue;
      const std::string which =
          classes[c].first ? "pcp" + std::to_string(*classes[c].first) + "-vlan" + std::to_string(classes[c].second)
                           : std::string("untagged");
      add(name + "/" + which, from, to, locator, ports(from).unicast_user, classes[c], static_cast<std::int32_t>(c) + 1,
          found->second);
    }
  }

  void add(const std::string& name, std::uint32_t from, const Members& to, const dds::Locator& locator,
           std::uint16_t source_port, const Class& traffic, std::int32_t transport_priority,
           const StreamDemand& demand) {
    if (to.empty()) return;
    NewStream wanted;
    wanted.name = name;
    wanted.where = application_of(from).where;
    wanted.from = host_of(from);
    std::set<std::uint32_t> hosts;
    for (const std::uint32_t each : to)
      if (hosts.insert(host_of(each)).second) wanted.to.push_back({host_of(each), application_of(each).where.at("on")});
    wanted.priority = traffic.first;
    wanted.vlan = traffic.second;
    wanted.headers = models::ipv4_and_udp_headers;
    wanted.payload = Octets{1472};
    wanted.is_group = locator.is_multicast();
    wanted.ip_group = locator.is_multicast() ? locator.ip_v4() : 0;
    wanted.udp_port = static_cast<std::uint16_t>(locator.port);
    wanted.udp_source_port = source_port;
    const auto index = builder_.add(wanted);
    if (!index) return;
    r_.streams[index->value].demand = demand;
    participant(from).routes.push_back({locator, transport_priority, *index});
    for (const std::uint32_t each : to)
      participant(each).hears.push_back({*index, dds::Locator::udp_v4(participant(from).config.address, source_port)});
  }

  Resolved& r_;
  StreamBuilder& builder_;
  json::Diagnostics& diagnostics_;
  std::map<std::uint16_t, Members> domains_;
  std::map<std::uint16_t, std::vector<Class>> classes_;
  std::map<std::uint32_t, Known> known_;
  std::set<std::pair<std::string, std::string>> reported_;  // places and problems
  std::uint32_t server_ = 0;
};

}  // namespace

void resolve_dds(Resolved& resolved, StreamBuilder& builder, json::Diagnostics& diagnostics) {
  DdsResolver(resolved, builder, diagnostics).run();
}

}  // namespace takt::scenario
