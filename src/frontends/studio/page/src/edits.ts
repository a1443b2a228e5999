// SPDX-License-Identifier: Apache-2.0
// Edits of the text by hand: a member or an item more or less, with the indentation and the comments that stand there.
import { jsonLanguage } from "@codemirror/lang-json";
import type { SyntaxNode } from "@lezer/common";
import type { Json } from "./api";

export interface Edit {
  from: number;
  to: number;
  insert: string;
}

export type Path = (string | number)[];

const stringsAndComments = /"(?:[^"\\\n]|\\.)*"|\/\/[^\n]*|\/\*[\s\S]*?\*\//g;

/// The text with blanks for comments, which the parser does not know; every place stays where it is.
export function withoutComments(text: string): string {
  return text.replace(stringsAndComments, (found) => (found.startsWith('"') ? found : found.replace(/[^\n]/g, " ")));
}

/// From where to where comments stand, in the order of the text.
export function comments(text: string): [number, number][] {
  const found: [number, number][] = [];
  for (const each of text.matchAll(stringsAndComments))
    if (!each[0].startsWith('"')) found.push([each.index, each.index + each[0].length]);
  return found;
}

const values = new Set(["Object", "Array", "String", "Number", "True", "False", "Null"]);

function nameOf(text: string, property: SyntaxNode): string {
  const name = property.getChild("PropertyName");
  try {
    return name ? (JSON.parse(text.slice(name.from, name.to)) as string) : "";
  } catch {
    return "";
  }
}

function valueOf(property: SyntaxNode): SyntaxNode | null {
  for (let each = property.lastChild; each; each = each.prevSibling) if (values.has(each.name)) return each;
  return null;
}

function children(node: SyntaxNode): SyntaxNode[] {
  const found: SyntaxNode[] = [];
  for (let each = node.firstChild; each; each = each.nextSibling)
    if (each.name === "Property" || values.has(each.name)) found.push(each);
  return found;
}

function root(text: string): SyntaxNode | null {
  const top = jsonLanguage.parser.parse(withoutComments(text)).topNode;
  return children(top)[0] ?? null;
}

/// The property or item that the path leads to; of the empty path the whole.
export function place(text: string, path: Path): SyntaxNode | null {
  let at = root(text);
  let found = at;
  for (const step of path) {
    if (!at) return null;
    const inside = children(at);
    found = (typeof step === "number" ? inside[step] : inside.find((each) => nameOf(text, each) === step)) ?? null;
    at = found?.name === "Property" ? valueOf(found) : found;
  }
  return found;
}

/// The value that the path leads to.
export function valueAt(text: string, path: Path): SyntaxNode | null {
  const found = place(text, path);
  return found?.name === "Property" ? valueOf(found) : found;
}

/// What a value says; of a broken one what can be read.
function read(text: string, node: SyntaxNode): Json {
  if (node.name === "Array") return children(node).map((each) => read(text, each));
  if (node.name === "Object")
    return Object.fromEntries(
      children(node).map((each): [string, Json] => {
        const value = valueOf(each);
        return [nameOf(text, each), value ? read(text, value) : null];
      }),
    );
  try {
    return JSON.parse(text.slice(node.from, node.to)) as Json;
  } catch {
    return null;
  }
}

export function readText(text: string): Json {
  const whole = root(text);
  return whole ? read(text, whole) : null;
}

/// Puts a value where the path leads to; a member that is not there is added to its object.
export function put(text: string, path: Path, value: string): Edit[] {
  const found = valueAt(text, path);
  if (found) return [{ from: found.from, to: found.to, insert: value }];
  const name = path[path.length - 1];
  return typeof name === "string" ? (added(text, path.slice(0, -1), name, value) ?? []) : [];
}

/// The text after edits of it that do not overlap.
export function applied(text: string, edits: Edit[]): string {
  const order = [...edits].sort((a, b) => b.from - a.from || edits.indexOf(b) - edits.indexOf(a));
  return order.reduce((now, edit) => now.slice(0, edit.from) + edit.insert + now.slice(edit.to), text);
}

/// The one edit that makes the second of two texts of the first.
export function difference(before: string, after: string): Edit {
  let from = 0;
  while (from < after.length && from < before.length && after[from] === before[from]) ++from;
  let behind = 0;
  while (
    behind < after.length - from &&
    behind < before.length - from &&
    after[after.length - 1 - behind] === before[before.length - 1 - behind]
  )
    ++behind;
  return { from, to: before.length - behind, insert: after.slice(from, after.length - behind) };
}

