// SPDX-License-Identifier: Apache-2.0
// Configuration files of ptp4l (linuxptp 3.1; the names of version 4 are told).
#pragma once

#include "interchange/export.hpp"
#include "interchange/ports.hpp"

namespace takt::interchange::linux_tc {

/// The file of a node with gPTP in one of its domains; empty without gPTP.
struct Ptp4lFile {
  std::uint8_t domain = 0;
  std::string content;
};
std::vector<Ptp4lFile> ptp4l_files(const scenario::Resolved& resolved, const Device& device, bool in_software,
                                   Exported& exported);

}  // namespace takt::interchange::linux_tc
