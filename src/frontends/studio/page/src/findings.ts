// SPDX-License-Identifier: Apache-2.0
// What is known of the scenario, beside the editor.
import type { Diagnostic, Findings } from "./api";
import { button, element, fill, table, time } from "./dom";
import { textOf } from "./editor";

const stages: Record<string, string> = {
  empty: "",
  checking: "checking ...",
  refused: "not sound",
  running: "simulating ...",
  proving: "bounding ...",
  searching: "searching for the worst ...",
  done: "done",
  sketched: "in part, while it moves",
};

function verdict(found: Findings): void {
  const line = document.getElementById("verdict");
  if (!line) return;
  let text = "";
  let look = "";
  const errors = found.diagnostics?.errors ?? 0;
  if (found.trouble !== "") [text, look] = [found.trouble, "fail"];
  else if (found.stage === "refused") [text, look] = [`${errors} ${errors === 1 ? "mistake" : "mistakes"}`, "fail"];
  else if (found.proofs) {
    const all = found.proofs.requirements;
    const proved = all.filter((each) => each.verdict === "pass").length;
    const words = found.proofs.verdict === "pass" ? "proved" : found.proofs.verdict;
    const end = found.stage === "done" ? `, after ${found.proofs.runs} runs` : " so far";
    [text, look] = [
      `${words}${all.length > 1 ? `: ${proved} of ${all.length} are proved` : ""}${end}${found.proofs.partial ? "; there was no time for more" : ""}`,
      found.proofs.verdict,
    ];
  } else if (found.result)
    [text, look] = [
      `${found.result.verdict} in the run`,
      found.result.verdict === "pass" ? "note" : found.result.verdict,
    ];
  line.textContent = text;
  line.className = `verdict ${look}`;
}

function mistakes(list: Diagnostic[], goTo: (each: Diagnostic) => void): HTMLElement[] {
  return list.map((each) => {
    const made = element(
      "button",
      `${each.line > 0 ? each.line + ":" + each.column + " " : ""}${textOf(each)}`,
      `mistake ${each.severity === "error" ? "fail" : "undecided"}`,
    ) as HTMLButtonElement;
    made.type = "button";
    made.addEventListener("click", () => goTo(each));
    return made;
  });
}

/// Where a row of the streams leads to.
type Choose = (stream: string) => void;

export function show(found: Findings, goTo: (each: Diagnostic) => void, choose: Choose): void {
  const stage = document.getElementById("stage");
  if (stage) stage.textContent = stages[found.stage] ?? found.stage;
  verdict(found);
  fill("mistakes", ...mistakes(found.diagnostics?.diagnostics ?? [], goTo));
  const isRefused = found.stage === "refused";
  document.getElementById("network")?.classList.toggle("is-old", isRefused); // it is that of the last sound text
  const reactions = Object.entries(found.result?.programs ?? {}).flatMap(([name, program]) =>
    program.reactions.map((each) => [
      { text: name },
      { text: each.kind },
      { text: each.initiator },
      { text: each.cause },
      { text: time(each.began_ps), look: "n" },
      { text: time(each.duration_ps), look: "n" },
    ]),
  );
  if (reactions.length > 0)
    fill(
      "reactions",
      element("h2", "Reactions"),
      table(["program", "reaction", "from", "cause", "at", "took"], reactions.slice(0, 200)),
    );
  else fill("reactions");
  const streams = Object.entries(found.result?.streams ?? {})
    .sort(([, a], [, b]) => (b.latency_ps?.max ?? 0) - (a.latency_ps?.max ?? 0))
    .map(([name, each]) => [
      { child: button(name, () => choose(name), "to its lines in the text; its path lights up on the map") },
      { text: String(each.sent), look: "n" },
      { text: String(each.delivered), look: "n" },
      { text: String(each.lost), look: each.lost > 0 ? "n fail" : "n" },
      { text: time(each.latency_ps?.mean), look: "n" },
      { text: time(each.latency_ps?.max), look: "n" },
    ]);
  if (streams.length > 0)
    fill(
      "streams",
      element("h2", "Streams, slowest first"),
      table(["stream", "sent", "delivered", "lost", "mean", "max"], streams.slice(0, 200)),
    );
  else fill("streams");
}
