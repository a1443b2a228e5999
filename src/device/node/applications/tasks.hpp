// SPDX-License-Identifier: Apache-2.0
// What the threads of applications and gateways do at each activation.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "gateway/channel.hpp"
#include "node/applications/topic_end.hpp"

namespace takt::node {

/// What one call did.
struct CallResult {
  std::uint32_t sent = 0;
  std::uint32_t timed_out = 0;
  std::uint32_t not_sent = 0;
  std::uint32_t taken = 0;     ///< samples that came
  std::uint32_t buffered = 0;  ///< those of them that the buffer held
  std::optional<bool> is_high =
      {};  ///< of a subscription: whether the first field of the last one is not zero; nothing if none came
};

/// The work of a thread. `now`: nanoseconds of the clock. Called by its thread alone.
class Work {
 public:
  virtual ~Work() = default;
  virtual CallResult call(std::int64_t now) = 0;
  virtual std::uint64_t lost() const { return 0; }
};

/// The newest sample of each topic that an application has taken, as fields: what its publishing threads may copy.
class NewestSamples {
 public:
  void put(const std::string& topic, uadp::Octets fields);
  /// False before the first one.
  bool get(const std::string& topic, std::vector<std::byte>& fields) const;

 private:
  mutable std::mutex mutex_;
  std::map<std::string, std::vector<std::byte>> samples_;
};

/// The topic outlives it, here and below.
std::unique_ptr<Work> make_publishing(const application::TopicShape& topic, TopicWriter& writer, const Payload& payload,
                                      NewestSamples& newest);
/// `is_copied`: some thread publishes what this one takes.
std::unique_ptr<Work> make_subscribing(const std::string& name, const application::TopicShape& topic,
                                       TopicReader& reader, std::uint32_t buffer, bool is_copied,
                                       NewestSamples& newest);

/// The channel of a gateway, which its two threads share.
struct SharedChannel {
  SharedChannel(gateway::TypeMapping mapping, const gateway::BufferSettings& settings)
      : channel(std::move(mapping), settings) {}
  /// Local time from the first call of either thread, since clocks count from long before and local time ends after 106
  /// days. With the lock held.
  sim::LocalTime local(std::int64_t now_ns) {
    if (!epoch_ns) epoch_ns = now_ns;
    return sim::LocalTime::from_ps((now_ns - *epoch_ns) * 1000);
  }

  std::mutex mutex;
  gateway::Channel channel;
  std::optional<std::int64_t> epoch_ns;
};
std::unique_ptr<Work> make_receiving(TopicReader& reader, SharedChannel& channel);
std::unique_ptr<Work> make_sending(TopicWriter& writer, SharedChannel& channel);

}  // namespace takt::node
