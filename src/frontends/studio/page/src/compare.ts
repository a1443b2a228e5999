// SPDX-License-Identifier: Apache-2.0
// Two variants side by side: one that was kept, and the text that stands there.
import { engine, type Compared, type Errand, type Proof, type Summary, type Verification } from "./api";
import { button, byId, element, table, time, type Cell } from "./dom";

const pause = (ms: number) => new Promise((done) => setTimeout(done, ms));

/// The mean, with half of its confidence interval where there is one.
function figure(of: Summary, unit: string): string {
  if (of.mean === undefined) return "-";
  const short = (value: number) => Number(value.toPrecision(5));
  return `${short(of.mean)}${of.half_width_95 ? ` ± ${Number(of.half_width_95.toPrecision(2))}` : ""}${unit === "" ? "" : ` ${unit}`}`;
}

/// B is another one than A as far as that can be said: zero is outside the interval of the difference.
const differs = (difference: Summary): boolean =>
  difference.mean !== undefined && Math.abs(difference.mean) > (difference.half_width_95 ?? 0);

export class CompareView {
  private kept: string | null = null;
  private asked = 0;
  private last: { text: string; a: Errand<Verification>; compared: Errand<Compared> } | null = null;

  /// `saved` is what the file holds, `present` what stands in the editor, with its proofs as far as there are any.
  constructor(
    private saved: () => string,
    private present: () => { text: string; proofs: Verification | null },
  ) {
    byId("compare-actions").append(
      button("Keep the text as A", () => this.keep(this.present().text, "A is the text as it stood when it was kept")),
      button("A: the file as it was saved", () => this.keep(null, "A is the file as it was saved last")),
      button("Compare with the text as it is now", () => void this.compare()),
    );
    this.keep(null, "A is the file as it was saved last");
  }

  /// Another text beside the present one.
  beside(text: string, words: string): void {
    this.keep(text, words);
    void this.compare();
  }

  /// Proofs of the present text may come later than what it is compared with.
  know(): void {
    if (this.last && this.last.text === this.present().text) this.show(this.last.a, this.last.compared);
  }

  private keep(text: string | null, words: string): void {
    this.kept = text;
    byId("compare-a").textContent = words;
  }

  private say(text: string): void {
    byId("compare-notice").textContent = text;
  }

  private async compare(): Promise<void> {
    const mine = ++this.asked;
    const a = this.kept ?? this.saved();
    const b = this.present().text;
    byId("compare-found").replaceChildren();
    this.last = null;
    if (a === b) return this.say("A and the text are the same: change the text, or keep another A");
    this.say("comparing: ten pairs of runs with the same seeds, and proofs of A ...");
    try {
      await engine.compare(a, b);
      for (;;) {
        const [proofs, compared] = await Promise.all([
          engine.errand<Verification>("verify"),
          engine.errand<Compared>("compare"),
        ]);
        if (mine !== this.asked) return;
        this.last = { text: b, a: proofs, compared };
        this.show(proofs, compared);
        if (!proofs.running && !compared.running) return this.say("");
        await pause(300);
      }
    } catch (problem) {
      if (mine === this.asked) this.say((problem as Error).message);
    }
  }

  private show(a: Errand<Verification>, compared: Errand<Compared>): void {
    const made: HTMLElement[] = [];
    for (const each of [a, compared])
      if (!each.running && !each.output) made.push(element("pre", each.problem, "fail"));
    const now = this.present().proofs;
    if (a.output && now) {
      const texts = [...new Set([...a.output.requirements, ...now.requirements].map((each) => each.text))];
      const side = (of: Proof | undefined): Cell[] =>
        of
          ? [
              { text: of.verdict, look: of.verdict },
              { text: time(of.adversarial_ps), look: "n" },
              { text: time(of.bound_ps), look: "n" },
            ]
          : [{ text: "not asked", look: "note" }, {}, {}];
      const rows = texts.map((text): Cell[] => [
        { text },
        ...side(a.output?.requirements.find((each) => each.text === text)),
        ...side(now.requirements.find((each) => each.text === text)),
      ]);
      made.push(
        element("h2", "Requirements"),
        table(["requirement", "A", "worst found", "at most", "now", "worst found", "at most"], rows),
      );
    }
    if (compared.output) {
      const found = compared.output;
      const rows = Object.entries(found.measures).map(([name, each]): Cell[] => [
        { text: name },
        { text: figure(each.a, each.unit), look: "n" },
        { text: figure(each.b, each.unit), look: "n" },
        { text: figure(each.difference, each.unit), look: differs(each.difference) ? "n is-news" : "n note" },
      ]);
      made.push(
        element("h2", `Figures, means of ${found.pairs} runs each with 95 % confidence`),
        table(["figure", "A", "now", "difference"], rows),
      );
      if (found.same_digest > 0)
        made.push(element("p", `${found.same_digest} of the pairs are the same run, event for event`));
      for (const trouble of found.troubles) made.push(element("p", trouble, "fail"));
      if (found.divergence) {
        const { seed, at_ps, only_a, only_b } = found.divergence;
        made.push(element("h2", `Where they part: at ${time(at_ps, 12)}, with seed ${seed}`));
        made.push(
          table(
            ["in A only", "now only"],
            Array.from({ length: Math.max(only_a.length, only_b.length) }, (_, n): Cell[] => [
              { text: only_a[n] ?? "" },
              { text: only_b[n] ?? "" },
            ]),
          ),
        );
      }
    }
    byId("compare-found").replaceChildren(...made);
  }
}
