// Stream identification, stream filters, gates, meters and ATS schedulers as instance data.
#pragma once

#include "interchange/export.hpp"
#include "interchange/ports.hpp"
#include "interchange/yang/data.hpp"

namespace takt::interchange::yang {

void write_policing(Data& root, const scenario::Resolved& resolved, const Device& device, Dialect dialect, std::uint64_t start_ns, Exported& exported);

}  // namespace takt::interchange::yang
