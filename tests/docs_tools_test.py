#!/usr/bin/env python3
"""The documentation tools find the faults that they are there to find: each test plants one in a small repository."""
import shutil
import subprocess
import sys
import tempfile
import textwrap
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

TOOLS = Path(__file__).resolve().parent.parent / "tools"
MARK = "snippet"  # tags are put together here, so that this file has none of its own

PAGE = """\
# 01 First

![before](figures/a.png) ![after](figures/b.png)

> The takeaway.

## Run it

```sh
./run 01 --view depth --set voxels=64 cones=6
```

## What is new, and where
## Theory
## The code

<!-- {mark}: shaders/a.comp#step -->
```glsl
float s = 1;
if (s > 0)
    s = 2;
```

## What you should see

Try `--view normal`, and `./run 01 --set cones=9`.

## Break it

```sh
./run 01 --set voxels=2
```

## Pitfalls
## References

See [the notation](notation.md#symbols--units).
"""
SHADER = """\
void main()
{{
    // {mark}: step
    float s = 1;
    if (s > 0)
        s = 2;
    // end {mark}
}}
"""
PROGRAM = """\
#!/bin/sh
case "$1" in
--list-views) printf 'final   the picture\\ndepth   depth in metres\\nnormal  unit\\n' ;;
--list-params) printf 'voxels  1..512  64\\ncones  5..32  6\\n' ;;
*) exit 1 ;;
esac
"""


class Repository(unittest.TestCase):
    """A small repository in which everything is right."""

    def setUp(self):
        self.root = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        self.write("CMakeLists.txt", "add_chapter(01_first)\n")
        self.write("docs/01_first.md", PAGE.format(mark=MARK))
        self.write("docs/notation.md", "# Notation\n\n## Symbols & units\n")
        self.write("docs/figures/figures.txt", "# comment\na.png: 01\nb.png: 01 --view depth\nparts/c.exr: 01\n")
        self.write("docs/figures/a.png", "a")
        self.write("docs/figures/b.png", "b")
        self.write("shaders/a.comp", SHADER.format(mark=MARK))
        self.write("bin/01_first", PROGRAM)
        (self.root / "bin/01_first").chmod(0o755)

    def write(self, name, text):
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text)

    def edit(self, name, old, new):
        text = (self.root / name).read_text()
        self.assertIn(old, text)
        self.write(name, text.replace(old, new, 1))

    def at(self, text, name="docs/01_first.md"):
        """`name:line` of the first line that holds the text."""
        lines = (self.root / name).read_text().splitlines()
        return f"{name}:{next(n for n, line in enumerate(lines, 1) if text in line)}"

    def tool(self, name, *arguments):
        result = subprocess.run([sys.executable, TOOLS / name, "--root", self.root, *arguments], capture_output=True,
                                text=True)
        self.assertEqual(result.stderr, "")
        return result.returncode, result.stdout

    def passes(self, *tool):
        code, out = self.tool(*tool)
        self.assertEqual(code, 0, out)
        self.assertEqual(len(out.splitlines()), 1, out)

    def fails(self, expected, *tool, lines=1):
        """The tool ends with 1 and one line for each fault, one of which starts as expected."""
        code, out = self.tool(*tool)
        self.assertEqual(code, 1, out)
        self.assertEqual(len(out.splitlines()), lines, out)
        self.assertTrue(any(line.startswith(expected) for line in out.splitlines()), out)


