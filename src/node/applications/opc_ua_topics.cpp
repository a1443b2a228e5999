#include <deque>
#include <mutex>

#include "gateway/field_values.hpp"
#include "node/applications/topic_end.hpp"
#include "pubsub/communication.hpp"

namespace takt::node {
namespace {

using namespace sim::literals;  // NOLINT

// Threads say when something is published, by setting the DataSet. A PublishingInterval would say it again when it is over.
constexpr sim::Duration seldom = 90 * 24 * 3600_s;
constexpr std::uint16_t data_set_writer = 1;  // alone in its group

pubsub::WriterGroupSettings group_settings(std::uint16_t writer_group) {
  pubsub::WriterGroupSettings settings;
  settings.writer_group_id = writer_group;
  settings.publishing_interval = seldom;
  settings.publish_on_change = true;
  return settings;
}

class NoInput final : public pubsub::SubscribedData {
 public:
  uadp::Octets next() override { return {}; }
};
class NoOutput final : public pubsub::PublishedData {
 public:
  void publish(uadp::Octets, const pubsub::Destination&) override {}
};

}  // namespace

struct OpcUaTopics::Shared {
  Shared(std::unique_ptr<Socket> given, std::int64_t (*clock)()) : socket(std::move(given)), now_ns(clock), epoch_ns(clock()) {}

  sim::LocalTime now() const { return sim::LocalTime::from_ps((now_ns() - epoch_ns) * 1000); }
  /// Gives what the socket holds to all readers, `most_taken` messages at most. With the lock held.
  void distribute();

  std::mutex mutex;  ///< of all that is below
  std::unique_ptr<Socket> socket;
  std::int64_t (*now_ns)();
  std::int64_t epoch_ns;
  std::vector<std::unique_ptr<Writer>> writers;
  std::vector<std::unique_ptr<Reader>> readers;
};

class OpcUaTopics::Writer final : public TopicWriter {
 public:
  Writer(Shared& shared, const TopicShape& topic, std::uint16_t writer_group)
      : shared_(shared), values_(topic.fields), publisher_(uadp::PublisherId::uint16(topic.publisher_id)), communication_(*shared.socket, input_) {
    const std::uint16_t group = publisher_.add_writer_group(group_settings(writer_group));
    publisher_.add_data_set("values", values_, {.data_set_writer_id = data_set_writer}, group);
    communication_.add_publisher(publisher_);
    communication_.enable(shared.now());
  }

  SendOutcome write(uadp::Octets value) override {
    const std::lock_guard lock(shared_.mutex);
    if (!values_.assign(value)) return SendOutcome::failed;
    const std::uint64_t failures = shared_.socket->send_failures();
    communication_.advance(shared_.now());
    return shared_.socket->send_failures() == failures ? SendOutcome::sent : SendOutcome::failed;
  }

 private:
  Shared& shared_;
  gateway::FieldValues values_;
  NoInput input_;
  pubsub::Publisher publisher_;
  pubsub::Communication communication_;
};

class OpcUaTopics::Reader final : public TopicReader {
 public:
  Reader(Shared& shared, const TopicShape& topic) : shared_(shared), values_(topic.fields), subscriber_(uadp::PublisherId::uint16(topic.publisher_id)), communication_(output_, input_) {
    for (std::uint16_t each = 1; each <= topic.writer_groups; ++each) {
      names_.push_back("values of " + std::to_string(each));
      const std::size_t group = subscriber_.add_reader_group(each);
      subscriber_.add_data_set(names_.back(), values_, {.data_set_writer_id = data_set_writer}, group);
    }
    values_.on_received([this] {
      if (waiting_.size() == most_taken) waiting_.pop_front();
      const uadp::Octets octets = values_.octets();
      waiting_.emplace_back(octets.begin(), octets.end());
    });
    communication_.add_subscriber(subscriber_);
    communication_.enable(shared.now());
  }

  std::span<const std::vector<std::byte>> take() override {
    const std::lock_guard lock(shared_.mutex);
    shared_.distribute();
    taken_.assign(std::make_move_iterator(waiting_.begin()), std::make_move_iterator(waiting_.end()));
    waiting_.clear();
    return taken_;
  }
  std::uint64_t lost() const override {
    std::uint64_t sum = 0;
    for (const std::string& name : names_) sum += subscriber_.reader(name)->missed();
    return sum;
  }
  void received(uadp::Octets message) { communication_.received(message, shared_.now()); }

 private:
  Shared& shared_;
  gateway::FieldValues values_;
  NoOutput output_;
  NoInput input_;
  pubsub::Subscriber subscriber_;
  std::vector<std::string> names_;  ///< of its readers, one for each WriterGroup
  pubsub::Communication communication_;
  std::deque<std::vector<std::byte>> waiting_;  ///< the newest that no thread has taken
  std::vector<std::vector<std::byte>> taken_;
};

void OpcUaTopics::Shared::distribute() {
  for (std::size_t i = 0; i < most_taken; ++i) {
    const uadp::Octets message = socket->next();
    if (message.empty()) return;
    for (const auto& reader : readers) reader->received(message);
  }
}

OpcUaTopics::OpcUaTopics(std::unique_ptr<Socket> socket, std::int64_t (*now_ns)()) : shared_(std::make_unique<Shared>(std::move(socket), now_ns)) {}
OpcUaTopics::~OpcUaTopics() = default;

TopicWriter& OpcUaTopics::add_writer(const TopicShape& topic, std::uint16_t writer_group) {
  return *shared_->writers.emplace_back(std::make_unique<Writer>(*shared_, topic, writer_group));
}
TopicReader& OpcUaTopics::add_reader(const TopicShape& topic) { return *shared_->readers.emplace_back(std::make_unique<Reader>(*shared_, topic)); }
std::uint64_t OpcUaTopics::send_failures() const { return shared_->socket->send_failures(); }

}  // namespace takt::node
