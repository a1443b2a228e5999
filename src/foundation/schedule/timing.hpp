// SPDX-License-Identifier: Apache-2.0
// How long things take: the arithmetic of frames on links, as the search and the refuters use it. (The judges work it
// out by themselves.)
#pragma once

#include <algorithm>

#include "schedule/problem.hpp"
#include "schedule/solution.hpp"

namespace takt::schedule {

class Timing {
 public:
  Timing(const Problem& problem, GateTiming kind) : problem_(&problem), kind_(kind) {}

  const Problem& problem() const { return *problem_; }
  GateTiming kind() const { return kind_; }

  /// One frame, preamble to FCS.
  Ps frame(const Stream& stream, const Link& link) const {
    return static_cast<Ps>(stream.octets + problem_->model.preamble) * link.octet;
  }
  Ps gap(const Link& link) const { return problem_->model.gap * link.octet; }
  /// From one frame of a train to the next.
  Ps step(const Stream& stream, const Link& link) const { return frame(stream, link) + gap(link); }
  /// All frames of a repetition.
  Ps block(const Stream& stream, const Link& link) const {
    return (stream.frames - 1) * step(stream, link) + frame(stream, link);
  }
  /// That and the gap behind it.
  Ps work(const Stream& stream, const Link& link) const { return stream.frames * step(stream, link); }
  /// From the start of a repetition until another may start. Frames that come over different links are told apart by
  /// more than the margin.
  Ps occupied(const Stream& stream, const Link& link) const {
    const Ps margin = problem_->model.margin;
    if (kind_ == GateTiming::flowing) return work(stream, link) + 2 * margin;
    return margin == 0 ? work(stream, link)
                       : std::max(work(stream, link), block(stream, link) - frame(stream, link) + margin + 1);
  }
  /// By how much the start on the next link must be later because the frames of a train come more slowly than they
  /// could go.
  Ps train_delay(const Stream& stream, const Link& link, const Link& next) const {
    return std::max<Ps>(0, static_cast<Ps>(stream.frames - 1) * (step(stream, link) - step(stream, next)));
  }
  /// From the start on a link to the earliest start on the next, without margin.
  Ps onward(const Stream& stream, const Link& link, const Link& next) const {
    const bool cuts = link.cut_through && link.octet == next.octet;
    const Ps head = cuts ? *link.cut_through * link.octet : frame(stream, link);
    return head + link.propagation + link.forwarding + train_delay(stream, link, next);
  }
  /// The same in this kind of schedule.
  Ps lag(const Stream& stream, const Link& link, const Link& next) const {
    return onward(stream, link, next) + (kind_ == GateTiming::held ? problem_->model.margin : 0);
  }
  /// From the start on the last link until all is at the listener.
  Ps to_listener(const Stream& stream, const Link& link) const {
    return block(stream, link) + link.propagation + link.forwarding;
  }

 private:
  const Problem* problem_;
  GateTiming kind_;
};

}  // namespace takt::schedule
