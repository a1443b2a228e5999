// SPDX-License-Identifier: Apache-2.0
// A DataSet whose fields are known at run time only: values stay in the encoding in which they travel.
#pragma once

#include <functional>
#include <vector>

#include "gateway/type_mapping.hpp"
#include "pubsub/data_set.hpp"

namespace takt::gateway {

/// Between a pubsub::Subscriber or Publisher and a Channel. Fields begin as zeros, empty strings and arrays; arrays of
/// a declared length with so many zeros.
class FieldValues final : public pubsub::AnyDataSet {
 public:
  explicit FieldValues(std::vector<DataSetField> fields);

  const std::vector<DataSetField>& fields() const { return fields_; }
  /// All fields as Variants, one behind the other; valid until the next change. As on the wire, of a field that was
  /// received as Bad there is its StatusCode in place of a value; one that is Uncertain gives its value, and `status`
  /// tells.
  Octets octets() const;
  /// Takes what `octets` gives; false, and nothing has changed, if it is not these fields.
  bool assign(Octets octets);
  /// Called after each message that was taken.
  void on_received(std::function<void()> call_back) { call_back_ = std::move(call_back); }

  std::size_t field_count() const override { return fields_.size(); }
  uadp::RawField field(std::size_t index) const override { return fields_[index].type; }
  void put(uadp::Writer& writer, std::size_t index) const override { writer.put_octets(values_[index]); }
  bool can_take(std::size_t index, const uadp::Variant& value) const override;
  bool take(std::size_t index, const uadp::Variant& value) override;
  void notify() override {
    if (call_back_) call_back_();
  }

 private:
  std::vector<DataSetField> fields_;
  std::vector<std::vector<std::byte>> values_;  ///< each a Variant
  mutable std::vector<std::byte> joined_;
  std::function<void()> call_back_;
};

}  // namespace takt::gateway
