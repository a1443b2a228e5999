// SPDX-License-Identifier: Apache-2.0
// DDS by Eclipse Cyclone DDS 0.10. Its own types come from its IDL compiler; payloads that are CDR already, of types
// that are known at run time only, pass through it as octets: that is what the sertype and the serdata here are for.
#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <vector>

#include "node/dds/participant.hpp"

namespace takt::node {
namespace {

using uadp::Octets;

constexpr std::size_t header_octets = 4;

struct RawData : ddsi_serdata {
  std::vector<std::byte> payload;  ///< filled up to a multiple of 4, for Cyclone sends so much
  std::size_t size = 0;            ///< without that
  gateway::KeyHash key{};          ///< zeros in topics without key

  void fill_up() {
    size = payload.size();
    payload.resize((size + 3) / 4 * 4);
  }
};

const RawData& raw(const ddsi_serdata* data) { return *static_cast<const RawData*>(data); }

struct RawType : ddsi_sertype {
  gateway::KeyLayout key;
};

const gateway::KeyLayout& key_of(const ddsi_sertype* type) { return static_cast<const RawType*>(type)->key; }

/// Only samples that are whole come this far.
RawData* make_data(const ddsi_sertype* type, ddsi_serdata_kind kind) {
  auto* const data = new RawData{};
  ddsi_serdata_init(data, type, kind);
  return data;
}

/// The payload is complete: what follows from it. What tells of an instance only has the key for a payload.
ddsi_serdata* completed(RawData* data) {
  const gateway::KeyLayout& key = key_of(data->type);
  if (key.has_key()) data->key = data->kind == SDK_DATA ? key.of_data(data->payload) : key.of_key(data->payload);
  std::uint32_t hash = 2166136261u;  // FNV-1a
  for (const std::uint8_t octet : data->key) hash = (hash ^ octet) * 16777619u;
  data->hash = data->type->serdata_basehash ^ (key.has_key() ? hash : 0u);
  data->fill_up();
  return data;
}

/// Of an instance, its key in big-endian CDR.
ddsi_serdata* data_of_key(const ddsi_sertype* type, std::span<const std::uint8_t> key) {
  RawData* const data = make_data(type, SDK_KEY);
  if (!key_of(type).has_key()) return completed(data);
  data->payload.resize(header_octets);  // CDR_BE
  for (const std::uint8_t octet : key) data->payload.push_back(std::byte{octet});
  return completed(data);
}

/// Nothing if the hash is not the key: no instance follows from it.
ddsi_serdata* data_of_hash(const ddsi_sertype* type, const std::uint8_t* hash) {
  if (!key_of(type).is_in_hash()) return nullptr;
  return data_of_key(type, std::span(hash, key_of(type).octets()));
}

const std::byte* bytes(const void* at) { return static_cast<const std::byte*>(at); }

ddsi_serdata* data_from_fragments(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* fragment,
                                  std::size_t size) {
  RawData* const data = make_data(type, kind);
  data->payload.reserve(size);
  for (; fragment != nullptr; fragment = fragment->nextfrag) {
    if (fragment->maxp1 <= data->payload.size()) continue;
    const unsigned char* const payload = NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    const std::size_t known = data->payload.size() - fragment->min;
    data->payload.insert(data->payload.end(), bytes(payload) + known,
                         bytes(payload) + (fragment->maxp1 - fragment->min));
  }
  return completed(data);
}

ddsi_serdata* data_from_parts(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                              const ddsrt_iovec_t* parts, std::size_t size) {
  RawData* const data = make_data(type, kind);
  data->payload.reserve(size);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
    const std::size_t length = std::min(parts[i].iov_len, size - data->payload.size());
    data->payload.insert(data->payload.end(), bytes(parts[i].iov_base), bytes(parts[i].iov_base) + length);
  }
  return completed(data);
}

/// A sample of the application is an Octets when it writes, a vector when it takes.
ddsi_serdata* data_from_sample(const ddsi_sertype* type, ddsi_serdata_kind kind, const void* sample) {
  const Octets payload = *static_cast<const Octets*>(sample);
  if (kind != SDK_DATA) return data_of_key(type, key_of(type).key_in_data(payload));
  RawData* const data = make_data(type, kind);
  data->payload.assign(payload.begin(), payload.end());
  return completed(data);
}

bool data_to_sample(const ddsi_serdata* data, void* sample, void**, void*) {
  const auto begin = raw(data).payload.begin();
  static_cast<std::vector<std::byte>*>(sample)->assign(begin, begin + static_cast<std::ptrdiff_t>(raw(data).size));
  return true;
}

void data_to_octets(const ddsi_serdata* data, std::size_t offset, std::size_t size, void* target) {
  std::memcpy(target, raw(data).payload.data() + offset, size);
}

ddsi_serdata* data_lend(const ddsi_serdata* data, std::size_t offset, std::size_t size, ddsrt_iovec_t* part) {
  part->iov_base = const_cast<std::byte*>(raw(data).payload.data() + offset);
  part->iov_len = size;
  return ddsi_serdata_ref(data);
}

constexpr ddsi_serdata_ops make_data_operations() {
  ddsi_serdata_ops ops = {};
  ops.eqkey = [](const ddsi_serdata* one, const ddsi_serdata* other) { return raw(one).key == raw(other).key; };
  ops.get_size = [](const ddsi_serdata* data) { return static_cast<std::uint32_t>(raw(data).size); };
  ops.from_ser = data_from_fragments;
  ops.from_ser_iov = data_from_parts;
  ops.from_keyhash = [](const ddsi_sertype* type, const ddsi_keyhash* hash) -> ddsi_serdata* {
    return data_of_hash(type, hash->value);
  };
  ops.from_sample = data_from_sample;
  ops.to_ser = data_to_octets;
  ops.to_ser_ref = data_lend;
  ops.to_ser_unref = [](ddsi_serdata* data, const ddsrt_iovec_t*) { ddsi_serdata_unref(data); };
  ops.to_sample = data_to_sample;
  ops.to_untyped = [](const ddsi_serdata* data) -> ddsi_serdata* {
    const gateway::KeyLayout& key = key_of(data->type);
    ddsi_serdata* const untyped = data_of_key(
        data->type, data->kind == SDK_DATA ? key.key_in_data(raw(data).payload) : key.key_in_key(raw(data).payload));
    untyped->type = nullptr;
    return untyped;
  };
  ops.untyped_to_sample = [](const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) { return true; };
  ops.free = [](ddsi_serdata* data) { delete static_cast<RawData*>(data); };
  ops.print = [](const ddsi_sertype*, const ddsi_serdata*, char* text, std::size_t size) -> std::size_t {
    if (size > 0) text[0] = '\0';
    return 0;
  };
  ops.get_keyhash = [](const ddsi_serdata* data, ddsi_keyhash* hash, bool) {
    std::copy(raw(data).key.begin(), raw(data).key.end(), hash->value);
  };
  return ops;
}

constexpr ddsi_sertype_ops make_type_operations() {
  ddsi_sertype_ops ops = {};
  ops.version = ddsi_sertype_v0;
  ops.free = [](ddsi_sertype* type) {
    ddsi_sertype_fini(type);
    delete static_cast<RawType*>(type);
  };
  ops.zero_samples = [](const ddsi_sertype*, void*, std::size_t) {};
  // A content filter has a sample made, looks at it, and gives it back.
  ops.realloc_samples = [](void** samples, const ddsi_sertype*, void*, std::size_t, std::size_t count) {
    std::generate_n(samples, count, [] { return new std::vector<std::byte>; });
  };
  ops.free_samples = [](const ddsi_sertype*, void** samples, std::size_t count, dds_free_op_t what) {
    if ((what & DDS_FREE_ALL_BIT) == 0) return;
    for (std::size_t i = 0; i < count; ++i) delete static_cast<std::vector<std::byte>*>(samples[i]);
  };
  ops.equal = [](const ddsi_sertype*, const ddsi_sertype*) { return true; };
  ops.hash = [](const ddsi_sertype*) { return std::uint32_t{0}; };
  return ops;
}

const ddsi_serdata_ops data_operations = make_data_operations();
const ddsi_sertype_ops type_operations = make_type_operations();

using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

std::int32_t limit_of(const std::optional<std::uint32_t>& limit) {
  return limit ? static_cast<std::int32_t>(*limit) : DDS_LENGTH_UNLIMITED;
}
dds_duration_t ns_of(const std::optional<sim::Duration>& duration, dds_duration_t absent) {
  return duration ? duration->ps() / 1000 : absent;
}

Qos qos_of(const plant::Qos& asked, std::string& problem) {
  using namespace plant;
  Qos qos(dds_create_qos(), &dds_delete_qos);
  const bool is_reliable = asked.reliability == Reliability::reliable;
  dds_qset_reliability(qos.get(), is_reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       ns_of(asked.max_blocking_time, DDS_MSECS(100)));
  switch (asked.durability.value_or(Durability::volatile_)) {
    case Durability::volatile_:
      dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
      break;
    case Durability::transient_local:
      dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
      break;
    default:
      problem = "Cyclone DDS keeps no transient and no persistent data";
  }
  const auto depth = static_cast<std::int32_t>(asked.depth.value_or(1));
  const dds_history_kind_t history = asked.history == History::keep_all ? DDS_HISTORY_KEEP_ALL : DDS_HISTORY_KEEP_LAST;
  dds_qset_history(qos.get(), history, depth);
  dds_qset_deadline(qos.get(), ns_of(asked.deadline, DDS_INFINITY));
  dds_qset_latency_budget(qos.get(), ns_of(asked.latency_budget, 0));
  constexpr dds_liveliness_kind_t liveliness[] = {DDS_LIVELINESS_AUTOMATIC, DDS_LIVELINESS_MANUAL_BY_PARTICIPANT,
                                                  DDS_LIVELINESS_MANUAL_BY_TOPIC};
  dds_qset_liveliness(qos.get(), liveliness[static_cast<std::size_t>(asked.liveliness.value_or(Liveliness::automatic))],
                      ns_of(asked.lease_duration, DDS_INFINITY));
  dds_qset_ownership(qos.get(),
                     asked.ownership == Ownership::exclusive ? DDS_OWNERSHIP_EXCLUSIVE : DDS_OWNERSHIP_SHARED);
  dds_qset_ownership_strength(qos.get(), asked.ownership_strength.value_or(0));
  dds_qset_lifespan(qos.get(), ns_of(asked.lifespan, DDS_INFINITY));
  dds_qset_time_based_filter(qos.get(), ns_of(asked.time_based_filter, 0));
  dds_qset_destination_order(qos.get(), asked.destination_order == DestinationOrder::by_source
                                            ? DDS_DESTINATIONORDER_BY_SOURCE_TIMESTAMP
                                            : DDS_DESTINATIONORDER_BY_RECEPTION_TIMESTAMP);
  const ResourceLimits limits = asked.resource_limits.value_or(ResourceLimits{});
  dds_qset_resource_limits(qos.get(), limit_of(limits.max_samples), limit_of(limits.max_instances),
                           limit_of(limits.max_samples_per_instance));
  // What a transient-local writer has for late readers is its history (DDS 1.4, 2.2.3.4). Cyclone limits it by the
  // policy of durability services, which by itself is one sample.
  dds_qset_durability_service(qos.get(), 0, history, depth, limit_of(limits.max_samples),
                              limit_of(limits.max_instances), limit_of(limits.max_samples_per_instance));
  if (asked.partition) {
    std::vector<const char*> names;
    for (const std::string& name : *asked.partition) names.push_back(name.c_str());
    dds_qset_partition(qos.get(), static_cast<std::uint32_t>(names.size()), names.data());
  }
  return qos;
}

class CycloneWriter final : public DdsWriter {
 public:
  explicit CycloneWriter(dds_entity_t writer) : writer_(writer) {}
  SendOutcome write(Octets payload) override {
    const dds_return_t code = dds_write(writer_, &payload);
    return code == DDS_RETCODE_OK        ? SendOutcome::sent
           : code == DDS_RETCODE_TIMEOUT ? SendOutcome::timed_out
                                         : SendOutcome::failed;
  }
  std::uint32_t matched() const override {
    dds_publication_matched_status_t status = {};
    return dds_get_publication_matched_status(writer_, &status) == DDS_RETCODE_OK ? status.current_count : 0;
  }

