#include "scenario/applications/resolve_dds.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "dds/participant/participant.hpp"
#include "models/ethernet/sizes.hpp"
#include "scenario/applications/dds_port.hpp"
#include "scenario/json/suggest.hpp"

namespace takt::scenario {
namespace {

constexpr std::size_t most_participants = 64;   // of a domain: each pair has streams
constexpr std::uint32_t sample_headers = 20 + 12 + 24;  // RTPS header, INFO_TS, DATA

/// Priority and VLAN of topics.
using Class = std::pair<std::optional<std::uint8_t>, std::uint16_t>;

class DdsResolver {
 public:
  DdsResolver(Resolved& resolved, StreamBuilder& builder, json::Diagnostics& diagnostics) : r_(resolved), builder_(builder), diagnostics_(diagnostics) {}

  void run() {
    r_.dds = std::make_shared<ResolvedDds>();
    for (std::uint32_t a = 0; a < r_.applications.size(); ++a) add_participants(a);
    for (const auto& [domain, members] : domains_) {
      const std::size_t errors_before = diagnostics_.errors();
      set_classes(domain, members);
      probe(members);
      if (diagnostics_.errors() != errors_before) continue;
      set_discovery(domain, members);
      warn_of_mismatches(members);
      lay_streams(domain, members);
    }
    for (ResolvedParticipant& each : r_.dds->participants)
      std::sort(each.hears.begin(), each.hears.end(), [](const auto& a, const auto& b) { return a.stream < b.stream; });
  }

