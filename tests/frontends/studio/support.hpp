// SPDX-License-Identifier: Apache-2.0
// What tests of the studio begin with.
#pragma once

namespace takt::studio {

/// Two hosts, a stream, and a requirement that is kept.
inline constexpr const char* small = R"({
  "name": "small", "duration": "20ms",
  "network": {"nodes": {"a": {"kind": "host"}, "b": {"kind": "host"}}, "links": [{"ends": ["a", "b"], "rate": "1Gbps", "length": "10m"}]},
  "streams": [{"name": "s", "from": "a", "to": "b", "payload": "100B", "every": "1ms"}],
  "require": [{"stream": "s", "latency": "10us"}]
})";

}  // namespace takt::studio
