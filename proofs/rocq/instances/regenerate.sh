#!/bin/sh
# Writes the instances anew from the certificates beside them: `regenerate.sh [ORTHOCERT]`, from any
# folder. The certificates are those that the kernel's tests prove, and KernelValues.v what they
# compute: ORTHOCERT_WRITE=1 cargo test -p orthocert-kernel rocq.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
orthocert=${1:-$here/../../../target/release/orthocert}

for name in OrthoglideTolerance LinearDelta FourSliders StrutsAndPlane PostulateAll PostulateUpTo2; do
    "$orthocert" export rocq "$here/$name.cert.json" -o "$here/$name.v"
done
"$orthocert" export rocq "$here/../../certificates/delta-joint-speed.cert.json" -o "$here/DeltaSpeed.v"
"$orthocert" export rocq "$here/../../certificates/delta-parallel-margin.cert.json" -o "$here/DeltaMargin.v"
"$orthocert" export rocq "$here/../../certificates/upu-base-axes.cert.json" -o "$here/UpuAxes.v"
