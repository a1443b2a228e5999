// SPDX-License-Identifier: Apache-2.0
// Why a frame or a reaction took so long, as tables.
import type { ExplainedFrame, Explanation, Part } from "./api";
import { element, table, time, type Cell } from "./dom";

export function amountOf(part: Part): string {
  if (part.stream) return `${part.stream} frame ${part.sequence ?? "?"}`;
  if (part.gate_entry !== undefined && part.gate_entry !== null) return `entry ${part.gate_entry} of the gate list`;
  if (part.missing_bits !== undefined && part.missing_bits !== null) return `${part.missing_bits} bits were missing`;
  return "";
}

function frameTable(frame: ExplainedFrame): HTMLElement {
  const rows: Cell[][] = [];
  for (const hop of frame.hops) {
    const where =
      hop.port === undefined || hop.port === null ? hop.node : `${hop.node}:${hop.port} to ${hop.to ?? "nothing"}`;
    hop.parts.forEach((part, n) =>
      rows.push([
        { text: n === 0 ? where : "" },
        { text: part.words, note: amountOf(part) },
        { text: time(part.takes_ps), look: "n" },
        { text: frame.takes_ps > 0 ? `${((100 * part.takes_ps) / frame.takes_ps).toFixed(1)} %` : "", look: "n" },
      ]),
    );
  }
  return table(["where", "what", "takes", "share"], rows);
}

export function explanation(found: Explanation): HTMLElement[] {
  const made: HTMLElement[] = [element("h2", found.question)];
  if (found.reaction) {
    const reaction = found.reaction;
    made.push(
      element(
        "p",
        `${reaction.kind} of ${reaction.program} after ${reaction.cause}: ${time(reaction.takes_ps)} from ${time(reaction.began_ps)} on`,
      ),
    );
    made.push(
      table(
        ["what", "who", "at", "takes"],
        reaction.steps.map((step) => [
          { text: step.what },
          { text: step.who },
          { text: time(step.at_ps), look: "n" },
          { text: time(step.takes_ps), look: "n" },
        ]),
      ),
    );
  }
  for (const frame of found.frames) {
    const reason = frame.reason ? ` (${frame.reason})` : "";
    made.push(
      element(
        "p",
        `${frame.end} at ${frame.node}${reason}, ${time(frame.takes_ps)} after it was produced at ${time(frame.produced_ps)}`,
      ),
      frameTable(frame),
    );
  }
  if (!found.reaction && found.frames.length === 0) made.push(element("p", "there is no such frame", "note"));
  return made;
}
