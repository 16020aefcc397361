#!/usr/bin/env bash
# ./run, ./test and tools/setup.sh, with stand-ins for apt-get, cmake, ninja, ctest and the programs, which write down
# how they were called. The scripts under test are copies in a small repository of its own.
# Usage: commands_test.sh ROOT
set -euo pipefail
source_root="$1"
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
failures=0 checks=0

check() {  # check WHAT EXPECTED ACTUAL: equal
    checks=$((checks + 1))
    [ "$2" = "$3" ] && return
    failures=$((failures + 1))
    printf 'FAILED: %s\n  expected: %s\n  actual:   %s\n' "$1" "$2" "$3"
}
check_has() {  # check_has WHAT PATTERN TEXT: a line matches
    checks=$((checks + 1))
    grep -qE -- "$2" <<<"$3" && return
    failures=$((failures + 1))
    printf 'FAILED: %s\n  no line matches: %s\n  in: %s\n' "$1" "$2" "$3"
}

fake() {  # fake NAME BODY: a program in the PATH that logs its arguments and then does BODY
    printf '#!/bin/bash\necho "%s $*" >>"$FAKE_LOG"\n%s\n' "$1" "$2" >"$work/fakes/$1"
    chmod +x "$work/fakes/$1"
}

repository="$work/a repository"  # paths with spaces must do
mkdir -p "$work/fakes" "$work/elsewhere" "$repository/tools" "$repository/.ci"
cp "$source_root/run" "$source_root/test" "$repository/"
cp "$source_root/.ci/run" "$repository/.ci/"
cp "$source_root/tools/setup.sh" "$repository/tools/"
printf '# comment\nalpha-dev   # why\n\nbeta-dev\ngamma\n' >"$repository/packages.txt"
for name in 07_first 12_second_bounce; do
    echo "add_chapter($name)" >>"$repository/CMakeLists.txt"
    mkdir -p "$repository/chapters/$name"
    echo "// $name: the idea of ${name#*_}" >"$repository/chapters/$name/main.cpp"
done

