#!/usr/bin/env python3
"""Check the pages: links, pictures, the parts that a chapter's page has, and the commands on it.

docs/TEMPLATE.md says what a page must have. With --bin the parameters and views that a page names are looked up in
the programs themselves.
"""
import argparse
import functools
import re
import shlex
import subprocess
import sys
from pathlib import Path

sys.dont_write_bytecode = True
from pages import ROOT, chapters, lines_with_fences, markdown_pages, report  # noqa: E402

HEADINGS = ["Run it", "What is new, and where", "Theory", "The code", "What you should see", "Break it", "Pitfalls",
            "References"]
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^()\s]+)\)")
IMG_TAG = re.compile(r"<img[^>]*\bsrc=\"([^\"]+)\"")
CODE = re.compile(r"(`+)(.+?)\1")
HEADING = re.compile(r"^(#{1,6})\s+(.*?)\s*#*$")
COMMAND = re.compile(r"^(?:\$ )?(?:[A-Z_]+=\S+ )*\./run\b(.*)$")


def prose(text):
    """Pairs (line number, line) of running text, code blocks left out."""
    return [(n, line) for n, (line, info) in enumerate(lines_with_fences(text), 1) if info is None]


def anchors(text):
    """The anchors that GitHub makes of the headings of a page."""
    found = set()
    for _, line in prose(text):
        heading = HEADING.match(line)
        if heading:
            title = re.sub(r"[`*]|\]\([^)]*\)|\[", "", heading.group(2)).lower()
            slug = re.sub(r"[^\w\- ]", "", title).replace(" ", "-")
            copies, unique = 0, slug
            while unique in found:
                copies += 1
                unique = f"{slug}-{copies}"
            found.add(unique)
    return found


def links(text):
    """(line number, is a picture, alternative text, target) of each link outside code."""
    for number, line in prose(text):
        line = CODE.sub("`code`", line)
        for mark, alt, target in LINK.findall(line):
            yield number, mark == "!", alt, target
            for inner_mark, inner_alt, inner_target in LINK.findall(alt):  # [![picture](a)](b)
                yield number, inner_mark == "!", inner_alt, inner_target
        for target in IMG_TAG.findall(line):
            yield number, True, "picture", target


def check_links(root, pages, problems):
    """Returns the pictures of docs/figures that some page shows."""
    shown = set()
    texts = {page: page.read_text() for page in pages}
    for page, text in texts.items():
        label = page.relative_to(root)
        for number, picture, alt, target in links(text):
            if re.match(r"^[a-z]+:", target):
                continue
            path, _, anchor = target.partition("#")
            file = (page.parent / path).resolve() if path else page
            if not file.exists():
                problems.append(f"{label}:{number}: {target} does not exist")
            elif root not in file.parents and file != root:
                problems.append(f"{label}:{number}: {target} lies outside the repository")
            elif anchor and file.suffix == ".md" and anchor not in anchors(file.read_text()):
                problems.append(f"{label}:{number}: {path or label} has no heading #{anchor}")
            if picture:
                shown.add(file)
                if not alt.strip():
                    problems.append(f"{label}:{number}: picture {target} has no text that says what is to be seen")
    return shown


def check_figures(root, shown, problems):
    """Pictures, the lines of figures.txt and the pictures on pages must be the same set.

    Drawings (.svg) have no lines: tools/drawings makes them, and compares them itself.
    """
    folder = root / "docs" / "figures"
    listing = folder / "figures.txt"
    lines = listing.read_text().splitlines() if listing.exists() else []
    listed = {line.split(":", 1)[0].strip() for line in lines if line.strip() and not line.startswith("#")}
    listed = {name for name in listed if not name.startswith("parts/")}
    present = {path.name for path in folder.glob("*.png")}
    for name in sorted(listed - present):
        problems.append(f"docs/figures/figures.txt: {name} is listed, but there is no such picture (tools/gallery.py)")
    for name in sorted(present - listed):
        problems.append(f"docs/figures/{name}: figures.txt does not say how it is made")
    present |= {path.name for path in folder.glob("*.svg")}
    for name in sorted(present - {path.name for path in shown if path.parent == folder}):
        problems.append(f"docs/figures/{name}: no page shows it")


