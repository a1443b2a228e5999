// A sample as a DataSet of OPC UA: the fields of its topic, known at run time only.
#pragma once

#include "pubsub/data_set.hpp"
#include "scenario/applications/sample_layout.hpp"

namespace takt::scenario {

class SampleDataSet final : public pubsub::AnyDataSet {
 public:
  /// The layout outlives it.
  explicit SampleDataSet(const SampleLayout& layout) : layout_(&layout), sample_(layout.zeros()) {}

  std::size_t field_count() const override { return layout_->fields().size(); }
  uadp::RawField field(std::size_t index) const override;
  void put(uadp::Writer& writer, std::size_t index) const override;
  bool can_take(std::size_t index, const uadp::Variant& value) const override;
  bool take(std::size_t index, const uadp::Variant& value) override;
  void notify() override { ++taken_; }

  /// The value that goes out with the next message.
  void set(std::span<const std::byte> sample);
  const Sample& get() const { return sample_; }
  /// Messages that were taken so far.
  std::uint64_t taken() const { return taken_; }

 private:
  const SampleLayout* layout_;
  Sample sample_;
  std::uint64_t taken_ = 0;
};

}  // namespace takt::scenario
