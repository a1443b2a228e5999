// SPDX-License-Identifier: Apache-2.0
#include "node/sources.hpp"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include "json/record.hpp"
#include "uadp/network_message.hpp"

namespace takt::node {
namespace {

constexpr std::int64_t forgotten_after_ns =
    10'000'000'000;  // a source of which nothing was taken, if another needs its place

struct VerdictCount {
  std::string_view verdict;
  std::uint64_t messages = 0;
};

const json::Record& describe(json::Type<VerdictCount>) {
  static constexpr json::Output outputs[] = {
      json::output<&VerdictCount::verdict>("verdict", "The reason; docs/security.md has a list."),
      json::output<&VerdictCount::messages>("messages", "How many."),
  };
  static constexpr json::Record record{"verdict_count", "Messages that were refused for one reason.", outputs};
  return record;
}

std::string address_of(const HeardSource& source) {
  return source.address.kind == SenderAddress::Kind::unknown ? "others" : to_text(source.address);
}
std::uint64_t taken_of(const HeardSource& source) { return source.count(wire::Verdict::taken); }
std::uint64_t passed_over_of(const HeardSource& source) {
  return source.count(wire::Verdict::stale) + source.count(wire::Verdict::not_running) +
         source.count(wire::Verdict::unsubscribed);
}
std::vector<VerdictCount> refusals_of(const HeardSource& source) {
  std::vector<VerdictCount> all;
  for (std::size_t i = 0; i < wire::verdict_count; ++i)
    if (wire::is_refusal(static_cast<wire::Verdict>(i)) && source.counts[i] != 0)
      all.push_back({wire::verdicts[i].name, source.counts[i]});
  return all;
}

}  // namespace

const json::Record& describe(json::Type<HeardSource>) {
  static constexpr json::Output outputs[] = {
      json::output<&address_of>("address",
                                "Where its messages come from: IPv4 address and port, or MAC address. \"others\": all "
                                "that found no place in the list."),
      json::output<&HeardSource::publisher_id>("publisher_id", "What they say; null: none, or a text."),
      json::output<&taken_of>("taken", "Messages that were taken."),
      json::output<&passed_over_of>(
          "passed_over", "Sound messages of the group with which nothing was done: stale, not running, unsubscribed."),
      json::output<&refusals_of>("refused", "Messages that were refused, by reason."),
  };
  static constexpr json::Record record{"source", "A sender that the node hears, as it calls itself.", outputs};
  return record;
}

std::uint64_t HeardSource::refused() const {
  const auto first = counts.begin() + static_cast<std::ptrdiff_t>(wire::index_of(wire::Verdict::not_uadp));
  return std::accumulate(first, counts.end(), std::uint64_t{0});
}

HeardSource& SourceTable::find(const SenderAddress& address, std::optional<std::uint64_t> publisher_id,
                               std::int64_t now_ns) {
  for (HeardSource& each : sources_)
    if (each.publisher_id == publisher_id && each.address == address) return each;
  if (sources_.size() < most_sources) return sources_.emplace_back(HeardSource{address, publisher_id, {}, now_ns, 0});
  const auto rank = [](const HeardSource& source) {
    return std::pair(source.count(wire::Verdict::taken) != 0, source.last_ns);
  };
  HeardSource& oldest = *std::min_element(
      sources_.begin(), sources_.end(), [&](const HeardSource& a, const HeardSource& b) { return rank(a) < rank(b); });
  if (oldest.count(wire::Verdict::taken) != 0 || now_ns - oldest.last_ns < forgotten_after_ns) return others_;
  return oldest = {address, publisher_id, {}, now_ns, 0};
}

bool SourceTable::count(const Arrival& arrival, wire::Verdict verdict, std::int64_t now_ns) {
  HeardSource& source = find(arrival.from, publisher_id_of(arrival.message), now_ns);
  source.last_ns = now_ns;
  if (!wire::is_refusal(verdict) || verdict == wire::Verdict::replayed) source.sound_ns = now_ns;
  return source.counts[wire::index_of(verdict)]++ == 0 && wire::is_refusal(verdict);
}

std::vector<SourceTable::Twins> SourceTable::twins(std::int64_t now_ns) const {
  std::vector<Twins> all;
  const auto is_there = [&](const HeardSource& each) {
    return each.publisher_id && each.sound_ns != 0 && now_ns - each.sound_ns < forgotten_after_ns;
  };
  for (auto one = sources_.begin(); one != sources_.end(); ++one)
    for (auto other = one + 1; is_there(*one) && other != sources_.end(); ++other)
      if (is_there(*other) && one->publisher_id == other->publisher_id)
        all.push_back({*one->publisher_id, one->address, other->address});
  return all;
}

std::vector<HeardSource> SourceTable::all() const {
  std::vector<HeardSource> all = sources_;
  const bool has_others =
      std::any_of(others_.counts.begin(), others_.counts.end(), [](std::uint64_t count) { return count != 0; });
  if (has_others) all.push_back(others_);
  return all;
}

std::optional<std::uint64_t> publisher_id_of(uadp::Octets message) {
  if (message.empty()) return std::nullopt;
  // Of a message of a Program: without looking at the rest of it.
  constexpr std::size_t at = 2;
  const bool is_usual = message.size() >= at + 2 && (std::to_integer<unsigned>(message[0]) & 0x9F) == 0x91 &&
                        (std::to_integer<unsigned>(message[1]) & 0x87) == 0x01;
  if (is_usual) return uadp::load_little_endian<std::uint16_t>(message.data() + at);
  uadp::NetworkMessage decoded;
  uadp::decode(message, decoded);
  const auto& id = decoded.header.publisher_id;
  return id && id->type != uadp::PublisherIdType::String ? std::optional(id->number) : std::nullopt;
}

}  // namespace takt::node
