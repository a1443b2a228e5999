// SPDX-License-Identifier: Apache-2.0
// ProgramStateMachineType with its invocations: Creatable, InstanceCount, deletion (OPC 10000-10, 4.2.10 and 5.2.2).
#pragma once

#include <memory>

#include "program/program.hpp"

namespace takt::program {

class ProgramType {
 public:
  /// `max_instance_count` below 0: any number.
  explicit ProgramType(bool creatable = true, std::int32_t max_instance_count = -1)
      : creatable_(creatable), max_instance_count_(max_instance_count) {}

  std::uint32_t instance_count() const { return static_cast<std::uint32_t>(instances_.size()); }
  /// The invocation with this name; nullptr if there is none. Valid until it is deleted.
  Program* find(const std::string& name);

  /// A client's Create. Bad_NotExecutable if the type is not creatable, Bad_ResourceUnavailable if there are as many as
  /// may be, Bad_InvalidArgument if the name is taken or empty.
  StatusCode create(ProgramSettings settings, const Program::Creator& creator, sim::LocalTime now);
  /// A client's DeleteNodes: Bad_NodeIdUnknown, Bad_UserAccessDenied if it is not deletable, Bad_InvalidState if it is
  /// not in Halted. The results go with it.
  StatusCode remove(const std::string& name);

  /// Calls a method of an invocation, and removes it where AutoDelete says so. Bad_NodeIdUnknown if there is none.
  Outcome call(const std::string& name, const Call& call, sim::LocalTime now);
  /// As `Program::advance`, and AutoDelete.
  Outcome advance(const std::string& name, std::uint32_t transition_number, sim::LocalTime now,
                  std::vector<NamedValue> result = {});

 private:
  Outcome settled(const std::string& name, Outcome outcome);

  bool creatable_;
  std::int32_t max_instance_count_;
  std::vector<std::unique_ptr<Program>> instances_;
};

}  // namespace takt::program
