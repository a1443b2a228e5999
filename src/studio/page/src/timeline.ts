// The timeline: ports and Programs by time on a canvas. It draws what is seen, from pieces that come as they are wanted.
import { engine, type ExplainedFrame, type Explanation, type Look, type Part, type TimelineSummary } from "./api";
import { byId, element, time } from "./dom";
import { explanation } from "./explanation";
import { Pieces, classOf, flag, rowsOfPiece, type PieceRow } from "./pieces";

const gutter = 190;   // pixels of names
const axisHeight = 26;
const plainHeight = 20;
const gatedHeight = 44;   // a lane for each class
const classes = 8;
const leastSpan = 10_000;   // ps on the whole width

const stateColours: Record<string, string> = { Halted: "#8a949b", "Halted.INIT": "#b08bd0", Ready: "#56b4e9", Running: "#009e73", Suspended: "#e69f00", dead: "#c0392b" };

/// Of the way of a frame: sent, on its way, in a host; everything else is waiting.
const partColours: Record<string, string> = { transmission: "#d55e00", cable: "#b8a48a", forwarding: "#b8a48a", jitter: "#b8a48a", os_transmit: "#9a86c8", os_receive: "#9a86c8", processor: "#9a86c8" };

interface Row {
  y: number;
  height: number;
  name: string;
  port: number;    // position among the ports, or -1
  track: number;   // or -1
}

/// A hop of the frame that is looked at.
interface Lit {
  row: number;      // position among the ports
  came: number;     // ps from the beginning of the timeline
  started: number | null;
  parts: Part[];
}

interface Sent {
  port: number;
  start: number;
  length: number;
  stream: number;
  sequence: number;
  flags: number;
}

function rgb(stream: number): [number, number, number] {
  // Neighbouring numbers get far hues.
  const hue = (stream * 137.508 + 205) % 360;
  const light = 0.5 - 0.08 * (stream % 3);
  const a = 0.6 * Math.min(light, 1 - light);
  const part = (n: number) => {
    const k = (n + hue / 30) % 12;
    return Math.round(255 * (light - a * Math.max(-1, Math.min(k - 3, 9 - k, 1))));
  };
  return [part(0), part(8), part(4)];
}

export class Timeline {
  private summary: TimelineSummary | null = null;
  private look: Look = { revision: 0, requirement: -1, from: 0 };
  private pieces: Pieces | null = null;
  private rows: Row[] = [];
  private portRows: Row[] = [];   // by port; those that are filtered out are missing
  private colours: string[] = [];
  private t0 = 0;             // ps from the beginning of the timeline, at the left edge
  private scale = 1;          // ps a pixel
  private top = 0;            // pixels that are scrolled away
  private isDue = false;
  private lit: Lit[] = [];
  private chosen: Sent | null = null;
  private asked = 0;
  private isToStep: 1 | -1 | 0 = 0;   // as soon as there are pieces
  private readonly canvas = byId("timeline-canvas") as HTMLCanvasElement;
  private readonly context = this.canvas.getContext("2d", { alpha: false }) as CanvasRenderingContext2D;
  private ink = { text: "", faint: "", line: "", paper: "", open: "" };

