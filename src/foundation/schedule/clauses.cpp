// SPDX-License-Identifier: Apache-2.0
#include "schedule/clauses.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "sim/check.hpp"

namespace takt::schedule {
namespace {

Ps rest(Ps at, Ps modulus) {
  const Ps r = at % modulus;
  return r < 0 ? r + modulus : r;
}

Ps round_down(Ps at, Ps unit) { return at - rest(at, unit); }

/// Differences of two numbers, first and last.
struct Zone {
  Ps first, last;
};

/// Zones modulo `every`, those that touch made one; all of it if they cover it.
std::vector<Zone> united(std::vector<Zone> zones, Ps every, Ps unit) {
  for (Zone& zone : zones) {
    const Ps length = zone.last - zone.first;
    zone.first = rest(zone.first, every);
    zone.last = zone.first + length;
    if (length + unit >= every) return {{0, every - unit}};
  }
  std::sort(zones.begin(), zones.end(), [](const Zone& a, const Zone& b) { return a.first < b.first; });
  std::vector<Zone> all;
  for (const Zone& zone : zones) {
    if (!all.empty() && zone.first <= all.back().last + unit)
      all.back().last = std::max(all.back().last, zone.last);
    else
      all.push_back(zone);
  }
  // The last ones may reach over the end into the first.
  while (all.size() > 1 && all.back().last + unit >= all.front().first + every) {
    all.back().last = std::max(all.back().last, all.front().last + every);
    all.erase(all.begin());
  }
  for (const Zone& zone : all)
    if (zone.last - zone.first + unit >= every) return {{0, every - unit}};
  return all;
}

}  // namespace

std::optional<Course> course_of(const Crossings& crossings, const Stream& stream) {
  if (stream.listeners.size() != 1 || (!stream.latency && !stream.deadline)) return std::nullopt;
  const auto starts = crossings.earliest_starts(stream);
  const Ps arrival = crossings.arrival(stream, stream.listeners.front(), starts);
  if (arrival == never) return std::nullopt;
  Course course;
  course.slack = stream.latency ? *stream.latency - arrival : *stream.deadline - stream.release - arrival;
  course.first = stream.release;
  course.last = stream.release + stream.period - 1;
  if (stream.deadline) course.last = std::min(course.last, *stream.deadline - arrival);
  if (course.slack < 0 || course.last < course.first) return std::nullopt;
  const Problem& problem = crossings.timing().problem();
  for (const LinkIndex l : crossings.needed(stream, true))
    course.links.push_back({l, starts[l], crossings.timing().work(stream, problem.links[l])});
  std::sort(course.links.begin(), course.links.end(),
            [](const Course::At& a, const Course::At& b) { return a.lag != b.lag ? a.lag < b.lag : a.link < b.link; });
  for (std::size_t i = 1; i < course.links.size(); ++i)
    if (course.links[i].lag == course.links[i - 1].lag) return std::nullopt;  // which comes first is not said
  return course;
}

std::optional<std::size_t> ClauseMaker::Member::place(LinkIndex link) const {
  const auto found = std::find_if(links.begin(), links.end(), [&](const Course::At& at) { return at.link == link; });
  return found == links.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - links.begin()));
}

struct ClauseMaker::Line {
  Ps first = 0, last = 0, width = 0;
  std::int32_t variable = 0;  ///< of the first threshold, which is a width above `first`
};

namespace {

/// A clause that grows: literals that cannot hold are left out, and one that always holds makes it none.
class Growing {
 public:
  template <class Line>
  Growing& at_least(const Line& line, Ps at) {
    const Ps k = at <= line.first ? 0 : (at - line.first) / line.width;
    if (at > line.last) return *this;
    if (k == 0)
      holds_ = true;
    else
      clause_.push_back(line.variable + static_cast<std::int32_t>(k) - 1);
    return *this;
  }
  template <class Line>
  Growing& less(const Line& line, Ps at) {
    if (at <= line.first) return *this;
    const Ps k = (at - line.first + line.width - 1) / line.width;
    if (line.first + k * line.width > line.last)
      holds_ = true;
    else
      clause_.push_back(-(line.variable + static_cast<std::int32_t>(k) - 1));
    return *this;
  }
  void into(std::vector<Clause>& clauses) {
    for (const std::int32_t literal : clause_)
      if (std::find(clause_.begin(), clause_.end(), -literal) != clause_.end()) holds_ = true;
    if (!holds_) clauses.push_back(std::move(clause_));
  }