function containerAt(text: string, path: Path): SyntaxNode | null {
  const value = valueAt(text, path);
  return value && (value.name === "Object" || value.name === "Array") ? value : null;
}

const indentOf = (text: string, at: number): string =>
  /^[ \t]*/.exec(text.slice(text.lastIndexOf("\n", at - 1) + 1, at))?.[0] ?? "";

/// One more thing at the end of an object or a list: `made` is its text, of an object with the name.
function append(text: string, container: SyntaxNode, made: string): Edit[] {
  const inside = children(container);
  const last = inside[inside.length - 1];
  const insert = (at: number, words: string): Edit => ({ from: at, to: at, insert: words });
  if (!last) {
    const outer = indentOf(text, container.from);
    return [insert(container.from + 1, `\n${outer}  ${made}\n${outer}`)];
  }
  const rest = withoutComments(text).slice(last.to, container.to - 1);
  const comma = /^\s*,/.exec(rest);
  const at = last.to + (comma ? comma[0].length : 0);
  const isOnOneLine = !text.slice(container.from, last.from).includes("\n");
  if (isOnOneLine) return [insert(at, `${comma ? "" : ","} ${made}`)];
  // A comment behind the last one stays with it.
  const line = /^[ \t]*\n/.exec(withoutComments(text).slice(at, container.to));
  const end = line ? at + line[0].length - 1 : at;
  return [...(comma ? [] : [insert(at, ",")]), insert(end, `\n${indentOf(text, last.from)}${made}`)];
}

/// Adds a member (with a name) or an item (without) to what the path leads to, which is made if it is not there. Nothing if that is no object or list.
export function added(text: string, path: Path, name: string | null, value: string): Edit[] | null {
  const container = containerAt(text, path);
  const made = name === null ? value : `${JSON.stringify(name)}: ${value}`;
  if (container) return (container.name === "Object") === (name !== null) ? append(text, container, made) : null;
  if (path.length === 0 || place(text, path)) return null;
  const key = path[path.length - 1];
  if (typeof key !== "string") return null;
  const inner = "  ".repeat(path.length);
  return added(
    text,
    path.slice(0, -1),
    key,
    name === null ? `[\n${inner}  ${made}\n${inner}]` : `{\n${inner}  ${made}\n${inner}}`,
  );
}

/// Takes a property or item away, with its comma, and the line if it stood there alone.
function removed(text: string, node: SyntaxNode): Edit {
  let from = node.from;
  let to = node.to;
  const plain = withoutComments(text);
  const behind = /^\s*,/.exec(plain.slice(to));
  if (behind) to += behind[0].length;
  else {
    const before = /,\s*$/.exec(plain.slice(0, from));
    if (before) from -= before[0].length;
  }
  const line = text.lastIndexOf("\n", from - 1) + 1;
  if (text.slice(line, from).trim() === "" && /^[ \t]*(\n|$)/.test(text.slice(to))) {
    from = line;
    to = Math.min(text.length, text.indexOf("\n", to) < 0 ? text.length : text.indexOf("\n", to) + 1);
  }
  return { from, to, insert: "" };
}

/// A link that ends at the node.
function linkOf(text: string, node: string): SyntaxNode | null {
  const list = containerAt(text, ["network", "links"]);
  const pattern = new RegExp(`"${node.replace(/[.*+?^${}()|[\]\\]/g, "\\$&")}(:\\d+)?"`);
  const endsThere = (link: SyntaxNode) => {
    const ends = children(link).find((property) => nameOf(text, property) === "ends");
    return ends !== undefined && pattern.test(text.slice(ends.from, ends.to));
  };
  return (list ? children(list) : []).find(endsThere) ?? null;
}

/// Takes a node away, with the links that end there. Nothing if it does not stand in the text.
export function withoutNode(text: string, name: string): { edit: Edit; links: number } | null {
  let now = text;
  const take = (node: SyntaxNode) => {
    const edit = removed(now, node);
    now = now.slice(0, edit.from) + now.slice(edit.to);
  };
  let links = 0;
  for (let link = linkOf(now, name); link; link = linkOf(now, name), ++links) take(link);
  const node = place(now, ["network", "nodes", name]);
  if (!node) return null;
  take(node);
  return { edit: difference(text, now), links }; // what is before and behind stays as it is
}
