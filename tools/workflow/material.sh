#!/bin/sh
# material.sh GONIO SOURCE STATUS FORMATS source|stack [OPTION ...]: converts SOURCE to each format and reports
# it, in the folder of STATUS, which is written last. An error of gonio (exit status 1) is a result and
# goes into STATUS; anything else, such as a kill, fails the job.
set -u
gonio=$1 source=$2 status=$3 formats=$4 what=$5
shift 5
folder=$(dirname "$status")
stem=$(basename "$source")
stem=${stem%.*}
mkdir -p "$folder" || exit 2

run() {
  "$gonio" "$@" >>"$folder/log.txt" 2>"$folder/errors.txt"
  code=$?
  cat "$folder/errors.txt" >>"$folder/log.txt"
  [ $code -eq 0 ] && return
  [ $code -eq 1 ] || exit $code
  finish "$(tail -n 1 "$folder/errors.txt")"
}

finish() {
  rm -f "$folder/errors.txt"
  printf '%s\n' "$1" >"$status.new" && mv "$status.new" "$status"
  exit
}

: >"$folder/log.txt"
for format in $formats; do run convert "$source" "$folder/$stem.$format"; done
if [ "$what" = stack ]; then source=$folder/$stem.exr; fi
run report "$source" -o "$folder/report" "$@"
finish ok
