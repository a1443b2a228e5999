// SPDX-License-Identifier: Apache-2.0
// The life of the text between page, engine and file: what rests on which file, whose text the engine has, who has changed the file meanwhile.
import { EngineError, engine, type Findings } from "./api";
import { button, byId, element } from "./dom";
import type { Editor } from "./editor";

const mostOctets = 8_000_000; // of a text, as the engine takes it
const restTime = 150; // ms without a key before the engine is asked
const text = (id: string, words: string) => (byId(id).textContent = words);

/// A text that is too large, in words; nothing if it is not.
function excess(content: string): string {
  if (content.length * 3 <= mostOctets) return "";
  const octets = new TextEncoder().encode(content).length;
  return octets <= mostOctets
    ? ""
    : `the text has ${(octets / 1e6).toFixed(1)} MB, takt studio takes at most 8 MB: it is neither checked nor kept`;
}

export class Session {
  shown = ""; // what the file holds, as far as this page knows
  private base = ""; // its digest; the text rests on it
  private digest: string | null = null; // of the text, as the engine has it; null: it changed since
  private revision = Date.now(); // a page that was loaded anew is ahead of the one before
  private readonly mine = new Set<number>();
  private typed = 0;
  private theirs: { text: string; digest: string } | null = null; // a file that is another one than this text rests on
  private seenFile = ""; // the digest that was looked at last
  private isSaving = false;
  private isLost = false;

  constructor(
    private editor: Editor,
    private compare: (theirs: string) => void,
  ) {
    byId("conflict-actions").append(
      button(
        "Take theirs",
        () => this.takeTheirs(),
        "the text of the file comes into the editor; Ctrl+Z brings yours back",
      ),
      button("Keep mine", () => this.keepMine(), "the next save writes over the file"),
      button(
        "Both in Compare",
        () => this.theirs && this.compare(this.theirs.text),
        "the file as A beside the text that stands here",
      ),
    );
    byId("stale").append(
      element("span", ""),
      button("Find out of this text", () => void this.tell()),
    );
    window.addEventListener("beforeunload", (event) => {
      if (this.isChanged()) event.preventDefault();
    });
  }

  isChanged(): boolean {
    return this.editor.text() !== this.shown;
  }

  /// Whether findings are of the text that stands here.
  owns(found: Findings): boolean {
    return this.digest !== null && found.text === this.digest;
  }

  async open(): Promise<void> {
    const file = await engine.file();
    text("path", file.path);
    this.shown = file.saved ?? "";
    this.base = file.digest;
    this.seenFile = file.digest;
    const draft = file.draft !== null && file.draft !== file.saved ? file.draft : null;
    if (draft !== null && file.draft_is_older) {
      this.base = "";
      this.setTheirs(
        { text: this.shown, digest: file.digest },
        "The file was changed after what was typed here and not saved.",
      );
    }
    this.editor.load(draft ?? this.shown);
    clearTimeout(this.typed);
    this.note();
    if (draft !== null) text("notice", "what was typed last, not saved");
    if (file.problem !== "") text("notice", file.problem);
    await this.tell();
  }

  note(): void {
    text("notice", this.isChanged() ? "not saved" : "");
  }

  /// The text is another one. Under the hand it is worked at in part, at once.
  changed(isCoarse: boolean): void {
    this.digest = null;
    this.note();
    clearTimeout(this.typed);
    this.isToSketch = false;
    if (isCoarse) void this.sketch();
    else this.typed = window.setTimeout(() => void this.tell(), restTime);
  }

  private sketching = false;
  private isToSketch = false;
  /// One text at a time: what comes meanwhile is the next.
  private async sketch(): Promise<void> {
    this.isToSketch = true;
    if (this.sketching) return;
    this.sketching = true;
    while (this.isToSketch) {
      this.isToSketch = false;
      await this.tell(true);
      await this.shownNow();
    }
    this.sketching = false;
  }
  /// The run of what was told last is on the page, or it takes too long to wait for it.
  private seen: (() => void) | null = null;
  private shownNow(): Promise<void> {
    return new Promise((done) => {
      const late = window.setTimeout(done, 400);
      this.seen = () => (clearTimeout(late), done());
    });
  }

  private next(): number {
    this.mine.add(++this.revision);
    return this.revision;
  }

  async tell(isCoarse = false): Promise<void> {
    const mine = this.next();
    const content = this.editor.text();
    const tooMuch = excess(content);
    if (tooMuch !== "") return void text("notice", tooMuch);
    try {
      const answer = await engine.tell(mine, content, this.base, isCoarse);
      if (mine === this.revision) this.digest = answer.text;
      this.showStale(this.last);
      if (answer.problem !== "") text("notice", `the draft cannot be kept: ${answer.problem}`);
    } catch (problem) {
      text("notice", `the engine does not answer; the text stays here (${(problem as Error).message})`);
    }
  }

