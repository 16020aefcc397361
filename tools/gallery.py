#!/usr/bin/env python3
"""Make the pictures of the pages again, each with the command that docs/figures/figures.txt gives for it.

  tools/gallery.py                  all of them
  tools/gallery.py 08_cones.png     only the ones named (a pattern will do: '08_*'), and the parts they need
  tools/gallery.py --missing        only those that do not exist yet
  tools/gallery.py --list           names and commands, nothing is made
"""
import argparse
import fnmatch
import os
import shlex
import subprocess
import sys
import time
from pathlib import Path

sys.dont_write_bytecode = True
from pages import ROOT, chapters  # noqa: E402


class Gallery:
    def __init__(self, root, bin_folder, shared):
        self.root, self.bin, self.shared = root, bin_folder, shared
        self.folder = root / "docs" / "figures"
        self.parts = bin_folder.parent / "figures"
        self.commands = {}
        self.made = set()
        for number, line in enumerate((self.folder / "figures.txt").read_text().splitlines(), 1):
            if not line.strip() or line.startswith("#"):
                continue
            name, separator, command = line.partition(":")
            words = shlex.split(command)
            if not separator or not words:
                raise ValueError(f"figures.txt:{number}: not of the form 'name: command'")
            if name in self.commands:
                raise ValueError(f"figures.txt:{number}: {name} is there twice")
            if not name.startswith("parts/") and not name.endswith(".png"):
                raise ValueError(f"figures.txt:{number}: only parts/ may be something else than .png")
            self.commands[name] = words

    def file(self, name):
        return self.parts / name if name.startswith("parts/") else self.folder / name

    def arguments(self, name):
        """The command line that makes this figure, and the figures that it reads."""
        words = self.commands[name]
        output = str(self.file(name))
        needs = [word for word in words[1:] if word in self.commands]
        rest = [str(self.file(w)) if w in self.commands else w.replace("{shared}", str(self.shared)) for w in words[1:]]
        rest = [str(self.root / w) if w.startswith("assets/") else w for w in rest]
        if words[0] in ("sheet", "reference"):
            return [str(self.bin / words[0]), *rest, "--output", output], needs
        if words[0] == "compare":
            return [str(self.bin / "compare"), *rest, "--heatmap", output], needs
        program = next((c for c in chapters(self.root) if c[:2] == words[0]), None)
        if program is None:
            raise ValueError(f"{name}: there is no chapter {words[0]}")
        return [str(self.bin / program), *rest, "--headless", "--output", output], needs

    def make(self, name, only_missing=False):
        """Returns False when the figure could not be made."""
        if name in self.made or only_missing and self.file(name).exists():
            return True
        arguments, needs = self.arguments(name)
        if not all([self.make(need, only_missing) for need in needs]):
            return False
        missing = [word for word in arguments if word.startswith(str(self.shared)) and not Path(word).exists()]
        if missing:
            print(f"{name}: skipped, there is no {missing[0]}")
            return False
        self.file(name).parent.mkdir(parents=True, exist_ok=True)
        started = time.monotonic()
        environment = dict(os.environ, CONEBOOK_ROOT=str(self.root),
                           MESA_SHADER_CACHE_DIR=str(self.bin.parent / "shader_cache"))
        result = subprocess.run(arguments, env=environment, capture_output=True, text=True)
        if result.returncode:
            print(f"{name}: code {result.returncode} from {shlex.join(arguments)}\n{result.stderr.strip()}")
            return False
        print(f"{name}: {time.monotonic() - started:.1f} s", flush=True)
        self.made.add(name)
        return True


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", help="figures, or patterns")
    parser.add_argument("--missing", action="store_true", help="leave what exists as it is")
    parser.add_argument("--list", action="store_true", help="print names and commands")
    parser.add_argument("--bin", type=Path, help="the folder of the programs; default build/bin")
    parser.add_argument("--shared", type=Path, default=os.environ.get("CONEBOOK_SHARED"),
                        help="the folder that {shared} stands for, with real scenes; default $CONEBOOK_SHARED")
    parser.add_argument("--root", type=Path, default=ROOT, help="another repository")
    options = parser.parse_args()
    root = options.root.resolve()
    try:
        gallery = Gallery(root, (options.bin or root / "build" / "bin").resolve(),
                          Path(options.shared or root.parent / "shared").resolve())
        chosen = [n for n in gallery.commands if not options.names or any(fnmatch.fnmatch(n, p) for p in options.names)]
        unknown = [p for p in options.names if not fnmatch.filter(gallery.commands, p)]
        if unknown:
            raise ValueError(f"figures.txt has no {unknown[0]}")
        if options.list:
            for name in chosen:
                print(f"{name}: {shlex.join(gallery.commands[name])}")
            return 0
        if not options.names:  # parts are made when a picture needs them
            chosen = [name for name in chosen if not name.startswith("parts/")]
        failed = [name for name in chosen if not gallery.make(name, options.missing)]
    except (OSError, ValueError) as error:
        print(f"gallery: {error}", file=sys.stderr)
        return 2
    if failed:
        print(f"gallery: {len(failed)} of {len(chosen)} were not made: {' '.join(failed)}", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
