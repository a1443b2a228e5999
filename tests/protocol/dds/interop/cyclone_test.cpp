// SPDX-License-Identifier: Apache-2.0
// A participant of ours and one of Cyclone DDS, over real UDP sockets on the loopback interface: they find each other,
// and samples go both ways.
#include <gtest/gtest.h>

#ifdef TAKT_CYCLONE_PEER

#include <arpa/inet.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "dds/interop/sample.hpp"
#include "dds/participant/participant.hpp"

namespace takt::dds {
namespace {

using namespace test;
using namespace sim::literals;

constexpr std::uint32_t loopback = 0x7F000001;

/// A UDP socket on the loopback interface.
class Socket {
 public:
  explicit Socket(std::uint16_t port) : descriptor_(socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
    const sockaddr_in here = address(loopback, port);
    if (bind(descriptor_, reinterpret_cast<const sockaddr*>(&here), sizeof here) != 0)
      throw std::runtime_error("port " + std::to_string(port) + " is taken");
  }
  ~Socket() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  Socket(Socket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  int descriptor() const { return descriptor_; }
  void send(Octets octets, const Locator& to) const {
    const sockaddr_in there = address(to.ip_v4(), static_cast<std::uint16_t>(to.port));
    sendto(descriptor_, octets.data(), octets.size(), 0, reinterpret_cast<const sockaddr*>(&there), sizeof there);
  }
  /// The octets of the next datagram in the buffer; nothing if there is none.
  std::optional<std::pair<Octets, Locator>> receive(std::span<std::byte> buffer) const {
    sockaddr_in there{};
    socklen_t size = sizeof there;
    const ssize_t got =
        recvfrom(descriptor_, buffer.data(), buffer.size(), 0, reinterpret_cast<sockaddr*>(&there), &size);
    if (got < 0) return std::nullopt;
    return std::pair(Octets(buffer.first(static_cast<std::size_t>(got))),
                     Locator::udp_v4(ntohl(there.sin_addr.s_addr), ntohs(there.sin_port)));
  }

 private:
  static sockaddr_in address(std::uint32_t ip, std::uint16_t port) {
    sockaddr_in made{};
    made.sin_family = AF_INET;
    made.sin_port = htons(port);
    made.sin_addr.s_addr = htonl(ip);
    return made;
  }
  int descriptor_;
};

/// One of 80 domains below the ports that the system gives to others. It is held by a port that no participant here
/// uses, so that tests at the same time do not meet.
std::uint32_t domain() {
  constexpr std::uint32_t domains = 80, holder = 100;
  static std::uint32_t number = 0;
  static const Socket held = [] {
    for (std::uint32_t i = 0;; ++i) {
      number = 1 + (static_cast<std::uint32_t>(getpid()) + i) % domains;
      try {
        return Socket(ports_of(number, holder).unicast_metatraffic);
      } catch (const std::runtime_error&) {
        if (i == domains) throw;
      }
    }
  }();
  return number;
}

/// The participant with sockets and a clock.
class RealParticipant {
 public:
  explicit RealParticipant(const TimingProfile& timing, const DiscoveryProfile& profile)
      : participant_(config(timing, profile), now()),
        sockets_{Socket(participant_.ports().unicast_metatraffic), Socket(participant_.ports().unicast_user)} {}

