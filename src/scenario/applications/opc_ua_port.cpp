#include "scenario/applications/opc_ua_port.hpp"

#include "sim/check.hpp"

namespace takt::scenario {
namespace {

using namespace sim::literals;

// The threads say when something is published, by setting the DataSet; no PublishingInterval comes round in a simulation.
constexpr sim::Duration never = 106 * 24 * 3600_s;

class NoInput final : public pubsub::SubscribedData {
 public:
  uadp::Octets next() override { return {}; }
};

class NoOutput final : public pubsub::PublishedData {
 public:
  void publish(uadp::Octets, const pubsub::Destination&) override {}
};

pubsub::WriterGroupSettings group_of(const OpcUaAddress& address) {
  pubsub::WriterGroupSettings settings;
  settings.writer_group_id = address.writer_group_id;
  settings.publishing_interval = never;
  settings.publish_on_change = true;
  return settings;
}

/// Messages that wait in a socket: as many as a socket buffer of 208 KiB, the usual size on Linux, holds of small ones.
class Inbox {
 public:
  static constexpr std::size_t most_messages = 256;
  static constexpr std::size_t most_octets = 1472;

  void put(uadp::Octets message) {
    if (waiting_ == most_messages || message.size() > most_octets) return;
    std::vector<std::byte>& place = messages_[(first_ + waiting_) % most_messages];
    place.assign(message.begin(), message.end());
    ++waiting_;
  }
  /// The octets last until the next call of either.
  uadp::Octets take() {
    if (waiting_ == 0) return {};
    const uadp::Octets message = messages_[first_];
    --waiting_;
    first_ = waiting_ == 0 ? 0 : (first_ + 1) % most_messages;
    return message;
  }

 private:
  std::vector<std::vector<std::byte>> messages_ = std::vector<std::vector<std::byte>>(most_messages);
  std::size_t first_ = 0;
  std::size_t waiting_ = 0;
};

}  // namespace

OpcUaAddress address_of(const ResolvedTopic& topic, const ResolvedThread& publication) { return {topic.publisher_id, publication.writer_group, 1}; }

struct OpcUaWriter::Publishing {
  Publishing(const SampleLayout& layout, const OpcUaAddress& address, pubsub::PublishedData& stack)
      : data_set(layout), publisher(uadp::PublisherId::uint16(address.publisher_id)), communication(stack, input) {
    const std::uint16_t group = publisher.add_writer_group(group_of(address));
    pubsub::DataSetWriterSettings writer;
    writer.data_set_writer_id = address.data_set_writer_id;
    const bool added = publisher.add_data_set("sample", data_set, writer, group);
    TAKT_CHECK(added, "a writer that is alone in its group");
    communication.add_publisher(publisher);
  }

  SampleDataSet data_set;
  pubsub::Publisher publisher;
  NoInput input;
  pubsub::Communication communication;
};

OpcUaWriter::OpcUaWriter(const SampleLayout& layout, const OpcUaAddress& address, std::optional<models::StreamIndex> stream)
    : layout_(&layout), address_(address), stream_(stream) {}
OpcUaWriter::~OpcUaWriter() = default;

void OpcUaWriter::start(models::HostServices& host) {
  pubsub::PublishedData& stack = *this;
  publishing_ = std::make_unique<Publishing>(*layout_, address_, stack);
  publishing_->communication.enable(host.now());
}

void OpcUaWriter::crash() { publishing_.reset(); }

WriteOutcome OpcUaWriter::write(models::HostServices& host, uadp::Octets sample) {
  host_ = &host;
  publishing_->data_set.set(sample);
  publishing_->communication.advance(host.now());
  host_ = nullptr;
  return WriteOutcome::published;
}

void OpcUaWriter::publish(uadp::Octets network_message, const pubsub::Destination&) {
  octets_ = network_message.size();
  if (host_ != nullptr && stream_) host_->send(*stream_, network_message);
}

std::size_t OpcUaWriter::message_octets(const SampleLayout& layout, const OpcUaAddress& address) {
  OpcUaWriter writer(layout, address, std::nullopt);
  pubsub::PublishedData& stack = writer;
  writer.publishing_ = std::make_unique<Publishing>(layout, address, stack);
  writer.publishing_->communication.enable(sim::LocalTime());
  writer.publishing_->data_set.set(layout.zeros());
  writer.publishing_->communication.advance(sim::LocalTime());
  return writer.octets_;
}

struct OpcUaReader::Subscribing {
  Subscribing(const SampleLayout& layout, std::span<const OpcUaAddress> heard) : data_set(layout), communication(output, input) {
    for (const OpcUaAddress& address : heard) {
      subscribers.push_back(std::make_unique<pubsub::Subscriber>(uadp::PublisherId::uint16(address.publisher_id)));
      const std::size_t group = subscribers.back()->add_reader_group(address.writer_group_id);
      pubsub::DataSetReaderSettings reader;
      reader.data_set_writer_id = address.data_set_writer_id;
      subscribers.back()->add_data_set("sample", data_set, reader, group);
      communication.add_subscriber(*subscribers.back());
    }
  }

  std::uint64_t lost() const {
    std::uint64_t sum = 0;
    for (const auto& each : subscribers) sum += each->reader("sample")->missed();
    return sum;
  }

  SampleDataSet data_set;
  NoOutput output;
  NoInput input;
  pubsub::Communication communication;
  std::vector<std::unique_ptr<pubsub::Subscriber>> subscribers;
  Inbox inbox;
};

OpcUaReader::OpcUaReader(const SampleLayout& layout, std::vector<OpcUaAddress> heard) : layout_(&layout), heard_(std::move(heard)) {}
OpcUaReader::~OpcUaReader() = default;

void OpcUaReader::start(models::HostServices& host) {
  subscribing_ = std::make_unique<Subscribing>(*layout_, heard_);
  subscribing_->communication.enable(host.now());
}

void OpcUaReader::crash() {
  lost_ = lost();
  subscribing_.reset();
}

void OpcUaReader::receive(models::HostServices&, uadp::Octets message) {
  subscribing_->inbox.put(message);   // what finds no room leaves a gap in the numbers
}

std::optional<uadp::Octets> OpcUaReader::next(models::HostServices& host) {
  const std::uint64_t taken = subscribing_->data_set.taken();
  for (uadp::Octets message = subscribing_->inbox.take(); !message.empty(); message = subscribing_->inbox.take()) {
    subscribing_->communication.received(message, host.now());
    if (subscribing_->data_set.taken() != taken) return subscribing_->data_set.get();
  }
  return std::nullopt;
}

std::uint64_t OpcUaReader::lost() const { return lost_ + (subscribing_ ? subscribing_->lost() : 0); }

}  // namespace takt::scenario
