// From the words of files to the values of protocol code.
#pragma once

#include "handshake/participant.hpp"
#include "program/method.hpp"
#include "vocabulary/program.hpp"
#include "wire/program_shape.hpp"

namespace takt::vocabulary {

handshake::Variant variant_of(Variant variant);
handshake::Subscription subscription_of(Subscription subscription);
program::Method method_of(Method method);
uadp::BuiltInType built_in_type_of(DataType type);

/// `from` is the participant that `data.from` names.
wire::DataSetShape data_set_shape_of(const ProcessData& data, std::uint8_t from);

}  // namespace takt::vocabulary