  async save(mayEmpty = false): Promise<void> {
    const content = this.editor.text();
    const tooMuch = excess(content);
    if (tooMuch !== "") return void text("notice", `not saved: ${tooMuch}`);
    this.isSaving = true;
    let isToAsk = false;
    try {
      const answer = await engine.save(content, this.base, this.next(), mayEmpty);
      if (answer.problem !== "") text("notice", `not saved: ${answer.problem}`);
      else if (answer.empties) isToAsk = true;
      else if (answer.conflict) await this.lookAtFile("Not saved: the file was changed by another program or page.");
      else {
        this.shown = content;
        this.base = this.seenFile = answer.digest;
        this.setTheirs(null);
        this.note();
        clearTimeout(this.typed);
        await this.tell();
      }
    } catch (problem) {
      text("notice", `not saved: ${(problem as Error).message}`);
    } finally {
      this.isSaving = false;
    }
    if (isToAsk && confirm("The text is empty, the file is not. Save the empty text over it?")) await this.save(true);
  }

  /// Findings have come.
  know(found: Findings): void {
    this.last = found;
    this.showStale(found);
    if (this.owns(found) && found.result !== null) this.seen?.();
    // An engine that has no text has just begun.
    if (this.isLost || (found.revision === 0 && this.digest !== null)) {
      this.isLost = false;
      this.note();
      void this.tell();
    }
    if (found.file !== this.seenFile && !this.isSaving && !this.isLooking)
      void this.lookAtFile("The file was changed by another program or page.");
  }
  private last: Findings | null = null;

  /// The engine does not answer: the one that comes after it begins with the text that stands here.
  lose(problem: unknown): void {
    this.isLost = true;
    const isOther = problem instanceof EngineError && problem.status === 403;
    text("stage", isOther ? "another engine answers" : "the engine does not answer");
    text(
      "notice",
      isOther
        ? "the engine has another address now: open the one that it has printed; the text stays here"
        : "the text stays here; start takt studio with this file again",
    );
  }

  private showStale(found: Findings | null): void {
    const isOld = found !== null && !this.owns(found);
    byId("views").classList.toggle("is-stale", isOld);
    const isOthers = isOld && this.digest !== null && found.revision !== 0 && !this.mine.has(found.revision);
    byId("stale").hidden = !isOthers;
    (byId("stale").firstChild as HTMLElement).textContent = isOthers
      ? "These findings belong to the text of another page. "
      : "";
  }

  /// Many programs empty a file and then write it in parts. It is read when two looks in a row find the same.
  private async restingFile() {
    let file = await engine.file();
    for (;;) {
      await new Promise((done) => window.setTimeout(done, 100));
      const again = await engine.file();
      if (again.digest === file.digest) return again;
      file = again;
    }
  }

  private isLooking = false;
  private looks = 0;
  private async lookAtFile(words: string): Promise<void> {
    const mine = ++this.looks;
    this.isLooking = true;
    let file;
    try {
      file = await this.restingFile();
    } catch {
      return; // seen again when it answers
    } finally {
      if (mine === this.looks) this.isLooking = false;
    }
    if (mine !== this.looks) return; // another look began later
    this.seenFile = file.digest;
    const theirs = file.saved ?? "";
    if (file.problem !== "") return void text("notice", file.problem);
    if (file.digest === this.base) return this.setTheirs(null);
    const isSame = theirs === this.editor.text();
    if (file.saved === null || isSame || !this.isChanged()) {
      // Nothing that was typed is lost: a text that was as the file follows it, and one that outlives its file waits to be saved.
      if (file.saved !== null && !isSame) this.editor.replace(theirs);
      this.base = file.digest;
      this.shown = theirs;
      this.setTheirs(null);
      this.note();
      if (file.saved === null) text("notice", "the file is gone; Ctrl+S writes it anew");
      else if (!isSame) text("notice", "the file was changed elsewhere: this is its new text");
      return;
    }
    this.setTheirs({ text: theirs, digest: file.digest }, words);
  }

  private setTheirs(theirs: { text: string; digest: string } | null, words = ""): void {
    this.theirs = theirs;
    byId("conflict").hidden = theirs === null;
    text("conflict-text", words);
  }

  private takeTheirs(): void {
    if (!this.theirs) return;
    const { text: content, digest } = this.theirs;
    this.shown = content;
    this.base = digest;
    this.setTheirs(null);
    this.editor.replace(content);
    this.note();
    this.editor.view.focus();
  }

  private keepMine(): void {
    if (!this.theirs) return;
    this.shown = this.theirs.text;
    this.base = this.theirs.digest;
    this.setTheirs(null);
    this.note();
    void this.tell();
    this.editor.view.focus();
  }
}
