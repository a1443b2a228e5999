// SPDX-License-Identifier: Apache-2.0
#include "dds/discovery/qos_parameters.hpp"

#include <array>

#include "dds/message/wire_values.hpp"

namespace takt::dds {
namespace {

/// Kinds are 32 bits on the wire. `first`: the number of the first kind.
template <class Kind>
void put_kind(Writer& writer, Kind kind, std::uint32_t first = 0) {
  writer.put(static_cast<std::uint32_t>(kind) + first);
}
template <class Kind>
void get_kind(Reader& reader, Kind& kind, Kind last, std::uint32_t first = 0) {
  const auto number = reader.get<std::uint32_t>();
  if (number < first || number - first > static_cast<std::uint32_t>(last))
    reader.fail();
  else
    kind = static_cast<Kind>(number - first);
}

void put_time(Writer& writer, sim::Duration duration) { put(writer, Duration::from(duration)); }
void get_time(Reader& reader, sim::Duration& duration) { duration = get_duration(reader).to_sim(); }

void put_policy(Writer& w, const Reliability& p) {
  put_kind(w, p.kind, 1);
  put_time(w, p.max_blocking_time);
}
void get_policy(Reader& r, Reliability& p) {
  get_kind(r, p.kind, ReliabilityKind::reliable, 1);
  get_time(r, p.max_blocking_time);
}
void put_policy(Writer& w, const Durability& p) { put_kind(w, p.kind); }
void get_policy(Reader& r, Durability& p) { get_kind(r, p.kind, DurabilityKind::persistent); }

void put_policy(Writer& w, const History& p) {
  put_kind(w, p.kind);
  w.put(p.depth);
}
void get_policy(Reader& r, History& p) {
  get_kind(r, p.kind, HistoryKind::keep_all);
  p.depth = r.get<std::int32_t>();
}
void put_policy(Writer& w, const ResourceLimits& p) {
  for (const std::int32_t limit : {p.max_samples, p.max_instances, p.max_samples_per_instance}) w.put(limit);
}
void get_policy(Reader& r, ResourceLimits& p) {
  for (std::int32_t* const limit : {&p.max_samples, &p.max_instances, &p.max_samples_per_instance})
    *limit = r.get<std::int32_t>();
}
void put_policy(Writer& w, const DurabilityService& p) {
  put_time(w, p.service_cleanup_delay);
  put_policy(w, p.history);
  put_policy(w, p.resource_limits);
}
void get_policy(Reader& r, DurabilityService& p) {
  get_time(r, p.service_cleanup_delay);
  get_policy(r, p.history);
  get_policy(r, p.resource_limits);
}
void put_policy(Writer& w, const Deadline& p) { put_time(w, p.period); }
void get_policy(Reader& r, Deadline& p) { get_time(r, p.period); }
void put_policy(Writer& w, const LatencyBudget& p) { put_time(w, p.duration); }
void get_policy(Reader& r, LatencyBudget& p) { get_time(r, p.duration); }
void put_policy(Writer& w, const Lifespan& p) { put_time(w, p.duration); }
void get_policy(Reader& r, Lifespan& p) { get_time(r, p.duration); }
void put_policy(Writer& w, const TimeBasedFilter& p) { put_time(w, p.minimum_separation); }
void get_policy(Reader& r, TimeBasedFilter& p) { get_time(r, p.minimum_separation); }

void put_policy(Writer& w, const Liveliness& p) {
  put_kind(w, p.kind);
  put_time(w, p.lease_duration);
}
void get_policy(Reader& r, Liveliness& p) {
  get_kind(r, p.kind, LivelinessKind::manual_by_topic);
  get_time(r, p.lease_duration);
}
void put_policy(Writer& w, const Ownership& p) { put_kind(w, p.kind); }
void get_policy(Reader& r, Ownership& p) { get_kind(r, p.kind, OwnershipKind::exclusive); }
void put_policy(Writer& w, const OwnershipStrength& p) { w.put(p.value); }
void get_policy(Reader& r, OwnershipStrength& p) { p.value = r.get<std::int32_t>(); }
void put_policy(Writer& w, const TransportPriority& p) { w.put(p.value); }
void get_policy(Reader& r, TransportPriority& p) { p.value = r.get<std::int32_t>(); }
void put_policy(Writer& w, const DestinationOrder& p) { put_kind(w, p.kind); }
void get_policy(Reader& r, DestinationOrder& p) { get_kind(r, p.kind, DestinationOrderKind::by_source_timestamp); }

void put_policy(Writer& w, const Presentation& p) {
  put_kind(w, p.access_scope);
  w.put(static_cast<std::uint8_t>(p.coherent_access));
  w.put(static_cast<std::uint8_t>(p.ordered_access));
}
void get_policy(Reader& r, Presentation& p) {
  get_kind(r, p.access_scope, PresentationScope::group);
  p.coherent_access = r.get<std::uint8_t>() != 0;
  p.ordered_access = r.get<std::uint8_t>() != 0;
}
void put_policy(Writer& w, const Partition& p) {
  const std::size_t begin = w.position();
  w.put(static_cast<std::uint32_t>(p.names.size()));
  for (const std::string& name : p.names) {
    w.align(4, begin);
    put_string(w, name);
  }
}
void get_policy(Reader& r, Partition& p) {
  p.names.clear();
  const auto count = r.get<std::uint32_t>();
  // A length takes four octets, so there are no more names than that.
  if (count > r.left() / 4) r.fail();
  for (std::uint32_t i = 0; i < count && !r.failed(); ++i) {
    r.align(4);
    p.names.push_back(get_string(r));
  }
}
void put_policy(Writer& w, const OpaqueData& p) { put_opaque(w, p); }
void get_policy(Reader& r, OpaqueData& p) { get_opaque(r, p); }

/// One policy of an entity.
template <class Qos>
struct Row {
  ParameterId id;
  bool is_always_announced;
  bool (*is_default)(const Qos&);
  void (*put)(Writer&, const Qos&);
  void (*get)(Reader&, Qos&);
};

template <class Qos, auto Member>
constexpr Row<Qos> row(ParameterId id, bool is_always_announced = false) {
  return {id, is_always_announced, [](const Qos& qos) { return qos.*Member == Qos{}.*Member; },
          [](Writer& writer, const Qos& qos) { put_policy(writer, qos.*Member); },
          [](Reader& reader, Qos& qos) { get_policy(reader, qos.*Member); }};
}

using W = DataWriterQos;
using R = DataReaderQos;

constexpr std::array writer_rows{
    row<W, &W::reliability>(ParameterId::reliability, true),
    row<W, &W::durability>(ParameterId::durability),
    row<W, &W::durability_service>(ParameterId::durability_service),
    row<W, &W::history>(ParameterId::history),
    row<W, &W::resource_limits>(ParameterId::resource_limits),
    row<W, &W::deadline>(ParameterId::deadline),
    row<W, &W::latency_budget>(ParameterId::latency_budget),
    row<W, &W::liveliness>(ParameterId::liveliness),
    row<W, &W::ownership>(ParameterId::ownership),
    row<W, &W::ownership_strength>(ParameterId::ownership_strength),
    row<W, &W::lifespan>(ParameterId::lifespan),
    row<W, &W::transport_priority>(ParameterId::transport_priority),
    row<W, &W::destination_order>(ParameterId::destination_order),
    row<W, &W::presentation>(ParameterId::presentation),
    row<W, &W::partition>(ParameterId::partition),
    row<W, &W::user_data>(ParameterId::user_data),
    row<W, &W::topic_data>(ParameterId::topic_data),
    row<W, &W::group_data>(ParameterId::group_data),
};

constexpr std::array reader_rows{
    row<R, &R::reliability>(ParameterId::reliability, true),
    row<R, &R::durability>(ParameterId::durability),
    row<R, &R::history>(ParameterId::history),
    row<R, &R::resource_limits>(ParameterId::resource_limits),
    row<R, &R::deadline>(ParameterId::deadline),
    row<R, &R::latency_budget>(ParameterId::latency_budget),
    row<R, &R::liveliness>(ParameterId::liveliness),
    row<R, &R::ownership>(ParameterId::ownership),
    row<R, &R::time_based_filter>(ParameterId::time_based_filter),
    row<R, &R::destination_order>(ParameterId::destination_order),
    row<R, &R::presentation>(ParameterId::presentation),
    row<R, &R::partition>(ParameterId::partition),
    row<R, &R::user_data>(ParameterId::user_data),
    row<R, &R::topic_data>(ParameterId::topic_data),
    row<R, &R::group_data>(ParameterId::group_data),
};

template <class Qos, class Rows>
void put_rows(ParameterWriter& list, const Qos& qos, const Rows& rows) {
  for (const auto& each : rows)
    if (each.is_always_announced || !each.is_default(qos))
      list.parameter(each.id, [&](Writer& writer) { each.put(writer, qos); });
}

template <class Qos, class Rows>
Taken decode_rows(const Parameter& parameter, Qos& qos, const Rows& rows) {
  for (const auto& each : rows) {
    if (!parameter.is(each.id)) continue;
    Reader reader = parameter.reader();
    each.get(reader, qos);
    return reader.failed() ? Taken::malformed : Taken::yes;
  }
  return Taken::no;
}

}  // namespace

void put_qos(ParameterWriter& list, const DataWriterQos& qos) { put_rows(list, qos, writer_rows); }
void put_qos(ParameterWriter& list, const DataReaderQos& qos) { put_rows(list, qos, reader_rows); }
Taken decode_qos(const Parameter& parameter, DataWriterQos& qos) { return decode_rows(parameter, qos, writer_rows); }
Taken decode_qos(const Parameter& parameter, DataReaderQos& qos) { return decode_rows(parameter, qos, reader_rows); }

void put_string(Writer& writer, std::string_view text) {
  writer.put(static_cast<std::uint32_t>(text.size() + 1));
  writer.put_octets(std::as_bytes(std::span(text)));
  writer.put(std::uint8_t{0});
}

std::string get_string(Reader& reader) {
  const Octets octets = reader.take(reader.get<std::uint32_t>());
  if (octets.empty()) return {};
  std::string text(reinterpret_cast<const char*>(octets.data()), octets.size() - 1);
  if (octets.back() != std::byte{0} || text.find('\0') != std::string::npos) reader.fail();
  return text;
}

void put_opaque(Writer& writer, const OpaqueData& data) {
  writer.put(static_cast<std::uint32_t>(data.octets.size()));
  writer.put_octets(data.octets);
}

void get_opaque(Reader& reader, OpaqueData& data) {
  const Octets octets = reader.take(reader.get<std::uint32_t>());
  data.octets.assign(octets.begin(), octets.end());
}

}  // namespace takt::dds
