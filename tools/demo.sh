#!/usr/bin/env bash
# From a fresh clone to a report: installs what is missing, builds, makes the default material,
# turns it into a stack file and measures how well it is sampled.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/setup.sh
cmake --preset release
cmake --build --preset release --parallel "$(nproc)" --target gonio_tool

mkdir -p build/demo
build/gonio synth default -o build/demo/default.binary
build/gonio convert build/demo/default.binary build/demo/default.exr
build/gonio report build/demo/default.binary -o build/demo/report

echo "The report: $PWD/build/demo/report/report.html (as text: report.md, for programs: report.json)"
