// SPDX-License-Identifier: Apache-2.0
// Process data of a node without an application: fields from simple sources, and a log of what is received.
#pragma once

#include <string>
#include <vector>

#include "node/application.hpp"
#include "node/config.hpp"
#include "node/log.hpp"

namespace takt::node {

class BuiltInValues final : public Application {
 public:
  /// For one Program of the node. `config` has been checked. Received values go to `log`, which outlives this;
  /// `is_named`: with the name of the Program.
  BuiltInValues(const Config& config, const wire::ProgramShape& shape, Log& log, bool is_named = false);

  void produce(std::size_t data_set, std::int64_t time_ns, std::span<std::byte> fields) override;
  void consume(std::size_t data_set, std::int64_t time_ns, uadp::Octets fields) override;

 private:
  struct Field {
    std::string name;
    uadp::BuiltInType type;
    std::uint16_t count = 1;
    std::size_t at = 0;           ///< octets from the begin of the fields
    std::vector<Source> sources;  ///< none: zeros
  };
  struct DataSet {
    std::string name;
    std::vector<Field> fields;
    double messages = 0;  ///< published so far
    std::int64_t next_log_ns = 0;
  };

  std::vector<DataSet> data_sets_;
  std::string program_;  ///< as a member with a comma behind it; or empty
  std::optional<Duration> log_values_every_;
  Log* log_;
};

/// The value of a source for the message with this number, from 0 on, at this time.
double value_of(const Source& source, double message, std::int64_t time_ns);

}  // namespace takt::node
