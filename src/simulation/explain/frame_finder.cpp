// SPDX-License-Identifier: Apache-2.0
#include "explain/frame_finder.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include "scenario/run/run.hpp"
#include "sim/trace.hpp"

namespace takt::explain {
namespace {

using models::Occurrence;

class FrameFinder final : public sim::TraceSink {
 public:
  FrameFinder(const models::Network& network, const FrameQuestion& question)
      : network_(&network), from_(question.from) {
    const auto& streams = network.traffic().streams();
    for (std::uint32_t s = 0; s < streams.size(); ++s)
      wanted_.push_back(!streams[s].link_local && (!question.stream || question.stream->value == s));
  }

  void record(const sim::TraceRecord& record) override {
    const auto kind = static_cast<Occurrence>(record.kind);
    if (kind != Occurrence::received && kind != Occurrence::drop) return;
    const models::Frame& frame = network_->traffic().frame({static_cast<std::uint32_t>(record.what)});
    if (!wanted_[frame.stream.value] || frame.produced < from_) return;
    if (kind == Occurrence::received)
      receive(
          {{frame.stream, frame.sequence}, {static_cast<std::uint32_t>(record.detail)}, record.time - frame.produced});
    else if (static_cast<models::DropReason>(record.detail) != models::DropReason::duplicate)
      drop({frame.stream, frame.sequence});
  }

  /// After the run.
  FoundFrames found() {
    const auto lost = std::ranges::find_if(dropped_, [&](const FrameName& each) { return is_missing(each); });
    if (lost != dropped_.end()) {
      found_.lost = *lost;
      found_.lost_has_copies = has_copies(lost->stream);
    }
    return found_;
  }

 private:
  void receive(const Delivery& delivery) {
    if (!found_.slowest || delivery.latency > found_.slowest->latency) found_.slowest = delivery;
    if (!found_.fastest || delivery.latency < found_.fastest->latency) found_.fastest = delivery;
  }
  /// Of a frame without copies the first drop says all; of others, what may yet come counts.
  void drop(const FrameName& frame) {
    if (!has_copies(frame.stream) && is_certain_) return;
    is_certain_ = is_certain_ || !has_copies(frame.stream);
    dropped_.push_back(frame);
  }
  bool has_copies(models::StreamIndex stream) const { return !network_->traffic().book().arrivals(stream).empty(); }
  bool is_missing(const FrameName& frame) {
    const auto arrivals = network_->traffic().book().arrivals(frame.stream);
    if (arrivals.empty()) return true;
    if (std::ranges::all_of(arrivals, [&](const auto& each) { return each.ledger.has(frame.sequence); })) return false;
    if (under_way_.empty())
      network_->traffic().for_each_live([&](const models::Frame& each) {
        under_way_.insert({each.stream, each.sequence});
      });
    return !under_way_.contains(frame);
  }

  const models::Network* network_;
  TrueTime from_;
  std::vector<bool> wanted_;  // by stream
  FoundFrames found_;
  std::vector<FrameName> dropped_;  // in the order of time
  bool is_certain_ = false;         // one of them is lost, whatever comes
  std::set<FrameName> under_way_;   // at the end
};

}  // namespace

std::optional<FoundFrames> find_frames(const scenario::Resolved& resolved, const FrameQuestion& question,
                                       const Interrupted& interrupted) {
  scenario::Run run(resolved);
  FrameFinder finder(run.network(), question);
  run.simulation().set_trace(&finder);
  constexpr std::uint64_t events_a_slice = 100'000;
  while (!run.advance(events_a_slice))
    if (interrupted && interrupted()) return std::nullopt;
  run.simulation().set_trace(nullptr);
  return finder.found();
}

}  // namespace takt::explain
