#include "output/pcap_recorder.hpp"

#include <pcap/pcap.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

namespace takt::output {
namespace {

constexpr int snapshot_length = 65535;
constexpr std::int64_t ps_in_a_second = 1'000'000'000'000;
constexpr std::int64_t ps_in_a_nanosecond = 1'000;

std::string failure(const std::string& path) { return path + ": " + std::strerror(errno); }

}  // namespace

PcapRecorder::PcapRecorder(const models::Network& network) : network_(&network), directory_(network) {
  format_ = pcap_open_dead_with_tstamp_precision(DLT_EN10MB, snapshot_length, PCAP_TSTAMP_PRECISION_NANO);
  TAKT_CHECK(format_ != nullptr, "libpcap knows Ethernet");
  files_of_port_.resize(directory_.ports().size());
}

PcapRecorder::~PcapRecorder() {
  for (const File& file : files_) {
    if (file.dumper == nullptr) continue;
    pcap_dump_close(file.dumper);
    ::unlink(file.temporary.c_str());
  }
  pcap_close(format_);
}

std::string PcapRecorder::add(const std::string& path, const std::vector<models::PortId>& ports) {
  File file{path, path + ".part", nullptr};
  file.dumper = pcap_dump_open(format_, file.temporary.c_str());
  if (file.dumper == nullptr) return pcap_geterr(format_);
  const auto number = static_cast<std::uint32_t>(files_.size());
  files_.push_back(std::move(file));
  if (ports.empty())
    for (std::vector<std::uint32_t>& files : files_of_port_) files.push_back(number);
  for (const models::PortId& id : ports) {
    const std::uint32_t position = directory_.find(id);
    TAKT_CHECK(position != models::PortDirectory::none, "a captured port is one of the network");
    files_of_port_[position].push_back(number);
  }
  return {};
}

void PcapRecorder::record(const sim::TraceRecord& record) {
  if (record.kind != static_cast<std::uint32_t>(models::Occurrence::started)) return;
  const std::uint32_t port = directory_.find(record.where);
  if (port == models::PortDirectory::none || files_of_port_[port].empty()) return;
  const models::FrameIndex frame{static_cast<std::uint32_t>(record.what)};
  const std::span<const std::byte> octets = encode_frame(*network_, frame, buffer_);
  pcap_pkthdr header{};
  header.ts.tv_sec = record.time.ps() / ps_in_a_second;
  header.ts.tv_usec = record.time.ps() % ps_in_a_second / ps_in_a_nanosecond;  // nanoseconds, as the file's magic number says
  header.caplen = static_cast<bpf_u_int32>(octets.size());
  header.len = header.caplen;
  for (const std::uint32_t number : files_of_port_[port]) {
    if (files_[number].dumper == nullptr) continue;
    pcap_dump(reinterpret_cast<u_char*>(files_[number].dumper), &header, reinterpret_cast<const u_char*>(octets.data()));
    ++frames_;
  }
}

std::string PcapRecorder::close() {
  std::string problem;
  for (File& file : files_) {
    if (file.dumper == nullptr) continue;
    const std::string of_file = finish(file);
    if (problem.empty()) problem = of_file;
  }
  return problem;
}

std::string PcapRecorder::finish(File& file) {
  std::FILE* const stream = pcap_dump_file(file.dumper);
  const bool written = pcap_dump_flush(file.dumper) == 0 && std::ferror(stream) == 0 && ::fsync(::fileno(stream)) == 0;
  std::string problem = written ? std::string() : failure(file.temporary);
  pcap_dump_close(std::exchange(file.dumper, nullptr));
  if (problem.empty() && ::rename(file.temporary.c_str(), file.path.c_str()) != 0) problem = failure(file.path);
  if (!problem.empty()) ::unlink(file.temporary.c_str());
  return problem;
}

}  // namespace takt::output
