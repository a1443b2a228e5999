// SPDX-License-Identifier: Apache-2.0
// The frames under way and the account of every stream: what was sent, delivered, dropped and why.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "models/ethernet/delivery_book.hpp"
#include "models/ethernet/frame_pool.hpp"
#include "models/ethernet/sizes.hpp"
#include "sim/histogram.hpp"
#include "sim/simulation.hpp"

namespace takt::models {

/// Kinds of digest records and of trace records that the network writes.
enum class Occurrence : std::uint32_t {
  delivery = 1,  ///< a frame reached a listener; what = sequence and instant of production (so its latency counts)
  drop = 2,      ///< a frame ended early; what = sequence, instant of production and reason
  produced = 3,  ///< an application handed a frame over; what = sequence, length and source
  started = 4,   ///< the first bit of the preamble leaves a port; see TransmissionDetail (trace only)
  enqueued = 5,  ///< a frame waits in a queue (trace only)
  cut = 6,  ///< the fragment under way ends after so many octets of the frame; its mCRC follows; see TransmissionDetail
            ///< (trace only)
  resumed = 7,  ///< the first bit of the preamble of a continuation leaves a port; see TransmissionDetail (trace only)
  clock_step = 10,     ///< a servo has stepped a node's clock; what = the step (digest only)
  clock_rate = 13,     ///< a servo has set the rate of a node's clock; what = the adjustment (digest only)
  clock_message = 14,  ///< a gPTP message came to a node; what = its octets (digest only)
  gates_changed = 9,   ///< a port got other gates, or one of its gates breaks (trace only)
  received = 11,  ///< a frame reaches the applications of a host; what = frame, detail = stream and node (trace only)
  output_changed =
      12,            ///< a digital output of an application changes; what = its number, detail = its level (trace only)
  dequeued = 8,      ///< a frame leaves a queue, to be sent or because it is given up (trace only)
  job_done = 15,     ///< a thread of a processor has done a job; what = its response time (digest only)
  refused = 16,      ///< frames of a class wait although the medium is free; what = until when at most, as a true time,
                     ///< detail = BlockedRecord (trace only)
  processing = 17,   ///< a frame waits for the processor of its host, or is on it; what = frame (trace only)
  arrived = 18,      ///< a frame has come to a node; what = frame, detail = ArrivalDetail (Network::trace_paths() only)
  separated = 19,    ///< a copy of a frame goes on as another record; what = that one, detail = the one before
                     ///< (Network::trace_paths() only)
  gates_shown = 20,  ///< the gates of a port are so from now on; what = bit q: that of class q is open (told by who
                     ///< follows gates, not by the port)
  stored = 22,       ///< the header of a frame has come, which is not cut through; detail = StoringDetail (trace only)
  ended = 21,  ///< no copy of a frame shares the record any more; what = that record (told by who orders records: see
               ///< Moment)
};

/// Whether a trace record of that kind has a frame under way as its `what`.
constexpr bool names_a_frame(Occurrence kind) {
  switch (kind) {
    case Occurrence::drop:
    case Occurrence::produced:
    case Occurrence::started:
    case Occurrence::enqueued:
    case Occurrence::dequeued:
    case Occurrence::cut:
    case Occurrence::resumed:
    case Occurrence::received:
    case Occurrence::processing:
    case Occurrence::stored:
    case Occurrence::arrived:
      return true;
    default:
      return false;
  }
}

/// Why a class of a port with a free medium may not start its first frame.
enum class BlockReason : std::uint8_t {
  gate_closed,   ///< its transmission gate is closed; amount = the entry of the list, from 0, or no_entry
  guard,         ///< the frame would not end before its gate closes; amount = the entry of the list, or no_entry
  credit,        ///< its credit is negative; amount = how many bits are missing, rounded up
  not_eligible,  ///< its launch time, or its ATS eligibility time, is still to come
  hold,          ///< the MAC holds preemptable frames
  count
};

/// The detail of a trace record of refused. It holds for the class until the port decides again, at the longest until
/// the time that the record names.
struct BlockedRecord {
  static constexpr std::uint32_t no_entry = 0xFFFF'FFFF;
  BlockReason hindrance = BlockReason::gate_closed;
  TrafficClass traffic_class = 0;
  bool of_rest = false;  ///< of a frame that was cut
  std::uint32_t amount = 0;
  constexpr std::uint64_t pack() const {
    return static_cast<std::uint64_t>(hindrance) << 56 | static_cast<std::uint64_t>(traffic_class) << 48 |
           static_cast<std::uint64_t>(of_rest) << 40 | amount;
  }
  static constexpr BlockedRecord unpack(std::uint64_t detail) {
    return {static_cast<BlockReason>(detail >> 56), static_cast<TrafficClass>(detail >> 48 & 0xFF),
            (detail >> 40 & 1) != 0, static_cast<std::uint32_t>(detail)};
  }
};

/// Why a port does not cut a frame through of which it has the header.
enum class Storing : std::uint8_t {
  not_asked_to,  ///< it cuts no frames of that class through
  other_rate,    ///< the frame comes from a link of another rate
  link_down,     ///< its own link is down
  medium_busy,   ///< a frame is on the medium, or the gap behind it
  goes_first,    ///< another frame may start now and does, or is cut through before it
  order,         ///< frames of its class wait, which came before it
  too_long,      ///< queueMaxSDU
  refused,       ///< gate or credit of its class; see the refusal
  count
};

/// The detail of a trace record of stored.
struct StoringDetail {
  Storing reason = Storing::not_asked_to;
  BlockedRecord refusal = {};  ///< of `refused`
  constexpr std::uint64_t pack() const {
    return static_cast<std::uint64_t>(reason) << 60 | (refusal.pack() & 0x0FFF'FFFF'FFFF'FFFF);
  }
  static constexpr StoringDetail unpack(std::uint64_t detail) {
    return {static_cast<Storing>(detail >> 60), BlockedRecord::unpack(detail & 0x0FFF'FFFF'FFFF'FFFF)};
  }
};

/// The detail of a trace record of started, cut or resumed: octets (of the frame; of the fragment that ends; of the
/// rest, FCS included) and traffic class.
struct TransmissionDetail {
  std::uint32_t octets = 0;
  TrafficClass traffic_class = 0;
  constexpr std::uint64_t pack() const { return static_cast<std::uint64_t>(traffic_class) << 32 | octets; }
  static constexpr TransmissionDetail unpack(std::uint64_t detail) {
    return {static_cast<std::uint32_t>(detail), static_cast<TrafficClass>(detail >> 32)};
  }
};

/// The detail of a trace record of arrived: by which port of the node, from which port of another one, and how much of
/// it.
struct ArrivalDetail {
  std::uint16_t port = 0;
  sim::ComponentId sender;
  bool only_header = false;
  constexpr std::uint64_t pack() const {
    return static_cast<std::uint64_t>(sender.index) << 32 | (only_header ? std::uint64_t{1} << 16 : 0) | port;
  }
  static constexpr ArrivalDetail unpack(std::uint64_t detail) {
    return {static_cast<std::uint16_t>(detail), {static_cast<std::uint32_t>(detail >> 32)}, (detail >> 16 & 1) != 0};
  }
};

/// One stream: its addressing and its account.
struct alignas(64) Stream {
  std::uint64_t sent = 0;       ///< frames produced by the talker
  std::uint64_t delivered = 0;  ///< frames handed to listeners
  std::uint64_t copies = 0;     ///< extra copies made by bridges for multicast
  sim::Digest::Key production;  ///< of the records of its frames' production; made by Traffic::add_stream
  AddressIndex source;
  AddressIndex destination;
  Octets headers{0};  ///< octets between EtherType and payload (28 for UDP over IPv4)
  VlanId vlan = 0;
  Priority priority = 0;
  bool tagged = false;
  bool link_local = false;
  std::uint16_t ether_type = 0;        ///< of what is neither IP nor without meaning; 0: takt's choice
  alignas(64) sim::Histogram latency;  ///< from production to delivery, all listeners
  std::array<std::uint64_t, static_cast<std::size_t>(DropReason::count)> dropped{};
  std::string name;
  NodeIndex talker;
  std::uint32_t listeners = 1;
  std::uint16_t udp_port = 0;         ///< of the receivers; 0: takt's choice
  std::uint16_t udp_source_port = 0;  ///< of the sender; 0: takt's choice
  std::uint32_t ip_group = 0;         ///< IPv4 multicast address to which it goes; 0: takt's choice

  std::uint64_t dropped_in_all() const {
    std::uint64_t sum = 0;
    for (const std::uint64_t n : dropped) sum += n;
    return sum;
  }
  /// Conservation: sent + copies = delivered + dropped + in flight.
  std::uint64_t in_flight() const { return sent + copies - delivered - dropped_in_all(); }
};

class Traffic {
 public:
  /// So many streams will be added: their accounts take no more room than they need.
  void expect_streams(std::size_t count) { streams_.reserve(count); }
  StreamIndex add_stream(Stream stream);
  Stream& stream(StreamIndex index) { return streams_[index.value]; }
  const Stream& stream(StreamIndex index) const { return streams_[index.value]; }
  const std::vector<Stream>& streams() const { return streams_; }

  Frame& frame(FrameIndex index) { return frames_[index]; }
  const Frame& frame(FrameIndex index) const { return frames_[index]; }
  /// A frame that may have ended: null, or the record that has the handle now, of another one or of none.
  Frame* find_frame(FrameIndex index) { return frames_.find(index); }
  Payload& payload(PayloadIndex index) { return payloads_[index]; }
  const Payload& payload(PayloadIndex index) const { return payloads_[index]; }

  /// Makes a frame of the stream with a payload of that many octets, at this instant, and counts it as sent.
  FrameIndex produce(StreamIndex stream, Octets payload, sim::Simulation& simulation);
  /// The same with octets, which are copied.
  FrameIndex produce(StreamIndex stream, std::span<const std::byte> payload, sim::Simulation& simulation);
  /// The same without the digest: the caller changes the frame first, then calls count_production().
  FrameIndex produce(StreamIndex stream, Octets payload, sim::TrueTime now);
  FrameIndex produce(StreamIndex stream, std::span<const std::byte> payload, sim::TrueTime now);

  /// A frame that another part of a divided run has sent, with its octets, if it has any, goes on here.
  FrameIndex take_over(const Frame& frame, std::span<const std::byte> payload);
  /// What another part of a divided run has counted, and the frames that are under way there, count here, too. It stays
  /// as it is from now on, and outlives this.
  void adopt(const Traffic& other);

  /// One more copy of the frame is under way.
  void copy(FrameIndex index) {
    Frame& frame = frames_[index];
    TAKT_CHECK(is_under_way(frame), "a frame is copied while it is under way");
    ++frame.references;
    ++streams_[frame.stream.value].copies;
  }

  /// A record that may be changed, because no other copy of the frame shares it: the same one if that is so already, a
  /// new one otherwise. The caller's copy goes on as the record that is returned. Emits a trace record at component
  /// `where`.
  FrameIndex own(FrameIndex index, sim::ComponentId where) {
    return frames_[index].references == 1 ? index : separate(index, where);
  }
  /// One more copy of the frame, with a record of its own.
  FrameIndex duplicate(FrameIndex index, sim::ComponentId where) {
    copy(index);
    return separate(index, where);
  }
  /// Puts tags on or takes them off. Precondition: the record is not shared.
  void set_tags(FrameIndex index, bool tagged, bool r_tagged) {
    Frame& frame = frames_[index];
    frame.tagged = tagged;
    frame.r_tagged = r_tagged;
    frame.length = static_cast<std::uint16_t>(frame_length(Octets{frame.msdu}, tagged, r_tagged).count);
  }

  /// The frame was produced at this instant.
  void count_production(const Frame& frame, sim::Simulation& simulation) const {
    simulation.digest().add(
        streams_[frame.stream.value].production, frame.produced,
        sim::joined(frame.sequence, static_cast<std::uint64_t>(frame.length) << 32 | frame.source.value));
  }

  /// The digest's key of deliveries of the stream at `listener`.
  static constexpr sim::Digest::Key delivery_key(StreamIndex stream, NodeIndex listener) {
    return sim::Digest::key_of(static_cast<std::uint32_t>(Occurrence::delivery),
                               static_cast<std::uint64_t>(stream.value) << 32 | listener.value);
  }

  /// The frame has reached a listener, whose key `listener` is. It stays alive until released.
  void count_delivery(const Frame& frame, sim::Digest::Key listener, sim::Simulation& simulation) {
    Stream& stream = streams_[frame.stream.value];
    ++stream.delivered;
    stream.latency.add(simulation.now() - frame.produced);
    simulation.digest().add(listener, simulation.now(), record_of(frame));
  }

  /// This copy of the frame ends here.
  void release(FrameIndex index) {
    Frame& frame = frames_[index];
    if (--frame.references != 0) {
      TAKT_CHECK(frame.references <= most_references,
                 "no copy of a frame ends twice");  // a count that was 0 has wrapped
      return;
    }
    if (!frame.payload.is_none()) release(frame.payload);
    frames_.free(index);
  }

  /// This copy of the frame ends at component `where` for that reason.
  void drop(FrameIndex index, DropReason reason, sim::ComponentId where, sim::Simulation& simulation);

  /// Brings what producing a frame of the stream touches towards the cache.
  void prefetch_sending(StreamIndex index) const { __builtin_prefetch(&streams_[index.value], 1); }
  /// The same for delivering one.
  void prefetch_delivery(StreamIndex index) const {
    __builtin_prefetch(&streams_[index.value], 1);
    __builtin_prefetch(&streams_[index.value].latency, 1);
  }
  /// The same for what only that leads to.
  void prefetch_latency(StreamIndex index) const { streams_[index.value].latency.prefetch(); }

  /// What is kept of deliveries of some streams, besides their accounts.
  DeliveryBook& book() { return book_; }
  const DeliveryBook& book() const { return book_; }
  /// See FramePool::for_each_live.
  template <class Visit>
  void for_each_live(Visit&& visit) const {
    frames_.for_each_live(visit);
    for (const Traffic* const other : adopted_) other->for_each_live(visit);
  }

  std::size_t live_frames() const { return frames_.live(); }

  /// Traces that the frame waits for the processor of its host.
  static void trace_processing(sim::Simulation& simulation, sim::ComponentId where, FrameIndex frame) {
    if (sim::TraceSink* const trace = simulation.trace()) [[unlikely]]
      trace->record({simulation.now(), static_cast<std::uint32_t>(Occurrence::processing), where, frame.value, 0});
  }
  /// From now on each copy that gets its own record is traced in that run.
  void trace_copies(const sim::Simulation& simulation) { traced_run_ = &simulation; }

 private:
  static constexpr std::uint32_t most_references = 0x7FFF'FFFF;
  static bool is_under_way(const Frame& frame) { return frame.references - 1 < most_references; }
  FrameIndex make(StreamIndex stream, Octets payload, sim::TrueTime now);
  FrameIndex make(StreamIndex stream, std::span<const std::byte> payload, sim::TrueTime now);
  FrameIndex separate(FrameIndex index, sim::ComponentId where);
  PayloadIndex keep(std::span<const std::byte> octets);
  /// One frame less carries the payload.
  void release(PayloadIndex index) {
    Payload& payload = payloads_[index];
    if (--payload.references == 0) {
      payloads_.free(index);
      return;
    }
    TAKT_CHECK(payload.references <= most_references, "a payload is given up once by each frame that carries it");
  }
  /// What a record of the end of a frame says of it.
  static constexpr std::uint64_t record_of(const Frame& frame) {
    return sim::joined(frame.sequence, static_cast<std::uint64_t>(frame.produced.ps()));
  }

  std::vector<Stream> streams_;
  FramePool frames_;
  PayloadPool payloads_;
  DeliveryBook book_;
  std::vector<const Traffic*> adopted_;
  const sim::Simulation* traced_run_ = nullptr;  // null: nobody asks which record was made of which
};

}  // namespace takt::models
