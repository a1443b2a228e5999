// SPDX-License-Identifier: Apache-2.0
// Gate lists and offsets of the text, and the edits that move them: an edge, a window, the beginning of a list, the offset of a stream.
import type { Json } from "./api";
import { put, readText, type Edit, type Path } from "./edits";

const units: Record<string, number> = { s: 1e12, ms: 1e9, us: 1e6, ns: 1e3, ps: 1 };
const everyClass = [0, 1, 2, 3, 4, 5, 6, 7]; // a stream gate is open for all, or for none
const least = 1000; // ps, of an entry

/// "1.5ms" in ps; null if it is none.
export function duration(text: unknown): number | null {
  const parts = typeof text === "string" ? /^\s*(-?\d+(?:\.\d+)?)\s*(s|ms|us|ns|ps)\s*$/.exec(text) : null;
  return parts ? Math.round(Number(parts[1]) * (units[parts[2] ?? ""] ?? 0)) : null;
}

/// A time in the unit of what stood there.
export function quoted(ps: number, like: unknown): string {
  const unit = (typeof like === "string" ? /[a-z]+\s*$/.exec(like)?.[0].trim() : undefined) ?? "us";
  return `"${Number((ps / (units[unit] ?? 1e6)).toFixed(9))}${unit}"`;
}

export interface Entry {
  open: number[];
  begin: number; // ps from the beginning of the cycle
  length: number;
}

export interface GateList {
  path: Path; // to the object that has the entries
  title: string;
  node: string; // whose ports follow it; empty: those of a generator
  to: string; // only of the port to that neighbour; empty: of all
  from: number | null; // ps, when a script sets it
  base: number; // ps
  cycle: number;
  entries: Entry[];
}

interface RawList {
  cycle?: unknown;
  base_time?: unknown;
  entries?: { open?: unknown; for?: unknown }[];
}

const asObject = (value: Json | undefined): Record<string, Json> | null =>
  typeof value === "object" && value !== null && !Array.isArray(value) ? value : null;

function listOf(raw: RawList, path: Path, place: Place): GateList | null {
  const entries: Entry[] = [];
  let begin = 0;
  for (const each of raw.entries ?? []) {
    const length = duration(each?.for);
    if (length === null) return null;
    entries.push({
      open:
        each.open === true
          ? everyClass
          : Array.isArray(each.open)
            ? each.open.filter((one): one is number => typeof one === "number")
            : [],
      begin,
      length,
    });
    begin += length;
  }
  return entries.length > 0
    ? { path, ...place, base: duration(raw.base_time) ?? 0, cycle: Math.max(duration(raw.cycle) ?? 0, begin), entries }
    : null;
}

type Place = Pick<GateList, "title" | "node" | "to" | "from">;

/// Where a list stands: whose it is, and that in words.
function placeOf(whole: Json, path: Path): Place {
  const at = (upTo: number): Record<string, Json> | null =>
    asObject(
      path
        .slice(0, upTo)
        .reduce<Json | undefined>(
          (value, step) => (Array.isArray(value) ? value[step as number] : asObject(value)?.[step]),
          whole,
        ),
    );
  const word = (value: Json | undefined) => (typeof value === "string" ? value : "");
  if (path[0] === "script") {
    const set = asObject(at(2)?.["set_gates"]);
    const [node, from] = [word(set?.["node"]), word(at(2)?.["at"])];
    return { title: `${node} from ${from} on`, node, to: word(set?.["to"]), from: duration(from) };
  }
  const egress = path.indexOf("egress");
  const to = egress >= 0 ? word(at(egress + 2)?.["to"]) : "";
  if (path[1] === "generate")
    return { title: `the ports of generator ${Number(path[2] ?? 0) + 1}`, node: "", to, from: null };
  if (path[1] === "nodes")
    return {
      title: `${String(path[2])}${to === "" ? "" : ` to ${to}`}${path.includes("ingress") ? ", stream gate" : ""}`,
      node: String(path[2]),
      to,
      from: null,
    };
  return { title: path.join("/"), node: "", to, from: null };
}

/// All lists of the text, in its order.
export function gateLists(text: string): GateList[] {
  const whole = readText(text);
  const found: GateList[] = [];
  const walk = (value: Json, path: Path): void => {
    if (Array.isArray(value)) return value.forEach((each, n) => walk(each, [...path, n]));
    const object = asObject(value);
    if (!object) return;
    if (path.includes("gates") && Array.isArray(object["entries"])) {
      const list = listOf(object as RawList, path, placeOf(whole, path));
      if (list) found.push(list);
    }
    for (const [key, each] of Object.entries(object)) walk(each, [...path, key]);
  };
  walk(whole, []);
  return found;
}

function rawAt(text: string, path: Path): RawList | null {
  const found = path.reduce<Json | undefined>(
    (value, step) => (Array.isArray(value) ? value[step as number] : asObject(value)?.[step]),
    readText(text),
  );
  return (asObject(found) as RawList | null) ?? null;
}

/// The whole list begins later, or earlier.
function movedBeginning(text: string, path: Path, raw: RawList, by: number): Edit[] {
  return put(
    text,
    [...path, "base_time"],
    quoted((duration(raw.base_time) ?? 0) + by, raw.base_time ?? raw.entries?.[0]?.for),
  );
}

/// Entries from `first` up to `last` later by so much: the one before gets longer, the one behind shorter, neither vanishes. The first one takes the whole list
/// along. An edge is what moves where there is nothing between them: `last` is `first` - 1.
export function movedEntries(text: string, path: Path, first: number, last: number, by: number): Edit[] {
  const raw = rawAt(text, path);
  const entries = raw?.entries ?? [];
  const count = entries.length;
  if (!raw || count === 0) return [];
  if (first <= 0 || last >= count - 1) return movedBeginning(text, path, raw, by);
  const [before, behind] = [first - 1, last + 1];
  const [a, b] = [duration(entries[before]?.for), duration(entries[behind]?.for)];
  if (a === null || b === null) return [];
  const within = Math.min(Math.max(by, least - a), b - least);
  const length = (n: number, ps: number) => put(text, [...path, "entries", n, "for"], quoted(ps, entries[n]?.for));
  return [...length(before, a + within), ...length(behind, b - within)];
}

export interface Talker {
  number: number; // in "streams"
  name: string;
  offset: number; // ps
  every: number;
}

/// The streams of the text that have a period.
export function talkers(text: string): Talker[] {
  const streams = asObject(readText(text))?.["streams"];
  return (Array.isArray(streams) ? streams : []).flatMap((each, number) => {
    const stream = asObject(each);
    const every = duration(stream?.["every"]);
    return stream && every
      ? [{ number, name: String(stream["name"] ?? number), offset: duration(stream["offset"]) ?? 0, every }]
      : [];
  });
}

/// A stream begins later within its period, or earlier.
export function movedOffset(text: string, number: number, by: number): Edit[] {
  const now = talkers(text).find((each) => each.number === number);
  const streams = asObject(readText(text))?.["streams"];
  const raw = Array.isArray(streams) ? asObject(streams[number]) : null;
  if (!now || !raw) return [];
  const offset = Math.min(Math.max(now.offset + by, 0), now.every - least);
  return put(text, ["streams", number, "offset"], quoted(offset, raw["offset"] ?? raw["every"]));
}

/// Steps in which the hand moves on a width of so many ps: a round number, about a thousandth.
export function stepOf(span: number): number {
  return Math.max(10 ** Math.floor(Math.log10(span / 500)), least);
}