  Participant& operator*() { return participant_; }
  Participant* operator->() { return &participant_; }
  sim::LocalTime now() const {
    const auto passed = std::chrono::steady_clock::now() - begin_;
    return sim::LocalTime::from_ps(std::chrono::duration_cast<std::chrono::nanoseconds>(passed).count() * 1000);
  }
  /// Lets messages come and go until `done`, at most 20 s; false if it never was.
  template <class Done>
  bool run_until(Done done) {
    for (const sim::LocalTime end = now() + 20_s; now() < end;) {
      send();
      if (done()) return true;
      std::array<pollfd, 2> watched{{{sockets_[0].descriptor(), POLLIN, 0}, {sockets_[1].descriptor(), POLLIN, 0}}};
      const sim::Duration left = std::min(participant_.next_wake(), now() + 10_ms) - now();
      poll(watched.data(), watched.size(), static_cast<int>(std::max<std::int64_t>(left / 1_ms, 0)));
      for (const Socket& socket : sockets_)
        while (const auto message = socket.receive(buffer_))
          participant_.receive(message->first, message->second, now());
      if (participant_.next_wake() <= now()) participant_.wake(now());
    }
    return false;
  }
  void send() {
    while (const auto datagram = participant_.next_datagram())
      for (const Locator& to : datagram->destinations) sockets_[1].send(datagram->octets, to);
    while (const auto event = participant_.next_event()) {
      if (event->kind == EventKind::matched) ++matched;
      if (event->kind == EventKind::participant_lost) ++lost;
      if (event->kind == EventKind::incompatible_qos) reasons += event->reason;
    }
  }
  int matched = 0;
  int lost = 0;
  std::string reasons;

 private:
  static ParticipantConfig config(const TimingProfile& timing, const DiscoveryProfile& profile) {
    ParticipantConfig made;
    made.domain = domain();
    made.participant = 20;  // Cyclone takes the lowest number that is free
    const auto process = static_cast<std::uint32_t>(getpid());
    made.prefix.octets = {0x01, 0xFA, static_cast<std::uint8_t>(process >> 16), static_cast<std::uint8_t>(process >> 8),
                          static_cast<std::uint8_t>(process)};
    made.address = loopback;
    made.timing = timing;
    made.epoch.seconds = static_cast<std::int32_t>(
        std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch()).count());
    made.discovery.emplace();
    made.discovery->profile = profile;
    for (std::uint32_t number = 0; number < 3; ++number)
      made.discovery->announce_to.push_back(Locator::udp_v4(loopback, ports_of(domain(), number).unicast_metatraffic));
    return made;
  }
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  Participant participant_;
  std::array<Socket, 2> sockets_;
  std::vector<std::byte> buffer_ = std::vector<std::byte>(65'536);
};

/// A process of the stock implementation: unicast on the loopback interface alone.
class Peer {
 public:
  explicit Peer(std::vector<std::string> arguments) {
    const std::string uri =
        "<CycloneDDS><Domain Id=\"" + std::to_string(domain()) +
        "\"><General><Interfaces><NetworkInterface address=\"127.0.0.1\" multicast=\"false\"/></Interfaces>"
        "<AllowMulticast>false</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex></"
        "Discovery></Domain></CycloneDDS>";
    setenv("CYCLONEDDS_URI", uri.c_str(), 1);
    arguments.insert(arguments.begin(), TAKT_CYCLONE_PEER);
    std::vector<char*> list;
    for (std::string& each : arguments) list.push_back(each.data());
    list.push_back(nullptr);
    if (posix_spawn(&process_, TAKT_CYCLONE_PEER, nullptr, nullptr, list.data(), environ) != 0)
      throw std::runtime_error("the peer does not start");
  }
  ~Peer() {
    if (!has_ended()) {
      kill(process_, SIGKILL);
      waitpid(process_, nullptr, 0);
    }
  }
  Peer(const Peer&) = delete;
  bool has_ended() {
    if (!ended_ && waitpid(process_, &status_, WNOHANG) == process_) ended_ = true;
    return ended_;
  }
  int exit_status() const { return ended_ && WIFEXITED(status_) ? WEXITSTATUS(status_) : -1; }

