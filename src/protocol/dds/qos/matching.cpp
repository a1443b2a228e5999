// SPDX-License-Identifier: Apache-2.0
#include "dds/qos/matching.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace takt::dds {
namespace {

using Reason = std::optional<std::string>;

constexpr std::array<std::string_view, 2> reliability_names{"BEST_EFFORT", "RELIABLE"};
constexpr std::array<std::string_view, 4> durability_names{"VOLATILE", "TRANSIENT_LOCAL", "TRANSIENT", "PERSISTENT"};
constexpr std::array<std::string_view, 3> liveliness_names{"AUTOMATIC", "MANUAL_BY_PARTICIPANT", "MANUAL_BY_TOPIC"};
constexpr std::array<std::string_view, 2> ownership_names{"SHARED", "EXCLUSIVE"};
constexpr std::array<std::string_view, 2> order_names{"BY_RECEPTION_TIMESTAMP", "BY_SOURCE_TIMESTAMP"};
constexpr std::array<std::string_view, 3> scope_names{"INSTANCE", "TOPIC", "GROUP"};

std::string reason(std::string_view offered, std::string_view requested) {
  return "offered " + std::string(offered) + ", requested " + std::string(requested);
}

template <class Kind, std::size_t Size>
Reason at_least(Kind offered, Kind requested, const std::array<std::string_view, Size>& names) {
  if (offered >= requested) return std::nullopt;
  return reason(names[static_cast<std::size_t>(offered)], names[static_cast<std::size_t>(requested)]);
}

std::string text(sim::Duration duration) {
  if (duration == infinite) return "infinite";
  // Whole microseconds read best; what is finer is told in picoseconds.
  return duration.ps() % 1'000'000 == 0 ? std::to_string(duration.ps() / 1'000'000) + " us"
                                        : std::to_string(duration.ps()) + " ps";
}

Reason at_most(sim::Duration offered, sim::Duration requested) {
  if (offered <= requested) return std::nullopt;
  return reason(text(offered), text(requested));
}

Reason reliability(const DataWriterQos& w, const DataReaderQos& r) {
  return at_least(w.reliability.kind, r.reliability.kind, reliability_names);
}
Reason durability(const DataWriterQos& w, const DataReaderQos& r) {
  return at_least(w.durability.kind, r.durability.kind, durability_names);
}
Reason deadline(const DataWriterQos& w, const DataReaderQos& r) {
  return at_most(w.deadline.period, r.deadline.period);
}
Reason latency_budget(const DataWriterQos& w, const DataReaderQos& r) {
  return at_most(w.latency_budget.duration, r.latency_budget.duration);
}

Reason liveliness(const DataWriterQos& w, const DataReaderQos& r) {
  if (Reason kind = at_least(w.liveliness.kind, r.liveliness.kind, liveliness_names)) return kind;
  const Reason lease = at_most(w.liveliness.lease_duration, r.liveliness.lease_duration);
  return lease ? Reason("lease duration: " + *lease) : std::nullopt;
}

Reason ownership(const DataWriterQos& w, const DataReaderQos& r) {
  if (w.ownership == r.ownership) return std::nullopt;
  return reason(ownership_names[static_cast<std::size_t>(w.ownership.kind)],
                ownership_names[static_cast<std::size_t>(r.ownership.kind)]);
}

Reason destination_order(const DataWriterQos& w, const DataReaderQos& r) {
  return at_least(w.destination_order.kind, r.destination_order.kind, order_names);
}

Reason presentation(const DataWriterQos& w, const DataReaderQos& r) {
  if (Reason scope = at_least(w.presentation.access_scope, r.presentation.access_scope, scope_names))
    return "access scope: " + *scope;
  if (r.presentation.coherent_access && !w.presentation.coherent_access)
    return "coherent access: " + reason("no", "yes");
  if (r.presentation.ordered_access && !w.presentation.ordered_access) return "ordered access: " + reason("no", "yes");
  return std::nullopt;
}

std::string text(const Partition& partition) {
  std::string list;
  for (const std::string& name : partition.names) list += (list.empty() ? "\"" : ", \"") + name + "\"";
  return list.empty() ? "\"\"" : list;
}

Reason partition(const DataWriterQos& w, const DataReaderQos& r) {
  if (have_common_partition(w.partition, r.partition)) return std::nullopt;
  return "no common name: " + reason(text(w.partition), text(r.partition));
}

struct Rule {
  PolicyId policy;
  std::string_view name;
  Reason (*mismatch)(const DataWriterQos&, const DataReaderQos&);
};

/// DDS 1.4, 2.2.3, "RxO", and the partitions.
constexpr std::array<Rule, 9> rules{{
    {PolicyId::reliability, "reliability", reliability},
    {PolicyId::durability, "durability", durability},
    {PolicyId::presentation, "presentation", presentation},
    {PolicyId::deadline, "deadline", deadline},
    {PolicyId::latency_budget, "latency_budget", latency_budget},
    {PolicyId::ownership, "ownership", ownership},
    {PolicyId::liveliness, "liveliness", liveliness},
    {PolicyId::destination_order, "destination_order", destination_order},
    {PolicyId::partition, "partition", partition},
}};

bool is_pattern(std::string_view name) { return name.find_first_of("*?[") != std::string_view::npos; }

bool names_fit(std::string_view a, std::string_view b) {
  if (is_pattern(a) && is_pattern(b)) return false;
  return is_pattern(a) ? fits_pattern(a, b) : is_pattern(b) ? fits_pattern(b, a) : a == b;
}

/// [...] at the front of a pattern: how long it is, and whether it has the letter. Length 0: it does not end, so [
/// stands for itself.
struct Bracket {
  std::size_t length = 0;
  bool has_letter = false;
};

Bracket bracket_of(std::string_view pattern, char letter) {
  const bool is_inverted = pattern.size() > 1 && (pattern[1] == '!' || pattern[1] == '^');
  const std::size_t first = is_inverted ? 2 : 1;
  bool has_letter = false;
  for (std::size_t i = first; i < pattern.size(); ++i) {
    if (pattern[i] == ']' && i != first) return {i + 1, has_letter != is_inverted};
    if (i + 2 < pattern.size() && pattern[i + 1] == '-' && pattern[i + 2] != ']') {
      has_letter = has_letter || (pattern[i] <= letter && letter <= pattern[i + 2]);
      i += 2;
    } else {
      has_letter = has_letter || pattern[i] == letter;
    }
  }
  return {};
}

/// Octets at the front of a pattern that fit one letter; 0 if they do not fit it.
std::size_t fit_one(std::string_view pattern, char letter) {
  if (pattern.empty()) return 0;
  if (pattern[0] == '?') return 1;
  if (pattern[0] == '[') {
    const Bracket bracket = bracket_of(pattern, letter);
    if (bracket.length != 0) return bracket.has_letter ? bracket.length : 0;
  }
  return pattern[0] == letter ? 1 : 0;
}

const std::vector<DataRepresentation>& or_default(const std::vector<DataRepresentation>* list) {
  static const std::vector<DataRepresentation> xcdr1{DataRepresentation::xcdr1};
  return list == nullptr || list->empty() ? xcdr1 : *list;
}

}  // namespace

