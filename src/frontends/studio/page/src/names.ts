// SPDX-License-Identifier: Apache-2.0
// Names that a value may be: of nodes, streams, Programs, as they stand in the text or as generators make them.
import type { Path } from "./edits";

export interface Names {
  nodes: string[];
  streams: string[];
  programs: string[];
}

/// What a key names. A key of two meanings goes by the object in which it stands.
const meant: Record<string, keyof Names> = {
  from: "nodes",
  to: "nodes",
  on: "nodes",
  node: "nodes",
  master: "nodes",
  slaves: "nodes",
  ends: "nodes",
  link: "nodes",
  link_down: "nodes",
  path: "nodes",
  paths: "nodes",
  grandmaster: "nodes",
  clocks: "nodes",
  stream: "streams",
  streams: "streams",
  babble: "streams",
  program: "programs",
};

const quantities = new Set(["frequency", "latency_tail", "oscillator"]); // "from" and "to" are bounds of a number there

/// The names that may stand at the end of that path.
export function namesAt(path: Path, names: Names): string[] {
  const keys = path.filter((step): step is string => typeof step === "string");
  const key = keys[keys.length - 1] ?? "";
  if (keys.some((each) => quantities.has(each))) return [];
  const kind = meant[key];
  return kind ? names[kind] : [];
}
