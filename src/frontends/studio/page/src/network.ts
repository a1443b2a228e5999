// SPDX-License-Identifier: Apache-2.0
// The network: drawn, dragged about (that is kept in a file beside the scenario), and edited by hand.
import { engine, type Layout, type Plant, type PlantNode } from "./api";
import { button, byId, element, field, input, select } from "./dom";
import { added, place, withoutNode, type Edit } from "./edits";
import type { Editor } from "./editor";

const unit = 120; // pixels between neighbouring switches
const margin = 60;
const mostNames = 150;
const space = "http://www.w3.org/2000/svg";

export function svg(
  name: string,
  attributes: Record<string, string | number>,
  ...children: (SVGElement | string)[]
): SVGElement {
  const made = document.createElementNS(space, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  made.append(...children);
  return made;
}

const titled = (text: string): SVGElement => svg("title", {}, text);

export class NetworkView {
  private plant: Plant | null = null;
  private layout: Layout = {};
  private shapes = new Map<string, SVGElement>();
  private lines: { line: SVGElement; cross: SVGElement | null; a: number; b: number }[] = [];
  private drawing: SVGElement | null = null;
  private kept = 0;
  private isDragged = false;

  /// What is lit: the path of a stream, a node, a link.
  private lit: { stream: string; nodes: string[] } = { stream: "", nodes: [] };

  /// `look` shows the two ports of a link in the timeline.
  constructor(
    private editor: Editor,
    private look: (a: string, b: string) => void,
  ) {
    void engine.layout().then((layout) => {
      this.layout = layout;
      if (this.plant) this.draw();
    });
    this.addForms();
  }

  show(plant: Plant): void {
    if (JSON.stringify(plant) === JSON.stringify(this.plant)) return;
    this.plant = plant;
    this.draw();
  }

  /// The names of all nodes, also of those that a generator makes.
  nodes(): string[] {
    return this.plant?.nodes.map((each) => each.name) ?? [];
  }

  /// The path of a stream, or single nodes, or nothing.
  light(stream: string, nodes: string[] = []): void {
    if (stream === this.lit.stream && nodes.join() === this.lit.nodes.join()) return;
    this.lit = { stream, nodes };
    this.showLit();
  }

  /// The nodes on the path of a stream, each once.
  pathOf(stream: string): string[] {
    const names = (this.plant?.paths[stream] ?? []).flat().map((n) => this.plant?.nodes[n]?.name ?? "");
    return [...new Set(names)];
  }

  private showLit(): void {
    const plant = this.plant;
    if (!plant) return;
    const paths = plant.paths[this.lit.stream] ?? [];
    const hops = new Set(
      paths.flatMap((path) => path.slice(1).flatMap((to, n) => [`${path[n]}-${to}`, `${to}-${path[n]}`])),
    );
    for (const { line, a, b } of this.lines) line.classList.toggle("is-lit", hops.has(`${a}-${b}`));
    const on = new Set([...paths.flat().map((n) => plant.nodes[n]?.name ?? ""), ...this.lit.nodes]);
    for (const [name, shape] of this.shapes) shape.classList.toggle("is-lit", on.has(name));
    const words = paths.map((path) => path.map((n) => plant.nodes[n]?.name ?? "").join(" to "));
    byId("network-path").textContent =
      words.length > 0
        ? `${this.lit.stream}: ${words.slice(0, 3).join("; ")}${words.length > 3 ? ` and ${words.length - 3} more` : ""}`
        : "";
  }

  private at(node: PlantNode): [number, number] {
    const [x, y] = this.layout.nodes?.[node.name] ?? [node.x, node.y];
    return [x * unit, y * unit];
  }

  private draw(): void {
    const plant = this.plant;
    if (!plant) return;
    const focused = document.activeElement?.getAttribute("data-node");
    const points = plant.nodes.map((node) => this.at(node));
    const xs = points.map(([x]) => x);
    const ys = points.map(([, y]) => y);
    const box = [
      Math.min(...xs, 0) - margin,
      Math.min(...ys, 0) - margin,
      Math.max(...xs, 0) + margin,
      Math.max(...ys, 0) + margin,
    ] as const;
    const [width, height] = [box[2] - box[0], box[3] - box[1]];
    const size = Math.min(Math.max(Math.max(width, height) / 90, 8), 60);
    const drawing = svg("svg", {
      viewBox: `${box[0]} ${box[1]} ${width} ${height}`,
      width: Math.min(width, 2000),
      role: "group",
      "aria-label": "The network; Tab goes from node to node, arrow keys move one",
    });
    this.lines = plant.links.map((link) => {
      const ends = [plant.nodes[link.a]?.name ?? "", plant.nodes[link.b]?.name ?? ""] as const;
      const line = svg(
        "g",
        {
          class: "link",
          role: "button",
          tabindex: 0,
          "data-link": ends.join(" "),
          "aria-label": `link from ${ends[0]} to ${ends[1]}; Enter shows it in the timeline`,
        },
        titled(`${link.title}; a click shows it in the timeline`),
      );
      line.append(
        svg("line", { class: "wide", "stroke-width": Math.max(size, 12) }),
        svg("line", { class: "thin", stroke: link.colour, "stroke-width": size / 3 }),
      );
      line.addEventListener("click", () => this.look(...ends));
      line.addEventListener("keydown", (event) => {
        if (event.key !== "Enter") return;
        event.preventDefault();
        this.look(...ends);
      });
      const cross = link.failed ? svg("path", { class: "failed" }) : null;
      drawing.append(line);
      if (cross) drawing.append(cross);
      return { line, cross, a: link.a, b: link.b };
    });
    this.shapes.clear();
    for (const node of plant.nodes) {
      const shape = svg("g", {
        class: "node",
        tabindex: 0,
        "data-node": node.name,
        role: "img",
        "aria-label": node.title,
      });
      const colour = node.failed ? "#c0392b" : node.kind === "host" ? "#009e73" : "#0072b2";
      if (node.kind === "host")
        shape.append(svg("circle", { class: "mark", r: size * 0.8, fill: colour }, titled(node.title)));
      else
        shape.append(
          svg(
            "rect",
            { class: "mark", x: -size, y: -size, width: 2 * size, height: 2 * size, fill: colour },
            titled(node.title),
          ),
        );
      if (node.kind === "station") shape.append(svg("circle", { r: size * 0.55, fill: "#009e73" }));
      if (plant.nodes.length <= mostNames)
        shape.append(
          svg("text", { y: -size - 4, "text-anchor": "middle", "font-size": Math.max(size * 1.2, 11) }, node.name),
        );
      this.listenTo(shape, node);
      this.shapes.set(node.name, shape);
      drawing.append(shape);
    }
    this.drawing = drawing;
    plant.nodes.forEach((_, n) => this.put(n));
    const legend = element("p", "load of links: ", "note");
    for (const each of plant.legend) {
      const swatch = element("i", "", "swatch");
      swatch.style.background = each.colour;
      legend.append(swatch, `${each.text}  `);
    }
    if (plant.hidden > 0) legend.append(`${plant.hidden} hosts that hang on one switch are not drawn. `);
    if (this.layout.nodes) legend.append(button("as it was laid out", () => void this.forget()));
    const path = element("p", "", "note");
    path.id = "network-path";
    byId("network").replaceChildren(drawing, path, legend);
    this.showLit();
    if (focused) (this.shapes.get(focused) as unknown as HTMLElement | undefined)?.focus();
    this.names.replaceChildren(...plant.nodes.map((node) => new Option("", node.name)));
  }

  /// Puts a node where it stands now, with the links that end there.
  private put(n: number): void {
    const plant = this.plant;
    const node = plant?.nodes[n];
    if (!plant || !node) return;
    const [x, y] = this.at(node);
    this.shapes.get(node.name)?.setAttribute("transform", `translate(${x} ${y})`);
    for (const { line, cross, a, b } of this.lines) {
      if (a !== n && b !== n) continue;
      const [from, to] = [plant.nodes[a], plant.nodes[b]];
      if (!from || !to) continue;
      const [[x1, y1], [x2, y2]] = [this.at(from), this.at(to)];
      for (const [key, value] of [
        ["x1", x1],
        ["y1", y1],
        ["x2", x2],
        ["y2", y2],
      ] as const)
        for (const each of line.querySelectorAll("line")) each.setAttribute(key, String(value));
      const [mx, my] = [(x1 + x2) / 2, (y1 + y2) / 2];
      cross?.setAttribute("d", `M${mx - 7} ${my - 7}l14 14m0-14l-14 14`);
    }
  }

  private move(node: PlantNode, x: number, y: number): void {
    const round = (value: number) => Math.round(value * 1000) / 1000;
    this.layout.nodes = { ...this.layout.nodes, [node.name]: [round(x / unit), round(y / unit)] };
    this.put(this.plant?.nodes.indexOf(node) ?? -1);
    clearTimeout(this.kept);
    this.kept = window.setTimeout(() => {
      if (!this.isDragged) this.draw(); // the picture may have grown
      void this.keep();
    }, 300);
  }

  private async keep(): Promise<void> {
    try {
      const answer = await engine.keepLayout(this.layout.nodes ? JSON.stringify(this.layout, null, 1) + "\n" : "");
      if (answer.problem !== "") byId("notice").textContent = `the layout cannot be kept: ${answer.problem}`;
    } catch {
      byId("notice").textContent = "the layout is not kept: the engine does not answer";
    }
  }

  private async forget(): Promise<void> {
    this.layout = {};
    await this.keep();
    this.draw();
  }

  private listenTo(shape: SVGElement, node: PlantNode): void {
    shape.addEventListener("pointerdown", (down) => {
      const matrix = (this.drawing as SVGSVGElement).getScreenCTM()?.inverse();
      if (!matrix || down.button !== 0) return;
      const toDrawing = (event: PointerEvent) => new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix);
      const [x, y] = this.at(node);
      const begin = toDrawing(down);
      shape.setPointerCapture(down.pointerId);
      const moved = (event: PointerEvent) => {
        const now = toDrawing(event);
        if (Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) > 3) this.isDragged = true;
        if (this.isDragged) this.move(node, x + now.x - begin.x, y + now.y - begin.y);
      };
      const up = () => {
        shape.removeEventListener("pointermove", moved);
        if (this.isDragged) this.draw();
        this.isDragged = false;
      };
      shape.addEventListener("pointermove", moved);
      shape.addEventListener("pointerup", up, { once: true });
      shape.addEventListener("pointercancel", up, { once: true });
    });
    shape.addEventListener("focus", () => (this.chosen.value = node.name));
    shape.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [-10, 0], ArrowRight: [10, 0], ArrowUp: [0, -10], ArrowDown: [0, 10] }[event.key];
      const [x, y] = this.at(node);
      if (step) this.move(node, x + (step[0] ?? 0), y + (step[1] ?? 0));
      else if (event.key === "Enter") this.goTo(node.name);
      else if (event.key === "Delete") this.remove(node.name);
      else return;
      event.preventDefault();
    });
    shape.addEventListener("dblclick", () => this.goTo(node.name));
  }

  private names = document.createElement("datalist");
  private chosen = input("", 12, "node-names");

  private tell(text: string): void {
    byId("edit-notice").textContent = text;
  }

  private change(edits: Edit[] | null, what: string): void {
    if (!edits) return this.tell(`${what}: the text has no place for it`);
    this.editor.change(edits);
    this.tell(what);
  }

  private goTo(name: string): void {
    if (!this.editor.goToPath(["network", "nodes", name]))
      this.tell(`${name} does not stand in the text: something else makes it`);
  }

  private remove(name: string): void {
    const found = withoutNode(this.editor.text(), name);
    if (!found) return this.tell(`${name} does not stand in the text: something else makes it`);
    this.editor.change([found.edit]);
    this.tell(
      `${name} is gone${found.links > 0 ? `, with ${found.links} ${found.links === 1 ? "link" : "links"}` : ""}; Ctrl+Z in the text brings it back`,
    );
  }

  private addForms(): void {
    this.names.id = "node-names";
    const form = (name: string, fields: [string, HTMLElement][], act: () => void): HTMLElement => {
      const made = document.createElement("form");
      made.setAttribute("aria-label", name);
      made.append(...fields.map(([label, each]) => field(label, each)));
      const submit = element("button", name) as HTMLButtonElement;
      made.append(submit);
      made.addEventListener("submit", (event) => {
        event.preventDefault();
        act();
      });
      return made;
    };
    const text = () => this.editor.text();
    const isNew = (path: (string | number)[], what: string): boolean => {
      if (!place(text(), path)) return true;
      this.tell(`${what} is there already`);
      return false;
    };
    const node = input("", 12);
    const kind = select([
      ["host", "host"],
      ["switch", "switch"],
      ["station", "station"],
    ]);
    const [a, b] = [input("", 12, "node-names"), input("", 12, "node-names")];
    const [rate, length] = [input("1Gbps", 8), input("10m", 6)];
    const stream = input("", 12);
    const [from, to] = [input("", 12, "node-names"), input("", 12, "node-names")];
    const [payload, every] = [input("100B", 6), input("1ms", 6)];
    const quoted = JSON.stringify;
    byId("edits").append(
      this.names,
      form(
        "Add node",
        [
          ["name", node],
          ["", kind],
        ],
        () => {
          if (node.value.trim() === "") return this.tell("a node wants a name");
          if (isNew(["network", "nodes", node.value], node.value))
            this.change(
              added(text(), ["network", "nodes"], node.value, `{"kind": ${quoted(kind.value)}}`),
              `${node.value} is added`,
            );
        },
      ),
      form(
        "Add link",
        [
          ["from", a],
          ["to", b],
          ["rate", rate],
          ["length", length],
        ],
        () =>
          this.change(
            added(
              text(),
              ["network", "links"],
              null,
              `{"ends": [${quoted(a.value)}, ${quoted(b.value)}], "rate": ${quoted(rate.value)}, "length": ${quoted(length.value)}}`,
            ),
            `a link from ${a.value} to ${b.value} is added`,
          ),
      ),
      form(
        "Add stream",
        [
          ["name", stream],
          ["from", from],
          ["to", to],
          ["payload", payload],
          ["every", every],
        ],
        () => {
          if (stream.value.trim() === "") return this.tell("a stream wants a name");
          this.change(
            added(
              text(),
              ["streams"],
              null,
              `{"name": ${quoted(stream.value)}, "from": ${quoted(from.value)}, "to": ${quoted(to.value)}, "payload": ${quoted(payload.value)}, "every": ${quoted(every.value)}}`,
            ),
            `stream ${stream.value} is added`,
          );
        },
      ),
      form("Remove", [["node", this.chosen]], () => this.remove(this.chosen.value)),
    );
  }
}
