// SPDX-License-Identifier: Apache-2.0
// A slider for the number at the cursor: the text changes under the hand, and the findings follow.
import { byId, element, input } from "./dom";
import { valueAt, type Path } from "./edits";
import type { Editor } from "./editor";

const octaves = 3; // as many times half and twice, on either side
const stepsAnOctave = 16;

/// "200us" as 200 and us, 5 as 5 and nothing.
function quantity(text: string): { number: number; unit: string; isQuoted: boolean } | null {
  const found = /^("?)(-?\d+(?:\.\d+)?) ?([A-Za-z%][\w/%]*)?\1$/.exec(text);
  return found && Number(found[2]) > 0
    ? { number: Number(found[2]), unit: found[3] ?? "", isQuoted: found[1] !== "" }
    : null;
}

export class Slider {
  private readonly range = input("0", 20);
  private readonly name = element("label", "");
  private readonly value = element("output", "");
  private path: Path = [];
  private begun: { number: number; unit: string; isQuoted: boolean; isWhole: boolean } | null = null;

  constructor(private editor: Editor) {
    this.range.type = "range";
    this.range.id = "slider-range";
    this.range.min = String(-octaves * stepsAnOctave);
    this.range.max = String(octaves * stepsAnOctave);
    this.name.setAttribute("for", this.range.id);
    byId("slider").append(this.name, this.range, this.value);
    this.range.addEventListener("input", () => this.move());
    for (const each of ["change", "pointerup", "blur"]) this.range.addEventListener(each, () => this.rest());
  }

  /// The cursor has come to what that path leads to.
  know(path: Path): void {
    if (this.begun) return; // it is the hand that moves
    const found = this.found(path);
    byId("slider").hidden = found === null;
    if (!found) return;
    this.path = path;
    this.range.value = "0";
    this.name.textContent = path
      .filter((each) => typeof each === "string")
      .slice(-2)
      .join(" / ");
    this.value.textContent = `${found.number}${found.unit}`;
  }

  private found(path: Path) {
    const text = this.editor.text();
    const node = valueAt(text, path);
    return node && (node.name === "String" || node.name === "Number") ? quantity(text.slice(node.from, node.to)) : null;
  }

  private move(): void {
    const now = this.begun ?? this.found(this.path);
    if (!now) return;
    this.begun ??= { ...now, isWhole: now.unit === "" && Number.isInteger(now.number) };
    const { number, unit, isQuoted, isWhole } = this.begun;
    const wanted = number * 2 ** (Number(this.range.value) / stepsAnOctave);
    const made =
      this.range.value === "0" ? number : isWhole ? Math.max(Math.round(wanted), 1) : Number(wanted.toPrecision(3));
    const words = isQuoted ? `"${made}${unit}"` : String(made);
    this.value.textContent = `${made}${unit}`;
    this.range.setAttribute("aria-valuetext", `${made}${unit}`);
    const path = this.path;
    this.editor.drag((text) => {
      const node = valueAt(text, path);
      return node ? [{ from: node.from, to: node.to, insert: words }] : [];
    });
  }

  private rest(): void {
    if (!this.begun) return;
    this.begun = null;
    this.editor.drop();
    this.know(this.path);
  }
}
