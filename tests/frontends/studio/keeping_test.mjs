// SPDX-License-Identifier: Apache-2.0
// The page loses no text, and shows nothing beside a text to which it does not belong: undo, drafts, a file that changes, two pages, an engine that dies.
//
//   keeping_test.mjs TAKT SOURCE [FOLDER FOR SCREENSHOTS]
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { existsSync } from "node:fs";
import { copyFile, mkdir, mkdtemp, readFile, rm, stat, writeFile } from "node:fs/promises";
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
const folder = await mkdtemp(join(tmpdir(), "takt-keeping-"));
const file = join(folder, "plant.json");
await copyFile(join(source, "scenarios/robot-arm.json"), file);
await mkdir(join(folder, "run"), { mode: 0o700 });
const start = async () => {
  const studio = spawn(takt, ["studio", file], { env: { ...process.env, XDG_RUNTIME_DIR: join(folder, "run") } });
  const address = await new Promise((done, fail) => {
    studio.stdout.once("data", (line) => done(String(line).trim()));
    studio.once("exit", (status) => fail(new Error(`takt studio ended with ${status}`)));
  });
  return { studio, address };
};
let { studio, address } = await start();
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
  ],
});
const questions = [];
let accepts = true;
const open = async () => {
  const page = await browser.newPage();
  page.setDefaultTimeout(180_000);
  await page.setViewport({ width: 1366, height: 800 });
  page.on("dialog", (dialog) => {
    questions.push(dialog.message());
    void (accepts ? dialog.accept() : dialog.dismiss());
  });
  await page.goto(address);
  await page.waitForFunction(() => document.querySelector("#streams").textContent !== "", { timeout: 120_000 });
  return page;
};
// A page behind another one draws no frames: it is asked by the clock.
const until = (page, what, ...values) =>
  page.waitForFunction(what, { timeout: 60_000, polling: 50 }, ...values);
const ctrl = async (page, key) => {
  await page.bringToFront();
  await page.focus(".cm-content");
  await page.keyboard.down("Control");
  await page.keyboard.press(key);
  await page.keyboard.up("Control");
};
const typed = async (page, words) => (await ctrl(page, "Home"), await page.keyboard.type(words));
const saves = async (page) => (
  await ctrl(page, "s"),
  await until(page, () => document.querySelector("#notice").textContent === "")
);
const drafted = async (words) => {
  for (let tries = 0; tries < 1200; ++tries) {
    if ((await readFile(`${file}.draft`, "utf8").catch(() => "")).includes(words)) return;
    await new Promise((next) => setTimeout(next, 50));
  }
  assert.fail(`no draft has ${words}`);
};
const shown = (page, words) =>
  until(page, (each) => document.querySelector(".cm-content").textContent.includes(each), words);
const choose = (page, words) =>
  page.$$eval("#conflict button", (all, name) => all.find((each) => each.textContent === name).click(), words);
