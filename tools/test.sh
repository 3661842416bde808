#!/usr/bin/env bash
# Installs what is missing, builds Release to build/ and runs all tests except those labelled slow.
# Tests on real measurements run when GONIO_TEST_DATA names their folder, and are skipped otherwise.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tools/setup.sh
cmake --preset release
cmake --build --preset release --parallel "$(nproc)"
exec ctest --preset release