 private:
  dds_entity_t writer_;
};

class CycloneReader final : public DdsReader {
 public:
  explicit CycloneReader(dds_entity_t reader) : reader_(reader) {}
  std::span<const std::vector<std::byte>> take() override {
    constexpr std::uint32_t at_once = 256;
    std::size_t count = 0;
    for (std::int32_t taken = at_once; taken == at_once && count + at_once <= most_taken;) {
      if (payloads_.size() < count + at_once) payloads_.resize(count + at_once);
      std::array<void*, at_once> samples;
      for (std::size_t i = 0; i < at_once; ++i) samples[i] = &payloads_[count + i];
      std::array<dds_sample_info_t, at_once> infos;
      taken = dds_take(reader_, samples.data(), infos.data(), at_once, at_once);
      const std::size_t first = count;
      for (std::size_t i = 0; i < static_cast<std::size_t>(std::max(taken, 0)); ++i)
        // The others say that a writer has gone.
        if (infos[i].valid_data && payloads_[first + i].size() >= header_octets)
          std::swap(payloads_[count++], payloads_[first + i]);
    }
    return std::span(payloads_).first(count);
  }
  std::uint32_t matched() const override {
    dds_subscription_matched_status_t status = {};
    return dds_get_subscription_matched_status(reader_, &status) == DDS_RETCODE_OK ? status.current_count : 0;
  }

