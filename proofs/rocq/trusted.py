#!/usr/bin/env python3
"""Counts the definitions that have to be read to know what verify_sound and verify_paving_sound say: of the roots below, and of all that
they are made of, as Coq's .glob files of the compiled development have it. Lines without comments and blank lines;
first those of the statement, then what the checks of shape have besides, then what pavings have.

    trusted.py       a line a file
    trusted.py -v    the names too
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).parent
STATEMENT = "print is_plain_certificate means".split()
SHAPES = "is_well_formed are_well_formed_legs is_turning are_well_formed_formulas are_parameters".split()
PAVINGS = "print_header print_summary is_plain_header means_paving".split()
KEYWORDS = rb"Definition|Fixpoint|Inductive|Record|Class|Instance|Notation|with"


def without_comments(text):
    """The same bytes, comments as blanks."""
    out, depth, i, quoted = bytearray(text), 0, 0, False
    while i < len(text):
        two = text[i : i + 2]
        if not depth and text[i : i + 1] == b'"':
            quoted = not quoted
        if not quoted and two in (b"(*", b"*)"):
            depth += 1 if two == b"(*" else -1
            out[i : i + 2] = b"  "
            i += 2
            continue
        if depth and text[i] != 10:
            out[i] = 32
        i += 1
    return bytes(out)


def sentences(text):
    """Where they begin and end: at a full stop before a blank."""
    start, quoted = 0, False
    for i, c in enumerate(text):
        if c == 34:
            quoted = not quoted
        elif c == 46 and not quoted and text[i + 1 : i + 2] in (b" ", b"\n", b""):
            yield start, i + 1
            start = i + 1


owner = {}  # (module, name) -> sentence
made_of = {}  # sentence -> names
size = {}  # sentence -> (file, lines)
for path in sorted(ROOT.glob("*.v")) + sorted((ROOT / "kernel").glob("*.v")):
    glob = path.with_suffix(".glob")
    if path.name == "Assumptions.v" or not glob.exists():
        continue
    module = "Orthocert." + ".".join(path.relative_to(ROOT).with_suffix("").parts)
    text = without_comments(path.read_bytes())
    at = []
    for begin, end in sentences(text):
        part = text[begin:end]
        is_definition = re.match(rb"\s*(Local |Global |#\[[^]]*\] )*(" + KEYWORDS + rb")\b", part)
        at.append((begin, end, bool(is_definition)))
        size[module, begin] = (str(path.relative_to(ROOT)), sum(1 for line in part.splitlines() if line.strip()))
    starts = iter(at)
    here = next(starts, None)
    events = []
    for line in glob.read_text().splitlines():
        found = re.match(r"R(\d+):\d+ (\S+) (\S+) (\S+) (\S+)$", line)
        if found:
            events.append((int(found[1]), None, (found[2], found[4])))
            continue
        found = re.match(r"(?:def|ind|constr|rec|proj|class|inst|method|abbrev|not|scheme) (\d+):\d+ (\S+) (\S+)$", line)
        if found:
            events.append((int(found[1]), found[3], None))
    for offset, name, reference in sorted(events, key=lambda event: event[0]):
        while here and here[1] <= offset:
            here = next(starts, None)
        if not here or not here[2]:
            continue
        key = (module, here[0])
        if name:
            owner[module, name] = key
        else:
            made_of.setdefault(key, set()).add(reference)

seen = set()
for words, module, roots in (("statement", "Certificate", STATEMENT), ("checks of shape", "Certificate", SHAPES), ("pavings", "PavingText", PAVINGS)):
    files, wanted = {}, [owner[f"Orthocert.kernel.{module}", root] for root in roots]
    while wanted:
        key = wanted.pop()
        if key not in seen:
            seen.add(key)
            file, lines = size[key]
            files.setdefault(file, []).append((lines, key))
            wanted.extend(owner[reference] for reference in made_of.get(key, ()) if reference in owner)
    for file in sorted(files):
        print(f"{sum(lines for lines, _ in files[file]):6d}  {len(files[file]):4d}  {file}")
        if "-v" in sys.argv:
            for lines, key in sorted(files[file], key=lambda found: found[1][1]):
                print(f"{lines:14d}    {' '.join(sorted(name for (_, name), k in owner.items() if k == key))}")
    of_all = [lines for found in files.values() for lines, _ in found]
    print(f"{sum(of_all):6d}  {len(of_all):4d}  lines, definitions: {words}\n")
