"""What the documentation tools share: reading Markdown pages, and knowing the repository."""
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FENCE = re.compile(r"^ {0,3}(`{3,}|~{3,})(.*)$")
MARK = re.compile(r"<!-- data:\s(.+?)\s-->(.*?)<!-- end -->", re.S)
SKIPPED_FOLDERS = re.compile(r"^(build.*|out|\..*|__pycache__)$")


def walk(root):
    """Every file of the repository, without build folders, output and hidden folders."""
    for path in sorted(Path(root).iterdir()):
        if path.is_dir():
            if not SKIPPED_FOLDERS.match(path.name):
                yield from walk(path)
        else:
            yield path


def markdown_pages(root):
    return [path for path in walk(root) if path.suffix == ".md"]


def lines_with_fences(text):
    """Pairs (line, info): info is None in running text, else the info string of the code block that the line is in.

    The lines that open and close a block count as in it. A block closes with at least as many of the same marks.
    """
    info = marks = None
    for line in text.splitlines():
        fence = FENCE.match(line)
        if info is None:
            if fence:
                marks, info = fence.group(1), fence.group(2).strip()
            yield line, info
        else:
            yield line, info
            closes = fence and fence.group(1).startswith(marks) and not fence.group(2).strip()
            if closes:
                info = marks = None


def chapters(root):
    """The chapters in order, as CMakeLists.txt lists them."""
    text = (Path(root) / "CMakeLists.txt").read_text()
    return re.findall(r"^add_chapter\((\d\d_[a-z0-9_]+)\)", text, re.M)


def filled_marks(text, names, label):
    """The page with the value of every <!-- data: EXPRESSION -->VALUE<!-- end --> made anew from `names`.

    Raises ValueError naming an expression that fails.
    """
    def value(match):
        expression = match.group(1)
        try:
            made = eval(f"({expression})", {"__builtins__": {}, **names})  # the page is the repository's own
        except Exception as fault:
            said = f"{' '.join(expression.split())}: {type(fault).__name__}: {fault}"
            raise ValueError(f"{label}: {said}") from fault
        return match.group(0)[:match.start(2) - match.start(0)] + f"{made}<!-- end -->"
    return MARK.sub(value, text)


def stale_marks(text, names, label, data, tool):
    """One line for each mark whose value is not what the data give, and the number of marks."""
    pairs = list(zip(MARK.finditer(text), MARK.finditer(filled_marks(text, names, label))))
    return [f"{label}:{text.count(chr(10), 0, old.start()) + 1}: {' '.join(old.group(1).split())} is not what {data} "
            f"gives; run tools/{tool} --write" for old, new in pairs if old.group(2) != new.group(2)], len(pairs)


def report(problems, ok):
    """Print the problems, one line each, or the line `ok`. Returns the exit code."""
    for problem in problems:
        print(problem)
    if not problems:
        print(ok)
    return 1 if problems else 0
