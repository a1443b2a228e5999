// SPDX-License-Identifier: Apache-2.0
// The views beside the text, one at a time; arrows go from tab to tab.
import { byId } from "./dom";

export type View = "findings" | "timeline" | "gates" | "explorer" | "compare" | "studies";

export class Tabs {
  private readonly tabs = [...byId("tabs").querySelectorAll<HTMLButtonElement>("[role=tab]")];
  present: View = "findings";

  constructor(private opened: (view: View) => void) {
    for (const tab of this.tabs) {
      tab.addEventListener("click", () => this.open(tab.dataset["view"] as View));
      tab.addEventListener("keydown", (event) => {
        const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
        if (!step) return;
        const next = this.tabs[(this.tabs.indexOf(tab) + step + this.tabs.length) % this.tabs.length];
        next?.focus();
        if (next) this.open(next.dataset["view"] as View);
      });
    }
    this.open("findings");
  }

  open(view: View): void {
    this.present = view;
    for (const tab of this.tabs) {
      const isChosen = tab.dataset["view"] === view;
      tab.setAttribute("aria-selected", String(isChosen));
      tab.tabIndex = isChosen ? 0 : -1;
      byId(tab.dataset["view"] as string).hidden = !isChosen;
    }
    this.opened(view);
  }
}
