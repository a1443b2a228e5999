// SPDX-License-Identifier: Apache-2.0
#include "interchange/pcap/import.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "interchange/device_import.hpp"
#include "interchange/pcap/capture_file.hpp"
#include "json/quantity.hpp"

namespace takt::interchange {
namespace {

using sim::Duration;

constexpr std::size_t most_frames = std::size_t{1} << 22;
constexpr std::size_t most_flows = 16384;  // of all interfaces

/// Frames that belong together: from one address to another, with one tag, to one UDP port or with one EtherType.
struct FlowKey {
  std::uint64_t source = 0, destination = 0;
  bool tagged = false;
  std::uint16_t vlan = 0;
  std::uint8_t pcp = 0;
  std::uint16_t ether_type = 0;
  std::uint16_t udp_port = 0;  ///< 0: no UDP
  auto operator<=>(const FlowKey&) const = default;
};

struct Flow {
  std::vector<std::int64_t> times_ns;
  std::uint32_t largest = 0, smallest = 0xFFFF'FFFF;  ///< payload
};

std::string address_text(std::uint64_t address) {
  std::string text;
  for (int shift = 40; shift >= 0; shift -= 8)
    text += fmt::format("{}{:02x}", text.empty() ? "" : ":", address >> shift & 0xFF);
  return text;
}

class Capture {
 public:
  Capture(const InputFile& file, Imported& imported, json::Diagnostics& diagnostics)
      : file_(file), imported_(imported), diagnostics_(diagnostics) {}

  std::map<FlowKey, Flow> read() {
    std::size_t count = 0;
    const std::string problem = read_captured_frames(file_.text, [&](const CapturedFrame& frame) {
      if (++count > most_frames) return false;
      take(frame);
      return true;
    });
    if (count > most_frames) return refuse(fmt::format("more than {} frames", most_frames));
    if (!problem.empty()) return refuse(problem);
    if (flows_.empty()) return refuse("no frames of streams");
    if (others_ > 0)
      imported_.remark(RemarkKind::ignored, {file_.name, 0, 0, ""},
                       fmt::format("{} frames of gPTP, LLDP, ARP and the like", others_));
    return where_seen_first();
  }

 private:
  std::map<FlowKey, Flow> refuse(const std::string& found) {
    diagnostics_.error({file_.name, 0, 0, ""}, "no capture that is read", {found, "pcap or pcapng of Ethernet"});
    return {};
  }

  /// Of a stream that several interfaces have seen on its way, what the first of them saw: the times there are those
  /// nearest to the talker's.
  std::map<FlowKey, Flow> where_seen_first() {
    std::map<FlowKey, Flow> first;
    std::size_t again = 0;
    for (auto& [seen, flow] : flows_) {
      const auto [found, is_new] = first.try_emplace(seen.first);
      again += is_new ? 0 : std::min(flow.times_ns.size(), found->second.times_ns.size());
      if (is_new || std::ranges::min(flow.times_ns) < std::ranges::min(found->second.times_ns))
        found->second = std::move(flow);
    }
    if (again > 0)
      imported_.remark(RemarkKind::ignored, {file_.name, 0, 0, ""},
                       fmt::format("{} frames that further interfaces saw on their way", again));
    return first;
  }

  static std::uint64_t number(sim::OctetSpan octets, std::size_t at, std::size_t count) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value = value << 8 | std::to_integer<std::uint64_t>(octets[at + i]);
    return value;
  }

  void take(const CapturedFrame& frame) {
    const sim::OctetSpan octets = frame.octets;
    const auto octet = [&](std::size_t at) { return std::to_integer<unsigned>(octets[at]); };
    if (octets.size() < 14) {
      ++others_;
      return;
    }
    FlowKey key;
    key.destination = number(octets, 0, 6);
    key.source = number(octets, 6, 6);
    std::size_t at = 12;
    key.ether_type = static_cast<std::uint16_t>(number(octets, at, 2));
    if (key.ether_type == 0x8100 && octets.size() >= 18) {
      const auto tag = static_cast<std::uint16_t>(number(octets, 14, 2));
      key.tagged = true;
      key.pcp = static_cast<std::uint8_t>(tag >> 13);
      key.vlan = tag & 0xFFF;
      at = 16;
      key.ether_type = static_cast<std::uint16_t>(number(octets, at, 2));
    }
    at += 2;
    std::int64_t payload = std::int64_t{frame.length} - static_cast<std::int64_t>(at);
    const bool is_management = key.ether_type == 0x88F7 || key.ether_type == 0x88CC || key.ether_type == 0x0806 ||
                               key.ether_type == 0x86DD || key.ether_type < 0x0600;
    if (is_management || payload < 1) {
      ++others_;
      return;
    }
    if (key.ether_type == 0x0800) {
      // IPv4 with UDP, whole; the rest of IP is no stream of a plant.
      if (octets.size() < at + 28 || octet(at) >> 4 != 4 || octet(at + 9) != 17) {
        ++others_;
        return;
      }
      const std::size_t header = std::size_t{octet(at) & 15} * 4;
      if (header < 20 || octets.size() < at + header + 8) {
        ++others_;
        return;
      }
      key.udp_port = static_cast<std::uint16_t>(number(octets, at + header + 2, 2));
      payload = static_cast<std::int64_t>(number(octets, at + header + 4, 2)) - 8;
    }
    if (payload < 1 || payload > 1500) {
      ++others_;
      return;
    }
    const std::pair<FlowKey, std::uint32_t> seen(key, frame.interface);
    const auto flow = flows_.find(seen);
    if (flow == flows_.end() && flows_.size() >= most_flows) {
      ++others_;
      return;
    }
    Flow& made = flow == flows_.end() ? flows_[seen] : flow->second;
    made.times_ns.push_back(frame.time_ns);
    made.largest = std::max(made.largest, static_cast<std::uint32_t>(payload));
    made.smallest = std::min(made.smallest, static_cast<std::uint32_t>(payload));
  }

