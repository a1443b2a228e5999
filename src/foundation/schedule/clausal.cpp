// SPDX-License-Identifier: Apache-2.0
#include "schedule/clausal.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "schedule/clauses.hpp"
#include "schedule/sat.hpp"
#include "schedule/trim.hpp"

namespace takt::schedule {
namespace {

struct Refuted {
  Certificate certificate;
  std::vector<StreamIndex> needed;  ///< streams that the proof speaks of
};

class ClausalRefuter {
 public:
  ClausalRefuter(const Problem& problem, const ClausalEffort& effort, const Stop& stop)
      : problem_(problem),
        effort_(effort),
        stop_(stop),
        crossings_(problem),
        courses_(problem.streams.size()),
        asked_(problem.streams.size()) {}

  bool has_course(StreamIndex stream) {
    if (!asked_[stream]) courses_[stream] = course_of(crossings_, problem_.streams[stream]);
    asked_[stream] = 1;
    return courses_[stream] && !courses_[stream]->links.empty();
  }

  /// Coarse thresholds first: they are few, and what they refute is refuted.
  std::optional<Refuted> refute(std::span<const StreamIndex> streams, std::uint32_t conflicts) {
    ClauseMaker maker(problem_, streams, courses_);
    for (const Ps width : widths(streams, maker.unit())) {
      if (maker.size(width) > effort_.most_thresholds || stop_()) break;
      Clauses clauses = maker.make(width);
      made_ += clauses.clauses.size();
      const SatAnswer answer =
          solve(clauses.clauses, static_cast<std::uint32_t>(clauses.thresholds.size()), conflicts, stop_);
      if (answer.verdict == SatAnswer::Verdict::unknown) break;
      if (answer.verdict == SatAnswer::Verdict::satisfiable) continue;
      auto trimmed = trim(clauses.clauses, clauses.thresholds, answer.proof);
      if (!trimmed) continue;
      Refuted refuted;
      refuted.certificate.kind = Certificate::Kind::clausal;
      refuted.certificate.in_time = true;
      refuted.certificate.streams.assign(streams.begin(), streams.end());
      refuted.certificate.clauses = std::move(trimmed->proof);
      refuted.certificate.clauses.anchor = clauses.anchor;
      std::set<StreamIndex> needed;
      for (const std::uint32_t axiom : trimmed->axioms)
        needed.insert({clauses.about[axiom].first, clauses.about[axiom].second});
      for (const StreamIndex s : streams)
        if (needed.contains(s)) refuted.needed.push_back(s);
      return refuted;
    }
    return std::nullopt;
  }

  bool is_spent() const { return made_ > effort_.most_clauses; }

  /// Drops streams as long as what is left is refuted.
  Certificate shrink(Refuted refuted) {
    std::vector<StreamIndex> kept;
    std::vector<StreamIndex> open = refuted.needed;
    const auto rest = [&] {
      std::vector<StreamIndex> all = open;
      all.insert(all.end(), kept.begin(), kept.end());
      return all;
    };
    // Those that the proof does not need go first, and at once.
    bool is_smaller = open.size() < refuted.certificate.streams.size();
    for (StreamIndex dropped = 0; is_smaller || !open.empty();) {
      if (stop_()) break;
      if (!is_smaller) {
        dropped = open.back();
        open.pop_back();
      }
      const auto streams = rest();
      auto less = streams.size() < 2 ? std::nullopt : refute(streams, 4 * effort_.conflicts);
      if (!less) {
        if (is_smaller) break;
        kept.push_back(dropped);
        continue;
      }
      const auto is_needed = [&](StreamIndex s) {
        return std::find(less->needed.begin(), less->needed.end(), s) != less->needed.end();
      };
      std::erase_if(open, [&](StreamIndex s) { return !is_needed(s); });
      std::erase_if(kept, [&](StreamIndex s) { return !is_needed(s); });
      is_smaller = less->needed.size() < less->certificate.streams.size();
      refuted = std::move(*less);
    }
    return std::move(refuted.certificate);
  }

 private:
  /// Multiples of the unit by which what the periods have in common is divided, each half of the one before or less.
  std::vector<Ps> widths(std::span<const StreamIndex> streams, Ps unit) const {
    Ps common = 0, least = longest_time;
    for (const StreamIndex s : streams) {
      common = std::gcd(common, problem_.streams[s].period);
      for (const Course::At& at : courses_[s]->links) least = std::min(least, at.work);
    }
    std::vector<Ps> all;
    const Ps parts = common / unit;
    Ps limit = std::max<Ps>(1, least / unit);
    while (limit >= 1) {
      Ps best = 1;
      for (Ps d = limit; d > 1 && best == 1; --d)
        if (parts % d == 0) best = d;
      all.push_back(best * unit);
      if (best == 1) break;
      limit = best / 2;
    }
    return all;
  }

  const Problem& problem_;
  const ClausalEffort& effort_;
  const Stop& stop_;
  Crossings crossings_;
  std::vector<std::optional<Course>> courses_;
  std::vector<std::uint8_t> asked_;
  std::uint64_t made_ = 0;  ///< clauses
};

}  // namespace

std::optional<Certificate> refute_streams(const Problem& problem, std::span<const StreamIndex> streams,
                                          const ClausalEffort& effort, const Stop& stop) {
  if (!problem.model.is_strict || !has_sat_solver()) return std::nullopt;
  ClausalRefuter refuter(problem, effort, stop);
  for (const StreamIndex s : streams)
    if (!refuter.has_course(s)) return std::nullopt;
  auto found = refuter.refute(streams, effort.conflicts);
  return found ? std::optional(refuter.shrink(std::move(*found))) : std::nullopt;
}

std::optional<Certificate> refute_by_clauses(const Problem& problem, std::span<const std::uint64_t> hardness,
                                             const ClausalEffort& effort, const Stop& stop) {
  if (!problem.model.is_strict || !has_sat_solver()) return std::nullopt;
  ClausalRefuter refuter(problem, effort, stop);
  std::vector<StreamIndex> streams(problem.streams.size());
  std::iota(streams.begin(), streams.end(), 0u);
  std::stable_sort(streams.begin(), streams.end(),
                   [&](StreamIndex a, StreamIndex b) { return hardness[a] > hardness[b]; });
  std::vector<StreamIndex> tried;
  std::size_t size = 2;
  for (const StreamIndex s : streams) {
    if (hardness[s] == 0 || (refuter.is_spent() && tried.size() >= 3) || stop()) break;
    if (!refuter.has_course(s)) continue;
    tried.push_back(s);
    if (tried.size() < size) continue;
    size = std::max(size + 1, size * 4 / 3);
    if (auto found = refuter.refute(tried, effort.conflicts)) return refuter.shrink(std::move(*found));
  }
  return std::nullopt;
}

}  // namespace takt::schedule
