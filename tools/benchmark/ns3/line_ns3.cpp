// SPDX-License-Identifier: Apache-2.0
// The line benchmark in ns-3: host A - 5 switches - host B, 1 Gb/s, 50 ns of cable a link; from A to B a UDP stream of
// 100 B of payload every 200 us and one of 1000 B every 20 us.
//
//   takt_bench_ns3 [SECONDS]        seconds to simulate, 10 unless given
//
// It prints one line of JSON; the CPU time is that of Simulator::Run alone. A frame-hop is one frame crossing one link.
// The exit status is 1 if a frame is missing at B: then the frame-hops would not be what they say.
//
// All that ns-3 does not need for this traffic is left out, so that the comparison is fair to it: no tracing, IPv4
// only, static routes, no queue disciplines, no ARP, and senders and receiver that only send and count. Two things
// remain when the numbers are read: Debian builds ns-3 optimised but with logging compiled in (an ns-3.37 without it
// and with -march=native ran this 1.55 times as fast), and about a quarter of the time goes into UDP and IPv4 in the
// two hosts.
#include <ns3/arp-cache.h>
#include <ns3/bridge-helper.h>
#include <ns3/csma-helper.h>
#include <ns3/csma-net-device.h>
#include <ns3/internet-stack-helper.h>
#include <ns3/ipv4-interface.h>
#include <ns3/ipv4-l3-protocol.h>
#include <ns3/ipv4-static-routing-helper.h>
#include <ns3/node-container.h>
#include <ns3/object-factory.h>
#include <ns3/packet.h>
#include <ns3/simulator.h>
#include <ns3/udp-socket-factory.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

namespace {

constexpr std::uint32_t switch_count = 5;
constexpr std::uint32_t links_on_path = switch_count + 1;
constexpr std::uint16_t port = 4840;
constexpr double longest_s = 1e6;

struct Host {
  ns3::Ptr<ns3::Node> node;
  ns3::Ptr<ns3::NetDevice> device;
  ns3::Ipv4Address address;
};

struct Line {
  Host a;
  Host b;
};

Line build_line();
void give_address(const Host& host);
void know_neighbour(const Host& host, const Host& neighbour);
double cpu_now_s();
double seconds_from(int argc, char** argv);

/// Sends one frame every `period` while simulated time is below `end`.
class Sender {
 public:
  Sender(const Host& from, const Host& to, std::uint32_t payload_bytes, ns3::Time period, ns3::Time end)
      : socket_(ns3::Socket::CreateSocket(from.node, ns3::UdpSocketFactory::GetTypeId())),
        payload_bytes_(payload_bytes),
        period_(period),
        end_(end) {
    socket_->Connect(ns3::InetSocketAddress(to.address, port));
    ns3::Simulator::ScheduleWithContext(from.node->GetId(), ns3::Time(0), &Sender::send, this);
  }

  std::uint64_t sent() const { return sent_; }

 private:
  void send() {
    if (socket_->Send(ns3::Create<ns3::Packet>(payload_bytes_)) == static_cast<int>(payload_bytes_)) ++sent_;
    if (ns3::Simulator::Now() + period_ < end_) ns3::Simulator::Schedule(period_, &Sender::send, this);
  }

  ns3::Ptr<ns3::Socket> socket_;
  std::uint32_t payload_bytes_;
  ns3::Time period_;
  ns3::Time end_;
  std::uint64_t sent_ = 0;
};

/// Counts what arrives at a host.
class Receiver {
 public:
  explicit Receiver(const Host& host)
      : socket_(ns3::Socket::CreateSocket(host.node, ns3::UdpSocketFactory::GetTypeId())) {
    socket_->Bind(ns3::InetSocketAddress(ns3::Ipv4Address::GetAny(), port));
    socket_->SetRecvCallback(ns3::MakeCallback(&Receiver::receive, this));
  }

  std::uint64_t received() const { return received_; }

 private:
  void receive(ns3::Ptr<ns3::Socket> socket) {
    while (socket->Recv()) ++received_;
  }

  ns3::Ptr<ns3::Socket> socket_;
  std::uint64_t received_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  const ns3::Time end = ns3::Seconds(seconds_from(argc, argv));
  // The fastest of ns-3's event queues on this workload; its default, a std::map, is about 7 % slower.
  ns3::Simulator::SetScheduler(ns3::ObjectFactory("ns3::PriorityQueueScheduler"));
  const Line line = build_line();
  const Receiver receiver(line.b);
  const Sender cyclic(line.a, line.b, 100, ns3::MicroSeconds(200), end);
  const Sender bulk(line.a, line.b, 1000, ns3::MicroSeconds(20), end);

