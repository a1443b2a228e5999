#include "wire/nesting.hpp"

namespace takt::wire {

using handshake::Side;

Nesting::Nesting(ProgramEndpoint& outer, EndpointHost& outer_host, ProgramEndpoint& inner, EndpointHost& inner_host)
    : outer_(&outer), outer_host_(&outer_host), inner_(&inner), inner_host_(&inner_host) {
  TAKT_CHECK(outer.settings().handshake.nested && inner.settings().handshake.nested, "both participants wait for each other");
  TAKT_CHECK(outer.settings().handshake.role == handshake::Role::Slave && inner.settings().handshake.role == handshake::Role::Master,
             "a slave of the outer group is the master of the inner one");
  outer.join(this);
  inner.join(this);
}

void Nesting::settle() {
  if (settling_) return;
  settling_ = true;
  while (const auto next = coupling_.next(view_of(outer_->participant()), view_of(inner_->participant()))) {
    if (next->side == Side::Outer)
      outer_->step(*outer_host_, next->input);
    else
      inner_->step(*inner_host_, next->input);
  }
  settling_ = false;
}

void Nesting::initialised(const ProgramEndpoint& endpoint, std::uint32_t run) {
  coupling_.initialised(&endpoint == outer_ ? Side::Outer : Side::Inner, run);
  settle();
}

}  // namespace takt::wire
