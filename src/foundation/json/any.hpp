// SPDX-License-Identifier: Apache-2.0
// Any JSON value, as it was written: of fields whose meaning decides what they may be.
#pragma once

#include "json/fields.hpp"

namespace takt::json {

struct Any {
  Node node;
  Source where;
  bool operator==(const Any& other) const { return equal(node, other.node); }
};

const Custom& describe(Type<Any>);

}  // namespace takt::json
