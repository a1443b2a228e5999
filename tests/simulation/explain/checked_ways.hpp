// SPDX-License-Identifier: Apache-2.0
// Every frame of a run explained, and each explanation checked from outside: it adds up, what it blames was on that
// wire at that time, and every frame has its ends.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "explain/way_recorder.hpp"
#include "scenario/run/run.hpp"

namespace takt::explain {

class CheckedWays final : public sim::TraceSink, private WaySink {
 public:
  /// `also` hears the same records, if it is not null.
  explicit CheckedWays(scenario::Run& run, sim::TraceSink* also = nullptr)
      : run_(&run),
        also_(also),
        directory_(run.network()),
        recorder_(run.network(), *this),
        ends_(run.network().traffic().streams().size()) {
    run.explain_to(this);
  }

  void record(const sim::TraceRecord& record) override {
    note_transmission(record);
    if (also_ != nullptr) also_->record(record);
    recorder_.record(record);
  }

  /// To be called when the run is over: what is wrong, or an empty text.
  std::string finish() {
    recorder_.finish(run_->simulation().now());
    const auto& streams = run_->network().traffic().streams();
    for (std::size_t s = 0; s < streams.size(); ++s) {
      if (streams[s].link_local) continue;
      if (ends_[s].first != streams[s].delivered)
        wrong(streams[s].name + ": " + std::to_string(ends_[s].first) + " deliveries explained of " +
              std::to_string(streams[s].delivered));
      if (ends_[s].second != streams[s].dropped_in_all())
        wrong(streams[s].name + ": " + std::to_string(ends_[s].second) + " losses explained of " +
              std::to_string(streams[s].dropped_in_all()));
    }
    return problem_;
  }

  std::uint64_t ways() const { return ways_; }
  /// How often each cause has occurred.
  const std::map<Cause, std::uint64_t>& causes() const { return causes_; }

 private:
  struct Transmission {
    TrueTime start;
    TrueTime end;
    FrameName frame;
    models::TrafficClass traffic_class = 0;
  };

  void wrong(std::string message) {
    if (problem_.empty()) problem_ = std::move(message);
  }

  /// What is on the wires, by the records of their beginnings alone.
  void note_transmission(const sim::TraceRecord& record) {
    const auto kind = static_cast<models::Occurrence>(record.kind);
    const bool begins = kind == models::Occurrence::started || kind == models::Occurrence::resumed;
    if (!begins && kind != models::Occurrence::cut) return;
    const std::uint32_t position = directory_.find(record.where);
    std::vector<Transmission>& all = on_wire_[position];
    const Duration octet = directory_.ports()[position].octet_time;
    const auto detail = models::TransmissionDetail::unpack(record.detail);
    if (!begins) {
      all.back().end = all.back().start + octet * (8 + std::int64_t{detail.octets} + 4 + 12);
      return;
    }
    const models::Frame& frame = run_->network().traffic().frame({static_cast<std::uint32_t>(record.what)});
    all.push_back({record.time,
                   record.time + octet * (8 + std::int64_t{detail.octets} + 12),
                   {frame.stream, frame.sequence},
                   detail.traffic_class});
  }

  bool wants(models::StreamIndex) const override { return true; }
  void ended(const Way& way) override {
    ++ways_;
    auto& [delivered, dropped] = ends_[way.frame.stream.value];
    if (way.end == Way::End::delivered) ++delivered;
    if (way.end == Way::End::dropped) ++dropped;
    const std::string name =
        run_->network().traffic().stream(way.frame.stream).name + " frame " + std::to_string(way.frame.sequence);
    Duration sum;
    for (const Part& part : parts_of(way)) {
      sum += part.length;
      ++causes_[part.cause];
    }
    if (sum != way.latency()) wrong(name + ": its parts do not add up");
    for (const Hop& hop : way.hops) {
      const std::uint32_t position = directory_.find(hop.port);
      for (const Part& part : hop.parts) check(name, hop, position, part);
    }
    for (std::size_t h = 1; h < way.hops.size(); ++h) check_stored(name, way.hops[h - 1], way.hops[h]);
  }

  /// Where the class of a frame is cut through it either comes to the port before it is whole, or there is a reason.
  void check_stored(const std::string& name, const Hop& before, const Hop& hop) {
    const models::EgressPort& port = run_->network().ports(hop.port.node)[hop.port.port];
    const bool is_cut_class = models::contains(port.config().cut_through, hop.traffic_class);
    if (!is_cut_class || before.cuts > 0 || hop.started == TrueTime::never()) {
      if (hop.stored && !is_cut_class) wrong(name + ": is told to be stored where nobody would cut it through");
      return;
    }
    const models::Link& link = run_->network().ports(before.port.node)[before.port.port].link();
    const TrueTime whole =
        before.started + link.octet_time() * (8 + std::int64_t{before.octets}) + link.reception().far_end.delay;
    if ((hop.came < whole) == hop.stored.has_value())
      wrong(name + (hop.stored ? ": is cut through, and told to be stored" : ": is stored without a reason"));
  }

  void check(const std::string& name, const Hop& hop, std::uint32_t position, const Part& part) {
    const bool is_behind = part.cause == Cause::higher_class || part.cause == Cause::own_class ||
                           part.cause == Cause::lower_class || part.cause == Cause::precedence;
    if (is_behind != part.who.has_value()) return wrong(name + ": a part without a frame, or with one too many");
    const TrueTime end = part.begin + part.length;
    if (!is_behind) {
      // Its own octets are on the wire while it is sent.
      if (part.cause == Cause::transmission && !is_on_wire(position, hop, part.begin, end, nullptr))
        wrong(name + ": is not sent when it should be");
      return;
    }
    if (run_->network().traffic().stream(part.who->stream).sent <= part.who->sequence)
      return wrong(name + ": waits for a frame that was never sent");
    if (!is_on_wire(position, hop, part.begin, end, &part))
      wrong(name + " (" + name_of(part.cause) + "): the frame that it waits for is not on the wire from " +
            std::to_string(part.begin.ps()) + " to " + std::to_string(end.ps()));
  }

  /// Without `part`: any frame. What was cut may have gone on at once, so several fragments may follow each other.
  bool is_on_wire(std::uint32_t position, const Hop& hop, TrueTime begin, TrueTime end, const Part* part) const {
    const auto found = on_wire_.find(position);
    if (found == on_wire_.end()) return false;
    for (auto each = found->second.rbegin(); each != found->second.rend() && each->end > begin; ++each) {
      if (each->start >= end) continue;
      if (each->end < end) return false;
      if (part != nullptr) {
        const bool fits = part->cause == Cause::own_class      ? each->traffic_class == hop.traffic_class
                          : part->cause == Cause::higher_class ? each->traffic_class > hop.traffic_class
                                                               : each->traffic_class < hop.traffic_class;
        if (each->frame != *part->who || !fits) return false;
      }
      if (each->start <= begin) return true;
      end = each->start;
    }
    return false;
  }

  scenario::Run* run_;
  sim::TraceSink* also_;
  models::PortDirectory directory_;
  WayRecorder recorder_;
  std::map<std::uint32_t, std::vector<Transmission>> on_wire_;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> ends_;  // by stream: delivered, dropped
  std::map<Cause, std::uint64_t> causes_;
  std::uint64_t ways_ = 0;
  std::string problem_;
};

}  // namespace takt::explain
