// SPDX-License-Identifier: Apache-2.0
// The editor: JSON with completion and hover texts from the schema, and diagnostics of the engine.
import {
  autocompletion,
  closeBrackets,
  closeBracketsKeymap,
  completionKeymap,
  type Completion,
  type CompletionContext,
  type CompletionResult,
} from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, indentWithTab, isolateHistory } from "@codemirror/commands";
import {
  bracketMatching,
  defaultHighlightStyle,
  foldGutter,
  foldKeymap,
  indentOnInput,
  syntaxHighlighting,
  syntaxTree,
} from "@codemirror/language";
import { lintGutter, lintKeymap, setDiagnostics, type Diagnostic as Mark } from "@codemirror/lint";
import { highlightSelectionMatches, searchKeymap } from "@codemirror/search";
import { Annotation, Compartment, EditorState, Transaction, type Extension } from "@codemirror/state";
import { oneDark } from "@codemirror/theme-one-dark";
import { EditorView, drawSelection, highlightActiveLine, hoverTooltip, keymap, lineNumbers } from "@codemirror/view";
import type { SyntaxNode } from "@lezer/common";
import type { Diagnostic } from "./api";
import { applied, difference, place, type Edit, type Path } from "./edits";
import { scenario, scenarioLanguage } from "./language";
import { namesAt, type Names } from "./names";
import { descriptionOf, keysAt, schemasAt, wordsAt, type Schema } from "./schema";

const nameOf = (state: EditorState, property: SyntaxNode): string => {
  const name = property.getChild("PropertyName");
  if (!name) return "";
  try {
    return JSON.parse(state.sliceDoc(name.from, name.to)) as string;
  } catch {
    return "";
  }
};

/// The keys and positions that lead to a node.
function pathTo(state: EditorState, node: SyntaxNode | null): Path {
  const path: Path = [];
  for (let at = node; at; at = at.parent) {
    if (at.name === "Property") path.unshift(nameOf(state, at));
    if (at.parent?.name === "Array") {
      let position = 0;
      for (let before = at.prevSibling; before; before = before.prevSibling)
        if (!["[", "]", ",", "⚠"].includes(before.name)) ++position;
      path.unshift(position);
    }
  }
  return path;
}

function completions(schema: Schema, names: () => Names) {
  return (context: CompletionContext): CompletionResult | null => {
    const node = syntaxTree(context.state).resolveInner(context.pos, -1);
    const word = context.matchBefore(/"[^"]*|[\w.-]*/);
    if (!word || (word.from === word.to && !context.explicit)) return null;
    const property = node.name === "PropertyName" ? node.parent : null;
    const isKey = property !== null || node.name === "Object" || (node.name === "⚠" && node.parent?.name === "Object");
    const options: Completion[] = isKey
      ? keysAt(schema, pathTo(context.state, property ? property.parent : node)).map((key) => ({
          label: `"${key.name}"`,
          type: "property",
          info: key.description,
          apply: property ? `"${key.name}"` : `"${key.name}": `,
        }))
      : [
          ...namesAt(pathTo(context.state, node), names()).map((name) => ({
            label: JSON.stringify(name),
            type: "variable",
            boost: 1,
          })),
          ...wordsAt(schema, pathTo(context.state, node)).map((text) => ({ label: text, type: "enum" })),
        ];
    // The quote that the editor has closed goes with what is chosen.
    const isClosed =
      context.state.sliceDoc(word.from, word.from + 1) === '"' &&
      context.state.sliceDoc(context.pos, context.pos + 1) === '"';
    const to = context.pos + (isClosed ? 1 : 0);
    return options.length === 0 ? null : { from: word.from, to, options, validFor: /^"?[\w.-]*"?$/ };
  };
}

function hover(schema: Schema): Extension {
  return hoverTooltip((view, position) => {
    const node = syntaxTree(view.state).resolveInner(position, 1);
    if (node.name !== "PropertyName") return null;
    const text = descriptionOf(schemasAt(schema, pathTo(view.state, node.parent)));
    if (text === "") return null;
    return {
      pos: node.from,
      end: node.to,
      create: () => {
        const dom = document.createElement("div");
        dom.style.cssText = "max-width: 480px; padding: 4px 8px";
        dom.textContent = text;
        return { dom };
      },
    };
  });
}

/// A movement of the hand, which belongs to the movement before it.
const held = Annotation.define<boolean>();
const typingPause = 500; // ms without a key after which what is typed is another step of the history
const longestHold = 86_400_000; // ms

/// What the editor reports.
export interface Listener {
  changed: (isUnderTheHand: boolean) => void;
  moved: (path: Path) => void; // the cursor, to what that path leads to
  save: () => void;
}

export class Editor {
  readonly view: EditorView;
  private dragged: string | null = null; // the text before what the hand moves
  private isMoved = false; // by the hand that holds it
  private changedAt = 0;
  private readonly scheme = new Compartment();

