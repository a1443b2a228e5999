// SPDX-License-Identifier: Apache-2.0
// Writes the frames that leave ports to pcapng files, an interface a port, for Wireshark and its like.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "models/moment.hpp"
#include "models/port_directory.hpp"
#include "output/frame_octets.hpp"
#include "output/streaming_file.hpp"
#include "sim/trace.hpp"

namespace takt::output {

/// A capture holds what its ports *send*; to see both directions of a link, capture the ports at both ends. The time
/// stamp is the instant at which the first bit of the preamble leaves, in true time, rounded down to a nanosecond. The
/// FCS is left out, as network cards leave it out.
class PcapRecorder final : public sim::TraceSink {
 public:
  /// The network outlives the recorder.
  explicit PcapRecorder(const models::Network& network);
  PcapRecorder(const PcapRecorder&) = delete;
  PcapRecorder& operator=(const PcapRecorder&) = delete;

  /// One more file: of these ports, or of all ports if none is named. A port may be in several files. Returns an empty
  /// text, or what went wrong.
  [[nodiscard]] std::string add(const std::string& path, const std::vector<models::PortId>& ports);
  /// One more file: of the frames of one stream, at all ports that they leave by. These become interfaces as the stream
  /// comes to them.
  [[nodiscard]] std::string add_stream(const std::string& path, models::StreamIndex stream);

  /// It is told of things later than they happen, each with its moment.
  void look_at(const models::Moment& moment) { view_.look_at(moment); }
  void record(const sim::TraceRecord& record) override;

  /// Writes what is left and gives each file its name; without it no file stays behind. Returns an empty text, or the
  /// first thing that went wrong; that file is not there then. Nothing is recorded afterwards.
  [[nodiscard]] std::string close();

  /// Frames written to all files so far.
  std::uint64_t frames() const { return frames_; }

 private:
  static constexpr std::uint32_t none = 0xFFFF'FFFF;
  struct File {
    std::unique_ptr<StreamingFile> file;
    std::optional<models::StreamIndex> stream = {};     ///< only its frames
    std::vector<std::uint32_t> interface_of_port = {};  ///< by the port's position; none: it has none (yet)
    std::uint32_t interfaces = 0;
  };
  void begin(File& file);
  void add_interface(File& file, std::uint32_t position);

  const models::Network* network_;
  models::View view_;
  models::PortDirectory directory_;
  std::vector<File> files_;
  std::vector<std::vector<std::uint32_t>> files_of_port_;
  FrameBuffer buffer_{};
  std::string block_;  // kept for its room
  std::uint64_t frames_ = 0;
};

}  // namespace takt::output
