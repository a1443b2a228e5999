// SPDX-License-Identifier: Apache-2.0
// The content filter of a thread that subscribes over DDS.
#pragma once

#include <optional>

#include "application/topic_shape.hpp"
#include "gateway/content_filter.hpp"
#include "json/diagnostics.hpp"
#include "plant/application.hpp"

namespace takt::application {

/// What its "filter" lets pass; nothing: it has none, or there is a mistake, which has been reported. `topic`: what it
/// subscribes to, with sound fields.
std::optional<gateway::ContentFilter> filter_of(const plant::Thread& thread, const TopicShape& topic,
                                                json::Diagnostics& diagnostics);

}  // namespace takt::application