class Snippets(Repository):
    CHECK = ("snippets.py", "--check")
    WRITE = ("snippets.py", "--write")

    def test_a_page_that_agrees_passes(self):
        self.passes(*self.CHECK)

    def test_a_changed_page_is_found_and_written_again(self):
        before = (self.root / "docs/01_first.md").read_text()
        self.edit("docs/01_first.md", "    s = 2;", "    s = 3;")
        self.fails(self.at("s = 3") + ": differs", *self.CHECK)
        self.passes(*self.WRITE)
        self.assertEqual((self.root / "docs/01_first.md").read_text(), before)
        self.passes(*self.CHECK)

    def test_a_changed_source_is_found(self):
        self.edit("shaders/a.comp", "s = 2", "s = 2.5")
        self.fails(self.at("s = 2;") + ": differs", *self.CHECK)
        self.passes(*self.WRITE)
        self.assertIn("    s = 2.5;\n```\n", (self.root / "docs/01_first.md").read_text())

    def test_changed_indentation_and_missing_lines_are_found(self):
        self.edit("docs/01_first.md", "\n    s = 2;", "\ns = 2;")
        self.fails(self.at("s = 2;") + ": differs", *self.CHECK)
        self.edit("docs/01_first.md", "if (s > 0)\n", "")
        self.fails(self.at("s = 2;") + ": differs", *self.CHECK)

    def test_a_missing_block_is_found_and_written(self):
        text = (self.root / "docs/01_first.md").read_text()
        begin = text.index("```glsl")
        end = text.index("```\n", begin + 3) + 4
        self.write("docs/01_first.md", text[:begin] + text[end:])
        self.fails("docs/01_first.md:18: differs", *self.CHECK)
        self.passes(*self.WRITE)
        self.assertEqual((self.root / "docs/01_first.md").read_text(), text)

    def test_an_unknown_tag_and_file_are_found(self):
        self.edit("docs/01_first.md", "#step", "#stop")
        self.fails(self.at("#stop") + ": shaders/a.comp has no snippet 'stop'", *self.CHECK, lines=2)
        self.edit("docs/01_first.md", "a.comp#stop", "b.comp#step")
        self.fails(self.at("b.comp") + ": shaders/b.comp has no snippet 'step'", *self.CHECK, lines=2)

    def test_an_unused_tag_is_found(self):
        self.write("common/x.hpp", f"// {MARK}: other\nint i;\n// end {MARK}\n")
        self.fails("common/x.hpp: snippet 'other' is quoted by no page", *self.CHECK)

    def test_faulty_tags_are_found(self):
        body = "int i;\n" * 21
        self.write("common/x.hpp", f"// {MARK}: long\n{body}// end {MARK}\n")
        self.fails("common/x.hpp:1: snippet 'long' has 21 lines", *self.CHECK, lines=2)
        self.write("common/x.hpp", f"// {MARK}: open\nint i;\n")
        self.fails("common/x.hpp:1: snippet 'open' does not end", *self.CHECK)
        self.write("common/x.hpp", f"// end {MARK}\n")
        self.fails("common/x.hpp:1: a snippet ends that did not begin", *self.CHECK)
        twice = f"// {MARK}: twice\nint i;\n// end {MARK}\n" * 2
        self.write("common/x.hpp", twice)
        self.fails("common/x.hpp:4: there are two snippets 'twice'", *self.CHECK, lines=2)

    def test_markers_shown_in_a_code_block_are_left_alone(self):
        self.write("docs/how.md", f"````markdown\n<!-- {MARK}: no/such#tag -->\n```glsl\n```\n````\n")
        self.passes(*self.CHECK)

    def test_a_marker_with_a_slip_is_found(self):
        self.edit("docs/01_first.md", "a.comp#step", "a.comp step")
        self.fails(self.at("a.comp step") + ": the marker is not", *self.CHECK, lines=2)


