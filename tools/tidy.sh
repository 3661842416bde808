#!/usr/bin/env bash
# tidy.sh [FILE ...]: looks for what .clang-tidy lists in these sources, or in all of mapping, brdf, fitting and tools,
# and in the headers that they include. Fails where it finds something. What is found depends on the version of
# clang-tidy: it is that of Debian 12, 14. Exit status 77 without it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

clang_tidy=$(command -v clang-tidy-14 || command -v clang-tidy || true)
if [[ -z $clang_tidy || $("$clang_tidy" --version) != *"version 14."* ]]; then
  echo "tidy: no clang-tidy 14" >&2
  exit 77
fi
[[ -f build/compile_commands.json ]] || cmake --preset release
sources=("$@")
((${#sources[@]})) || mapfile -t sources < <(git ls-files {mapping,brdf,fitting,tools}/'*.cpp')
printf '%s\0' "${sources[@]}" |
  xargs -0 -n 1 -P "$(nproc)" "$clang_tidy" -p build --quiet --warnings-as-errors='*'
