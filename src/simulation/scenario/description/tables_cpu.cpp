// SPDX-License-Identifier: Apache-2.0
// The vocabulary of processors. See tables.cpp.
#include "plant/limits.hpp"
#include "scenario/description/cpu.hpp"

namespace takt::scenario {

using json::name;
using json::optional;
using json::required;
using plant::longest_step;

const json::Enumeration& describe(json::Type<StackPart>) {
  static constexpr json::EnumName names[] = {
      name(StackPart::receive, "receive", "each frame that comes, before programs get it"),
      name(StackPart::transmit, "transmit", "each frame that is sent, after programs have given it away"),
      name(StackPart::gptp, "gptp", "each gPTP message that comes, and what the servo makes of it"),
  };
  static constexpr json::Enumeration table = json::enumeration<StackPart>("a part of the protocol stack", names);
  return table;
}

const json::Enumeration& describe(json::Type<SchedulingPolicy>) {
  static constexpr json::EnumName names[] = {
      name(SchedulingPolicy::deadline, "deadline",
           "before all others; the earliest deadline first (SCHED_DEADLINE without its budgets)"),
      name(SchedulingPolicy::fifo, "fifo", "fixed priorities; among equals who is ready first (SCHED_FIFO)"),
      name(SchedulingPolicy::fair, "fair", "shares of what the others leave, by weight (SCHED_OTHER)"),
  };
  static constexpr json::Enumeration table = json::enumeration<SchedulingPolicy>("a scheduling policy", names);
  return table;
}

const json::Object& describe(json::Type<Cryptography>) {
  static constexpr json::Field fields[] = {
      optional<&Cryptography::seal>("seal", "Before a message is sent.", {.max = 1_s}),
      optional<&Cryptography::open>("open", "Before a message that has come is heard.", {.max = 1_s}),
  };
  static constexpr json::Object table =
      json::object<Cryptography>("cryptography",
                                 "How long securing takes for each message of programs with `security`. Messages do "
                                 "not wait for each other in it, but on a thread of a processor.",
                                 fields);
  return table;
}

const json::Object& describe(json::Type<CpuThread>) {
  static constexpr json::Field fields[] = {
      required<&CpuThread::name>("name", "Unique on the host.", {.min_length = 1, .max_length = 200}),
      optional<&CpuThread::policy>("policy", "How it is scheduled."),
      optional<&CpuThread::priority>("priority", "Of policy fifo: the greatest goes first. 1 if absent.",
                                     {.min = 1, .max = 99}),
      optional<&CpuThread::deadline>(
          "deadline",
          "After a job is ready. By it policy deadline schedules; of any thread jobs that take longer are counted.",
          {.min = 1_us, .max = longest_step}),
      optional<&CpuThread::weight>("weight", "Of policy fair: its share beside those of the others. 1024 if absent.",
                                   {.min = 1, .max = 1'000'000}),
      optional<&CpuThread::core>("core", "The only core on which it runs, from 0; any if absent."),
      required<&CpuThread::execution>("execution",
                                      "How long a job takes when nobody interrupts it. What a program says of its own "
                                      "(processing of replies) takes its place."),
      optional<&CpuThread::non_preemptive>("non_preemptive", "So much at the end of each job nobody interrupts.",
                                           {.max = 1_s}),
      optional<&CpuThread::wake_up>("wake_up",
                                    "From the expiry of a timer until the job that it causes is ready, from when its "
                                    "response time counts; as the operating system says if absent."),
      optional<&CpuThread::runs>("runs",
                                 "What runs on it: Programs, applications, \"APPLICATION/THREAD\", gateways and "
                                 "persistence services of this host. Each alarm and each message is a job.",
                                 {.max_items = 256, .unique = true, .items = {.min_length = 1}}),
      optional<&CpuThread::stack>("stack", "What of the protocol stack runs on it.", {.max_items = 3, .unique = true}),
      optional<&CpuThread::every>("every", "A load: a job is released each time, and nothing comes of it.",
                                  {.min = 10_us, .max = longest_step}),
      optional<&CpuThread::offset>("offset", "Phase of the load within the interval.", {.max = longest_step}),
  };
  static constexpr json::Object table = json::object<CpuThread>(
      "cpu_thread", "A thread of a host. It works off its jobs one by one, as they came.", fields);
  return table;
}

const json::Object& describe(json::Type<Cpu>) {
  static constexpr json::Field fields[] = {
      optional<&Cpu::cores>("cores", "How many threads run at a time.", {.min = 1, .max = 64}),
      optional<&Cpu::switching>(
          "switching", "What a core needs before it goes on with another thread than the last one.", {.max = 1_ms}),
      optional<&Cpu::slice>("slice", "How long a thread of policy fair runs before another one of them may.",
                            {.min = 10_us, .max = 1_s}),
      required<&Cpu::threads>("threads", "Those that take time. What runs on none of them takes none.",
                              {.min_items = 1, .max_items = 256}),
  };
  static constexpr json::Object table = json::object<Cpu>("cpu", "The processor of a host.", fields);
  return table;
}

}  // namespace takt::scenario