 private:
  dds_entity_t reader_;
  std::vector<std::vector<std::byte>> payloads_;
};

class CycloneParticipant final : public DdsParticipant {
 public:
  CycloneParticipant(dds_entity_t domain, dds_entity_t participant) : domain_(domain), participant_(participant) {}
  ~CycloneParticipant() override {
    dds_delete(participant_);
    if (domain_ > 0) dds_delete(domain_);
  }

  DdsWriter* add_writer(const DdsTopic& topic, std::string& problem) override {
    const dds_entity_t entity = add(topic, dds_create_writer, "a writer", problem);
    return entity < 0 ? nullptr : writers_.emplace_back(std::make_unique<CycloneWriter>(entity)).get();
  }
  DdsReader* add_reader(const DdsTopic& topic, std::string& problem) override {
    const dds_entity_t entity = add(topic, dds_create_reader, "a reader", problem);
    return entity < 0 ? nullptr : readers_.emplace_back(std::make_unique<CycloneReader>(entity)).get();
  }

 private:
  template <class Create>
  dds_entity_t add(const DdsTopic& asked, Create create, const char* what, std::string& problem) {
    const Qos qos = qos_of(asked.qos, problem);
    if (!problem.empty()) return -1;
    auto* const made = new RawType{};
    made->key = asked.key;
    ddsi_sertype* type = made;
    ddsi_sertype_init(type, asked.type.c_str(), &type_operations, &data_operations, !asked.key.has_key());
    const dds_entity_t topic =
        dds_create_topic_sertype(participant_, asked.name.c_str(), &type, nullptr, nullptr, nullptr);
    if (topic < 0) {
      ddsi_sertype_unref(type);
      problem = "topic " + asked.name + ": " + dds_strretcode(topic);
      return -1;
    }
    if (asked.passes) {
      dds_topic_filter filter = {};
      filter.mode = DDS_TOPIC_FILTER_SAMPLE_ARG;
      filter.f.sample_arg = [](const void* sample, void* passes) {
        return (*static_cast<const Passes*>(passes))(*static_cast<const std::vector<std::byte>*>(sample));
      };
      filter.arg = filters_.emplace_back(std::make_unique<Passes>(asked.passes)).get();
      if (const dds_return_t code = dds_set_topic_filter_extended(topic, &filter); code != DDS_RETCODE_OK) {
        problem = "the filter of topic " + asked.name + ": " + dds_strretcode(code);
        return -1;
      }
    }
    const dds_entity_t entity = create(participant_, topic, qos.get(), nullptr);
    if (entity < 0) problem = std::string(what) + " of topic " + asked.name + ": " + dds_strretcode(entity);
    return entity;
  }

