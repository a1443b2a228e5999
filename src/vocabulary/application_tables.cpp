// The words of applications. See json/fields.hpp.
#include "vocabulary/application.hpp"

namespace takt::vocabulary {
namespace {

using json::name;
using json::optional;

}  // namespace

const json::Enumeration& describe(json::Type<Protocol>) {
  static constexpr json::EnumName names[] = {
      name(Protocol::opc_ua, "opc-ua", "OPC UA PubSub: UADP over UDP multicast"),
      name(Protocol::dds, "dds", "DDS: RTPS over UDP"),
  };
  static constexpr json::Enumeration table = json::enumeration<Protocol>("a protocol", names);
  return table;
}

const json::Enumeration& describe(json::Type<Pattern>) {
  static constexpr json::EnumName names[] = {
      name(Pattern::counter, "counter", "the first field, keys apart, counts the publications, from 1 on"),
      name(Pattern::alternate, "alternate", "the first field, keys apart, is 1 and 0 by turns"),
  };
  static constexpr json::Enumeration table = json::enumeration<Pattern>("a pattern", names);
  return table;
}

const json::Object& describe(json::Type<Payload>) {
  static constexpr json::Field fields[] = {
      optional<&Payload::pattern>("pattern", "What the first field of each sample is that is no key; all other values are zero."),
      optional<&Payload::copy_of>("copy_of", "A topic that the application subscribes to: its newest sample is published; nothing before the first one."),
      optional<&Payload::instance>("instance", "Of a topic with keys: what its key fields hold; 0 if absent."),
      optional<&Payload::instances>("instances", "Of a topic with keys: so many instances, from that one on, by turns; 1 if absent.", {.min = 1, .max = 1'000'000}),
  };
  static constexpr std::string_view contents[] = {"pattern", "copy_of"};
  static constexpr json::Group groups[] = {json::exactly_one_of(contents)};
  static constexpr json::Object table = json::object<Payload>("payload", "What a thread publishes.", fields, {.groups = groups, .shorthand = "pattern"});
  return table;
}

const json::Enumeration& describe(json::Type<Overflow>) {
  static constexpr json::EnumName names[] = {
      name(Overflow::overwrite_oldest, "overwrite-oldest", "the oldest sample makes room"),
      name(Overflow::drop_newest, "drop-newest", "what finds no room is dropped"),
      name(Overflow::keep_latest, "keep-latest", "only the newest sample is kept"),
  };
  static constexpr json::Enumeration table = json::enumeration<Overflow>("an overflow policy", names);
  return table;
}

}  // namespace takt::vocabulary
