#!/usr/bin/env bash
# ./run for real, as on a bare machine: no display, no input, nothing but HOME and PATH, from another folder.
# Usage: run_test.sh ROOT BUILD
set -euo pipefail
root="$1" build="$2"
[ -f "$build/build.ninja" ] || { echo "skipped: ./run builds with ninja, and this build folder does not" && exit 77; }
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
cd "$work"
bare=(env -i HOME="${HOME:-$work}" PATH="$PATH" CONEBOOK_BUILD_DIR="$build")
fail() { echo "FAILED: $*" && exit 1; }

"${bare[@]}" "$root/run" 01 --size 64x48 --output picture.png </dev/null >out 2>err || fail "./run 01: $(cat err)"
[ "$(head -c 8 picture.png | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ] || fail "picture.png is not a PNG"
[ "$(od -An -tu1 -j16 -N8 picture.png | tr -s ' ')" = " 0 0 0 64 0 0 0 48" ] || fail "picture.png is not 64x48"
grep -q "picture: $work/picture.png$" out || fail "it does not say where the picture is: $(cat out)"
grep -qE '[0-9]+\.[0-9]+' out || fail "there is no table of times: $(cat out)"

# The second time it starts in a second or two; measured 0.2 s on two idle cores, so 5 s leaves room for a busy machine.
start="$(date +%s%N)"
"${bare[@]}" "$root/run" 01 --size 64x48 --output picture.png </dev/null >out 2>err || fail "./run 01 again: $(cat err)"
took=$((($(date +%s%N) - start) / 1000000))
[ "$took" -lt 5000 ] || fail "the second time took $took ms"

code=0
"${bare[@]}" "$root/run" 01 --view no_such_view --output none.png </dev/null >out 2>err || code=$?
[ "$code" -gt 0 ] || fail "an unknown view has code 0"
[ "$(wc -l <err)" = 1 ] || fail "an unknown view is not one line: $(cat err)"
[ ! -e none.png ] || fail "an unknown view left a picture"
[ "$("$root/run" --list | wc -l)" = "$(grep -c '^add_chapter' "$root/CMakeLists.txt")" ] || fail "--list: not all chapters"
"$root/run" --list | grep -vE '^[0-9]{2}_[a-z_]+ +[^ ]' && fail "--list: a chapter without its line"
echo "passed; the second start took $took ms"
