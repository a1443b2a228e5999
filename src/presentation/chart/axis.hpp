// SPDX-License-Identifier: Apache-2.0
// A scale from figures to pixels, and where its ticks stand.
#pragma once

#include <string>
#include <vector>

namespace takt::chart {

enum class Scale { linear, logarithmic };

struct Tick {
  double value = 0;
  std::string text;
};

/// Linear or logarithmic, from `low` to `high` (figures) onto `from` to `to` (pixels).
class Axis {
 public:
  /// Takes in all finite `values`; a logarithmic axis takes in only those above 0, and is linear if there are none. The
  /// ends are widened to ticks. Equal values get an axis around them.
  Axis(const std::vector<double>& values, Scale scale, double from, double to);
  /// With the ends as they are. A logarithmic one wants low > 0.
  Axis(Scale scale, double low, double high, double from, double to);

  bool is_logarithmic() const { return is_logarithmic_; }
  double low() const { return low_; }
  double high() const { return high_; }
  /// The pixel of a figure; beyond the ends, the end.
  double at(double value) const;
  /// Round numbers: steps of 1, 2 or 5 times a power of ten; powers of ten on a logarithmic axis (with 2 and 5 on a
  /// short one).
  std::vector<Tick> ticks() const;

 private:
  bool is_logarithmic_;
  double low_ = 0;
  double high_ = 1;
  double step_ = 1;  // between ticks of a linear axis
  double from_;
  double to_;
};

/// Few digits, without trailing zeros; 1e6 and beyond with an exponent.
std::string number_text(double value);

}  // namespace takt::chart
