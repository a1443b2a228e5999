// SPDX-License-Identifier: Apache-2.0
// What the hand takes hold of in the timeline: which gate list of the text a port follows at an instant, and which of its edges or windows that is.
import type { Edit } from "./edits";
import type { Editor } from "./editor";
import { gateLists, movedEntries, movedOffset, stepOf, talkers, type GateList } from "./gates";

/// Moves by so many ps from where it was taken; once it is let go that is one step of the history.
export interface Grip {
  name: string;
  move: (by: number) => void;
  drop: () => void;
}

const near = 0.02; // of a cycle: clocks of nodes are not those of the text

export class Grips {
  constructor(private editor: Editor) {}

  /// The edge of a gate of that port that was passed at that time.
  edge(node: string, to: string, at: number): Grip | null {
    const list = this.listAt(node, to, at);
    if (!list) return null;
    const phase = this.phase(list, at);
    const distance = (n: number) => {
      const away = Math.abs((list.entries[n]?.begin ?? 0) - phase);
      return Math.min(away, list.cycle - away);
    };
    const best = list.entries.reduce((nearest, _, n) => (distance(n) < distance(nearest) ? n : nearest), 0);
    if (distance(best) > near * list.cycle) return null;
    return this.grip(`edge of ${list.title}`, list.cycle, (text, by) =>
      movedEntries(text, list.path, best, best - 1, by),
    );
  }

  /// The window of that class that is open then.
  window(node: string, to: string, at: number, traffic_class: number): Grip | null {
    const list = this.listAt(node, to, at);
    const phase = list ? this.phase(list, at) : 0;
    const isOpen = (n: number) => list?.entries[n]?.open.includes(traffic_class) ?? false;
    let first = list?.entries.findIndex((each) => each.begin <= phase && phase < each.begin + each.length) ?? -1;
    if (!list || !isOpen(first)) return null;
    let last = first;
    while (isOpen(first - 1)) --first;
    while (isOpen(last + 1)) ++last;
    const [a, b] = [first, last];
    return this.grip(`window of class ${traffic_class}, ${list.title}`, list.cycle, (text, by) =>
      movedEntries(text, list.path, a, b, by),
    );
  }

  offset(stream: string): Grip | null {
    const talker = talkers(this.editor.text()).find((each) => each.name === stream);
    return talker
      ? this.grip(`offset of ${stream}`, talker.every, (text, by) => movedOffset(text, talker.number, by))
      : null;
  }

  private grip(name: string, span: number, moved: (text: string, by: number) => Edit[]): Grip {
    const step = stepOf(span);
    return {
      name,
      move: (by) => this.editor.drag((text) => moved(text, Math.round(by / step) * step)),
      drop: () => this.editor.drop(),
    };
  }

  private phase(list: GateList, at: number): number {
    return (((at - list.base) % list.cycle) + list.cycle) % list.cycle;
  }

  /// The last that a script has set for the node by then; else that of the port, of the node, of a generator.
  private listAt(node: string, to: string, at: number): GateList | null {
    const lists = gateLists(this.editor.text());
    const set = lists.filter((each) => each.path[0] === "script" && each.node === node && (each.from ?? 0) <= at);
    const own = lists.filter(
      (each) => each.path[0] === "network" && each.path.includes("egress") && each.node === node,
    );
    const isTo = (each: GateList) => each.to !== "" && each.to.replace(/:\d+$/, "") === to;
    return (
      set[set.length - 1] ??
      own.find(isTo) ??
      own.find((each) => each.to === "") ??
      lists.find((each) => each.path[1] === "generate" && each.path.includes("egress") && own.length === 0) ??
      null
    );
  }
}
