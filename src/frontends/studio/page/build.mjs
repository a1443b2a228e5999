// SPDX-License-Identifier: Apache-2.0
// Bundles the page: node build.mjs [FOLDER], by default dist.
import { build } from "esbuild";
import { copyFile, mkdir } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const out = process.argv[2] ?? join(here, "dist");
await mkdir(out, { recursive: true });
await build({
  absWorkingDir: here,
  entryPoints: { page: "src/main.ts" },
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  outdir: out,
  legalComments: "none",
  logLevel: "warning",
});
for (const file of ["page.html", "page.css"]) await copyFile(join(here, "src", file), join(out, file));
