#!/usr/bin/env bash
# From a fresh clone to pictures and a report: installs what is missing, builds, renders measured materials and a scene of
# data/, and measures how well one of the materials is sampled.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/setup.sh
cmake --preset release
cmake --build --preset release --parallel "$(nproc)" --target gonio_tool

mkdir -p build/demo
for material in cc_iris_purple_gem carpaint_blue chm_orange; do
  build/gonio info "data/materials/$material.exr"
  build/gonio render --material "data/materials/$material.exr" -o "build/demo/$material.png" --size 256x256
done
build/gonio render data/scene.json -o build/demo/scene.png
build/gonio report data/materials/cc_iris_purple_gem.exr -o build/demo/report

echo "The pictures: $PWD/build/demo/scene.png, cc_iris_purple_gem.png, carpaint_blue.png, chm_orange.png"
echo "The report: $PWD/build/demo/report/report.html (as text: report.md, for programs: report.json)"
