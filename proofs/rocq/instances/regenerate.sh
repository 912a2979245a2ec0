#!/bin/sh
# Writes the instances anew from their certificates: `regenerate.sh [ORTHOCERT]`, from any folder. Those beside
# them are what the kernel's tests prove, and KernelValues.v what they compute:
# ORTHOCERT_WRITE=1 cargo test -p orthocert-kernel rocq.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
orthocert=${1:-$here/../../../target/release/orthocert}

for name in OrthoglideTolerance LinearDelta FourSliders StrutsAndPlane PostulateAll PostulateUpTo2 NoCube Atlas; do
    "$orthocert" export rocq "$here/$name.cert.json" -o "$here/$name.v"
done
while read -r name certificate; do
    "$orthocert" export rocq "$here/../../certificates/$certificate.cert.json" -o "$here/$name.v"
done <<END
DeltaSpeed delta-joint-speed
DeltaTooFast delta-joint-speed-refuted
DeltaMargin delta-parallel-margin
UpuAxes upu-base-axes
FiveBar five-bar
FiveBarFormulas five-bar-formulas
PlanarPlatform planar-3-rpr
Prototype orthoglide-prototype
END
