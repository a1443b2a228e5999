// The page of takt studio: a scenario on the left, what is known of it on the right.
import { engine, type Findings } from "./api";
import { CompareView } from "./compare";
import { byId } from "./dom";
import { Editor } from "./editor";
import { ExplorerView } from "./explorer";
import { show } from "./findings";
import { NetworkView } from "./network";
import { RunView } from "./run_view";
import { StudiesView } from "./studies";
import { Tabs } from "./tabs";

const pause = (ms: number) => new Promise((done) => setTimeout(done, ms));
const text = (id: string, words: string) => (byId(id).textContent = words);

async function begin(): Promise<void> {
  const [schema, file] = await Promise.all([engine.schema(), engine.file()]);
  let revision = Date.now();   // a page that was loaded anew is ahead of the one before
  let shown = "";              // what the file holds
  let typed = 0;
  let found: Findings | null = null;

  const note = () => text("notice", editor.text() === shown ? "" : "not saved");
  const tell = async () => {
    const mine = ++revision;
    try {
      const answer = await engine.tell(mine, editor.text());
      if (answer.problem !== "") text("notice", `the draft cannot be kept: ${answer.problem}`);
    } catch (problem) {
      text("notice", `the engine does not answer; the text stays here (${(problem as Error).message})`);
    }
  };
  const save = async () => {
    const content = editor.text();
    try {
      const answer = await engine.save(content);
      if (answer.problem !== "") return void text("notice", answer.problem);
      shown = content;
      note();
    } catch (problem) {
      text("notice", `not saved: ${(problem as Error).message}`);
    }
  };
  const editor = new Editor(
    byId("editor"),
    schema,
    () => {
      note();
      clearTimeout(typed);
      typed = window.setTimeout(() => void tell(), 150);
    },
    () => void save(),
  );
  byId("save").addEventListener("click", () => void save());
  window.addEventListener("beforeunload", (event) => {
    if (editor.text() !== shown) event.preventDefault();
  });

  const network = new NetworkView(editor);
  const run = new RunView();
  const explorer = new ExplorerView(() => editor.text());
  const compare = new CompareView(
    () => shown,
    () => ({ text: editor.text(), proofs: found?.revision === revision ? found.proofs : null }),
  );
  const studies = new StudiesView();
  const tabs: Tabs = new Tabs((view) => {
    run.setSeen(view === "timeline");
    if (view === "studies") void studies.open().catch(() => undefined);
    if (view === "explorer") explorer.open();
  });
  const look = (requirement: number) => {
    run.look(requirement);
    tabs.open("timeline");
  };
  const hide = () => {
    const isWide = document.querySelector("main")?.classList.toggle("is-wide") ?? false;
    byId("wide").setAttribute("aria-pressed", String(isWide));
    text("wide", isWide ? "Show the text" : "Hide the text");
  };
  byId("wide").addEventListener("click", hide);
  window.addEventListener("keydown", (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.key !== "e") return;
    event.preventDefault();
    hide();
  });

  text("path", file.path);
  if (file.problem !== "") text("notice", file.problem);
  shown = file.saved ?? "";
  editor.set(file.draft ?? shown);
  clearTimeout(typed);   // it is told below
  note();
  if (file.draft !== null && file.draft !== shown) text("notice", "what was typed last, not saved");
  await tell();

  for (let version = 0; ; ) {
    try {
      const news = await engine.findings(version);
      version = news.version;
      if (news.revision === 0 && news.trouble === "") continue;
      found = news;
      show(news, (each) => editor.goTo(each), look);
      if (news.network) network.show(news.network);
      run.know(news);
      compare.know();
      if (news.revision === revision) editor.mark(news.diagnostics?.diagnostics ?? []);
    } catch {
      text("stage", "the engine does not answer");
      await pause(1000);
    }
  }
}

begin().catch((problem: Error) => text("notice", problem.message));