  constructor(
    parent: HTMLElement,
    schema: Schema,
    names: () => Names,
    private listener: Listener,
  ) {
    const dark = matchMedia("(prefers-color-scheme: dark)");
    const look = () => (dark.matches ? [oneDark] : []);
    dark.addEventListener("change", () => this.view.dispatch({ effects: this.scheme.reconfigure(look()) }));
    this.view = new EditorView({
      parent,
      state: EditorState.create({
        extensions: [
          lineNumbers(),
          foldGutter(),
          // All movements of one drag are one step, however long the hand rests between them.
          history({
            newGroupDelay: longestHold,
            joinToEvent: (transaction, isAdjacent) =>
              transaction.annotation(held) ?? (isAdjacent && Date.now() - this.changedAt < typingPause),
          }),
          drawSelection(),
          indentOnInput(),
          bracketMatching(),
          closeBrackets(),
          highlightActiveLine(),
          highlightSelectionMatches(),
          syntaxHighlighting(defaultHighlightStyle, { fallback: true }),
          scenario(scenarioLanguage.data.of({ autocomplete: completions(schema, names) })),
          autocompletion(),
          hover(schema),
          lintGutter(),
          // Ctrl+M lets Tab move on, for those who have no mouse.
          keymap.of([
            { key: "Mod-s", run: () => (listener.save(), true), preventDefault: true },
            ...closeBracketsKeymap,
            ...defaultKeymap,
            ...searchKeymap,
            ...historyKeymap,
            ...foldKeymap,
            ...completionKeymap,
            ...lintKeymap,
            indentWithTab,
          ]),
          EditorView.contentAttributes.of({ "aria-label": "Scenario, JSON" }),
          EditorView.updateListener.of((update) => {
            if (update.docChanged) this.changedAt = Date.now();
            if (update.docChanged) listener.changed(this.dragged !== null);
            if (update.docChanged || update.selectionSet) listener.moved(this.path());
          }),
          this.scheme.of(look()),
        ],
      }),
    });
  }

  /// What the cursor stands in.
  path(): Path {
    return pathTo(this.view.state, syntaxTree(this.view.state).resolveInner(this.view.state.selection.main.head, -1));
  }

  text(): string {
    return this.view.state.doc.toString();
  }

  /// A text that is loaded is no step of the history.
  load(text: string): void {
    this.view.dispatch({
      changes: { from: 0, to: this.view.state.doc.length, insert: text },
      annotations: Transaction.addToHistory.of(false),
    });
  }

  /// Another text; one step back brings the one before.
  replace(text: string): void {
    this.view.dispatch({ changes: difference(this.text(), text), annotations: isolateHistory.of("full") });
  }

  /// The hand moves something: edits of the text as it was before. Many movements are one step of the history.
  drag(edits: (text: string) => Edit[]): void {
    this.dragged ??= this.text();
    const changes = difference(this.text(), applied(this.dragged, edits(this.dragged)));
    if (changes.from === changes.to && changes.insert === "") return;
    this.view.dispatch({ changes, annotations: this.isMoved ? held.of(true) : isolateHistory.of("before") });
    this.isMoved = true;
  }

  isDragging(): boolean {
    return this.dragged !== null;
  }

  /// The hand lets go: the next change is another step.
  drop(): void {
    if (this.dragged === null) return;
    this.dragged = null;
    this.isMoved = false;
    this.view.dispatch({ annotations: isolateHistory.of("full") });
    this.listener.changed(false);
  }

  /// Line and column count from 1, columns in code points; 0 is the whole file.
  private place(line: number, column: number): number {
    const found = this.view.state.doc.line(Math.min(Math.max(line, 1), this.view.state.doc.lines));
    const before = [...found.text].slice(0, Math.max(column - 1, 0)).join("");
    return Math.min(found.from + before.length, found.to);
  }

  mark(diagnostics: Diagnostic[]): void {
    const marks: Mark[] = diagnostics.map((each) => {
      const from = this.place(each.line, each.column);
      const node = syntaxTree(this.view.state).resolveInner(from, 1);
      const to = node.from === from && node.to > from ? Math.min(node.to, this.view.state.doc.lineAt(from).to) : from;
      return { from, to, severity: each.severity, message: textOf(each) };
    });
    this.view.dispatch(setDiagnostics(this.view.state, marks));
  }

  goTo(each: Diagnostic): void {
    this.goToOffset(this.place(each.line, each.column));
  }

  /// Edits that do not overlap, in the order of the text; one step back undoes all.
  change(edits: Edit[]): void {
    this.view.dispatch({ changes: edits, userEvent: "input" });
  }

  /// To what a path leads to; false if nothing stands there.
  goToPath(path: Path): boolean {
    const found = place(this.text(), path);
    if (found) this.goToOffset(found.from + 1); // within it, so that the cursor is in what is meant
    return found !== null;
  }

  goToOffset(anchor: number): void {
    this.view.dispatch({ selection: { anchor }, scrollIntoView: true });
    this.view.focus();
  }
}

export function textOf(each: Diagnostic): string {
  const parts = [each.found ? `found ${each.found}` : "", each.expected ? `expected ${each.expected}` : ""].filter(
    (part) => part !== "",
  );
  return (
    each.message +
    (parts.length > 0 ? `: ${parts.join(", ")}` : "") +
    (each.suggestion ? ` (did you mean "${each.suggestion}"?)` : "")
  );
}