class Pages(Repository):
    def check(self):
        return "check_docs.py", "--bin", self.root / "bin"

    def test_pages_in_order_pass(self):
        self.passes(*self.check())

    def test_dead_links_are_found(self):
        self.edit("docs/01_first.md", "notation.md#symbols--units", "notations.md")
        self.fails(self.at("notations") + ": notations.md does not exist", *self.check())
        self.edit("docs/01_first.md", "notations.md", "notation.md#nothing")
        self.fails(self.at("#nothing") + ": notation.md has no heading #nothing", *self.check())

    def test_links_in_code_are_not_links(self):
        self.edit("docs/notation.md", "# Notation", "# Notation\n\n`[a](b)` and\n\n```\n[c](d)\n```\n")
        self.passes(*self.check())

    def test_a_missing_picture_is_found(self):
        (self.root / "docs/figures/b.png").unlink()
        self.fails("docs/01_first.md:3: figures/b.png does not exist", *self.check(), lines=2)

    def test_a_picture_that_nobody_shows_or_makes_is_found(self):
        self.write("docs/figures/c.png", "c")
        self.fails("docs/figures/c.png: figures.txt does not say how it is made", *self.check(), lines=2)

    def test_a_drawing_that_nobody_shows_is_found(self):
        self.write("docs/figures/01_c.svg", "<svg/>")
        self.fails("docs/figures/01_c.svg: no page shows it", *self.check())
        self.edit("docs/01_first.md", "## Theory\n", "## Theory\n\n![a drawing](figures/01_c.svg)\n")
        self.passes(*self.check())

    def test_a_chapter_without_page_is_found(self):
        self.edit("CMakeLists.txt", "add_chapter", "add_chapter(02_second)\nadd_chapter")
        self.fails("docs/02_second.md: chapter 02_second has no page", *self.check())

    def test_headings_are_required_in_order(self):
        self.edit("docs/01_first.md", "## Theory\n", "")
        self.fails("docs/01_first.md: the headings are not those of TEMPLATE.md: Theory", *self.check())
        self.edit("docs/01_first.md", "## Pitfalls\n", "## Theory\n## Pitfalls\n")
        self.fails("docs/01_first.md: the headings are not those of TEMPLATE.md: wrong order", *self.check())

    def test_takeaway_pictures_and_title_are_required(self):
        self.edit("docs/01_first.md", "> The", "The")
        self.fails("docs/01_first.md: the takeaway", *self.check())
        self.edit("docs/01_first.md", "The take", "> The take")
        self.edit("docs/01_first.md", "# 01 First", "# First")
        self.fails("docs/01_first.md: the page needs one title", *self.check())
        self.edit("docs/01_first.md", "# First", "# 01 First")
        self.edit("docs/01_first.md", "## Run it", "## Run it\n\n![more](figures/b.png)\n")
        self.edit("docs/01_first.md", " ![after](figures/b.png)", "")
        self.fails("docs/01_first.md: a picture before and one after", *self.check())

    def test_break_it_needs_a_command(self):
        self.edit("docs/01_first.md", "./run 01 --set voxels=2", "./run 01")
        self.fails("docs/01_first.md: 'Break it' has no command", *self.check())

    def test_unknown_views_parameters_and_chapters_are_found(self):
        self.edit("docs/01_first.md", "--view normal", "--view norm")
        self.fails(self.at("view norm") + ": 01_first has no view norm", *self.check())
        self.edit("docs/01_first.md", "--view norm", "--view normal")
        self.edit("docs/01_first.md", "cones=6", "cone=6")
        self.fails(self.at("cone=6") + ": 01_first has no parameter cone", *self.check())
        self.edit("docs/01_first.md", "cone=6", "cones=6")
        self.edit("docs/notation.md", "# Notation", "# Notation\n\n`./run 07`\n")
        self.fails("docs/notation.md:3: there is no chapter 07", *self.check())


