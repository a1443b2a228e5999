// Edits by hand leave a text that says what it said before, and one thing more or less: for every shipped scenario.
//
//   edits_test.mjs SOURCE
import assert from "node:assert/strict";
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [source] = process.argv.slice(2);
const workshop = join(source, "build/studio");
const bundler = join(workshop, "node_modules/esbuild/lib/main.js");
if (!existsSync(bundler)) {
  console.log("the packages of the page are not installed: edits are not looked at");
  process.exit(77);
}
const { build } = await import(pathToFileURL(bundler).href);
const folder = mkdtempSync(join(tmpdir(), "takt-edits-"));
await build({ entryPoints: [join(source, "src/studio/page/src/edits.ts")], bundle: true, format: "esm", outfile: join(folder, "edits.mjs"), nodePaths: [join(workshop, "node_modules")], logLevel: "warning" });
const { added, withoutComments, withoutNode } = await import(pathToFileURL(join(folder, "edits.mjs")).href);
rmSync(folder, { recursive: true });

const applied = (text, edits) => [...edits].sort((a, b) => b.from - a.from || edits.indexOf(b) - edits.indexOf(a)).reduce((now, edit) => now.slice(0, edit.from) + edit.insert + now.slice(edit.to), text);
const read = (text) => JSON.parse(withoutComments(text).replace(/,(\s*[\]}])/g, "$1"));

// By hand: one line, several lines, nothing there, a comment behind the last one, a comma behind the last one.
const cases = [
  ['{"a": [1, 2]}', ["a"], null, "3", '{"a": [1, 2, 3]}'],
  ['{"a": []}', ["a"], null, "3", '{"a": [\n  3\n]}'],
  ["{}", ["a", "b"], "c", "1", '{\n  "a": {\n    "b": {\n      "c": 1\n    }\n  }\n}'],
  ['{\n  "a": {\n    "x": 1 // the first\n  }\n}', ["a"], "y", "2", '{\n  "a": {\n    "x": 1, // the first\n    "y": 2\n  }\n}'],
  ['{\n  "a": [\n    1,\n  ]\n}', ["a"], null, "2", '{\n  "a": [\n    1,\n    2\n  ]\n}'],
  ['// "a": [9]\n{"a": [1]}', ["a"], null, "2", '// "a": [9]\n{"a": [1, 2]}'],
  ['{"a": "no list"}', ["a"], null, "2", null],
  ['{"a": ["// no comment"]}', ["a"], null, "2", '{"a": ["// no comment", 2]}'],
];
for (const [text, path, name, value, expected] of cases) {
  const edits = added(text, path, name, value);
  assert.equal(edits === null ? null : applied(text, edits), expected, text);
}

let scenarios = 0;
const walk = (path) => readdirSync(path, { withFileTypes: true }).flatMap((each) => (each.isDirectory() ? walk(join(path, each.name)) : each.name.endsWith(".json") ? [join(path, each.name)] : []));
for (const file of walk(join(source, "scenarios"))) {
  const text = readFileSync(file, "utf8");
  if (!/"network"/.test(text) || /"factors"|\$defs/.test(text)) continue;
  const before = read(text);
  if (!before.network) continue;
  ++scenarios;
  const node = applied(text, added(text, ["network", "nodes"], "valve", '{"kind": "host"}'));
  const expected = structuredClone(before);
  expected.network.nodes = { ...expected.network.nodes, valve: { kind: "host" } };
  assert.deepEqual(read(node), expected, file);
  const stream = applied(text, added(text, ["streams"], null, '{"name": "s"}'));
  assert.deepEqual(read(stream), { ...before, streams: [...(before.streams ?? []), { name: "s" }] }, file);

  // What was added goes again, and a node goes with its links.
  assert.deepEqual(read(applied(node, [withoutNode(node, "valve").edit])), expected.network.nodes && before.network.nodes ? before : { ...before, network: { ...before.network, nodes: {} } }, file);
  for (const name of Object.keys(before.network.nodes ?? {})) {
    const after = read(applied(text, [withoutNode(text, name).edit]));
    assert.ok(!(name in after.network.nodes), `${file}: ${name}`);
    const ends = (link) => link.ends.map((end) => end.replace(/:\d+$/, ""));
    assert.deepEqual(after.network.links ?? [], (before.network.links ?? []).filter((link) => !ends(link).includes(name)), `${file}: ${name}`);
  }
}
assert.ok(scenarios > 50, `${scenarios} scenarios`);
