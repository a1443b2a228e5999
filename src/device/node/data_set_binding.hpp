// SPDX-License-Identifier: Apache-2.0
// The data sets of a Program as pubsub::DataSet<T>: what the application sets is published, what comes is in its
// DataSets.
#pragma once

#include <string_view>
#include <vector>

#include "node/application.hpp"
#include "pubsub/data_set.hpp"
#include "wire/program_shape.hpp"

namespace takt::node {

class DataSetBinding final : public Application {
 public:
  /// `shape` is copied from.
  explicit DataSetBinding(const wire::ProgramShape& shape);

  /// `data_set` outlives this. False if the Program has no data set of this name, or other fields in it: a field of the
  /// Program with a count is that many elements, so a std::array of them.
  bool bind(std::string_view name, pubsub::AnyDataSet& data_set);

  void produce(std::size_t data_set, std::int64_t time_ns, std::span<std::byte> fields) override;
  void consume(std::size_t data_set, std::int64_t time_ns, uadp::Octets fields) override;

 private:
  struct Bound {
    wire::DataSetShape shape;
    pubsub::AnyDataSet* data_set = nullptr;
  };
  std::vector<Bound> bound_;  ///< by data set of the Program
};

}  // namespace takt::node
