// SPDX-License-Identifier: Apache-2.0
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
const bundled = async (name) => {
  const file = join(folder, `${name}.mjs`);
  await build({
    entryPoints: [join(source, `src/frontends/studio/page/src/${name}.ts`)],
    bundle: true,
    format: "esm",
    outfile: file,
    nodePaths: [join(workshop, "node_modules")],
    logLevel: "warning",
  });
  return import(pathToFileURL(file).href);
};
const { added, applied, comments, difference, put, readText, withoutComments, withoutNode } = await bundled("edits");
const { gateLists, movedEntries, movedOffset, talkers } = await bundled("gates");
const { namesAt } = await bundled("names");
rmSync(folder, { recursive: true });

const read = (text) => JSON.parse(withoutComments(text).replace(/,(\s*[\]}])/g, "$1"));

// By hand: one line, several lines, nothing there, a comment behind the last one, a comma behind the last one.
const cases = [
  ['{"a": [1, 2]}', ["a"], null, "3", '{"a": [1, 2, 3]}'],
  ['{"a": []}', ["a"], null, "3", '{"a": [\n  3\n]}'],
  ["{}", ["a", "b"], "c", "1", '{\n  "a": {\n    "b": {\n      "c": 1\n    }\n  }\n}'],
  [
    '{\n  "a": {\n    "x": 1 // the first\n  }\n}',
    ["a"],
    "y",
    "2",
    '{\n  "a": {\n    "x": 1, // the first\n    "y": 2\n  }\n}',
  ],
  ['{\n  "a": [\n    1,\n  ]\n}', ["a"], null, "2", '{\n  "a": [\n    1,\n    2\n  ]\n}'],
  ['// "a": [9]\n{"a": [1]}', ["a"], null, "2", '// "a": [9]\n{"a": [1, 2]}'],
  ['{"a": "no list"}', ["a"], null, "2", null],
  ['{"a": ["// no comment"]}', ["a"], null, "2", '{"a": ["// no comment", 2]}'],
];
for (const [text, path, name, value, expected] of cases) {
  const edits = added(text, path, name, value);
  assert.equal(edits === null ? null : applied(text, edits), expected, text);
}

// What the hand moves: an edge, a window, a whole list, an offset; units and comments stay.
const gates = `{
  "network": {"nodes": {"sw": {"kind": "switch", "egress": [{"to": "b", "gates": {"entries": [
    {"open": [7], "for": "100us"},   // control
    {"open": [0, 1], "for": "0.4ms"}, {"open": [2], "for": "500us"}
  ]}}]}}},
  "streams": [{"name": "s", "every": "1ms"}, {"name": "t", "offset": "3us", "every": "1ms"}]
}`;
const [list] = gateLists(gates);
assert.deepEqual([list.title, list.cycle, list.entries.map((each) => each.begin)], ["sw to b", 1e9, [0, 1e8, 5e8]]);
const entries = (first, last, by) =>
  readText(applied(gates, movedEntries(gates, list.path, first, last, by))).network.nodes.sw.egress[0].gates;
const lengths = (...of) => entries(...of).entries.map((each) => each.for);
assert.deepEqual(lengths(1, 0, 2e7), ["120us", "0.38ms", "500us"], "an edge");
assert.deepEqual(lengths(1, 0, -5e8), ["0.001us", "0.499999ms", "500us"], "no entry vanishes");
assert.deepEqual(lengths(1, 1, 1e7), ["110us", "0.4ms", "490us"], "a window");
assert.equal(entries(0, 0, 1e7).base_time, "10us", "the first window takes the list along");
assert.deepEqual(lengths(0, 0, 1e7), ["100us", "0.4ms", "500us"]);
assert.match(applied(gates, movedEntries(gates, list.path, 1, 0, 2e7)), /"120us"\},   \/\/ control/);
const offsets = (number, by) => talkers(applied(gates, movedOffset(gates, number, by))).map((each) => each.offset);
assert.deepEqual(
  [offsets(0, 2e6), offsets(1, 2e6), offsets(1, -9e6), offsets(1, 9e9)],
  [
    [2e6, 3e6],
    [0, 5e6],
    [0, 0],
    [0, 1e9 - 1000],
  ],
);
assert.deepEqual(comments('"// no" /* a */ // b'), [
  [8, 15],
  [16, 20],
]);
assert.deepEqual(applied("abcd", [difference("abcd", "axd")]), "axd");
assert.equal(applied('{"a": 1}', put('{"a": 1}', ["a"], "2")), '{"a": 2}');
const known = { nodes: ["n"], streams: ["s"], programs: ["p"] };
for (const [path, names] of [
  [["streams", 0, "from"], ["n"]],
  [["streams", 0, "path", 2], ["n"]],
  [["require", 0, "stream"], ["s"]],
  [["script", 0, "program"], ["p"]],
  [["clocks", "oscillator", "from"], []],
  [["name"], []],
])
  assert.deepEqual(namesAt(path, known), names, path.join("/"));

let scenarios = 0;
const walk = (path) =>
  readdirSync(path, { withFileTypes: true }).flatMap((each) =>
    each.isDirectory() ? walk(join(path, each.name)) : each.name.endsWith(".json") ? [join(path, each.name)] : [],
  );
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
  assert.deepEqual(
    read(applied(node, [withoutNode(node, "valve").edit])),
    expected.network.nodes && before.network.nodes ? before : { ...before, network: { ...before.network, nodes: {} } },
    file,
  );
  for (const name of Object.keys(before.network.nodes ?? {})) {
    const after = read(applied(text, [withoutNode(text, name).edit]));
    assert.ok(!(name in after.network.nodes), `${file}: ${name}`);
    const ends = (link) => link.ends.map((end) => end.replace(/:\d+$/, ""));
    assert.deepEqual(
      after.network.links ?? [],
      (before.network.links ?? []).filter((link) => !ends(link).includes(name)),
      `${file}: ${name}`,
    );
  }
}
assert.ok(scenarios > 50, `${scenarios} scenarios`);