  using Passes = std::function<bool(Octets)>;

  dds_entity_t domain_;  ///< 0: the implementation makes it by itself
  dds_entity_t participant_;
  std::vector<std::unique_ptr<CycloneWriter>> writers_;
  std::vector<std::unique_ptr<CycloneReader>> readers_;
  std::vector<std::unique_ptr<Passes>> filters_;  // of their topics; until these are gone
};

}  // namespace

bool has_dds() { return true; }

std::unique_ptr<DdsParticipant> open_dds(std::uint16_t domain, const std::string& interface, std::string& problem) {
  dds_entity_t made = 0;
  if (!interface.empty()) {
    const std::string config = "<General><Interfaces><NetworkInterface name=\"" + interface +
                               "\"/></Interfaces><AllowMulticast>true</AllowMulticast></General>";
    made = dds_create_domain(domain, config.c_str());
    if (made < 0) {
      problem = "DDS domain " + std::to_string(domain) + " on " + interface + ": " + dds_strretcode(made);
      return nullptr;
    }
  }
  const dds_entity_t participant = dds_create_participant(domain, nullptr, nullptr);
  if (participant < 0) {
    problem = "a DDS participant in domain " + std::to_string(domain) + ": " + dds_strretcode(participant);
    if (made > 0) dds_delete(made);
    return nullptr;
  }
  return std::make_unique<CycloneParticipant>(made, participant);
}

}  // namespace takt::node