  const InputFile& file_;
  Imported& imported_;
  json::Diagnostics& diagnostics_;
  std::map<std::pair<FlowKey, std::uint32_t>, Flow> flows_;  // by the interface, too
  std::size_t others_ = 0;
};

class CaptureBuilder {
 public:
  CaptureBuilder(const ImportRequest& request, const Names& names, Imported& imported)
      : names_(names), imported_(imported) {
    if (request.base != nullptr) scenario_ = *request.base;
    has_base_ = request.base != nullptr;
  }

  void add(const std::string& file, const std::map<FlowKey, Flow>& flows, std::int64_t begin) {
    for (const auto& [key, flow] : flows) add(file, key, flow, begin);
  }

  scenario::Scenario take(const std::string& name, Duration length) {
    if (!has_base_) {
      scenario_.name = name;
      scenario_.duration = length;
      for (const std::string& host : hosts_) {
        scenario_.network.nodes.emplace_back(host, scenario::Node(scenario::HostNode{}));
        scenario::Link link;
        link.ends = {host, "sw"};
        scenario_.network.links.push_back(std::move(link));
      }
      scenario_.network.nodes.emplace_back("sw", scenario::Node(scenario::SwitchNode{}));
    }
    return std::move(scenario_);
  }

 private:
  std::string host_of(std::uint64_t address) {
    std::string name = names_.node(address_text(address)).value_or("");
    if (name.empty()) {
      name = (address >> 40 & 1) != 0 ? "group-" : "host-";
      name += fmt::format("{:06x}", address & 0xFF'FFFF);
    }
    hosts_.insert(name);
    return name;
  }

  void add(const std::string& file, const FlowKey& key, const Flow& flow, std::int64_t begin) {
    const json::Place place{file, 0, 0, ""};
    const std::string what = address_text(key.source) + " to " + address_text(key.destination) +
                             (key.udp_port != 0 ? fmt::format(", UDP port {}", key.udp_port)
                                                : fmt::format(", EtherType {:04x}", key.ether_type));
    if (flow.times_ns.size() < 3)
      return imported_.remark(RemarkKind::lost, place,
                              what + fmt::format(": {} frames, too few to see a period", flow.times_ns.size()));
    scenario::Stream stream;
    stream.from = host_of(key.source);
    stream.to.names = {host_of(key.destination)};
    if ((key.destination >> 40 & 1) != 0)
      imported_.remark(RemarkKind::lost, place,
                       what + ": who listens to a group is in no capture; one host stands for all");
    if (stream.from == stream.to.names.front()) return imported_.remark(RemarkKind::lost, place, what + ": to itself");
    stream.name = stream.from + "-to-" + stream.to.names.front();
    for (int i = 2;
         std::ranges::any_of(scenario_.streams, [&](const scenario::Stream& each) { return each.name == stream.name; });
         ++i)
      stream.name = stream.from + "-to-" + stream.to.names.front() + "-" + std::to_string(i);
    stream.payload = sim::Octets{flow.largest};
    stream.encapsulation = key.udp_port != 0 ? scenario::Encapsulation::udp : scenario::Encapsulation::ethernet;
    if (key.tagged) {
      stream.pcp = key.pcp;
      stream.vlan = key.vlan == 0xFFF ? std::uint16_t{0} : key.vlan;
    }
    if (flow.smallest != flow.largest)
      imported_.remark(
          RemarkKind::lost, place,
          what + fmt::format(": {} to {} octets; all frames have {}", flow.smallest, flow.largest, flow.largest));
    set_times(flow, begin, stream, place, what);
    scenario_.streams.push_back(std::move(stream));
  }

  struct Grid {
    std::int64_t least = 0, jitter = 0;  ///< ns: where the first frame may stand, how far frames stray behind
  };
  static Grid grid_of(const std::vector<std::int64_t>& times, std::int64_t period) {
    std::int64_t least = 0, most = 0;
    for (std::size_t k = 0; k < times.size(); ++k) {
      const std::int64_t left = times[k] - times.front() - static_cast<std::int64_t>(k) * period;
      least = std::min(least, left);
      most = std::max(most, left);
    }
    return {least, most - least};
  }

  /// A round period that the frames bear out as well as their mean gap: jitter makes the mean wrong by a part of it for
  /// each gap.
  static std::int64_t rounded(std::int64_t mean, std::int64_t jitter, std::int64_t gaps) {
    const std::int64_t doubt = jitter / gaps + 1;
    for (const std::int64_t step :
         {1'000'000, 500'000, 250'000, 125'000, 100'000, 50'000, 25'000, 10'000, 5'000, 1'000, 500, 100, 10}) {
      const std::int64_t round = (mean + step / 2) / step * step;
      if (round > 0 && std::abs(round - mean) <= doubt) return round;
    }
    return mean;
  }

  /// Frame k at offset + k * period + what is left, from 0 to the jitter: the period is the mean gap, or a round one as
  /// near as the jitter lets tell.
  void set_times(const Flow& flow, std::int64_t begin, scenario::Stream& stream, const json::Place& place,
                 const std::string& what) {
    std::vector<std::int64_t> times = flow.times_ns;
    std::ranges::sort(times);
    const auto gaps = static_cast<std::int64_t>(times.size()) - 1;
    const std::int64_t mean = std::max<std::int64_t>((times.back() - times.front() + gaps / 2) / gaps, 1);
    if (const std::int64_t jitter = grid_of(times, mean).jitter; jitter >= mean) {
      stream.exponential = scenario::ExponentialGaps{Duration::from_ps(mean * 1000)};
      return imported_.remark(RemarkKind::lost, place,
                              what + ": no period (frames stray by " + json::to_text(Duration::from_ps(jitter * 1000)) +
                                  " at a mean gap of " + json::to_text(Duration::from_ps(mean * 1000)) +
                                  "), so random gaps of that mean");
    }
    const std::int64_t period = rounded(mean, grid_of(times, mean).jitter, gaps);
    const Grid grid = grid_of(times, period);
    stream.every = Duration::from_ps(period * 1000);
    std::int64_t offset = (times.front() + grid.least - begin) % period;
    if (offset < 0) offset += period;
    stream.offset = json::OrAuto<Duration>(Duration::from_ps(offset * 1000));
    stream.jitter = Duration::from_ps(std::min(grid.jitter, period) * 1000);
  }

  const Names& names_;
  Imported& imported_;
  scenario::Scenario scenario_;
  bool has_base_ = false;
  std::set<std::string> hosts_;
};

}  // namespace

Imported import_pcap(const ImportRequest& request, json::Diagnostics& diagnostics) {
  Imported imported;
  Names names;
  std::vector<std::pair<const InputFile*, std::map<FlowKey, Flow>>> captures;
  for (const InputFile& file : request.files) {
    if (is_names_file(file))
      names.read(file, diagnostics);
    else
      captures.emplace_back(&file, Capture(file, imported, diagnostics).read());
  }
  if (captures.empty() && !diagnostics.has_errors())
    diagnostics.error({request.files.empty() ? "" : request.files.front().name, 0, 0, ""}, "no capture",
                      {"only a table of names", "a pcap or pcapng file"});
  if (diagnostics.has_errors()) return imported;
  std::int64_t begin = std::numeric_limits<std::int64_t>::max(), end = std::numeric_limits<std::int64_t>::min();
  for (const auto& [file, flows] : captures)
    for (const auto& [key, flow] : flows) {
      begin = std::min(begin, *std::ranges::min_element(flow.times_ns));
      end = std::max(end, *std::ranges::max_element(flow.times_ns));
    }
  CaptureBuilder builder(request, names, imported);
  for (const auto& [file, flows] : captures) builder.add(file->name, flows, begin);
  const Duration length = Duration::from_ps(std::clamp<std::int64_t>(end - begin, 1'000'000, 3'600'000'000'000) * 1000);
  imported.scenario = builder.take(captures.front().first->device, length);
  if (request.base == nullptr)
    imported.remark(RemarkKind::lost, {captures.front().first->name, 0, 0, ""},
                    "the network, which is in no capture (--into): all hosts are at one switch of 1 Gb/s");
  return imported;
}

}  // namespace takt::interchange
