// SPDX-License-Identifier: Apache-2.0
#include "analysis/max_plus.hpp"

#include <Eigen/Core>

#include "sim/check.hpp"

// What Eigen asks of a scalar.
namespace Eigen {
template <>
struct NumTraits<takt::analysis::MaxPlus> : GenericNumTraits<takt::analysis::MaxPlus> {
  using Real = takt::analysis::MaxPlus;
  using NonInteger = takt::analysis::MaxPlus;
  using Literal = takt::analysis::MaxPlus;
  using Nested = takt::analysis::MaxPlus;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = 1,
    AddCost = 2,
    MulCost = 3
  };
};
}  // namespace Eigen

namespace takt::analysis {
namespace {

using Dense = Eigen::Matrix<MaxPlus, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Dense dense(const MaxPlusMatrix& matrix) {
  Dense made(static_cast<Eigen::Index>(matrix.rows()), static_cast<Eigen::Index>(matrix.columns()));
  for (std::size_t i = 0; i < matrix.rows(); ++i)
    for (std::size_t j = 0; j < matrix.columns(); ++j)
      made(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = matrix(i, j);
  return made;
}

MaxPlusMatrix from(const Dense& matrix) {
  MaxPlusMatrix made(static_cast<std::size_t>(matrix.rows()), static_cast<std::size_t>(matrix.cols()));
  for (std::size_t i = 0; i < made.rows(); ++i)
    for (std::size_t j = 0; j < made.columns(); ++j)
      made(i, j) = matrix(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  return made;
}

}  // namespace

MaxPlusMatrix MaxPlusMatrix::identity(std::size_t n) {
  MaxPlusMatrix made(n, n);
  for (std::size_t i = 0; i < n; ++i) made(i, i) = MaxPlus::one();
  return made;
}

MaxPlusMatrix operator+(const MaxPlusMatrix& a, const MaxPlusMatrix& b) {
  TAKT_CHECK(a.rows() == b.rows() && a.columns() == b.columns(), "matrices of one size are added");
  return from(dense(a) + dense(b));
}

MaxPlusMatrix operator*(const MaxPlusMatrix& a, const MaxPlusMatrix& b) {
  TAKT_CHECK(a.columns() == b.rows(), "a product has matrices that fit");
  // Coefficient by coefficient: a blocked product begins with a literal 0, which is no zero here.
  return from(dense(a).lazyProduct(dense(b)));
}

MaxPlus MaxPlusMatrix::greatest() const {
  MaxPlus latest;
  for (const MaxPlus entry : entries_) latest += entry;
  return latest;
}

}  // namespace takt::analysis
