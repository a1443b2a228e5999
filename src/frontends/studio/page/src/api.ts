// SPDX-License-Identifier: Apache-2.0
// The engine behind the page, as it answers.

export interface Diagnostic {
  severity: "error" | "warning";
  file: string;
  line: number;
  column: number;
  pointer: string;
  message: string;
  found?: string;
  expected?: string;
  suggestion?: string;
}

/// Times are in picoseconds.
export interface RunRequirement {
  text: string;
  verdict: string;
  measured_ps?: number | null;
  limit_ps?: number | null;
  remark?: string | null;
}

export interface Stream {
  sent: number;
  delivered: number;
  lost: number;
  latency_ps?: { min: number; mean: number; p99: number; max: number } | null;
}

export interface Reaction {
  kind: string;
  initiator: string;
  cause: string;
  began_ps: number;
  duration_ps?: number | null;
}

export interface Result {
  scenario: string;
  digest: string;
  simulated_ps: number;
  partial: boolean;
  verdict: string;
  requirements: RunRequirement[];
  streams: Record<string, Stream>;
  programs: Record<string, { reactions: Reaction[] }>;
}

export interface Proof {
  text: string;
  verdict: string;
  simulated_ps: number | null;
  adversarial_ps: number | null;
  bound_ps: number | null;
  limit_ps: number | null;
  reason: string | null;
  remark: string | null;
}

export interface Verification {
  verdict: string;
  runs: number;
  partial: boolean;
  requirements: Proof[];
}

export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };

export interface PlantNode {
  name: string;
  kind: "host" | "switch" | "station";
  title: string;
  failed: boolean;
  x: number;
  y: number;
}

export interface Plant {
  hidden: number;
  nodes: PlantNode[];
  links: { a: number; b: number; colour: string; title: string; failed: boolean }[];
  legend: { colour: string; text: string }[];
  paths: Record<string, number[][]>; // nodes from talker to listener
  requirements: { entry: number | null; subject: string }[]; // by position in the result
}

/// Where nodes were dragged to, in the units of PlantNode.
export interface Layout {
  nodes?: Record<string, [number, number]>;
}

export interface TimelineSummary {
  from_ps: number;
  to_ps: number;
  whole: boolean;
  frames: number;
  streams: string[];
  rows: { node: string; port: number; to: string; gates: boolean }[];
  tracks: { program: string; name: string; states: [number, string][] }[];
}

export interface Part {
  cause: string;
  words: string;
  at_ps: number;
  takes_ps: number;
  stream?: string | null;
  sequence?: number | null;
  gate_entry?: number | null;
  missing_bits?: number | null;
}

export interface Hop {
  node: string;
  port?: number | null;
  to?: string | null;
  traffic_class?: number | null;
  came_ps: number;
  started_ps?: number | null;
  cuts: number;
  parts: Part[];
}

export interface ExplainedFrame {
  stream: string;
  sequence: number;
  talker: string;
  end: string;
  node: string;
  reason?: string | null;
  produced_ps: number;
  ended_ps: number;
  takes_ps: number;
  hops: Hop[];
}

export interface Explanation {
  question: string;
  reaction?: {
    program: string;
    kind: string;
    cause: string;
    began_ps: number;
    takes_ps: number;
    steps: { what: string; who: string; at_ps: number; takes_ps: number; message?: ExplainedFrame | null }[];
  } | null;
  frames: ExplainedFrame[];
}

/// What one participant knows of another one; steps count from 1, 0 is before the first.
export interface Belief {
  who: string;
  of: string;
  heard: string | null;
  word: string | null;
  said_in: number | null;
  heard_in: number | null;
  is_true: boolean | null;
  now: string;
  now_since: number;
  is_new: boolean;
  is_cause: boolean;
}

export interface FoundRun {
  property: string;
  text: string;
  ends: string;
  beginning: string;
  participants: string[];
  states: Record<string, string>;
  knowledge: Belief[];
  steps: {
    step: number;
    sentence: string;
    arrow: string[];
    states: Record<string, string>;
    knowledge: Belief[];
    findings: string[];
  }[];
  cycle: number;
  why: string[];
}

export interface Exploration {
  program?: string;
  variant: string;
  slaves: number;
  states: number;
  exhausted: boolean;
  properties: Record<string, string>;
  violations?: FoundRun[];
}

export interface Compared {
  a: string;
  b: string;
  pairs: number;
  same_digest: number;
  measures: Record<string, { unit: string; a: Summary; b: Summary; difference: Summary }>;
  troubles: string[];
  divergence: { seed: number; at_ps: number; only_a: string[]; only_b: string[] } | null;
}