def check_parts(root, name, problems):
    page = root / "docs" / f"{name}.md"
    label = f"docs/{name}.md"
    if not page.exists():
        problems.append(f"{label}: chapter {name} has no page")
        return
    text = page.read_text()
    lines = prose(text)
    titles = [m.group(2) for _, line in lines if (m := HEADING.match(line)) and len(m.group(1)) == 1]
    if len(titles) != 1 or not titles[0].startswith(name[:2] + " "):
        problems.append(f"{label}: the page needs one title, '# {name[:2]} ...'")
    parts = [m.group(2) for _, line in lines if (m := HEADING.match(line)) and len(m.group(1)) == 2]
    if parts != HEADINGS:
        missing = [h for h in HEADINGS if h not in parts] + [f"not '{p}'" for p in parts if p not in HEADINGS]
        problems.append(f"{label}: the headings are not those of TEMPLATE.md: " + (", ".join(missing) or "wrong order"))
    first = next((n for n, line in lines if line.startswith("## ")), 10**9)
    if sum(picture and number < first for number, picture, _, _ in links(text)) < 2:
        problems.append(f"{label}: a picture before and one after belong above the first heading")
    if not any(line.startswith("> ") for number, line in lines if number < first):
        problems.append(f"{label}: the takeaway ('> ...') belongs above the first heading")
    broken = False
    for line, info in lines_with_fences(text):
        heading = HEADING.match(line) if info is None else None
        if heading and len(heading.group(1)) == 2:
            broken = heading.group(2) == "Break it"
        if broken and "--set " in line:
            return
    problems.append(f"{label}: 'Break it' has no command with --set")


def commands(text):
    """(line number, arguments) of each ./run in code, and of each lone --set or --view (arguments start with None)."""
    for number, (line, info) in enumerate(lines_with_fences(text), 1):
        pieces = [line] if info is not None else [m.group(2) for m in CODE.finditer(line)]
        for piece in pieces:
            command = COMMAND.match(piece.strip())
            try:
                if command:
                    yield number, shlex.split(command.group(1), comments=True)
                elif info is None and re.match(r"^--(set|view) ", piece.strip()):
                    yield number, [None, *shlex.split(piece.strip())]
            except ValueError:
                yield number, ["(cannot be read)"]


@functools.cache
def names_of(binary, option):
    """The first word of each line that the program prints for --list-views or --list-params."""
    result = subprocess.run([binary, option], capture_output=True, text=True, timeout=60)
    if result.returncode:
        raise RuntimeError(f"{binary.name} {option} failed: {result.stderr.strip()}")
    return {line.split()[0].rstrip(":") for line in result.stdout.splitlines() if line.strip()}


def check_commands(root, page, bin_folder, problems):
    label = page.relative_to(root)
    known = chapters(root)
    own = page.stem if page.stem in known else None
    for number, arguments in commands(page.read_text()):
        word = arguments.pop(0) if arguments else ""
        if word is None:  # an option alone is the page's own chapter's; elsewhere it could be any chapter's
            if own is None:
                continue
            name = own
        elif word == "" or word.startswith("-"):
            arguments.insert(0, word)
            name = "12_second_bounce"
        elif word in ("report", "bench", "ladder", "roads", "numbers", "reference", "compare", "NN"):
            continue
        else:
            name = next((c for c in known if word in (c[:2], c, str(int(c[:2])))), None)
            if name is None:
                problems.append(f"{label}:{number}: there is no chapter {word}")
                continue
        if bin_folder is None:
            continue
        values = iter(arguments)
        option = ""
        for value in values:
            if value.startswith("--"):
                option, _, rest = value.partition("=")
                if not rest:
                    continue
                value = rest
            try:
                if option == "--view" and value not in names_of(bin_folder / name, "--list-views"):
                    problems.append(f"{label}:{number}: {name} has no view {value}")
                if option == "--set" and value.split("=")[0] not in names_of(bin_folder / name, "--list-params"):
                    problems.append(f"{label}:{number}: {name} has no parameter {value.split('=')[0]}")
            except (OSError, RuntimeError, subprocess.TimeoutExpired) as error:
                problems.append(f"{label}:{number}: {error}")
            if option != "--set":  # --set takes several values
                option = ""


def run(root, bin_folder):
    root = Path(root).resolve()
    problems = []
    pages = markdown_pages(root)
    check_figures(root, check_links(root, pages, problems), problems)
    for name in chapters(root):
        check_parts(root, name, problems)
    for page in pages:
        check_commands(root, page, bin_folder, problems)
    return report(problems, f"{len(pages)} pages are in order")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bin", type=Path, help="the folder of the programs; without it their views are not looked up")
    parser.add_argument("--root", type=Path, default=ROOT, help="another repository")
    options = parser.parse_args()
    sys.exit(run(options.root, options.bin and options.bin.resolve()))
