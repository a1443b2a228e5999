#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the constant tables of namespace 0 (standard_nodes.hpp) of nodeset.json.

usage: generate.py nodeset.json OUT.cpp
"""
import json
import pathlib
import sys


def text(value):
    return json.dumps(value) if value else "{}"


def flag(node, name):
    return "true" if node.get(name) else "false"


def main(source, target):
    nodes = json.loads(pathlib.Path(source).read_text(encoding="utf-8"))["nodes"]
    rows, references, fields, strings = [], [], [], []
    for node in sorted(nodes, key=lambda each: each["id"]):
        value = node.get("value")
        number = value if isinstance(value, int) else -1
        rows.append(f'{{{node["id"]}, NodeClass::{node["class"]}, {text(node["browseName"])}, {text(node.get("inverseName"))}, {flag(node, "isAbstract")}, '
                    f'{flag(node, "symmetric")}, {node.get("eventNotifier", 0)}, {node.get("dataType", 0)}, {node.get("valueRank", -1)}, {number}}},')
        references += [f'{{{node["id"]}, {kind}, {to}}},' for kind, to in node["references"]]
        fields += [f'{{{node["id"]}, {text(each["name"])}, {each.get("dataType", 0)}, {each.get("valueRank", -1)}, {each.get("value", -1)}}},'
                   for each in node.get("definition", [])]
        strings += [f'{{{node["id"]}, {text(each)}}},' for each in (value if isinstance(value, list) else [])]
    tables = [("StandardNode", "standard_nodes", rows), ("StandardReference", "standard_references", references), ("StandardField", "standard_fields", fields),
              ("StandardText", "standard_texts", strings)]
    out = ["// Made by generate.py of nodeset.json.", '#include "opcua/address_space/standard_nodes.hpp"', "namespace takt::opcua {", "namespace {"]
    for kind, name, lines in tables:
        out += [f"constexpr {kind} {name}_table[] = {{", *lines, "};"]
    out += ["}  // namespace"]
    out += [f"std::span<const {kind}> {name}() {{ return {name}_table; }}" for kind, name, _ in tables]
    out += ["}  // namespace takt::opcua", ""]
    pathlib.Path(target).write_text("\n".join(out), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
