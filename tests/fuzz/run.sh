#!/usr/bin/env bash
# run.sh [SECONDS [NAME ...]]: builds the fuzzers with clang in build-fuzz/ and runs each, or those named,
# for SECONDS (60), from generated files on. Fails at the first finding, which stays in
# build-fuzz/findings/, with exit status 1. Exit status 77 without clang (it is libFuzzer's own for a finding, which is set otherwise).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
seconds=${1:-60}
names=("${@:2}")
((${#names[@]})) || names=(merl rgl mbsdf stack image light fit manifest scene ply obj)

if ! command -v clang++ >/dev/null; then
  echo "fuzz: no clang++" >&2
  exit 77
fi
cmake --preset fuzz
cmake --build --preset fuzz

mkdir -p build-fuzz/corpus build-fuzz/findings
build-fuzz/tests/fuzz/fuzz_corpus build-fuzz/corpus
for name in "${names[@]}"; do
  echo "fuzz: $name"
  build-fuzz/tests/fuzz/fuzz_$name -max_total_time="$seconds" -timeout=20 -rss_limit_mb=3000 -max_len=65536 \
    -seed=1 -error_exitcode=1 -print_final_stats=1 -verbosity=0 -artifact_prefix=build-fuzz/findings/$name- build-fuzz/corpus/$name
done
