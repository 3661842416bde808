#!/usr/bin/env bash
# format.sh [--check]: lays out all C++ sources by .clang-format, or says which differ. Layout depends on the version of
# clang-format: it is that of Debian 12, 14. Exit status 77 without it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

clang_format=$(command -v clang-format-14 || command -v clang-format || true)
if [[ -z $clang_format || $("$clang_format" --version) != *"version 14."* ]]; then
  echo "format: no clang-format 14" >&2
  exit 77
fi
mapfile -t sources < <(git ls-files '*.h' '*.cpp')
if [[ ${1:-} == --check ]]; then
  "$clang_format" --dry-run --Werror "${sources[@]}"
else
  "$clang_format" -i "${sources[@]}"
fi
