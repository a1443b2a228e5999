// The page of takt studio: a scenario on the left, what is known of it on the right.
import { engine } from "./api";
import { Editor } from "./editor";
import { show } from "./findings";

const pause = (ms: number) => new Promise((done) => setTimeout(done, ms));
const text = (id: string, words: string) => {
  const element = document.getElementById(id);
  if (element) element.textContent = words;
};

async function begin(): Promise<void> {
  const [schema, file] = await Promise.all([engine.schema(), engine.file()]);
  let revision = Date.now();   // a page that was loaded anew is ahead of the one before
  let shown = "";              // what the file holds
  let typed = 0;

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
      if (answer.problem !== "") return text("notice", answer.problem);
      shown = content;
      note();
    } catch (problem) {
      text("notice", `not saved: ${(problem as Error).message}`);
    }
  };
  const editor = new Editor(
    document.getElementById("editor") as HTMLElement,
    schema,
    () => {
      note();
      clearTimeout(typed);
      typed = window.setTimeout(() => void tell(), 150);
    },
    () => void save(),
  );
  document.getElementById("save")?.addEventListener("click", () => void save());
  window.addEventListener("beforeunload", (event) => {
    if (editor.text() !== shown) event.preventDefault();
  });

  text("path", file.path);
  if (file.problem !== "") text("notice", file.problem);
  shown = file.saved ?? "";
  editor.set(file.draft ?? shown);
  note();
  if (file.draft !== null && file.draft !== shown) text("notice", "what was typed last, not saved");
  await tell();

  for (let version = 0; ; ) {
    try {
      const found = await engine.findings(version);
      version = found.version;
      if (found.revision === 0 && found.trouble === "") continue;
      show(found, (each) => editor.goTo(each));
      if (found.revision === revision) editor.mark(found.diagnostics?.diagnostics ?? []);
    } catch {
      text("stage", "the engine does not answer");
      await pause(1000);
    }
  }
}

begin().catch((problem: Error) => text("notice", problem.message));
