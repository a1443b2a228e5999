// SPDX-License-Identifier: Apache-2.0
// Follows frames through a run and tells, when one ends, its way and where its time went. It hears what the models say
// (models::Occurrence) and keeps what a port was used for only while somebody whom it follows waits there.
#pragma once

#include <set>
#include <vector>

#include "explain/port_account.hpp"
#include "explain/way.hpp"
#include "models/moment.hpp"
#include "models/network.hpp"
#include "models/port_directory.hpp"
#include "sim/trace.hpp"

namespace takt::explain {

/// Who is told of ways.
class WaySink {
 public:
  virtual ~WaySink() = default;
  /// Whether frames of the stream are followed at all; asked once.
  virtual bool wants(models::StreamIndex stream) const = 0;
  /// Whether this frame of such a stream is; asked when it is produced.
  virtual bool wants_frame(const models::Frame& frame) {
    static_cast<void>(frame);
    return true;
  }
  /// Whether the way of that delivery, at the present instant, is worth the trouble.
  virtual bool wants_delivery(const models::Frame& frame, models::NodeIndex listener, TrueTime now) {
    static_cast<void>(frame), static_cast<void>(listener), static_cast<void>(now);
    return true;
  }
  virtual bool wants_loss(const models::Frame& frame, models::DropReason reason) {
    static_cast<void>(frame), static_cast<void>(reason);
    return true;
  }
  virtual void ended(const Way& way) = 0;
};

/// Hangs on a run by scenario::Run::explain_to() from before its first event. Messages of gPTP, which end at the next
/// node, are not followed.
class WayRecorder final : public sim::TraceSink {
 public:
  /// Both outlive it.
  WayRecorder(const models::Network& network, WaySink& sink);

  /// It is told of things later than they happen, each with its moment.
  void look_at(const models::Moment& moment) { view_.look_at(moment); }

  void record(const sim::TraceRecord& record) override;
  /// The run is over: tells of what is under way, in the order of production.
  void finish(TrueTime now);

 private:
  static constexpr std::uint32_t none = 0xFFFF'FFFF;
  /// A hop as it comes about.
  struct Visit {
    Hop hop;
    std::uint32_t position = 0;  // of its port
    std::uint32_t from = none;   // the hop before
    TrueTime last_start;         // of the last fragment
    TrueTime last_free;          // when its rest might go on
    std::uint32_t left = 0;      // octets of the last fragment, FCS or mCRC not counted twice
    Duration octet_time;
    Duration cable;
    Duration node_delay;
    bool has_header_come = false;  // before the whole frame
    bool has_launch_time = false;  ///< what is not eligible waits for it: else an ATS scheduler holds it
    bool is_waiting = false;       // it, or its rest
    TrueTime waits_since;          // if so
    bool is_reported = false;      // in the way of another copy
    bool is_over = false;          // its frame has ended behind it
  };
  /// A node that the record of a frame has come to.
  struct Place {
    models::NodeIndex node;
    std::uint32_t from = none;                // the hop by which it came
    bool only_header = false;                 // has come
    TrueTime processing = TrueTime::never();  // since when it is on the host's processor
  };
  struct AtPort {
    std::uint32_t position = 0;
    std::uint32_t visit = 0;
  };
  /// A record of a frame. The record that was made of another one has been where that one was.
  struct Copy {
    std::uint32_t journey = none;
    std::vector<Place> places;
    std::vector<AtPort> ports;
    std::vector<std::pair<std::uint32_t, Stored>> stored;  // by the positions of ports that have its header
  };
  struct Journey {
    FrameName frame;
    models::Priority priority = 0;
    models::NodeIndex talker;
    TrueTime produced;
    std::vector<Visit> visits;
    std::vector<std::uint32_t> records;  // that live
  };

  Copy* copy_of(std::uint64_t record);
  Copy& make_copy(std::uint32_t record);
  models::NodeIndex node_of(sim::ComponentId component) const;
  static Place* place_at(Copy& copy, models::NodeIndex node);
  static std::uint32_t visit_at(const Copy& copy, std::uint32_t position);
  Visit& visit(Copy& copy, std::uint32_t position, TrueTime now);
  void wait_at(std::uint32_t position, Visit& visit, TrueTime since);
  void waits_no_more(std::uint32_t position, Visit& visit, TrueTime now);
  void explain_wait(Visit& visit, TrueTime from, TrueTime until, bool is_rest);

  void produced(const sim::TraceRecord& record);
  void arrived(const sim::TraceRecord& record);
  void started(const sim::TraceRecord& record);
  void resumed(const sim::TraceRecord& record);
  void cut(const sim::TraceRecord& record);
  void received(const sim::TraceRecord& record);
  void dropped(const sim::TraceRecord& record);
  void separated(const sim::TraceRecord& record);
  void stored(const sim::TraceRecord& record);
  std::optional<Stored> why_stored(const Journey& journey, const Visit& visit) const;
  void copy_ends(std::uint32_t record, const models::Frame& frame);
  void record_ends(std::uint32_t record);

  /// The way up to the visit `last`, and on to `place`, if it came there; otherwise it ended at that port or on the
  /// wire behind it.
  Way way_of(const Copy& copy, std::uint32_t last, const Place* place, TrueTime ended);
  bool is_shaped_at_talker(models::StreamIndex stream) const;
  void add_talker(const Copy& copy, TrueTime until, Way& way) const;
  void add_flight(const Visit& visit, TrueTime until, bool arrives, const Place* host, std::vector<Part>& parts) const;

  const models::Network* network_;
  models::View view_;
  WaySink* sink_;
  models::PortDirectory directory_;
  std::vector<std::uint32_t> node_of_component_;
  std::vector<bool> wanted_;                      // by stream
  std::vector<PortAccount> accounts_;             // by port
  std::vector<std::multiset<TrueTime>> waiting_;  // by port: since when those wait whom we follow
  std::vector<Copy> copies_;                      // by record
  std::vector<Journey> journeys_;
  std::vector<std::uint32_t> free_journeys_;
  bool ended_in_host_ = false;  // the way that is being made ends behind a bridge's part of a station
};

}  // namespace takt::explain
