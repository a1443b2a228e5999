// SPDX-License-Identifier: Apache-2.0
#include "schedule/refute.hpp"

#include <algorithm>
#include <numeric>

#include "schedule/crossings.hpp"
#include "schedule/cuts.hpp"
#include "sim/time.hpp"

namespace takt::schedule {
namespace {

using sim::int128;

/// Loads as fractions of a common denominator; where there is none in reach, with doubles and a safety beyond their
/// error.
class Sum {
 public:
  explicit Sum(std::optional<Ps> common) : common_(common) {}
  void add(Ps work, Ps of) {
    if (common_)
      exact_ += static_cast<int128>(work) * (*common_ / of);
    else
      rough_ += static_cast<double>(work) / static_cast<double>(of);
  }
  bool exceeds(std::uint64_t limit) const {
    return common_ ? exact_ > static_cast<int128>(*common_) * static_cast<int128>(limit)
                   : rough_ > static_cast<double>(limit) * (1 + 1e-9);
  }

 private:
  std::optional<Ps> common_;
  int128 exact_ = 0;
  double rough_ = 0;
};

class Refuter {
 public:
  Refuter(const Problem& problem, const Stop& stop)
      : problem_(problem),
        stop_(stop),
        crossings_(problem),
        common_(hyperperiod(problem)),
        crossing_(problem.links.size()) {}

  std::optional<Certificate> latency() {
    for (StreamIndex s = 0; s < problem_.streams.size(); ++s) {
      const Stream& stream = problem_.streams[s];
      if (!stream.latency && !stream.deadline) continue;
      const auto starts = crossings_.earliest_starts(stream);
      for (const NodeIndex listener : stream.listeners) {
        const Ps least = crossings_.arrival(stream, listener, starts);
        if (least == never || (stream.latency && least > *stream.latency) ||
            (stream.deadline && least > *stream.deadline - stream.release)) {
          Certificate certificate;
          certificate.kind = Certificate::Kind::latency;
          certificate.streams = {s};
          certificate.listener = listener;
          return certificate;
        }
      }
    }
    return std::nullopt;
  }

  /// Load, folded load and intervals of single links. `in_time`: ways that are too slow do not count as ways around a
  /// link.
  std::optional<Certificate> others(bool in_time) {
    in_time_ = in_time;
    crossing_.assign(problem_.links.size(), {});
    auto found = search();
    if (found) found->in_time = in_time;
    return found;
  }

 private:
  std::optional<Certificate> search() {
    for (StreamIndex s = 0; s < problem_.streams.size(); ++s) {
      if (stop_()) return std::nullopt;
      for (const LinkIndex l : crossings_.needed(problem_.streams[s], in_time_)) crossing_[l].push_back(s);
    }
    for (LinkIndex l = 0; l < problem_.links.size(); ++l)
      if (auto found = load(l)) return found;
    if (!in_time_)
      if (auto found = cut_load()) return found;
    if (problem_.model.is_strict) {
      if (moduli_.empty()) note_moduli();
      for (LinkIndex l = 0; l < problem_.links.size(); ++l)
        if (auto found = folded(l)) return found;
    }
    for (LinkIndex l = 0; l < problem_.links.size() && !stop_(); ++l)
      if (auto found = interval(l)) return found;
    return problem_.model.is_strict ? pair() : std::nullopt;
  }

  /// A stream at the links that it must cross.
  struct Trail {
    StreamIndex stream;
    Ps slack;                                  ///< of its latency
    std::vector<std::pair<LinkIndex, Ps>> at;  ///< ascending links, and the earliest start on each
  };

