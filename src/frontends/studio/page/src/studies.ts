// SPDX-License-Identifier: Apache-2.0
// Studies beside the scenario: started, and watched as they fill in.
import { engine } from "./api";
import { button, byId } from "./dom";

const pause = (ms: number) => new Promise((done) => setTimeout(done, ms));

export class StudiesView {
  private asked = 0;
  private readonly file = byId("study-file") as HTMLSelectElement;
  private readonly frame = byId("study-report") as HTMLIFrameElement;

  constructor() {
    byId("study-actions").append(
      button("Start, or go on", () => void this.start()),
      button("Stop", () => void this.stop()),
    );
  }

  private say(text: string): void {
    byId("study-notice").textContent = text;
  }

  /// The list anew.
  async open(): Promise<void> {
    const known = await engine.studies();
    const chosen = this.file.value;
    this.file.replaceChildren(...known.map((name) => new Option(name, name)));
    if (known.includes(chosen)) this.file.value = chosen;
    if (known.length === 0)
      this.say("no study file (with factors and measures) stands beside the scenario or in its folder studies");
  }

  private async start(): Promise<void> {
    const mine = ++this.asked;
    if (this.file.value === "") return;
    try {
      await engine.study(this.file.value);
      let shown = -1;
      let next = 0;
      for (;;) {
        const found = await engine.errand<unknown>("study");
        if (mine !== this.asked) return;
        const [points, of] = [found.points ?? 0, found.of ?? 0];
        const progress = byId("study-progress") as HTMLProgressElement;
        progress.hidden = false;
        progress.max = Math.max(of, 1);
        progress.value = points;
        const state = found.running
          ? ""
          : found.status === 0
            ? "; done"
            : found.problem !== ""
              ? `; ${found.problem.trim()}`
              : "; stopped";
        this.say(`${points} of ${of === 0 ? "?" : of} points${state}`);
        // A page that is loaded anew goes back to its top, so it is not done all the time.
        if (found.report && points !== shown && (Date.now() >= next || !found.running)) {
          this.frame.hidden = false;
          this.frame.srcdoc = found.report;
          shown = points;
          next = Date.now() + 3000;
        }
        if (!found.running) return;
        await pause(500);
      }
    } catch (problem) {
      if (mine === this.asked) this.say((problem as Error).message);
    }
  }

  private async stop(): Promise<void> {
    ++this.asked;
    await engine.endErrand("study");
    this.say("stopped; what is there is kept, and Start goes on with it");
  }
}