export interface Summary {
  count: number;
  mean?: number;
  half_width_95?: number | null;
}

/// A command that runs beside the engine, with what it has printed when it is over.
export interface Errand<T> {
  running: boolean;
  status: number;
  problem: string;
  output: T | null;
  points?: number;
  of?: number;
  report?: string;
}

export interface Findings {
  version: number;
  revision: number;
  text: string; // digest of the text that they belong to
  file: string; // of the file
  stage: string;
  diagnostics: { errors: number; warnings: number; diagnostics: Diagnostic[] } | null;
  network: Plant | null;
  result: Result | null;
  proofs: Verification | null;
  trouble: string;
}

export interface FileState {
  path: string;
  saved: string | null;
  digest: string; // of what is saved; empty: there is no file
  draft: string | null;
  draft_is_older: boolean; // than the file
  problem: string;
}

export interface Saved {
  problem: string;
  conflict: boolean; // the file is another one than the text rests on: nothing was written
  empties: boolean; // an empty text over a full one: likewise
  digest: string; // of the file, as it is now
}

const token = new URLSearchParams(location.search).get("token") ?? "";

export class EngineError extends Error {
  constructor(
    readonly status: number,
    words: string,
  ) {
    super(words);
  }
}

async function ask(method: string, path: string, body?: string): Promise<Response> {
  const response = await fetch(path, {
    method,
    headers: { "X-Takt-Token": token },
    ...(body === undefined ? {} : { body }),
  });
  if (!response.ok) throw new EngineError(response.status, (await response.text()).trim() || response.statusText);
  return response;
}

async function json<T>(method: string, path: string, body?: string): Promise<T> {
  return (await (await ask(method, path, body)).json()) as T;
}

/// A run that is looked at: of that text, as it is (-1) or the worst that was found for a requirement, from that instant on.
export interface Look {
  revision: number;
  requirement: number;
  from: number;
}
const lookAt = (look: Look) =>
  `revision=${look.revision}&run=${look.requirement < 0 ? "" : look.requirement}&from=${look.from}`;

export const engine = {
  schema: () => json<{ [key: string]: Json }>("GET", "/api/schema"),
  file: () => json<FileState>("GET", "/api/file"),
  save: (text: string, base: string, revision: number, mayEmpty: boolean) =>
    json<Saved>("PUT", `/api/file?base=${base}&revision=${revision}${mayEmpty ? "&empty=yes" : ""}`, text),
  tell: (revision: number, text: string, base: string, isCoarse: boolean) =>
    json<{ problem: string; text: string }>(
      "PUT",
      `/api/text?revision=${revision}&base=${base}${isCoarse ? "&pace=coarse" : ""}`,
      text,
    ),
  layout: () => json<Layout>("GET", "/api/layout"),
  keepLayout: (layout: string) => json<{ problem: string }>("PUT", "/api/layout", layout),
  timeline: (look: Look) => json<TimelineSummary>("GET", `/api/timeline?${lookAt(look)}`),
  piece: async (look: Look, level: number, index: number, first: number, count: number) =>
    (
      await ask("GET", `/api/piece?${lookAt(look)}&level=${level}&index=${index}&first=${first}&count=${count}`)
    ).arrayBuffer(),
  explain: (look: Look, stream: string, sequence: number) =>
    json<Explanation>("GET", `/api/explain?${lookAt(look)}&stream=${encodeURIComponent(stream)}&sequence=${sequence}`),
  explainWorst: (look: Look) => json<Explanation>("GET", `/api/explain?${lookAt(look)}`),
  studies: () => json<string[]>("GET", "/api/studies"),
  explore: (text: string, options: string) => json<{ problem: string }>("PUT", `/api/explore?${options}`, text),
  compare: (a: string, b: string) =>
    json<{ problem: string }>("PUT", `/api/compare?length=${new TextEncoder().encode(a).length}`, a + b),
  study: (file: string) => json<{ problem: string }>("PUT", `/api/study?file=${encodeURIComponent(file)}`, ""),
  errand: <T>(name: string) => json<Errand<T>>("GET", `/api/errand?name=${name}`),
  endErrand: (name: string) => json<{ problem: string }>("DELETE", `/api/errand?name=${name}`),
  findings: (after: number, file: string) => json<Findings>("GET", `/api/findings?after=${after}&file=${file}`),
};
