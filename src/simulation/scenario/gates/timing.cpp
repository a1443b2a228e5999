// SPDX-License-Identifier: Apache-2.0
#include "scenario/gates/timing.hpp"

#include <algorithm>
#include <utility>

#include "scenario/description/promises.hpp"

namespace takt::scenario {
namespace {

constexpr std::uint32_t most_frames_of_a_train = 256;

class TimingWalk {
 public:
  explicit TimingWalk(const Resolved& resolved) : r_(resolved) {
    FrameTiming unknown;
    unknown.no_window = "times that nobody promises, as those of programs with roles";
    made_.of_streams.assign(r_.streams.size(), unknown);
  }

  Timings run() {
    time_streams();
    for (std::uint32_t p = 0; p < r_.programs.size(); ++p) time_program(p);
    return std::move(made_);
  }

 private:
  const models::OsLatency& os_of(models::NodeIndex host) const {
    return r_.plan.os_latencies[r_.plan.nodes[host.value].os_latency];
  }

  void set(models::StreamIndex stream, FrameTiming timing) {
    const models::StreamPlan& plan = r_.plan.streams[stream.value];
    if (const models::CpuPlan* const cpu = r_.plan.nodes[plan.talker.value].cpu.get(); cpu != nullptr && cpu->transmit)
      wait_for_thread(timing, cpu->threads[*cpu->transmit]);
    if (timing.no_window.empty() && timing.period.ps() % 1'000 != 0)
      timing.no_window = "a period of " + json::to_text(timing.period) + ", which is no whole number of ns";
    made_.of_streams[stream.value] = std::move(timing);
  }

  /// How long it waits for the processor depends on all that runs there.
  static void wait_for_thread(FrameTiming& timing, const models::CpuThreadPlan& thread) {
    timing.is_known = false;
    if (timing.no_window.empty())
      timing.no_window = "thread " + json::quote(thread.name) + " of its host before it, which waits for others";
  }

  /// What a host adds before the port, at most; it must be less than a period, or two frames may be there at once.
  static FrameTiming after(Duration phase, Duration least, Duration delay, Duration period, std::uint32_t train) {
    FrameTiming timing;
    timing.period = period;
    timing.train = train;
    timing.early = delay - least;
    timing.is_known = delay < period;
    if (!timing.is_known)
      timing.no_window = "up to " + json::to_text(delay) +
                         " between the application and the port of its host, of a period of " + json::to_text(period);
    else
      timing.release = phase + delay;
    return timing;
  }

  std::uint32_t choice_of(OffsetChoice choice) {
    made_.choices.push_back(choice);
    return static_cast<std::uint32_t>(made_.choices.size() - 1);
  }

  // The talkers stand in the order of the streams (nothing was refused).
  void time_streams() {
    for (std::uint32_t i = 0; i < r_.scenario.streams.size() && i < r_.plan.talkers.size(); ++i) {
      const Stream& stream = r_.scenario.streams[i];
      const models::StreamIndex index = r_.plan.talkers[i].stream;
      FrameTiming timing;
      if (stream.every || stream.burst) {
        const models::OsLatency& os = os_of(r_.plan.streams[index.value].talker);
        const Duration period = stream.every ? *stream.every : stream.burst->every;
        timing = after(stream.offset.value_or(Duration()), os.transmit.least(), stream.jitter + os.transmit.greatest(),
                       period, trains_++);
        if (stream.burst) {
          timing.frames = stream.burst->frames;
          timing.spacing = stream.burst->spacing;
          timing.is_known = false;  // what chooses offsets without gates knows one frame a period
          if (timing.spacing > Duration()) trains_ += timing.frames - 1;
        }
        if (stream.launch) {  // it is sent then, however early it was there
          timing.release = stream.offset.value_or(Duration()) + *stream.launch;
          timing.early = Duration();
          timing.is_known = true;
        }
        if (stream.offset && stream.offset->is_auto) timing.choice = choice_of({i});
      }
      if (!stream.every && !stream.burst)
        timing.no_window = "no period: \"every\" or \"burst\" is missing";
      else if (!promises_phase(stream))
        timing.no_window = "no \"offset\" that promises when it is sent, or \"auto\"";
      else if (timing.frames > most_frames_of_a_train)
        timing.no_window = "bursts of more than " + std::to_string(most_frames_of_a_train) + " frames";
      else if (stream.launch)
        timing.no_window = "\"launch\", which is a plan of its own";
      else if (std::ranges::find(r_.plan.talker_ats, index, &models::TalkerAtsPlan::stream) != r_.plan.talker_ats.end())
        timing.no_window = "an ATS scheduler at its talker, which may hold it";
      set(index, std::move(timing));
    }
  }

  void time_program(std::uint32_t number) {
    const ResolvedProgram& program = r_.programs[number];
    const Program& description = *program.description;
    const bool is_open = description.offset && description.offset->is_auto;
    if (program.has_roles()) {
      if (is_open) time_roles(program, choice_of({number, true, {}}));
      return;  // its streams keep the reason that all have first
    }
    for (std::uint8_t p = 0; p < program.members.size(); ++p) {
      const std::string& name = program.participant_names[p];
      FrameTiming timing = published(program, program.members[p], program.phases[p]);
      const bool has_own =
          std::ranges::any_of(description.phases, [&](const auto& phase) { return phase.first == name; });
      if (is_open && !has_own) timing.choice = choice_of({number, true, p});
      if (description.publish != Publish::cyclic)
        timing.no_window = "\"publish\": \"on-change\", at no known time";
      else if (!promises_phase(description, name))
        timing.no_window =
            "no \"offset\" or \"phases\" that promises when " + json::quote(name) + " publishes, or \"auto\"";
      set(program.members[p].state, timing);
      for (std::size_t d = 0; d < program.process_data.size(); ++d) {
        if (program.process_data[d].from != p) continue;
        const bool is_reply = std::any_of(program.replies.begin(), program.replies.end(),
                                          [&](const ResolvedReply& reply) { return reply.with == d; });
        FrameTiming data = timing;
        if (is_reply) {
          data.no_window = "an answer, published when its question has been worked at";
          data.is_known = false;
        }
        set(program.stream_of(d), std::move(data));
      }
    }
  }

  FrameTiming published(const ResolvedProgram& program, const ResolvedMember& member, Duration phase) {
    const models::OsLatency& os = os_of(member.node);
    FrameTiming timing =
        after(phase, os.wake_up.least() + os.transmit.least() + member.seal,
              os.wake_up.greatest() + os.transmit.greatest() + member.seal, program.description->cycle, trains_++);
    if (member.cpu_thread) wait_for_thread(timing, r_.plan.nodes[member.node.value].cpu->threads[*member.cpu_thread]);
    return timing;
  }

  /// Whoever has a role publishes with the others.
  void time_roles(const ResolvedProgram& program, std::uint32_t choice) {
    for (const ResolvedMember& member : program.members) {
      FrameTiming timing = published(program, member, program.phases.front());
      timing.choice = choice;
      timing.no_window = made_.of_streams[member.state.value].no_window;
      set(member.state, timing);
      for (const std::optional<models::StreamIndex>& data : member.data)
        if (data) set(*data, timing);
    }
  }

  const Resolved& r_;
  Timings made_;
  std::uint32_t trains_ = 0;
};

}  // namespace

Timings timings_of(const Resolved& resolved) { return TimingWalk(resolved).run(); }

}  // namespace takt::scenario
