#!/usr/bin/env python3
"""Write the drawings of the pages, docs/figures/*.svg.

  python3 tools/drawings             all of them; one that is no longer drawn is removed
  python3 tools/drawings --check     1 and a line for each that is missing, not drawn by this program or different

A module NN.py holds the drawings of page NN: each public function without parameters returns a Drawing, and
`depth_compare` in 03.py becomes 03_depth_compare.svg.
"""
import argparse
import importlib
import inspect
import sys
from pathlib import Path

sys.dont_write_bytecode = True
FOLDER = Path(__file__).resolve().parent


def drawings():
    """File names and their text, by name."""
    found = {}
    for path in sorted(FOLDER.glob("[0-9][0-9].py")):
        module = importlib.import_module(path.stem)
        for name, function in sorted(inspect.getmembers(module, inspect.isfunction)):
            if function.__module__ == module.__name__ and not name.startswith("_"):
                found[f"{path.stem}_{name}.svg"] = function().svg()
    return found


def problems(folder, expected):
    present = {path.name: path.read_text() for path in folder.glob("*.svg")}
    for name in sorted(present.keys() | expected.keys()):
        if name not in present:
            yield f"docs/figures/{name} is missing"
        elif name not in expected:
            yield f"docs/figures/{name} is drawn by no function of tools/drawings"
        elif present[name] != expected[name]:
            yield f"docs/figures/{name} is not what tools/drawings draws"


def main():
    parser = argparse.ArgumentParser(prog="tools/drawings", description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="compare, write nothing")
    parser.add_argument("--root", type=Path, default=FOLDER.parent.parent, help="another repository")
    options = parser.parse_args()
    folder, expected = options.root / "docs" / "figures", drawings()
    if options.check:
        found = list(problems(folder, expected))
        print("\n".join(found) if found else f"{len(expected)} drawings are as they are drawn")
        return 1 if found else 0
    for path in folder.glob("*.svg"):
        if path.name not in expected:
            path.unlink()
    for name, text in expected.items():
        (folder / name).write_text(text)
        print(name)
    return 0


if __name__ == "__main__":
    sys.exit(main())