class Pictures(Repository):
    """The gallery, with programs that write their arguments into the picture."""

    def setUp(self):
        super().setUp()
        for name in ("01_first", "sheet", "compare", "reference"):
            script = ('#!/bin/sh\nall="$*"\nwhile [ $# -gt 0 ]; do case "$1" in --output|--heatmap) out="$2" ;; esac; '
                      f'shift; done\ncase "$all" in *bad*) echo no good >&2; exit 3 ;; esac\necho "{name} $all" >"$out"\n')
            self.write(f"build/bin/{name}", script)
            (self.root / f"build/bin/{name}").chmod(0o755)
        for name in ("a.png", "b.png"):
            (self.root / "docs/figures" / name).unlink()
        self.write("shared/there.glb", "scene")
        self.write("docs/figures/figures.txt", """\
# comment
a.png: 01 --scene assets/x.glb --view depth
parts/one.exr: 01 --set cones=6
parts/two.exr: reference --spp 4
heat.png: compare parts/one.exr parts/two.exr
both.png: sheet --columns 2 a.png heat.png
""")
        self.figures = self.root / "docs/figures"
        self.parts = self.root / "build/figures/parts"

    def gallery(self, *arguments, code=0):
        result = subprocess.run([sys.executable, TOOLS / "gallery.py", "--root", self.root, "--shared",
                                 self.root / "shared", *arguments], capture_output=True, text=True)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result.stdout + result.stderr

    def test_all_are_made_with_their_commands(self):
        self.gallery()
        self.assertEqual((self.figures / "a.png").read_text(),
                         f"01_first --scene {self.root}/assets/x.glb --view depth --headless --output {self.figures}/a.png\n")
        self.assertEqual((self.figures / "heat.png").read_text(),
                         f"compare {self.parts}/one.exr {self.parts}/two.exr --heatmap {self.figures}/heat.png\n")
        self.assertEqual((self.parts / "two.exr").read_text(), f"reference --spp 4 --output {self.parts}/two.exr\n")
        self.assertEqual((self.figures / "both.png").read_text(),
                         f"sheet --columns 2 {self.figures}/a.png {self.figures}/heat.png --output {self.figures}/both.png\n")

    def test_only_the_named_and_what_they_need(self):
        self.gallery("h*.png")
        self.assertEqual([path.name for path in self.figures.glob("*.png")], ["heat.png"])
        self.assertEqual(sorted(path.name for path in self.parts.iterdir()), ["one.exr", "two.exr"])
        self.assertIn("no_such.png", self.gallery("no_such.png", code=2))

    def test_missing_leaves_what_is_there(self):
        self.write("docs/figures/a.png", "old")
        self.gallery("--missing")
        self.assertEqual((self.figures / "a.png").read_text(), "old")
        self.assertTrue((self.figures / "both.png").exists())

    def test_a_command_that_fails_is_reported(self):
        self.edit("docs/figures/figures.txt", "cones=6", "bad=6")
        out = self.gallery(code=1)
        self.assertIn("no good", out)
        self.assertIn("2 of 3 were not made: heat.png both.png", out)

    def test_a_scene_that_is_not_there_skips_the_picture(self):
        self.edit("docs/figures/figures.txt", "assets/x.glb", "{shared}/there.glb")
        self.gallery()
        self.assertIn(f"--scene {self.root}/shared/there.glb", (self.figures / "a.png").read_text())
        self.edit("docs/figures/figures.txt", "there.glb", "not_there.glb")
        self.assertIn(f"a.png: skipped, there is no {self.root}/shared/not_there.glb", self.gallery("a.png", code=1))


