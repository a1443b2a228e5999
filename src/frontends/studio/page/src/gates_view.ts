// SPDX-License-Identifier: Apache-2.0
// Gates and offsets of the text as charts that the hand takes hold of: an edge, a window, the offset of a stream.
import { byId, element, time } from "./dom";
import type { Edit } from "./edits";
import type { Editor } from "./editor";
import { gateLists, movedEntries, movedOffset, stepOf, talkers, type GateList, type Talker } from "./gates";
import { svg } from "./network";

const classes = 8;
const lane = 9; // pixels
const width = 600; // units of the drawing, whatever it is wide
const height = classes * lane;
const mostCharts = 60;

/// What a hand holds: by how many ps it moved makes the edits.
type Moved = (text: string, by: number) => Edit[];

export class GatesView {
  private isSeen = false;
  private drawn = "";

  constructor(private editor: Editor) {}

  setSeen(isSeen: boolean): void {
    this.isSeen = isSeen;
    this.know();
  }

  /// The text may be another one.
  know(): void {
    const text = this.editor.text();
    if (!this.isSeen || text === this.drawn) return;
    this.drawn = text;
    const lists = gateLists(text);
    const streams = talkers(text);
    const focused = (document.activeElement as HTMLElement | null)?.dataset["grip"];
    byId("gates-charts").replaceChildren(
      ...lists.slice(0, mostCharts).map((each) => this.chart(each)),
      ...(streams.length > 0 ? [this.offsets(streams, lists)] : []),
    );
    if (focused) document.querySelector<SVGElement>(`[data-grip="${focused}"]`)?.focus();
    byId("gates-notice").textContent =
      lists.length === 0
        ? "No gate list stands in the text: what takt lays itself is not moved by hand."
        : "Drag an edge or a window, or move it by arrow keys: the text changes, and what is known of it. One step back (Ctrl+Z in the text) takes back one drag.";
  }

  private chart(list: GateList): HTMLElement {
    const made = element("section", "", "gates");
    made.append(element("h2", `${list.title}, cycle ${time(list.cycle)}`));
    const drawing = svg("svg", {
      viewBox: `0 0 ${width} ${height}`,
      preserveAspectRatio: "none",
      role: "group",
      "aria-label": `Gates of ${list.title}: class 7 above, class 0 below`,
    });
    const x = (at: number) => (width * at) / list.cycle;
    for (let q = 0; q < classes; ++q) {
      const y = (classes - 1 - q) * lane;
      for (let first = 0; first < list.entries.length;) {
        const isOpen = (n: number) => list.entries[n]?.open.includes(q) ?? false;
        let last = first;
        while (isOpen(first) && isOpen(last + 1)) ++last;
        const [from, until] = [list.entries[first], list.entries[last]];
        if (isOpen(first) && from && until) {
          const end = until.begin + until.length;
          const window = svg("rect", {
            class: "window",
            x: x(from.begin),
            y: y + 0.5,
            width: x(end - from.begin),
            height: lane - 1,
          });
          window.append(
            svg(
              "title",
              {},
              `class ${q} is open from ${time(from.begin)} to ${time(end)}, for ${time(end - from.begin)}`,
            ),
          );
          const [a, b] = [first, last];
          this.hold(
            window,
            `${list.path.join("/")}:${q}:${first}`,
            list.cycle,
            `window of class ${q}, from ${time(from.begin)} to ${time(end)}`,
            (text, by) => movedEntries(text, list.path, a, b, by),
            q === Math.max(...from.open),
          );
          drawing.append(window);
        }
        first = last + 1;
      }
    }
    list.entries.forEach((entry, n) => {
      const edge = svg(
        "g",
        { class: "edge" },
        svg("rect", { class: "wide", x: x(entry.begin) - 4, y: 0, width: 8, height }),
        svg("line", { x1: x(entry.begin), x2: x(entry.begin), y1: 0, y2: height }),
      );
      edge.append(
        svg("title", {}, n === 0 ? "the beginning of the list: its base time" : `edge at ${time(entry.begin)}`),
      );
      this.hold(
        edge,
        `${list.path.join("/")}:edge${n}`,
        list.cycle,
        n === 0 ? "beginning of the list" : `edge at ${time(entry.begin)}`,
        (text, by) => movedEntries(text, list.path, n, n - 1, by),
        true,
      );
      drawing.append(edge);
    });
    made.append(drawing);
    return made;
  }

  private offsets(streams: Talker[], lists: GateList[]): HTMLElement {
    const shown = streams.slice(0, mostCharts);
    const span = Math.max(
      ...lists.map((each) => each.cycle),
      ...(lists.length > 0 ? [] : shown.map((each) => each.every)),
    );
    const row = 18;
    const made = element("section", "", "gates");
    made.append(element("h2", `Offsets of streams, ${time(span)}`));
    for (const each of shown) {
      const line = element("div", "", "offset");
      line.append(element("span", each.name));
      const drawing = svg("svg", {
        viewBox: `0 0 ${width} ${row}`,
        preserveAspectRatio: "none",
        role: "group",
        "aria-label": `Offset of ${each.name}`,
      });
      for (let at = each.offset, n = 0; at <= span && n < 400; at += each.every, ++n) {
        const mark = svg("rect", {
          class: n === 0 ? "talk is-first" : "talk",
          x: (width * at) / span - (n === 0 ? 4 : 1),
          y: 2,
          width: n === 0 ? 8 : 2,
          height: row - 4,
        });
        if (n === 0) {
          mark.append(svg("title", {}, `${each.name}: offset ${time(each.offset)}, every ${time(each.every)}`));
          this.hold(
            mark,
            `offset${each.number}`,
            span,
            `offset of ${each.name}, ${time(each.offset)}`,
            (text, by) => movedOffset(text, each.number, by),
            true,
          );
        }
        drawing.append(mark);
      }
      line.append(drawing);
      made.append(line);
    }
    return made;
  }

  /// Lets the hand take hold of a shape on a drawing as wide as `span`; arrow keys move it by a hundredth, with Shift by a thousandth.
  private hold(shape: SVGElement, grip: string, span: number, name: string, moved: Moved, isTabbed: boolean): void {
    const step = stepOf(span);
    shape.dataset["grip"] = grip;
    shape.setAttribute("role", "slider");
    shape.setAttribute("aria-label", name);
    shape.setAttribute("aria-valuetext", name);
    shape.setAttribute("tabindex", isTabbed ? "0" : "-1");
    shape.addEventListener("pointerdown", (down) => {
      const drawing = shape.closest("svg");
      if (down.button !== 0 || !drawing) return;
      down.preventDefault();
      shape.focus();
      const pixels = drawing.getBoundingClientRect().width;
      const move = (event: PointerEvent) => {
        const by = Math.round(((event.clientX - down.clientX) * span) / pixels / step) * step;
        this.editor.drag((text) => moved(text, by));
        this.know();
      };
      // The shape is drawn anew while it moves, so the window listens.
      const up = () => {
        window.removeEventListener("pointermove", move);
        this.editor.drop();
        this.know();
      };
      window.addEventListener("pointermove", move);
      window.addEventListener("pointerup", up, { once: true });
      window.addEventListener("pointercancel", up, { once: true });
    });
    shape.addEventListener("keydown", (event) => {
      const direction = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (!direction) return;
      event.preventDefault();
      this.editor.drag((text) => moved(text, direction * (event.shiftKey ? step : 10 * step)));
      this.editor.drop();
      this.know();
    });
  }
}
