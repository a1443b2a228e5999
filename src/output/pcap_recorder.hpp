// Writes the frames that leave ports to pcap files with nanosecond time stamps, for Wireshark and its like.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "output/frame_octets.hpp"
#include "models/port_directory.hpp"
#include "sim/trace.hpp"

struct pcap;
struct pcap_dumper;

namespace takt::output {

/// A capture holds what its ports *send*; to see both directions of a link, capture the ports at both ends. The time stamp is the
/// instant at which the first bit of the preamble leaves, in true time, rounded down to a nanosecond. The FCS is left out, as
/// network cards leave it out.
class PcapRecorder final : public sim::TraceSink {
 public:
  /// The network outlives the recorder.
  explicit PcapRecorder(const models::Network& network);
  /// Without close() no file stays behind.
  ~PcapRecorder() override;
  PcapRecorder(const PcapRecorder&) = delete;
  PcapRecorder& operator=(const PcapRecorder&) = delete;

  /// One more file: of these ports, or of all ports if none is named. A port may be in several files. Returns an empty text, or
  /// what went wrong.
  [[nodiscard]] std::string add(const std::string& path, const std::vector<models::PortId>& ports);

  void record(const sim::TraceRecord& record) override;

  /// Writes what is left and gives each file its name. Returns an empty text, or the first thing that went wrong; that file is not there
  /// then. Nothing is recorded afterwards.
  [[nodiscard]] std::string close();

  /// Frames written to all files so far.
  std::uint64_t frames() const { return frames_; }

 private:
  struct File {
    std::string path;
    std::string temporary;
    pcap_dumper* dumper = nullptr;
  };
  static std::string finish(File& file);

  const models::Network* network_;
  models::PortDirectory directory_;
  pcap* format_ = nullptr;
  std::vector<File> files_;
  std::vector<std::vector<std::uint32_t>> files_of_port_;
  FrameBuffer buffer_{};
  std::uint64_t frames_ = 0;
};

}  // namespace takt::output