export FAKE_LOG="$work/log"
program='case "$*" in *bad*) echo "bad: no such thing" >&2; exit 3 ;; esac
while [ $# -gt 0 ]; do case "$1" in --output) echo picture >"$2" ;; --output=*) echo picture >"${1#*=}" ;; esac; shift; done'
install_all() { fake dpkg-query 'printf "installed alpha-dev\ninstalled beta-dev\ninstalled gamma\n"'; }
install_all
fake id 'echo 0'
fake sudo '"$@"'
fake apt-get ''
fake ctest 'echo "goldens=${CONEBOOK_UPDATE_GOLDENS:-}" >>"$FAKE_LOG"; echo "100% tests passed"'
fake ninja 'echo "ninja: no work to do."'
fake cmake 'while [ $# -gt 0 ]; do [ "$1" = -B ] && b="$2"; [ "$1" = -S ] && s="$2"; shift; done
echo "CMAKE_HOME_DIRECTORY:INTERNAL=$s" >"$b/CMakeCache.txt"; touch "$b/build.ninja"; mkdir -p "$b/bin"
for n in 07_first 12_second_bounce reference compare; do cp "'"$work"'/fakes/program_$n" "$b/bin/$n"; done'
for name in 07_first 12_second_bounce reference compare; do fake "program_$name" "$program"; done

# Called as on a bare machine: nothing but HOME and PATH, from another folder, no input. Sets out, err, code, log.
call() {  # call [VARIABLE=VALUE...] -- COMMAND ARGUMENTS...
    local variables=()
    while [ "$1" != -- ]; do variables+=("$1") && shift; done
    shift
    : >"$FAKE_LOG"
    code=0
    (cd "$work/elsewhere" && env -i HOME="$work" PATH="$work/fakes:/usr/bin:/bin" FAKE_LOG="$FAKE_LOG" "${variables[@]}" \
        bash "$repository/$1" "${@:2}" </dev/null >"$work/out" 2>"$work/err") || code=$?
    out="$(cat "$work/out")" err="$(cat "$work/err")" log="$(cat "$FAKE_LOG")"
}
program_calls() { grep '^program_' <<<"$log" | sed 's/^program_//' || true; }

for script in run test .ci/run tools/setup.sh; do
    checks=$((checks + 1))
    bash -n "$repository/$script" || failures=$((failures + 1))
done

# What needs neither packages nor a build
call -- run --list
check "--list" "07_first 12_second_bounce" "$(awk '{printf "%s%s", s, $1; s = " "}' <<<"$out")"
check_has "--list says what each is" '^07_first +the idea of first$' "$out"
check "--list starts nothing" "" "$log"
call -- run 99 --view x
check "unknown chapter: code" 2 "$code"
check "unknown chapter: one line" "conebook: there is no chapter 99; ./run --list names them" "$err"
check "unknown chapter: starts nothing" "" "$log"

# First time
picture="$repository/out/12_second_bounce.png"
call -- run
check "first run: code" 0 "$code"
check_has "first run configures" "^cmake -G Ninja -DCMAKE_BUILD_TYPE=Release -S $repository -B $repository/build\$" "$log"
check_has "first run builds all programs" '^ninja .* 07_first 12_second_bounce reference compare$' "$log"
check "first run renders chapter 12" "12_second_bounce --headless --output $picture --print-stats" "$(program_calls)"
check_has "first run says where" "picture: $picture\$" "$out"
check "nothing to install: no apt-get" "" "$(grep apt-get <<<"$log" || true)"

# Later, and arguments
call -- run
check "second run does not configure" "" "$(grep '^cmake' <<<"$log" || true)"
check_has "second run builds quietly" '^ninja .*--quiet' "$log"
check "nothing to do: nothing is said about it" "" "$err"
call -- run 7 --view depth --scene "a b.glb"
check "arguments are passed" \
    "07_first --view depth --scene a b.glb --headless --output $repository/out/07_first_depth.png --print-stats" "$(program_calls)"
check_has "only the chapter is built" '^ninja .* 07_first$' "$log"
call -- run --set voxels=64
check_has "options alone are for chapter 12" '^12_second_bounce --set voxels=64 --headless' "$(program_calls)"
call -- run 07 --output y.exr
check "an output of the user's is kept" "07_first --output y.exr --headless --print-stats" "$(program_calls)"
call -- run 07 --headless --output=x.png
check "and so is --headless" "07_first --headless --output=x.png --print-stats" "$(program_calls)"
check_has "and named in full" "picture: $work/elsewhere/x.png\$" "$out"
call -- run 07 --list-views
check "--list-views is passed as it is" "07_first --list-views" "$(program_calls)"
call DISPLAY=:5 -- run 07 --view depth
check "with a display: a window" "07_first --view depth" "$(program_calls)"
call WAYLAND_DISPLAY=wayland-0 -- run
check "with Wayland: a window" "12_second_bounce " "$(program_calls)"
call -- run compare a.exr b.exr
check "compare" "compare a.exr b.exr" "$(program_calls)"
call -- run reference --spp 4
check "reference" "reference --spp 4" "$(program_calls)"
fake python3 ''
call -- run ladder --bounces 2
check_has "the ladder builds its programs" '^ninja .* reference compare 12_second_bounce$' "$log"
check_has "the ladder" "^python3 $repository/tools/ladder.py --bin $repository/build/bin --bounces 2\$" "$log"
call -- run report --quick --no-figures
check_has "report builds what it measures" '^ninja .* 14_speed_against_error 12_second_bounce reference compare sheet$' "$log"
check_has "report" "^python3 $repository/tools/report.py --quick --no-figures\$" "$log"
fake python3 'case "$*" in *--targets*) echo 07_first compare ;; esac'
call -- run numbers --only 07
check_has "numbers builds what it measures" '^ninja .* 07_first compare$' "$log"
check_has "numbers" "^python3 $repository/tools/page_numbers.py --bin $repository/build/bin --measure --only 07\$" "$log"
call -- run bench --quick --no-figures
check_has "bench builds what it measures" '^ninja .* 14_speed_against_error bench_fetch$' "$log"
check_has "bench" "^python3 $repository/tools/bench.py --quick --no-figures\$" "$log"
rm "$work/fakes/python3"
call -- run 07 --set bad=1
check "the program's code" 3 "$code"
check_has "the program's message" '^bad: no such thing$' "$err"
check "no picture is claimed" "" "$(grep picture <<<"$out" || true)"

# A build folder of another place is made again
sed -i 's|=.*|=/elsewhere|' "$repository/build/CMakeCache.txt"
call -- run
check_has "a moved repository is configured again" '^cmake --fresh' "$log"

# Packages
fake dpkg-query 'printf "installed alpha-dev\nconfig-files beta-dev\n"; exit 1'
call -- run
check "missing packages, root" "env DEBIAN_FRONTEND apt-get install" \
    "$(grep -q '^apt-get .*update$' <<<"$log" && grep -q '^apt-get .*install -y --no-install-recommends beta-dev gamma$' <<<"$log" &&
        ! grep -q ^sudo <<<"$log" && echo env DEBIAN_FRONTEND apt-get install)"
