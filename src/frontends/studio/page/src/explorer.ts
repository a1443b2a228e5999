// SPDX-License-Identifier: Apache-2.0
// Every order of messages, calls and faults of the Programs, as takt explore searches them; and a counter-example step by step.
import { engine, type Belief, type Exploration, type FoundRun } from "./api";
import { button, byId, element, field, input, table, type Cell } from "./dom";

const pause = (ms: number) => new Promise((done) => setTimeout(done, ms));
const faults = ["loss", "crash", "restart", "timeout", "duplicate", "reorder", "forge"];

/// "slave 1 as Running, said in step 2; now Halted, since step 3".
function words(belief: Belief): string {
  if (belief.heard === null) return `nothing of ${belief.of}, which is ${belief.now}`;
  const step = (number: number | null) =>
    number === null ? "" : number === 0 ? "before the first step" : `in step ${number}`;
  const since = belief.now_since === 0 ? "since the beginning" : `since step ${belief.now_since}`;
  return `${belief.of}: ${belief.word ?? belief.heard}, said ${step(belief.said_in)}${belief.is_true === false ? `; by now ${belief.now}, ${since}` : ""}`;
}

/// Goes through one found run.
class Stepper {
  readonly root = element("div");
  private at = 0;
  private readonly place = element("span", "", "note");
  private readonly body = element("div");

  constructor(private run: FoundRun) {
    const steps = element("div", "", "steps");
    const go = (to: number) => () => this.go(to < 0 ? this.run.steps.length : to);
    steps.append(
      button("|<", go(0), "the beginning"),
      button("<", () => this.go(this.at - 1), "a step back"),
      button(">", () => this.go(this.at + 1), "a step on"),
      button(">|", go(-1), "the end"),
      this.place,
    );
    this.root.append(element("h2", `${run.property} is violated: ${run.text}`), steps, this.body);
    this.root.tabIndex = 0;
    this.root.addEventListener("keydown", (event) => {
      const to = { ArrowLeft: this.at - 1, ArrowRight: this.at + 1, Home: 0, End: this.run.steps.length }[event.key];
      if (to === undefined) return;
      event.preventDefault();
      this.go(to);
    });
    this.go(0);
  }

  private go(to: number): void {
    this.at = Math.min(Math.max(to, 0), this.run.steps.length);
    const step = this.run.steps[this.at - 1];
    const before = (this.at > 1 ? this.run.steps[this.at - 2] : undefined) ?? this.run;
    const states = step?.states ?? this.run.states;
    const knowledge = step?.knowledge ?? this.run.knowledge;
    this.place.textContent = `step ${this.at} of ${this.run.steps.length}`;
    const rows = this.run.participants.map((name): Cell[] => {
      const known = element("div");
      for (const belief of knowledge.filter((each) => each.who === name))
        known.append(
          element(
            "div",
            words(belief),
            `${belief.is_cause || belief.is_new ? "is-news" : ""} ${belief.is_true === false ? "undecided" : ""}`,
          ),
        );
      const state = states[name] ?? "-";
      const isNew = this.at > 0 && before.states[name] !== state;
      return [{ text: name }, { text: state, look: isNew ? "is-news" : "" }, { child: known }];
    });
    const made = [
      element("p", step ? `${step.step}. ${step.sentence}` : `At the beginning: ${this.run.beginning}`, "is-news"),
      table(["participant", "state", "what it knows of others"], rows),
    ];
    for (const finding of step?.findings ?? []) made.push(element("p", finding, "fail"));
    if (this.at === this.run.steps.length) {
      if (this.run.cycle > 0) made.push(element("p", `the last ${this.run.cycle} steps repeat for ever`, "fail"));
      for (const sentence of this.run.why) made.push(element("p", sentence));
    }
    this.body.replaceChildren(...made);
  }
}

export class ExplorerView {
  private asked = 0;
  private readonly boxes = faults.map((name) => {
    const box = document.createElement("input");
    box.type = "checkbox";
    box.value = name;
    return box;
  });
  private readonly calls = input("", 2);

  constructor(private text: () => string) {
    byId("explore-actions").append(
      button("Explore the Programs", () => void this.explore()),
      button("Stop", () => void this.stop()),
      ...this.boxes.map((box) => field("", box)),
      field("calls", this.calls),
    );
    this.boxes.forEach((box, n) => box.parentElement?.append(faults[n] ?? ""));
  }

  open(): void {
    if (byId("explore-found").childElementCount === 0 && this.asked === 0)
      this.say(
        "every order of messages, calls and faults of a small group, up to 20 million states, in the order of the fewest steps",
      );
  }

  private say(text: string): void {
    byId("explore-notice").textContent = text;
  }

  private async explore(): Promise<void> {
    const mine = ++this.asked;
    const chosen = this.boxes.filter((box) => box.checked).map((box) => box.value);
    const options = `faults=${chosen.join(",")}&calls=${encodeURIComponent(this.calls.value.trim())}`;
    byId("explore-found").replaceChildren();
    this.say("exploring ...");
    try {
      await engine.explore(this.text(), options);
      for (;;) {
        const found = await engine.errand<Exploration | Exploration[]>("explore");
        if (mine !== this.asked) return;
        if (!found.running) {
          this.say(found.output ? "" : found.problem);
          if (found.output) this.show(Array.isArray(found.output) ? found.output : [found.output]);
          return;
        }
        await pause(300);
      }
    } catch (problem) {
      if (mine === this.asked) this.say((problem as Error).message);
    }
  }

  private async stop(): Promise<void> {
    ++this.asked;
    await engine.endErrand("explore");
    this.say("stopped");
  }

  private show(found: Exploration[]): void {
    const made: HTMLElement[] = [];
    for (const each of found) {
      made.push(element("h2", each.program ?? "The group"));
      made.push(
        element(
          "p",
          `${each.variant}, ${each.slaves} ${each.slaves === 1 ? "slave" : "slaves"}: ${each.states.toLocaleString("en")} states; ${each.exhausted ? "the whole space was searched" : "the space was not searched to its end"}`,
          "note",
        ),
      );
      const rows = Object.entries(each.properties).map(([name, verdict]): Cell[] => [
        { text: name },
        { text: verdict, look: verdict === "violated" ? "fail" : verdict === "holds" ? "pass" : "note" },
      ]);
      for (const run of each.violations ?? []) made.push(new Stepper(run).root);
      made.push(table(["property", ""], rows));
    }
    byId("explore-found").replaceChildren(...made);
  }
}
