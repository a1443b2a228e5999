#include "plant/criterion.hpp"

#include <algorithm>

namespace takt::plant {

std::optional<double> CriterionFigures::percent() const {
  if (expected == 0) return std::nullopt;
  return 100.0 * static_cast<double>(counted) / static_cast<double>(expected);
}

void Criterion::begin(std::int64_t now) {
  const std::int64_t since = std::max({now, settings_.after, settings_.phase}) - settings_.phase;
  number_ = (since + settings_.length - 1) / settings_.length;
  happened_ = 0;
  has_begun_ = true;
}

void Criterion::end() {
  if (open()) ++figures_.discarded;
  has_begun_ = false;
}

std::optional<Criterion::Window> Criterion::open() const {
  if (!has_begun_ || (settings_.most_tests && figures_.tests >= *settings_.most_tests)) return std::nullopt;
  const std::int64_t from = settings_.phase + number_ * settings_.length;
  return Window{from, from + settings_.length};
}

void Criterion::add(std::int64_t due, std::uint64_t count) {
  if (const auto window = open(); window && due >= window->from && due < window->to) happened_ += count;
}

void Criterion::look(std::int64_t now) {
  const auto window = open();
  if (!window || now < window->to) return;
  if (now - window->to > settings_.tolerance) {
    // What began before this look is discarded, but for the window that is open now.
    const std::int64_t number = (now - settings_.phase) / settings_.length;
    figures_.discarded += static_cast<std::uint64_t>(number - number_);
    number_ = number;
  } else {
    ++figures_.tests;
    figures_.expected += settings_.expected;
    figures_.counted += std::min(happened_, settings_.expected);
    figures_.beyond += happened_ - std::min(happened_, settings_.expected);
    figures_.windows_below += happened_ < settings_.expected ? 1 : 0;
    figures_.windows_above += happened_ > settings_.expected ? 1 : 0;
    ++number_;
  }
  happened_ = 0;
}

}  // namespace takt::plant
