// SPDX-License-Identifier: Apache-2.0
// The page of takt studio: a scenario on the left, what is known of it on the right.
import { engine, type Findings } from "./api";
import { CompareView } from "./compare";
import { byId } from "./dom";
import { readText, type Path } from "./edits";
import { Editor } from "./editor";
import { ExplorerView } from "./explorer";
import { show } from "./findings";
import { GatesView } from "./gates_view";
import { Grips } from "./grips";
import type { Names } from "./names";
import { NetworkView } from "./network";
import { RequirementsView } from "./requirements";
import { RunView } from "./run_view";
import { Session } from "./session";
import { Slider } from "./slider";
import { addSplitter } from "./splitter";
import { StudiesView } from "./studies";
import { Tabs } from "./tabs";

const pause = (ms: number) => new Promise((done) => setTimeout(done, ms));
const text = (id: string, words: string) => (byId(id).textContent = words);
const unique = (names: string[]) => [...new Set(names.filter((each) => each !== ""))];

/// What a text names, as far as it can be read.
interface Named {
  network?: { nodes?: Record<string, unknown>; links?: { ends?: string[] }[] };
  streams?: { name?: string; stream?: string }[];
  programs?: { name?: string }[];
  require?: { stream?: string }[];
}

async function begin(): Promise<void> {
  const schema = await engine.schema();
  let found: Findings | null = null;
  let pointed = 0;

  const named = (): Named => (readText(editor.text()) ?? {}) as Named;
  const names = (): Names => {
    const now = named();
    const list = (of: unknown): { name?: string }[] => (Array.isArray(of) ? of : []);
    return {
      nodes: unique([...Object.keys(now.network?.nodes ?? {}), ...network.nodes()]),
      streams: unique([
        ...list(now.streams).map((each) => each?.name ?? ""),
        ...Object.keys(found?.result?.streams ?? {}),
      ]),
      programs: unique(list(now.programs).map((each) => each?.name ?? "")),
    };
  };
  /// The cursor is in a stream, a node, a link or a requirement: so it is on the map.
  const largestLinked = 2_000_000; // characters: a greater text is not read anew at each step of the cursor
  const point = (path: Path) => {
    slider.know(path);
    const [part, second, third] = path;
    if (part === undefined || editor.view.state.doc.length > largestLinked) return;
    const now = named();
    requirements.mark(part === "require" && typeof second === "number" ? second : -1);
    if (part === "streams" && typeof second === "number") network.light(now.streams?.[second]?.name ?? "");
    else if (part === "require" && typeof second === "number") network.light(now.require?.[second]?.stream ?? "");
    else if (part === "network" && second === "nodes" && typeof third === "string") network.light("", [third]);
    else if (part === "network" && second === "links" && typeof third === "number")
      network.light(
        "",
        (now.network?.links?.[third]?.ends ?? []).map((each) => String(each).replace(/:\d+$/, "")),
      );
  };

  const editor: Editor = new Editor(byId("text"), schema, names, {
    changed: (isUnderTheHand) => session.changed(isUnderTheHand),
    moved: (path) => {
      clearTimeout(pointed);
      pointed = window.setTimeout(() => point(path), 60); // once for a key that is held
    },
    save: () => void session.save(),
  });
  const slider: Slider = new Slider(editor);
  const run = new RunView();
  const explorer = new ExplorerView(() => editor.text());
  const compare = new CompareView(
    () => session.shown,
    () => ({ text: editor.text(), proofs: found && session.owns(found) ? found.proofs : null }),
  );
  const studies = new StudiesView();
  const session: Session = new Session(editor, (theirs) => {
    tabs.open("compare");
    compare.beside(theirs, "A is the file as it is now");
  });
  const network: NetworkView = new NetworkView(editor, (a, b) => {
    tabs.open("timeline");
    run.lookAt([[a, b]]);
  });
  const goToStream = (name: string) => {
    network.light(name);
    const n = (named().streams ?? []).findIndex((each) => each?.name === name);
    if (n < 0 || !editor.goToPath(["streams", n]))
      text("notice", `${name} does not stand in the text: something else makes it`);
  };
  const requirements: RequirementsView = new RequirementsView({
    text: (entry) => void editor.goToPath(["require", entry]),
    worst: (number) => {
      run.look(number);
      tabs.open("timeline");
    },
    choose: (subject) => network.light(subject),
  });
  const gates = new GatesView(editor);
  const tabs: Tabs = new Tabs((view) => {
    run.setSeen(view === "timeline");
    gates.setSeen(view === "gates");
    if (view === "studies") void studies.open().catch(() => undefined);
    if (view === "explorer") explorer.open();
  });
  run.timeline.grips = new Grips(editor);
  run.timeline.chose = (stream) => network.light(stream);
  const hide = () => {
    const isWide = document.querySelector("main")?.classList.toggle("is-wide") ?? false;
    byId("wide").setAttribute("aria-pressed", String(isWide));
    text("wide", isWide ? "Show the text" : "Hide the text");
  };
  byId("save").addEventListener("click", () => void session.save());
  byId("wide").addEventListener("click", hide);
  window.addEventListener("keydown", (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.key !== "e") return;
    event.preventDefault();
    hide();
  });
  addSplitter();
  await session.open();

  for (let version = 0, file = ""; ;) {
    try {
      const news = await engine.findings(version, file);
      version = news.version;
      file = news.file;
      if (news.revision === 0 && news.trouble === "") {
        session.know(news);
        continue;
      }
      found = news;
      show(news, (each) => editor.goTo(each), goToStream);
      requirements.show(news, editor.isDragging());
      if (news.network) network.show(news.network);
      gates.know();
      session.know(news);
      run.know(news, editor.isDragging() || news.stage === "sketched");
      compare.know();
      if (session.owns(news)) editor.mark(news.diagnostics?.diagnostics ?? []);
    } catch (problem) {
      session.lose(problem);
      version = 0; // of the engine that comes next
      await pause(500);
    }
  }
}

begin().catch((problem: Error) => text("notice", problem.message));