 private:
  Clause clause_;
  bool holds_ = false;
};

}  // namespace

ClauseMaker::ClauseMaker(const Problem& problem, std::span<const StreamIndex> streams,
                         std::span<const std::optional<Course>> courses) {
  std::map<LinkIndex, int> crossed;
  for (const StreamIndex s : streams)
    for (const Course::At& at : courses[s]->links) ++crossed[at.link];
  bool has_deadline = false;
  for (const StreamIndex s : streams) {
    const Course& course = *courses[s];
    Member member{s, problem.streams[s].period, course.slack, course.first, course.last, {}};
    for (const Course::At& at : course.links)
      if (crossed[at.link] > 1) member.links.push_back(at);
    has_deadline = has_deadline || problem.streams[s].deadline;
    members_.push_back(std::move(member));
  }
  for (const Member& member : members_) {
    unit_ = std::gcd(unit_, std::gcd(member.slack, member.period));
    if (has_deadline) unit_ = std::gcd(unit_, member.first);
    for (const Course::At& at : member.links) unit_ = std::gcd(unit_, std::gcd(at.lag, at.work));
  }
  TAKT_CHECK(unit_ > 0, "periods are positive");
  if (has_deadline) {
    for (Member& member : members_) {
      const Ps latest = member.last + member.slack;
      member.last = round_down(problem.streams[member.stream].deadline
                                   ? std::min(latest, courses[member.stream]->last + member.slack)
                                   : latest,
                               unit_);
    }
    return;
  }
  // Nobody is bound to an instant. A phase counts only by what its period has in common with those of others; and one
  // stream may begin at 0.
  std::uint64_t most = 0;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    Member& member = members_[i];
    Ps modulus = 1;
    for (const Member& other : members_) {
      const bool meets =
          &other != &member && std::any_of(other.links.begin(), other.links.end(),
                                           [&](const Course::At& at) { return member.place(at.link).has_value(); });
      if (meets) modulus = std::lcm(modulus, std::gcd(member.period, other.period));
    }
    member.first = 0;
    member.last = std::max<Ps>(0, modulus - unit_) + member.slack;
    const std::uint64_t weight =
        static_cast<std::uint64_t>(modulus / unit_) * (member.slack > 0 ? member.links.size() : 1);
    if (!anchor_ || weight > most) anchor_ = i, most = weight;
  }
  if (anchor_) members_[*anchor_].last = members_[*anchor_].slack;
}

std::uint64_t ClauseMaker::size(Ps width) const {
  std::uint64_t sum = 0;
  for (const Member& member : members_)
    sum += static_cast<std::uint64_t>((member.last - member.first) / width + 1) *
           (member.slack > 0 ? member.links.size() : 1);
  return sum;
}

