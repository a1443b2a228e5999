// SPDX-License-Identifier: Apache-2.0
#include "study/divergence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>

#include "models/ethernet/traffic.hpp"
#include "models/port_directory.hpp"
#include "scenario/run/run.hpp"
#include "sim/trace.hpp"

namespace takt::study {
namespace {

constexpr std::uint64_t events_a_slice = 20'000;

struct Happening {
  models::Occurrence kind{};
  std::uint32_t port = 0;  // position in the directory, or none
  std::uint32_t stream = 0;
  std::uint64_t sequence = 0;
  std::uint64_t detail = 0;
};

struct Instant {
  sim::TrueTime time;
  std::vector<Happening> happenings;
};

/// One of the two runs, with what happened in it and is not compared yet.
class Side : public sim::TraceSink {
 public:
  explicit Side(const scenario::Resolved& resolved) : run_(resolved), directory_(run_.network()) {
    run_.simulation().set_trace(this);
  }

  void record(const sim::TraceRecord& record) override {
    const auto kind = static_cast<models::Occurrence>(record.kind);
    if (kind != models::Occurrence::started && kind != models::Occurrence::drop && kind != models::Occurrence::produced)
      return;
    if (instants_.empty() || instants_.back().time != record.time) instants_.push_back({record.time, {}});
    const models::Frame& frame = run_.network().traffic().frame({static_cast<std::uint32_t>(record.what)});
    // What a frame is called by a bridge that rewrites it (detail) would differ for no reason that one can see.
    const std::uint64_t detail = kind == models::Occurrence::produced ? 0 : record.detail;
    instants_.back().happenings.push_back(
        {kind, directory_.find(record.where), frame.stream.value, frame.sequence, detail});
  }

  /// Goes on until a whole instant is known or the run is over; false if there is none left.
  bool fill() {
    while (instants_.size() < 2 && !is_over_) is_over_ = run_.advance(events_a_slice);
    return !instants_.empty();
  }
  const Instant& front() const { return instants_.front(); }
  void pop() { instants_.pop_front(); }

  std::vector<std::string> texts(const Instant& instant) const {
    std::vector<std::string> all;
    for (const Happening& happening : instant.happenings) all.push_back(text_of(happening));
    std::sort(all.begin(), all.end());
    return all;
  }

 private:
  std::string text_of(const Happening& h) const {
    const auto& nodes = run_.network().plan().nodes;
    const auto& streams = run_.network().traffic().streams();
    const std::string frame =
        fmt::format("frame {} of {}", h.sequence, h.stream < streams.size() ? streams[h.stream].name : "?");
    if (h.kind == models::Occurrence::produced) return frame + " is handed over by its application";
    std::string where = "somewhere";
    if (h.port != models::PortDirectory::none) {
      const models::PortDirectory::Port& port = directory_.ports()[h.port];
      where = nodes[port.id.node.value].name + (port.peer.is_none() ? "" : " towards " + nodes[port.peer.value].name);
    }
    if (h.kind == models::Occurrence::drop)
      return fmt::format("{} is dropped at {}: {}", frame, where,
                         models::name_of(static_cast<models::DropReason>(h.detail)));
    const models::TransmissionDetail detail = models::TransmissionDetail::unpack(h.detail);
    return fmt::format("{} leaves {} ({} octets, class {})", frame, where, detail.octets, detail.traffic_class);
  }

  scenario::Run run_;
  models::PortDirectory directory_;
  std::deque<Instant> instants_;
  bool is_over_ = false;
};

}  // namespace

std::optional<Divergence> first_divergence(const scenario::Resolved& a, const scenario::Resolved& b,
                                           const std::function<bool()>& interrupted) {
  Side left(a);
  Side right(b);
  for (std::uint64_t count = 0;; ++count) {
    if (count % 4096 == 0 && interrupted && interrupted()) return std::nullopt;
    const bool has_left = left.fill();
    const bool has_right = right.fill();
    // The end of a run is no event: a longer run is not another one for that.
    if (!has_left && !has_right) return std::nullopt;
    if (!has_left && right.front().time.since_start() >= a.scenario.duration) return std::nullopt;
    if (!has_right && left.front().time.since_start() >= b.scenario.duration) return std::nullopt;
    const bool left_first = has_left && (!has_right || left.front().time <= right.front().time);
    const bool right_first = has_right && (!has_left || right.front().time <= left.front().time);
    std::vector<std::string> of_left = left_first ? left.texts(left.front()) : std::vector<std::string>();
    std::vector<std::string> of_right = right_first ? right.texts(right.front()) : std::vector<std::string>();
    if (of_left == of_right) {
      left.pop();
      right.pop();
      continue;
    }
    Divergence divergence;
    divergence.at = left_first ? left.front().time : right.front().time;
    std::set_difference(of_left.begin(), of_left.end(), of_right.begin(), of_right.end(),
                        std::back_inserter(divergence.only_a));
    std::set_difference(of_right.begin(), of_right.end(), of_left.begin(), of_left.end(),
                        std::back_inserter(divergence.only_b));
    return divergence;
  }
}

}  // namespace takt::study
