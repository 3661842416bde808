#!/bin/sh
# Makes materials, lights, default.json and normals.exr of this folder anew with build/gonio, from the
# measurements in $GONIO_TEST_DATA. On one machine it gives the same bytes each time.
set -eu
measured=$(cd "${GONIO_TEST_DATA:?found none, expected the folder of rgl, rgl_more and mbsdf}" && pwd)
cd "$(dirname "$0")"
gonio=../build/gonio
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir -p materials lights

# material OUT FILE WHO: the smallest stack of relative variance 0.01.
material() {
  $gonio convert "$measured/$2" "materials/$1.exr" --max-variance 0.01 --comment "derived from a measurement: $3"
}
rgl='J. Dupuy and W. Jakob, EPFL RGL, https://rgl.epfl.ch/materials; CC0'
mdl='car paint, NVIDIA MDL SDK examples; CC0'
for name in cc_iris_purple_gem cg_sunflower paper_white satin_rosaline; do
  material $name rgl/${name}_rgb.bsdf "$rgl"
done
for name in aurora_white cc_green_malachite chm_orange ilm_solo_m_68 irid_flake_paint1 vch_silk_blue; do
  material $name rgl_more/${name}_rgb.bsdf "$rgl"
done
for name in carpaint_blue carpaint_red; do
  material $name mbsdf/$name.mbsdf "$mdl"
done

$gonio synth default -o default.json

$gonio ndf "$measured/rgl/cc_iris_purple_gem_rgb.bsdf" --size 64 -o "$scratch/ndf"
cp "$scratch/ndf/ndf.exr" normals.exr

# lamp FILE TITLE CATALOGUE LAMP WATTS OPENING PLANES GAMMA INTENSITY: an IES file, every degree from the nadir to
# GAMMA in the PLANES; INTENSITY [cd] is an awk expression of s and c, sine and cosine of the angle from the nadir,
# and ps and pc, those of the plane.
lamp() {
  awk -v title="$2" -v catalogue="$3" -v lamp="$4" -v watts="$5" -v opening="$6" -v planes="$7" -v last="$8" '
    function intensity(s, c, ps, pc) { return '"$9"' }
    function end_of_line(i, n, a_line) { return i == n || i % a_line == 0 ? "\n" : " " }
    BEGIN {
      degree = atan2(0, -1) / 180
      n = split(planes, plane, " ")
      printf "IESNA:LM-63-2002\n[TEST] invented: computed from a closed form, not measured\n[TESTLAB] none\n"
      printf "[ISSUEDATE] 2026-11-30\n[MANUFAC] gonio\n[LUMCAT] %s\n[LUMINAIRE] %s\n[LAMP] %s\nTILT=NONE\n", catalogue, title, lamp
      printf "1 -1 1 %d %d 1 2 %s\n1 1 %s\n", last + 1, n, opening, watts
      for (i = 0; i <= last; ++i) printf "%d%s", i, end_of_line(i + 1, last + 1, 20)
      for (k = 1; k <= n; ++k) printf "%d%s", plane[k], end_of_line(k, n, 20)
      for (k = 1; k <= n; ++k)
        for (i = 0; i <= last; ++i)
          printf "%.1f%s", intensity(sin(i * degree), cos(i * degree), sin(plane[k] * degree), cos(plane[k] * degree)),
            end_of_line(i + 1, last + 1, 15)
    }' > "$1"
}

# 2 pi 1200 / 5 lm; half of it at 33 degrees.
lamp lights/downlight.ies 'Downlight, round, 170 mm' D15 'LED 15 W' 15 '-0.17 -0.17 0' 0 90 '1200 * c ^ 4'

# Down across the lamp, so that two rows of desks are lit and the screens are not; a third of it up.
lamp "$scratch/pendant.ies" 'Pendant, linear, 1.2 m, direct and indirect' P32 'LED 32 W' 32 '0.08 1.2 0.06' \
  '0 15 30 45 60 75 90' 180 'c > 0 ? 560 * c * (1 + 1.6 * s * s * ps * ps) : -330 * c * (1 + 0.8 * s * s * ps * ps)'
$gonio light convert "$scratch/pendant.ies" lights/pendant.ldt

# A lobe towards the wall, which is in the plane 0, 40 degrees (0.7) from the nadir.
lamp lights/wall_washer.ies 'Wall washer, round, 100 mm' W24 'LED 24 W' 24 '-0.1 -0.1 0' \
  '0 10 20 30 40 50 60 70 80 90 100 110 120 130 140 150 160 170 180' 90 \
  '3200 * c * exp(7 * (s * pc * sin(0.7) + c * cos(0.7) - 1))'