const saved = () => readFile(file, "utf8");
let failed = true;
let page;
try {
  page = await open();
  const was = await saved();

  // Loading is no step of the history.
  await ctrl(page, "z");
  assert.ok(
    !(await page.$eval(".cm-content", (each) => each.textContent)).startsWith(" ") &&
      (await page.$eval(".cm-content", (each) => each.textContent)).length > 100,
  );
  await saves(page);
  assert.equal(await saved(), was);

  // Another program changes the file: a text that was as the file follows it.
  await writeFile(file, was.replace('"seed": 1', '"seed": 77'));
  await shown(page, '"seed": 77');
  await typed(page, "// a\n");
  await saves(page);
  assert.match(await saved(), /^\/\/ a\n[^]*"seed": 77/);

  // Both have changed: nothing is written until one is chosen.
  await typed(page, "// mine\n");
  await writeFile(file, was.replace('"seed": 1', '"seed": 78'));
  await until(page, () => !document.querySelector("#conflict").hidden);
  if (pictures) await page.screenshot({ path: join(pictures, "conflict.png") });
  await ctrl(page, "s");
  await until(page, () => /Not saved/.test(document.querySelector("#conflict-text").textContent));
  assert.match(await saved(), /"seed": 78/);
  assert.doesNotMatch(await saved(), /mine/);
  await choose(page, "Both in Compare");
  await until(page, () => !document.querySelector("#compare").hidden);
  await choose(page, "Take theirs");
  await shown(page, '"seed": 78');
  await ctrl(page, "z");
  await shown(page, "// mine"); // and one step back brings the other
  await typed(page, "// again\n");
  await writeFile(file, was.replace('"seed": 1', '"seed": 79'));
  await until(page, () => !document.querySelector("#conflict").hidden);
  await choose(page, "Keep mine");
  await saves(page);
  assert.match(await saved(), /^\/\/ again\n\/\/ mine/);

  // Two pages: neither writes over the other, and one whose text is not the engine's says so.
  const second = await open();
  await typed(second, "// second\n");
  await until(
    page,
    () => document.querySelector("#views").classList.contains("is-stale") && !document.querySelector("#stale").hidden,
  );
  assert.match(await page.$eval("#stale", (each) => each.textContent), /text of another page/);
  await page.bringToFront();
  if (pictures) await page.screenshot({ path: join(pictures, "stale.png") });
  await typed(page, "// first\n");
  await until(page, () => !document.querySelector("#views").classList.contains("is-stale"));
  await saves(page);
  await until(second, () => !document.querySelector("#conflict").hidden);
  await ctrl(second, "s");
  await until(second, () => /Not saved/.test(document.querySelector("#conflict-text").textContent));
  assert.match(await saved(), /^\/\/ first/);
  await second.close({ runBeforeUnload: false });

  // What was not saved survives a reload, and a step back too many.
  await typed(page, "// an hour of work\n");
  await drafted("// an hour of work");
  await page.reload();
  await shown(page, "// an hour of work");
  await ctrl(page, "z");
  await ctrl(page, "z");
  await shown(page, "// an hour of work");
  assert.ok((await stat(`${file}.draft`)).size > was.length);
  // The file was changed while nobody had it open.
  await page.goto("about:blank");
  await writeFile(file, was.replace('"seed": 1', '"seed": 80'));
  page = await open();
  await until(page, () => !document.querySelector("#conflict").hidden);
  await shown(page, "// an hour of work");
  await choose(page, "Keep mine");
  await saves(page);
  assert.match(await saved(), /^\/\/ an hour of work/);

  // An empty text over a full one asks.
  await ctrl(page, "a");
  await page.keyboard.press("Backspace");
  accepts = false;
  const before = questions.length;
  await ctrl(page, "s");
  for (let tries = 0; tries < 1200 && questions.length === before; ++tries)
    await new Promise((next) => setTimeout(next, 50));
  assert.match(questions.at(-1), /empty/);
  assert.match(await saved(), /^\/\/ an hour of work/);
  await ctrl(page, "z");
  await shown(page, "// an hour of work");
  accepts = true;

  // The engine dies; the page finds the one that comes next, and saves.
  await typed(page, "// after the crash\n");
  studio.kill("SIGKILL");
  await until(page, () => document.querySelector("#stage").textContent === "the engine does not answer");
  await typed(page, "// while it was gone\n");
  ({ studio, address } = await start());
  await until(page, () => document.querySelector("#stage").textContent === "done");
  await until(page, () => !document.querySelector("#views").classList.contains("is-stale"));
  await saves(page);
  assert.match(await saved(), /^\/\/ while it was gone\n\/\/ after the crash\n/);

  // A text that is too large says so, and is not lost.
  await page.evaluate(() => navigator.clipboard?.writeText("").catch(() => undefined));
  await writeFile(file, " ".repeat(8_000_001));
  await until(page, () =>
    /has 8.1 MB: takt studio takes texts of at most 8 MB/.test(document.querySelector("#notice").textContent),
  );
  await shown(page, "// after the crash");
  failed = false;
} finally {
  if (failed && pictures && page)
    await page.screenshot({ path: join(pictures, "keeping-failed.png") }).catch(() => undefined);
  await browser.close();
  studio.kill("SIGKILL");
  await rm(folder, { recursive: true, force: true });
}
process.exit(failed ? 1 : 0);
