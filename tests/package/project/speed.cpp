// SPDX-License-Identifier: Apache-2.0
// A value goes from a Publisher to a Subscriber through memory.
#include "pubsub/communication.hpp"
#include "pubsub/data_set.hpp"
#include "pubsub/memory_stack.hpp"

int main() {
  using namespace takt::pubsub;
  MemoryMedium medium;
  MemoryPort here(medium, 4, 1500);
  MemoryPort there(medium, 4, 1500);
  DataSet<double> sent(2.5);
  DataSet<double> received;
  Publisher publisher(takt::uadp::PublisherId::uint16(1));
  publisher.add_data_set("speed", sent);
  Subscriber subscriber(takt::uadp::PublisherId::uint16(1));
  subscriber.add_data_set("speed", received);
  Communication sending(here, here);
  Communication receiving(there, there);
  sending.add_publisher(publisher);
  receiving.add_subscriber(subscriber);
  const takt::sim::LocalTime now;
  sending.enable(now);
  receiving.enable(now);
  sending.advance(sending.next_time());
  receiving.poll(now);
  return received.get() == 2.5 ? 0 : 1;
}
