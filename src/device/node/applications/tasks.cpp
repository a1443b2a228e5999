// SPDX-License-Identifier: Apache-2.0
#include "node/applications/tasks.hpp"

#include <algorithm>

#include "application/topic_values.hpp"

namespace takt::node {
namespace {

CallResult result_of(SendOutcome outcome) {
  return {.sent = outcome == SendOutcome::sent ? 1U : 0U,
          .timed_out = outcome == SendOutcome::timed_out ? 1U : 0U,
          .not_sent = outcome == SendOutcome::failed ? 1U : 0U};
}

class Publishing final : public Work {
 public:
  Publishing(const application::TopicShape& topic, TopicWriter& writer, const Payload& payload, NewestSamples& newest)
      : writer_(writer), newest_(newest), copy_of_(payload.copy_of), publication_(topic, payload) {}

  CallResult call(std::int64_t) override {
    if (!copy_of_) return result_of(writer_.write(publication_.next()));
    if (!newest_.get(*copy_of_, copied_)) return {};
    const auto value = publication_.copy(copied_);
    return value ? result_of(writer_.write(*value)) : CallResult{};
  }

 private:
  TopicWriter& writer_;
  NewestSamples& newest_;
  std::optional<std::string> copy_of_;
  application::Publication publication_;
  std::vector<std::byte> copied_;
};

class Subscribing final : public Work {
 public:
  Subscribing(const std::string& name, const application::TopicShape& topic, TopicReader& reader, std::uint32_t buffer,
              bool is_copied, NewestSamples& newest)
      : name_(name),
        reader_(reader),
        newest_(newest),
        buffer_(buffer),
        is_copied_(is_copied),
        topic_(topic),
        subscription_(topic) {}

  CallResult call(std::int64_t) override {
    CallResult result;
    std::optional<uadp::Octets> last;
    for (const std::vector<std::byte>& value : reader_.take()) {
      const auto fields = subscription_.take(value);
      if (!fields) continue;
      if (is_copied_) newest_.put(name_, *fields);
      last = fields;
      ++result.taken;
    }
    if (last) result.is_high = !topic_.is_zero(*last);
    result.buffered = std::min(result.taken, buffer_);
    return result;
  }
  std::uint64_t lost() const override { return reader_.lost(); }

 private:
  std::string name_;
  TopicReader& reader_;
  NewestSamples& newest_;
  std::uint32_t buffer_;
  bool is_copied_;
  const application::TopicShape& topic_;
  application::Subscription subscription_;
};

class Receiving final : public Work {
 public:
  Receiving(TopicReader& reader, SharedChannel& channel) : reader_(reader), channel_(channel) {}

  CallResult call(std::int64_t now) override {
    CallResult result;
    const std::span<const std::vector<std::byte>> values = reader_.take();
    const std::lock_guard lock(channel_.mutex);
    for (const std::vector<std::byte>& value : values) channel_.channel.receive(value, channel_.local(now));
    result.taken = result.buffered = static_cast<std::uint32_t>(values.size());
    return result;
  }
  std::uint64_t lost() const override { return reader_.lost(); }

 private:
  TopicReader& reader_;
  SharedChannel& channel_;
};

class Sending final : public Work {
 public:
  Sending(TopicWriter& writer, SharedChannel& channel) : writer_(writer), channel_(channel) {}

  CallResult call(std::int64_t now) override {
    {
      const std::lock_guard lock(channel_.mutex);
      const auto next = channel_.channel.pull(channel_.local(now));
      if (!next) return {};
      value_.assign(next->octets.begin(), next->octets.end());
    }
    return result_of(writer_.write(value_));  // outside of the lock: a reliable writer may wait
  }

 private:
  TopicWriter& writer_;
  SharedChannel& channel_;
  std::vector<std::byte> value_;
};

}  // namespace

void NewestSamples::put(const std::string& topic, uadp::Octets fields) {
  const std::lock_guard lock(mutex_);
  samples_[topic].assign(fields.begin(), fields.end());
}

bool NewestSamples::get(const std::string& topic, std::vector<std::byte>& fields) const {
  const std::lock_guard lock(mutex_);
  const auto found = samples_.find(topic);
  if (found == samples_.end()) return false;
  fields = found->second;
  return true;
}

std::unique_ptr<Work> make_publishing(const application::TopicShape& topic, TopicWriter& writer, const Payload& payload,
                                      NewestSamples& newest) {
  return std::make_unique<Publishing>(topic, writer, payload, newest);
}
std::unique_ptr<Work> make_subscribing(const std::string& name, const application::TopicShape& topic,
                                       TopicReader& reader, std::uint32_t buffer, bool is_copied,
                                       NewestSamples& newest) {
  return std::make_unique<Subscribing>(name, topic, reader, buffer, is_copied, newest);
}
std::unique_ptr<Work> make_receiving(TopicReader& reader, SharedChannel& channel) {
  return std::make_unique<Receiving>(reader, channel);
}
std::unique_ptr<Work> make_sending(TopicWriter& writer, SharedChannel& channel) {
  return std::make_unique<Sending>(writer, channel);
}

}  // namespace takt::node
