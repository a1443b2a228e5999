// SPDX-License-Identifier: Apache-2.0
// The readers, one for each format; instances.hpp finds the one that fits. Each tells all mistakes that it finds; the
// problem counts only if there are none.
#pragma once

#include <string_view>

#include "schedule_instances/builder.hpp"
#include "schedule_instances/instances.hpp"
#include "xml/xml.hpp"
#include "json/document.hpp"

namespace takt::schedule_instances {

Instance read_neutral(const json::Document& document, json::Diagnostics& diagnostics);
/// One entry of its "streams".
void read_neutral_stream(const Pick& pick, json::Reader& reader, Builder& builder);
Instance read_tas_benchmark(const json::Document& document, json::Diagnostics& diagnostics);
Instance read_tsnsched(const json::Document& document, json::Diagnostics& diagnostics);
/// A topology (".top") and a set of streams (".pat").
Instance read_tsn_bench_scenario(const json::Document& topology, const json::Document& streams,
                                 json::Diagnostics& diagnostics);

Instance read_tsnkit(const TextFile& tasks, const TextFile& topology, json::Diagnostics& diagnostics);
/// Streams of the given traffic class at 100 Mbit/s are scheduled.
Instance read_ecrts(const TextFile& streams, json::Diagnostics& diagnostics);

Instance read_graphml(const XmlElement& network, const XmlElement& applications, const std::string& name,
                      const GraphmlAssumptions& assumptions, json::Diagnostics& diagnostics);

/// "folder/name.json" is "name".
std::string stem_of(std::string_view path);

}  // namespace takt::schedule_instances
