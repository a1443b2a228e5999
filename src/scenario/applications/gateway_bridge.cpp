#include "scenario/applications/gateway_bridge.hpp"

#include <algorithm>

#include "sim/check.hpp"

namespace takt::scenario {
namespace {

// The values have the same order.
static_assert(static_cast<gateway::Overflow>(plant::Overflow::keep_latest) == gateway::Overflow::keep_latest);

std::vector<gateway::DataSetField> fields_of(const ResolvedTopic& topic) {
  std::vector<gateway::DataSetField> fields;
  for (const SampleLayout::Field& field : topic.layout.fields()) fields.push_back({field.name, {field.type, field.count > 1, field.count > 1 ? field.count : 0, 0}});
  return fields;
}

gateway::TypeMapping sound_mapping(const ResolvedTopic& from, const ResolvedTopic& to) {
  std::vector<std::string> problems;
  auto mapping = mapping_between(from, to, problems);
  TAKT_CHECK(mapping.has_value(), "a mapping that was checked");
  return std::move(*mapping);
}

void add(gateway::ChannelFigures& sum, const gateway::ChannelFigures& more) {
  sum.buffer.received += more.buffer.received;
  sum.buffer.forwarded += more.buffer.forwarded;
  sum.buffer.overwritten += more.buffer.overwritten;
  sum.buffer.dropped += more.buffer.dropped;
  sum.buffer.stale += more.buffer.stale;
  if (more.age.count > 0) {
    sum.age.least = sum.age.count == 0 ? more.age.least : std::min(sum.age.least, more.age.least);
    sum.age.greatest = std::max(sum.age.greatest, more.age.greatest);
    sum.age.count += more.age.count;
    sum.age.sum_ps += more.age.sum_ps;
  }
  for (std::size_t e = 0; e < sum.mapping_errors.size(); ++e) sum.mapping_errors[e] += more.mapping_errors[e];
}

}  // namespace

gateway::IdlStruct idl_struct_of(const ResolvedTopic& topic, std::vector<std::string>& problems) {
  gateway::IdlStruct type;
  type.name = topic.description->name;
  for (const gateway::DataSetField& field : fields_of(topic)) {
    std::string problem;
    std::optional<gateway::IdlMember> member = gateway::idl_member_of({field.name, {field.type.type, false, 0, 0}}, problem);
    if (!member) {
      problems.push_back(problem);
      continue;
    }
    if (field.type.is_array) {
      member->collection = gateway::IdlCollection::array;
      member->length = field.type.array_length;
    }
    type.members.push_back(std::move(*member));
  }
  return type;
}

std::optional<gateway::TypeMapping> mapping_between(const ResolvedTopic& from, const ResolvedTopic& to, std::vector<std::string>& problems) {
  const bool to_dds = to.description->protocol == Protocol::dds;
  const gateway::IdlStruct type = idl_struct_of(to_dds ? to : from, problems);
  if (!problems.empty()) return std::nullopt;
  return gateway::TypeMapping::make(to_dds ? gateway::Direction::to_dds : gateway::Direction::to_opc_ua, fields_of(to_dds ? from : to), type, {}, problems);
}

GatewayBridge::GatewayBridge(const ResolvedGateway& settings, const ResolvedTopic& from, const ResolvedTopic& to)
    : settings_(&settings),
      mapping_(sound_mapping(from, to)),
      to_dds_(to.description->protocol == Protocol::dds),
      cdr_((to_dds_ ? to : from).layout),
      fields_((to_dds_ ? from : to).layout),
      out_(to.layout.zeros()) {}

void GatewayBridge::start() {
  channel_ = std::make_unique<gateway::Channel>(
      mapping_, gateway::BufferSettings{settings_->capacity, static_cast<gateway::Overflow>(settings_->overflow), settings_->stale_after});
}

void GatewayBridge::crash() {
  if (channel_) add(before_, channel_->figures());
  channel_.reset();
}

void GatewayBridge::receive(uadp::Octets sample, sim::LocalTime now) {
  if (to_dds_) {
    fields_.set(sample);
    octets_.resize(sample.size() + 8 * fields_.field_count());
    uadp::Writer writer(octets_);
    for (std::size_t i = 0; i < fields_.field_count(); ++i) fields_.put(writer, i);
    octets_.resize(writer.position());
  } else {
    octets_.resize(cdr_.octets());
    cdr_.encode(sample, octets_);
  }
  channel_->receive(octets_, now);
}

std::optional<uadp::Octets> GatewayBridge::pull(sim::LocalTime now) {
  const auto value = channel_->pull(now);
  if (!value) return std::nullopt;
  if (to_dds_) {
    const bool sound = cdr_.decode(value->octets, out_);
    TAKT_CHECK(sound, "a payload of the mapping is one of the topic");
    return out_;
  }
  uadp::Reader reader(value->octets);
  for (std::size_t i = 0; i < fields_.field_count(); ++i) {
    const bool taken = fields_.take(i, uadp::get_variant(reader));
    TAKT_CHECK(taken, "fields of the mapping are those of the topic");
  }
  return fields_.get();
}

gateway::ChannelFigures GatewayBridge::figures() const {
  gateway::ChannelFigures figures = before_;
  if (channel_) add(figures, channel_->figures());
  return figures;
}

}  // namespace takt::scenario
