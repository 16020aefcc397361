#!/usr/bin/env python3
"""How soon a window answers: from the start of the process to its first pictures, and from a key, a drag or a resize that
comes while it draws to the picture that shows it. Needs Xvfb and libXtst (packages xvfb, xdotool).

    ./run bench window [--size 1280x720] [--times 15] [--chapters 01 08 12] [-- ARGUMENTS OF THE PROGRAMS]

Times are of this machine as it is: with a loaded one they are larger. chrt -f 1 ./run bench window ... (as root) lets the
programs go first.
"""
import argparse
import ctypes
import os
import random
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
X_KEY = {"Tab": 0xFF09, "Escape": 0xFF1B, "1": 0x31, "w": 0x77}


class Screen:
    """A virtual X server, and events sent to it by its test extension."""

    def __init__(self, size):
        read, write = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", f"{size[0]}x{size[1]}x24",
                                        "-nolisten", "tcp"], pass_fds=[write], stderr=subprocess.DEVNULL)
        os.close(write)
        self.name = ":" + os.read(read, 16).decode().strip()
        self.x11, self.xtst = ctypes.CDLL("libX11.so.6"), ctypes.CDLL("libXtst.so.6")
        self.x11.XOpenDisplay.restype = ctypes.c_void_p
        self.x11.XDefaultRootWindow.restype = ctypes.c_ulong
        self.display = ctypes.c_void_p(self.x11.XOpenDisplay(self.name.encode()))

    def window(self):
        """The last of the root's children that is as large as a window is, or None."""
        root = ctypes.c_ulong(self.x11.XDefaultRootWindow(self.display))
        a, b, count = ctypes.c_ulong(), ctypes.c_ulong(), ctypes.c_uint()
        children = ctypes.POINTER(ctypes.c_ulong)()
        self.x11.XQueryTree(self.display, root, ctypes.byref(a), ctypes.byref(b), ctypes.byref(children),
                            ctypes.byref(count))
        found = None
        for i in range(count.value):
            width, height = ctypes.c_uint(), ctypes.c_uint()
            other = [ctypes.c_int() for _ in range(2)] + [ctypes.c_uint() for _ in range(2)]
            self.x11.XGetGeometry(self.display, ctypes.c_ulong(children[i]), ctypes.byref(a), ctypes.byref(other[0]),
                                  ctypes.byref(other[1]), ctypes.byref(width), ctypes.byref(height),
                                  ctypes.byref(other[2]), ctypes.byref(other[3]))
            if width.value > 100:
                found = children[i]
        return found

    def move_to(self, x, y):
        self.xtst.XTestFakeMotionEvent(self.display, -1, x, y, ctypes.c_ulong(0))
        self.x11.XSync(self.display, 0)

    def key(self, name):
        code = self.x11.XKeysymToKeycode(self.display, ctypes.c_ulong(X_KEY[name]))
        for down in (1, 0):
            self.xtst.XTestFakeKeyEvent(self.display, code, down, ctypes.c_ulong(0))
        self.x11.XSync(self.display, 0)

    def drag(self, x, y):
        self.xtst.XTestFakeButtonEvent(self.display, 3, 1, ctypes.c_ulong(0))
        self.xtst.XTestFakeRelativeMotionEvent(self.display, x, y, ctypes.c_ulong(0))
        self.xtst.XTestFakeButtonEvent(self.display, 3, 0, ctypes.c_ulong(0))
        self.x11.XSync(self.display, 0)

    def resize(self, size):
        self.x11.XResizeWindow(self.display, ctypes.c_ulong(self.window()), *size)
        self.x11.XSync(self.display, 0)

    def close(self):
        self.x11.XCloseDisplay(self.display)
        self.server.terminate()
        self.server.wait()


