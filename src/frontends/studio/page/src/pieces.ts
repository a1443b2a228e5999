// SPDX-License-Identifier: Apache-2.0
// Pieces of a timeline, as the engine hands them out: kept while they are likely to be seen again.
import { engine, type Look } from "./api";

export const rowsOfPiece = 32;
const bucketCount = 512;

/// One port in one piece of time. Starts count from the beginning of the piece, in ps.
export interface PieceRow {
  count: number;
  starts: Float64Array | null; // null: too many to be told one by one
  lengths: Float32Array;
  streams: Uint32Array;
  sequences: Uint32Array;
  flags: Uint32Array;
  picture: HTMLCanvasElement | null; // of how busy the port is, one pixel high
  discarded: Uint8Array; // of that picture: frames that ended there, by part of the time
  gateTimes: Float64Array;
  gates: Uint32Array;
}

export interface Piece {
  begin: number; // ps from the beginning of the timeline
  length: number;
  rows: PieceRow[];
}

export const flag = { continued: 1, cut: 2, dropped: 4 };
export const classOf = (flags: number): number => flags >> 8;

function picture(
  streams: Uint32Array,
  busy: Uint8Array,
  colour: (stream: number) => [number, number, number],
): HTMLCanvasElement {
  const canvas = document.createElement("canvas");
  canvas.width = bucketCount;
  canvas.height = 1;
  const context = canvas.getContext("2d");
  if (!context) return canvas;
  const image = context.createImageData(bucketCount, 1);
  for (let b = 0; b < bucketCount; ++b) {
    const stream = streams[b] ?? 0xffffffff;
    if (stream === 0xffffffff) continue;
    const [red, green, blue] = colour(stream);
    image.data.set([red, green, blue, 70 + ((busy[b] ?? 0) * 185) / 255], 4 * b);
  }
  context.putImageData(image, 0, 0);
  return canvas;
}

export function decoded(
  octets: ArrayBuffer,
  begin: number,
  length: number,
  colour: (stream: number) => [number, number, number],
): Piece {
  const head = new Uint32Array(octets, 0, 2 + 6 * (new Uint32Array(octets, 0, 1)[0] ?? 0));
  const rows: PieceRow[] = [];
  for (let i = 0; i < (head[0] ?? 0); ++i) {
    const [kind = 0, count = 0, at = 0, gateCount = 0, gatesAt = 0] = head.subarray(2 + 6 * i, 8 + 6 * i);
    const isExact = kind === 1;
    const n = isExact ? count : 0;
    rows.push({
      count,
      starts: isExact ? new Float64Array(octets, at, n) : null,
      lengths: new Float32Array(octets, at + 8 * n, n),
      streams: new Uint32Array(octets, at + 12 * n, n),
      sequences: new Uint32Array(octets, at + 16 * n, n),
      flags: new Uint32Array(octets, at + 20 * n, n),
      picture: isExact
        ? null
        : picture(
            new Uint32Array(octets, at, bucketCount),
            new Uint8Array(octets, at + 4 * bucketCount, bucketCount),
            colour,
          ),
      discarded: isExact ? new Uint8Array() : new Uint8Array(octets, at + 5 * bucketCount, bucketCount),
      gateTimes: new Float64Array(octets, gatesAt, gateCount),
      gates: new Uint32Array(octets, gatesAt + 8 * gateCount, gateCount),
    });
  }
  return { begin, length, rows };
}

/// Asks for pieces, the last wanted first, and forgets those that were not seen for long.
export class Pieces {
  private kept = new Map<string, Piece>(); // in the order in which they were last seen
  private wanted: { key: string; level: number; index: number; group: number }[] = [];
  private underWay = new Set<string>();
  private readonly most = 600;

  constructor(
    private look: Look,
    private span: number,
    private colour: (stream: number) => [number, number, number],
    private came: () => void,
  ) {}

  lengthAt(level: number): number {
    return Math.ceil(this.span / 2 ** level);
  }

  /// The piece, or what is known of its time from a longer one; null: nothing yet.
  get(level: number, index: number, group: number): Piece | null {
    for (let up = 0; up <= level; ++up) {
      const key = `${level - up}/${Math.floor(index / 2 ** up)}/${group}`;
      const found = this.kept.get(key);
      if (up === 0 && !found) this.want(key, level, index, group);
      if (!found) continue;
      this.kept.delete(key);
      this.kept.set(key, found);
      return found;
    }
    return null;
  }

  private want(key: string, level: number, index: number, group: number): void {
    if (this.underWay.has(key)) return;
    this.wanted = this.wanted.filter((each) => each.key !== key);
    this.wanted.push({ key, level, index, group });
    if (this.wanted.length > 60) this.wanted.shift();
    this.fetch();
  }

  private fetch(): void {
    while (this.underWay.size < 3) {
      const next = this.wanted.pop();
      if (!next) return;
      this.underWay.add(next.key);
      const length = this.lengthAt(next.level);
      engine
        .piece(this.look, next.level, next.index, next.group * rowsOfPiece, rowsOfPiece)
        .then((octets) => {
          this.kept.set(next.key, decoded(octets, length * next.index, length, this.colour));
          while (this.kept.size > this.most) this.kept.delete(this.kept.keys().next().value as string);
          this.came();
        })
        .catch(() => undefined) // another text has come
        .finally(() => {
          this.underWay.delete(next.key);
          this.fetch();
        });
    }
  }
}
