// SPDX-License-Identifier: Apache-2.0
// A message of a Program is read back.
#include <array>

#include "program/machine.hpp"
#include "wire/program_format.hpp"

int main() {
  takt::wire::ProgramShape shape;
  shape.name = "cell";
  shape.participants = {"master", "slave"};
  const takt::wire::ProgramFormat format(shape);
  std::array<std::byte, 100> octets;
  takt::wire::StateMessage message;
  message.sender = 1;
  const auto read = format.decode(format.encode(message, octets));
  const auto* const state = read ? std::get_if<takt::wire::StateMessage>(&*read) : nullptr;
  return state != nullptr && *state == message ? 0 : 1;
}
