#!/bin/sh
# tools/what_to_open.sh OUT: what a run left and what opens it.
set -eu
out=$1
echo
echo "Open:"
echo "  $out/summary.json           power, centre of mass, energies, collisions, provenance"
echo "  $out/series.csv             the same over time; any spreadsheet"
for picture in "$out"/vtk/*.pvd; do
  [ -e "$picture" ] && echo "  $picture   ParaView, then Apply and Play"
done
grep -A 6 '"power_W"' "$out/summary.json" | sed -n 's/^ *"\(torque\|com\|dissipation\)": \([0-9.]\{1,6\}\)[0-9.]*,*$/  power by \1: \2 W/p'
