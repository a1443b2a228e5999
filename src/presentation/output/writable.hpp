// SPDX-License-Identifier: Apache-2.0
// Whether a place can be written to, found out before the work: nobody waits an hour to hear that the disk is not
// there.
#pragma once

#include <string>

namespace takt::output {

/// Why no files can be written into the folder, which need not be there: all that is missing of its path is made, a
/// file is written there, and both are taken away again. Empty: they can.
[[nodiscard]] std::string why_no_folder(const std::string& path);

/// The same of one file, new or replaced as write_file() does it. Devices and pipes are written to as they are.
[[nodiscard]] std::string why_no_file(const std::string& path);

}  // namespace takt::output
