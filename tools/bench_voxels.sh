#!/usr/bin/env bash
# What the passes over voxels cost at three grid sizes, per occupied face and per cell of the grid, relative to the first
# size: what stays near 1 in the first column follows the faces, in the second the cells.
#   tools/bench_voxels.sh [SCENE] [FRAMES]      default: assets/cornell_box.glb, 3 frames (the fastest counts)
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
bin=${CONEBOOK_BIN:-$root/build/bin}
scene=${1:-$root/assets/cornell_box.glb}
frames=${2:-3}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for chapter in 06_voxel_shading 12_second_bounce; do
    for n in 64 128 256; do
        "$bin/$chapter" --headless --scene "$scene" --size 64x64 --frames "$frames" --set voxels=$n \
            --stats "$folder/$chapter.$n.json" --output "$folder/picture.png"
    done
done
python3 - "$folder" <<'PYTHON'
import json, sys
passes = {"06_voxel_shading": ("average", "voxel shading"), "12_second_bounce": ("light pyramid", "bounce")}
print(f"{'pass':42} {'voxels':>6} {'faces':>8} {'ms':>9} {'per face':>9} {'per cell':>9}")
for chapter, names in passes.items():
    first = {}
    for n in (64, 128, 256):
        data = json.load(open(f"{sys.argv[1]}/{chapter}.{n}.json"))
        faces = next(c["value"] for c in data["counts"] if c["name"] == "occupied faces")
        for p in data["passes"]:
            if not any(name in p["name"] for name in names):
                continue
            per_face, per_cell = p["min_ms"] / faces, p["min_ms"] / n**3
            base = first.setdefault(p["name"], (per_face, per_cell))
            print(f"{chapter + ': ' + p['name']:42} {n:6} {faces:8.0f} {p['min_ms']:9.1f} "
                  f"{per_face / base[0]:9.2f} {per_cell / base[1]:9.2f}")
PYTHON
