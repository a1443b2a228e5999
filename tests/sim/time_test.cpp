// SPDX-License-Identifier: Apache-2.0
#include "sim/time.hpp"

#include <gtest/gtest.h>

#include <type_traits>

namespace takt::sim {
namespace {

template <class A, class B>
concept Comparable = requires(A a, B b) {
  a < b;
};
template <class A, class B>
concept Equal = requires(A a, B b) {
  a == b;
};
template <class A, class B>
concept Subtractable = requires(A a, B b) {
  a - b;
};
template <class A, class B>
concept Addable = requires(A a, B b) {
  a + b;
};
template <class A, class B>
concept Multipliable = requires(A a, B b) {
  a* b;
};

// Instants of different scales neither compare nor subtract nor convert: a compile error, not a convention.
template <class A, class B>
constexpr bool scales_mix = Comparable<A, B> || Equal<A, B> || Subtractable<A, B> || Addable<A, B> ||
                            std::is_constructible_v<A, B> || std::is_assignable_v<A&, B>;
static_assert(!scales_mix<TrueTime, LocalTime> && !scales_mix<LocalTime, TrueTime>);
static_assert(!scales_mix<TrueTime, PtpTime> && !scales_mix<PtpTime, TrueTime>);
static_assert(!scales_mix<LocalTime, PtpTime> && !scales_mix<PtpTime, LocalTime>);

// An instant is no duration and no number; two instants do not add; a number has no unit.
static_assert(!Addable<TrueTime, TrueTime> && Subtractable<TrueTime, TrueTime> && Addable<TrueTime, Duration>);
static_assert(!Comparable<TrueTime, Duration> && !Comparable<Duration, std::int64_t> &&
              !Addable<Duration, std::int64_t>);
static_assert(!Multipliable<Duration, Duration> && Multipliable<Duration, std::int64_t> &&
              Multipliable<std::int64_t, Duration>);
static_assert(!std::is_constructible_v<Duration, std::int64_t> && !std::is_convertible_v<Duration, std::int64_t>);
static_assert(!std::is_constructible_v<TrueTime, std::int64_t> && !std::is_constructible_v<TrueTime, Duration>);
static_assert(std::is_same_v<decltype(TrueTime() - TrueTime()), Duration>);
static_assert(std::is_same_v<decltype(TrueTime() - Duration()), TrueTime>);

static_assert(sizeof(TrueTime) == 8 && sizeof(Duration) == 8 && std::is_trivially_copyable_v<TrueTime>);

TEST(Time, LiteralsCountPicoseconds) {
  EXPECT_EQ((1_ps).ps(), 1);
  EXPECT_EQ((1_ns).ps(), 1'000);
  EXPECT_EQ((1_us).ps(), 1'000'000);
  EXPECT_EQ((1_ms).ps(), 1'000'000'000);
  EXPECT_EQ((1_s).ps(), 1'000'000'000'000);
  // 106 days of 86 400 s are 9'158'400 s, which 2^63 ps (9'223'372 s) still hold.
  EXPECT_EQ((9'158'400_s).ps(), 9'158'400'000'000'000'000);
}

TEST(Time, DurationArithmetic) {
  Duration d = 3_us - 5_us;
  EXPECT_EQ(d.ps(), -2'000'000);
  EXPECT_EQ((-d).ps(), 2'000'000);
  d += 2_ns;
  d -= 1_ps;
  EXPECT_EQ(d.ps(), -1'998'001);  // -2 000 000 + 2 000 - 1
  EXPECT_EQ(7_ns * 3, 21_ns);
  EXPECT_EQ(3 * 7_ns, 21_ns);
  EXPECT_EQ(10_us / 3_us, 3);  // how often 3 us goes into 10 us
  EXPECT_EQ(10_us % 3_us, 1_us);
  EXPECT_EQ(10_ps / 4, 2_ps);  // towards zero
  EXPECT_EQ((-(10_ps) / 4).ps(), -2);
  EXPECT_EQ((-(10_ps) % 4_ps).ps(), -2);
  EXPECT_EQ(Duration(), 0_ps);
  EXPECT_LT(-(1_ps), Duration());
  EXPECT_GT(Duration::max(), 9'158'400_s);
}

TEST(Time, InstantArithmetic) {
  TrueTime t = TrueTime::from_ps(100);
  EXPECT_EQ(t + 5_ps, TrueTime::from_ps(105));
  EXPECT_EQ(t - 150_ps, TrueTime::from_ps(-50));
  EXPECT_EQ(t - TrueTime::from_ps(40), 60_ps);
  EXPECT_EQ(TrueTime::from_ps(40) - t, -(60_ps));
  t += 1_ns;
  EXPECT_EQ(t.ps(), 1'100);
  EXPECT_EQ(t.since_start(), 1'100_ps);
  EXPECT_EQ(TrueTime().ps(), 0);
  EXPECT_GT(TrueTime::never(), TrueTime::from_ps(9'158'400'000'000'000'000));
  EXPECT_EQ(TrueTime::never().ps(), INT64_MAX);
}

}  // namespace
}  // namespace takt::sim
