// A scale from figures to pixels, with round marks.
#pragma once

#include <string>
#include <vector>

namespace takt::chart {

enum class Scale { linear, logarithmic };

class Axis {
 public:
  /// From the figures [least, greatest] to the pixels [from, to]. A logarithmic one wants least > 0.
  Axis(Scale scale, double least, double greatest, double from, double to);

  double pixel(double value) const;
  struct Mark {
    double value = 0;
    std::string text;
  };
  /// About five round figures; powers of ten (or of two for a span of less than two decades) on a logarithmic axis.
  std::vector<Mark> marks() const;

 private:
  Scale scale_;
  double least_;
  double greatest_;
  double from_;
  double to_;
};

}  // namespace takt::chart
