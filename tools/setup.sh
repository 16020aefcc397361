# Sourced by ./run and ./test: installs what is missing, configures, builds.
# Sets root (of the repository), build (the build folder; $CONEBOOK_BUILD_DIR chooses another one).
root="$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)"
build="${CONEBOOK_BUILD_DIR:-$root/build}"

say() { echo "conebook: $*"; }
fail() {  # fail CODE MESSAGE
    echo "conebook: $2" >&2
    exit "$1"
}

# The packages of packages.txt that are not installed, one a line.
missing_packages() {
    local wanted installed
    wanted="$(sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "$root/packages.txt" | LC_ALL=C sort -u)"
    # dpkg-query fails when it does not know one of the names, but still prints the others.
    # shellcheck disable=SC2086
    installed="$(dpkg-query -W -f='${db:Status-Status} ${Package}\n' $wanted 2>/dev/null || true)"
    installed="$(sed -n 's/^installed //p' <<<"$installed" | LC_ALL=C sort -u)"
    LC_ALL=C comm -23 <(echo "$wanted") <(echo "$installed")
}

install_packages() {
    if ! command -v dpkg-query >/dev/null; then
        # Another distribution: CMake names whatever it does not find.
        command -v cmake >/dev/null && command -v ninja >/dev/null ||
            fail 3 "this is not a Debian system; install what packages.txt lists, by the names it has here"
        return 0
    fi
    local missing as_root=()
    missing="$(missing_packages | tr '\n' ' ')"
    missing="${missing% }"
    [ -n "$missing" ] || return 0
    if [ "$(id -u)" != 0 ]; then
        command -v sudo >/dev/null ||
            fail 3 "packages are missing, and there is no sudo to install them with; as root: apt-get install $missing"
        as_root=(sudo)
    fi
    say "installing with ${as_root[*]:+sudo }apt-get: $missing"
    local apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300)
    # Old lists may still do, so a failed update alone ends nothing.
    "${apt[@]}" update >/dev/null || say "apt-get update failed; trying with the package lists at hand"
    # shellcheck disable=SC2086
    "${apt[@]}" install -y --no-install-recommends $missing </dev/null ||
        fail 3 "apt-get could not install: $missing"
}

# Configure once; afterwards ninja configures again by itself when a CMake file has changed.
configure() {
    fresh_build=no
    local home_dir=""
    [ -f "$build/CMakeCache.txt" ] &&
        home_dir="$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$build/CMakeCache.txt")"
    [ -f "$build/build.ninja" ] && [ "$home_dir" = "$root" ] && return 0
    fresh_build=yes
    say "configuring $build (Release)"
    local fresh=()
    [ -n "$home_dir" ] && fresh=(--fresh)  # made for another place, or never finished
    mkdir -p "$build"
    cmake "${fresh[@]}" -G Ninja -DCMAKE_BUILD_TYPE=Release -S "$root" -B "$build" >"$build/configure.log" 2>&1 || {
        grep -E '^conebook:|conebook: ' "$build/configure.log" >&2 || cat "$build/configure.log" >&2
        fail 4 "CMake could not configure; its whole output is in $build/configure.log"
    }
}

# build_targets [TARGET...]: all of them when none is named. Silent when there is nothing to do.
build_targets() {
    local message="the build failed; the compiler's message is above"
    if [ "$fresh_build" = yes ]; then
        say "building (the first time takes a few minutes)"
        ninja -C "$build" "$@" >&2 || fail 4 "$message"
    else
        ninja -C "$build" --quiet "$@" 2>&1 | sed -u '/^ninja: no work to do\.$/d' >&2 || fail 4 "$message"
    fi
}

# What every program started from here needs.
export_environment() {
    export CONEBOOK_ROOT="$root"
    export MESA_SHADER_CACHE_DIR="$build/shader_cache"
}

# ccache keeps its files in the home folder; without one, in the build folder.
if [ ! -w "${HOME:-}" ]; then
    export CCACHE_DIR="${CCACHE_DIR:-$build/ccache}"
fi

# The chapters, in order, as CMakeLists.txt lists them.
chapters() { sed -n 's/^add_chapter(\([0-9][0-9]_[a-z0-9_]*\)).*/\1/p' "$root/CMakeLists.txt"; }