 private:
  using Members = std::vector<std::uint32_t>;   // participants
  ResolvedParticipant& participant(std::uint32_t number) { return r_.dds->participants[number]; }
  ResolvedApplication& application_of(std::uint32_t number) { return r_.applications[participant(number).application]; }
  std::uint32_t host_of(std::uint32_t number) { return application_of(number).node.value; }
  const Topic& topic_of(const ResolvedThread& thread) const { return *r_.topics[thread.topic].description; }
  const Domain* description_of(std::uint16_t domain) const {
    const auto found = std::find_if(r_.scenario.domains.begin(), r_.scenario.domains.end(), [&](const Domain& each) { return each.id == domain; });
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

  void add_participants(std::uint32_t a) {
    std::map<std::uint16_t, std::uint32_t> of_domain;
    for (ResolvedThread& thread : r_.applications[a].threads) {
      const Topic& topic = topic_of(thread);
      if (topic.protocol != Protocol::dds) continue;
      const std::uint16_t domain = topic.domain.value_or(0);
      const auto [found, is_new] = of_domain.try_emplace(domain, static_cast<std::uint32_t>(r_.dds->participants.size()));
      thread.participant = found->second;
      if (!is_new) continue;
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
        diagnostics_.error(r_.applications[a].where.place(), "too many participants in a domain", {std::to_string(most_participants + 1), "at most " + std::to_string(most_participants)});
      if (std::string problem = dds::port_problem(domain, r_.dds->participants.back().config.participant); !problem.empty())
        diagnostics_.error(topic.where.at("domain"), "a domain without ports", {problem, "a lower DomainId, or fewer participants on a host"});
    }
  }

  /// Samples of topics go with the topic's priority and VLAN. All else goes with them, too, if they are the same for the whole domain.
  void set_classes(std::uint16_t domain, const Members& members) {
    std::set<Class> classes;
    for (const std::uint32_t member : members)
      for (const std::uint32_t t : threads_of(member)) classes.insert(class_of(topic_of(application_of(member).threads[t])));
    classes_[domain] = {classes.begin(), classes.end()};
    for (const std::uint32_t member : members) {
      for (const std::uint32_t t : threads_of(member)) {
        ResolvedThread& thread = application_of(member).threads[t];
        const std::vector<Class>& all = classes_[domain];
        const auto at = std::find(all.begin(), all.end(), class_of(topic_of(thread))) - all.begin();
        thread.transport_priority = all.size() > 1 ? static_cast<std::int32_t>(at) + 1 : 0;
        const Topic& topic = topic_of(thread);
        if (topic.flow_control && thread.publishes) participant(member).config.flow_controllers.push_back({topic.name, dds::FlowScheduler::fifo, topic.flow_control->octets, topic.flow_control->every});
      }
    }
  }
  static Class class_of(const Topic& topic) { return {topic.pcp, topic.vlan}; }

  /// Makes all endpoints once, without a network: what contradicts itself is told, and what each has to say of itself is kept.
  void probe(const Members& members) {
    for (const std::uint32_t member : members) {
      dds::ParticipantConfig config = participant(member).config;
      config.prefix.octets[11] = static_cast<std::uint8_t>(member + 1);
      const ResolvedApplication& application = application_of(member);
      if (const auto problems = dds::problems_of(config); !problems.empty()) {
        for (const std::string& problem : problems) diagnostics_.error(application.where.place(), "settings of a participant that cannot be", {problem});
        continue;
      }
      dds::Participant made(config, {});
      dds::StaticParticipant known{application.name, {}, {}};
      for (const std::uint32_t t : threads_of(member)) {
        const ResolvedThread& thread = application.threads[t];
        std::vector<std::string> problems;
        if (thread.publishes) {
          const auto writer = made.create_writer(writer_config(r_.topics[thread.topic], thread), {});
          problems = writer.problems;
          if (writer.handle) known.publications.push_back(made.data_of(*writer.handle));
        } else {
          const auto reader = made.create_reader(reader_config(r_.topics[thread.topic], thread), {});
          problems = reader.problems;
          if (reader.handle) known.subscriptions.push_back(made.data_of(*reader.handle));
        }
        for (const std::string& problem : problems) diagnostics_.error(thread.where.place(), "quality of service that cannot be", {problem, "policies that fit each other"});
      }
      known_[member] = std::move(known);
    }
  }

  void set_discovery(std::uint16_t domain, const Members& members) {
    const Domain* const description = description_of(domain);
    const Discovery kind = description != nullptr ? description->discovery : Discovery::simple;
    dds::DiscoverySettings settings;
    if (description != nullptr && description->announce_every) settings.profile.announcement_period = *description->announce_every;
    if (description != nullptr && description->lease_duration) settings.profile.lease_duration = *description->lease_duration;
    if (settings.profile.lease_duration <= settings.profile.announcement_period)
      diagnostics_.error(description->where.at(description->lease_duration ? "lease_duration" : "announce_every"), "a lease that ends between two announcements",
                         {json::to_text(settings.profile.lease_duration), "more than " + json::to_text(settings.profile.announcement_period)});
    if (kind == Discovery::server) {
      set_server(*description, members, settings);
      return;
    }
    for (const std::uint32_t member : members) {
      participant(member).config.discovery = settings;
      if (kind == Discovery::simple) continue;
      participant(member).config.discovery->kind = dds::DiscoveryKind::static_;
      for (const std::uint32_t other : members)
        if (other != member) participant(member).config.discovery->participants.push_back(known_[other]);
    }
  }

  void set_server(const Domain& domain, const Members& members, const dds::DiscoverySettings& settings) {
    const auto server = std::find_if(members.begin(), members.end(), [&](std::uint32_t member) { return application_of(member).name == domain.server; });
    if (server == members.end()) {
      std::vector<std::string_view> names;
      for (const std::uint32_t member : members) names.push_back(application_of(member).name);
      diagnostics_.error(domain.where.at("server"), "a server that is not in the domain",
                         {json::quote(domain.server.value_or("")), "an application with a topic of the domain", json::suggest(domain.server.value_or(""), names)});
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
        for (const dds::PublicationData& publication : known_[from].publications)
          for (const dds::SubscriptionData& subscription : known_[to].subscriptions) {
            const dds::Matching matching = dds::match(publication, subscription);
            if (from == to || matching.is_match() || matching.relation == dds::Relation::other_topic) continue;
            diagnostics_.warning(application_of(to).where.at("threads"), "quality of service that does not match",
                                 {json::quote(publication.endpoint.topic_name) + " from " + application_of(from).name + " to " + application_of(to).name + ": " + matching.reason});
          }
  }

  dds::Ports ports(std::uint32_t member) { return dds::ports_of(participant(member).config.domain, participant(member).config.participant); }
  std::uint16_t metatraffic_port(std::uint32_t member) { return participant(member).config.metatraffic_port.value_or(ports(member).unicast_metatraffic); }

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
      for (const std::uint32_t to : members) {
        if (host_of(to) == host_of(from)) continue;
        const std::string pair = name + "/" + application_of(to).name;
        if (!by_server || from == server_ || to == server_)
          add(pair + "/discovery", from, {to}, dds::Locator::udp_v4(participant(to).config.address, metatraffic_port(to)), metatraffic_port(from), base, 0, {});
        lay_user_streams(pair, domain, base, from, to);
      }
    }
  }

