// SPDX-License-Identifier: Apache-2.0
// The timeline: which run and which stretch it shows, what the hand does there, and why a frame took so long.
import { engine, type ExplainedFrame, type Explanation, type Look } from "./api";
import { byId, element, time } from "./dom";
import { explanation } from "./explanation";
import type { Grip, Grips } from "./grips";
import { Pieces, classOf, flag, type PieceRow } from "./pieces";
import {
  TimelineDrawing,
  axisHeight,
  classes,
  gatedHeight,
  gutter,
  leastSpan,
  plainHeight,
  rgb,
  type Sent,
} from "./timeline_drawing";

export class Timeline extends TimelineDrawing {
  private look: Look = { revision: 0, requirement: -1, from: 0 };
  private asked = 0;
  private isToStep: 1 | -1 | 0 = 0; // as soon as there are pieces
  grips: Grips | null = null;
  chose: (stream: string) => void = () => undefined; // a frame of that stream was chosen

  constructor() {
    super();
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.resize());
    (byId("timeline-filter") as HTMLInputElement).addEventListener("input", () => this.arrange());
    this.listen();
  }

  /// Whether it shows that run.
  shows(look: Look): boolean {
    return (
      this.summary !== null &&
      look.revision === this.look.revision &&
      look.requirement === this.look.requirement &&
      look.from === this.look.from
    );
  }

  async load(look: Look): Promise<void> {
    this.say("recording the run ...");
    const summary = await engine.timeline(look);
    const keepsView =
      this.summary !== null &&
      this.look.requirement === look.requirement &&
      this.look.from === look.from &&
      this.span() === summary.to_ps - summary.from_ps;
    this.look = look;
    this.summary = summary;
    this.colours = summary.streams.map((_, n) => `rgb(${rgb(n).join(" ")})`);
    this.pieces = new Pieces(look, Math.max(this.span(), 1), rgb, () => this.came());
    this.lit = [];
    this.chosen = null;
    byId("timeline-why").replaceChildren();
    this.arrange();
    if (!keepsView) this.showAll();
    const end = summary.whole ? "" : `; there is no room for more: what is later, from a later beginning`;
    this.say(
      `${summary.frames.toLocaleString("en")} frames on ports, ${time(summary.from_ps)} to ${time(summary.to_ps)}${end}`,
    );
    this.redraw();
  }

  /// The frame or reaction that a requirement's worst run is about, in the middle.
  showExplained(found: Explanation): void {
    byId("timeline-why").replaceChildren(...explanation(found));
    const frames = [
      ...found.frames,
      ...(found.reaction?.steps.flatMap((step) => (step.message ? [step.message] : [])) ?? []),
    ];
    this.light(frames);
    const begin = found.reaction?.began_ps ?? found.frames[0]?.produced_ps;
    const takes = found.reaction?.takes_ps ?? found.frames[0]?.takes_ps;
    if (begin !== undefined && takes !== undefined && this.summary)
      this.showSpan(begin - this.summary.from_ps - 0.2 * takes, Math.max(1.4 * takes, leastSpan));
    this.scrollToLit();
  }

  private say(text: string): void {
    byId("timeline-notice").textContent = text;
  }

  private showAll(): void {
    this.showSpan(0, this.span());
    this.top = 0;
  }

  private showSpan(from: number, span: number): void {
    this.scale = Math.max(span, leastSpan) / this.width();
    this.t0 = from;
    this.keepWithin();
    this.redraw();
  }

  isLoaded(): boolean {
    return this.summary !== null;
  }

  /// Only the ports between those nodes; without any all of them.
  showPorts(names: string[], isWhole: (node: string, to: string) => boolean): void {
    const rows = (this.summary?.rows ?? [])
      .filter((row) => isWhole(row.node, row.to))
      .map((row) => `${row.node}:${row.port} to ${row.to}`);
    (byId("timeline-filter") as HTMLInputElement).value = rows.length > 0 ? rows.join(" | ") : names.join(" | ");
    this.arrange();
  }

  private arrange(): void {
    const summary = this.summary;
    if (!summary) return;
    const filter = (byId("timeline-filter") as HTMLInputElement).value.trim().toLowerCase();
    const alternatives = filter
      .split("|")
      .map((each) => each.trim())
      .filter((each) => each !== "");
    const has = (name: string) =>
      alternatives.length === 0 || alternatives.some((each) => name.toLowerCase().includes(each));
    this.rows = [];
    this.portRows = [];
    let y = 0;
    const add = (name: string, height: number, port: number, track: number) => {
      if (!has(name)) return;
      const row = { y, height, name, port, track };
      this.rows.push(row);
      if (port >= 0) this.portRows[port] = row;
      y += height;
    };
    summary.tracks.forEach((track, n) => add(`${track.program}: ${track.name}`, plainHeight, -1, n));
    summary.rows.forEach((row, n) =>
      add(
        `${row.node}:${row.port} to ${row.to === "" ? "nothing" : row.to}`,
        row.gates ? gatedHeight : plainHeight,
        n,
        -1,
      ),
    );
    this.canvas.style.height = `clamp(160px, ${y + axisHeight + 4}px, 58vh)`;
    this.keepWithin();
    this.redraw();
  }

  /// A piece has come.
  private came(): void {
    this.redraw();
    if (this.isToStep !== 0) this.step(this.isToStep);
  }

  /// What the hand takes hold of there: an edge of a gate; with Shift a window, or a frame at its talker.
  private gripAt(x: number, y: number, isWide: boolean): Grip | null {
    const [row, summary] = [this.rowAt(y), this.summary];
    const port = row && summary?.rows[row.port];
    if (!this.grips || !row || !port || !summary || x < gutter || y < axisHeight) return null;
    const at = this.t0 + (x - gutter) * this.scale;
    if (isWide) {
      const sent = this.hit(x, y);
      const stream = sent && sent !== "many" ? (summary.streams[sent.stream] ?? "") : "";
      if (stream !== "") return port.gates ? null : this.grips.offset(stream);
      const lane = classes - 1 - Math.floor((y - axisHeight + this.top - row.y - 2) / ((gatedHeight - 4) / classes));
      return port.gates ? this.grips.window(port.node, port.to, at + summary.from_ps, lane) : null;
    }
    if (!port.gates) return null;
    let edge: number | null = null;
    for (const part of this.piecesOf(row.port))
      if (part.row.gateTimes.length * 6 < this.width())
        // edges that can be told apart
        for (const time of part.row.gateTimes) {
          const away = Math.abs(part.begin + time - at) / this.scale;
          if (away < 4 && part.begin + time > part.begin && (edge === null || away < Math.abs(edge - at) / this.scale))
            edge = part.begin + time;
        }
    return edge === null ? null : this.grips.edge(port.node, port.to, edge + summary.from_ps);
  }

  private light(frames: ExplainedFrame[]): void {
    const summary = this.summary;
    if (!summary) return;
    const port = new Map(summary.rows.map((row, n) => [`${row.node}:${row.port}`, n]));
    this.lit = [];
    for (const frame of frames)
      for (const hop of frame.hops) {
        const row = port.get(`${hop.node}:${hop.port ?? ""}`);
        if (row !== undefined)
          this.lit.push({
            row,
            came: hop.came_ps - summary.from_ps,
            started: typeof hop.started_ps === "number" ? hop.started_ps - summary.from_ps : null,
            parts: hop.parts,
          });
      }
    this.redraw();
  }

  private scrollToLit(): void {
    const rows = this.lit.flatMap((hop) => this.portRows[hop.row] ?? []);
    if (rows.length === 0) return;
    const [first, last] = [Math.min(...rows.map((row) => row.y)), Math.max(...rows.map((row) => row.y + row.height))];
    const height = this.canvas.clientHeight - axisHeight;
    if (first < this.top || last > this.top + height) this.top = Math.max((first + last - height) / 2, 0);
    this.keepWithin();
    this.redraw();
  }

  private sentAt(part: { row: PieceRow; begin: number }, port: number, n: number): Sent {
    const { row, begin } = part;
    return {
      port,
      start: begin + (row.starts?.[n] ?? 0),
      length: row.lengths[n] ?? 0,
      stream: row.streams[n] ?? 0,
      sequence: row.sequences[n] ?? 0,
      flags: row.flags[n] ?? 0,
    };
  }

  /// What is drawn there; null: nothing, or too much to tell.
  private hit(x: number, y: number): Sent | "many" | null {
    const row = this.rowAt(y);
    if (!row || row.port < 0 || x < gutter || y < axisHeight) return null;
    const at = this.t0 + (x - gutter) * this.scale;
    const near = 3 * this.scale;
    let best: Sent | null = null;
    for (const part of this.piecesOf(row.port)) {
      if (at < part.from - near || at > part.until + near) continue;
      if (part.row.picture) return part.row.count > 0 ? "many" : null;
      for (let n = 0; n < (part.row.starts?.length ?? 0); ++n) {
        const sent = this.sentAt(part, row.port, n);
        if (at < sent.start - near || at > sent.start + sent.length + near) continue;
        const distance = (each: Sent) => Math.max(each.start - at, at - each.start - each.length, 0);
        const [top, size] = this.lane(row, row.y - this.top + axisHeight, sent.flags);
        if (row.height === gatedHeight && (y < top - 1 || y > top + size + 1)) continue;
        if (!best || distance(sent) < distance(best)) best = sent;
      }
    }
    return best;
  }

  private async choose(sent: Sent): Promise<void> {
    const summary = this.summary;
    if (!summary) return;
    this.chosen = sent;
    this.redraw();
    const mine = ++this.asked;
    const stream = summary.streams[sent.stream] ?? "";
    this.chose(stream);
    byId("timeline-why").replaceChildren(
      element("p", `asking why ${stream} frame ${sent.sequence} took so long ...`, "note"),
    );
    try {
      const found = await engine.explain(this.look, stream, sent.sequence);
      if (mine !== this.asked) return;
      byId("timeline-why").replaceChildren(...explanation(found));
      this.light(found.frames);
    } catch (problem) {
      if (mine === this.asked) byId("timeline-why").replaceChildren(element("p", (problem as Error).message, "note"));
    }
  }

  private zoom(factor: number, x: number): void {
    const at = this.t0 + (x - gutter) * this.scale;
    this.scale *= factor;
    this.keepWithin();
    this.t0 = at - (x - gutter) * this.scale;
    this.keepWithin();
    this.redraw();
  }

  private pan(pixels: number, rows: number): void {
    this.t0 += pixels * this.scale;
    this.top += rows;
    this.keepWithin();
    this.redraw();
  }

  /// The next frame of the row, or the one before; of the first port in sight if none is chosen.
  private step(direction: 1 | -1): void {
    const port =
      this.chosen?.port ??
      this.rows.find(
        (row) => row.port >= 0 && row.y >= this.top && this.piecesOf(row.port).some((each) => each.row.count > 0),
      )?.port;
    const parts = port === undefined ? [] : this.piecesOf(port);
    // Where frames are not told apart yet, or nothing has come, it is tried again when something has.
    const isTooMuch = parts.some((each) => each.row.picture);
    this.isToStep = isTooMuch || parts.length === 0 ? direction : 0;
    if (isTooMuch) this.zoom(0.25, gutter + this.width() / 2);
    if (this.isToStep !== 0 || port === undefined) return;
    const all = parts.flatMap((part) => Array.from(part.row.starts ?? [], (_, n) => this.sentAt(part, port, n)));
    const now = this.chosen?.start ?? this.t0 - 1;
    const next = direction > 0 ? all.find((each) => each.start > now) : all.reverse().find((each) => each.start < now);
    if (!next) return this.pan((direction * this.width()) / 2, 0);
    if (next.start < this.t0 || next.start > this.t0 + this.width() * this.scale)
      this.t0 = next.start - (this.width() * this.scale) / 2;
    this.keepWithin();
    void this.choose(next);
  }

  private listen(): void {
    const { canvas } = this;
    let isDragged = false;
    const tip = byId("timeline-tip");
    canvas.addEventListener("pointerdown", (down) => {
      if (down.button !== 0) return;
      let [x, y] = [down.clientX, down.clientY];
      isDragged = false;
      const grip = this.gripAt(down.offsetX, down.offsetY, down.shiftKey);
      if (grip) this.held = { x: down.offsetX, by: 0 };
      canvas.setPointerCapture(down.pointerId);
      const moved = (event: PointerEvent) => {
        isDragged ||= Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) > 3;
        if (isDragged && grip && this.held) {
          this.held.by = event.clientX - down.clientX;
          grip.move(this.held.by * this.scale);
          this.redraw();
        } else if (isDragged) this.pan(x - event.clientX, y - event.clientY);
        [x, y] = [event.clientX, event.clientY];
      };
      const up = () => {
        canvas.removeEventListener("pointermove", moved);
        this.held = null;
        if (isDragged) grip?.drop();
        this.redraw();
      };
      canvas.addEventListener("pointermove", moved);
      canvas.addEventListener("pointerup", up, { once: true });
      canvas.addEventListener("pointercancel", up, { once: true });
    });
    canvas.addEventListener("click", (event) => {
      if (isDragged) return;
      const found = this.hit(event.offsetX, event.offsetY);
      if (found === "many") this.zoom(0.2, event.offsetX);
      else if (found) void this.choose(found);
    });
    canvas.addEventListener("pointermove", (event) => {
      const found = event.buttons === 0 ? this.hit(event.offsetX, event.offsetY) : null;
      const grip = event.buttons === 0 ? this.gripAt(event.offsetX, event.offsetY, event.shiftKey) : null;
      canvas.style.cursor = grip ? "ew-resize" : "crosshair";
      tip.hidden = found === null && grip === null;
      if (tip.hidden) return;
      tip.textContent =
        found === null
          ? `${grip?.name ?? ""}: drag it`
          : found === "many"
            ? "many frames: a click goes nearer"
            : this.words(found);
      tip.style.left = `${Math.min(event.offsetX + 14, canvas.clientWidth - 260)}px`;
      tip.style.top = `${event.offsetY + 14}px`;
    });
    canvas.addEventListener("pointerleave", () => (tip.hidden = true));
    canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        if (event.ctrlKey) this.zoom(Math.exp(Math.max(-200, Math.min(200, event.deltaY)) / 250), event.offsetX);
        else if (event.shiftKey) this.pan(event.deltaY, 0);
        else this.pan(event.deltaX, event.deltaY);
      },
      { passive: false },
    );
    const middle = () => gutter + this.width() / 2;
    const keys: Record<string, () => void> = {
      ArrowLeft: () => this.pan(-60, 0),
      ArrowRight: () => this.pan(60, 0),
      a: () => this.pan(-60, 0),
      d: () => this.pan(60, 0),
      PageUp: () => this.pan(-this.width() * 0.9, 0),
      PageDown: () => this.pan(this.width() * 0.9, 0),
      ArrowUp: () => this.pan(0, -plainHeight),
      ArrowDown: () => this.pan(0, plainHeight),
      "+": () => this.zoom(0.7, middle()),
      "=": () => this.zoom(0.7, middle()),
      w: () => this.zoom(0.7, middle()),
      "-": () => this.zoom(1 / 0.7, middle()),
      s: () => this.zoom(1 / 0.7, middle()),
      Home: () => this.showAll(),
      n: () => this.step(1),
      p: () => this.step(-1),
      Escape: () => {
        this.chosen = null;
        this.lit = [];
        byId("timeline-why").replaceChildren();
        this.redraw();
      },
    };
    canvas.addEventListener("keydown", (event) => {
      const act = event.ctrlKey || event.metaKey || event.altKey ? undefined : keys[event.key];
      if (!act) return;
      event.preventDefault();
      act();
    });
  }

  private words(sent: Sent): string {
    const stream = this.summary?.streams[sent.stream] ?? "";
    const at = time(sent.start + (this.summary?.from_ps ?? 0), 9);
    if ((sent.flags & flag.dropped) !== 0) return `${stream} frame ${sent.sequence} is dropped here at ${at}`;
    const part =
      (sent.flags & flag.continued) !== 0
        ? ", the rest of one that was cut"
        : (sent.flags & flag.cut) !== 0
          ? ", cut"
          : "";
    return `${stream} frame ${sent.sequence}, class ${classOf(sent.flags)}, at ${at} for ${time(sent.length)}${part}`;
  }
}
