// SPDX-License-Identifier: Apache-2.0
// The requirements: what is proved of each, tightest first, with bars of what was simulated, found and proved.
import type { Findings, Proof, RunRequirement } from "./api";
import { button, byId, element, field, input, select, time } from "./dom";

/// Where a requirement leads to.
export interface Leads {
  text: (entry: number) => void; // to its lines
  worst: (number: number) => void; // to its worst run, at that instant
  choose: (subject: string, entry: number) => void; // its stream on the map
}

/// One requirement, from the run alone (a run that holds is no proof) or with what was proved.
interface Line {
  number: number;
  verdict: string;
  words: string;
  text: string;
  remark: string;
  simulated: number | null;
  worst: number | null;
  bound: number | null;
  limit: number | null;
  isOpen: boolean; // nothing is proved yet: worst and bound are to come
  isEarlier: boolean; // worst and bound are those of the text before, while the hand moves
  entry: number | null;
  subject: string;
}

const wordsOf: Record<string, string> = { pass: "proved", fail: "fails in the run" };
const heads: [string, keyof Line][] = [
  ["", "verdict"],
  ["requirement", "text"],
  ["simulated", "simulated"],
  ["worst found", "worst"],
  ["at most", "bound"],
  ["limit", "limit"],
];

/// How near it is to its limit; what fails comes first, what has no limit in time last.
function tightness(line: Line): number {
  if (["refuted", "fail", "contradiction"].includes(line.verdict)) return 1e9;
  const greatest = Math.max(line.simulated ?? 0, line.worst ?? 0, line.bound ?? 0);
  if (line.limit && greatest > 0) return greatest / line.limit;
  return line.verdict === "undecided" ? 1e-3 : 0;
}

function stroke(look: string, style: string): HTMLElement {
  const made = element("i", "", look);
  made.style.cssText = style;
  return made;
}

/// Simulated, worst found and bound as parts of the limit, which stands at 80 %.
function bar(line: Line): HTMLElement {
  const made = element("div", "", line.isEarlier ? "bar is-earlier" : "bar");
  const limit = line.limit;
  if (!limit) return element("span");
  const share = (ps: number) => Math.min(100, (80 * ps) / limit);
  if (line.worst !== null) made.append(stroke("worst", `width: ${share(line.worst)}%`));
  if (line.simulated !== null) made.append(stroke("simulated", `width: ${share(line.simulated)}%`));
  if (line.bound !== null) made.append(stroke("bound", `left: calc(${share(line.bound)}% - 3px)`));
  made.append(stroke("limit", ""));
  return made;
}

/// What counts most of what is known of this text, beside its limit. Bounds of an earlier text do not count.
function ofLimit(line: Line): string {
  const isRun = line.isEarlier || line.verdict === "fail";
  const most = isRun ? line.simulated : (line.bound ?? line.worst ?? line.simulated);
  return line.limit ? `${time(most)} of ${time(line.limit)}` : "";
}

const legend = (): HTMLElement => {
  const made = element("p", "", "legend note");
  for (const [look, words] of [
    ["simulated", "simulated"],
    ["worst", "worst found"],
    ["bound", "at most: proved, no run exceeds it"],
    ["limit", "limit"],
  ] as const) {
    const swatch = element("span", "", "bar");
    swatch.append(stroke(look, look === "worst" || look === "simulated" ? "width: 100%" : "left: 8px"));
    made.append(swatch, `${words} `);
  }
  return made;
};

export class RequirementsView {
  private lines: Line[] = [];
  private proofs: Proof[] = []; // the last, for as long as newer ones are to come
  private readonly filter = input("", 12);
  private readonly order = select([
    ["tightness", "tightest first"],
    ["number", "as in the text"],
    ["text", "by name"],
    ["verdict", "by verdict"],
    ["simulated", "by simulated"],
    ["worst", "by worst found"],
    ["bound", "by at most"],
    ["limit", "by limit"],
  ]);
  private readonly count = element("span", "", "note");
  private readonly place = element("div", "", "figures-place");
  private readonly parts: HTMLElement[];
  private chosen = -1;

  constructor(private leads: Leads) {
    this.filter.id = "requirement-filter";
    this.order.id = "requirement-order";
    this.filter.addEventListener("input", () => this.draw());
    this.order.addEventListener("change", () => this.draw());
    const tools = element("div", "", "tools");
    tools.append(field("with", this.filter), field("order", this.order), this.count);
    this.parts = [element("h2", "Requirements"), tools, legend(), this.place];
  }

  show(found: Findings, isCoarse: boolean): void {
    const places = found.network?.requirements ?? [];
    const all = found.proofs?.requirements ?? [];
    const proofs = all.length > 0 ? all : null; // of a run that was not waited for nothing is proved
    if (proofs) this.proofs = proofs;
    const of = (each: Proof | RunRequirement, number: number) => ({
      number,
      text: each.text,
      limit: each.limit_ps ?? null,
      entry: places[number]?.entry ?? null,
      subject: places[number]?.subject ?? "",
    });
    if (proofs)
      this.lines = proofs.map((each, n) => ({
        ...of(each, n),
        verdict: each.verdict,
        words: wordsOf[each.verdict] ?? each.verdict,
        remark: each.reason ?? each.remark ?? "",
        simulated: each.simulated_ps,
        worst: each.adversarial_ps,
        bound: each.bound_ps,
        isOpen: false,
        isEarlier: false,
      }));
    else
      this.lines = (found.result?.requirements ?? []).map((each, n): Line => {
        const before =
          isCoarse && this.proofs.length === found.result?.requirements.length ? this.proofs[n] : undefined;
        const holds = each.verdict === "pass";
        return {
          ...of(each, n),
          verdict: holds ? "note" : each.verdict,
          words: holds ? "holds in the run" : (wordsOf[each.verdict] ?? each.verdict),
          remark: each.remark ?? "",
          simulated: each.measured_ps ?? null,
          worst: before?.adversarial_ps ?? null,
          bound: before?.bound_ps ?? null,
          isOpen: !before && !found.proofs,
          isEarlier: before !== undefined,
        };
      });
    this.draw();
  }

