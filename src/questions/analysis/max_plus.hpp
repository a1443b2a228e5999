// SPDX-License-Identifier: Apache-2.0
// Max-plus algebra: "plus" is the later of two instants, "times" is one duration after another. Matrices hold delays
// from column to row; their product composes steps of a handshake: (A * B)(i, j) = max over k of A(i, k) + B(k, j).
#pragma once

#include <cstddef>
#include <vector>

#include "analysis/picoseconds.hpp"

namespace takt::analysis {

/// A duration, or "never happens" (the zero of the algebra), or "unbounded", which swallows every duration.
class MaxPlus {
 public:
  /// Never: neutral for +, absorbing for *.
  constexpr MaxPlus() = default;
  constexpr explicit MaxPlus(Ps ps) : ps_(ps) {}
  static constexpr MaxPlus zero() { return MaxPlus(); }
  static constexpr MaxPlus one() { return MaxPlus(0); }
  static constexpr MaxPlus unbounded() { return MaxPlus(unbounded_ps); }

  constexpr bool happens() const { return ps_ != never; }
  /// Precondition: happens().
  constexpr Ps ps() const { return ps_; }

  constexpr auto operator<=>(const MaxPlus&) const = default;
  friend constexpr MaxPlus operator+(MaxPlus a, MaxPlus b) { return a.ps_ > b.ps_ ? a : b; }
  friend constexpr MaxPlus operator*(MaxPlus a, MaxPlus b) {
    return a.happens() && b.happens() ? MaxPlus(sum(a.ps_, b.ps_)) : zero();
  }
  constexpr MaxPlus& operator+=(MaxPlus other) { return *this = *this + other; }
  constexpr MaxPlus& operator*=(MaxPlus other) { return *this = *this * other; }

 private:
  static constexpr Ps never = std::numeric_limits<Ps>::min();
  Ps ps_ = never;
};

/// A matrix of them; zero() everywhere at first.
class MaxPlusMatrix {
 public:
  MaxPlusMatrix(std::size_t rows, std::size_t columns) : rows_(rows), columns_(columns), entries_(rows * columns) {}
  static MaxPlusMatrix identity(std::size_t n);

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  MaxPlus& operator()(std::size_t row, std::size_t column) { return entries_[row * columns_ + column]; }
  MaxPlus operator()(std::size_t row, std::size_t column) const { return entries_[row * columns_ + column]; }
  bool operator==(const MaxPlusMatrix&) const = default;

  /// Preconditions: the sizes fit.
  friend MaxPlusMatrix operator+(const MaxPlusMatrix& a, const MaxPlusMatrix& b);
  friend MaxPlusMatrix operator*(const MaxPlusMatrix& a, const MaxPlusMatrix& b);
  /// The latest of all entries.
  MaxPlus greatest() const;

 private:
  std::size_t rows_;
  std::size_t columns_;
  std::vector<MaxPlus> entries_;  // by row
};

}  // namespace takt::analysis
