// Which run the timeline shows: the scenario as it is, or the worst that was found for a requirement.
import { engine, type Findings, type Look } from "./api";
import { byId } from "./dom";
import { Timeline } from "./timeline";

const units: Record<string, number> = { s: 1e12, ms: 1e9, us: 1e6, ns: 1e3, ps: 1 };

/// "1.5ms" in ps; null if it is none.
function duration(text: string): number | null {
  const parts = /^\s*(\d+(?:\.\d+)?)\s*(s|ms|us|ns|ps)\s*$/.exec(text);
  return parts ? Math.round(Number(parts[1]) * (units[parts[2] ?? ""] ?? 0)) : null;
}

export class RunView {
  private readonly timeline = new Timeline();
  private readonly run = byId("timeline-run") as HTMLSelectElement;
  private readonly from = byId("timeline-from") as HTMLInputElement;
  private revision = 0;
  private isReady = false;       // the text is sound
  private isSeen = false;
  private wanted = -1;           // the requirement whose worst run is shown, or -1
  private explains = false;      // that run is to be explained, too
  private isLoading = false;

  constructor() {
    this.run.addEventListener("change", () => this.look(Number(this.run.value)));
    this.from.addEventListener("change", () => this.refresh());
    this.list(null);
  }

  look(requirement: number): void {
    this.wanted = requirement;
    this.explains = requirement >= 0;
    this.run.value = String(requirement);
    this.refresh();
  }

  setSeen(isSeen: boolean): void {
    this.isSeen = isSeen;
    this.refresh();
  }

  know(found: Findings): void {
    this.revision = found.revision;
    this.isReady = found.result !== null;
    this.list(found);
    this.refresh();
  }

  private list(found: Findings | null): void {
    const worst = (found?.proofs?.requirements ?? []).map((each, n): [number, string] | null => (each.adversarial_ps === null ? null : [n, each.text])).filter((each) => each !== null);
    const options = [new Option("as it is", "-1"), ...worst.map(([n, text]) => new Option(`worst found: ${text}`, String(n)))];
    if (options.length === this.run.options.length && options.every((each, n) => this.run.options[n]?.text === each.text)) return;
    this.run.replaceChildren(...options);
    this.run.value = String(this.wanted);
    // While the search for the worst goes on the choice stays.
    if (this.run.value === "" && found?.stage === "done") this.look(-1);
  }

  private refresh(): void {
    void this.load();
  }

  private async load(): Promise<void> {
    const from = duration(this.from.value);
    this.from.setAttribute("aria-invalid", String(from === null));
    const look: Look = { revision: this.revision, requirement: this.wanted, from: from ?? 0 };
    if (!this.isSeen || !this.isReady || from === null || this.isLoading) return;
    const isShown = this.timeline.shows(look);
    if (isShown && !this.explains) return;
    this.isLoading = true;
    try {
      if (!isShown) await this.timeline.load(look);
      if (this.explains) {
        this.explains = false;
        this.timeline.showExplained(await engine.explainWorst(look));
      }
    } catch (problem) {
      this.explains = false;
      byId("timeline-notice").textContent = (problem as Error).message;
      this.isLoading = false;
      return;
    }
    this.isLoading = false;
    this.refresh();   // what was asked for meanwhile
  }
}