  const double start_s = cpu_now_s();
  ns3::Simulator::Run();  // until no event is left: the last frames arrive too
  const double cpu_s = cpu_now_s() - start_s;

  const std::uint64_t sent = cyclic.sent() + bulk.sent();
  const std::uint64_t delivered = receiver.received();
  std::printf("{\"frames_sent\":%ju,\"frames_delivered\":%ju,\"frame_hops\":%ju,\"cpu_s\":%.6f}\n",
              std::uintmax_t{sent}, std::uintmax_t{delivered}, std::uintmax_t{delivered * links_on_path}, cpu_s);
  ns3::Simulator::Destroy();
  return delivered == sent && sent > 0 ? 0 : 1;
}

namespace {

Line build_line() {
  ns3::NodeContainer nodes;  // A, the switches, B
  nodes.Create(switch_count + 2);

  ns3::CsmaHelper csma;
  csma.SetChannelAttribute("DataRate", ns3::DataRateValue(ns3::DataRate("1Gbps")));
  csma.SetChannelAttribute("Delay", ns3::TimeValue(ns3::NanoSeconds(50)));
  csma.DisableFlowControl();  // without queue disciplines above it nobody listens
  Line line;
  ns3::Ptr<ns3::NetDevice> left = nullptr;  // the end of the link to the left, on node i
  for (std::uint32_t i = 0; i + 1 < nodes.GetN(); ++i) {
    const ns3::NetDeviceContainer ends = csma.Install(ns3::NodeContainer(nodes.Get(i), nodes.Get(i + 1)));
    if (i == 0) {
      line.a = {nodes.Get(0), ends.Get(0), ns3::Ipv4Address("10.0.0.1")};
    } else {
      ns3::BridgeHelper().Install(nodes.Get(i), ns3::NetDeviceContainer(left, ends.Get(0)));
    }
    left = ends.Get(1);
  }
  line.b = {nodes.Get(switch_count + 1), left, ns3::Ipv4Address("10.0.0.2")};

  ns3::InternetStackHelper internet;
  internet.SetIpv6StackInstall(false);
  internet.SetRoutingHelper(ns3::Ipv4StaticRoutingHelper());
  internet.Install(ns3::NodeContainer(line.a.node, line.b.node));
  // Not by Ipv4AddressHelper, which would install a queue discipline (fq_codel) on every device.
  give_address(line.a);
  give_address(line.b);
  know_neighbour(line.a, line.b);
  know_neighbour(line.b, line.a);
  return line;
}

void give_address(const Host& host) {
  const auto ipv4 = host.node->GetObject<ns3::Ipv4>();
  const std::uint32_t interface = ipv4->AddInterface(host.device);
  ipv4->AddAddress(interface, ns3::Ipv4InterfaceAddress(host.address, ns3::Ipv4Mask("255.255.255.0")));
  ipv4->SetUp(interface);
}

/// A permanent ARP entry, so that no ARP exchange distorts the count.
void know_neighbour(const Host& host, const Host& neighbour) {
  const auto ipv4 = host.node->GetObject<ns3::Ipv4L3Protocol>();
  const auto interface = ipv4->GetInterface(static_cast<std::uint32_t>(ipv4->GetInterfaceForDevice(host.device)));
  ns3::ArpCache::Entry* entry = interface->GetArpCache()->Add(neighbour.address);
  entry->SetMacAddress(neighbour.device->GetAddress());
  entry->MarkPermanent();
}

double cpu_now_s() {
  std::timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

double seconds_from(int argc, char** argv) {
  const std::string text = argc > 1 ? argv[1] : "10";
  char* rest = nullptr;
  const double seconds = std::strtod(text.c_str(), &rest);
  if (argc > 2 || text.empty() || *rest != '\0' || !(seconds > 0 && seconds <= longest_s)) {
    std::fprintf(stderr, "usage: %s [SECONDS]   a number above 0 and at most %g, not \"%s\"\n", argv[0], longest_s,
                 text.c_str());
    std::exit(2);
  }
  return seconds;
}

}  // namespace
