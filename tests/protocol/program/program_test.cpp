// SPDX-License-Identifier: Apache-2.0
// A Program as a server has it: calls and their statuses, events, audit events, diagnostics, recycle counts, results.
#include "program/program.hpp"

#include <gtest/gtest.h>

namespace takt::program::program_test {
namespace {

using namespace sim::literals;

sim::LocalTime at(sim::Duration since_start) { return sim::LocalTime() + since_start; }

Call call_of(Method method) {
  Call call;
  call.method = method;
  call.session_id = "session";
  call.user_id = "operator";
  return call;
}

Program ready_program(ProgramSettings settings = {}) {
  settings.name = "trajectory";
  settings.initial = State::Ready;
  return Program(settings, {"maker", "engineering"}, at(0_ms));
}

// An instance with MaxRecycleCount 1: each call, its status, the state, LastTransition and RecycleCount after it.
TEST(Programs, ATraceThroughAllOfIt) {
  ProgramSettings settings;
  settings.max_recycle_count = 1;
  Program program = ready_program(settings);
  const auto expect = [&](StatusCode status, const Outcome& outcome, State state, int transition, int recycled) {
    EXPECT_EQ(outcome.status, status);
    EXPECT_EQ(program.state(), state);
    EXPECT_EQ(program.machine().last_transition(), transition);
    EXPECT_EQ(program.recycle_count(), recycled);
    EXPECT_EQ(outcome.events.size(), is_good(status) ? 1u : 0u);
  };
  const auto call = [&](Method method, sim::Duration time) { return program.call(call_of(method), at(time)); };
  expect(StatusCode::BadNotExecutable, call(Method::Suspend, 5_ms), State::Ready, 0, 0);
  expect(StatusCode::Good, call(Method::Start, 10_ms), State::Running, 2, 0);
  expect(StatusCode::Good, call(Method::Suspend, 15_ms), State::Suspended, 5, 0);
  expect(StatusCode::Good, call(Method::Resume, 20_ms), State::Running, 6, 0);
  expect(StatusCode::Good, program.advance(3, at(40_ms)), State::Halted, 3, 0);
  expect(StatusCode::Good, call(Method::Reset, 50_ms), State::Ready, 1, 0);
  expect(StatusCode::Good, call(Method::Start, 60_ms), State::Running, 2, 1);
  expect(StatusCode::Good, call(Method::Halt, 70_ms), State::Halted, 3, 1);
  expect(StatusCode::BadInvalidState, call(Method::Reset, 80_ms), State::Halted, 3, 1);
  expect(StatusCode::BadInvalidState, program.advance(1, at(90_ms)), State::Halted, 3, 1);
}

// A Program that ends in Ready by itself (4) needs no Reset; there the limit stops Start. 0 is "never again".
TEST(Programs, TheRecycleLimitStopsStartToo) {
  ProgramSettings settings;
  settings.max_recycle_count = 0;
  Program program = ready_program(settings);
  EXPECT_EQ(program.call(call_of(Method::Start), at(1_ms)).status, StatusCode::Good) << "the first start is no recycle";
  EXPECT_EQ(program.advance(4, at(2_ms)).status, StatusCode::Good);
  EXPECT_EQ(program.call(call_of(Method::Start), at(3_ms)).status, StatusCode::BadInvalidState);
  EXPECT_EQ(program.state(), State::Ready);
}

TEST(Programs, ExecutableFollowsTheState) {
  Program program = ready_program();
  const auto executables = [&] {
    std::string text;
    for (const MethodInfo& method : methods) text += program.executable(method.method) ? 'T' : 'F';
    return text;  // Start Suspend Resume Halt Reset
  };
  EXPECT_EQ(executables(), "TFFTF");
  program.call(call_of(Method::Start), at(1_ms));
  EXPECT_EQ(executables(), "FTFTF");
  program.call(call_of(Method::Suspend), at(2_ms));
  EXPECT_EQ(executables(), "FFTTT");
  program.call(call_of(Method::Halt), at(3_ms));
  EXPECT_EQ(executables(), "FFFFT");
  ProgramSettings settings;
  settings.reset_in_suspended = false;
  settings.methods = MethodSet{Method::Start, Method::Suspend, Method::Reset};
  Program strict = ready_program(settings);
  strict.call(call_of(Method::Start), at(1_ms));
  strict.call(call_of(Method::Suspend), at(1_ms));
  EXPECT_FALSE(strict.executable(Method::Reset)) << "the text of Part 10";
  EXPECT_FALSE(strict.executable(Method::Resume)) << "the instance has no such method";
}

TEST(Programs, ChecksInTheirOrder) {
  ProgramSettings settings;
  settings.methods = MethodSet{Method::Start, Method::Halt};
  Program program = ready_program(settings);
  program.set_behaviour(Method::Start,
                        {{{"speed", "Double"}}, {}, [](const std::vector<Value>& in, std::vector<Value>&) {
                           return std::get<double>(in[0]) > 10 ? StatusCode::BadResourceUnavailable : StatusCode::Good;
                         }});
  const auto status = [&](Method method, std::vector<Value> arguments, bool permitted = true) {
    Call call = call_of(method);
    call.arguments = std::move(arguments);
    call.user_permitted = permitted;
    return program.call(call, at(1_ms)).status;
  };
  EXPECT_EQ(status(Method::Reset, {}, false), StatusCode::BadMethodInvalid);
  EXPECT_EQ(status(Method::Start, {}, false), StatusCode::BadUserAccessDenied);
  EXPECT_EQ(status(Method::Start, {}), StatusCode::BadArgumentsMissing);
  EXPECT_EQ(status(Method::Start, {1.0, 2.0}), StatusCode::BadTooManyArguments);
  EXPECT_EQ(status(Method::Start, {std::int64_t{1}}), StatusCode::BadInvalidArgument);
  EXPECT_EQ(status(Method::Start, {11.0}), StatusCode::BadResourceUnavailable) << "the action refuses";
  EXPECT_EQ(program.state(), State::Ready);
  EXPECT_EQ(status(Method::Start, {1.0}), StatusCode::Good);
  EXPECT_EQ(status(Method::Start, {1.0}, false), StatusCode::BadNotExecutable) << "before the user's right";
}

TEST(Programs, EventsAndAudits) {
  Program program = ready_program();
  const Outcome started = program.call(call_of(Method::Start), at(7_ms));
  ASSERT_EQ(started.events.size(), 1u);
  const TransitionEvent& event = started.events[0];
  EXPECT_EQ(event.source_name, "trajectory");
  EXPECT_EQ(event.time, at(7_ms));
  EXPECT_EQ(event.transition_number, 2u);
  EXPECT_EQ(event.transition_name, "ReadyToRunning");
  EXPECT_EQ(event.from_number, 12u);
  EXPECT_EQ(event.to_number, 13u);
  ASSERT_EQ(started.audits.size(), 1u);
  const AuditEvent& audit = started.audits[0];
  EXPECT_EQ(audit.source_name, "Method/Start");
  EXPECT_TRUE(audit.status);
  EXPECT_EQ(audit.method_id, 2426);
  EXPECT_EQ(audit.old_state_id, 2400);
  EXPECT_EQ(audit.new_state_id, 2402);
  EXPECT_EQ(audit.transition_number, 2u);
  EXPECT_EQ(audit.client_user_id, "operator");

  const Outcome refused = program.call(call_of(Method::Start), at(8_ms));
  EXPECT_TRUE(refused.events.empty());
  ASSERT_EQ(refused.audits.size(), 1u);
  EXPECT_FALSE(refused.audits[0].status);
  EXPECT_EQ(refused.audits[0].transition_number, 0u);

  const Outcome internal = program.advance(3, at(9_ms));
  ASSERT_EQ(internal.audits.size(), 1u);
  EXPECT_EQ(internal.audits[0].source_name, "System");
  EXPECT_FALSE(internal.audits[0].status) << "no method caused it";
  EXPECT_EQ(internal.audits[0].transition_number, 3u);

  ProgramSettings silent;
  silent.auditing = false;
  EXPECT_TRUE(ready_program(silent).call(call_of(Method::Start), at(1_ms)).audits.empty());
}

TEST(Programs, DiagnosticsRecordTheLastCall) {
  Program program = ready_program();
  EXPECT_EQ(program.diagnostic().create_session_id, "maker");
  EXPECT_EQ(program.diagnostic().last_method_call, "");
  EXPECT_FALSE(program.diagnostic().last_transition_time);
  program.set_behaviour(
      Method::Start,
      {{{"n", "Int64"}}, {{"twice", "Int64"}}, [](const std::vector<Value>& in, std::vector<Value>& out) {
         out.emplace_back(2 * std::get<std::int64_t>(in[0]));
         return StatusCode::Good;
       }});
  Call start = call_of(Method::Start);
  start.arguments = {std::int64_t{21}};
  EXPECT_EQ(program.call(start, at(3_ms)).outputs, std::vector<Value>{std::int64_t{42}});
  EXPECT_EQ(program.diagnostic().last_method_call, "Start");
  EXPECT_EQ(program.diagnostic().last_method_session_id, "session");
  EXPECT_EQ(program.diagnostic().last_method_input_values, std::vector<Value>{std::int64_t{21}});
  EXPECT_EQ(program.diagnostic().last_method_output_values, std::vector<Value>{std::int64_t{42}});
  EXPECT_EQ(program.diagnostic().last_transition_time, at(3_ms));
  program.call(call_of(Method::Reset), at(4_ms));
  EXPECT_EQ(program.diagnostic().last_method_call, "Reset") << "a failed call is a call";
  EXPECT_EQ(program.diagnostic().last_method_return_status, StatusCode::BadNotExecutable);
  EXPECT_EQ(program.diagnostic().last_method_call_time, at(4_ms));
  EXPECT_EQ(program.diagnostic().last_transition_time, at(3_ms));
}

TEST(Programs, FinalResultsComeWithTheLastTransitionAndStay) {
  Program program = ready_program();
  program.call(call_of(Method::Start), at(1_ms));
  const FinalResultData result{{"parts", std::int64_t{12}}};
  const Outcome ended = program.advance(4, at(2_ms), result);
  EXPECT_EQ(ended.events.at(0).intermediate_result, result);
  EXPECT_EQ(program.final_result(), result);
  program.call(call_of(Method::Start), at(3_ms));
  EXPECT_EQ(program.final_result(), result) << "until the next execution ends";
  program.call(call_of(Method::Halt), at(4_ms));
  EXPECT_TRUE(program.final_result().empty());
}

// Part 10, Table 1 and 4.2.10: the Program itself may take 1, 3, 4 and 8.
TEST(Programs, InternalCauses) {
  for (const Transition& transition : transitions) {
    SCOPED_TRACE(transition.name);
    Program program = ready_program();
    if (transition.from == State::Halted) program.call(call_of(Method::Halt), at(1_ms));
    if (transition.from == State::Running || transition.from == State::Suspended)
      program.call(call_of(Method::Start), at(1_ms));
    if (transition.from == State::Suspended) program.call(call_of(Method::Suspend), at(1_ms));
    const bool internal =
        transition.number == 1 || transition.number == 3 || transition.number == 4 || transition.number == 8;
    EXPECT_EQ(program.advance(transition.number, at(2_ms)).status,
              internal ? StatusCode::Good : StatusCode::BadInvalidState);
    EXPECT_EQ(program.state(), internal ? transition.to : transition.from);
  }
  Program program = ready_program();
  EXPECT_EQ(program.advance(3, at(1_ms)).status, StatusCode::BadInvalidState) << "not in Running";
  EXPECT_EQ(program.advance(10, at(1_ms)).status, StatusCode::BadInvalidState);
}

}  // namespace
}  // namespace takt::program::program_test
