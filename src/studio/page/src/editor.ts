// The editor: JSON with completion and hover texts from the schema, and diagnostics of the engine.
import { autocompletion, closeBrackets, closeBracketsKeymap, completionKeymap, type Completion, type CompletionContext, type CompletionResult } from "@codemirror/autocomplete";
import { defaultKeymap, history, historyKeymap, indentWithTab } from "@codemirror/commands";
import { json, jsonLanguage } from "@codemirror/lang-json";
import { bracketMatching, defaultHighlightStyle, foldGutter, foldKeymap, indentOnInput, syntaxHighlighting, syntaxTree } from "@codemirror/language";
import { lintGutter, lintKeymap, setDiagnostics, type Diagnostic as Mark } from "@codemirror/lint";
import { highlightSelectionMatches, searchKeymap } from "@codemirror/search";
import { EditorState, type Extension } from "@codemirror/state";
import { oneDark } from "@codemirror/theme-one-dark";
import { EditorView, drawSelection, highlightActiveLine, hoverTooltip, keymap, lineNumbers } from "@codemirror/view";
import type { SyntaxNode } from "@lezer/common";
import type { Diagnostic } from "./api";
import type { Edit } from "./edits";
import { descriptionOf, keysAt, schemasAt, wordsAt, type Schema } from "./schema";

type Path = (string | number)[];

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
      for (let before = at.prevSibling; before; before = before.prevSibling) if (!["[", "]", ",", "⚠"].includes(before.name)) ++position;
      path.unshift(position);
    }
  }
  return path;
}

function completions(schema: Schema) {
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
      : wordsAt(schema, pathTo(context.state, node)).map((text) => ({ label: text, type: "enum" }));
    return options.length === 0 ? null : { from: word.from, options, validFor: /^"?[\w.-]*"?$/ };
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

export class Editor {
  readonly view: EditorView;

  constructor(parent: HTMLElement, schema: Schema, changed: (text: string) => void, save: () => void) {
    const isDark = matchMedia("(prefers-color-scheme: dark)").matches;
    this.view = new EditorView({
      parent,
      state: EditorState.create({
        extensions: [
          lineNumbers(),
          foldGutter(),
          history(),
          drawSelection(),
          indentOnInput(),
          bracketMatching(),
          closeBrackets(),
          highlightActiveLine(),
          highlightSelectionMatches(),
          syntaxHighlighting(defaultHighlightStyle, { fallback: true }),
          json(),
          jsonLanguage.data.of({ autocomplete: completions(schema) }),
          autocompletion(),
          hover(schema),
          lintGutter(),
          // Ctrl+M lets Tab move on, for those who have no mouse.
          keymap.of([{ key: "Mod-s", run: () => (save(), true), preventDefault: true }, ...closeBracketsKeymap, ...defaultKeymap, ...searchKeymap, ...historyKeymap, ...foldKeymap, ...completionKeymap, ...lintKeymap, indentWithTab]),
          EditorView.contentAttributes.of({ "aria-label": "Scenario, JSON" }),
          EditorView.updateListener.of((update) => {
            if (update.docChanged) changed(this.text());
          }),
          ...(isDark ? [oneDark] : []),
        ],
      }),
    });
  }

  text(): string {
    return this.view.state.doc.toString();
  }

  set(text: string): void {
    this.view.dispatch({ changes: { from: 0, to: this.view.state.doc.length, insert: text } });
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

  goToOffset(anchor: number): void {
    this.view.dispatch({ selection: { anchor }, scrollIntoView: true });
    this.view.focus();
  }
}

export function textOf(each: Diagnostic): string {
  const parts = [each.found ? `found ${each.found}` : "", each.expected ? `expected ${each.expected}` : ""].filter((part) => part !== "");
  return each.message + (parts.length > 0 ? `: ${parts.join(", ")}` : "") + (each.suggestion ? ` (did you mean "${each.suggestion}"?)` : "");
}
