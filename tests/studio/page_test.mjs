// The page of takt studio in a real browser, by keyboard: from an edit to a verdict.
//
//   page_test.mjs TAKT SOURCE [FOLDER FOR SCREENSHOTS]
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync } from "node:fs";
import { copyFile, mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [takt, source, pictures] = process.argv.slice(2);
const driver = join(source, "build/studio/node_modules/puppeteer-core/lib/esm/puppeteer/puppeteer-core.js");
const chromium = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find((path) => existsSync(path));
if (!existsSync(driver) || chromium === undefined) {
  console.log("no browser here: the page is not looked at");
  process.exit(77);
}
const puppeteer = (await import(pathToFileURL(driver).href)).default;

const folder = await mkdtemp(join(tmpdir(), "takt-studio-"));
const file = join(folder, "plant.json");
await copyFile(join(source, "scenarios/tsn/gates-on-a-line.json"), file);
const studio = spawn(takt, ["studio", file]);
const address = await new Promise((done, fail) => {
  studio.stdout.once("data", (line) => done(String(line).trim()));
  studio.once("exit", (status) => fail(new Error(`takt studio ended with ${status}`)));
});
const browser = await puppeteer.launch({
  executablePath: chromium,
  headless: true,
  args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--disable-dev-shm-usage", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"],
});
let failed = true;
try {
  const page = await browser.newPage();
  await page.setViewport({ width: 1400, height: 1000 });
  const complaints = [];
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
  const text = (id) => page.$eval(`#${id}`, (element) => element.textContent);
  const until = (what, ...values) => page.waitForFunction(what, { timeout: 120_000 }, ...values);
  const done = () => until(() => document.querySelector("#stage").textContent === "done");
  const look = async (name) => pictures && (await page.screenshot({ path: join(pictures, `${name}.png`) }));

  await page.goto(address);
  await done();
  assert.match(await text("verdict"), /after \d+ runs/);
  assert.match(await text("requirements"), /stream control latency at most 10us/);
  assert.equal(await page.$$eval("#network svg .mark title", (all) => all.filter((each) => /, a (host|switch)$/.test(each.textContent)).length), 6, "three hosts, three switches");
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
  assert.ok(await page.$eval(".cm-content", (element) => element.contains(document.activeElement) || element === document.activeElement), "the editor has the focus again");
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
  await key(...Array(4).fill("Backspace"));   // with the quote goes the one that the editor has closed it by

  // Saved by the keyboard, whole.
  await page.keyboard.down("Control");
  await page.keyboard.press("s");
  await page.keyboard.up("Control");
  await until(() => document.querySelector("#notice").textContent === "");
  assert.match(await readFile(file, "utf8"), /"latency": *"1us"/);

  // On a phone, and in the dark.
  await page.setViewport({ width: 390, height: 800 });
  await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: "dark" }]);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= 391), "nothing sticks out");
  await look("phone");

  // The engine dies: the text stays, and the page says so.
  studio.kill("SIGKILL");
  await until(() => document.querySelector("#stage").textContent === "the engine does not answer");
  assert.ok(await page.$eval(".cm-content", (element) => element.textContent.length > 100));
  assert.deepEqual(complaints.filter((each) => !/ERR_|Failed to load resource/.test(each)), []);
  failed = false;
} finally {
  await browser.close();
  studio.kill("SIGKILL");
  await rm(folder, { recursive: true, force: true });
}
process.exit(failed ? 1 : 0);
