// SPDX-License-Identifier: Apache-2.0
// The tag by which a type's table is found.
#pragma once

namespace takt::json {

struct Record;

/// Names a type in an overload of describe(), found by argument-dependent lookup in the type's own namespace.
template <class T>
struct Type {};

}  // namespace takt::json