  /// The lines of that item of "require" are those that are meant.
  mark(entry: number): void {
    if (entry === this.chosen) return;
    this.chosen = entry;
    for (const each of this.place.querySelectorAll<HTMLElement>("tbody"))
      each.classList.toggle("is-chosen", entry >= 0 && each.dataset["entry"] === String(entry));
  }

  private draw(): void {
    if (this.lines.length === 0) byId("requirements").replaceChildren();
    else if (!this.place.isConnected) byId("requirements").replaceChildren(...this.parts);
    const wanted = this.filter.value.trim().toLowerCase();
    const shown = this.lines.filter(
      (each) => wanted === "" || `${each.words} ${each.text}`.toLowerCase().includes(wanted),
    );
    const by = this.order.value;
    if (by === "tightness") shown.sort((a, b) => tightness(b) - tightness(a) || a.number - b.number);
    else if (by !== "number") {
      const key = by as keyof Line;
      shown.sort(
        (a, b) =>
          (typeof a[key] === "string"
            ? String(a[key]).localeCompare(String(b[key]))
            : Number(b[key] ?? -1) - Number(a[key] ?? -1)) || a.number - b.number,
      );
    }
    this.count.textContent =
      shown.length === this.lines.length ? `${shown.length}` : `${shown.length} of ${this.lines.length}`;
    const made = element("table", "", "figures");
    const head = element("tr");
    for (const [name, key] of heads) {
      const cell = element("th", "", ["simulated", "worst", "bound", "limit"].includes(key) ? "n" : "");
      const sorter = button(name === "" ? "verdict" : name, () => this.sort(key), "sort by this");
      sorter.className = "sorter";
      cell.append(sorter);
      cell.setAttribute(
        "aria-sort",
        by === key ? (key === "text" || key === "verdict" ? "ascending" : "descending") : "none",
      );
      head.append(cell);
    }
    const top = element("thead");
    top.append(head);
    made.append(top, ...shown.map((each) => this.row(each)));
    this.drawFew();
    const focused = (document.activeElement as HTMLElement | null)?.dataset["key"];
    this.place.replaceChildren(made);
    if (focused) this.place.querySelector<HTMLElement>(`[data-key="${focused}"]`)?.focus();
  }

  /// The tightest ones beside what the hand takes hold of.
  private drawFew(): void {
    const few = [...this.lines].sort((a, b) => tightness(b) - tightness(a) || a.number - b.number).slice(0, 5);
    const rows = () =>
      few.map((each) => {
        const made = element("div", "", "few");
        made.append(
          element("span", each.words, each.verdict),
          element("span", each.text),
          bar(each),
          element("span", ofLimit(each), "n"),
        );
        return made;
      });
    for (const id of ["gates-bars", "timeline-bars"]) byId(id).replaceChildren(...rows());
  }

  private sort(key: keyof Line): void {
    this.order.value = this.order.value === key ? "tightness" : key;
    this.draw();
  }

  private row(line: Line): HTMLElement {
    const made = element("tbody");
    if (line.entry !== null) made.dataset["entry"] = String(line.entry);
    made.classList.toggle("is-chosen", line.entry !== null && line.entry === this.chosen);
    const first = element("tr");
    const name = element("td");
    const link = element("a", line.text) as HTMLAnchorElement;
    link.dataset["key"] = `text-${line.number}`;
    if (line.entry !== null) {
      const entry = line.entry;
      link.href = "#";
      link.title = "to its lines in the text; its stream lights up on the map";
      link.addEventListener("click", (event) => {
        event.preventDefault();
        this.leads.choose(line.subject, entry);
        this.leads.text(entry);
      });
    }
    name.append(link);
    const figure = (ps: number | null) => element("td", line.isOpen && ps === null ? "..." : time(ps), "n");
    const worst = element("td", "", "n");
    if (line.worst === null) worst.textContent = line.isOpen ? "..." : "-";
    else {
      const look = button(time(line.worst), () => this.leads.worst(line.number), "look at that run, at that instant");
      look.dataset["key"] = `worst-${line.number}`;
      worst.append(look);
    }
    first.append(
      element("td", line.words, line.verdict),
      name,
      figure(line.simulated),
      worst,
      figure(line.bound),
      element("td", time(line.limit), "n"),
    );
    const second = element("tr");
    const wide = element("td");
    wide.setAttribute("colspan", "5");
    wide.append(bar(line));
    if (line.remark !== "") wide.append(element("div", line.remark, "note"));
    if (line.limit || line.remark !== "") second.append(element("td"), wide);
    made.append(first, ...(second.childNodes.length > 0 ? [second] : []));
    return made;
  }
}
