// SPDX-License-Identifier: Apache-2.0
// A master alone waits in INIT for its slave.
#include "handshake/participant.hpp"

int main() {
  takt::handshake::Participant<4> master({});
  master.step(takt::handshake::Input::command(takt::program::Method::Start));
  return master.state() == takt::handshake::PublishedState::HaltedInit ? 0 : 1;
}
