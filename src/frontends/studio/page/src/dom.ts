// SPDX-License-Identifier: Apache-2.0
// What the views are made of: elements, tables, times.

/// In the greatest unit of which it has one, with that many digits behind the point.
export function time(ps: number | null | undefined, digits = 3): string {
  if (ps === null || ps === undefined) return "-";
  for (const [unit, size] of [
    ["s", 1e12],
    ["ms", 1e9],
    ["us", 1e6],
    ["ns", 1e3],
  ] as const)
    if (Math.abs(ps) >= size) return `${Number((ps / size).toFixed(digits))} ${unit}`;
  return `${ps} ps`;
}

export function element(name: string, text = "", look = ""): HTMLElement {
  const made = document.createElement(name);
  made.textContent = text;
  made.className = look;
  return made;
}

export interface Cell {
  text?: string;
  note?: string;
  look?: string;
  child?: HTMLElement;
}

export function table(heads: string[], rows: Cell[][]): HTMLElement {
  const made = element("table");
  const head = element("tr");
  for (const each of heads) head.append(element("th", each));
  made.append(head);
  for (const row of rows) {
    const line = element("tr");
    for (const cell of row) {
      const data = element("td", cell.text ?? "", cell.look ?? "");
      if (cell.child) data.append(cell.child);
      if (cell.note) data.append(element("div", cell.note, "note"));
      line.append(data);
    }
    made.append(line);
  }
  const scroll = element("div", "", "scroll");
  scroll.append(made);
  return scroll;
}

export function fill(id: string, ...children: HTMLElement[]): void {
  document.getElementById(id)?.replaceChildren(...children);
}

export function button(text: string, act: () => void, title = ""): HTMLButtonElement {
  const made = element("button", text) as HTMLButtonElement;
  made.type = "button";
  if (title !== "") made.title = title;
  made.addEventListener("click", act);
  return made;
}

/// A labelled field of a form.
export function field(label: string, input: HTMLElement): HTMLLabelElement {
  const made = document.createElement("label");
  made.append(label + " ", input);
  return made;
}

export function input(value: string, size: number, list = ""): HTMLInputElement {
  const made = document.createElement("input");
  made.value = value;
  made.size = size;
  made.autocomplete = "off";
  made.spellcheck = false;
  if (list !== "") made.setAttribute("list", list);
  return made;
}

export function select(options: [string, string][]): HTMLSelectElement {
  const made = document.createElement("select");
  for (const [value, text] of options) made.append(new Option(text, value));
  return made;
}

export const byId = (id: string): HTMLElement => {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no ${id}`);
  return found;
};