 private:
  pid_t process_ = 0;
  int status_ = 0;
  bool ended_ = false;
};

/// Both sides keep what they wrote for those who match later: two participants do not match at the same instant, and to
/// a volatile reader of Cyclone the first HEARTBEAT says that all before it is history.
WriterConfig writer_of(const std::string& topic) {
  WriterConfig config;
  config.topic = topic;
  config.type = interop_type;
  config.has_key = true;
  config.qos.durability.kind = DurabilityKind::transient_local;
  config.qos.history.kind = HistoryKind::keep_all;
  return config;
}
ReaderConfig reader_of(const std::string& topic) {
  ReaderConfig config;
  config.topic = topic;
  config.type = interop_type;
  config.has_key = true;
  config.qos.durability.kind = DurabilityKind::transient_local;
  config.qos.reliability.kind = ReliabilityKind::reliable;
  config.qos.history.kind = HistoryKind::keep_all;
  config.key_of = key_of_payload;
  return config;
}

/// Ping to the peer, which sends it back as pong.
void exchange(const TimingProfile& timing, const DiscoveryProfile& profile, std::int64_t count, std::size_t text_size) {
  RealParticipant ours(timing, profile);
  const auto ping = ours->create_writer(writer_of("Ping"), ours.now());
  const auto pong = ours->create_reader(reader_of("Pong"), ours.now());
  ASSERT_TRUE(ping && pong);
  Peer peer({"echo", "Ping", "Pong", std::to_string(count)});
  ASSERT_TRUE(ours.run_until([&] { return ours.matched >= 2; })) << "discovery: " << ours.reasons;
  std::vector<InteropSample> sent, got;
  for (std::int64_t i = 1; i <= count; ++i) {
    sent.push_back({static_cast<std::int32_t>(i % 3), i, std::string(text_size, static_cast<char>('a' + i % 26))});
    const auto result = ours->write(*ping.handle, key_of(sent.back().id), encode(sent.back()), ours.now());
    ASSERT_EQ(result.verdict, WriteVerdict::written) << result.reason;
  }
  const auto take = [&] {
    while (const auto sample = ours->take(*pong.handle, ours.now())) {
      if (!sample->info.valid_data) continue;  // the peer has taken leave
      EXPECT_EQ(sample->info.key, key_of_payload(PayloadKind::data, sample->payload));
      EXPECT_TRUE(decode(sample->payload, got.emplace_back()));
    }
    return got.size() >= sent.size();
  };
  EXPECT_TRUE(ours.run_until(take)) << got.size() << " came back";
  // Cyclone gives its application instance after instance, so what comes back is in the order of each instance.
  const auto by_instance = [](const InteropSample& a, const InteropSample& b) { return a.id < b.id; };
  std::stable_sort(got.begin(), got.end(), by_instance);
  std::stable_sort(sent.begin(), sent.end(), by_instance);
  EXPECT_TRUE(got == sent) << got.size() << " samples";
  EXPECT_TRUE(ours.run_until([&] { return peer.has_ended(); }));
  EXPECT_EQ(peer.exit_status(), 0);
  EXPECT_TRUE(ours.run_until([&] { return ours.lost == 1; })) << "it takes leave";
  EXPECT_EQ(ours->figures().verdicts[MessageStatus::malformed] + ours->figures().verdicts[MessageStatus::truncated],
            0u);
  EXPECT_EQ(ours->discovery()->figures().refused, 0u);
}

TEST(Cyclone, SamplesGoBothWays) { exchange(timing::fast_dds, discovery_profile::fast_dds, 20, 10); }
TEST(Cyclone, SamplesGoBothWaysAtItsOwnPace) { exchange(timing::cyclone, discovery_profile::cyclone, 20, 10); }
TEST(Cyclone, FragmentsGoBothWays) { exchange(timing::fast_dds, discovery_profile::fast_dds, 5, 30'000); }

TEST(Cyclone, TellsWhyItDoesNotMatch) {
  RealParticipant ours(timing::fast_dds, discovery_profile::fast_dds);
  WriterConfig best_effort = writer_of("Ping");
  best_effort.qos.reliability.kind = ReliabilityKind::best_effort;
  ASSERT_TRUE(ours->create_writer(best_effort, ours.now()));
  Peer peer({"subscribe", "Ping", "1"});
  EXPECT_TRUE(ours.run_until([&] { return !ours.reasons.empty(); }));
  EXPECT_EQ(ours.reasons, "reliability: offered BEST_EFFORT, requested RELIABLE");
}

}  // namespace
}  // namespace takt::dds

#else

TEST(Cyclone, SamplesGoBothWays) {
  GTEST_SKIP() << "Cyclone DDS was not installed when this was configured (Debian: cyclonedds-dev, cyclonedds-tools)";
}

#endif
