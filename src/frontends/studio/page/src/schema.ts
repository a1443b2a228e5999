// SPDX-License-Identifier: Apache-2.0
// What may stand at a place of a scenario, by its JSON Schema.
import type { Json } from "./api";

export type Schema = { [key: string]: Json };

const isObject = (value: Json | undefined): value is Schema =>
  typeof value === "object" && value !== null && !Array.isArray(value);

/// The schemas that a schema stands for: references followed, alternatives and parts taken apart.
function parts(root: Schema, schema: Schema, depth = 0): Schema[] {
  if (depth > 20) return [];
  const found: Schema[] = [schema];
  const reference = schema["$ref"];
  if (typeof reference === "string" && reference.startsWith("#/")) {
    let at: Json | undefined = root;
    for (const step of reference.slice(2).split("/"))
      at = isObject(at) ? at[step.replaceAll("~1", "/").replaceAll("~0", "~")] : undefined;
    if (isObject(at)) found.push(...parts(root, at, depth + 1));
  }
  for (const key of ["allOf", "anyOf", "oneOf"]) {
    const several = schema[key];
    if (Array.isArray(several))
      for (const each of several) if (isObject(each)) found.push(...parts(root, each, depth + 1));
  }
  for (const key of ["if", "then", "else"]) {
    const each = schema[key];
    if (isObject(each)) found.push(...parts(root, each, depth + 1));
  }
  return found;
}

/// One step down: a key of an object, or any item of a list.
function below(root: Schema, schema: Schema, step: string | number): Schema[] {
  const found: Schema[] = [];
  for (const part of parts(root, schema)) {
    if (typeof step === "number") {
      const items = part["items"];
      if (isObject(items)) found.push(items);
      else if (Array.isArray(items) && isObject(items[step])) found.push(items[step]);
      continue;
    }
    const properties = part["properties"];
    const known = isObject(properties) ? properties[step] : undefined;
    if (isObject(known)) found.push(known);
    else if (isObject(part["additionalProperties"])) found.push(part["additionalProperties"]);
  }
  return found;
}

export function schemasAt(root: Schema, path: (string | number)[]): Schema[] {
  let at: Schema[] = [root];
  for (const step of path) at = at.flatMap((schema) => below(root, schema, step)).slice(0, 200);
  return at.flatMap((schema) => parts(root, schema));
}

export interface Key {
  name: string;
  description: string;
  schema: Schema;
}

/// The keys that an object there may have, each once.
export function keysAt(root: Schema, path: (string | number)[]): Key[] {
  const keys = new Map<string, Key>();
  for (const part of schemasAt(root, path)) {
    const properties = part["properties"];
    if (!isObject(properties)) continue;
    for (const [name, schema] of Object.entries(properties)) {
      if (!isObject(schema) || keys.has(name)) continue;
      keys.set(name, { name, schema, description: descriptionOf(schemasAt(root, [...path, name])) });
    }
  }
  return [...keys.values()];
}

/// Words that a value there may be.
export function wordsAt(root: Schema, path: (string | number)[]): string[] {
  const words = new Set<string>();
  for (const part of schemasAt(root, path)) {
    const list = part["enum"];
    if (Array.isArray(list)) for (const each of list) words.add(JSON.stringify(each));
    if ("const" in part) words.add(JSON.stringify(part["const"]));
    if (part["type"] === "boolean") ["true", "false"].forEach((word) => words.add(word));
  }
  return [...words];
}

export function descriptionOf(schemas: Schema[]): string {
  for (const schema of schemas) {
    const text = schema["description"];
    if (typeof text === "string" && text !== "") {
      const fallback = schemas.map((each) => each["default"]).find((each) => each !== undefined);
      return text + (fallback === undefined ? "" : ` Default: ${JSON.stringify(fallback)}.`);
    }
  }
  return "";
}
