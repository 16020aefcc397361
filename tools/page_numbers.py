#!/usr/bin/env python3
"""The measured numbers of the pages: measure them, put them into the pages, or check that they are there.

  ./run numbers                      measures everything that docs/data/numbers.txt lists, into docs/data/numbers.json,
                                     and writes the numbers into the pages
  ./run numbers --only 07 '10_*' 13_box     only runs of these pages, patterns or names, and those that they compare
  tools/page_numbers.py --write      only writes into the pages what was measured before
  tools/page_numbers.py --check      code 1 and one line for each number that is not what was measured

On a page, <!-- data: EXPRESSION -->VALUE<!-- end --> holds what the expression makes of the data; class Numbers has
the functions that it may call. Times are those of this machine: measure them while nothing else runs.
"""
import argparse
import fnmatch
import json
import os
import re
import resource
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.dont_write_bytecode = True
from pages import ROOT, chapters, filled_marks, report, stale_marks  # noqa: E402
from report_measure import machine  # noqa: E402

LIST, DATA = Path("docs/data/numbers.txt"), Path("docs/data/numbers.json")
OTHER_PAGES = {"14_speed_against_error.md"}  # tools/report_page.py fills it
BUSY = 0.2  # cores that other programs may use before times are called too long


def read_list(root):
    """{name: words of the command}, from numbers.txt."""
    runs = {}
    for number, line in enumerate((root / LIST).read_text().splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        name, separator, command = line.partition(":")
        words = shlex.split(command)
        if not separator or not words or name in runs:
            raise ValueError(f"{LIST}:{number}: {'twice' if name in runs else 'not of the form name: command'}")
        runs[name] = words
    return runs


def chosen(runs, patterns):
    """The names that the patterns mean; 07 stands for all of page 07."""
    for pattern in patterns:
        if not any(fnmatch.fnmatch(name, pattern) or name.startswith(pattern + "_") for name in runs):
            raise ValueError(f"{LIST} has no {pattern}")
    return [name for name in runs
            if not patterns or any(fnmatch.fnmatch(name, p) or name.startswith(p + "_") for p in patterns)]


# --- Measuring ---

class Bench:
    """Runs the lines of numbers.txt. Pictures that other runs compare stay in the build folder."""

    def __init__(self, root, bin_folder, shared):
        self.root, self.bin, self.shared = root, bin_folder, shared
        self.runs = read_list(root)
        self.pictures = bin_folder.parent / "numbers"
        self.measured = {}

    def kind(self, name):
        """The first word, and the words behind it; an edit of the shaders left out."""
        words = self.runs[name]
        words = words[4:] if words[0] == "edit" else words
        return words[0], words[1:]

    def program(self, name):
        word, rest = self.kind(name)
        if word in ("reference", "compare"):
            return word
        if word == "test":
            return rest[0]
        if word == "ladder":
            return "12_second_bounce"
        found = next((c for c in chapters(self.root) if c[:2] == word), None)
        if found is None:
            raise ValueError(f"{name}: there is no chapter {word}")
        return found

    def compared(self, word):
        """The run whose picture the word means: NAME, or NAME:PART of a reference that writes its parts; or None."""
        name = word.partition(":")[0]
        return name if name in self.runs else None

    def picture(self, word):
        return self.pictures / f"{word.replace(':', '_')}.exr"

    def with_needs(self, names):
        """The names, each after those whose pictures it compares."""
        ordered = []
        for name in names:
            needs = [self.compared(word) for word in self.runs[name][1:] if self.compared(word)]
            ordered += [n for n in [*self.with_needs(needs), name] if n not in ordered]
        return ordered

    def targets(self, names):
        needed = {self.program(name) for name in self.with_needs(names)}
        return sorted(needed | ({"reference", "compare"} if any(self.kind(n)[0] == "ladder" for n in names) else set()))

    def arguments(self, name, file):
        """The command line. What the program tells goes to `file`, if it tells it to a file."""
        kind, rest = self.kind(name)
        picture = self.picture(name)
        if kind == "compare" and self.kind(self.compared(rest[1]))[0] == "reference":
            rest = [*rest, "--reference-error", str(self.picture(rest[1] + "_error"))]
        rest = [str(self.picture(w)) if self.compared(w) else w.replace("{shared}", str(self.shared)) for w in rest]
        rest = [str(self.root / w) if w.startswith("assets/") else w for w in rest]
        if kind == "ladder":
            return [sys.executable, self.root / "tools/ladder.py", "--bin", self.bin, *rest, "--json", file]
        program = self.bin / self.program(name)
        return [program, *{"reference": [*rest, "--output", picture, "--error", self.picture(name + "_error")],
                           "compare": [*rest, "--json", file],
                           "test": [*rest[1:], f"--gtest_output=json:{file}"]}.get(
            kind, [*rest, "--headless", "--output", picture, "--stats", file])]

    def edited_root(self, name, folder):
        """A repository in `folder` whose shaders have the run's edit and whose other files are this one's."""
        _, path, old, new = self.runs[name][:4]
        for entry in self.root.iterdir():
            if entry.name != "shaders":
                (folder / entry.name).symlink_to(entry)
        shutil.copytree(self.root / "shaders", folder / "shaders")
        text = (folder / path).read_text()
        if text.count(old) != 1:
            raise ValueError(f"{name}: {path} holds '{old}' {text.count(old)} times, not once")
        (folder / path).write_text(text.replace(old, new))
        return folder

    def measure(self, name):
        """What one run told, or None when its scene is not here. Its needs have been measured before."""
        self.pictures.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "told.json"
            arguments = list(map(str, self.arguments(name, file)))
            missing = [a for a in arguments if a.startswith(str(self.shared)) and not Path(a).exists()]
            if missing:
                print(f"{name}: skipped, there is no {missing[0]}")
                return None
            edit = self.runs[name][0] == "edit"
            root = self.edited_root(name, Path(folder)) if edit else self.root
            environment = dict(os.environ, CONEBOOK_ROOT=str(root), CONEBOOK_BIN=str(self.bin))
            environment.setdefault("MESA_SHADER_CACHE_DIR", str(self.bin.parent / "shader_cache"))
            own, others, started = cpu_seconds(), busy_seconds(), time.monotonic()
            result = subprocess.run(arguments, env=environment, capture_output=True, text=True)
            seconds = time.monotonic() - started
            if result.returncode and not (edit and file.exists()):  # a test may fail when the shader is edited
                said = (result.stderr.strip() or result.stdout.strip() or "nothing was said").splitlines()[-1]
                raise RuntimeError(f"{name}: code {result.returncode} from {shlex.join(arguments)}: {said}")
            busy = max(0.0, busy_seconds() - others - (cpu_seconds() - own)) / seconds
            told = told_by(self.kind(name)[0], result.stdout, json.loads(file.read_text()) if file.exists() else {})
        print(f"{name}: {seconds:.1f} s" + (f"; others used {busy:.1f} cores, so its times are too long"
                                            if busy > BUSY and "ms" in told else ""), flush=True)
        return {"command": shlex.join(self.runs[name]), "others_cores": round(busy, 2),
                "machine": machine(self.root, told.pop("driver", "")), **told}


def cpu_seconds():
    """Of this program's children that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def busy_seconds():
    """In which the machine's cores did anything; 0 where this is not told."""
    try:
        fields = list(map(int, Path("/proc/stat").read_text().splitlines()[0].split()[1:9]))
    except (OSError, ValueError, IndexError):
        return 0.0
    return (sum(fields) - fields[3] - fields[4]) / os.sysconf("SC_CLK_TCK")  # but idle and waiting


def told_by(kind, printed, data):
    """What is kept: by name, so that an expression can ask for it."""
    if kind == "reference":
        found = re.search(r"mean radiance +(\S+) (\S+) (\S+) .*standard error of that mean (\S+) (\S+) (\S+)\n"
                          r"mean standard error of a pixel +(\S+) (\S+) (\S+)", printed)
        values = list(map(float, found.groups()))
        return {"values": {"mean": values[:3], "error of mean": values[3:6], "error of pixel": values[6:]}}
    if kind == "compare":
        return {"values": {key: value for key, value in data.items() if key not in ("image", "reference")}}
    if kind == "ladder":
        rungs = [{k: v for k, v in rung.items() if k not in ("seconds", "command")} for rung in data["rungs"]]
        return {"values": {**{k: data[k] for k in ("total_percent", "standard_error_percent")}, "rungs": rungs}}
    if kind == "test":
        known = {"name", "file", "line", "status", "result", "timestamp", "time", "classname", "failures", "value_param",
                 "type_param"}
        return {"values": {f"{test['name']}.{key}": float(value) for suite in data["testsuites"] for test in suite["testsuite"]
                           for key, value in test.items() if key not in known}}
    return {"driver": data["driver"], "counts": {c["name"]: c["value"] for c in data["counts"]},
            "ms": {p["name"]: p["min_ms"] for p in data["passes"]},
            "frames": {p["name"]: p.get("frames", 1) for p in data["passes"]},
            "bytes": {r["name"]: r["bytes"] for r in data["resources"]}}


# --- What an expression on a page may call ---

class Numbers:
    """Every function takes the name of a run in numbers.txt; those that return text are for the page."""

    def __init__(self, data):
        self._data, self._asked = data, set()

    def _run(self, run):
        self._asked.add(run)
        if run not in self._data:
            raise KeyError(f"{run} was not measured; ./run numbers --only {run}")
        return self._data[run]

    def count(self, run, name):
        return self._run(run)["counts"][name]

    def ms(self, run, name):
        """Least time of a pass over the frames."""
        return self._run(run)["ms"][name]

    def again(self, run, *names):
        """Least time in a later frame than the first of all passes, or of these, that ran in one; summed up."""
        data = self._run(run)
        return sum(ms for name, ms in data["ms"].items() if data["frames"][name] > 1 and (not names or name in names))

    def events(self, runs):
        """Of runs {heading: run}: a row for each pass, its least time where it ran in later frames than the first one."""
        data = [self._run(run) for run in runs.values()]
        passes = dict.fromkeys(name for told in data for name in told["ms"])
        return self.table(" | ".join(["pass", *runs]), list(passes), lambda name: [
            self.significant(told["ms"][name], 2) if told["frames"].get(name, 0) > 1 else "" for told in data])

    def megabytes(self, run, name):
        return self._run(run)["bytes"][name] / 1e6

    def value(self, run, name):
        """Of a comparison, a test, the path tracer or the ladder."""
        return self._run(run)["values"][name]

    def command(self, run):
        words = shlex.split(self._run(run)["command"])
        words = words[4:] if words[0] == "edit" else words
        return f"`./run {shlex.join(w.replace('{shared}/scenes/', '') for w in words)}`"

    def on(self, *runs):
        """The machine, which must be the same for these runs, and the renderer where there is one."""
        told = [self._run(run)["machine"] for run in runs]
        kinds = {(m["cpu"], m["cores"], m["driver"]) for m in told}
        if len(kinds) != 1:
            raise ValueError(f"{', '.join(runs)} were measured on different machines")
        m = told[0]
        return f"{m['cpu']}, {m['cores']} cores" + (f", {m['driver'].rsplit(',', 1)[0]}" if m["driver"] else "")

    @staticmethod
    def whole(x):
        return f"{x:,.0f}"

    @staticmethod
    def fixed(x, digits):
        return f"{x:.{digits}f}"

    @staticmethod
    def significant(x, digits):
        return f"{float(f'{x:.{digits}g}'):,.10g}"

    @staticmethod
    def percent(share, digits=0):
        return f"{100 * share:.{digits}f} %"

    @staticmethod
    def table(head, rows, cells):
        """head: 'a | b'; rows: {first cell: row}, or the first cells alone; cells: from a row to the other cells' text."""
        rows = rows.items() if isinstance(rows, dict) else [(str(row), row) for row in rows]
        lines = [f"| {head} |", "|---" * (head.count("|") + 1) + "|"]
        return "\n" + "\n".join(lines + [f"| {' | '.join([first, *cells(row)])} |" for first, row in rows]) + "\n"

    def ladder_table(self, run):
        def cells(rung):
            steps = [] if rung["rung"] == "R0" else [f"{rung['step_percent']:+.2f}", *(
                self.fixed(rung[key], digits) for key, digits in (("smape_before", 3), ("smape_r1", 3), ("p95_r1", 2)))]
            return [rung["step"], self.fixed(rung["mean"], 4), *(steps or [""] * 4)]
        return self.table("rung | step to it | mean, W sr⁻¹ m⁻² | step, % of R1 | SMAPE to the rung before | SMAPE to R1 | "
                          "95th percentile to R1", {rung["rung"]: rung for rung in self.value(run, "rungs")}, cells)


def names_of(numbers):
    return {name: getattr(numbers, name) for name in dir(numbers) if not name.startswith("_")} | {
        "min": min, "max": max, "sum": sum, "round": round, "len": len}


# --- Pages ---

def page_files(root):
    return [p for p in sorted((root / "docs").glob("[0-9][0-9]_*.md")) if p.name not in OTHER_PAGES]


def load(root):
    return json.loads((root / DATA).read_text())


def write(root):
    """Returns the exit code."""
    names = names_of(Numbers(load(root)))
    for page in page_files(root):
        text = page.read_text()
        try:
            filled = filled_marks(text, names, page.relative_to(root))
        except ValueError:
            continue  # check names it
        if filled != text:
            page.write_text(filled)
    return check(root)


def check(root):
    runs, data = read_list(root), load(root)
    numbers, found, marks = Numbers(data), [], 0
    for page in page_files(root):
        try:
            stale, count = stale_marks(page.read_text(), names_of(numbers), page.relative_to(root), DATA, "page_numbers.py")
        except ValueError as fault:
            stale, count = [str(fault)], 0
        found += stale
        marks += count
    needed = {word.partition(":")[0] for words in runs.values() for word in words[1:]}
    for name, words in runs.items():
        if name not in data:
            found.append(f"{LIST}: {name} was not measured; ./run numbers --only {name}")
        elif data[name]["command"] != shlex.join(words):
            found.append(f"{LIST}: {name} was measured with another command; ./run numbers --only {name}")
        elif name not in numbers._asked | needed:
            found.append(f"{LIST}: no page asks for {name}")
    found += [f"{DATA}: {LIST.name} does not list {name}" for name in data if name not in runs]
    return report(found, f"{marks} numbers and tables of the pages are what was measured")


def measure(root, bench, names):
    file = root / DATA
    data = load(root) if file.exists() else {}
    try:
        for name in bench.with_needs(names):
            told = bench.measure(name)
            if told is not None:
                data[name] = told
    finally:  # what was measured before a failure stays
        kept = {name: data[name] for name in bench.runs if name in data}
        unfinished = file.with_suffix(".part")
        unfinished.write_text(json.dumps(kept, indent=1) + "\n")
        os.replace(unfinished, file)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    action = parser.add_mutually_exclusive_group(required=True)
    action.add_argument("--measure", action="store_true", help="measure, then --write")
    action.add_argument("--write", action="store_true", help="put the numbers into the pages")
    action.add_argument("--check", action="store_true", help="only say what differs")
    action.add_argument("--targets", action="store_true", help="print the programs that --measure would run")
    parser.add_argument("--only", nargs="+", default=[], metavar="NN", help="pages (07), names of runs, or patterns")
    parser.add_argument("--bin", type=Path, help="the folder of the programs; default build/bin")
    parser.add_argument("--root", type=Path, default=ROOT, help="another repository")
    options = parser.parse_args()
    root = options.root.resolve()
    bench = Bench(root, (options.bin or root / "build" / "bin").resolve(), root.parent / "shared")
    names = chosen(bench.runs, options.only)
    if options.targets:
        print(" ".join(bench.targets(names)))
        return 0
    if options.measure:
        measure(root, bench, names)
    return check(root) if options.check else write(root)


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (OSError, ValueError, KeyError, RuntimeError) as fault:
        print(f"page_numbers: {fault}", file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        sys.exit(130)
