// SPDX-License-Identifier: Apache-2.0
// The page of takt studio in a real browser, by keyboard: from an edit to a verdict, from a frame to its explanation, and each of the views.
//
//   page_test.mjs TAKT SOURCE [FOLDER FOR SCREENSHOTS]
//
// It tells how long the frames of a pan over a million frames took; on a machine with other work that says nothing, so it is not asserted.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync } from "node:fs";
import { copyFile, mkdir, mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [takt, source, pictures] = process.argv.slice(2);
const driver = join(source, "build/studio/node_modules/puppeteer-core/lib/esm/puppeteer/puppeteer-core.js");
const chromium = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find((path) =>
  existsSync(path),
);
if (!existsSync(driver) || chromium === undefined) {
  console.log("no browser here: the page is not looked at");
  process.exit(77);
}
const puppeteer = (await import(pathToFileURL(driver).href)).default;

const folder = await mkdtemp(join(tmpdir(), "takt-studio-"));
const file = join(folder, "plant.json");
await copyFile(join(source, "scenarios/tsn/gates-on-a-line.json"), file);
await mkdir(join(folder, "studies"));
const link = JSON.parse(
  (await readFile(join(source, "scenarios/direct-link.json"), "utf8")).replace(/^\s*\/\/.*$/gm, ""),
);
await writeFile(
  join(folder, "studies/cycle.json"),
  JSON.stringify({
    name: "cycle",
    scenario: link,
    factors: [{ name: "cycle", set: ["/programs/0/cycle"], values: ["200us", "400us", "1ms"] }],
    replications: 2,
    measures: [{ name: "latency", of: "latency.max", unit: "us" }],
  }),
);
const open = async (path) => {
  const studio = spawn(takt, ["studio", path]);
  const address = await new Promise((done, fail) => {
    studio.stdout.once("data", (line) => done(String(line).trim()));
    studio.once("exit", (status) => fail(new Error(`takt studio ended with ${status}`)));
  });
  return { studio, address };
};
let { studio, address } = await open(file);
const browser = await puppeteer.launch({
  timeout: 180_000,
  executablePath: chromium,
  headless: true,
  args: [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
  ],
});
let failed = true;
const page = await browser.newPage();
page.setDefaultTimeout(180_000);
const look = async (name) => pictures && (await page.screenshot({ path: join(pictures, `${name}.png`) }));
try {
  await page.setViewport({ width: 1400, height: 1000 });
  const complaints = [];
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
  const text = (id) => page.$eval(`#${id}`, (element) => element.textContent);
  const until = (what, ...values) => page.waitForFunction(what, { timeout: 120_000 }, ...values);
  const done = () => until(() => document.querySelector("#stage").textContent === "done");

  await page.goto(address);
  await done();
  assert.match(await text("verdict"), /after \d+ runs/);
  assert.equal(await page.$eval("#requirements tbody td", (each) => each.textContent), "undecided");
  // At the widths of laptops every figure is in sight, of which the bound is the one that counts.
  for (const width of [1280, 1366, 1440, 1536]) {
    await page.setViewport({ width, height: 800 });
    const hidden = await page.$$eval(
      "#requirements th, #requirements tbody tr:first-child td:nth-child(n + 3)",
      (cells) =>
        cells
          .filter((each) => each.getBoundingClientRect().top < innerHeight)
          .filter((each) => {
            const box = each.getBoundingClientRect();
            return [box.left + 2, box.right - 2].some(
              (x) => !each.contains(document.elementFromPoint(x, (box.top + box.bottom) / 2)),
            );
          })
          .map((each) => each.textContent),
    );
    assert.deepEqual(hidden, [], `at ${width} px`);
    await look(`findings-${width}`);
  }
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: "dark" }]);
  await look("findings-dark");
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: "light" }]);
  await page.setViewport({ width: 1400, height: 1000 });
  assert.match(
    await page.$eval("#requirements .legend", (each) => each.textContent),
    /simulated.*worst found.*at most.*limit/,
  );
  assert.match(
    await page.$eval("#requirements tbody", (each) => each.textContent),
    /control latency/,
    "tightest first",
  );
  await page.type("#requirement-filter", "camera");
  assert.equal(await page.$$eval("#requirements tbody", (all) => all.length), 2);
  await page.$eval("#requirement-filter", (input) => ((input.value = ""), input.dispatchEvent(new Event("input"))));
  await page.select("#requirement-order", "text");
  assert.match(await page.$eval("#requirements tbody", (each) => each.textContent), /stream camera drops/);
  await page.select("#requirement-order", "tightness");

  // The splitter, by keyboard.
  const widthOf = (id) => page.$eval(`#${id}`, (each) => each.clientWidth);
  const wide = await widthOf("views");
  await page.focus("#splitter");
  await page.keyboard.press("ArrowLeft");
  assert.ok((await widthOf("views")) > wide);
  await page.keyboard.press("ArrowRight");

  // From a requirement to its line and its stream's path, from the cursor to the map, from a link to the timeline.
  const lineOf = () => page.$eval(".cm-activeLine", (each) => each.textContent);
  await page.click("#requirements tbody a");
  assert.match(await lineOf(), /"stream": "control", "latency"/);
  await until(() => document.querySelector("#network-path").textContent === "control: h1 to sw1 to sw2 to sw3 to h3");
  assert.equal(await page.$$eval("#network .link.is-lit", (all) => all.length), 4);
  assert.equal(
    await page.$$eval("#requirements tbody.is-chosen", (all) => all.length),
    2,
    "both of that item of the text",
  );
  await page.keyboard.down("Control");
  await page.keyboard.press("Home");
  await page.keyboard.up("Control");
  for (let n = 0; n < 14; ++n) await page.keyboard.press("ArrowDown");
  for (let n = 0; n < 10; ++n) await page.keyboard.press("ArrowRight");
  await until(() => document.querySelector("#network-path").textContent.startsWith("camera: h2 to sw2"));
  await page.$eval('[data-link="sw2 sw3"], [data-link="sw3 sw2"]', (each) => each.focus());
  await page.keyboard.press("Enter");
  await until(() => document.querySelector("#timeline-filter").value === "sw2:1 to sw3 | sw3:0 to sw2");
  await page.$eval("#timeline-filter", (input) => ((input.value = ""), input.dispatchEvent(new Event("input"))));
  await page.click("[data-view=findings]");
  assert.match(await text("requirements"), /stream control latency at most 10us/);
  assert.equal(
    await page.$$eval(
      "#network svg .mark title",
      (all) => all.filter((each) => /, a (host|switch)$/.test(each.textContent)).length,
    ),
    6,
    "three hosts, three switches",
  );
  assert.match(await text("streams"), /camera/);
  await look("done");

  // A mistake is told with its place; the keyboard leads there and mends it.
  await page.focus(".cm-content");
  const key = async (...keys) => {
    for (const each of keys) await page.keyboard.press(each);
  };
  const find = async (word) => {
    await page.keyboard.down("Control");
    await page.keyboard.press("f");
    await page.keyboard.up("Control");
    await page.waitForSelector(".cm-search input[name=search]");
    await page.$eval(".cm-search input[name=search]", (input) => (input.value = ""));
    await page.type(".cm-search input[name=search]", word);
    await key("Enter", "Escape");
  };
  await find('"10us"');
  await page.keyboard.type('"10parsec"');
  await until(() => document.querySelector("#verdict").textContent === "1 mistake");
  assert.match(await text("mistakes"), /10parsec/);
  assert.equal(await text("requirements"), "", "figures of an older text do not stand beside a newer one");
  assert.match(await text("notice"), /not saved/);
  await look("mistake");
  await page.focus("#mistakes button");
  await key("Enter");
  assert.ok(
    await page.$eval(
      ".cm-content",
      (element) => element.contains(document.activeElement) || element === document.activeElement,
    ),
    "the editor has the focus again",
  );
  await find('"10parsec"');
  await page.keyboard.type('"1us"');
  await until(() => /refuted/.test(document.querySelector("#verdict").textContent));
  assert.match(await text("requirements"), /refuted.*stream control latency at most 1us/);
  await look("refuted");

  // Keys are completed from the schema.
  await find('"duration"');
  await key("ArrowLeft");
  await page.keyboard.type('"war');
  await page.waitForSelector(".cm-tooltip-autocomplete", { timeout: 60_000 });
  assert.match(await page.$eval(".cm-tooltip-autocomplete", (element) => element.textContent), /warm_up/);
  await look("completion");
  await key("Escape");
  await key(...Array(4).fill("Backspace")); // with the quote goes the one that the editor has closed it by

  // Names are completed from the text and from what generators make; a comment is no mistake of the grammar.
  await find('"stream": "camera"');
  await page.keyboard.type('"stream": "co');
  await page.waitForSelector(".cm-tooltip-autocomplete", { timeout: 60_000 });
  assert.match(await page.$eval(".cm-tooltip-autocomplete", (element) => element.textContent), /"control"/);
  await new Promise((next) => setTimeout(next, 300)); // a list that has just come takes no key yet
  await key("Enter");
  await until(() =>
    document.querySelector(".cm-content").textContent.includes('"stream": "control", "latency": "400us"'),
  );
  await find('"stream": "control", "latency": "400us"');
  await page.keyboard.type('"stream": "camera", "latency": "400us"');
  await key("Escape");
  assert.match(await page.$eval(".cm-line .comment", (element) => element.textContent), /^\/\/ Gates along a line/);

  // Saved by the keyboard, whole.
  await page.keyboard.down("Control");
  await page.keyboard.press("s");
  await page.keyboard.up("Control");
  await until(() => document.querySelector("#notice").textContent === "");
  assert.match(await readFile(file, "utf8"), /"latency": *"1us"/);

  // The timeline: everything at once, nearer, a frame, and why it took so long.
  const press = async (name, times) => {
    for (let n = 0; n < times; ++n) await page.keyboard.press(name);
  };
  const view = (name) => page.click(`[data-view=${name}]`);
  await done();
  await page.focus("[data-view=findings]");
  await key("ArrowRight");
  await until(() => /frames on ports, 0 ps to 3 s/.test(document.querySelector("#timeline-notice").textContent));
  await look("timeline");
  await page.focus("#timeline-canvas");
  await press("+", 25);
  await key("n");
  await until(() => /transmission/.test(document.querySelector("#timeline-why").textContent));
  assert.match(await text("timeline-why"), /stream (control|camera): frame \d+/);
  const shares = await page.$$eval("#timeline-why td:nth-child(4)", (all) =>
    all.map((each) => Number.parseFloat(each.textContent)),
  );
  assert.ok(
    Math.abs(shares.reduce((sum, each) => sum + each, 0) - 100) < 0.1 * shares.length,
    "the parts are all of it",
  );
  await look("explanation");
  await key("Escape");
  assert.equal(await text("timeline-why"), "");

  // From what was found to that run, at that instant.
  await view("findings");
  await page.focus("#requirements td button");
  await key("Enter");
  await until(() => /the worst run that was found/.test(document.querySelector("#timeline-why").textContent));
  assert.match(await page.$eval("#timeline-run", (select) => select.selectedOptions[0].textContent), /^worst found: /);
  await look("worst");

  // Edits by hand: into the text, and back into the picture; what is dragged stands beside the scenario.
  await view("findings");
  await page.$eval("#edit", (details) => (details.open = true));
  const form = (n) => page.$(`#edits form:nth-of-type(${n})`);
  await (await (await form(1)).$("input")).type("valve");
  await key("Enter");
  await until(() => /valve is added/.test(document.querySelector("#edit-notice").textContent));
  const [from, to] = await (await form(2)).$$("input");
  await from.type("valve");
  await to.type("sw1");
  await key("Enter");
  await until(() => document.querySelector("[data-node=valve]") !== null);
  assert.match(await page.$eval(".cm-content", (element) => element.textContent), /"valve": \{"kind": "host"\}/);
  await done();
  const focusValve = () => page.$eval("[data-node=valve]", (node) => node.focus());
  await focusValve();
  await press("ArrowRight", 5);
  const layout = async () => JSON.parse(await readFile(`${file}.layout`, "utf8").catch(() => "{}"));
  for (let tries = 0; tries < 1200 && !(await layout()).nodes?.valve; ++tries)
    await new Promise((next) => setTimeout(next, 50));
  assert.equal((await layout()).nodes.valve.length, 2);
  await look("edited");

  // The saved file and the text side by side.
  await view("compare");
  await page.focus("#compare-actions button:last-child");
  await key("Enter");
  await until(
    () =>
      /Figures/.test(document.querySelector("#compare-found").textContent) &&
      /Requirements/.test(document.querySelector("#compare-found").textContent),
  );
  await look("compare");
  await view("findings");
  await focusValve();
  await key("Delete");
  await until(() => document.querySelector("[data-node=valve]") === null);

  // A study fills in.
  await view("studies");
  await until(() => document.querySelector("#study-file").options.length === 1);
  await page.focus("#study-actions button");
  await key("Enter");
  await until(() => document.querySelector("#study-notice").textContent === "6 of 6 points; done");
  await until(() => document.querySelector("#study-report").srcdoc.includes("cycle"));
  await look("study");

  // On a phone, and in the dark.
  await page.setViewport({ width: 390, height: 800 });
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: "dark" }]);
  for (const name of ["findings", "timeline", "gates", "explorer", "compare", "studies"]) {
    await view(name);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= 391), `nothing sticks out of ${name}`);
    await look(`phone-${name}`);
  }

  // The engine dies: the text stays, and the page says so.
  studio.kill("SIGKILL");
  await until(() => document.querySelector("#stage").textContent === "the engine does not answer");
  assert.ok(await page.$eval(".cm-content", (element) => element.textContent.length > 100));

  // Counter-examples step by step, and a million frames on one page.
  const paper = join(folder, "paper.json");
  await writeFile(
    paper,
    (await readFile(join(source, "scenarios/robot-arm.json"), "utf8")).replace(
      '"master"',
      '"variant": "paper", "master"',
    ),
  );
  ({ studio, address } = await open(paper));
  await page.setViewport({ width: 1400, height: 1000 });
  page.on("dialog", (dialog) => dialog.accept()); // what was not saved
  await page.goto(address);
  await until(() => document.querySelector("#streams").textContent !== "");
  await view("explorer");
  await page.focus("#explore-actions button");
  await key("Enter");
  await until(() => document.querySelector(".steps") !== null);
  assert.match(await text("explore-found"), /step 0 of \d+/);
  await page.focus("#explore-found .steps button");
  await key("End");
  assert.match(await text("explore-found"), /violates S\d/);
  await look("explorer");
  await view("timeline");
  await until(() => /frames on ports/.test(document.querySelector("#timeline-notice").textContent));
  assert.ok(
    Number((await text("timeline-notice")).replace(/,/g, "").split(" ")[0]) > 1e6,
    await text("timeline-notice"),
  );
  for (const zoom of [0, 8, 8, 8]) {
    await page.focus("#timeline-canvas");
    await press("+", zoom);
    const times = page.evaluate(
      () =>
        new Promise((tell) => {
          const seen = [];
          const next = (now) =>
            seen.push(now) < 120
              ? requestAnimationFrame(next)
              : tell(
                  seen
                    .slice(1)
                    .map((each, n) => each - seen[n])
                    .sort((a, b) => a - b),
                );
          requestAnimationFrame(next);
        }),
    );
    await press("ArrowRight", 80);
    const sorted = await times;
    console.log(
      `${await text("timeline-notice")}: frames of the pan: median ${sorted[60].toFixed(1)} ms, 90 % ${sorted[107].toFixed(1)} ms`,
    );
  }
  assert.deepEqual(
    complaints.filter((each) => !/ERR_|Failed to load resource/.test(each)),
    [],
  );
  failed = false;
} finally {
  if (failed) await look("failed").catch(() => undefined);
  await browser.close();
  studio.kill("SIGKILL");
  await rm(folder, { recursive: true, force: true });
}
process.exit(failed ? 1 : 0);
