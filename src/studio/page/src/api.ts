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
  requirements: Proof[];
}

export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };

export interface Findings {
  version: number;
  revision: number;
  stage: string;
  diagnostics: { errors: number; warnings: number; diagnostics: Diagnostic[] } | null;
  network: string;
  result: Result | null;
  proofs: Verification | null;
  trouble: string;
}

export interface FileState {
  path: string;
  saved: string | null;
  draft: string | null;
  problem: string;
}

const token = new URLSearchParams(location.search).get("token") ?? "";

async function ask(method: string, path: string, body?: string): Promise<Response> {
  const response = await fetch(path, { method, headers: { "X-Takt-Token": token }, ...(body === undefined ? {} : { body }) });
  if (!response.ok) throw new Error((await response.text()).trim() || response.statusText);
  return response;
}

async function json<T>(method: string, path: string, body?: string): Promise<T> {
  return (await (await ask(method, path, body)).json()) as T;
}

export const engine = {
  schema: () => json<{ [key: string]: Json }>("GET", "/api/schema"),
  file: () => json<FileState>("GET", "/api/file"),
  save: (text: string) => json<{ problem: string }>("PUT", "/api/file", text),
  tell: (revision: number, text: string) => json<{ problem: string }>("PUT", `/api/text?revision=${revision}`, text),
  findings: (after: number) => json<Findings>("GET", `/api/findings?after=${after}`),
};
