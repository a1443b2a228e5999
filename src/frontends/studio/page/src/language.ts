// SPDX-License-Identifier: Apache-2.0
// Scenarios are JSON with comments: the parser sees blanks where they stand, and they are coloured on top.
import { jsonLanguage } from "@codemirror/lang-json";
import { Language, LanguageSupport, defineLanguageFacet, languageDataProp } from "@codemirror/language";
import { RangeSetBuilder, StateField, type EditorState, type Extension } from "@codemirror/state";
import { Decoration, EditorView, type DecorationSet } from "@codemirror/view";
import { Parser, type Input, type PartialParse, type TreeFragment } from "@lezer/common";
import { comments, withoutComments } from "./edits";

const data = defineLanguageFacet({
  commentTokens: { line: "//", block: { open: "/*", close: "*/" } },
  closeBrackets: { brackets: ["[", "{", '"'] },
});
// Completion and comments are found by the data at the top of the tree.
const parser = jsonLanguage.parser.configure({
  props: [languageDataProp.add((type) => (type.isTop ? data : undefined))],
});

class ParserWithComments extends Parser {
  createParse(
    input: Input,
    _fragments: readonly TreeFragment[],
    ranges: readonly { from: number; to: number }[],
  ): PartialParse {
    // A comment that opens changes what stands behind it: nothing of an older tree is taken over.
    return parser.startParse(withoutComments(input.read(0, input.length)), [], ranges);
  }
}

export const scenarioLanguage = new Language(data, new ParserWithComments(), [], "scenario");

const mark = Decoration.mark({ class: "comment" });

function marked(state: EditorState): DecorationSet {
  const builder = new RangeSetBuilder<Decoration>();
  for (const [from, to] of comments(state.doc.toString())) builder.add(from, to, mark);
  return builder.finish();
}

const shownComments = StateField.define<DecorationSet>({
  create: marked,
  update: (shown, change) => (change.docChanged ? marked(change.state) : shown),
  provide: (field) => EditorView.decorations.from(field),
});

export function scenario(...more: Extension[]): LanguageSupport {
  return new LanguageSupport(scenarioLanguage, [shownComments, ...more]);
}