  /// Where frames of two streams are on their way for long, and neither may wait for long, the one that is sent faster
  /// comes too close to the other on some link.
  std::optional<Certificate> pair() {
    std::vector<Trail> trails;
    for (StreamIndex s = 0; s < problem_.streams.size() && !stop_(); ++s) {
      const Stream& stream = problem_.streams[s];
      if (!stream.latency || stream.listeners.size() != 1) continue;
      const auto starts = crossings_.earliest_starts(stream);
      Trail trail{s, *stream.latency - crossings_.arrival(stream, stream.listeners.front(), starts), {}};
      for (const LinkIndex l : crossings_.needed(stream, in_time_)) trail.at.emplace_back(l, starts[l]);
      std::sort(trail.at.begin(), trail.at.end());
      if (trail.slack >= 0) trails.push_back(std::move(trail));
    }
    std::vector<std::pair<Ps, Ps>> forbidden;
    for (std::size_t i = 0; i < trails.size() && !stop_(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Trail& a = trails[j];
        const Trail& b = trails[i];
        const Ps every = std::gcd(problem_.streams[a.stream].period, problem_.streams[b.stream].period);
        forbidden.clear();
        bool covered = false;
        for (auto x = a.at.begin(), y = b.at.begin(); x != a.at.end() && y != b.at.end() && !covered;) {
          if (x->first != y->first) {
            if (x->first < y->first)
              ++x;
            else
              ++y;
            continue;
          }
          // From b's phase less a's: the first and the last that make them meet here however they wait.
          const Ps apart = y->second - x->second;
          const Ps first = 1 - work(b.stream, x->first) - apart + a.slack,
                   last = work(a.stream, x->first) - apart - b.slack - 1;
          ++x;
          ++y;
          if (last < first) continue;
          covered = last - first + 1 >= every;
          const Ps begin = (first % every + every) % every;
          forbidden.emplace_back(begin, std::min(begin + (last - first), every - 1));
          if (begin + (last - first) >= every) forbidden.emplace_back(0, begin + (last - first) - every);
        }
        if (!covered) {
          std::sort(forbidden.begin(), forbidden.end());
          Ps until = 0;
          for (const auto& [from, to] : forbidden)
            if (from <= until) until = std::max(until, to + 1);
          covered = until >= every;
        }
        if (!covered) continue;
        Certificate certificate;
        certificate.kind = Certificate::Kind::pair;
        certificate.streams = {a.stream, b.stream};
        return certificate;
      }
    return std::nullopt;
  }

  Ps work(StreamIndex s, LinkIndex l) const { return crossings_.timing().work(problem_.streams[s], problem_.links[l]); }

  std::optional<Certificate> load(LinkIndex l) const {
    Sum sum(common_);
    for (const StreamIndex s : crossing_[l]) sum.add(work(s, l), problem_.streams[s].period);
    if (!sum.exceeds(1)) return std::nullopt;
    Certificate certificate;
    certificate.kind = Certificate::Kind::load;
    certificate.links = {l};
    certificate.streams = crossing_[l];
    return certificate;
  }

  /// Rings and the like: more goes from one part to the other than two cables carry. Of networks of some hundred
  /// cables.
  std::optional<Certificate> cut_load() const {
    constexpr std::size_t most_links = 1'000, most_looks = 20'000'000;
    std::optional<Certificate> found;
    std::size_t looks = 0;
    if (problem_.links.size() > most_links) return found;
    for_each_double_cut(problem_, [&](const Cut& cut) {
      std::vector<StreamIndex> crossing;
      Sum sum(common_);
      for (StreamIndex s = 0; s < problem_.streams.size(); ++s) {
        const Stream& stream = problem_.streams[s];
        if (cut.is_behind[stream.talker] || std::none_of(stream.listeners.begin(), stream.listeners.end(),
                                                         [&](NodeIndex n) { return cut.is_behind[n] != 0; }))
          continue;
        Ps least = longest_time;
        for (const LinkIndex l : cut.links) least = std::min(least, work(s, l));
        sum.add(least, stream.period);
        crossing.push_back(s);
      }
      looks += problem_.streams.size() + problem_.links.size();
      if (!cut.links.empty() && sum.exceeds(cut.links.size())) {
        found.emplace();
        found->kind = Certificate::Kind::load;
        found->links = cut.links;
        found->streams = std::move(crossing);
      }
      return !found && looks < most_looks && !stop_();
    });
    return found;
  }

  /// Least common multiples of periods and of what two of them have in common: moduli that are worth a try.
  void note_moduli() {
    std::vector<Ps> base;
    for (const Stream& stream : problem_.streams) base.push_back(stream.period);
    std::sort(base.begin(), base.end());
    base.erase(std::unique(base.begin(), base.end()), base.end());
    const std::size_t periods = base.size();
    if (periods > 64) base.clear();
    for (std::size_t a = 0; a < std::min<std::size_t>(periods, 64) && a < base.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) base.push_back(std::gcd(base[a], base[b]));
    std::sort(base.begin(), base.end());
    base.erase(std::unique(base.begin(), base.end()), base.end());
    constexpr std::size_t most = 512;
    for (const Ps each : base) {
      const std::size_t before = moduli_.size();
      moduli_.push_back(each);
      for (std::size_t i = 0; i < before && moduli_.size() < most; ++i) {
        const Ps factor = each / std::gcd(each, moduli_[i]);
        if (factor <= longest_time / moduli_[i]) moduli_.push_back(moduli_[i] * factor);
      }
      std::sort(moduli_.begin(), moduli_.end());
      moduli_.erase(std::unique(moduli_.begin(), moduli_.end()), moduli_.end());
    }
  }

  /// Of one modulus: all streams whose period divides it, and of each other period the greatest, if what they have in
  /// common divides it, too.
  std::optional<Certificate> folded(LinkIndex l) const {
    const auto& streams = crossing_[l];
    if (streams.size() < 2) return std::nullopt;
    struct Kin {
      Ps period;
      std::vector<StreamIndex> streams;  // the greatest first
    };
    std::vector<Kin> kin;
    for (const StreamIndex s : streams) {
      auto place = std::find_if(kin.begin(), kin.end(),
                                [&](const Kin& each) { return each.period == problem_.streams[s].period; });
      if (place == kin.end()) place = kin.insert(kin.end(), Kin{problem_.streams[s].period, {}});
      place->streams.push_back(s);
    }
    for (Kin& each : kin)
      std::stable_sort(each.streams.begin(), each.streams.end(),
                       [&](StreamIndex a, StreamIndex b) { return work(a, l) > work(b, l); });
    for (const Ps modulus : moduli_) {
      std::vector<StreamIndex> chosen;
      int128 sum = 0;  // of `modulus`
      std::vector<const Kin*> single;
      for (const Kin& each : kin) {
        if (modulus % each.period != 0) {
          single.push_back(&each);
          continue;
        }
        for (const StreamIndex s : each.streams) {
          chosen.push_back(s);
          sum += static_cast<int128>(work(s, l)) * (modulus / each.period);
        }
      }
      const auto fits = [&](Ps period, const std::vector<StreamIndex>& with) {
        return std::all_of(with.begin(), with.end(), [&](StreamIndex other) {
          return modulus % std::gcd(period, problem_.streams[other].period) == 0;
        });
      };
      // Few periods: all choices; many: the heaviest first.
      std::vector<StreamIndex> best = chosen;
      int128 best_sum = sum;
      const auto share = [&](const Kin& each) {
        return static_cast<int128>(work(each.streams.front(), l)) * (modulus / std::gcd(each.period, modulus));
      };
      if (single.size() <= 10) {
        for (std::uint32_t choice = 1; choice < 1u << single.size(); ++choice) {
          std::vector<StreamIndex> with = chosen;
          int128 total = sum;
          bool good = true;
          for (std::size_t i = 0; i < single.size() && good; ++i) {
            if ((choice >> i & 1) == 0) continue;
            good = fits(single[i]->period, with);
            with.push_back(single[i]->streams.front());
            total += share(*single[i]);
          }
          if (good && total > best_sum) best = with, best_sum = total;
        }
      } else {
        std::stable_sort(single.begin(), single.end(),
                         [&](const Kin* a, const Kin* b) { return share(*a) > share(*b); });
        for (const Kin* each : single)
          if (fits(each->period, best)) best.push_back(each->streams.front()), best_sum += share(*each);
      }
      if (best.size() < 2 || best_sum <= modulus) continue;
      Certificate certificate;
      certificate.kind = Certificate::Kind::folded;
      certificate.links = {l};
      certificate.modulus = modulus;
      certificate.streams = std::move(best);
      return certificate;
    }
    return std::nullopt;
  }

  struct Job {
    StreamIndex stream;
    std::uint64_t repetition;
    Ps first, last, work;
  };

  std::optional<Certificate> interval(LinkIndex l) const {
    std::vector<Job> jobs;
    if (!common_) return std::nullopt;
    constexpr std::size_t most_jobs = 20'000;
    for (const StreamIndex s : crossing_[l]) {
      const Stream& stream = problem_.streams[s];
      if (!stream.deadline) continue;
      const Ps to_here = crossings_.earliest_starts(stream)[l];
      const auto onward = crossings_.earliest_starts_from(stream, l);
      Ps least = never;
      std::vector<std::uint8_t> without(problem_.links.size());
      without[l] = 1;
      for (const NodeIndex listener : stream.listeners) {
        if (in_time_ ? crossings_.reaches_in_time(stream, listener, l) : crossings_.reaches(stream, listener, without))
          continue;
        const Ps rest = crossings_.arrival(stream, listener, onward);
        if (rest != never) least = std::min(least, *stream.deadline - rest);
      }
      if (to_here == never || least == never) continue;
      const Ps last = least + crossings_.timing().block(stream, problem_.links[l]);
      const Ps turns = *common_ / stream.period;
      if (static_cast<std::size_t>(turns) + jobs.size() > most_jobs) return std::nullopt;
      for (Ps k = 0; k < turns; ++k)
        jobs.push_back({s, static_cast<std::uint64_t>(k), stream.release + to_here + k * stream.period,
                        last + k * stream.period, work(s, l)});
    }
    std::sort(jobs.begin(), jobs.end(), [](const Job& a, const Job& b) { return a.first < b.first; });
    std::vector<std::size_t> by_last(jobs.size());
    std::iota(by_last.begin(), by_last.end(), std::size_t{0});
    std::sort(by_last.begin(), by_last.end(),
              [&](std::size_t a, std::size_t b) { return jobs[a].last < jobs[b].last; });
    // For each end: from the last begin backwards, the work of all that lies between.
    const Ps gap = crossings_.timing().gap(problem_.links[l]);
    for (const std::size_t end : by_last) {
      const Ps until = jobs[end].last;
      Ps sum = -gap;
      const auto behind =
          std::lower_bound(jobs.begin(), jobs.end(), until, [](const Job& job, Ps t) { return job.first < t; });
      for (auto job = behind; job != jobs.begin();) {
        --job;
        if (job->last > until) continue;
        sum += job->work;
        if (sum <= until - job->first) continue;
        Certificate certificate;
        certificate.kind = Certificate::Kind::interval;
        certificate.links = {l};
        certificate.from = job->first;
        certificate.until = until;
        for (auto each = job; each != behind; ++each)
          if (each->last <= until) certificate.jobs.emplace_back(each->stream, each->repetition);
        return certificate;
      }
      if (stop_()) return std::nullopt;
    }
    return std::nullopt;
  }

  const Problem& problem_;
  const Stop& stop_;
  Crossings crossings_;
  std::optional<Ps> common_;
  std::vector<std::vector<StreamIndex>> crossing_;  ///< by link: who cannot do without
  std::vector<Ps> moduli_;
  bool in_time_ = false;
};

}  // namespace

std::optional<Certificate> refute_by_latency(const Problem& problem) {
  const Stop never_stop = [] { return false; };
  return Refuter(problem, never_stop).latency();
}

std::optional<Certificate> refute(const Problem& problem, const Stop& stop) {
  Refuter refuter(problem, stop);
  if (auto found = refuter.latency()) return found;
  if (auto found = refuter.others(false)) return found;
  return refuter.others(true);
}

}  // namespace takt::schedule