  /// Of samples one way, of acknowledgements the other.
  void lay_user_streams(const std::string& pair, std::uint16_t domain, const Class& base, std::uint32_t from, std::uint32_t to) {
    const dds::Locator user = dds::Locator::udp_v4(participant(to).config.address, ports(to).unicast_user);
    std::map<Class, StreamDemand> samples;
    bool answers = false;
    for (const std::uint32_t a : threads_of(from)) {
      for (const std::uint32_t b : threads_of(to)) {
        const ResolvedThread& one = application_of(from).threads[a];
        const ResolvedThread& other = application_of(to).threads[b];
        if (one.topic != other.topic || one.publishes == other.publishes) continue;
        if (!one.publishes) {
          answers = true;
          continue;
        }
        StreamDemand& demand = samples[class_of(topic_of(one))];
        const double per_second = 1e12 / static_cast<double>(one.every.ps());
        const auto payload = static_cast<std::uint32_t>(CdrLayout(r_.topics[one.topic].layout).octets());
        demand.frames_per_second += per_second;
        demand.wire_bits_per_second +=
            per_second * 8.0 *
            models::wire_length(models::frame_length(models::ipv4_and_udp_headers + Octets{std::min<std::uint32_t>(sample_headers + payload, 1472)}, topic_of(one).pcp.has_value())).count;
      }
    }
    if (samples.empty() && !answers) return;
    const auto of_base = samples.find(base);
    add(pair, from, {to}, user, ports(from).unicast_user, base, 0, of_base != samples.end() ? of_base->second : StreamDemand{});
    const std::vector<Class>& classes = classes_[domain];
    for (std::size_t c = 0; classes.size() > 1 && c < classes.size(); ++c) {
      const auto found = samples.find(classes[c]);
      if (found == samples.end()) continue;
      const std::string which = classes[c].first ? "pcp" + std::to_string(*classes[c].first) + "-vlan" + std::to_string(classes[c].second) : std::string("untagged");
      add(pair + "/" + which, from, {to}, user, ports(from).unicast_user, classes[c], static_cast<std::int32_t>(c) + 1, found->second);
    }
  }

  void add(const std::string& name, std::uint32_t from, const Members& to, const dds::Locator& locator, std::uint16_t source_port, const Class& traffic, std::int32_t transport_priority,
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
    for (const std::uint32_t each : to) participant(each).hears.push_back({*index, dds::Locator::udp_v4(participant(from).config.address, source_port)});
  }

  Resolved& r_;
  StreamBuilder& builder_;
  json::Diagnostics& diagnostics_;
  std::map<std::uint16_t, Members> domains_;
  std::map<std::uint16_t, std::vector<Class>> classes_;
  std::map<std::uint32_t, dds::StaticParticipant> known_;
  std::uint32_t server_ = 0;
};

}  // namespace

void resolve_dds(Resolved& resolved, StreamBuilder& builder, json::Diagnostics& diagnostics) { DdsResolver(resolved, builder, diagnostics).run(); }

}  // namespace takt::scenario
