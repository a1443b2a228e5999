// SPDX-License-Identifier: Apache-2.0
// What the timeline draws: ports and Programs by time on a canvas, from pieces that come as they are wanted.
import type { Part, TimelineSummary } from "./api";
import { byId, time } from "./dom";
import { Pieces, classOf, flag, rowsOfPiece, type PieceRow } from "./pieces";

export const gutter = 190; // pixels of names
export const axisHeight = 26;
export const plainHeight = 20;
export const gatedHeight = 44; // a lane for each class
export const classes = 8;
export const leastSpan = 10_000; // ps on the whole width

const stateColours: Record<string, string> = {
  Halted: "#8a949b",
  "Halted.INIT": "#b08bd0",
  Ready: "#56b4e9",
  Running: "#009e73",
  Suspended: "#e69f00",
  dead: "#c0392b",
};

/// Of the way of a frame: sent, on its way, in a host; everything else is waiting.
const partColours: Record<string, string> = {
  transmission: "#d55e00",
  cable: "#b8a48a",
  forwarding: "#b8a48a",
  jitter: "#b8a48a",
  os_transmit: "#9a86c8",
  os_receive: "#9a86c8",
  processor: "#9a86c8",
};

export interface Row {
  y: number;
  height: number;
  name: string;
  port: number; // position among the ports, or -1
  track: number; // or -1
}

/// A hop of the frame that is looked at.
export interface Lit {
  row: number; // position among the ports
  came: number; // ps from the beginning of the timeline
  started: number | null;
  parts: Part[];
}

export interface Sent {
  port: number;
  start: number;
  length: number;
  stream: number;
  sequence: number;
  flags: number;
}

