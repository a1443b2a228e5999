// SPDX-License-Identifier: Apache-2.0
// Logarithm, exponential and the normal quantile from + - * / and sqrt alone.
//
// IEEE 754 fixes the result of those operations to the bit, so these functions give the same bits with every compiler,
// library and machine, which libm does not. Relative error below 4e-15 in the ranges used by the distributions.
#pragma once

namespace takt::sim {

/// Natural logarithm. Precondition: x is positive, normal and finite.
double exact_log(double x);

/// Exponential. Below -700 it returns 0; above 700 the largest value it can (exp(700)).
double exact_exp(double x);

/// The quantile of the standard normal distribution (algorithm AS 241 of Wichura, 1988). Precondition: 0 < p < 1.
double normal_quantile(double p);

}  // namespace takt::sim