Clauses ClauseMaker::make(Ps width) {
  Clauses all;
  if (anchor_) all.anchor = members_[*anchor_].stream;
  auto& clauses = all.clauses;
  const auto note_about = [&](std::size_t i, std::size_t j) {
    all.about.resize(clauses.size(), std::pair(members_[i].stream, members_[j].stream));
  };
  const auto new_line = [&](StreamIndex stream, LinkIndex link, Ps modulus, Ps first, Ps last) {
    Line line{first, last, width, static_cast<std::int32_t>(all.thresholds.size()) + 1};
    for (Ps at = first + width; at <= last; at += width) {
      all.thresholds.push_back({stream, link, modulus, at});
      const auto here = static_cast<std::int32_t>(all.thresholds.size());
      if (here > line.variable) clauses.push_back({-here, here - 1});
    }
    return line;
  };
  // The numbers themselves.
  std::vector<std::vector<Line>> lines(members_.size());
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const Member& member = members_[i];
    const std::size_t count = member.links.empty() ? 0 : member.slack > 0 ? member.links.size() : 1;
    for (std::size_t p = 0; p < count; ++p)
      lines[i].push_back(new_line(member.stream, member.links[p].link, 0, member.first, member.last));
    for (std::size_t p = 1; p < count; ++p)
      for (Ps at = member.first + width; at <= member.last; at += width)
        Growing().less(lines[i][p - 1], at).at_least(lines[i][p], at).into(clauses);
    for (Ps at = member.first + width; count > 1 && at <= member.last; at += width)
      Growing().less(lines[i].back(), at).at_least(lines[i].front(), at - member.slack).into(clauses);
    note_about(i, i);
  }
  // Their rests, where somebody else repeats more often.
  std::map<std::tuple<std::size_t, std::size_t, Ps>, Line> rests;
  const auto phase_line = [&](std::size_t i, std::size_t place, Ps every) -> const Line& {
    const Member& member = members_[i];
    const std::size_t p = member.slack > 0 ? place : 0;
    const Line& line = lines[i][p];
    if (line.first >= 0 && line.last < every) return line;
    const auto [found, is_new] = rests.try_emplace({i, p, every});
    if (!is_new) return found->second;
    const Line phase = new_line(member.stream, member.links[p].link, every, 0, every - unit_);
    for (Ps from = line.first; from <= line.last; from += width) {
      const Ps until = std::min(from + width - unit_, line.last);
      const Ps a = rest(from, every), b = rest(until, every);
      if (until - from >= every) continue;
      if (a <= b) {
        Growing().less(line, from).at_least(line, until + unit_).at_least(phase, a).into(clauses);
        Growing().less(line, from).at_least(line, until + unit_).less(phase, b + unit_).into(clauses);
      } else {
        Growing()
            .less(line, from)
            .at_least(line, until + unit_)
            .at_least(phase, a)
            .less(phase, b + unit_)
            .into(clauses);
      }
    }
    note_about(i, i);
    return found->second = phase;
  };
  // Who meets whom.
  const auto forbid = [&](const Line& a, const Line& b, Ps every, const Zone& zone) {
    for (Ps from = a.first; from <= a.last; from += width) {
      const Ps until = std::min(from + width - unit_, a.last);
      Ps low = until + zone.first, high = from + zone.last;  // for all of the box
      if (high < low) continue;
      if (high - low + unit_ >= every) {
        Growing().less(a, from).at_least(a, until + unit_).into(clauses);
        continue;
      }
      high -= round_down(low, every);
      low = rest(low, every);
      const auto exclude = [&](Ps begin, Ps end) {
        Growing().less(a, from).at_least(a, until + unit_).less(b, begin).at_least(b, end + unit_).into(clauses);
      };
      exclude(low, std::min(high, every - unit_));
      if (high >= every) exclude(0, high - every);
    }
  };
  for (std::size_t i = 0; i < members_.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Ps every = std::gcd(members_[i].period, members_[j].period);
      std::vector<Zone> zones;  // of the number of j less that of i
      for (std::size_t p = 0; p < members_[i].links.size(); ++p) {
        const Course::At& here = members_[i].links[p];
        const auto there = members_[j].place(here.link);
        if (!there) continue;
        const Ps apart = members_[j].links[*there].lag - here.lag;
        const Zone zone{unit_ - members_[j].links[*there].work - apart, here.work - apart - unit_};
        if (zone.last < zone.first) continue;
        if (members_[i].slack == 0 && members_[j].slack == 0) {
          zones.push_back(zone);
          continue;
        }
        const Line& a = phase_line(i, p, every);
        const Line& b = phase_line(j, *there, every);
        if (a.last - a.first <= b.last - b.first)
          forbid(a, b, every, zone);
        else
          forbid(b, a, every, {-zone.last, -zone.first});
        note_about(i, j);
      }
      if (zones.empty()) continue;
      const Line a = phase_line(i, 0, every), b = phase_line(j, 0, every);
      for (const Zone& zone : united(std::move(zones), every, unit_)) {
        if (a.last - a.first <= b.last - b.first)
          forbid(a, b, every, zone);
        else
          forbid(b, a, every, {-zone.last, -zone.first});
      }
      note_about(i, j);
    }
  return all;
}

}  // namespace takt::schedule