  constructor() {
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.resize());
    (byId("timeline-filter") as HTMLInputElement).addEventListener("input", () => this.arrange());
    this.listen();
  }

  /// Whether it shows that run.
  shows(look: Look): boolean {
    return this.summary !== null && look.revision === this.look.revision && look.requirement === this.look.requirement && look.from === this.look.from;
  }

  async load(look: Look): Promise<void> {
    this.say("recording the run ...");
    const summary = await engine.timeline(look);
    const keepsView = this.summary !== null && this.look.requirement === look.requirement && this.look.from === look.from && this.span() === summary.to_ps - summary.from_ps;
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
    this.say(`${summary.frames.toLocaleString("en")} frames on ports, ${time(summary.from_ps)} to ${time(summary.to_ps)}${end}`);
    this.redraw();
  }

  /// The frame or reaction that a requirement's worst run is about, in the middle.
  showExplained(found: Explanation): void {
    byId("timeline-why").replaceChildren(...explanation(found));
    const frames = [...found.frames, ...(found.reaction?.steps.flatMap((step) => (step.message ? [step.message] : [])) ?? [])];
    this.light(frames);
    const begin = found.reaction?.began_ps ?? found.frames[0]?.produced_ps;
    const takes = found.reaction?.takes_ps ?? found.frames[0]?.takes_ps;
    if (begin !== undefined && takes !== undefined && this.summary) this.showSpan(begin - this.summary.from_ps - 0.2 * takes, Math.max(1.4 * takes, leastSpan));
    this.scrollToLit();
  }

  private span(): number {
    return this.summary ? this.summary.to_ps - this.summary.from_ps : 0;
  }

  private width(): number {
    return Math.max(this.canvas.clientWidth - gutter, 50);
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

  private keepWithin(): void {
    const most = Math.max(this.span(), leastSpan) / this.width();
    this.scale = Math.min(Math.max(this.scale, leastSpan / this.width()), most);
    this.t0 = Math.min(Math.max(this.t0, 0), Math.max(this.span() - this.width() * this.scale, 0));
    const last = this.rows[this.rows.length - 1];
    const height = this.canvas.clientHeight - axisHeight;
    this.top = Math.min(Math.max(this.top, 0), Math.max((last ? last.y + last.height : 0) - height, 0));
  }

  private arrange(): void {
    const summary = this.summary;
    if (!summary) return;
    const filter = (byId("timeline-filter") as HTMLInputElement).value.trim().toLowerCase();
    const has = (name: string) => filter === "" || name.toLowerCase().includes(filter);
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
    summary.rows.forEach((row, n) => add(`${row.node}:${row.port} to ${row.to === "" ? "nothing" : row.to}`, row.gates ? gatedHeight : plainHeight, n, -1));
    this.canvas.style.height = `clamp(160px, ${y + axisHeight + 4}px, 58vh)`;
    this.keepWithin();
    this.redraw();
  }

  private resize(): void {
    const ratio = devicePixelRatio || 1;
    this.canvas.width = Math.round(this.canvas.clientWidth * ratio);
    this.canvas.height = Math.round(this.canvas.clientHeight * ratio);
    const style = getComputedStyle(document.documentElement);
    const of = (name: string) => style.getPropertyValue(name).trim();
    this.ink = { text: of("--ink"), faint: of("--faint"), line: of("--line"), paper: of("--paper"), open: of("--open") };
    this.keepWithin();
    this.redraw();
  }

  private redraw(): void {
    if (this.isDue) return;
    this.isDue = true;
    requestAnimationFrame(() => {
      this.isDue = false;
      this.draw();
    });
  }

  private x(at: number): number {
    return gutter + (at - this.t0) / this.scale;
  }

  /// A piece has come.
  private came(): void {
    this.redraw();
    if (this.isToStep !== 0) this.step(this.isToStep);
  }

  private draw(): void {
    const { context, canvas } = this;
    const ratio = canvas.width / Math.max(canvas.clientWidth, 1);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.fillStyle = this.ink.paper;
    context.fillRect(0, 0, width, height);
    if (!this.summary || width < gutter) return;
    context.save();
    context.beginPath();
    context.rect(0, axisHeight, width, height - axisHeight);
    context.clip();
    const shown = this.rows.filter((row) => row.y + row.height > this.top && row.y - this.top < height - axisHeight);
    context.strokeStyle = this.ink.line;
    context.lineWidth = 1;
    for (const row of shown) {
      const y = Math.round(row.y - this.top + axisHeight);
      context.save();
      context.beginPath();
      context.rect(gutter, y, width - gutter, row.height);
      context.clip();
      if (row.port >= 0) this.drawPort(row, y);
      else this.drawTrack(row, y);
      context.restore();
      context.beginPath();
      context.moveTo(0, y + row.height - 0.5);
      context.lineTo(width, y + row.height - 0.5);
      context.stroke();
    }
    this.drawLit();
    this.drawNames(shown);
    context.restore();
    this.drawAxis(width);
  }

  private drawNames(shown: Row[]): void {
    const { context } = this;
    context.fillStyle = this.ink.paper;
    context.fillRect(0, axisHeight, gutter - 1, this.canvas.clientHeight);
    context.fillStyle = this.ink.text;
    context.font = "12px system-ui, sans-serif";
    context.textBaseline = "middle";
    context.textAlign = "left";
    for (const row of shown) {
      let name = row.name;
      while (name.length > 4 && context.measureText(name).width > gutter - 12) name = name.slice(0, -2) + "…";
      context.fillText(name, 6, row.y - this.top + axisHeight + row.height / 2);
    }
  }

  private drawAxis(width: number): void {
    const { context } = this;
    context.fillStyle = this.ink.paper;
    context.fillRect(0, 0, width, axisHeight);
    context.strokeStyle = this.ink.line;
    context.fillStyle = this.ink.faint;
    context.font = "11px system-ui, sans-serif";
    context.textAlign = "left";
    context.textBaseline = "middle";
    const rough = this.scale * 80;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = Math.max(power * (rough / power > 5 ? 10 : rough / power > 2 ? 5 : 2), 1);
    const from = this.summary?.from_ps ?? 0;
    context.beginPath();
    for (let tick = Math.ceil((from + this.t0) / step) * step; tick - from < this.t0 + this.width() * this.scale; tick += step) {
      const x = Math.round(this.x(tick - from)) + 0.5;
      context.moveTo(x, axisHeight - 7);
      context.lineTo(x, axisHeight);
      context.fillText(time(tick, 9), x + 3, axisHeight / 2 - 2);
    }
    context.moveTo(0, axisHeight - 0.5);
    context.lineTo(width, axisHeight - 0.5);
    context.stroke();
    context.fillStyle = this.ink.text;
    context.fillText(`${time(this.width() * this.scale)} wide`, 6, axisHeight / 2);
  }

  private drawTrack(row: Row, y: number): void {
    const { context } = this;
    const states = this.summary?.tracks[row.track]?.states ?? [];
    const from = this.summary?.from_ps ?? 0;
    context.font = "11px system-ui, sans-serif";
    context.textBaseline = "middle";
    context.textAlign = "left";
    const end = gutter + this.width();
    let first = 0;
    for (let low = 0, high = states.length; low < high; ) {   // the last that began before the left edge
      const middle = (low + high) >> 1;
      if ((states[middle]?.[0] ?? 0) - from <= this.t0) first = low = middle + 1;
      else high = middle;
    }
    for (let n = Math.max(first - 1, 0); n < states.length; ++n) {
      const [at, name] = states[n] ?? [0, ""];
      const x1 = Math.max(this.x(at - from), gutter);
      if (x1 > end) break;
      const next = states[n + 1];
      const x2 = next ? Math.min(this.x(next[0] - from), end) : end;
      if (name === "") continue;
      context.fillStyle = stateColours[name] ?? "#7f7fd5";
      context.fillRect(x1, y + 3, Math.max(x2 - x1, 1), row.height - 7);
      if (x2 - x1 < 40) continue;
      context.fillStyle = "#fff";
      context.fillText(name, x1 + 4, y + row.height / 2, x2 - x1 - 8);
    }
  }

  /// The pieces of a port in that time, a little narrower than what is seen.
  private piecesOf(port: number): { row: PieceRow; begin: number; from: number; until: number; length: number }[] {
    const pieces = this.pieces;
    if (!pieces) return [];
    const seen = this.width() * this.scale;
    const level = Math.min(Math.max(Math.floor(Math.log2(Math.max(this.span(), 1) / seen)) + 1, 0), 40);
    const length = pieces.lengthAt(level);
    const found = [];
    for (let index = Math.max(Math.floor(this.t0 / length), 0); index * length < this.t0 + seen && index < 2 ** level; ++index) {
      const piece = pieces.get(level, index, Math.floor(port / rowsOfPiece));
      const row = piece?.rows[port % rowsOfPiece];
      if (piece && row) found.push({ row, begin: piece.begin, from: index * length, until: (index + 1) * length, length: piece.length });
    }
    return found;
  }

  private lane(row: Row, y: number, flags: number): [number, number] {
    if (row.height !== gatedHeight) return [y + 3, row.height - 7];
    const size = (gatedHeight - 4) / classes;
    return [y + 2 + (classes - 1 - Math.min(classOf(flags), classes - 1)) * size, size];
  }

  private drawPort(row: Row, y: number): void {
    const { context } = this;
    const right = gutter + this.width();
    for (const { row: part, begin, from, until, length } of this.piecesOf(row.port)) {
      const [left, end] = [Math.max(this.x(from), gutter), Math.min(this.x(until), right)];
      if (row.height === gatedHeight) this.drawGates(part, begin, left, end, y);
      if (part.picture) {
        context.imageSmoothingEnabled = false;
        context.save();
        context.beginPath();
        context.rect(left, y, end - left, row.height);
        context.clip();
        context.drawImage(part.picture, this.x(begin), y + 3, length / this.scale, row.height - 7);
        context.restore();
        continue;
      }
      const starts = part.starts as Float64Array;
      let last = -10;
      let colour = -1;
      for (let n = 0; n < starts.length; ++n) {
        const x1 = this.x(begin + (starts[n] ?? 0));
        if (x1 > end) break;
        const x2 = x1 + (part.lengths[n] ?? 0) / this.scale;
        if (x2 < left) continue;
        const flags = part.flags[n] ?? 0;
        if ((flags & flag.dropped) !== 0) {
          this.cross(x1, y + row.height / 2);
          colour = -1;
          continue;
        }
        if (x2 - last < 0.5 && row.height !== gatedHeight) continue;   // within the pixel that is drawn already
        const stream = part.streams[n] ?? 0;
        if (stream !== colour) context.fillStyle = this.colours[(colour = stream)] ?? "#888";
        const [top, size] = this.lane(row, y, flags);
        context.fillRect(x1, top, Math.max(x2 - x1 - (x2 - x1 > 4 ? 0.7 : 0), 1), size);
        last = x2;
        if (x2 - Math.max(x1, gutter) > 60 && row.height !== gatedHeight) {
          context.fillStyle = "#fff";
          context.font = "11px system-ui, sans-serif";
          context.textBaseline = "middle";
          const text = Math.max(x1, gutter) + 3;
          context.fillText(`${this.summary?.streams[stream] ?? ""} ${part.sequences[n] ?? 0}`, text, y + row.height / 2, Math.max(x2 - text - 4, 1));
          colour = -1;
        }
      }
    }
  }

  private drawGates(part: PieceRow, begin: number, left: number, end: number, y: number): void {
    const { context } = this;
    const size = (gatedHeight - 4) / classes;
    context.fillStyle = this.ink.open;
    const count = part.gateTimes.length;
    if (count === 0 || count * classes > 3 * (end - left)) {   // too many to be seen
      context.globalAlpha = 0.4;
      context.fillRect(left, y + 2, end - left, gatedHeight - 4);
      context.globalAlpha = 1;
      return;
    }
    for (let q = 0; q < classes; ++q) {
      const top = y + 2 + (classes - 1 - q) * size;
      let since: number | null = null;
      for (let n = 0; n <= count; ++n) {
        const x = n < count ? Math.max(this.x(begin + (part.gateTimes[n] ?? 0)), left) : end;
        const isOpen = n < count && ((part.gates[n] ?? 0) >> q) % 2 === 1;
        if (isOpen && since === null) since = x;
        if (isOpen || since === null) continue;
        if (Math.min(x, end) > since) context.fillRect(since, top + 0.5, Math.min(x, end) - since, size - 1);
        since = null;
      }
    }
  }

  private cross(x: number, y: number): void {
    const { context } = this;
    context.save();
    context.strokeStyle = "#c0392b";
    context.lineWidth = 2;
    context.beginPath();
    context.moveTo(x - 4, y - 4);
    context.lineTo(x + 4, y + 4);
    context.moveTo(x - 4, y + 4);
    context.lineTo(x + 4, y - 4);
    context.stroke();
    context.restore();
  }

  /// The way of the chosen frame: where it waited (below), where it was sent (framed), and a line from hop to hop.
  private drawLit(): void {
    const { context } = this;
    const from = this.summary?.from_ps ?? 0;
    context.save();
    context.beginPath();
    context.rect(gutter, axisHeight, this.width(), this.canvas.clientHeight);
    context.clip();
    let before: [number, number] | null = null;
    for (const hop of this.lit) {
      const row = this.portRows[hop.row];
      if (!row) continue;
      const y = row.y - this.top + axisHeight;
      for (const part of hop.parts) {
        const x1 = this.x(part.at_ps - from);
        const isSent = part.cause === "transmission";
        context.fillStyle = partColours[part.cause] ?? "#f0c040";
        context.fillRect(x1, y + (isSent ? 1 : row.height - 6), Math.max(part.takes_ps / this.scale, part.takes_ps > 0 ? 1.5 : 0), isSent ? 3 : 5);
      }
      const at: [number, number] = [this.x(hop.started ?? hop.came), y + row.height / 2];
      context.strokeStyle = "#d55e00";
      context.lineWidth = 2;
      if (before) {
        context.beginPath();
        context.moveTo(...before);
        context.lineTo(...at);
        context.stroke();
      }
      context.beginPath();
      context.arc(at[0], at[1], 4, 0, 2 * Math.PI);
      context.stroke();
      before = at;
    }
    if (this.chosen) {
      const row = this.portRows[this.chosen.port];
      if (row) {
        const x1 = this.x(this.chosen.start);
        context.strokeStyle = this.ink.text;
        context.lineWidth = 2;
        context.strokeRect(x1 - 1, row.y - this.top + axisHeight + 1, Math.max(this.chosen.length / this.scale, 2) + 2, row.height - 3);
      }
    }
    context.restore();
  }

  private light(frames: ExplainedFrame[]): void {
    const summary = this.summary;
    if (!summary) return;
    const port = new Map(summary.rows.map((row, n) => [`${row.node}:${row.port}`, n]));
    this.lit = [];
    for (const frame of frames)
      for (const hop of frame.hops) {
        const row = port.get(`${hop.node}:${hop.port ?? ""}`);
        if (row !== undefined) this.lit.push({ row, came: hop.came_ps - summary.from_ps, started: typeof hop.started_ps === "number" ? hop.started_ps - summary.from_ps : null, parts: hop.parts });
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
    return { port, start: begin + (row.starts?.[n] ?? 0), length: row.lengths[n] ?? 0, stream: row.streams[n] ?? 0, sequence: row.sequences[n] ?? 0, flags: row.flags[n] ?? 0 };
  }

  /// What is drawn there; null: nothing, or too much to tell.
  private hit(x: number, y: number): Sent | "many" | null {
    const row = this.rows.find((each) => y - axisHeight + this.top >= each.y && y - axisHeight + this.top < each.y + each.height);
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
    byId("timeline-why").replaceChildren(element("p", `asking why ${stream} frame ${sent.sequence} took so long ...`, "note"));
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
    const port = this.chosen?.port ?? this.rows.find((row) => row.port >= 0 && row.y >= this.top && this.piecesOf(row.port).some((each) => each.row.count > 0))?.port;
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
    if (next.start < this.t0 || next.start > this.t0 + this.width() * this.scale) this.t0 = next.start - (this.width() * this.scale) / 2;
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
      canvas.setPointerCapture(down.pointerId);
      const moved = (event: PointerEvent) => {
        isDragged ||= Math.hypot(event.clientX - down.clientX, event.clientY - down.clientY) > 3;
        if (isDragged) this.pan(x - event.clientX, y - event.clientY);
        [x, y] = [event.clientX, event.clientY];
      };
      const up = () => canvas.removeEventListener("pointermove", moved);
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
      tip.hidden = found === null;
      if (found === null) return;
      tip.textContent = found === "many" ? "many frames: a click goes nearer" : this.words(found);
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
    const part = (sent.flags & flag.continued) !== 0 ? ", the rest of one that was cut" : (sent.flags & flag.cut) !== 0 ? ", cut" : "";
    return `${stream} frame ${sent.sequence}, class ${classOf(sent.flags)}, at ${at} for ${time(sent.length)}${part}`;
  }
}

