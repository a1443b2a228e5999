#include "evaluation/judge_streams.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "json/quantity.hpp"
#include "scenario/figures/requirement_rules.hpp"

namespace takt::evaluation {

using namespace results;
namespace {

using json::to_text;

class StreamJudge {
 public:
  StreamJudge(const scenario::Scenario& scenario, const scenario::Requirement& requirement, const StreamResult& stream, bool partial)
      : requirement_(requirement),
        stream_(stream),
        from_(scenario::counts_from(scenario, requirement)),
        losses_count_(!scenario::requires_losses_separately(scenario, stream.name, from_)),
        held_(partial ? Verdict::undecided : Verdict::pass),
        missing_(partial ? Verdict::undecided : Verdict::fail) {}

  std::vector<RequirementResult> all() {
    if (requirement_.latency) latency(*requirement_.latency);
    if (requirement_.jitter) jitter(*requirement_.jitter);
    if (requirement_.dropped) dropped(*requirement_.dropped);
    if (requirement_.delivered) delivered(*requirement_.delivered);
    return std::move(verdicts_);
  }

 private:
  /// A frame that is under way will have been so for at least as long when it comes: the latency is never less than this.
  void latency(const scenario::DurationLimit& limit) {
    RequirementResult verdict = begin(RequirementKind::latency, fmt::format("stream {} latency {}", stream_.name, text_of(limit)));
    const std::optional<Duration> longest = stream_.latency ? std::optional(stream_.latency->max) : std::nullopt;
    const std::optional<Duration> shortest = stream_.latency ? std::optional(stream_.latency->min) : std::nullopt;
    judge_times(verdict, limit, longest, shortest, stream_.oldest_in_flight);
  }

  void jitter(const scenario::DurationLimit& limit) {
    RequirementResult verdict = begin(RequirementKind::jitter, fmt::format("stream {} jitter {}", stream_.name, text_of(limit)));
    std::optional<Duration> spread;
    std::optional<Duration> coming;  // of what is under way
    if (stream_.latency) {
      spread = stream_.latency->max - stream_.latency->min;
      if (stream_.oldest_in_flight && *stream_.oldest_in_flight > stream_.latency->min) coming = *stream_.oldest_in_flight - stream_.latency->min;
    }
    judge_times(verdict, limit, spread, spread, coming);
  }

  void judge_times(RequirementResult& verdict, const scenario::DurationLimit& limit, std::optional<Duration> longest, std::optional<Duration> shortest,
                   std::optional<Duration> coming) {
    verdict.limit = limit.greatest();
    verdict.least_limit = limit.least();
    if (limit.least()) verdict.least_measured = shortest;
    verdict.measured = coming ? std::max(coming, longest) : longest;
    verdict.remark = fmt::format("{} frames", stream_.delivered);
    if (longest && *longest > limit.greatest()) {
      verdict.verdict = Verdict::fail;
    } else if (coming && *coming > limit.greatest()) {
      verdict.verdict = Verdict::fail;
      verdict.remark = fmt::format("{} frames came; one has been under way for {} at the end", stream_.delivered, to_text(*stream_.oldest_in_flight));
    } else if (!longest) {
      verdict.verdict = missing_;
      verdict.remark = "nothing delivered";
      verdict.measured.reset();
    } else if (limit.least() && *shortest < *limit.least()) {
      verdict.verdict = Verdict::fail;
      verdict.remark = fmt::format("{} frames, the least is {}", stream_.delivered, to_text(*shortest));
    } else if (stream_.lost > 0 && losses_count_) {
      verdict.verdict = Verdict::fail;
      verdict.remark = fmt::format("{} frames came, {} lost and so late for ever; \"dropped\" says how many may be", stream_.delivered, stream_.lost);
    } else {
      verdict.verdict = held_;
    }
    verdicts_.push_back(std::move(verdict));
  }

  void dropped(std::uint64_t limit) {
    RequirementResult verdict = begin(RequirementKind::dropped, fmt::format("stream {} drops at most {}", stream_.name, limit));
    verdict.count_limit = limit;
    verdict.verdict = stream_.lost <= limit ? held_ : Verdict::fail;
    verdict.remark = !stream_.has_copies ? fmt::format("{} dropped", stream_.lost)
                                         : fmt::format("{} lost; {} copies dropped", stream_.lost, stream_.dropped_in_all());
    verdicts_.push_back(std::move(verdict));
  }

  void delivered(std::uint64_t limit) {
    RequirementResult verdict = begin(RequirementKind::delivered, fmt::format("stream {} delivers at least {}", stream_.name, limit));
    verdict.count_limit = limit;
    verdict.verdict = stream_.delivered >= limit ? Verdict::pass : missing_;
    verdict.remark = fmt::format("{} delivered", stream_.delivered);
    verdicts_.push_back(std::move(verdict));
  }

  RequirementResult begin(RequirementKind kind, std::string text) const {
    RequirementResult verdict;
    verdict.kind = kind;
    verdict.subject = stream_.name;
    verdict.text = std::move(text);
    return verdict;
  }

  const scenario::Requirement& requirement_;
  const StreamResult& stream_;
  Duration from_;
  bool losses_count_;
  Verdict held_;
  Verdict missing_;
  std::vector<RequirementResult> verdicts_;
};

}  // namespace

std::vector<RequirementResult> judge_stream(const scenario::Scenario& scenario, const scenario::Requirement& requirement, const StreamResult& stream, bool partial) {
  return StreamJudge(scenario, requirement, stream, partial).all();
}

}  // namespace takt::evaluation
