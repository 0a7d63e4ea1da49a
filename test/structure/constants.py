#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# Copyright (c) 2026, the segorient authors
"""The page of constants: name, value and reason from the code, the basis from the page itself.

    constants.py           writes the page anew; constants that it did not have get the basis '?'
    constants.py --check   ends with 1 where the page is not what would be written, or has a '?'
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCES = ROOT / "segorient/src"
PAGE = ROOT / "segorient/doc/constants.md"

# What the default method consists of: folder, and which of its files.
ROOMS = [
    ("features", r"(sheet_|grown_|growing_|more_neighbors|noise_level|automatic_normals|one_sided|scan_|cloud_noise|surface_|spread_|slope_|across_)"),
    ("segmentation", r"sheet_"),
    ("orientation/automatic", r""),
    ("orientation/winding", r""),
    ("orientation/sensors", r""),
]
SEARCH = "orientation/sensors"  # what `--no-sensors` leaves out is counted by itself
BASES = {
    "geometry": "follows from shapes: angles, neighbours on a grid, numbers of coefficients",
    "sampling": "statistics of random points and votes: how many are enough, what chance alone does",
    "noise": "how noise of a known size acts on planes, surfaces and normals",
    "paper": "the paper's value",
    "clouds": "seen on clouds: lies between two kinds of them, as the reason says",
    "cost": "time and memory only; results hardly depend on it, or not at all",
    "arithmetic": "what numbers can hold, and definitions",
}
DEFINITION = re.compile(r"^\s*(?:static )?constexpr (?:const )?[\w:<>, ]+?\s*\b(k[A-Z]\w*)(?:\[\])?"
                        r"\s*(?:=\s*|(?=\{))([^;]*);(.*)$")
BEGINNING = re.compile(r"^\s*(?:static )?constexpr [^(]*\bk[A-Z]\w*")


def text_of(comment):
    return re.sub(r"^/+<? ?", "", comment.strip())


def constants(path):
    """(name, value, reason) of each constant of a file, in order."""
    lines = path.read_text().split("\n")
    number, last = 0, -1
    while number < len(lines):
        line, end = lines[number], number
        if BEGINNING.match(line) and ";" not in line:
            while ";" not in lines[end]:
                end += 1
            line = " ".join(part.strip() for part in lines[number:end + 1])
        found = DEFINITION.match(line)
        if found and '"' not in found.group(2):  # texts are no thresholds
            above = []
            at = number - 1
            while at >= 0 and lines[at].strip().startswith("//"):
                above.insert(0, text_of(lines[at]))
                at -= 1
            reason = " ".join(above + [text_of(found.group(3))]).strip()
            reason = "" if "SPDX" in reason else reason
            if not reason:
                reason = "as the one above" if last == number - 1 else "none given"
            last = end
            yield found.group(1), re.sub(r"\s+", " ", found.group(2).strip()), reason
        number = end + 1


def known_bases():
    """By file, name and how often the name came before in the file."""
    bases, file, seen = {}, "", {}
    if not PAGE.exists():
        return bases
    for line in PAGE.read_text().split("\n"):
        if line.startswith("## "):
            file, seen = line[3:].strip("` "), {}
        row = re.match(r"^\| `(k\w+)` \| .* \| ([\w?]+) \| .*\|$", line)
        if row:
            count = seen[row.group(1)] = seen.get(row.group(1), 0) + 1
            bases[file, row.group(1), count] = row.group(2)
    return bases


def page():
    bases = known_bases()
    sections, counts = [], {room: dict.fromkeys(list(BASES) + ["?"], 0) for room in (False, True)}
    for folder, wanted in ROOMS:
        for path in sorted((SOURCES / folder).iterdir()):
            if path.suffix not in (".cpp", ".h", ".inl") or not re.match(wanted, path.name):
                continue
            file, seen, rows = f"{folder}/{path.name}", {}, []
            for name, value, reason in constants(path):
                count = seen[name] = seen.get(name, 0) + 1
                basis = bases.get((file, name, count), "?")
                counts[folder == SEARCH][basis] += 1
                cell = reason.replace("|", "\\|")
                rows.append(f"| `{name}` | `{value}` | {basis} | {cell} |")
            if rows:
                sections.append(f"## `{file}`\n\n| constant | value | basis | reason |\n"
                                "|---|---|---|---|\n" + "\n".join(rows))
    signs, search = counts[False], counts[True]
    table = "\n".join(f"| {basis} | {signs[basis]} | {search[basis]} | {what} |"
                      for basis, what in BASES.items())
    head = ("# Constants of the default method {#constants_page}\n\n"
            "<!-- Written by test/structure/constants.py from the code; only the column `basis` is\n"
            "     written by hand. A test compares. -->\n\n"
            f"Files are below `segorient/src/`. {sum(signs.values())} constants of normals, segments and\n"
            f"signs and {sum(search.values())} of the search for sensors, by what they rest on:\n\n"
            "| basis | signs | sensors | means |\n|---|---|---|---|\n" + table +
            "\n\nLengths are in local spacings, angles as cosines or radians, shares and confidences 0 "
            "to 1, unless the\nreason says otherwise. What users may set is not here: see the options "
            "in `include/segorient/`.\n\n")
    return head + "\n\n".join(sections) + "\n", signs["?"] + search["?"]


def main():
    text, unknown = page()
    if "--check" not in sys.argv:
        PAGE.write_text(text)
        print(f"{PAGE}: {unknown} without a basis")
        return 0
    if text != PAGE.read_text():
        print(f"{PAGE} is not what the code says: run {sys.argv[0]}")
        return 1
    if unknown:
        print(f"{PAGE}: {unknown} constants have no basis")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