class MeasuredNumbers(Repository):
    """Programs that tell what they were called with, and a page that asks for it."""
    CHECK = ("page_numbers.py", "--check")

    def setUp(self):
        super().setUp()
        told = ("{\"driver\": \"d, 4.5\", \"counts\": [{\"name\": \"voxels\", \"value\": 1234.0}], "
                "\"passes\": [{\"name\": \"draw\", \"min_ms\": 2.5}], \"resources\": [{\"name\": \"t\", \"bytes\": 3000000}]}")
        self.program("01_first", f"'{told}'")
        self.program("compare", "'{\"smape\": 0.25}'")
        self.program("01_test", '"{\\"testsuites\\": [{\\"testsuite\\": [{\\"name\\": \\"Wall\\", \\"time\\": \\"1s\\", \\"most\\": '
                                '\\"$(grep -c "float s" $CONEBOOK_ROOT/shaders/a.comp)\\"}]}]}"; exit 1')
        self.write("docs/data/numbers.txt", """\
# comment
01_a: 01 --set voxels=64
01_b: 01 --scene assets/x.glb --camera 1
01_error: compare 01_a 01_b
01_edited: edit shaders/a.comp "float s = 1;" "" test 01_test --gtest_filter=*
""")
        marks = ['whole(count("01_a", "voxels"))', 'fixed(ms("01_a", "draw") + megabytes("01_b", "t"), 1)',
                 'percent(value("01_error", "smape"))', 'value("01_edited", "Wall.most")', 'command("01_b")',
                 'table("run | ms", {"a": "01_a", "b": "01_b"}, lambda run: [fixed(ms(run, "draw"), 1)])']
        self.edit("docs/01_first.md", "## Pitfalls", "\n".join(f"<!-- data: {m} --><!-- end -->" for m in marks) + "\n## Pitfalls")
        self.measure()

    def program(self, name, told):
        self.write(f"build/bin/{name}", '#!/bin/bash\necho "$0 $*" >>"${0%/*}/log"\nwhile [ $# -gt 0 ]; do case "$1" in '
                   '--stats|--json) out="$2" ;; --gtest_output=json:*) out="${1#*:}" ;; esac; shift; done\n'
                   f'echo {told.partition("; ")[0]} >"$out"\n{told.partition("; ")[2]}\n')
        (self.root / f"build/bin/{name}").chmod(0o755)

    def measure(self, *names):
        result = subprocess.run([sys.executable, TOOLS / "page_numbers.py", "--root", self.root, "--measure", *(("--only", *names) if names else ())],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_what_was_measured_is_on_the_page(self):
        self.passes(*self.CHECK)
        page = (self.root / "docs/01_first.md").read_text()
        for value in ("1,234", "5.5", "25 %", "`./run 01 --scene assets/x.glb --camera 1`",
                      "\n| run | ms |\n|---|---|\n| a | 2.5 |\n| b | 2.5 |\n"):
            self.assertIn(f"-->{value}<!-- end -->", page)
        self.assertIn("-->0.0<!-- end -->", page)  # the test saw the edited shader
        self.assertIn("float s = 1;", (self.root / "shaders/a.comp").read_text())

    def test_runs_have_their_commands(self):
        log = (self.root / "build/bin/log").read_text()
        pictures = self.root / "build/numbers"
        self.assertIn(f"01_first --scene {self.root}/assets/x.glb --camera 1 --headless --output {pictures}/01_b.exr --stats", log)
        self.assertIn(f"compare {pictures}/01_a.exr {pictures}/01_b.exr --json", log)
        self.assertLess(log.index("01_a.exr --stats"), log.index("/compare"))

    def test_a_typed_number_is_found_and_written_again(self):
        before = (self.root / "docs/01_first.md").read_text()
        self.edit("docs/01_first.md", "1,234", "1,235")
        self.fails(self.at("1,235") + ': whole(count("01_a", "voxels")) is not what docs/data/numbers.json gives', *self.CHECK)
        self.passes("page_numbers.py", "--write")
        self.assertEqual((self.root / "docs/01_first.md").read_text(), before)

    def test_a_changed_or_new_run_must_be_measured(self):
        self.edit("docs/data/numbers.txt", "voxels=64", "voxels=32")
        self.fails("docs/data/numbers.txt: 01_a was measured with another command", *self.CHECK)
        self.measure("01_a")
        self.passes(*self.CHECK)
        self.edit("docs/data/numbers.txt", "01_a:", "01_c: 01\n01_a:")
        self.fails("docs/data/numbers.txt: 01_c was not measured", *self.CHECK)

    def test_a_run_that_no_page_asks_for_is_found(self):
        self.edit("docs/data/numbers.txt", "01_a:", "01_c: 01\n01_a:")
        result = subprocess.run([sys.executable, TOOLS / "page_numbers.py", "--root", self.root, "--measure", "--only", "01_c"],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 1)
        self.fails("docs/data/numbers.txt: no page asks for 01_c", *self.CHECK)

    def test_an_edit_must_find_its_place(self):
        self.edit("docs/data/numbers.txt", "float s = 1;", "float s = 9;")
        result = subprocess.run([sys.executable, TOOLS / "page_numbers.py", "--root", self.root, "--measure", "--only", "01_edited"],
                                capture_output=True, text=True)
        self.assertEqual(result.returncode, 2)
        self.assertIn("shaders/a.comp holds 'float s = 9;' 0 times, not once", result.stderr)


class Drawings(Repository):
    CHECK = ("drawings", "--check")
    NAME = "docs/figures/03_depth_compare.svg"

    def setUp(self):
        super().setUp()
        code, out = self.tool("drawings")
        self.assertEqual(code, 0)
        self.assertIn("03_depth_compare.svg", out.splitlines())

    def test_what_was_drawn_passes(self):
        self.passes(*self.CHECK)

    def test_drawings_are_well_formed_and_have_a_title(self):
        for path in (self.root / "docs/figures").glob("*.svg"):
            root = ElementTree.parse(path).getroot()
            self.assertTrue(root.find("{http://www.w3.org/2000/svg}title").text, path.name)

    def test_a_changed_a_missing_and_a_foreign_drawing_are_found(self):
        self.edit(self.NAME, "light", "lamp")
        self.fails(f"{self.NAME} is not what tools/drawings draws", *self.CHECK)
        (self.root / self.NAME).unlink()
        self.fails(f"{self.NAME} is missing", *self.CHECK)
        self.tool("drawings")
        self.write("docs/figures/03_other.svg", "<svg/>")
        self.fails("docs/figures/03_other.svg is drawn by no function", *self.CHECK)
        self.tool("drawings")
        self.passes(*self.CHECK)


if __name__ == "__main__":
    unittest.main()
