#!/usr/bin/env python3
"""Fill the code blocks of the pages from tagged lines of the source, or check that they agree.

The syntax of tags and pages is explained in docs/TEMPLATE.md.
"""
import argparse
import re
import sys
import textwrap
from pathlib import Path

sys.dont_write_bytecode = True
from pages import FENCE, ROOT, lines_with_fences, markdown_pages, report, walk  # noqa: E402

MAX_LINES = 20
LANGUAGES = {".cpp": "cpp", ".hpp": "cpp", ".h": "cpp", ".vert": "glsl", ".geom": "glsl", ".frag": "glsl",
             ".comp": "glsl", ".glsl": "glsl", ".cmake": "cmake", ".txt": "cmake", ".py": "python", ".sh": "sh"}
BEGIN = re.compile(r"^\s*(?://|#)\s*snippet:\s*(.*?)\s*$")
END = re.compile(r"^\s*(?://|#)\s*end snippet\s*$")
NAME = re.compile(r"^[a-z0-9_]+$")
MARKER = re.compile(r"^<!--\s*snippet:\s*(\S+?)#(\S+)\s*-->\s*$")
LOOKS_LIKE_MARKER = re.compile(r"^\s*<!--\s*snippet\b")


def read_tags(path, label, problems):
    """{tag: code} of one source file. Faults are added to problems."""
    tags = {}
    name, body, start = None, [], 0
    for number, line in enumerate(path.read_text().splitlines(), 1):
        begin = BEGIN.match(line)
        if begin:
            if name is not None:
                problems.append(f"{label}:{number}: a snippet begins inside snippet '{name}'")
            name, body, start = begin.group(1), [], number
            if not NAME.match(name):
                problems.append(f"{label}:{number}: '{name}' is not a snippet name (a-z, 0-9, _)")
            if name in tags:
                problems.append(f"{label}:{number}: there are two snippets '{name}'")
        elif END.match(line):
            if name is None:
                problems.append(f"{label}:{number}: a snippet ends that did not begin")
                continue
            code = textwrap.dedent("\n".join(body)).strip("\n")
            count = len(code.splitlines())
            if not 1 <= count <= MAX_LINES:
                problems.append(f"{label}:{start}: snippet '{name}' has {count} lines; 1 to {MAX_LINES} are allowed")
            tags[name] = code
            name = None
        elif name is not None:
            body.append(line)
    if name is not None:
        problems.append(f"{label}:{start}: snippet '{name}' does not end")
    return tags


def read_sources(root, problems):
    """{path relative to root: {tag: code}} of all files that have tags."""
    sources = {}
    for path in walk(root):
        if path.suffix in LANGUAGES or path.suffix == "" and path.name in ("run", "test"):
            label = path.relative_to(root).as_posix()
            tags = read_tags(path, label, problems)
            if tags:
                sources[label] = tags
    return sources


def fill(text, label, sources, used, problems):
    """The page's text with every block after a marker filled from its source."""
    lines = text.splitlines()
    fenced = [info is not None for _, info in lines_with_fences(text)]
    out, i = [], 0
    while i < len(lines):
        out.append(lines[i])
        marker = None if fenced[i] else MARKER.match(lines[i])
        if marker is None:
            if not fenced[i] and LOOKS_LIKE_MARKER.match(lines[i]):
                problems.append(f"{label}:{i + 1}: the marker is not of the form <!-- snippet: path#name -->")
            i += 1
            continue
        number, (path, name) = i + 1, marker.groups()
        i += 1
        end = i  # one past the block that follows, if one does
        if i < len(lines) and fenced[i] and FENCE.match(lines[i]):
            end = i + 1
            while end < len(lines) and lines[end].rstrip() != FENCE.match(lines[i]).group(1):
                end += 1
            end += 1
        old = lines[i:end]
        code = sources.get(path, {}).get(name)
        if code is None:
            problems.append(f"{label}:{number}: {path} has no snippet '{name}'")
            out += old
        else:
            used.add((path, name))
            language = LANGUAGES.get(Path(path).suffix, "sh")
            out += [f"```{language}", *code.splitlines(), "```"]
        i = end
    return "\n".join(out) + "\n"


def first_difference(old, new):
    """The number of the first line that differs, and that line as it is on the page."""
    old, new = old.splitlines(), new.splitlines()
    for number, (a, b) in enumerate(zip(old, new), 1):
        if a != b:
            return number, a.strip()
    return min(len(old), len(new)) + 1, ""


def run(root, write):
    root = Path(root)
    problems, used, changed, count = [], set(), 0, 0
    sources = read_sources(root, problems)
    for page in markdown_pages(root):
        label = page.relative_to(root).as_posix()
        text = page.read_text()
        filled = fill(text, label, sources, used, problems)
        count += 1
        if filled == text or filled.rstrip("\n") == text.rstrip("\n"):
            continue
        if write:
            page.write_text(filled)
            changed += 1
        else:
            number, line = first_difference(text, filled)
            problems.append(f"{label}:{number}: differs from its source (tools/snippets.py --write): {line}")
    for path, tags in sources.items():
        for name in tags:
            if (path, name) not in used:
                problems.append(f"{path}: snippet '{name}' is quoted by no page")
    ok = f"{len(used)} snippets on {count} pages agree with their sources"
    return report(problems, ok + (f"; {changed} pages rewritten" if write else ""))


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    mode = parser.add_mutually_exclusive_group(required=True)
    mode.add_argument("--check", action="store_true", help="code 1 and one line for each difference")
    mode.add_argument("--write", action="store_true", help="rewrite the pages")
    parser.add_argument("--root", type=Path, default=ROOT, help="another repository")
    options = parser.parse_args()
    sys.exit(run(options.root.resolve(), options.write))
