// SPDX-License-Identifier: Apache-2.0
#include "models/gptp/codec.hpp"

#include <type_traits>

#include "sim/octets.hpp"

namespace takt::models::gptp {
namespace {

constexpr std::size_t header_length = 34;
constexpr std::uint8_t two_step_flag = 0x02;        // first flag octet
constexpr std::uint8_t ptp_time_scale_flag = 0x08;  // second flag octet
constexpr std::uint16_t tlv_organization_extension = 0x0003;
constexpr std::uint16_t tlv_path_trace = 0x0008;
constexpr std::uint16_t tlv_organization_extension_do_not_propagate = 0x8000;
constexpr std::uint16_t gptp_capable_length = 12;
constexpr std::uint32_t gptp_capable_subtype = 4;
constexpr std::uint16_t interval_request_length = 12;
constexpr std::uint32_t interval_request_subtype = 2;
constexpr std::uint16_t follow_up_information_length = 28;
constexpr std::uint16_t drift_tracking_length = 32;
constexpr std::uint32_t follow_up_information_subtype = 1;
constexpr std::uint32_t drift_tracking_subtype = 6;
constexpr std::uint32_t organization_802_1 = 0x0080C2;

using Reader = sim::OctetReader<sim::BigEndian>;
using Writer = sim::OctetWriter<sim::BigEndian>;

void put(Writer& out, const ClockIdentity& identity) { out.put_octets(std::as_bytes(std::span(identity.octets))); }
void put(Writer& out, const PortIdentity& identity) {
  put(out, identity.clock);
  out.put(identity.port);
}
void put(Writer& out, const Timestamp& time) {
  out.put(static_cast<std::uint16_t>(time.seconds >> 32));
  out.put(static_cast<std::uint32_t>(time.seconds));
  out.put(time.nanoseconds);
}
/// Three octets: an OUI, or what its owner numbers.
void put_24_bits(Writer& out, std::uint32_t value) {
  out.put(static_cast<std::uint8_t>(value >> 16));
  out.put(static_cast<std::uint16_t>(value));
}

void get(Reader& in, ClockIdentity& identity) {
  for (std::uint8_t& octet : identity.octets) octet = in.get<std::uint8_t>();
}
void get(Reader& in, PortIdentity& identity) {
  get(in, identity.clock);
  identity.port = in.get<std::uint16_t>();
}
void get(Reader& in, Timestamp& time) {
  const auto high = in.get<std::uint16_t>();
  time.seconds = std::uint64_t{high} << 32 | in.get<std::uint32_t>();
  time.nanoseconds = in.get<std::uint32_t>();
  if (time.nanoseconds >= 1'000'000'000) in.fail();
}
std::uint32_t get_24_bits(Reader& in) {
  const auto high = in.get<std::uint8_t>();
  return std::uint32_t{high} << 16 | in.get<std::uint16_t>();
}

template <class Body>
constexpr MessageType type_of() {
  if constexpr (std::is_same_v<Body, Sync>) return MessageType::sync;
  if constexpr (std::is_same_v<Body, FollowUp>) return MessageType::follow_up;
  if constexpr (std::is_same_v<Body, PdelayReq>) return MessageType::pdelay_req;
  if constexpr (std::is_same_v<Body, PdelayResp>) return MessageType::pdelay_resp;
  if constexpr (std::is_same_v<Body, PdelayRespFollowUp>) return MessageType::pdelay_resp_follow_up;
  if constexpr (std::is_same_v<Body, Announce>) return MessageType::announce;
  if constexpr (std::is_same_v<Body, Signaling>) return MessageType::signaling;
}

/// The obsolete field that IEEE 1588-2008 derived from the type; 802.1AS-2020 still fills it in.
std::uint8_t control_of(MessageType type) {
  if (type == MessageType::sync) return 0;
  return type == MessageType::follow_up ? 2 : 5;
}

std::size_t length_of(const std::optional<DriftTracking>& drift) { return drift ? 4 + drift_tracking_length : 0; }
std::size_t length_of(const Sync& sync) { return sync.one_step ? 76 + length_of(sync.one_step->drift) : 44; }
std::size_t length_of(const FollowUp& follow_up) { return 76 + length_of(follow_up.drift); }
std::size_t length_of(const PdelayReq&) { return 54; }
std::size_t length_of(const PdelayResp&) { return 54; }
std::size_t length_of(const PdelayRespFollowUp&) { return 54; }
std::size_t length_of(const Announce& announce) { return 64 + 4 + 8 * announce.path_trace.size(); }
std::size_t length_of(const Signaling& signaling) {
  return 44 + (signaling.request ? std::size_t{4} + interval_request_length : 0) +
         (signaling.capable ? std::size_t{4} + gptp_capable_length : 0);
}

// The first flag octet: twoStepFlag for a Sync without contents and for every Pdelay_Resp.
std::uint8_t flags_of(const Message& message) {
  const Sync* const sync = std::get_if<Sync>(&message);
  const bool two_step = (sync != nullptr && !sync->one_step) || std::holds_alternative<PdelayResp>(message);
  return two_step ? two_step_flag : 0;
}

void put_information(Writer& out, const FollowUpInformation& information) {
  out.put(tlv_organization_extension);
  out.put(follow_up_information_length);
  put_24_bits(out, organization_802_1);
  put_24_bits(out, follow_up_information_subtype);
  out.put(information.cumulative_scaled_rate_offset);
  out.put(information.gm_time_base_indicator);
  out.put_octets(std::as_bytes(std::span(information.last_gm_phase_change)));
  out.put(information.scaled_last_gm_freq_change);
}

void put_drift(Writer& out, const std::optional<DriftTracking>& drift) {
  if (!drift) return;
  out.put(tlv_organization_extension);
  out.put(drift_tracking_length);
  put_24_bits(out, organization_802_1);
  put_24_bits(out, drift_tracking_subtype);
  put(out, drift->sync_egress);
  out.put_zeros(2);  // of a nanosecond
  put(out, drift->grandmaster);
  out.put(drift->steps_removed);
  out.put(drift->rate_ratio_drift);
}

void put_body(Writer& out, const Sync& sync) {
  if (!sync.one_step) return out.put_zeros(10);
  put(out, sync.one_step->origin);
  put_information(out, sync.one_step->information);
  put_drift(out, sync.one_step->drift);
}
void put_body(Writer& out, const FollowUp& follow_up) {
  put(out, follow_up.precise_origin);
  put_information(out, follow_up.information);
  put_drift(out, follow_up.drift);
}
void put_body(Writer& out, const PdelayReq&) { out.put_zeros(20); }
void put_body(Writer& out, const PdelayResp& response) {
  put(out, response.request_receipt);
  put(out, response.requesting_port);
}
void put_body(Writer& out, const PdelayRespFollowUp& follow_up) {
  put(out, follow_up.response_origin);
  put(out, follow_up.requesting_port);
}
void put_body(Writer& out, const Announce& announce) {
  TAKT_CHECK(announce.path_trace.size() <= Announce::longest_path_trace, "a path trace that fits a frame");
  out.put_zeros(10);
  out.put(announce.time.current_utc_offset);
  out.put_zeros(1);
  out.put(announce.grandmaster_priority1);
  out.put(announce.grandmaster_quality.clock_class);
  out.put(announce.grandmaster_quality.clock_accuracy);
  out.put(announce.grandmaster_quality.offset_scaled_log_variance);
  out.put(announce.grandmaster_priority2);
  put(out, announce.grandmaster);
  out.put(announce.steps_removed);
  out.put(announce.time.time_source);
  out.put(tlv_path_trace);
  out.put(static_cast<std::uint16_t>(8 * announce.path_trace.size()));
  for (const ClockIdentity& identity : announce.path_trace) put(out, identity);
}

void put_body(Writer& out, const Signaling& signaling) {
  put(out, signaling.target);
  if (signaling.request) {
    out.put(tlv_organization_extension);
    out.put(interval_request_length);
    put_24_bits(out, organization_802_1);
    put_24_bits(out, interval_request_subtype);
    out.put(signaling.request->link_delay);
    out.put(signaling.request->time_sync);
    out.put(signaling.request->announce);
    out.put(signaling.request->flags);
    out.put_zeros(2);
  }
  if (!signaling.capable) return;
  out.put(tlv_organization_extension_do_not_propagate);
  out.put(gptp_capable_length);
  put_24_bits(out, organization_802_1);
  put_24_bits(out, gptp_capable_subtype);
  out.put(signaling.capable->log_interval);
  out.put(signaling.capable->flags);
  out.put_zeros(4);
}

struct RawHeader {
  MessageType type{};
  std::uint16_t length = 0;
  std::uint8_t flags[2] = {};
  Header header;
};

std::optional<RawHeader> get_header(Reader& in) {
  RawHeader raw;
  const auto first = in.get<std::uint8_t>();
  const auto version = in.get<std::uint8_t>();
  raw.type = static_cast<MessageType>(first & 0xF);
  raw.header.major_sdo_id = static_cast<MajorSdoId>(first >> 4);
  raw.header.minor_version = version >> 4;
  raw.length = in.get<std::uint16_t>();
  raw.header.domain = in.get<std::uint8_t>();
  raw.header.minor_sdo_id = in.get<std::uint8_t>();
  for (std::uint8_t& octet : raw.flags) octet = in.get<std::uint8_t>();
  raw.header.correction.scaled_ns = in.get<std::int64_t>();
  in.take(4);
  get(in, raw.header.source);
  raw.header.sequence_id = in.get<std::uint16_t>();
  in.take(1);
  raw.header.log_message_interval = in.get<std::int8_t>();
  const bool known = (first >> 4 == 1 || first >> 4 == 2) && (version & 0xF) == 2;
  if (in.failed() || !known || raw.length < header_length) return std::nullopt;
  return raw;
}

/// Looks through the TLVs that are left for the one that is wanted: calls found(contents) -> bool until it gives true.
/// Further ones of that type are shown to `more`.
template <class Found, class More>
bool find_tlv(Reader& in, std::uint16_t wanted, Found&& found, More&& more) {
  bool is_found = false;
  while (in.left() >= 4) {
    const auto type = in.get<std::uint16_t>();
    const Reader contents(in.take(in.get<std::uint16_t>()));
    if (in.failed()) return false;
    if (type != wanted) continue;
    if (is_found)
      more(contents);
    else
      is_found = found(contents);
  }
  return is_found && in.left() == 0;
}

bool get_information(Reader contents, FollowUpInformation& information) {
  if (contents.left() != follow_up_information_length) return false;
  if (get_24_bits(contents) != organization_802_1 || get_24_bits(contents) != follow_up_information_subtype)
    return false;
  information.cumulative_scaled_rate_offset = contents.get<std::int32_t>();
  information.gm_time_base_indicator = contents.get<std::uint16_t>();
  for (std::uint8_t& octet : information.last_gm_phase_change) octet = contents.get<std::uint8_t>();
  information.scaled_last_gm_freq_change = contents.get<std::int32_t>();
  return true;
}

void get_drift(Reader contents, std::optional<DriftTracking>& drift) {
  if (drift || contents.left() != drift_tracking_length) return;
  if (get_24_bits(contents) != organization_802_1 || get_24_bits(contents) != drift_tracking_subtype) return;
  DriftTracking read;
  get(contents, read.sync_egress);
  contents.take(2);
  get(contents, read.grandmaster);
  read.steps_removed = contents.get<std::uint16_t>();
  read.rate_ratio_drift = contents.get<std::int32_t>();
  if (!contents.failed()) drift = read;
}

/// What is behind the time of a Sync: the information that must be there, and what else is known.
bool get_information(Reader& in, FollowUpInformation& information, std::optional<DriftTracking>& drift) {
  return find_tlv(
      in, tlv_organization_extension,
      [&](Reader contents) {
        get_drift(contents, drift);
        return get_information(contents, information);
      },
      [&](Reader contents) { get_drift(contents, drift); });
}

bool get_body(Reader& in, const RawHeader& raw, Sync& sync) {
  if ((raw.flags[0] & two_step_flag) != 0) {
    in.take(10);
    return true;
  }
  Sync::OneStep contents;
  get(in, contents.origin);
  const bool complete = get_information(in, contents.information, contents.drift);
  sync.one_step = contents;
  return complete;
}
bool get_body(Reader& in, const RawHeader&, FollowUp& follow_up) {
  get(in, follow_up.precise_origin);
  return get_information(in, follow_up.information, follow_up.drift);
}
bool get_body(Reader& in, const RawHeader&, PdelayReq&) {
  in.take(20);
  return true;
}
bool get_body(Reader& in, const RawHeader&, PdelayResp& response) {
  get(in, response.request_receipt);
  get(in, response.requesting_port);
  return true;
}
bool get_body(Reader& in, const RawHeader&, PdelayRespFollowUp& follow_up) {
  get(in, follow_up.response_origin);
  get(in, follow_up.requesting_port);
  return true;
}
bool get_body(Reader& in, const RawHeader& raw, Announce& announce) {
  announce.time.flags = raw.flags[1];
  in.take(10);
  announce.time.current_utc_offset = in.get<std::int16_t>();
  in.take(1);
  announce.grandmaster_priority1 = in.get<std::uint8_t>();
  announce.grandmaster_quality.clock_class = in.get<std::uint8_t>();
  announce.grandmaster_quality.clock_accuracy = in.get<std::uint8_t>();
  announce.grandmaster_quality.offset_scaled_log_variance = in.get<std::uint16_t>();
  announce.grandmaster_priority2 = in.get<std::uint8_t>();
  get(in, announce.grandmaster);
  announce.steps_removed = in.get<std::uint16_t>();
  announce.time.time_source = in.get<std::uint8_t>();
  return find_tlv(
      in, tlv_path_trace,
      [&](Reader contents) {
        if (contents.left() % 8 != 0 || contents.left() / 8 > Announce::longest_path_trace) return false;
        announce.path_trace.resize(contents.left() / 8);
        for (ClockIdentity& identity : announce.path_trace) get(contents, identity);
        return true;
      },
      [](Reader) {});
}

void get_capable(Reader contents, std::optional<GptpCapable>& capable) {
  if (capable || contents.left() != gptp_capable_length) return;
  if (get_24_bits(contents) != organization_802_1 || get_24_bits(contents) != gptp_capable_subtype) return;
  capable.emplace();
  capable->log_interval = contents.get<std::int8_t>();
  capable->flags = contents.get<std::uint8_t>();
}

void get_request(Reader contents, std::optional<IntervalRequest>& request) {
  if (request || contents.left() != interval_request_length) return;
  if (get_24_bits(contents) != organization_802_1 || get_24_bits(contents) != interval_request_subtype) return;
  request.emplace();
  request->link_delay = contents.get<std::int8_t>();
  request->time_sync = contents.get<std::int8_t>();
  request->announce = contents.get<std::int8_t>();
  request->flags = contents.get<std::uint8_t>();
}

/// Other TLVs than those that are known here are no mistake.
bool get_body(Reader& in, const RawHeader&, Signaling& signaling) {
  get(in, signaling.target);
  while (in.left() >= 4) {
    const auto type = in.get<std::uint16_t>();
    const Reader contents(in.take(in.get<std::uint16_t>()));
    if (in.failed()) return false;
    if (type == tlv_organization_extension) get_request(contents, signaling.request);
    if (type == tlv_organization_extension_do_not_propagate) get_capable(contents, signaling.capable);
  }
  return in.left() == 0;
}

template <class Body>
std::optional<Message> decoded(Reader& in, const RawHeader& raw) {
  Body body;
  body.header = raw.header;
  if (!get_body(in, raw, body) || in.failed()) return std::nullopt;
  return body;
}

}  // namespace

std::size_t encoded_length(const Message& message) {
  return std::visit([](const auto& each) { return length_of(each); }, message);
}

void encode(const Message& message, std::vector<std::byte>& octets) {
  octets.resize(encoded_length(message));
  Writer out(octets);
  const Header& header = header_of(message);
  const MessageType type =
      std::visit([](const auto& each) { return type_of<std::decay_t<decltype(each)>>(); }, message);
  const Announce* const announce = std::get_if<Announce>(&message);
  out.put(static_cast<std::uint8_t>(static_cast<unsigned>(header.major_sdo_id) << 4 | static_cast<unsigned>(type)));
  out.put(static_cast<std::uint8_t>(header.minor_version << 4 | 2));
  out.put(static_cast<std::uint16_t>(octets.size()));
  out.put(header.domain);
  out.put(header.minor_sdo_id);
  out.put(flags_of(message));
  out.put(announce != nullptr ? announce->time.flags : ptp_time_scale_flag);
  out.put(header.correction.scaled_ns);
  out.put_zeros(4);
  put(out, header.source);
  out.put(header.sequence_id);
  out.put(control_of(type));
  out.put(header.log_message_interval);
  std::visit([&](const auto& each) { put_body(out, each); }, message);
  TAKT_CHECK(!out.overflowed() && out.position() == octets.size(), "a message of its length");
}

std::optional<Message> decode(std::span<const std::byte> octets) {
  Reader whole(octets);
  const std::optional<RawHeader> raw = get_header(whole);
  if (!raw || raw->length > octets.size()) return std::nullopt;
  Reader in(whole.take(raw->length - header_length));
  switch (raw->type) {
    case MessageType::sync:
      return decoded<Sync>(in, *raw);
    case MessageType::follow_up:
      return decoded<FollowUp>(in, *raw);
    case MessageType::pdelay_req:
      return decoded<PdelayReq>(in, *raw);
    case MessageType::pdelay_resp:
      return decoded<PdelayResp>(in, *raw);
    case MessageType::pdelay_resp_follow_up:
      return decoded<PdelayRespFollowUp>(in, *raw);
    case MessageType::announce:
      return decoded<Announce>(in, *raw);
    case MessageType::signaling:
      return decoded<Signaling>(in, *raw);
  }
  return std::nullopt;
}

}  // namespace takt::models::gptp
