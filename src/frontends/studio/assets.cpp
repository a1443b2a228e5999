// SPDX-License-Identifier: Apache-2.0
// The page, as the build has bundled it, within the program.
#include "studio/server.hpp"

#ifdef TAKT_STUDIO_PAGE

// The assembler reads the files: as arrays of numbers they would take the compiler longer than all the rest of the
// studio.
#define TAKT_EMBED(symbol, file)                                                                                 \
  asm(".section .rodata\n.global takt_studio_" #symbol "\ntakt_studio_" #symbol ":\n.incbin \"" TAKT_STUDIO_PAGE \
      "/" file "\"\n.global takt_studio_" #symbol "_end\ntakt_studio_" #symbol "_end:\n.byte 0\n.previous\n");   \
  extern "C" const char takt_studio_##symbol[];                                                                  \
  extern "C" const char takt_studio_##symbol##_end[]
TAKT_EMBED(html, "page.html");
TAKT_EMBED(script, "page.js");
TAKT_EMBED(style, "page.css");
#undef TAKT_EMBED

namespace takt::studio {

Assets built_in_assets() {
  return {{takt_studio_html, static_cast<std::size_t>(takt_studio_html_end - takt_studio_html)},
          {takt_studio_script, static_cast<std::size_t>(takt_studio_script_end - takt_studio_script)},
          {takt_studio_style, static_cast<std::size_t>(takt_studio_style_end - takt_studio_style)}};
}

}  // namespace takt::studio

#else

namespace takt::studio {

Assets built_in_assets() { return {}; }

}  // namespace takt::studio

#endif
