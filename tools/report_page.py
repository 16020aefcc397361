#!/usr/bin/env python3
"""Put the numbers of docs/data/report.json into docs/14_speed_against_error.md, or check that they are there.

On the page, <!-- data: EXPRESSION -->VALUE<!-- end --> holds what a function of report_answers.py makes of the data.
Numbers with a unit and decimals outside such marks, headings, code and links are refused: nobody would update them.
"""
import argparse
import json
import re
import sys
from pathlib import Path

sys.dont_write_bytecode = True
from pages import MARK, ROOT, filled_marks, lines_with_fences, report, stale_marks  # noqa: E402
from report_answers import Answers  # noqa: E402

PAGE, DATA = Path("docs/14_speed_against_error.md"), Path("docs/data/report.json")
MEASURED = re.compile(r"\d\.\d|\b\d+ ?(?:%|ms\b|MB\b|s\b|times\b|samples\b|minutes\b)")


def names_of(root):
    """The functions that an expression may call."""
    answers = Answers(json.loads((root / DATA).read_text()))
    return {name: getattr(answers, name) for name in dir(answers) if not name.startswith("_")}


def typed_numbers(text):
    """Lines with a measured number that no mark made."""
    text = MARK.sub(lambda m: "\n" * m.group(0).count("\n"), text)
    for number, (line, info) in enumerate(lines_with_fences(text), 1):
        if info is None and not line.startswith("#"):
            bare = re.sub(r"`[^`]*`|\]\([^)]*\)|\$[^$]*\$", "", line)
            if MEASURED.search(bare):
                yield number, line.strip()


def problems_of(root):
    text = (root / PAGE).read_text()
    stale, count = stale_marks(text, names_of(root), PAGE, DATA, "report_page.py")
    if not count:
        return [f"{PAGE}: holds no <!-- data: ... --> mark"]
    return [f"{PAGE}:{n}: a number that is not made from the data: {line}" for n, line in typed_numbers(text)] + stale


def write(root):
    """Returns the exit code."""
    page = root / PAGE
    page.write_text(filled_marks(page.read_text(), names_of(root), PAGE))
    return report(problems_of(root), f"{PAGE} holds the data")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    action = parser.add_mutually_exclusive_group(required=True)
    action.add_argument("--write", action="store_true", help="put the values in")
    action.add_argument("--check", action="store_true", help="only say what differs; code 1 if anything does")
    parser.add_argument("--root", type=Path, default=ROOT, help="another repository")
    options = parser.parse_args()
    try:
        if options.write:
            return write(options.root)
        return report(problems_of(options.root), f"{PAGE} holds the data")
    except (OSError, ValueError, KeyError) as fault:
        print(f"report_page: {fault}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
