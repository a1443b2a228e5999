// SPDX-License-Identifier: Apache-2.0
// Which run the timeline shows: the scenario as it is, or the worst that was found for a requirement.
import { engine, type Findings, type Look } from "./api";
import { byId } from "./dom";
import { duration } from "./gates";
import { Timeline } from "./timeline";

export class RunView {
  readonly timeline = new Timeline();
  private between: [string, string][] = []; // whose ports are to be shown, as soon as there is a timeline
  private readonly run = byId("timeline-run") as HTMLSelectElement;
  private readonly from = byId("timeline-from") as HTMLInputElement;
  private revision = 0;
  private isReady = false; // the text is sound
  private isSeen = false;
  private wanted = -1; // the requirement whose worst run is shown, or -1
  private explains = false; // that run is to be explained, too
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

  /// Shows only the ports between those pairs of nodes.
  lookAt(between: [string, string][]): void {
    this.between = between;
    this.showBetween();
  }

  private showBetween(): void {
    if (this.between.length === 0 || !this.timeline.isLoaded()) return;
    const names = this.between.map(([a]) => a);
    this.timeline.showPorts(names, (node, to) =>
      this.between.some(([a, b]) => (node === a && to === b) || (node === b && to === a)),
    );
    this.between = [];
  }

  setSeen(isSeen: boolean): void {
    this.isSeen = isSeen;
    this.refresh();
  }

  /// While the hand moves something the run that it has begun from stays.
  know(found: Findings, isUnderTheHand = false): void {
    if (isUnderTheHand) return;
    this.revision = found.revision;
    this.isReady = found.result !== null;
    this.list(found);
    this.refresh();
  }

  private list(found: Findings | null): void {
    const worst = (found?.proofs?.requirements ?? [])
      .map((each, n): [number, string] | null => (each.adversarial_ps === null ? null : [n, each.text]))
      .filter((each) => each !== null);
    const options = [
      new Option("as it is", "-1"),
      ...worst.map(([n, text]) => new Option(`worst found: ${text}`, String(n))),
    ];
    if (
      options.length === this.run.options.length &&
      options.every((each, n) => this.run.options[n]?.text === each.text)
    )
      return;
    this.run.replaceChildren(...options);
    this.run.value = String(this.wanted);
    // While the search for the worst goes on the choice stays.
    if (this.run.value === "" && found?.stage === "done") this.look(-1);
  }

  private refresh(): void {
    void this.load();
  }

  private async load(): Promise<void> {
    const asked = duration(this.from.value);
    const from = asked !== null && asked >= 0 ? asked : null;
    this.from.setAttribute("aria-invalid", String(from === null));
    const look: Look = { revision: this.revision, requirement: this.wanted, from: from ?? 0 };
    if (!this.isSeen || !this.isReady || from === null || this.isLoading) return;
    const isShown = this.timeline.shows(look);
    if (isShown && !this.explains) return;
    this.isLoading = true;
    try {
      if (!isShown) await this.timeline.load(look);
      this.showBetween();
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
    this.refresh(); // what was asked for meanwhile
  }
}
