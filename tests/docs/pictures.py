# SPDX-License-Identifier: Apache-2.0
"""The picture of the README: simulated, worst found and bound of each requirement, as parts of its limit.

tests/docs/renew.py draws it; tests/docs/outputs_test.py holds it against what the program says now.
"""
import json
import pathlib
import xml.sax.saxutils

NAME = pathlib.PurePosixPath("docs/pictures/verdict.svg")
COMMAND = "takt verify scenarios/robot-arm.json --budget 20 --format json"
LEFT, WIDTH, ROW, TOP = 250, 420, 44, 62
KINDS = (("bound_ps", "#c9d7e8", 22, "bound: no run can exceed it"),
         ("adversarial_ps", "#6f9bd1", 14, "worst run found"),
         ("simulated_ps", "#1f4e8c", 6, "simulated"))
STYLE = ("text{font:12px system-ui,sans-serif;fill:#333}.small{font-size:11px;fill:#555}"
         ".title{font-weight:600;font-size:13px}")


def readable(picoseconds):
    """Three significant digits; whole picoseconds until then."""
    for unit, size in (("ms", 10**9), ("us", 10**6), ("ns", 10**3)):
        if picoseconds >= size:
            whole = picoseconds // size
            decimals = max(0, 3 - len(str(whole)))
            scaled = (picoseconds * 10**decimals + size // 2) // size
            digits = str(scaled).rjust(decimals + 1, "0")
            return f"{digits[:-decimals]}.{digits[-decimals:]} {unit}" if decimals else f"{digits} {unit}"
    return f"{picoseconds} ps"


def text(x, y, content, kind=""):
    return f'<text x="{x}" y="{y}"{kind}>{xml.sax.saxutils.escape(content)}</text>'


def rows(verification):
    """Requirements with all four figures, in the order of the file."""
    needed = [key for key, *_ in KINDS] + ["limit_ps"]
    return [each for each in verification["requirements"] if all(each[key] is not None for key in needed)]


def draw(printed):
    verification = json.loads(printed)
    lines = rows(verification)
    height = TOP + ROW * len(lines) + 58
    title = f"{verification['scenario']}: simulated, worst found and bound, as parts of the limit"
    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 830 {height}" width="830" height="{height}"'
           f' role="img" aria-label="{title}">', f"<style>{STYLE}</style>",
           f'<rect width="830" height="{height}" fill="#fff"/>', text(14, 24, title, ' class="title"')]
    for at, each in enumerate(lines):
        middle = TOP + ROW * at + ROW // 2
        figures = ", ".join(readable(each[key]) for key, *_ in reversed(KINDS))
        svg.append(text(14, middle - 2, each["text"]))
        svg.append(text(14, middle + 13, f"{figures} of {readable(each['limit_ps'])}", ' class="small"'))
        for key, colour, thickness, name in KINDS:
            length = each[key] * WIDTH // each["limit_ps"]
            svg.append(f'<rect x="{LEFT + 60}" y="{middle - thickness // 2}" width="{length}" height="{thickness}"'
                       f' fill="{colour}"><title>{name}: {readable(each[key])}</title></rect>')
        svg.append(text(LEFT + WIDTH + 70, middle + 4, each["verdict"]))
    end = TOP + ROW * len(lines)
    limit = LEFT + 60 + WIDTH
    svg.append(f'<path d="M{limit} {TOP - 8}V{end + 4}" stroke="#c0392b" stroke-width="1.5" stroke-dasharray="5 4"/>')
    svg.append(text(limit - 12, TOP - 14, "limit", ' class="small"'))
    for at, (_, colour, _, name) in enumerate(reversed(KINDS)):
        x = LEFT + 60 + at * 120
        svg.append(f'<rect x="{x}" y="{end + 24}" width="12" height="12" fill="{colour}"/>')
        svg.append(text(x + 17, end + 34, name, ' class="small"'))
    return "\n".join([*svg, "</svg>", ""])