std::string_view name_of(PolicyId policy) {
  const auto found = std::find_if(rules.begin(), rules.end(), [&](const Rule& rule) { return rule.policy == policy; });
  return found != rules.end() ? found->name : "data_representation";
}

std::vector<Mismatch> mismatches_of(const DataWriterQos& offered, const DataReaderQos& requested) {
  std::vector<Mismatch> list;
  for (const Rule& rule : rules)
    if (Reason why = rule.mismatch(offered, requested)) list.push_back({rule.policy, *std::move(why)});
  return list;
}

// A star fits as little as it can, and one letter more each time the rest does not fit: never more than |pattern| *
// |name| steps.
bool fits_pattern(std::string_view pattern, std::string_view name) {
  std::size_t p = 0;
  std::size_t n = 0;
  std::size_t star = std::string_view::npos;
  std::size_t star_name = 0;
  while (n < name.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      star_name = n;
    } else if (const std::size_t fitted = fit_one(pattern.substr(p), name[n]); fitted != 0) {
      p += fitted;
      ++n;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      n = ++star_name;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

bool have_common_partition(const Partition& a, const Partition& b) {
  static const std::vector<std::string> unnamed{""};
  const auto& ours = a.names.empty() ? unnamed : a.names;
  const auto& theirs = b.names.empty() ? unnamed : b.names;
  for (const std::string& one : ours)
    for (const std::string& other : theirs)
      if (names_fit(one, other)) return true;
  return false;
}

Matching match(const WriterDescription& writer, const ReaderDescription& reader) {
  Matching matching;
  if (writer.topic != reader.topic) return matching;
  if (writer.type != reader.type) {
    matching.relation = Relation::other_type;
    matching.reason = "topic " + std::string(writer.topic) + ": " + reason(writer.type, reader.type);
    return matching;
  }
  matching.mismatches = mismatches_of(*writer.qos, *reader.qos);
  // A writer writes in the first representation of its list (DDS-XTypes 7.6.3.1.1).
  const auto& readable = or_default(reader.representations);
  const DataRepresentation written = or_default(writer.representations).front();
  if (std::find(readable.begin(), readable.end(), written) == readable.end()) {
    constexpr std::array<std::string_view, 3> names{"XCDR1", "XML", "XCDR2"};
    const auto name = [&](DataRepresentation each) {
      return static_cast<std::size_t>(each) < names.size() ? names[static_cast<std::size_t>(each)] : "another";
    };
    matching.mismatches.push_back({PolicyId::data_representation, reason(name(written), name(readable.front()))});
  }
  matching.relation = matching.mismatches.empty() ? Relation::matched : Relation::incompatible;
  for (const Mismatch& each : matching.mismatches)
    matching.reason += (matching.reason.empty() ? "" : "; ") + std::string(name_of(each.policy)) + ": " + each.reason;
  return matching;
}

}  // namespace takt::dds
