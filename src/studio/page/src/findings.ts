// What is known of the scenario, beside the editor.
import type { Diagnostic, Findings, Proof, RunRequirement } from "./api";
import { button, element, fill, table, time, type Cell } from "./dom";
import { textOf } from "./editor";

const stages: Record<string, string> = {
  empty: "",
  checking: "checking ...",
  refused: "not sound",
  running: "simulating ...",
  proving: "bounding ...",
  searching: "searching for the worst ...",
  done: "done",
};

/// Shows the worst run of requirement `number`.
type Look = (number: number) => void;

/// Simulated, worst found and bound as parts of the limit, which stands at 80 %.
function bar(parts: { simulated?: number | null; worst?: number | null; bound?: number | null }, limit: number | null | undefined): HTMLElement {
  const made = element("div", "", "bar");
  if (!limit) return element("span");
  const share = (ps: number) => Math.min(100, (80 * ps) / limit);
  const stroke = (look: string, style: string) => {
    const each = element("i", "", look);
    each.style.cssText = style;
    made.append(each);
  };
  if (parts.worst != null) stroke("worst", `width: ${share(parts.worst)}%`);
  if (parts.simulated != null) stroke("simulated", `width: ${share(parts.simulated)}%`);
  if (parts.bound != null) stroke("bound", `left: ${share(parts.bound)}%`);
  stroke("limit", "");
  return made;
}

function provedRow(each: Proof, number: number, look: Look): Cell[] {
  const worst = each.adversarial_ps === null ? { text: "-", look: "n" } : { child: button(time(each.adversarial_ps), () => look(number), "look at that run, at that instant"), look: "n" };
  return [
    { text: each.verdict, look: each.verdict },
    { text: each.text, note: each.reason ?? each.remark ?? "" },
    { child: bar({ simulated: each.simulated_ps, worst: each.adversarial_ps, bound: each.bound_ps }, each.limit_ps) },
    { text: time(each.simulated_ps), look: "n" },
    worst,
    { text: time(each.bound_ps), look: "n" },
    { text: time(each.limit_ps), look: "n" },
  ];
}

/// Before anything is proved: a run that holds is no proof.
function runRow(each: RunRequirement): Cell[] {
  const verdict = each.verdict === "pass" ? "holds in the run" : each.verdict;
  return [
    { text: verdict, look: each.verdict === "pass" ? "note" : each.verdict },
    { text: each.text, note: each.remark ?? "" },
    { child: bar({ simulated: each.measured_ps ?? null }, each.limit_ps) },
    { text: time(each.measured_ps), look: "n" },
    { text: "...", look: "n note" },
    { text: "...", look: "n note" },
    { text: time(each.limit_ps), look: "n" },
  ];
}

function verdict(found: Findings): void {
  const line = document.getElementById("verdict");
  if (!line) return;
  let text = "";
  let look = "";
  const errors = found.diagnostics?.errors ?? 0;
  if (found.trouble !== "") [text, look] = [found.trouble, "fail"];
  else if (found.stage === "refused") [text, look] = [`${errors} ${errors === 1 ? "mistake" : "mistakes"}`, "fail"];
  else if (found.proofs) [text, look] = [`${found.proofs.verdict}${found.stage === "done" ? ", after " + found.proofs.runs + " runs" : " so far"}`, found.proofs.verdict];
  else if (found.result) [text, look] = [`${found.result.verdict} in the run`, found.result.verdict === "pass" ? "note" : found.result.verdict];
  line.textContent = text;
  line.className = `verdict ${look}`;
}

function mistakes(list: Diagnostic[], goTo: (each: Diagnostic) => void): HTMLElement[] {
  return list.map((each) => {
    const made = element("button", `${each.line > 0 ? each.line + ":" + each.column + " " : ""}${textOf(each)}`, `mistake ${each.severity === "error" ? "fail" : "undecided"}`) as HTMLButtonElement;
    made.type = "button";
    made.addEventListener("click", () => goTo(each));
    return made;
  });
}

export function show(found: Findings, goTo: (each: Diagnostic) => void, look: Look): void {
  const stage = document.getElementById("stage");
  if (stage) stage.textContent = stages[found.stage] ?? found.stage;
  verdict(found);
  fill("mistakes", ...mistakes(found.diagnostics?.diagnostics ?? [], goTo));
  const isRefused = found.stage === "refused";
  document.getElementById("network")?.classList.toggle("is-old", isRefused);   // it is that of the last sound text
  const heads = ["", "requirement", "of the limit", "simulated", "worst found", "at most", "limit"];
  const rows = found.proofs ? found.proofs.requirements.map((each, number) => provedRow(each, number, look)) : (found.result?.requirements ?? []).map(runRow);
  if (rows.length > 0) fill("requirements", element("h2", "Requirements"), table(heads, rows));
  else fill("requirements");
  const reactions = Object.entries(found.result?.programs ?? {}).flatMap(([name, program]) =>
    program.reactions.map((each) => [{ text: name }, { text: each.kind }, { text: each.initiator }, { text: each.cause }, { text: time(each.began_ps), look: "n" }, { text: time(each.duration_ps), look: "n" }]),
  );
  if (reactions.length > 0) fill("reactions", element("h2", "Reactions"), table(["program", "reaction", "from", "cause", "at", "took"], reactions.slice(0, 200)));
  else fill("reactions");
  const streams = Object.entries(found.result?.streams ?? {})
    .sort(([, a], [, b]) => (b.latency_ps?.max ?? 0) - (a.latency_ps?.max ?? 0))
    .map(([name, each]) => [
      { text: name },
      { text: String(each.sent), look: "n" },
      { text: String(each.delivered), look: "n" },
      { text: String(each.lost), look: each.lost > 0 ? "n fail" : "n" },
      { text: time(each.latency_ps?.mean), look: "n" },
      { text: time(each.latency_ps?.max), look: "n" },
    ]);
  if (streams.length > 0) fill("streams", element("h2", "Streams, slowest first"), table(["stream", "sent", "delivered", "lost", "mean", "max"], streams.slice(0, 200)));
  else fill("streams");
}