check_has "missing packages are named" 'installing with apt-get: beta-dev gamma$' "$out"
fake id 'echo 1000'
call -- run
check_has "missing packages, not root" '^sudo env DEBIAN_FRONTEND=noninteractive apt-get .*install -y .* beta-dev gamma$' "$log"
check_has "missing packages, not root: says so" 'installing with sudo apt-get: beta-dev gamma$' "$out"
rm "$work/fakes/sudo"
if ! PATH=/usr/bin:/bin command -v sudo >/dev/null; then
    call -- run
    check "no sudo: code" 3 "$code"
    check "no sudo: one line" "conebook: packages are missing, and there is no sudo to install them with; as root: apt-get install beta-dev gamma" "$err"
fi
fake id 'echo 0'
fake apt-get 'case "$*" in *install*) exit 100 ;; esac'
call -- test
check "apt-get fails: code" 3 "$code"
check_has "apt-get fails: message" '^conebook: apt-get could not install: beta-dev gamma$' "$err"
install_all

# ./test and .ci/run
call -- test
check_has "test builds everything" '^ninja -C [^"]*/build --quiet$' "$log"
check_has "test runs ctest" '^ctest --test-dir .*/build --output-on-failure --no-tests=error -j2 *$' "$log"
check "ctest's last line is the last" "100% tests passed" "$(tail -n 1 <<<"$out")"
call -- test -L hard
check_has "arguments go to ctest" '^ctest .*-j2 -L hard$' "$log"
call -- test --update-goldens
check_has "--update-goldens" '^ctest .*-j2 -L golden$' "$log"
check_has "--update-goldens is told to the tests" '^goldens=1$' "$log"
fake ctest 'exit 8'
call -- .ci/run
check ".ci/run runs the tests, and has their code" "8 yes" "$code $(grep -q ^ctest <<<"$log" && echo yes)"

# A build that fails
fake ninja 'echo "x.cpp:1: error" >&2; exit 1'
call -- run 07
check_has "a failed build: the message of the compiler" '^x.cpp:1: error$' "$err"
check "a failed build: code" 4 "$code"
check "a failed build: nothing is run" "" "$(program_calls)"
fake cmake 'echo "CMake Error: conebook: GLM is missing; install the Debian package libglm-dev"; exit 1'
rm -r "$repository/build"
call -- run
check "failed configuration: code" 4 "$code"
check_has "failed configuration: the reason" 'GLM is missing' "$err"

echo "$checks checks, $failures failed"
[ "$failures" = 0 ]