export function rgb(stream: number): [number, number, number] {
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

export class TimelineDrawing {
  protected summary: TimelineSummary | null = null;
  protected pieces: Pieces | null = null;
  protected rows: Row[] = [];
  protected portRows: Row[] = []; // by port; those that are filtered out are missing
  protected colours: string[] = [];
  protected t0 = 0; // ps from the beginning of the timeline, at the left edge
  protected scale = 1; // ps a pixel
  protected top = 0; // pixels that are scrolled away
  protected isDue = false;
  protected lit: Lit[] = [];
  protected chosen: Sent | null = null;
  protected held: { x: number; by: number } | null = null; // what the hand moves: where it was, and how far it is from there
  protected readonly canvas = byId("timeline-canvas") as HTMLCanvasElement;
  protected readonly context = this.canvas.getContext("2d", { alpha: false }) as CanvasRenderingContext2D;
  protected ink = { text: "", faint: "", line: "", paper: "", open: "" };

  protected span(): number {
    return this.summary ? this.summary.to_ps - this.summary.from_ps : 0;
  }

  protected width(): number {
    return Math.max(this.canvas.clientWidth - gutter, 50);
  }

  protected keepWithin(): void {
    const most = Math.max(this.span(), leastSpan) / this.width();
    this.scale = Math.min(Math.max(this.scale, leastSpan / this.width()), most);
    this.t0 = Math.min(Math.max(this.t0, 0), Math.max(this.span() - this.width() * this.scale, 0));
    const last = this.rows[this.rows.length - 1];
    const height = this.canvas.clientHeight - axisHeight;
    this.top = Math.min(Math.max(this.top, 0), Math.max((last ? last.y + last.height : 0) - height, 0));
  }

  protected resize(): void {
    const ratio = devicePixelRatio || 1;
    this.canvas.width = Math.round(this.canvas.clientWidth * ratio);
    this.canvas.height = Math.round(this.canvas.clientHeight * ratio);
    const style = getComputedStyle(document.documentElement);
    const of = (name: string) => style.getPropertyValue(name).trim();
    this.ink = {
      text: of("--ink"),
      faint: of("--faint"),
      line: of("--line"),
      paper: of("--paper"),
      open: of("--open"),
    };
    this.keepWithin();
    this.redraw();
  }

  protected redraw(): void {
    if (this.isDue) return;
    this.isDue = true;
    requestAnimationFrame(() => {
      this.isDue = false;
      this.draw();
    });
  }

  protected x(at: number): number {
    return gutter + (at - this.t0) / this.scale;
  }

  protected draw(): void {
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
    this.drawHeld(height);
    this.drawNames(shown);
    context.restore();
    this.drawAxis(width);
  }

  protected drawNames(shown: Row[]): void {
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

  protected drawAxis(width: number): void {
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
    for (
      let tick = Math.ceil((from + this.t0) / step) * step;
      tick - from < this.t0 + this.width() * this.scale;
      tick += step
    ) {
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

  protected drawTrack(row: Row, y: number): void {
    const { context } = this;
    const states = this.summary?.tracks[row.track]?.states ?? [];
    const from = this.summary?.from_ps ?? 0;
    context.font = "11px system-ui, sans-serif";
    context.textBaseline = "middle";
    context.textAlign = "left";
    const end = gutter + this.width();
    let first = 0;
    for (let low = 0, high = states.length; low < high;) {
      // the last that began before the left edge
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
  protected piecesOf(port: number): { row: PieceRow; begin: number; from: number; until: number; length: number }[] {
    const pieces = this.pieces;
    if (!pieces) return [];
    const seen = this.width() * this.scale;
    const level = Math.min(Math.max(Math.floor(Math.log2(Math.max(this.span(), 1) / seen)) + 1, 0), 40);
    const length = pieces.lengthAt(level);
    const found = [];
    for (
      let index = Math.max(Math.floor(this.t0 / length), 0);
      index * length < this.t0 + seen && index < 2 ** level;
      ++index
    ) {
      const piece = pieces.get(level, index, Math.floor(port / rowsOfPiece));
      const row = piece?.rows[port % rowsOfPiece];
      if (piece && row)
        found.push({
          row,
          begin: piece.begin,
          from: index * length,
          until: (index + 1) * length,
          length: piece.length,
        });
    }
    return found;
  }

  protected lane(row: Row, y: number, flags: number): [number, number] {
    if (row.height !== gatedHeight) return [y + 3, row.height - 7];
    const size = (gatedHeight - 4) / classes;
    return [y + 2 + (classes - 1 - Math.min(classOf(flags), classes - 1)) * size, size];
  }

  protected drawPort(row: Row, y: number): void {
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
        let before = -10;
        part.discarded.forEach((count, n) => {
          const x = this.x(begin + ((n + 0.5) * length) / part.discarded.length);
          if (count === 0 || x < left || x > end || x - before < 6) return;
          this.cross(x, y + row.height / 2);
          before = x;
        });
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
        if (x2 - last < 0.5 && row.height !== gatedHeight) continue; // within the pixel that is drawn already
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
          context.fillText(
            `${this.summary?.streams[stream] ?? ""} ${part.sequences[n] ?? 0}`,
            text,
            y + row.height / 2,
            Math.max(x2 - text - 4, 1),
          );
          colour = -1;
        }
      }
    }
  }

  protected drawGates(part: PieceRow, begin: number, left: number, end: number, y: number): void {
    const { context } = this;
    const size = (gatedHeight - 4) / classes;
    context.fillStyle = this.ink.open;
    const count = part.gateTimes.length;
    if (count === 0 || count * classes > 3 * (end - left)) {
      // too many to be seen
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

  protected cross(x: number, y: number): void {
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
  protected drawLit(): void {
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
        context.fillRect(
          x1,
          y + (isSent ? 1 : row.height - 6),
          Math.max(part.takes_ps / this.scale, part.takes_ps > 0 ? 1.5 : 0),
          isSent ? 3 : 5,
        );
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
        context.strokeRect(
          x1 - 1,
          row.y - this.top + axisHeight + 1,
          Math.max(this.chosen.length / this.scale, 2) + 2,
          row.height - 3,
        );
      }
    }
    context.restore();
  }

  /// Where what the hand moves was, and where it is.
  protected drawHeld(height: number): void {
    if (!this.held) return;
    const { context } = this;
    context.strokeStyle = "#d55e00";
    context.lineWidth = 1;
    for (const [x, dash] of [
      [this.held.x, [3, 3]],
      [this.held.x + this.held.by, []],
    ] as const) {
      context.setLineDash([...dash]);
      context.beginPath();
      context.moveTo(x, axisHeight);
      context.lineTo(x, height);
      context.stroke();
    }
    context.setLineDash([]);
  }

  protected rowAt(y: number): Row | undefined {
    return this.rows.find(
      (each) => y - axisHeight + this.top >= each.y && y - axisHeight + this.top < each.y + each.height,
    );
  }
}