class Program:
    """A chapter in a window; its pictures are the lines of --trace-frames."""

    def __init__(self, screen, chapter, size, arguments, folder):
        self.trace = Path(folder) / "trace"
        self.trace.unlink(missing_ok=True)
        program = Path(os.environ.get("CONEBOOK_BIN", ROOT / "build" / "bin")) / chapter
        environment = dict(os.environ, DISPLAY=screen.name, CONEBOOK_ROOT=str(ROOT))
        environment.setdefault("MESA_SHADER_CACHE_DIR", str(ROOT / "build" / "shader_cache"))
        environment.pop("WAYLAND_DISPLAY", None)
        self.start_s = time.monotonic()
        self.process = subprocess.Popen([program, "--size", f"{size[0]}x{size[1]}", "--trace-frames", self.trace,
                                         *arguments], env=environment, cwd=folder, stderr=subprocess.DEVNULL)

    def pictures(self):
        lines = self.trace.read_text().split("\n")[:-1] if self.trace.exists() else []
        return [dict(zip(("s", "what", "size", "window", "view", "sample", "changes"),
                         (float(w[0]), w[1], w[2], w[3], w[4], int(w[5]), int(w[6]))))
                for w in (line.split() for line in lines)]

    def wait_for(self, wanted):
        """The first picture that is wanted."""
        deadline = time.monotonic() + 120
        while time.monotonic() < deadline and self.process.poll() is None:
            for picture in self.pictures():
                if wanted(picture):
                    return picture
            time.sleep(0.01)
        sys.exit(f"{self.process.args[0]}: shows nothing any more")


def measure(screen, chapter, size, arguments, times, folder):
    """{what: [seconds]} of one chapter."""
    found = {"first picture": [], "first frame": [], "key at start": [], "key": [], "drag": [], "resize": []}
    chance = random.Random(0)

    def answer_to(send):
        changes = program.pictures()[-1]["changes"]
        sent_s = time.monotonic()
        send()
        return program.wait_for(lambda p: p["s"] > sent_s and p["changes"] > changes)["s"] - sent_s

    screen.move_to(size[0] // 2, size[1] // 2)
    for _ in range(max(3, times // 2)):
        program = Program(screen, chapter, size, arguments, folder)
        found["first picture"].append(program.wait_for(lambda p: True)["s"] - program.start_s)
        found["first frame"].append(program.wait_for(lambda p: p["what"] == "frame")["s"] - program.start_s)
        program.process.kill()
        program.process.wait()
        # Once more, with a key at any moment before the first frame.
        program = Program(screen, chapter, size, arguments, folder)
        first = program.wait_for(lambda p: True)["s"] - program.start_s
        time.sleep(chance.uniform(0.0, 0.8 * max(0.0, found["first frame"][-1] - first)))
        found["key at start"].append(answer_to(lambda: screen.key("Tab")))
        program.process.kill()
        program.process.wait()
    program = Program(screen, chapter, size, arguments, folder)
    program.wait_for(lambda p: p["what"] == "frame")
    for i in range(times):
        other = (size[0] - 16 * (i % 2) - 16, size[1] - 16)
        events = {"key": lambda: screen.key("Tab" if i % 2 == 0 else "1"),
                  "drag": lambda: screen.drag(20 if i % 2 == 0 else -20, 5 if i % 2 == 0 else -5),
                  "resize": lambda: screen.resize(other)}
        for what, send in events.items():
            # At any moment of what is drawn by then: coarse, finer or whole pictures.
            time.sleep(chance.uniform(0.05, 2.0))
            found[what].append(answer_to(send))
    screen.key("Escape")
    if program.process.wait(timeout=60) != 0:
        sys.exit(f"{chapter}: ended with code {program.process.returncode}")
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--times", type=int, default=15)
    parser.add_argument("--chapters", nargs="+", default=["01", "08", "12"])
    parser.add_argument("arguments", nargs="*", help="after --: of the programs, such as --scene FILE")
    options = parser.parse_args()
    size = tuple(int(side) for side in options.size.split("x"))
    screen = Screen((size[0] + 64, size[1] + 64))
    print(f"{'chapter':24} {'what':14} {'min s':>8} {'median s':>9} {'max s':>8} {'N':>4}")
    try:
        for chapter in options.chapters:
            names = [path.name for path in sorted((ROOT / "chapters").glob(f"{chapter}*"))]
            if len(names) != 1:
                sys.exit(f"{chapter}: no chapter is called so")
            with tempfile.TemporaryDirectory() as folder:
                found = measure(screen, names[0], size, options.arguments, options.times, folder)
            for what, seconds in found.items():
                print(f"{names[0]:24} {what:14} {min(seconds):8.3f} {statistics.median(seconds):9.3f} "
                      f"{max(seconds):8.3f} {len(seconds):4}", flush=True)
    finally:
        screen.close()


if __name__ == "__main__":
    main()
