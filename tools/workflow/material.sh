#!/bin/sh
# material.sh GONIO SOURCE STATUS FORMATS source|stack [OPTION ...]: converts SOURCE to each format and reports
# it, in the folder of STATUS, which is written last. What is wrong with the file itself is a result and goes
# into STATUS; anything else, such as a full disk or a kill, fails the job, so that it is tried again.
set -u
gonio=$1 source=$2 status=$3 formats=$4 what=$5
shift 5
folder=$(dirname "$status")
stem=$(basename "$source")
stem=${stem%.*}
mkdir -p "$folder" || exit 2

# True if gonio succeeds; false if it refuses the file, with its words in $message.
run() {
  "$gonio" "$@" >"$folder/out.txt" 2>"$folder/errors.txt"
  code=$?
  cat "$folder/out.txt" "$folder/errors.txt" >>"$folder/log.txt"
  [ $code -eq 0 ] && return
  message=$(tail -n 1 "$folder/errors.txt")
  case $message in "gonio $1: $source: "* | "gonio $1: unusable: "*) return 1 ;; esac
  exit $code
}

finish() {
  rm -f "$folder/out.txt" "$folder/errors.txt"
  printf '%s\n' "$1" >"$status.new" && mv "$status.new" "$status"
  exit
}

: >"$folder/log.txt"
run validate "$source" || finish "$(sed -n 's/^.*: error: //p' "$folder/out.txt" | paste -sd ';')"
# One format may be refused to a good file: spectra are no colours that could become spectra.
for format in $formats; do run convert "$source" "$folder/$stem.$format" || :; done
if [ "$what" = stack ]; then source=$folder/$stem.exr; fi
run report "$source" -o "$folder/report" "$@" || finish "$message"
finish ok
