#!/usr/bin/env bash
# workflow_test.sh GONIO WORKFLOW WORK: single jobs; then 20 files, two of them broken, killed half way and started
# again.
# Exit status 77 without snakemake.
set -euo pipefail
gonio=$1 workflow=$2 work=$3
if ! command -v snakemake >/dev/null; then
  echo "workflow: no snakemake (Debian: snakemake), skipped"
  exit 77
fi
rm -rf "$work" && mkdir -p "$work/files" && cd "$work"
fail() { echo "workflow: $*" >&2; exit 1; }

k=0
for model in default lambert:albedo=0.5/0.4/0.3 ggx:alpha=0.3+lambert:albedo=0.2; do
  "$gonio" synth "$model" -o large.mbsdf >/dev/null 2>&1
  "$gonio" convert large.mbsdf small.mbsdf --grid 20x40 >/dev/null 2>&1
  for copy in 1 2 3 4 5 6; do k=$((k + 1)); cp small.mbsdf "files/material$k.mbsdf"; done
done
head -c 1000 small.mbsdf >files/truncated.mbsdf
echo "no table" >files/text.binary

# One job: what is not the file's fault is no result, and a format that is refused stops no other.
job() { "$workflow/material.sh" "$gonio" "$1" "alone/$1/status.txt" "exr bsdf" stack >/dev/null; }
mkdir -p alone/small.mbsdf/small.exr  # where a file cannot be written
job small.mbsdf && fail "a file that cannot be written is a success"
[ ! -e alone/small.mbsdf/status.txt ] || fail "a file that cannot be written is a result"
rmdir alone/small.mbsdf/small.exr
job small.mbsdf || fail "not tried again"
grep -qx ok alone/small.mbsdf/status.txt || fail "tried again: $(cat alone/small.mbsdf/status.txt)"
LC_ALL=C sed 's/rgb\x05\x00/grb\x05\x00/' alone/small.mbsdf/small.bsdf >spectral.bsdf
"$gonio" info spectral.bsdf | grep -q spectra || fail "spectral.bsdf is not spectral"
job spectral.bsdf || fail "a spectral file"
grep -qx ok alone/spectral.bsdf/status.txt || fail "a spectral file: $(cat alone/spectral.bsdf/status.txt)"
grep -q "spectra: found" alone/spectral.bsdf/log.txt || fail "the refused format is not in the log"

# The jobs as the cheapest there are: small stacks, and their files alone reported.
cat >"$work/gonio" <<EOF
#!/bin/sh
case \$1 in
  convert) exec "$gonio" "\$@" --chart outgoing --grid 6x6 --incident 7 ;;
  *) exec "$gonio" "\$@" ;;
esac
EOF
chmod +x "$work/gonio"
run() {
  exec snakemake -s "$workflow/Snakefile" --profile "$workflow/profile" --cores 2 \
    --config inputs="['files/*']" gonio="$work/gonio" report=stack threads=1 convert="['exr']" "$@"
}
finished() { find database/materials -name status.txt 2>/dev/null | sort; }

# Killed with all its jobs once eight are finished.
setsid bash -c "$(declare -f run); workflow='$workflow' work='$work'; run" >first.log 2>&1 &
first=$!
for _ in $(seq 3000); do
  [ "$(finished | wc -l)" -ge 8 ] && break
  kill -0 $first 2>/dev/null || { cat first.log; fail "the first run ended early"; }
  sleep 0.2
done
kill -KILL -- -$first
wait $first 2>/dev/null || true
before=$(finished | wc -l)
[ "$before" -ge 8 ] && [ "$before" -lt 20 ] || fail "killed after $before of 20"
[ ! -e database/overview ] || fail "an overview before the end"
finished | xargs stat -c '%n %y %i' >before.txt
finished | sed 's/status.txt/report\/report.json/' | xargs stat -c '%n %y %i' >>before.txt 2>/dev/null || true

(run) >second.log 2>&1 || { cat second.log; fail "the second run failed"; }
cut -d' ' -f1 before.txt | xargs stat -c '%n %y %i' >after.txt
diff before.txt after.txt || fail "finished work was done again"
[ "$(grep -lx ok $(finished) | wc -l)" = 18 ] || fail "expected 18 reports"
[ "$(grep -Lx ok $(finished) | wc -l)" = 2 ] || fail "expected 2 failures"
for name in text.binary truncated.mbsdf; do
  grep -q "^$name: .*found .*, expected" database/overview/failures.txt || fail "no clear message for $name"
done
grep -q "18 materials reported, 2 failed" second.log || fail "no summary"
materials=$(grep -c '"source_bytes"' database/overview/report.json)
[ "$materials" = 18 ] || fail "the overview has $materials materials"
[ -s database/overview/report.html ] || fail "no page"

(run) >third.log 2>&1
grep -q "Nothing to be done" third.log || fail "a third run found something to do"
echo "workflow: $before of 20 when killed; 18 reports, 2 failures, 1 overview"
