// SPDX-License-Identifier: Apache-2.0
#include "output/pcap_recorder.hpp"

#include <fmt/format.h>

#include <numeric>
#include <utility>

#include "output/pcapng.hpp"
#include "results/behaviour.hpp"

namespace takt::output {
namespace {

constexpr std::int64_t ps_in_a_nanosecond = 1'000;
constexpr std::int64_t bits_times_ps = 8 * 1'000'000'000'000;  // of an octet in a second

}  // namespace

PcapRecorder::PcapRecorder(const models::Network& network) : network_(&network), view_(network), directory_(network) {
  files_of_port_.resize(directory_.ports().size());
}

std::string PcapRecorder::add(const std::string& path, const std::vector<models::PortId>& ports) {
  std::vector<std::uint32_t> positions(ports.empty() ? directory_.ports().size() : 0);
  std::iota(positions.begin(), positions.end(), 0U);
  for (const models::PortId& id : ports) {
    positions.push_back(directory_.find(id));
    TAKT_CHECK(positions.back() != models::PortDirectory::none, "a captured port is one of the network");
  }
  File made{std::make_unique<StreamingFile>(path)};
  const std::string problem = made.file->problem();
  if (!problem.empty()) return problem;
  begin(made);
  for (const std::uint32_t position : positions) {
    add_interface(made, position);
    files_of_port_[position].push_back(static_cast<std::uint32_t>(files_.size()));
  }
  files_.push_back(std::move(made));
  return {};
}

std::string PcapRecorder::add_stream(const std::string& path, models::StreamIndex stream) {
  File made{std::make_unique<StreamingFile>(path), stream};
  const std::string problem = made.file->problem();
  if (!problem.empty()) return problem;
  begin(made);
  for (std::vector<std::uint32_t>& files : files_of_port_) files.push_back(static_cast<std::uint32_t>(files_.size()));
  files_.push_back(std::move(made));
  return {};
}

void PcapRecorder::begin(File& file) {
  file.interface_of_port.assign(directory_.ports().size(), none);
  block_.clear();
  pcapng::add_section_header(block_, results::name_of(results::this_takt()));
  file.file->write(block_);
}

/// "sw1:2 to robot".
void PcapRecorder::add_interface(File& file, std::uint32_t position) {
  const models::PortDirectory::Port& port = directory_.ports()[position];
  const auto& nodes = network_->plan().nodes;
  const std::string_view peer = port.peer.is_none() ? std::string_view("nothing") : nodes[port.peer.value].name;
  const std::int64_t octet_time = port.octet_time.ps();
  block_.clear();
  pcapng::add_interface(block_, {fmt::format("{}:{} to {}", nodes[port.id.node.value].name, port.id.port, peer),
                                 octet_time > 0 ? static_cast<std::uint64_t>(bits_times_ps / octet_time) : 0});
  file.file->write(block_);
  file.interface_of_port[position] = file.interfaces++;
}

void PcapRecorder::record(const sim::TraceRecord& record) {
  if (record.kind != static_cast<std::uint32_t>(models::Occurrence::started)) return;
  const std::uint32_t port = directory_.find(record.where);
  if (port == models::PortDirectory::none || files_of_port_[port].empty()) return;
  const models::Frame& frame = view_.frame({static_cast<std::uint32_t>(record.what)});
  std::span<const std::byte> octets;
  for (const std::uint32_t number : files_of_port_[port]) {
    File& file = files_[number];
    if (file.file == nullptr || (file.stream && *file.stream != frame.stream)) continue;
    if (file.interface_of_port[port] == none) add_interface(file, port);
    if (octets.empty())
      octets = encode_frame(*network_, frame,
                            frame.payload.is_none() ? std::span<const std::byte>() : view_.payload(frame), buffer_);
    block_.clear();
    pcapng::add_outbound_packet(block_, file.interface_of_port[port], record.time.ps() / ps_in_a_nanosecond, octets);
    file.file->write(block_);
    ++frames_;
  }
}

std::string PcapRecorder::close() {
  std::string problem;
  for (File& file : files_) {
    if (file.file == nullptr) continue;
    const std::string of_file = std::exchange(file.file, nullptr)->close();
    if (problem.empty()) problem = of_file;
  }
  return problem;
}

}  // namespace takt::output
